"""The simplex between the edges of a front, and its lattice."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from math import comb

import numpy as np

from modefront._typing import Floats, Ints
from modefront.optim.lexicographic import EXACT
from modefront.optim.sqp import Solution

FLAT = 1e-2  # least singular value of Phi, over the greatest one, below which the simplex is flat
MANY = 300  # points of the simplex that are not exceeded if nothing else is wanted


def lattice(objectives: int, divisions: int) -> Ints:
    """Return the lattice of Das and Dennis with ``divisions`` steps along each edge, (points, n).

    Whole coordinates whose sum is ``divisions``: the first point is the edge of the first
    objective, the last point that of the last one.

    >>> lattice(2, 2).tolist()
    [[2, 0], [1, 1], [0, 2]]
    """
    total = divisions + objectives - 1
    bars = np.array(list(combinations(range(total), objectives - 1)), dtype=int)
    ends = np.hstack([np.full((len(bars), 1), -1), bars, np.full((len(bars), 1), total)])
    return np.asarray(np.diff(ends, axis=1)[::-1] - 1)


def nearest(beta: Floats, divisions: int) -> tuple[int, ...]:
    """Return a point of the lattice next to coordinates (n,) of the plane.

    >>> nearest(np.array([0.6, 0.6, -0.2]), 5)
    (3, 3, -1)
    """
    counts = np.rint(beta * divisions)
    rest = beta * divisions - counts
    counts[int(np.argmax(rest * (divisions - counts.sum())))] += divisions - counts.sum()
    return tuple(counts.astype(int).tolist())


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


@dataclass(frozen=True)
class Payoff:
    """The simplex between the edges."""

    utopia: Floats  # (n,) least objectives
    scale: Floats  # (n,) range of each objective
    Phi: Floats  # (n, n) the scaled pay-off matrix, one column an edge
    # the model worst in each objective, where the simplex is that of the ranges; else none
    worst: Sequence[Solution] = ()

    @cached_property
    def r(self) -> Floats:
        """The normal towards greater objectives, (n,), in units of the ranges."""
        return np.asarray(self.Phi.sum(axis=1))

    @cached_property
    def unit(self) -> Floats:
        """The normal towards greater objectives, (n,)."""
        return self.scale * self.r

    def place(self, J: Floats) -> Floats:
        """Return the coordinates (..., n) of the points of the plane that are projected onto J."""
        inverse = np.linalg.inv(self.Phi)
        onto = inverse - inverse.mean(axis=0)
        return np.asarray((J - self.utopia) / self.scale @ onto.T + 1 / self.utopia.size)


def is_flat(edges: Sequence[Solution], sizes: Floats) -> bool:
    """Return whether the simplex between edges has no volume; ``sizes`` (n,) are typical ones.

    One model may be best in several of more than two objectives. Where one is the best in all of
    them, the front is one point.
    """
    P = simplex(edges)
    sigma = np.linalg.svd(P / np.maximum(P.max(axis=1), EXACT * sizes)[:, None], compute_uv=False)
    varies = (EXACT * sizes[:, None] < P).any()
    return bool(len(edges) > 2 and varies and sigma[-1] <= FLAT * sigma[0])


def payoff(
    edges: Sequence[Solution], sizes: Floats, worst: Sequence[Solution] = ()
) -> Payoff | None:
    """Return the pay-off of the edges, or of the ranges up to the ``worst`` models if given.

    None where an objective does not vary, compared with ``sizes`` (n,). The corners of the ranges,
    which take the place of a simplex that is flat, need not be attained.
    """
    P, utopia = simplex(edges), np.array([solution.J[i] for i, solution in enumerate(edges)])
    if worst:
        P = np.diag([solution.J[i] for i, solution in enumerate(worst)] - utopia)
    scale = P.max(axis=1)
    if (scale <= EXACT * sizes).any():
        return None
    return Payoff(utopia, scale, P / scale[:, None], worst)


def simplex(edges: Sequence[Solution]) -> Floats:
    """Return the objectives of the edges above the least ones, (n, n), one column an edge."""
    J = np.array([edge.J for edge in edges]).T
    return np.asarray(J - np.diag(J)[:, None])
