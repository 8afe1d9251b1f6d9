r"""Validity of the linearised scatter: distances of a solution from other active sets and jumps.

The linearisation of `modefront.uncertainty.scatter` is valid as long as no active set changes and
the solution remains the same minimum. Each condition of validity,

======================================  ===================================================
condition                               quantity that has to be positive
======================================  ===================================================
a parameter within its bounds           its distance from the nearer bound
a parameter at an active bound          the slope of the Lagrangian towards the bound
an active bound of an objective         its weight, less the share :math:`\rho` of all
an inactive bound of an objective       its slack :math:`\tau - c_i`
a minimum among others                  the excess of the others
======================================  ===================================================

is a quantity x with a linearised standard deviation of its own. It is in doubt where
:math:`x \le \sigma_x`, that is where one standard deviation of the errors of the data violates it.
A point is near the end of a branch of the front where the end is within its scatter in all
objectives. Where the second derivatives on the null space of the equations are not positive
definite, the point is a fold or a saddle rather than a minimum.
"""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum

import numpy as np

from modefront._typing import Floats


class LinearisationWarning(Enum):
    """Reason why the linearised scatter of a point may not be valid."""

    SADDLE = "the second derivatives are not positive definite: the front folds or jumps there"
    MEETS = "a parameter reaches its bound within one standard deviation"
    LEAVES = "a parameter leaves its bound within one standard deviation"
    SWITCHES = "other groups determine the point within one standard deviation"
    ENDS = "a branch of the front ends within one standard deviation"
    RIVAL = "another minimum becomes better within one standard deviation"
    UNSOLVED = "the solution has not converged"


def std(changes: Floats) -> Floats:
    """Return the standard deviations over the sources, which are the first dimension."""
    return np.asarray(np.sqrt((changes**2).sum(axis=0)))


def near_an_end(J: Floats, changes: Floats, ends: Iterable[Floats]) -> bool:
    """Return whether a point J (n,) that changes by (sources, n) is within its scatter of an end.

    ``ends`` are the objectives (n,) at the ends of the branches of the front.

    >>> J, changes = np.array([1.0, 2.0]), np.array([[0.2, 0.1]])
    >>> near_an_end(J, changes, [np.array([1.1, 1.95])])
    True
    >>> near_an_end(J, changes, [np.array([1.1, 1.8])])
    False
    """
    reach = std(changes)
    return any(bool((np.abs(J - end) <= reach).all()) for end in ends)


def has_rival(value: float, changes: Floats, others: Iterable[float]) -> bool:
    """Return whether a least value that changes by (sources,) is within its scatter of others.

    >>> has_rival(1.0, np.array([0.3, 0.4]), [1.4]), has_rival(1.0, np.array([0.3, 0.4]), [1.6])
    (True, False)
    """
    reach = float(std(changes))
    return any(other - value <= reach for other in others)
