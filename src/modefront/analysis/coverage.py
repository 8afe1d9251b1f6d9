"""Coverage of a front: hypervolume, IGD+ and largest gap."""

from __future__ import annotations

import numpy as np

from modefront.front.dominance import nondominated
from modefront.front.front import Front
from modefront.front.gaps import branches_of
from modefront.front.indicators import REFERENCE, hypervolume, igd_plus, largest_gap
from modefront.front.point import Kind, of_kind


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
    reported = [point.solution for point in front.points]
    reported += [solution for edge in front.edges for solution in edge.minima]
    reported += [*front.optimal]
    J = np.array([solution.J for solution in along])
    everything = np.array([solution.J for solution in reported])
    optimal = nondominated(J)
    Y = (J - utopia) / scale
    R = (everything[nondominated(everything)] - utopia) / scale
    parts = branches_of(along, optimal, front.gaps) if front.gaps else []
    branches = [np.array([(solution.J - utopia) / scale for solution in part]) for part in parts]
    gap = max(
        largest_gap(part[(part <= REFERENCE).all(axis=1)])
        for part in branches or [Y[optimal]]
        if len(part)
    )
    return dict(zip(names, (hypervolume(Y[optimal]), igd_plus(Y[optimal], R), gap), strict=True))
