r"""The Pareto front by normal-boundary intersection (Das & Dennis 1998).

With the edges :math:`\theta_i^*`, the utopia point :math:`J^*` and the pay-off matrix
:math:`\Phi = [J(\theta_1^*) - J^*, \ldots]`, every point :math:`\Phi \beta` of the simplex between
the edges is projected along the quasi-normal :math:`\hat n = -\Phi e` onto the boundary of what
can be attained (doi:10.1137/S1052623496307510). Even steps of :math:`\beta` give even points.

Subproblems are solved outwards from the edges, each from a neighbour that is solved. Where two
such advances meet, each is checked against the other: the better solution stays, and its advance
goes on. So a front whose parts belong to different minima gets the best of them everywhere, at
the price of a few more subproblems.

========  ==========================================================
symbol    meaning
========  ==========================================================
beta      (n,) barycentric coordinates of a point of the simplex
Phi       (n, n) pay-off matrix, one column an edge
scale     (n,) range of each objective over the edges
========  ==========================================================
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import combinations

import numpy as np

from modefront._typing import Floats
from modefront.solvers.checkpoint import Checkpoint, compute_always
from modefront.solvers.problem import Problem
from modefront.solvers.scalarisation import Linear, boundary
from modefront.solvers.sqp import Solution, solve

BETTER = 1e-7
"""Gain along the normal, over its length, below which two solutions are the same."""

POINT = 1e-10
"""Range of an objective over the edges, over its typical size, below which it is no range."""


@dataclass(frozen=True)
class Simplex:
    """The simplex between the edges: (points, n) coordinates, and neighbours of each point."""

    beta: Floats
    neighbours: tuple[tuple[int, ...], ...]


def simplex(objectives: int, divisions: int) -> Simplex:
    """Return the lattice of Das and Dennis with ``divisions`` steps along each edge.

    The first point is the edge of the first objective, the last point that of the last one.

    >>> simplex(2, 2).beta.tolist()
    [[1.0, 0.0], [0.5, 0.5], [0.0, 1.0]]
    """
    total = divisions + objectives - 1
    bars = np.array(list(combinations(range(total), objectives - 1)), dtype=int)
    ends = np.hstack([np.full((len(bars), 1), -1), bars, np.full((len(bars), 1), total)])
    counts = np.diff(ends, axis=1)[::-1] - 1
    position = {tuple(row): i for i, row in enumerate(counts.tolist())}
    moves = np.eye(objectives, dtype=int)[:, None] - np.eye(objectives, dtype=int)
    steps = [moves[i, j] for i in range(objectives) for j in range(objectives) if i != j]
    neighbours = tuple(
        tuple(
            i
            for i in (position.get(tuple((row + step).tolist())) for step in steps)
            if i is not None
        )
        for row in counts
    )
    return Simplex(counts / divisions, neighbours)


@dataclass(frozen=True)
class Payoff:
    """Utopia point, range of the objectives and the scaled pay-off matrix, one column an edge."""

    utopia: Floats
    scale: Floats
    Phi: Floats

    def subproblem(self, beta: Floats) -> Linear:
        """Return the programme of one point of the simplex."""
        return boundary(self.Phi @ beta, -self.Phi.sum(axis=1), self.utopia, self.scale)


def payoff(edges: Sequence[Solution], sizes: Floats) -> Payoff | None:
    """Return the pay-off of the edges; None where an objective does not vary over them.

    ``sizes`` are typical sizes of the objectives. Where nothing varies, one model is the best in
    everything and the front is one point.
    """
    J = np.array([edge.at.J for edge in edges]).T
    utopia = np.diag(J).copy()
    scale = np.asarray((J - utopia[:, None]).max(axis=1))
    if (scale <= POINT * sizes).any():
        return None
    return Payoff(utopia, scale, (J - utopia[:, None]) / scale[:, None])


def nbi(
    problem: Problem,
    edges: Sequence[Solution],
    target: Payoff,
    lattice: Simplex,
    checkpoint: Checkpoint = compute_always,
) -> list[Solution]:
    """Return one solution a point of the lattice, in its order.

    Solutions may be dominated, and those that did not converge say so in their status.
    """
    solved: dict[int, Solution] = {}
    advance: dict[int, int] = {}
    renewed: Counter[int] = Counter()
    queue: deque[tuple[int, int]] = deque()
    tried: set[tuple[int, int, int]] = set()

    def settle(i: int, solution: Solution, origin: int) -> None:
        solved[i], advance[i] = solution, origin
        renewed[i] += 1
        queue.extend((j, i) for j in lattice.neighbours[i])

    def worth_trying(i: int, source: int) -> bool:
        if i not in solved:
            return True
        if lattice.beta[i].max() == 1 or (i, source, renewed[source]) in tried:
            return False
        other = advance[i] != advance[source]
        return not solved[i].converged or (solved[source].converged and other)

    for origin, edge in enumerate(edges):
        settle(int(np.argmax(lattice.beta[:, origin])), edge, origin)
    while queue:
        i, source = queue.popleft()
        if not worth_trying(i, source):
            continue
        tried.add((i, source, renewed[source]))
        programme = target.subproblem(lattice.beta[i])
        known = solved.get(i)
        name = f"nbi-{i + 1}-from-{source + 1}-{renewed[source]}"
        found = checkpoint(name, partial(_solve_one, problem, programme, solved[source]))[0]
        if known is None or _better(programme, found, known):
            settle(i, found, advance[source])
        elif found.converged and not _better(programme, known, found):
            tried.add((source, i, renewed[i]))
    return [solved[i] for i in range(len(lattice.beta))]


def _solve_one(problem: Problem, programme: Linear, start: Solution) -> list[Solution]:
    return [solve(problem, programme, start)]


def _better(programme: Linear, found: Solution, known: Solution) -> bool:
    """Return whether a solution reaches farther along the normal than the known one."""
    if found.converged != known.converged:
        return found.converged
    return programme.value(found.at.J) < programme.value(known.at.J) - BETTER
