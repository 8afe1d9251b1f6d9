r"""A programme at a point: its linearisation, the step from there, and by what it is judged.

Parameters are u in the unit box. One of which the first guess lies nearer to the geometric mean of
its bounds than to their arithmetic one is a factor, and its logarithm is what is moved: eigenvalues
and what follows from them are homogeneous functions of factors of stiffness and mass. With
:math:`L = \ln(upper / lower)`

.. math:: \theta = lower\, e^{L u} \quad\text{or}\quad lower + (upper - lower)\, u .

What is minimised is near the point, with s a step in u,

.. math:: f + g^T s + \tfrac12 s^T B s + \max_i\,(y + \partial y\, s)_i .

Steps are judged by the augmented Lagrangian, with multipliers :math:`\kappa` and the penalty
:math:`\nu`,

.. math:: M = f + \max_{x \in \Delta} \Big( x^T y - \tfrac1{2\nu} \|x - \kappa\|^2 \Big),

with :math:`\Delta` the simplex :math:`x \ge 0`, :math:`\sum x_i = 1`. The last term is that of
Rockafellar (1974, doi:10.1137/0312021) for :math:`\min \tau` subject to :math:`y_i \le \tau`, with
:math:`\tau` at its best: it is :math:`\max y` where the active :math:`y_i` are equal, and as smooth
as the other terms where they are not, so that a step on which y bends is not rejected for that.
"""

from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Floats
from modefront.optim.problem import Evaluation, Problem, Residual
from modefront.optim.qp import QuadraticProgramme, solve_qp
from modefront.optim.scalarisation import Scalarisation

PENALTY = 10.0  # penalty at least; it hardly changes the evaluations that a solution takes

NOISE = 1e-11
"""Relative error that a step is not blamed for: that of a large eigenproblem."""


@dataclass
class UnitBox:
    """A problem in u; see the module."""

    problem: Problem

    def __post_init__(self) -> None:
        lower, upper = self.problem.lower, self.problem.upper
        self.span = upper - lower
        means = np.sqrt(np.maximum(lower * upper, 0.0)) + (lower + upper) / 2
        self.factor = (lower > 0) & (2 * self.problem.start < means)
        self.L = np.log(np.divide(upper, lower, out=np.ones(lower.size), where=self.factor))

    def inside(self, evaluation: Evaluation) -> Evaluation:
        """Return an evaluation with derivatives with respect to u."""
        theta, lower, factor = evaluation.theta, self.problem.lower, self.factor
        u = (theta - lower) / self.span
        u[factor] = np.log(theta[factor] / lower[factor]) / self.L[factor]
        slope = np.where(factor, self.L * theta, self.span)
        H = evaluation.H * (slope[:, None] * slope)
        rows = np.arange(theta.size)
        H[:, rows, rows] += evaluation.dJ * (self.L * slope)
        residuals = [Residual(x.r, x.dr * slope) for x in evaluation.residuals]
        return replace(evaluation, theta=u, dJ=evaluation.dJ * slope, H=H, residuals=residuals)

    def after(self, theta: Floats, s: Floats) -> Floats:
        """Return the parameters after a step s in u, within the bounds."""
        new = np.where(self.factor, theta * np.exp(self.L * s), theta + self.span * s)
        return np.minimum(np.maximum(new, self.problem.lower), self.problem.upper)


