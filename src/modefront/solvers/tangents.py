r"""Points on a manifold of minima: their tangents, and corrections back to it.

The tangent space of the minimisers of f(J) is the null space of the second derivatives

.. math:: B = \sum_i w_i \, \partial^2 J_i + \partial J^T f'' \partial J, \qquad
    w = \partial f / \partial J .

With :math:`J_i = \|r_i\|^2`, their known part (Gauss-Newton's) is
:math:`B_0 = 2 \sum_i w_i\, \partial r_i^T \partial r_i`, and the rest is
:math:`2 \sum_i w_i\, r_i^T \partial^2 r_i`. The directions in which no residual changes to first
order are the null space of :math:`B_0`, exactly and for nothing. It is that of B as well, unless

* residuals bend where they do not change, and such a direction is no tangent; or
* residuals turn, :math:`r^T \partial^2 r = - \|\partial r\|^2`, while the sum of their squares
  stays.

All of B, by differences (`modefront.solvers.curvature`), tells at the first minimum whether it is
so; if it is, B is taken in place of :math:`B_0` at every point.

A step along the tangents is corrected back to the manifold across them,

.. math:: s = -B^+ g, \qquad g = w^T \partial J ,

with the inverse on the complement of the null space, until s vanishes: quadratically where
residuals vanish, linearly elsewhere; in the place of :math:`B_0`, B is that of the point where the
step began.

========  =========  ==========================================================
symbol    shape      meaning
========  =========  ==========================================================
u         (p,)       :math:`(\theta - lower) / (upper - lower)`
d         ()         dimension of the manifold; 0 is an isolated minimum
T         (p, d)     orthonormal basis of the tangent space, in u
B, B_0    (p, p)     second derivatives of f(J), and their known part, in u
g         (p,)       slope of f(J), in u
========  =========  ==========================================================
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg

from modefront._typing import Bools, Floats
from modefront.solvers.curvature import ERROR, second_order
from modefront.solvers.lexicographic import TIE
from modefront.solvers.problem import Evaluation, Problem
from modefront.solvers.scalarisation import Scalarisation

FLAT = 1e-12
"""Eigenvalue of B_0 over the greatest one, below which no residual changes in a direction: slopes
of the residuals below 1e-6 of the greatest one, whose squares are eigenvalues."""

TURNING = 1e-3
"""Eigenvalue of B_0 over the greatest one, from which a direction in the null space of B is one in
which residuals turn: their parts of B cancel to 1 %, and not by the errors of differences."""

ARRIVED = 1e-8
"""Correction in u below which a point lies on the manifold: a tenth of the tolerance of a step
(`modefront.solvers.sqp.Options`)."""

AT_BOUND = 1e-9
"""Distance in u below which a variable is at its bound, or does not move: below `ARRIVED`."""

CORRECTIONS = 12
"""Corrections after which a step is given up; quadratic ones take three to five."""


@dataclass(frozen=True)
class TangentPoint:
    """A point on the manifold, its tangents (p, d) and second derivatives (p, p)."""

    evaluation: Evaluation
    u: Floats
    T: Floats
    B: Floats


@dataclass(frozen=True)
class Context:
    """Quantities that are the same everywhere on a manifold.

    Attributes
    ----------
    problem, programme : of which its points are minima
    value : f there
    size : of the parts of f
    top : the greatest eigenvalue of B_0
    held : (p,) variables that stay at a bound, or that are idle
    idle : (p,) variables without effect
    dimension : of the manifold
    exact : whether B is taken and not B_0
    """

    problem: Problem
    programme: Scalarisation
    value: float
    size: float
    top: float
    held: Bools
    idle: Bools
    dimension: int
    exact: bool

    @property
    def span(self) -> Floats:
        """Ranges of the parameters, shape (p,)."""
        return self.problem.upper - self.problem.lower

    def offset(self, u: Floats, evaluation: Evaluation) -> Floats:
        """Return the difference of an evaluation from u, but for idle variables."""
        goal = (evaluation.theta - self.problem.lower) / self.span
        return np.where(self.idle, 0.0, goal - u)

    def slope(self, evaluation: Evaluation) -> Floats:
        """Return g."""
        return self.programme.gradient(evaluation.J) @ evaluation.dJ * self.span

    def gauss_newton(self, evaluation: Evaluation) -> Floats:
        """Return B_0."""
        B = np.tensordot(self.programme.gradient(evaluation.J), evaluation.H, axes=1)
        return B * np.outer(self.span, self.span)

    def hessian(self, evaluation: Evaluation) -> Floats | None:
        """Return B; None where the model is not defined around the point."""
        second = second_order(self.problem, evaluation)
        if second is None:
            return None
        B = np.tensordot(self.programme.gradient(evaluation.J), second.H, axes=1)
        B = B + evaluation.dJ.T @ self.programme.hessian(evaluation.J) @ evaluation.dJ
        return np.asarray(B * np.outer(self.span, self.span))

    def unchanging(self, evaluation: Evaluation) -> Floats:
        """Return a basis (p, .) of the directions in which no residual changes."""
        lam, V = _spectrum(self.gauss_newton(evaluation), ~self.held)
        return V[:, lam <= FLAT * max(self.top, lam.max(initial=0.0))]

    def tangent_point(self, evaluation: Evaluation, u: Floats) -> TangentPoint | None:
        """Return a point with its tangents; None where they cannot be told."""
        if not self.exact:
            return TangentPoint(
                evaluation, u, self.unchanging(evaluation), self.gauss_newton(evaluation)
            )
        B = self.hessian(evaluation)
        return None if B is None else TangentPoint(evaluation, u, self.tangents(evaluation, B), B)

    def tangents(self, evaluation: Evaluation, B: Floats) -> Floats:
        """Return a basis (p, .) of the null space of B, see the top of the module."""
        flat = ERROR * max(self.top, float(np.abs(B).max()))
        still = self.unchanging(evaluation)
        mu, U = np.linalg.eigh(still.T @ B @ still)
        still = still @ U[:, np.abs(mu) <= flat]
        others = scipy.linalg.null_space(np.vstack([still.T, np.eye(self.held.size)[self.held]]))
        lam, V = np.linalg.eigh(others.T @ B @ others)
        null = others @ V[:, np.abs(lam) <= flat]
        gamma, U = np.linalg.eigh(null.T @ self.gauss_newton(evaluation) @ null)
        return np.hstack([still, null @ U[:, gamma >= TURNING * self.top]])

    def equivalent(self, evaluation: Evaluation) -> bool:
        """Return whether a model is as good as the start."""
        allowed = TIE * self.size + self.top * TIE**2
        return self.programme.value(evaluation.J) <= self.value + allowed

    def corrected(self, start: TangentPoint, u: Floats, held: Bools) -> TangentPoint | None:
        """Return the point of the manifold next to u, to which a step from ``start`` led, or None.

        Each variable that is held at a bound takes a dimension away from what is left to move on;
        one that leaves its bounds on the way is held there.
        """
        for _ in range(CORRECTIONS):
            evaluation = self.problem.evaluate(self.problem.lower + u * self.span)
            d = self.dimension - int((held & ~self.held).sum())
            if not evaluation.feasible or d < 0:
                return None
            lam, V = _spectrum(start.B if self.exact else self.gauss_newton(evaluation), ~held)
            across, V = lam[d:], V[:, d:]
            if (across <= FLAT * max(self.top, across.max(initial=0.0))).any():
                return None
            s = -V @ ((V.T @ self.slope(evaluation)) / across)
            if np.abs(s).max(initial=0.0) <= ARRIVED:
                point = self.tangent_point(evaluation, u) if self.equivalent(evaluation) else None
                on = point is not None and point.T.shape[1] == self.dimension
                return point if on else None
            u = u + s
            held = held | (u < 0) | (u > 1)
            u = np.clip(u, 0, 1)
        return None

    def landed(self, start: TangentPoint, u: Floats) -> TangentPoint | None:
        """Return the point of the manifold next to u, which keeps to the bounds that u is at."""
        at_bound = ~self.held & ((u <= AT_BOUND) | (u >= 1 - AT_BOUND))
        u = np.clip(u, 0, 1)
        point = None
        if at_bound.sum() <= self.dimension:
            rounded = np.where(at_bound, np.round(u), u)
            point = self.corrected(start, rounded, self.held | at_bound)
        return self.corrected(start, u, self.held) if point is None else point


def context_of(
    problem: Problem,
    programme: Scalarisation,
    evaluation: Evaluation,
    idle: Bools,
    plain: int | None,
) -> tuple[Context, TangentPoint]:
    """Return the context of the manifold through a minimum, and the minimum with its tangents.

    Variables that the slope presses against a bound are held there, and those that are ``idle``
    where they are. B is not looked at where B_0 has a null space of the dimension ``plain``, for
    which it was that of B at another minimum.
    """
    w = programme.gradient(evaluation.J)
    size = float(np.abs(w) @ np.abs(evaluation.J))
    u = (evaluation.theta - problem.lower) / (problem.upper - problem.lower)
    none = np.zeros(u.size, dtype=bool)
    value = programme.value(evaluation.J)
    context = Context(problem, programme, value, size, 0.0, none, idle, 0, exact=False)
    top = float(np.linalg.eigvalsh(context.gauss_newton(evaluation))[-1])
    slope = context.slope(evaluation)
    pressed = np.abs(slope) > TIE * np.sqrt(top * size) + ARRIVED * top
    held = idle | (pressed & np.where(slope > 0, u <= 0, u >= 1))
    context = replace(context, top=top, held=held)
    still = context.unchanging(evaluation)
    B = None if still.shape[1] == plain else context.hessian(evaluation)
    T = still if B is None else context.tangents(evaluation, B)
    same = T.shape == still.shape and np.abs(T - still @ (still.T @ T)).max(initial=0) <= TURNING
    context = replace(context, dimension=T.shape[1], exact=not same)
    if B is None or same:
        return context, TangentPoint(evaluation, u, still, context.gauss_newton(evaluation))
    return context, TangentPoint(evaluation, u, T, B)


def steps_to_bounds(u: Floats, t: Floats) -> Floats:
    """Return the length of a step along t after which each variable meets its bound, (p,)."""
    moving = np.abs(t) > np.finfo(float).eps
    steps = np.full(t.size, np.inf)
    steps[moving] = ((t > 0) - u)[moving] / t[moving]
    return steps


def _spectrum(B: Floats, free: Bools) -> tuple[Floats, Floats]:
    """Return eigenvalues, ascending, and eigenvectors (p, .) of B within the free variables."""
    lam, V = np.linalg.eigh(B[np.ix_(free, free)])
    full = np.zeros((free.size, lam.size))
    full[free] = V
    return lam, full
