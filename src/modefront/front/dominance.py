"""Which points are Pareto optimal among the points of a set."""

import numpy as np

from modefront._typing import Bools, Floats

TRADE = 1e-9
"""Loss in one objective, over the gain in another one, that counts as none: no proper trade-off."""

SAME = 1e-6  # gain in an objective, over its range, that counts as none: solvers leave as much
BLOCK = 1_000_000  # differences of objectives that are held at once


def nondominated(J: Floats, tolerance: float = SAME, scale: Floats | None = None) -> Bools:
    """Return which rows of J (points, n) no other row dominates, equation (4).

    A row dominates another one if it is nowhere greater and somewhere less. So that two results of
    the same optimum do not dominate each other by rounding, gains below ``tolerance`` times the
    range of an objective are none, and losses up to it neither where the gain is 1e7 times as
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


def undominated(J: Floats, known: Floats, scale: Floats, tolerance: float = SAME) -> Bools:
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