def augmented(programme: Scalarisation, kappa: Floats, penalty: float, point: Evaluation) -> float:
    """Return the augmented Lagrangian at a point; infinite where objectives are not defined.

    ``kappa`` (m,) are the multipliers.
    """
    if not point.feasible:
        return np.inf
    y = programme.maximised.at(point.J)
    return float(programme.value(point.J) + (kappa @ y + surplus(y, kappa, penalty)))


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
    """A programme at an evaluation with derivatives; see the module for the symbols.

    ``x`` is the evaluation in the unit box, ``G`` (n, p, p) Gauss-Newton's second derivatives
    there, ``df`` (n,) the slope of f with respect to J.
    """

    unit: UnitBox
    programme: Scalarisation
    evaluation: Evaluation

    def __post_init__(self) -> None:
        self.x = self.unit.inside(self.evaluation)
        self.G = self.x.gauss_newton
        J, dJ = self.x.J, self.x.dJ
        maximised = self.programme.maximised
        self.f, self.df = self.programme.value(J), self.programme.gradient(J)
        self.g = self.df @ dJ
        self.y, self.dy = maximised.at(J), maximised.matrix @ dJ

    def step(
        self, H: Floats, radius: float, kappa: Floats | None
    ) -> tuple[QuadraticProgramme, Floats, list[int], Floats]:
        """Return the quadratic programme, its solution `solve_qp`, and the multipliers (m,) there.

        ``H`` (n, p, p) are second derivatives of the objectives. B takes the multipliers ``kappa``
        of the step before; where there is none, those of another step.
        """
        x = self.x
        lo, hi = np.maximum(-x.theta, -radius), np.minimum(1 - x.theta, radius)
        curved = x.dJ.T @ self.programme.hessian(x.J) @ x.dJ
        m = self.y.size
        passes = 2 if kappa is None and m else 1
        kappa = np.full(m, 1 / max(m, 1)) if kappa is None else kappa
        for _ in range(passes):
            w = self.weights(kappa)[None]
            B = (w @ H.reshape(len(H), -1)).reshape(curved.shape) + curved
            qp = QuadraticProgramme(B, self.g, lo, hi, self.dy, self.y)
            s, active = solve_qp(qp)
            if m:
                kappa = np.maximum(qp.multipliers(s, active, (lo < s) & (s < hi)), 0.0)
                kappa = kappa / kappa.sum()
        return qp, s, active, kappa

    def weights(self, kappa: Floats) -> Floats:
        """Return the slope of the Lagrangian with respect to the objectives, shape (n,)."""
        return np.asarray(self.df + kappa @ self.programme.maximised.matrix)

    def slope(self, kappa: Floats) -> Floats:
        """Return the slope of the Lagrangian, shape (p,)."""
        return np.asarray(self.g + kappa @ self.dy)

    def unchanging(self, s: Floats, reduction: float) -> bool:
        """Return whether what is minimised changes by less than its share along a step."""
        before = self.y.max() if self.y.size else 0.0
        after = (self.y + self.dy @ s).max() if self.y.size else 0.0
        return bool(abs(self.g @ s + (after - before)) <= reduction * abs(self.f + before))

    def predicted(self, B: Floats, s: Floats, kappa: Floats, penalty: float) -> tuple[float, float]:
        """Return the reduction of the augmented Lagrangian by a step, and the penalty in it.

        That is as great as makes the reduction positive; it falls slowly.
        """
        gain, y = -self.slope(kappa) @ s - 0.5 * s @ B @ s, self.y + self.dy @ s
        drop = (surplus(self.y, kappa, penalty) - surplus(y, kappa, penalty)) / penalty
        if drop > 0:
            penalty = max(
                PENALTY / self.programme.maximised.slope**2, 0.1 * penalty, float(-2 * gain / drop)
            )
        above = surplus(self.y, kappa, penalty) - surplus(y, kappa, penalty)
        return float(gain + above), penalty

    def promised(self, s: Floats) -> Floats:
        """Return the objectives (n,) that the derivatives promise at the end of a step.

        Of sums of squares, the greater of the quadratic model and the squares of linear residuals.
        """
        x = self.x
        J = x.J + x.dJ @ s + 0.5 * (x.H @ s @ s)
        squares = [np.sum((each.r + each.dr @ s) ** 2) for each in x.residuals]
        return np.asarray(np.maximum(J, squares or 0.0))

    def after(self, s: Floats) -> Evaluation:
        """Return the evaluation at the end of a step, with second derivatives."""
        return self.unit.problem.evaluate(self.unit.after(self.evaluation.theta, s), second=True)

    def noise(self, kappa: Floats) -> float:
        """Return the change of the augmented Lagrangian that may be rounding.

        That of sums of squares is the one of r, times 2 r.
        """
        J = self.x.J + 2 * np.sqrt(self.x.J) if self.x.residuals else np.abs(self.x.J)
        rows = kappa @ np.abs(self.programme.maximised.matrix)
        return float(NOISE * ((np.abs(self.df) + rows) @ J))
