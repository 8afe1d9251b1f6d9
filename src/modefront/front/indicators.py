"""Coverage of a front by a set of points, in units of the range of each objective.

Hypervolume (Zitzler & Thiele 1998, doi:10.1007/BFb0056872), IGD+ (Ishibuchi et al. 2015,
doi:10.1007/978-3-319-15892-1_8), and the longest branch of the shortest tree that joins all points.
"""

from collections.abc import Iterable

import numpy as np
from scipy.sparse.csgraph import minimum_spanning_tree

from modefront._typing import Floats
from modefront.front.dominance import nondominated
from modefront.front.front import Front
from modefront.front.gaps import branches_of
from modefront.front.point import Kind, of_kind
from modefront.optim.sqp import Solution

REFERENCE = 1.1  # each coordinate of the point up to which the hypervolume counts


def hypervolume(Y: Floats) -> float:
    """Return the hypervolume of points (points, n), n >= 2.

    For three and more objectives the package moocore (the extra ``metrics``) computes it; NaN
    where it is not installed.

    >>> round(hypervolume(np.array([[0.0, 1.0], [0.5, 0.5], [1.0, 0.0]])), 12)
    0.46
    """
    Y = Y[(Y < REFERENCE).all(axis=1)]
    if len(Y) == 0:
        return 0.0
    if Y.shape[1] > 2:
        try:
            import moocore
        except ImportError:
            return float("nan")
        return float(moocore.hypervolume(Y, ref=np.full(Y.shape[1], REFERENCE)))
    Y = Y[nondominated(Y, tolerance=0.0)]
    Y = Y[np.argsort(Y[:, 0], kind="stable")]
    width = np.diff(np.append(Y[:, 0], REFERENCE))
    return float(width @ (REFERENCE - np.minimum.accumulate(Y[:, 1])))


def igd_plus(Y: Floats, R: Floats) -> float:
    """Return the IGD+ of points (points, n) to a reference set (m, n).

    >>> igd_plus(np.array([[1.0, 0.5]]), np.array([[0.0, 1.0], [2.0, 0.0]]))
    0.75
    """
    behind = np.array([np.linalg.norm(np.maximum(Y - rho, 0.0), axis=1).min() for rho in R])
    return float(behind.mean())


def largest_gap(Y: Floats) -> float:
    """Return the longest branch of the shortest tree that joins points (points, n).

    >>> round(largest_gap(np.array([[0.0, 1.0], [1.0, 0.0], [0.5, 0.5]])) ** 2, 12)
    0.5
    """
    if len(Y) < 2:
        return 0.0
    # Points that coincide are no branch, which a length of 0 would be in a sparse matrix.
    Y = np.unique(Y, axis=0)
    tree = minimum_spanning_tree(np.linalg.norm(Y[:, None] - Y, axis=2))
    return float(tree.data.max(initial=0.0))


def coverage(front: Front) -> dict[str, float]:
    """Return hypervolume, IGD+ and largest gap of the Pareto-optimal points of a front.

    In units of the ranges of the objectives over the edges, from the utopia point. The reference
    set of IGD+ is all that is not dominated of everything that was found: what the front misses
    of that, such as edges and weighted models. Gaps are those between points within 1.1 times the
    ranges, as far as the hypervolume reaches. NaN where the front is one point or empty.
    """
    names = ("hypervolume", "igd_plus", "largest_gap")
    along = [point.solution for point in of_kind(front.points, Kind.FRONT)]
    if front.target is None or not along:
        return dict.fromkeys(names, float("nan"))
    utopia, scale = front.target.utopia, front.target.scale

    def units(solutions: Iterable[Solution]) -> Floats:
        return (np.array([x.J for x in solutions]) - utopia) / scale

    Y = units(along)
    optimal = nondominated(Y)
    minima = [solution for edge in front.edges for solution in edge.minima]
    R = units([*(point.solution for point in front.points), *minima, *front.optimal])
    branches = [units(part) for part in branches_of(along, optimal, front.gaps) if part]
    gap = max(largest_gap(part[(part <= REFERENCE).all(axis=1)]) for part in branches)
    R = R[nondominated(R)]
    return dict(zip(names, (hypervolume(Y[optimal]), igd_plus(Y[optimal], R), gap), strict=True))
