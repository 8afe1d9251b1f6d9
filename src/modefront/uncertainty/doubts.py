r"""Where a linearised scatter may say nothing: a jump, or another active set, is near.

The linearisation of `modefront.uncertainty.scatter` holds as long as no active set changes and the
solution goes on to be the minimum that it is. Each inequality that says so,

======================================  ===================================================
what                                    has to be positive
======================================  ===================================================
a parameter within its bounds           its distance from the nearer one
a parameter that a bound holds          the slope that presses it there
an active bound of an objective         its weight, less the share :math:`\rho` of all
another bound of an objective           its slack :math:`\tau - c_i`
a minimum among others                  how much worse the others are
======================================  ===================================================

is a number x with a linearised standard deviation of its own, and is doubtful where
:math:`x \le \sigma_x`: by one standard deviation of the errors of the data it is otherwise. A point
is as near to the end of a piece of the front where it is within its scatter in all objectives.
Where second derivatives along all that the equations leave open are not positive, the point is no
minimum but a fold or a saddle, and jumps.
"""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum

import numpy as np

from modefront._typing import Floats


class Doubt(Enum):
    """Why a linearisation may say nothing of how far a point scatters."""

    SADDLE = "second derivatives do not hold the model: the front folds or jumps there"
    MEETS = "a parameter meets its bound within one standard deviation"
    LEAVES = "a parameter comes off its bound within one standard deviation"
    SWITCHES = "other groups decide where the point lies within one standard deviation"
    ENDS = "a piece of the front ends within one standard deviation"
    RIVAL = "another minimum is as good within one standard deviation"
    UNSOLVED = "the solution has not converged"


def std(changes: Floats) -> Floats:
    """Return the standard deviations over the sources, which are the first dimension."""
    return np.asarray(np.sqrt((changes**2).sum(axis=0)))


def near_an_end(J: Floats, changes: Floats, ends: Iterable[Floats]) -> bool:
    """Return whether a point J (n,) that changes by (sources, n) is within its scatter of an end.

    ``ends`` are objectives (n,) where the pieces of the front end.

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
