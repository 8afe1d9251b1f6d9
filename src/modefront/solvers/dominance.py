"""Which points are Pareto optimal among the points of a set."""

from __future__ import annotations

import numpy as np

from modefront._typing import Bools, Floats


def nondominated(J: Floats, tolerance: float = 1e-9) -> Bools:
    """Return which rows of J (points, n) no other row dominates, equation (4).

    A row dominates another one if it is nowhere greater and somewhere less. Differences below
    ``tolerance`` times the range of an objective are none, so that two results of the same
    optimum do not dominate each other by rounding. Rows that are not finite are dominated.

    >>> nondominated(np.array([[0.0, 1.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])).tolist()
    [True, True, False, True]
    """
    finite = np.asarray(np.isfinite(J).all(axis=1))
    out = finite.copy()
    if finite.any():
        J = J[finite]
        margin = tolerance * (J.max(axis=0) - J.min(axis=0))
        no_greater = (J[:, None] <= J + margin).all(axis=2)
        less = (J[:, None] < J - margin).any(axis=2)
        out[finite] = ~(no_greater & less).any(axis=0)
    return out
