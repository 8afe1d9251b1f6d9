r"""The augmented Lagrangian, by which steps of `modefront.optim.sqp` are judged.

For :math:`\min f + \max_i y_i` subject to :math:`c = 0`,

.. math:: M = f + \mu^T c + \tfrac\nu2 \|c\|^2
    + \max_{x \in \Delta} \Big( x^T y - \tfrac1{2\nu} \|x - \kappa\|^2 \Big),

with :math:`\Delta` the simplex :math:`x \ge 0`, :math:`\sum x_i = 1`. The last term is that of
Rockafellar (1974, doi:10.1137/0312021) for :math:`\min \tau` subject to :math:`y_i \le \tau`, with
:math:`\tau` at its best: of

.. math:: \min_\tau\; \tau
    + \tfrac1{2\nu} \sum_i \big( \max(0, \kappa_i + \nu (y_i - \tau))^2 - \kappa_i^2 \big)

the solution has :math:`x_i = \max(0, \kappa_i + \nu (y_i - \tau))` of sum 1, the projection of
:math:`\kappa + \nu y` onto the simplex. It lies between :math:`\max y - 1 / \nu` and
:math:`\max y`, and is :math:`\max y` where the active :math:`y_i` are equal. Where they differ by
little, it is :math:`\kappa^T y` and :math:`\nu / 2` of the squares of their differences from their
mean: as smooth as the other terms, so that a step on which y bends is not rejected for that.

========  =======  ============================================================
symbol    shape    meaning
========  =======  ============================================================
c, mu     (k,)     violations of the constraints, and their multipliers
y, kappa  (m,)     functions of which the maximum counts, and their multipliers
nu        ()       penalty
========  =======  ============================================================
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.optim.problem import Evaluation
from modefront.optim.scalarisation import Scalarisation

PENALTY = 10.0
"""Penalty at least; it hardly changes the evaluations that a solution takes."""


@dataclass(frozen=True)
class Multipliers:
    """Multipliers mu (k,) of constraints and kappa (m,) of functions, of which the maximum counts.

    kappa lies in the simplex.
    """

    mu: Floats
    kappa: Floats

    def weights(self, programme: Scalarisation, J: Floats) -> Floats:
        """Return the slope (n,) of the Lagrangian with respect to the objectives."""
        A, C = programme.constraints.matrix, programme.maximised.matrix
        return np.asarray(programme.gradient(J) + self.mu @ A + self.kappa @ C)


@dataclass(frozen=True)
class Merit:
    """The augmented Lagrangian of a programme, with its multipliers and penalty."""

    programme: Scalarisation
    multipliers: Multipliers
    penalty: float

    def at(self, point: Evaluation) -> float:
        """Return the value at a point; infinite where the objectives are not defined."""
        if not point.feasible:
            return np.inf
        c, y = self.programme.constraints.at(point.J), self.programme.maximised.at(point.J)
        mu, kappa = self.multipliers.mu, self.multipliers.kappa
        of_constraints = mu @ c + 0.5 * self.penalty * (c @ c)
        of_maximum = kappa @ y + surplus(y, kappa, self.penalty)
        return float(self.programme.value(point.J) + of_constraints + of_maximum)


def surplus(y: Floats, kappa: Floats, penalty: float) -> float:
    """Return the last term of the augmented Lagrangian, less kappa^T y: not negative.

    >>> round(surplus(np.array([0.3, 0.1]), np.array([0.5, 0.5]), 10.0), 12)
    0.075
    >>> surplus(np.array([0.3, 0.3]), np.array([0.5, 0.5]), 10.0)
    0.0
    """
    if y.size == 0:
        return 0.0
    change = projected(kappa + penalty * y) - kappa
    return float(change @ y - change @ change / (2 * penalty))


def projected(x: Floats) -> Floats:
    """Return the point of the simplex next to x (Held, Wolfe & Crowder 1974).

    doi:10.1007/BF01580223

    >>> projected(np.array([0.9, 0.3, -2.0])).round(12).tolist()
    [0.8, 0.2, 0.0]
    """
    x = x - x.max()  # the point is the same, but a great number would swallow the 1
    falling = np.sort(x)[::-1]
    level = (np.cumsum(falling) - 1) / np.arange(1, x.size + 1)
    return np.maximum(x - level[np.flatnonzero(falling > level)[-1]], 0.0)
