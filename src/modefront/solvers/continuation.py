"""Programmes on a lattice, solved outwards from the edges, each from a neighbour that is solved.

Where two such advances meet, each is checked against the other: the better solution stays, and
its advance goes on. An advance that jumps to another branch is another one from there, so that the
branch which it has left is checked against it. So a front whose parts belong to different minima
gets the best of them everywhere, at the price of a few more programmes.
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations
from math import comb
from typing import Protocol

import numpy as np

from modefront._typing import Floats, Ints
from modefront.solvers.problem import Problem
from modefront.solvers.sqp import Solution
from modefront.work.task import IMMEDIATE, Executor, Key, Task

LatticePoint = tuple[int, ...]
"""A point of the lattice: whole coordinates, one an objective, whose sum is that of its corners."""


@dataclass(frozen=True)
class Simplex:
    """The lattice of Das and Dennis: whole coordinates (points, n), each row of the same sum."""

    counts: Ints

    @property
    def divisions(self) -> int:
        """Steps along each edge."""
        return int(self.counts[0].sum())

    @property
    def beta(self) -> Floats:
        """Barycentric coordinates, shape (points, n)."""
        return np.asarray(self.counts / self.divisions)


def simplex(objectives: int, divisions: int) -> Simplex:
    """Return the lattice of Das and Dennis with ``divisions`` steps along each edge.

    The first point is the edge of the first objective, the last point that of the last one.

    >>> simplex(2, 2).beta.tolist()
    [[1.0, 0.0], [0.5, 0.5], [0.0, 1.0]]
    """
    total = divisions + objectives - 1
    bars = np.array(list(combinations(range(total), objectives - 1)), dtype=int)
    ends = np.hstack([np.full((len(bars), 1), -1), bars, np.full((len(bars), 1), total)])
    return Simplex(np.diff(ends, axis=1)[::-1] - 1)


def default_points(objectives: int) -> int:
    """Return how many points lie along each edge if nothing else is wanted: 20, or fewer of many.

    >>> [default_points(n) for n in (2, 3, 6)]
    [20, 20, 6]
    """
    fitting = (points for points in range(20, 2, -1) if size(objectives, points) <= MANY)
    return next(fitting, 2)


def size(objectives: int, points: int) -> int:
    """Return the number of points of the simplex with so many along each edge."""
    return comb(points + objectives - 2, objectives - 1)


def neighbours(place: LatticePoint) -> list[LatticePoint]:
    """Return the points of the lattice one step from one, within the simplex or beyond it."""
    n = len(place)
    return [
        tuple(x + (k == i) - (k == j) for k, x in enumerate(place))
        for i in range(n)
        for j in range(n)
        if i != j
    ]


class Programmes(Protocol):
    """One programme a point beta (n,) of the lattice."""

    @property
    def label(self) -> str:
        """What the points are called."""

    def goes_on(self, J: Floats, /) -> bool:
        """Return whether points beyond the simplex are wanted next to one with these objectives."""

    @property
    def scale(self) -> Floats:
        """Range of each objective over the edges, shape (n,)."""

    def distance(self, beta: Floats, other: Floats, /) -> float:
        """Return the distance of two points of the plane, in units of the ranges."""

    def place(self, edge: int, J: Floats, /) -> Floats:
        """Return the coordinates (n,) to which an edge with these objectives belongs."""

    def solve(self, problem: Problem, beta: Floats, start: Solution) -> Solution:
        """Return the solution at beta, from a start."""

    def solve_again(self, problem: Problem, beta: Floats, start: Solution) -> Solution:
        """Return the solution at beta, from another start than that of one that converged."""

    def value(self, beta: Floats, J: Floats) -> float:
        """Return what is least at the solution, in units of the range of the objectives."""


BETTER = 1e-7
"""Difference of two values below which the solutions are the same."""

BEYOND = 300
"""Points beyond the simplex that are tried at most; of three objectives, 5 times those within
where these are more. With each further objective a point has more neighbours."""

APART = 1.0
"""Distance of points beyond the simplex in steps of the ranges, one a division, at least: where the
simplex is narrow, the steps of its lattice across are much shorter than those along it."""

DENSE = 60
"""Points beyond the simplex from which on such distances are kept; fewer cost little."""

ATTEMPTS = 3
"""Neighbours from which a point beyond the simplex is tried at most: where none of these leads to a
solution, the front ends."""

MANY = 300
"""Points of the simplex that are not exceeded if nothing else is wanted."""

JUMP = 0.25
"""Change of a parameter from a point to its neighbour, over its range, above which the neighbour
counts as one of another branch, from which the first point is checked."""

SAME = 1e-6
"""Distance of two points, over the ranges of the objectives, below which they are one."""


def continuation(
    problem: Problem,
    programmes: Programmes,
    edges: Sequence[Solution],
    lattice: Simplex,
    work: Executor = IMMEDIATE,
    before: Sequence[Solution] = (),
) -> list[Solution]:
    """Return one solution a point of the lattice, in its order, then those beyond the simplex.

    ``before`` are solutions of nearly the same problem, from which points are solved first.

    Solutions may be dominated, and those that did not converge say so in their status; beyond the
    simplex only those are returned that converged and are not there yet.
    """
    solved: dict[LatticePoint, Solution] = {}
    origin: dict[LatticePoint, int] = {}
    renewed: Counter[LatticePoint] = Counter()
    attempts: Counter[LatticePoint] = Counter()
    queue: deque[tuple[LatticePoint, LatticePoint]] = deque()
    doubtful: deque[tuple[LatticePoint, LatticePoint]] = (
        deque()
    )  # from solutions that did not converge
    tried: set[tuple[LatticePoint, LatticePoint, int]] = set()
    divisions, span = lattice.divisions, problem.upper - problem.lower
    branches = len(edges)
    fixed: set[LatticePoint] = set()
    left_out: set[tuple[LatticePoint, LatticePoint]] = set()
    beyond = 0
    few = lattice.counts.shape[1] <= 3
    room = max(BEYOND, 5 * len(lattice.counts)) if few else BEYOND

    def beta(place: LatticePoint) -> Floats:
        return np.array(place) / divisions

    def accept(place: LatticePoint, solution: Solution, of: int) -> None:
        solved[place], origin[place] = solution, of
        renewed[place] += 1
        J = solution.at.J
        here = programmes.goes_on(J) and place == _nearest(
            divisions * programmes.place(of, J), divisions
        )
        steps = queue if solution.converged else doubtful
        steps.extend((near, place) for near in neighbours(place) if here or min(near) >= 0)

    def worth_trying(place: LatticePoint, source: LatticePoint) -> bool:
        if place not in solved:
            return True
        if place in fixed or (place, source, renewed[source]) in tried:
            return False
        if not few and min(place) < 0:
            return False
        if min(place) < 0 and attempts[place] >= ATTEMPTS and not solved[place].converged:
            return False
        if not solved[place].converged:
            return True
        other = origin[place] != origin[source]
        apart = len(place) == 2 or jumps(solved[place], solved[source])
        return solved[source].converged and other and apart

    def close(place: LatticePoint, other: LatticePoint) -> bool:
        return programmes.distance(beta(place), beta(other)) * divisions < APART - SAME

    def jumps(solution: Solution, other: Solution) -> bool:
        return bool((np.abs(solution.at.theta - other.at.theta) > JUMP * span).any())

    def better(place: LatticePoint, found: Solution, known: Solution) -> bool:
        if found.converged != known.converged:
            return found.converged
        value = partial(programmes.value, beta(place))
        return value(found.at.J) < value(known.at.J) - BETTER

    for i, edge in enumerate(edges):
        coordinates = divisions * programmes.place(i, edge.at.J)
        place = _nearest(coordinates, divisions)
        found = edge
        if np.abs(coordinates - place).max() <= SAME * divisions:
            fixed.add(place)
        else:
            key: Key = ("front", programmes.label, place, "from-edge", i + 1)
            (found,) = work.run([Task(key, _solve, (problem, programmes, beta(place), edge))])
        if place not in solved or better(place, found, solved[place]):
            accept(place, found, i)
    for one in before:
        if one.beta is None or (at := _nearest(divisions * one.beta, divisions)) in solved:
            continue
        key = ("front", programmes.label, at, "again")
        (found,) = work.run([Task(key, _from_before, (problem, programmes, beta(at), one))])
        accept(at, found, -1)
    while queue or doubtful:
        place, source = (queue or doubtful).popleft()
        if not worth_trying(place, source):
            continue
        if place not in solved and min(place) < 0:
            if beyond >= DENSE and close(place, source):
                # It is left out, and those behind it are reached from the same point.
                if (place, source) not in left_out:
                    left_out.add((place, source))
                    queue.extend((near, source) for near in neighbours(place) if min(near) < 0)
                continue
            if beyond >= DENSE and any(close(place, other) for other in solved):
                continue
            beyond += 1
            if beyond > room:
                continue
        tried.add((place, source, renewed[source]))
        attempts[place] += 1
        known = solved.get(place)
        key = ("front", programmes.label, place, "from", source, renewed[source])
        solve = _solve_again if known and known.converged else _solve
        arguments = (problem, programmes, beta(place), solved[source])
        (found,) = work.run([Task(key, solve, arguments)])
        if known is None or better(place, found, known):
            far = jumps(found, solved[source])
            branches += far
            accept(place, found, branches if far else origin[source])
        elif (
            found.converged and not better(place, known, found) and not jumps(known, solved[source])
        ):
            # The way back leads to what is known, unless one of the two lies in another basin.
            tried.add((source, place, renewed[place]))

    within = [tuple(row) for row in lattice.counts.tolist()]
    out = [solved[place] for place in within]
    for place in sorted(set(solved) - set(within), reverse=True):
        J = np.array([one.at.J for one in out])
        away = (np.abs(J - solved[place].at.J) / programmes.scale).max(axis=1)
        if solved[place].converged and away.min() > SAME:
            out.append(solved[place])
    return out


def _solve(problem: Problem, programmes: Programmes, beta: Floats, start: Solution) -> Solution:
    return programmes.solve(problem, beta, start)


def _solve_again(
    problem: Problem, programmes: Programmes, beta: Floats, start: Solution
) -> Solution:
    return programmes.solve_again(problem, beta, start)


def _from_before(
    problem: Problem, programmes: Programmes, beta: Floats, before: Solution
) -> Solution:
    start = replace(before, at=problem.evaluate(before.at.theta))
    return programmes.solve(problem, beta, start)


def _nearest(coordinates: Floats, total: int) -> LatticePoint:
    """Return whole numbers with this sum close to coordinates that have it."""
    floor = np.floor(coordinates + SAME).astype(int)
    short = total - int(floor.sum())
    first = np.argsort(floor - coordinates, kind="stable")[:short]
    floor[first] += 1
    return tuple(floor.tolist())
