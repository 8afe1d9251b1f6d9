"""Which points are Pareto optimal among the points of a set."""

from __future__ import annotations

import numpy as np

from modefront._typing import Bools, Floats

TRADE = 1e-7
"""Loss in one objective, over the gain in another one, that counts as none: no proper trade-off."""


SAME = 1e-6
"""Gain in an objective, over its range, that counts as none: solvers leave as much."""


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
    finite = np.asarray(np.isfinite(J).all(axis=1))
    out = finite.copy()
    if finite.any():
        J = J[finite]
        scale = J.max(axis=0) - J.min(axis=0) if scale is None else scale
        apart = (J[:, None] - J) / np.where(scale > 0, scale, 1.0)
        loss, gain = apart.max(axis=2), -apart.min(axis=2)
        dominates = (gain > tolerance) & (loss <= np.minimum(tolerance, TRADE * gain))
        out[finite] = ~dominates.any(axis=0)
    return out
