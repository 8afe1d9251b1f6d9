r"""Ways to turn a vector of objectives into one programme.

.. math:: \min_\theta f(J(\theta)) \quad\text{subject to}\quad A J(\theta) = b

Every method of the package is one of these members, and one solver (`modefront.solvers.sqp`)
serves them all.

========  =========  ===========================================
symbol    shape      meaning
========  =========  ===========================================
f         ()         what is minimised, a function of J
df        (n,)       its derivatives
ddf       (n, n)     its second derivatives
A, b      (k, n)     linear constraints on the objectives
========  =========  ===========================================
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import scipy.linalg

from modefront._typing import Bools, Floats

LEAST = 1e-100
"""An objective below which its logarithm and the derivatives change no more: no overflow."""


class Scalarisation(Protocol):
    """A function of the objectives and linear constraints on them."""

    @property
    def A(self) -> Floats:
        """Matrix of the constraints, shape (k, n); k may be 0."""

    @property
    def b(self) -> Floats:
        """Right-hand side of the constraints, shape (k,)."""

    def value(self, J: Floats) -> float:
        """Return f."""

    def gradient(self, J: Floats) -> Floats:
        """Return df/dJ, shape (n,)."""

    def hessian(self, J: Floats) -> Floats:
        """Return d2f/dJ2, shape (n, n)."""


@dataclass(frozen=True)
class Linear:
    """f = w^T J subject to A J = b."""

    w: Floats
    A: Floats
    b: Floats

    def value(self, J: Floats) -> float:
        """Return w^T J."""
        return float(self.w @ J)

    def gradient(self, J: Floats) -> Floats:
        """Return w, whatever J is."""
        return np.broadcast_to(self.w, J.shape)

    def hessian(self, J: Floats) -> Floats:
        """Return zeros."""
        return np.zeros((J.size, J.size))


@dataclass(frozen=True)
class LogSum:
    """I = sum_i a_i ln J_i, equation (8): its stationary points have the weights w_i = a_i / J_i.

    With a ``floor`` b (n,), J_i + b_i stands for J_i: the weights a_i / (J_i + b_i) are bounded,
    and there is a minimum also where a group can be fitted exactly. Where some J_i + b_i is not
    above ``vanishing`` (n,), I is minus infinity. ``a`` (n,) counts the measured properties of
    each group.
    """

    a: Floats
    floor: Floats | float = 0.0
    vanishing: Floats | float = 0.0

    @property
    def A(self) -> Floats:
        """No constraints."""
        return np.zeros((0, self.a.size))

    @property
    def b(self) -> Floats:
        """No constraints."""
        return np.zeros(0)

    def value(self, J: Floats) -> float:
        """Return I; minus infinity where an objective vanishes."""
        if (J + self.floor <= self.vanishing).any():
            return -np.inf
        return float(self.a @ np.log(np.maximum(J + self.floor, LEAST)))

    def gradient(self, J: Floats) -> Floats:
        """Return a / (J + b)."""
        return self.a / np.maximum(J + self.floor, LEAST)

    def hessian(self, J: Floats) -> Floats:
        """Return -a / (J + b)**2 on the diagonal."""
        return np.diag(-self.a / np.maximum(J + self.floor, LEAST) ** 2)


@dataclass(frozen=True)
class Squares:
    """f = sum_i w_i (J_i - goal_i)**2 / 2: the greatest differences count most."""

    w: Floats
    goal: Floats

    @property
    def A(self) -> Floats:
        """No constraints."""
        return np.zeros((0, self.w.size))

    @property
    def b(self) -> Floats:
        """No constraints."""
        return np.zeros(0)

    def value(self, J: Floats) -> float:
        """Return f."""
        return float(self.w @ (J - self.goal) ** 2 / 2)

    def gradient(self, J: Floats) -> Floats:
        """Return w (J - goal)."""
        return np.asarray(self.w * (J - self.goal))

    def hessian(self, J: Floats) -> Floats:
        """Return w on the diagonal, whatever J is."""
        return np.diag(np.broadcast_to(self.w, J.shape))


def weighted(w: Floats) -> Linear:
    """Return min w^T J."""
    return Linear(w, np.zeros((0, w.size)), np.zeros(0))


def boundary(
    point: Floats,
    normal: Floats,
    utopia: Floats,
    scale: Floats,
    active: Bools | None = None,
    share: float = 0.0,
) -> Linear:
    r"""Return the subproblem of normal-boundary intersection (Das & Dennis 1998).

    Maximise t subject to :math:`\Phi \beta + t \hat n = J - J^*`
    (doi:10.1137/S1052623496307510), with ``point`` for :math:`\Phi \beta` and ``normal`` for
    :math:`\hat n`, both in units of ``scale``; t is eliminated: it is the component of the
    equation along the normal, and what is across the normal remains as constraints.

    Only the ``active`` objectives are constrained so; of each other one, over its component of
    the normal, ``share`` is added to what is minimised.
    """
    on = np.ones(normal.size, dtype=np.bool_) if active is None else active
    n = np.where(on, normal, 0.0)
    across = np.zeros((int(on.sum()) - 1, normal.size))
    across[:, on] = scipy.linalg.null_space(normal[None, on]).T
    w = np.where(on, -n / (n @ n), share / np.abs(normal))
    return Linear(w / scale, across / scale, across @ (point + utopia / scale))


def level(minimised: int, fixed: int, value: float, scale: Floats) -> Linear:
    """Return min J_minimised subject to J_fixed = value, in units of ``scale``."""
    unit = np.eye(scale.size) / scale
    return Linear(unit[minimised], unit[[fixed]], np.array([value / scale[fixed]]))
