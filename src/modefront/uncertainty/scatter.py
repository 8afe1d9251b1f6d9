r"""How far errors of the data move the solution of a programme: the implicit function theorem.

A solution is where the conditions of Karush, Kuhn and Tucker hold. With the weights w of the
objectives at it, all of its programmes have

.. math:: \sum_i w_i \, \partial J_i(\theta) = 0

on the parameters that no bound holds. Errors of the data change :math:`J` by :math:`\delta J` and
:math:`\partial J` by :math:`\delta \partial J` (`modefront.uncertainty.noise`). The solution
follows, so that the conditions go on to hold (Fiacco 1983, *Introduction to Sensitivity and
Stability Analysis in Nonlinear Programming*, section 2.4):

.. math:: W \delta\theta + \partial J^T \delta w = - \delta \partial J^T w, \qquad
    W = \sum_i w_i H_i ,

together with what the programme says of w:

==================  =====================================================================
weights given       :math:`\delta w = 0`
optimal weights     :math:`w = a / J`:
                    :math:`\delta w = -\operatorname{diag}(a / J^2)
                    (\partial J\, \delta\theta + \delta J)`
level               min of the others at :math:`J_i = v`: only :math:`w_i` changes, and
                    :math:`\partial J_i \delta\theta + \delta J_i = \delta v`
boundary (NBI)      :math:`J = J^* + P (\beta - t e)` with the edges E as columns,
                    :math:`J^* = \operatorname{diag} E`, :math:`P = E - J^* e^T`, and
                    :math:`w^T P e = 1`:
                    :math:`\partial J \delta\theta + P e\, \delta t = \delta J^* - \delta J
                    + \delta P (\beta - t e)`,
                    :math:`(P e)^T \delta w = -(\delta P\, e)^T w`
==================  =====================================================================

So points of the front also follow the edges, which scatter themselves. A parameter that is pressed
against a bound stays there. Directions in which no residual changes are left out and
named: nothing holds the model there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from modefront._typing import Bools, Floats
from modefront.solvers.curvature import SecondOrder
from modefront.solvers.problem import Problem
from modefront.uncertainty.noise import Noise

FLAT = 1e-12
"""Eigenvalue over the greatest one below which a direction changes no residual."""

BENT = 1e-5
"""Second derivative over the greatest one below which it is the error of differences."""

PRESSED = 1e-6
"""Slope of the Lagrangian at a bound, over the slopes of its terms, from which the bound holds."""


@dataclass(frozen=True)
class Scatter:
    """Changes of a solution by each source of error, of standard deviation one.

    Attributes
    ----------
    theta : (sources, p) changes of the parameters
    J : (sources, n) changes of the objectives at the solution, of its own data
    held : (p,) parameters that a bound holds
    free : (p, d) directions that no data determine, orthonormal over the ranges
    """

    theta: Floats
    J: Floats
    held: Bools
    free: Floats

    @property
    def covariance(self) -> Floats:
        """Covariance of the parameters, (p, p), without the directions that are free."""
        return self.theta.T @ self.theta


def held_at_bounds(problem: Problem, point: SecondOrder, w: Floats) -> Bools:
    """Return which parameters the slope of w^T J presses against a bound."""
    at, span = point.at, problem.upper - problem.lower
    u = (at.theta - problem.lower) / span
    parts = np.abs(w[:, None] * at.dJ) * span
    slope = w @ at.dJ * span
    curved = np.abs(np.tensordot(np.abs(w), at.H, axes=1) * np.outer(span, span)).max()
    pressed = np.abs(slope) > PRESSED * (parts.sum(axis=0).max() + curved)
    near = 1e-9
    held: Bools = pressed & np.where(slope > 0, u <= near, u >= 1 - near)
    return held


def spaces(problem: Problem, point: SecondOrder, w: Floats, held: Bools) -> tuple[Floats, Floats]:
    """Return bases (p, .) over the ranges: of what residuals determine, and of what is free.

    Free is where no residual changes to first order and their squares do not to second order.
    """
    at, span = point.at, problem.upper - problem.lower
    top = np.abs(at.H).max(axis=(1, 2))
    first = np.tensordot(1 / np.where(top > 0, top, 1.0), at.H, axes=1) * np.outer(span, span)
    second = np.tensordot(np.abs(w), point.H, axes=1) * np.outer(span, span)
    lam, V = np.linalg.eigh(first[np.ix_(~held, ~held)])
    basis = np.zeros((held.size, lam.size))
    basis[~held] = V
    flat = lam <= FLAT * max(float(lam.max(initial=0.0)), np.finfo(float).tiny)
    N = basis[:, flat]
    mu, U = np.linalg.eigh(N.T @ second @ N)
    bent = np.abs(mu) > BENT * np.abs(second).max()
    return np.hstack([basis[:, ~flat], N @ U[:, bent]]), N @ U[:, ~bent]


@dataclass(frozen=True)
class Conditions:
    r"""What a programme says of the changes: C dtheta + D dw + e dt = f, g^T dw = h.

    Arrays are C (n, p), D (n, n), f (sources, n), and e (n, k), g (n, k), h (sources, k) with k
    either 0 or 1.
    """

    C: Floats
    D: Floats
    e: Floats
    f: Floats
    g: Floats
    h: Floats


def _open(C: Floats, D: Floats, f: Floats) -> Conditions:
    none = np.zeros((len(D), 0))
    return Conditions(C, D, none, f, none, np.zeros((len(f), 0)))


def given_weights(noise: Noise) -> Conditions:
    """Return the conditions of weights that stay."""
    _, n, p = noise.dJ.shape
    return _open(np.zeros((n, p)), np.eye(n), np.zeros(noise.J.shape))


def optimal_weights(point: SecondOrder, a: Floats, noise: Noise) -> Conditions:
    """Return the conditions of w = a / J."""
    second = a / point.at.J**2
    return _open(second[:, None] * point.at.dJ, np.eye(a.size), -second * noise.J)


def level(point: SecondOrder, objective: int, dv: Floats, noise: Noise) -> Conditions:
    """Return the conditions of the least of the others at J_objective = v; dv is (sources,)."""
    at = np.arange(point.at.J.size) == objective
    f = np.zeros(noise.J.shape)
    f[:, objective] = dv - noise.J[:, objective]
    return _open(at[:, None] * point.at.dJ, np.diag(~at).astype(float), f)


def boundary(
    point: SecondOrder, w: Floats, E: Floats, dE: Floats, noise: Noise
) -> tuple[Floats, Conditions]:
    """Return the weights in their right size and the conditions of a point of NBI.

    ``E`` (n, n) are the objectives of the edges, one column an edge, ``dE`` (sources, n, n) their
    changes. Raises LinAlgError where the edges do not span a simplex.
    """
    n = len(E)
    utopia = np.diag(E)
    P = E - utopia[:, None]
    shifted = np.linalg.solve(P, point.at.J - utopia)  # beta - t e
    dutopia = np.einsum("mii->mi", dE)
    dP = dE - dutopia[:, :, None]
    normal = P.sum(axis=1)
    w = w / (w @ normal)
    f = dutopia - noise.J + dP @ shifted
    return w, Conditions(
        point.at.dJ,
        np.zeros((n, n)),
        normal[:, None],
        f,
        normal[:, None],
        -(dP.sum(axis=2) @ w)[:, None],
    )


def scatter(
    problem: Problem, point: SecondOrder, w: Floats, conditions: Conditions, noise: Noise
) -> Scatter:
    """Return how a solution with weights w (n,) moves with the errors of the data."""
    at, span = point.at, problem.upper - problem.lower
    held = held_at_bounds(problem, point, w)
    Q, free = spaces(problem, point, w, held)
    B = span[:, None] * Q  # parameters for unit changes of what is determined
    dJ = at.dJ @ B
    W = B.T @ np.tensordot(w, point.H, axes=1) @ B
    c = conditions
    k = c.e.shape[1]
    q = Q.shape[1]
    system = np.block(
        [
            [W, dJ.T, np.zeros((q, k))],
            [c.C @ B, c.D, c.e],
            [np.zeros((k, q)), c.g.T, np.zeros((k, k))],
        ]
    )
    right = np.hstack([-(np.einsum("mnp,n->mp", noise.dJ, w) @ B), c.f, c.h])
    changes = _solve_scaled(system, right.T)[:q].T @ B.T
    return Scatter(changes, noise.J + changes @ at.dJ.T, held, span[:, None] * free)


def _solve_scaled(A: Floats, b: Floats) -> Floats:
    """Solve A x = b with the rows and columns of A brought to size one."""
    rows = np.abs(A).max(axis=1, initial=0.0)
    rows = np.where(rows > 0, rows, 1.0)
    scaled = A / rows[:, None]
    columns = np.abs(scaled).max(axis=0, initial=0.0)
    columns = np.where(columns > 0, columns, 1.0)
    x = scipy.linalg.lstsq(scaled / columns, b / rows[:, None], cond=1e-14)[0]
    return np.asarray(x / columns[:, None])
