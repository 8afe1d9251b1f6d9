"""A Pareto front with its edges, weighted models and gaps."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from modefront._typing import Floats, Ints
from modefront.front.gaps import Gap
from modefront.front.point import REFERENCES, Kind, Point, label, of_kind
from modefront.front.simplex import Payoff
from modefront.optim.lexicographic import EXACT
from modefront.optim.scalarisation import LogSum, Scalarisation, weighted
from modefront.optim.sqp import Solution


@dataclass(frozen=True)
class Edge:
    """The edge of one objective, and all other minima of that objective."""

    best: Solution  # best, minima: the edge, and all minima with it
    minima: Sequence[Solution]
    starts: int = 0  # number of random models from which the least objective was sought
    found: int = 0  # number of different minima to which they led
    doubtful: bool = False  # whether fewer than two led to it, and unseen minima are likely


# 13 fields: everything that a search leaves, which tasks keep as one record.
@dataclass(frozen=True)
class Front:
    """A Pareto front with its edges, its weighted models and its gaps."""

    method: str  # by which the front was found
    points: Sequence[Point]  # points along the front, then edges and weighted models
    edges: Sequence[Edge]  # the edge of each objective with its other minima
    optimal: Sequence[Solution]  # accepted minima of optimally weighted residuals, best first
    iterated: Solution | None  # fixed point of the weights; None where they met a singularity
    exact: tuple[bool, ...]  # (n,) whether a model fits the objective exactly
    target: Payoff | None  # utopia point and ranges over the edges; None of one point
    gaps: Sequence[Gap]  # gaps between the branches of a front of two objectives
    # (places, n) lattice points of normal-boundary intersection
    lattice: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    # (places,) the point of the front, from 0, to which each of them led
    places: Ints = field(default_factory=lambda: np.zeros(0, dtype=np.intp))
    # (models, n) objectives of evaluated models that no evaluated model dominates
    known: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    # (n,) typical sizes of the objectives, of random models; empty where not known
    sizes: Floats = field(default_factory=lambda: np.zeros(0))
    # labels of what the search had not finished when its budget was spent
    open: tuple[str, ...] = ()

    @property
    def reference(self) -> Point:
        """The model that the data prefer: most probable, else of optimal, else equal weights."""
        return next(x for kind in REFERENCES for x in self.points if x.kind is kind)

    @property
    def scale(self) -> Floats | None:
        """Range of each objective over the edges, shape (n,)."""
        return self.target.scale if self.target else None


def best_minima(
    front: Front, a: Floats, share: float
) -> list[tuple[str, Scalarisation, list[Solution]]]:
    """Return each objective, and the optimal weights, with its programme and all its best minima.

    They exceed the best one by a ``share`` of it, or of ``a`` (n,), the numbers of properties, in
    the logarithms of optimal weights. An objective that is fitted exactly counts as zero.
    """
    out: list[tuple[str, Scalarisation, list[Solution]]] = []
    names = [point.name for point in of_kind(front.points, Kind.EDGE)]
    scale = np.ones(a.size) if front.scale is None else front.scale
    for i, (name, edge) in enumerate(zip(names, front.edges, strict=True)):
        most = (1 + share) * edge.best.J[i] + EXACT * front.sizes[i]
        programme = weighted(np.eye(a.size)[i] / scale)
        out.append((name, programme, [x for x in edge.minima if x.J[i] <= most]))
    if front.optimal:
        value = LogSum(a).value
        most = value(front.optimal[0].J) + share * float(a.sum())
        best = [x for x in front.optimal if value(x.J) <= most]
        out.append((label(Kind.OPTIMAL), LogSum(a), best))
    return out
