"""The pay-off matrix: the simplex between the edges, in units of the range of each objective."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.solvers.dominance import nondominated
from modefront.solvers.problem import Problem
from modefront.solvers.scalarisation import Linear, Squares, boundary
from modefront.solvers.sqp import Options, Solution, begin, solve
from modefront.work.task import IMMEDIATE, Executor, Task

POINT = 1e-10
"""Range of an objective over the edges, over its typical size, below which it is no range."""

FLAT = 1e-2
"""Least singular value of Phi, over the greatest one, below which the simplex is flat."""

ATTEMPTS = 3
"""Known models from which a corner is sought."""

LAST = 1e-6
"""Weight of the objective that is worst at a corner, where the others have 1."""

_COARSE = Options(step=1e-4, reduction=1e-6, iterations=30)
"""A corner only says how far an objective goes."""


BETTER, REST = 1e-7, 1e-4
"""Differences of the greatest excess over a point of the simplex, and of the sum of all, below
which two solutions are the same: the others are free where their excess is not the greatest."""


def is_less(c: Floats, known: Floats) -> bool:
    """Return whether an excess (n,) is less than a known one: its greatest, or else its sum.

    >>> is_less(np.array([1.0, 1.0, 0.2]), np.array([1.0, 1.0, 0.3]))
    True
    """
    fall = known.max() - c.max()
    return bool(fall > BETTER or (fall >= -BETTER and known.sum() - c.sum() > REST))


@dataclass(frozen=True)
class Payoff:
    """The simplex between the edges.

    Attributes
    ----------
    utopia : (n,) least objectives
    scale : (n,) range of each objective
    Phi : (n, n) the scaled pay-off matrix, one column an edge
    worst : the model worst in each objective, where the simplex is that of the ranges; else none
    """

    utopia: Floats
    scale: Floats
    Phi: Floats
    worst: Sequence[Solution] = ()

    def place(self, J: Floats) -> Floats:
        """Return the coordinates (..., n) of the points of the plane that are projected onto J."""
        y = (J - self.utopia) / self.scale
        gamma = np.linalg.solve(self.Phi, y[..., None])[..., 0]
        return np.asarray(gamma - (gamma.sum(axis=-1, keepdims=True) - 1) / gamma.shape[-1])

    def distance(self, beta: Floats, other: Floats) -> Floats:
        """Return the greatest differences (...) of a point (n,) and others (..., n) of the plane.

        They are in units of the ranges.
        """
        return np.asarray(np.abs((beta - other) @ self.Phi.T).max(axis=-1))

    def excess(self, beta: Floats, J: Floats) -> Floats:
        """Return how far objectives (n,) lie above a point of the plane, over the normal (n,)."""
        y = (J - self.utopia) / self.scale
        return np.asarray((y - self.Phi @ beta) / self.Phi.sum(axis=1))

    def is_better(self, beta: Floats, J: Floats, known: Floats) -> bool:
        """Return whether objectives exceed a point of the plane by less than known ones."""
        return is_less(self.excess(beta, J), self.excess(beta, known))

    def subproblem(self, beta: Floats) -> Linear:
        """Return the programme of one point of the simplex."""
        return boundary(self.Phi @ beta, -self.Phi.sum(axis=1), self.utopia, self.scale)


def payoff(
    edges: Sequence[Solution], sizes: Floats, minima: Sequence[Solution] = ()
) -> Payoff | None:
    """Return the pay-off of the edges; None where an objective does not vary over them.

    ``sizes`` are typical sizes of the objectives. Where nothing varies, one model is the best in
    everything and the front is one point.

    Of three and more objectives, one model may be best in several, and the simplex between the
    edges then is flat. Its place takes the simplex between the points that are worst in one
    objective and best in all others, with the ranges over all ``minima``, which need not be
    attained.
    """
    if len(edges) == 2 or _solid(edges, sizes):
        return spanned(edges, (), sizes)
    known = [*edges, *minima]
    optimal = nondominated(np.array([solution.J for solution in known]))
    kept = [known[k] for k in np.flatnonzero(optimal).tolist()]
    worst = [max(kept, key=lambda solution: float(solution.J[i])) for i in range(len(edges))]
    return spanned(edges, worst, sizes)


def corners(
    problem: Problem,
    edges: Sequence[Solution],
    sizes: Floats,
    known: Sequence[Solution],
    work: Executor = IMMEDIATE,
) -> list[Solution]:
    """Return, for each objective, a model that is as near as can be to the least of all others.

    None are looked for where the simplex between the edges has a volume. Else several objectives
    share a best model, all edges may be the same one, and only the corners tell how far each
    objective goes. They are solved from the best of the ``known`` models and the first guess.
    """
    n = len(edges)
    if n == 2 or _solid(edges, sizes):
        return []
    utopia = np.array([solution.J[i] for i, solution in enumerate(edges)])
    tasks = []
    for i, name in enumerate(problem.objectives):
        w = np.where(np.arange(n) == i, LAST, 1.0) / sizes**2
        arguments = (problem, Squares(w, utopia), [*edges, *known])
        tasks.append(Task(("corner", name), _corner, arguments))
    return work.run(tasks)


def _corner(problem: Problem, programme: Squares, known: Sequence[Solution]) -> Solution:
    """Return the best minimum found from the best of the known models and from the first guess."""
    best = sorted(known, key=lambda solution: programme.value(solution.J))[:ATTEMPTS]
    starts = [begin(problem.evaluate(problem.start)), *best]
    solved = [solve(problem, programme, start, _COARSE) for start in starts]
    feasible = [solution for solution in solved if solution.feasible]
    return min(feasible, key=lambda solution: programme.value(solution.J))


def spanned(edges: Sequence[Solution], worst: Sequence[Solution], sizes: Floats) -> Payoff | None:
    """Return the pay-off of the edges, or of the ranges up to the ``worst`` models if given.

    None where an objective does not vary.
    """
    P, utopia = _simplex(edges), np.array([solution.J[i] for i, solution in enumerate(edges)])
    if worst:
        P = np.diag([solution.J[i] for i, solution in enumerate(worst)] - utopia)
    scale = P.max(axis=1)
    if (scale <= POINT * sizes).any():
        return None
    return Payoff(utopia, scale, P / scale[:, None], worst)


def _simplex(edges: Sequence[Solution]) -> Floats:
    """Return the objectives of the edges above the least ones, (n, n), one column an edge."""
    J = np.array([edge.J for edge in edges]).T
    return np.asarray(J - np.diag(J)[:, None])


def _solid(edges: Sequence[Solution], sizes: Floats) -> bool:
    """Return whether a simplex has a volume, compared with the lengths of its edges."""
    P = _simplex(edges)
    scale = np.maximum(P.max(axis=1), POINT * sizes)
    sigma = np.linalg.svd(P / scale[:, None], compute_uv=False)
    return bool(sigma[-1] > FLAT * sigma[0])
