r"""A programme at a point: its linearisation, the step from there, and by what it is judged.

What is minimised is near the point, with s a step of :math:`u = (\theta - lower) / (upper - lower)`

.. math:: f + g^T s + \tfrac12 s^T B s + \max_i\,(y + \partial y\, s)_i
    \quad\text{subject to}\quad c + \partial c\, s = 0 .

Steps are judged by the augmented Lagrangian, with the penalty :math:`\nu`,

.. math:: M = f + \mu^T c + \tfrac\nu2 \|c\|^2
    + \max_{x \in \Delta} \Big( x^T y - \tfrac1{2\nu} \|x - \kappa\|^2 \Big),

with :math:`\Delta` the simplex :math:`x \ge 0`, :math:`\sum x_i = 1`. The last term is that of
Rockafellar (1974, doi:10.1137/0312021) for :math:`\min \tau` subject to :math:`y_i \le \tau`, with
:math:`\tau` at its best: it is :math:`\max y` where the active :math:`y_i` are equal, and as smooth
as the other terms where they are not, so that a step on which y bends is not rejected for that.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.optim.problem import Evaluation, Problem
from modefront.optim.qp import QuadraticProgramme, QuadraticStep, solve_qp
from modefront.optim.scalarisation import Scalarisation

PENALTY = 10.0
"""Penalty at least; it hardly changes the evaluations that a solution takes."""


NOISE = 1e-11
"""Relative error of the objectives that a step is not blamed for: that of a large eigenproblem."""


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


@dataclass
class Linearised:
    """A programme at an evaluation with derivatives, in u; see the module for the symbols.

    ``df`` (n,) is the slope of f with respect to J, and ``free`` says whether there are neither
    constraints nor functions of which the maximum counts.
    """

    problem: Problem
    programme: Scalarisation
    evaluation: Evaluation

    def __post_init__(self) -> None:
        self.span = self.problem.upper - self.problem.lower
        J, dJ = self.evaluation.J, self.evaluation.dJ * self.span
        constraints, maximised = self.programme.constraints, self.programme.maximised
        self.f, self.df = self.programme.value(J), self.programme.gradient(J)
        self.g = self.df @ dJ
        self.c, self.dc = constraints.at(J), constraints.matrix @ dJ
        self.y, self.dy = maximised.at(J), maximised.matrix @ dJ
        self.free = not (self.c.size or self.y.size)

    def step(
        self, H: Floats, radius: float, multipliers: Multipliers | None
    ) -> tuple[QuadraticProgramme, QuadraticStep, Multipliers]:
        """Return the quadratic programme, its solution, and the multipliers there.

        ``H`` (n, p, p) are second derivatives of the objectives with respect to theta. B takes the
        ``multipliers`` of the step before; where there is none, those of the slopes at the point
        and, of functions of which the maximum counts, those of another step.
        """
        dJ, span = self.evaluation.dJ * self.span, self.span[:, None] * self.span
        theta = self.evaluation.theta
        lo = np.maximum((self.problem.lower - theta) / self.span, -radius)
        hi = np.minimum((self.problem.upper - theta) / self.span, radius)
        curved = dJ.T @ self.programme.hessian(self.evaluation.J) @ dJ

        def with_curvature(B: Floats) -> QuadraticProgramme:
            return QuadraticProgramme(B, self.g, self.dc, -self.c, lo, hi, self.dy, self.y)

        passes = 1
        if multipliers is None:
            multipliers, passes = self._first(with_curvature(curved)), 2 if self.y.size else 1
        for _ in range(passes):
            w = multipliers.weights(self.programme, self.evaluation.J)
            qp = with_curvature(weighted(w, H) * span + curved)
            step = solve_qp(qp)
            multipliers = self._multipliers(qp, step)
        return qp, step, multipliers

    def _first(self, qp: QuadraticProgramme) -> Multipliers:
        """Return multipliers of the slopes at the point, and the same one of all functions."""
        still = QuadraticStep(np.zeros_like(self.g), [])
        mu = self._multipliers(qp, still).mu
        return Multipliers(mu, np.full(self.y.size, 1 / max(self.y.size, 1)))

    def _multipliers(self, qp: QuadraticProgramme, step: QuadraticStep) -> Multipliers:
        """Return the multipliers at the end of a step, those of functions within the simplex."""
        if self.free:
            return Multipliers(np.zeros(0), np.zeros(0))
        free = (qp.lo - step.s < 0) & (qp.hi - step.s > 0)
        mu, kappa = qp.multipliers(step.s, step.active, free)
        kappa = np.maximum(kappa, 0.0)
        return Multipliers(mu, kappa / kappa.sum() if step.active else kappa)

    def slope(self, multipliers: Multipliers) -> Floats:
        """Return the slope of the Lagrangian, shape (p,)."""
        if self.free:
            return self.g
        return np.asarray(self.g + multipliers.mu @ self.dc + multipliers.kappa @ self.dy)

    def unchanging(self, s: Floats, reduction: float) -> bool:
        """Return whether what is minimised changes by less than its share along a step."""
        before = self.y.max() if self.y.size else 0.0
        after = (self.y + self.dy @ s).max() if self.y.size else 0.0
        return bool(abs(self.g @ s + (after - before)) <= reduction * abs(self.f + before))

    def predicted(
        self, B: Floats, s: Floats, multipliers: Multipliers, penalty: float
    ) -> tuple[float, float]:
        """Return the reduction of the augmented Lagrangian by a step, and the penalty in it.

        That is as great as makes the reduction positive; it falls slowly.
        """
        gain = -self.slope(multipliers) @ s - 0.5 * s @ B @ s
        if self.free:
            return float(gain), penalty
        c, y = self.c + self.dc @ s, self.y + self.dy @ s
        kappa = multipliers.kappa
        squares = 0.5 * (self.c @ self.c - c @ c)
        drop = squares + (surplus(self.y, kappa, penalty) - surplus(y, kappa, penalty)) / penalty
        if drop > 0:
            penalty = max(PENALTY, 0.1 * penalty, float(-2 * gain / drop))
        above = surplus(self.y, kappa, penalty) - surplus(y, kappa, penalty)
        return float(gain + penalty * squares + above), penalty

    def promised(self, s: Floats) -> Floats:
        """Return the objectives (n,) that the derivatives promise at the end of a step.

        Of sums of squares, the greater of the quadratic model and the squares of linear residuals.
        """
        x, change = self.evaluation, s * self.span
        J = x.J + x.dJ @ change + 0.5 * (x.H @ change @ change)
        squares = [np.sum((each.r + each.dr @ change) ** 2) for each in x.residuals]
        return np.asarray(np.maximum(J, squares or 0.0))

    def after(self, s: Floats) -> Evaluation:
        """Return the evaluation at the end of a step, with second derivatives."""
        theta = self.evaluation.theta + s * self.span
        within = np.minimum(np.maximum(theta, self.problem.lower), self.problem.upper)
        return self.problem.evaluate(within, second=True)

    def noise(self, multipliers: Multipliers) -> float:
        """Return the change of the augmented Lagrangian that may be rounding."""
        if self.free:
            return NOISE * abs(self.f)
        A, C = self.programme.constraints.matrix, self.programme.maximised.matrix
        rows = np.abs(multipliers.mu) @ np.abs(A @ self.evaluation.J)
        rows += multipliers.kappa @ np.abs(C @ self.evaluation.J)
        return float(NOISE * (abs(self.f) + rows))


def weighted(w: Floats, H: Floats) -> Floats:
    """Return sum_i w_i H_i for w (n,) and H (n, p, p)."""
    return np.asarray((w[None] @ H.reshape(len(H), -1)).reshape(H.shape[1:]))


def length(s: Floats) -> float:
    """Return the greatest component; 0 of nothing."""
    return float(np.abs(s).max()) if s.size else 0.0
