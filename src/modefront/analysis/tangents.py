r"""Points on a manifold of minima: their tangents, and corrections back to it.

The tangent space of the minimisers of f(J) is the null space of their second derivatives B within
the variables that no bound holds; what changes residuals a little is weakly determined and no
tangent. A step along the tangents is corrected across them, by Newton's method on a basis Q of
their complement,

.. math:: s = -Q\, (Q^T B Q)^{-1} Q^T g, \qquad g = \partial f / \partial J\, \partial J ;

where residuals vanish, with Gauss-Newton's G, which is B on the manifold and leads farther. Of a
model without exact second derivatives B is G.
"""

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from scipy.linalg import null_space

from modefront._typing import Bools, Floats
from modefront.front.weights import UNCHANGED
from modefront.optim.lexicographic import EXACT, TIE
from modefront.optim.problem import AT_BOUND, Evaluation, Problem
from modefront.optim.scalarisation import Scalarisation
from modefront.optim.sqp import Options

FLAT = 1e-5
"""Eigenvalue of B over the greatest one, below which a direction may be flat: more than what the
distance from the manifold leaves."""

TURNING = 1e-3
"""Eigenvalue of G over the greatest one of B, from which residuals turn in a direction of the null
space of B; up to `UNCHANGED` none changes there. Slopes of residuals are its roots."""

ARRIVED = Options().step  # correction in u below which a point lies on the manifold


@dataclass(frozen=True)
class TangentPoint:
    """A point on the manifold with its tangents (p, d)."""

    evaluation: Evaluation
    u: Floats
    T: Floats


class Context:
    """Quantities that are the same everywhere on a manifold.

    Variables that the slope presses against a bound are held there, unless residuals vanish, and
    those that are ``idle`` (p,), without effect, where they are.
    """

    def __init__(
        self, problem: Problem, programme: Scalarisation, minimum: Evaluation, idle: Bools
    ) -> None:
        self.problem, self.programme, self.idle = problem, programme, idle
        self.span = span = problem.upper - problem.lower
        if not minimum.exact:
            minimum = problem.evaluate(minimum.theta, second=True)
        w, value = programme.gradient(minimum.J), programme.value(minimum.J)
        u, g = (minimum.theta - problem.lower) / span, w @ minimum.dJ * span
        size, B = float(np.abs(w) @ np.abs(minimum.J)), self.second(minimum)
        self.top = top = float(np.abs(np.linalg.eigvalsh(B)).max())
        self.most = value + TIE * size + top * TIE**2  # the greatest f that is as good
        self.fits = size <= EXACT * top  # whether residuals vanish on the manifold
        pressed = (np.abs(g) > TIE * np.sqrt(top * size) + ARRIVED * top) & (not self.fits)
        self.held = idle | (pressed & np.where(g > 0, u <= 0, u >= 1))
        self.first = TangentPoint(minimum, u, self.tangents(minimum))
        self.dimension = self.first.T.shape[1]

    def offset(self, point: TangentPoint, evaluation: Evaluation) -> Floats:
        """Return the difference of an evaluation from a point, but for idle variables."""
        goal = (evaluation.theta - self.problem.lower) / self.span
        return np.where(self.idle, 0.0, goal - point.u)

    def distance(self, point: TangentPoint, evaluation: Evaluation) -> float:
        """Return the length of that."""
        return float(np.linalg.norm(self.offset(point, evaluation)))

    def equivalent(self, evaluation: Evaluation) -> bool:
        """Return whether a model is as good as the start."""
        return self.programme.value(evaluation.J) <= self.most

    def second(self, evaluation: Evaluation) -> Floats:
        """Return B."""
        J, dJ = evaluation.J, evaluation.dJ * self.span
        B = self._weighted(evaluation, evaluation.H)
        return B + dJ.T @ self.programme.hessian(J) @ dJ if evaluation.exact else B

    def tangents(self, evaluation: Evaluation) -> Floats:
        """Return a basis (p, .) of the null space of B, without what is weakly determined."""
        N = np.eye(self.held.size)[:, ~self.held]
        lam, V = np.linalg.eigh(N.T @ self._across(evaluation) @ N)
        N = N @ V[:, np.abs(lam) <= FLAT * self.top]
        G = self._weighted(evaluation, evaluation.gauss_newton)
        gamma, V = np.linalg.eigh(N.T @ G @ N)
        return N @ V[:, (gamma <= UNCHANGED * self.top) | (gamma >= TURNING * self.top)]

    def corrected(self, start: TangentPoint, u: Floats, held: Bools) -> TangentPoint | None:
        """Return the point of the manifold next to u, to which a step from ``start`` led, or None.

        Each variable that is held at a bound takes a dimension away from what is left to move on;
        one that leaves its bounds on the way is held there. Corrections that do not become shorter
        lead nowhere.
        """
        before = np.inf
        while True:
            evaluation = self.problem.evaluate(self.problem.lower + u * self.span, second=True)
            if not evaluation.feasible or (held & ~self.held).sum() > self.dimension:
                return None
            T = start.T @ null_space(start.T[held])
            Q = null_space(np.vstack([T.T, np.eye(u.size)[held]]))
            try:
                factor = scipy.linalg.cho_factor(Q.T @ self._across(evaluation) @ Q)
            except np.linalg.LinAlgError:
                return None
            g = self.programme.gradient(evaluation.J) @ evaluation.dJ * self.span
            s = -Q @ scipy.linalg.cho_solve(factor, Q.T @ g)
            size = float(np.abs(s).max(initial=0.0))
            if size <= ARRIVED:
                point = TangentPoint(evaluation, u, self.tangents(evaluation))
                on = self.equivalent(evaluation) and point.T.shape[1] == self.dimension
                return point if on else None
            if size >= before:
                return None
            before, u = size, u + s
            held = held | (u < 0) | (u > 1)
            u = np.clip(u, 0, 1)

    def landed(self, start: TangentPoint, u: Floats, held: Bools) -> TangentPoint | None:
        """Return the point next to u, likewise, on the bounds that u is at if there is one.

        ``held`` (p,) variables stay where they are.
        """
        at_bound = ~held & ((u <= AT_BOUND) | (u >= 1 - AT_BOUND))
        point = None
        if at_bound.any() and (at_bound | held & ~self.held).sum() <= self.dimension:
            point = self.corrected(start, np.where(at_bound, np.round(u), u), held | at_bound)
        return self.corrected(start, np.clip(u, 0, 1), held) if point is None else point

    def _across(self, evaluation: Evaluation) -> Floats:
        """Return the second derivatives across the manifold: G is B where residuals vanish."""
        if self.fits:
            return self._weighted(evaluation, evaluation.gauss_newton)
        return self.second(evaluation)

    def _weighted(self, evaluation: Evaluation, H: Floats) -> Floats:
        w = self.programme.gradient(evaluation.J)
        return np.asarray(np.tensordot(w, H, axes=1) * np.outer(self.span, self.span))
