"""Which models are Pareto optimal among those of a set, and which points are different."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from modefront._typing import Bools, Floats
from modefront.optim.lexicographic import TIE
from modefront.optim.sqp import Solution

TRADE = 1e-9
"""Loss in one objective, over the gain in another one, that counts as none: no proper trade-off."""

COPY = 10 * TIE
"""Distance of two points, over the ranges of the objectives, below which they are copies."""

BLOCK = 1_000_000  # differences of objectives that are held at once


def nondominated(J: Floats, tolerance: float = COPY, scale: Floats | None = None) -> Bools:
    """Return which rows of J (points, n) no other row dominates, equation (4).

    A row dominates another one if it is nowhere greater and somewhere less. So that two results of
    the same optimum do not dominate each other by rounding, gains below ``tolerance`` times the
    range of an objective are none, and losses up to it neither where the gain is 1e9 times as
    great: next to an edge the loss in its own objective is small, but real. Rows that are not
    finite are dominated. ``scale`` (n,) are the ranges; that of the rows unless they are given.

    >>> nondominated(np.array([[0.0, 1.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])).tolist()
    [True, True, False, True]
    >>> nondominated(np.array([[0.0, 1.0], [1e-11, 1.0 - 1e-5], [1.0, 0.0]])).tolist()
    [True, True, True]
    >>> nondominated(np.array([[0.0, 1.0], [1e-11, 0.5], [1.0, 0.0]])).tolist()
    [False, True, True]
    """
    if scale is None:
        finite = J[np.isfinite(J).all(axis=1)]
        scale = np.ptp(finite, axis=0) if len(finite) else np.ones(J.shape[1])
    return undominated(J, J, scale, tolerance)


def undominated(J: Floats, known: Floats, scale: Floats, tolerance: float = COPY) -> Bools:
    """Return which rows of J (points, n) no row of ``known`` (models, n) dominates.

    Gains and losses count as in `nondominated`; ``scale`` (n,) are the ranges of the objectives.

    >>> known = np.array([[0.0, 1.0], [1.0, 0.0]])
    >>> undominated(np.array([[0.0, 1.1], [0.5, 0.5]]), known, np.ones(2)).tolist()
    [False, True]
    """
    out = np.asarray(np.isfinite(J).all(axis=1))
    known = known[np.isfinite(known).all(axis=1)]
    unit = np.where(scale > 0, scale, 1.0)
    block = max(BLOCK // max(known.size, 1), 1)
    rows = np.flatnonzero(out)
    for chunk in (rows[k : k + block] for k in range(0, rows.size, block)):
        apart = (known[:, None] - J[chunk]) / unit
        loss, gain = apart.max(axis=2), -apart.min(axis=2)
        dominates = (gain > tolerance) & (loss <= np.minimum(tolerance, TRADE * gain))
        out[chunk] = ~dominates.any(axis=0)
    return out


class Archive:
    """The models that no other evaluated model dominates, with their objectives ``J`` (., n).

    They are in the order in which they were evaluated; of equal ones the last is there.
    """

    def __init__(self, objectives: int) -> None:
        self.models: list[Any] = []
        self.J: Floats = np.zeros((0, objectives))

    def add(self, J: Floats, model: Any) -> None:
        """Keep a model unless another one dominates it, and drop those that it dominates."""
        dominating = (self.J <= J).all(axis=1) & (self.J < J).any(axis=1)
        if not np.isfinite(J).all() or dominating.any():
            return
        kept = (self.J < J).any(axis=1)
        if not kept.all():
            self.models = [self.models[k] for k in np.flatnonzero(kept)]
        self.models.append(model)
        self.J = np.vstack([self.J[kept], J])


def distinct_points(points: Sequence[Solution], scale: Floats) -> list[Solution]:
    """Return points of a front, each once: objectives over ``scale`` (n,) tell copies apart."""
    out: list[Solution] = []
    J = np.zeros((len(points), scale.size))  # of those that are kept
    for x in points:
        same = np.flatnonzero((np.abs(J[: len(out)] - x.J) <= COPY * scale).all(axis=1)).tolist()
        if not same:
            J[len(out)] = x.J
            out.append(x)
        elif x.converged and not out[same[0]].converged:
            out[same[0]], J[same[0]] = x, x.J
    return out
