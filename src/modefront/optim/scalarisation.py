r"""Ways to turn a vector of objectives into one programme, which one solver serves.

.. math:: \min_\theta f(J(\theta)) + \max_i\,(C J(\theta) - d)_i

Most have no maximum (m = 0). A constraint is one whose slope is `STEEP`: an exact penalty.
"""

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats

LEAST = float(np.finfo(float).tiny ** (1 / 3))
"""An objective below which its logarithm and the derivatives change no more: the second ones do not
overflow."""

STEEP = 1e3
"""Slope of a penalty over that of what is minimised: a constraint is met where its multiplier is
less."""

MARGIN = 1e-6  # by which a penalty keeps below zero, in the unit of parameters over their ranges


@dataclass(frozen=True)
class Rows:
    """Linear functions of the objectives, matrix J - offset."""

    matrix: Floats  # (rows, n)
    offset: Floats  # (rows,)
    slope: float = 1.0  # theirs over that of what is minimised, above 1 of a penalty

    def at(self, J: Floats) -> Floats:
        """Return the values, shape (rows,)."""
        return self.matrix @ J - self.offset if self.offset.size else self.offset


@dataclass(frozen=True)
class Linear:
    """f = w^T J, with a maximum of linear functions."""

    w: Floats
    maximised: Rows

    def value(self, J: Floats) -> float:
        """Return w^T J."""
        return float(self.w @ J)

    def gradient(self, J: Floats) -> Floats:
        """Return w, whatever J is."""
        return np.full(J.shape, self.w)

    def hessian(self, J: Floats) -> Floats:
        """Return zeros."""
        return np.zeros((J.size, J.size))


@dataclass(frozen=True)
class LogSum:
    """I = sum_i a_i ln J_i, equation (8): its stationary points have the weights w_i = a_i / J_i.

    With a ``floor`` b (n,), J_i + b_i stands for J_i: the weights a_i / (J_i + b_i) are bounded,
    and there is a minimum also where a group can be fitted exactly. Where some J_i + b_i is not
    above ``vanishing`` (n,), I is minus infinity. ``a`` (n,) counts the measured properties of
    each group, and ``linear`` (n,) are weights of J_i themselves besides.
    """

    a: Floats
    floor: Floats | float = 0.0
    vanishing: Floats | float = 0.0
    linear: Floats | float = 0.0

    @property
    def maximised(self) -> Rows:
        """No maximum."""
        return weighted(self.a).maximised

    def value(self, J: Floats) -> float:
        """Return I; minus infinity where an objective vanishes."""
        if (J + self.floor <= self.vanishing).any():
            return -np.inf
        logs = self.a @ np.log(np.maximum(J + self.floor, LEAST))
        return float(logs + (self.linear * J).sum())

    def gradient(self, J: Floats) -> Floats:
        """Return a / (J + b), and the weights of J."""
        return self.a / np.maximum(J + self.floor, LEAST) + self.linear

    def hessian(self, J: Floats) -> Floats:
        """Return -a / (J + b)**2 on the diagonal."""
        return np.diag(-self.a / np.maximum(J + self.floor, LEAST) ** 2)


@dataclass(frozen=True)
class Constrained:
    """A programme of all objectives but the last, g, which a penalty keeps below zero.

    What is minimised and g are taken over a unit each: their typical slopes.
    """

    programme: "Scalarisation"
    unit: float
    last: float

    @property
    def maximised(self) -> Rows:
        """The rows of the programme, and once more with the penalty."""
        rows = self.programme.maximised
        C = rows.matrix / self.unit if len(rows.matrix) else np.zeros((1, rows.matrix.shape[1]))
        d = rows.offset / self.unit if len(rows.matrix) else np.zeros(1)
        penalty = np.repeat([0.0, STEEP], len(C))
        C = np.column_stack([np.tile(C, (2, 1)), penalty / self.last])
        return Rows(C, np.tile(d, 2) - penalty * MARGIN, STEEP)

    def value(self, J: Floats) -> float:
        """Return f over its unit."""
        return self.programme.value(J[:-1]) / self.unit

    def gradient(self, J: Floats) -> Floats:
        """Return its slope, 0 for g."""
        return np.append(self.programme.gradient(J[:-1]) / self.unit, 0.0)

    def hessian(self, J: Floats) -> Floats:
        """Return its second derivatives, 0 for g."""
        return np.pad(self.programme.hessian(J[:-1]) / self.unit, (0, 1))


def total(programme: "Scalarisation", J: Floats) -> float:
    """Return what a programme minimises."""
    y = programme.maximised.at(J)
    return programme.value(J) + float(y.max() if y.size else 0.0)


Scalarisation = Linear | LogSum | Constrained
"""A smooth function f of the objectives and a maximum of linear ones, minimised together: ``value``
returns f, ``gradient`` df/dJ (n,), ``hessian`` d2f/dJ2 (n, n), and ``maximised`` is C J - d."""


def weighted(w: Floats) -> Linear:
    """Return min w^T J."""
    return Linear(w, Rows(np.zeros((0, w.size)), np.zeros(0)))


def below(w: Floats, a: Floats, most: float) -> Linear:
    """Return min w^T J subject to a^T J <= most."""
    return achievement(w, np.array([0 * a, a]), np.array([0.0, most]), STEEP)


def achievement(w: Floats, C: Floats, d: Floats, slope: float = 1.0) -> Linear:
    """Return min w^T J + slope max (C J - d), an achievement function.

    Wierzbicki 1980, doi:10.1007/978-3-642-48782-8_32.
    """
    return Linear(w, Rows(slope * C, slope * d, slope))
