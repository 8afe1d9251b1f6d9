r"""Scatter of the solution of a programme by errors of the data: the implicit function theorem.

docs/uncertainty.md derives it from the conditions of Karush, Kuhn and Tucker (Fiacco 1983,
*Introduction to Sensitivity and Stability Analysis in Nonlinear Programming*, section 2.4). There
are conditions of each programme on w besides. Of a point of NBI,
:math:`J_A = (J^* + P (\beta + \tau e))_A` on the active bounds A, with :math:`n = P e` and
:math:`w_A^T n_A = 1`, and :math:`w_i = \rho / n_i` elsewhere; with the edges E as columns,
:math:`J^* = \operatorname{diag} E` and :math:`P = E - J^* e^T`.

A parameter at an active bound is fixed. Directions in which no residual changes are left out and
named. Reasons to doubt the linearisation are returned: an active set that changes, or another
minimum that becomes the better one, within a standard deviation.

The optimally weighted model is the peak of the posterior with Jeffreys' prior of the variances of
the errors (compare Christodoulou & Papadimitriou 2007, Mechanical Systems and Signal Processing 21,
4-23); docs/uncertainty.md has its covariance by Laplace's approximation.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
import scipy.linalg

from modefront._typing import Bools, Floats
from modefront.front.front import Front
from modefront.front.subproblems import RHO, active_bounds
from modefront.optim.problem import AT_BOUND, Evaluation, Problem
from modefront.optim.scalarisation import LogSum, Scalarisation, weighted
from modefront.rounding import TINY
from modefront.uncertainty.noise import Noise
from modefront.uncertainty.points import SolvedPoint, edge_weights, in_order
from modefront.work.codec import record

FLAT = 1e-12  # eigenvalue over the greatest one below which a direction changes no residual

BENT = 1e-5
"""Second derivative over the greatest one below which it is none: a distance of the solution of
1e-7 leaves less, and so do differences."""

DEPENDENT = 1e-14  # singular value, over the greatest, of scaled equations that is rounding
PRESSED = 1e-6  # least slope of the Lagrangian at a bound that holds, over those of its terms


class LinearisationWarning(Enum):
    """Reason why the linearised scatter of a point may not be valid."""

    SADDLE = "the second derivatives are not positive definite: the front folds or jumps there"
    MEETS = "a parameter reaches its bound within one standard deviation"
    LEAVES = "a parameter leaves its bound within one standard deviation"
    SWITCHES = "other groups determine the point within one standard deviation"
    ENDS = "a branch of the front ends within one standard deviation"
    RIVAL = "another minimum becomes better within one standard deviation"
    UNSOLVED = "the solution has not converged"


@dataclass(frozen=True)
class Conditions:
    """Conditions of a programme on the changes: C dtheta + D dw - e dtau = f, e^T dw = h."""

    C: Floats  # (n, p)
    D: Floats  # (n,) a diagonal of ones, and zeros for equations
    e: Floats  # (n, k) with k either 0 or 1
    f: Floats  # (sources, n)
    h: Floats  # (sources, k)
    # whether errors of one standard deviation change the active set; of dw, of the changes of J at
    # this solution's data, and of dtau
    switch: Callable[[Floats, Floats, Floats], bool] = lambda _, __, ___: False


def _open(C: Floats, D: Floats, f: Floats) -> Conditions:
    return Conditions(C, D, np.zeros((len(D), 0)), f, np.zeros((len(f), 0)))


def given_weights(noise: Noise) -> Conditions:
    """Return the conditions of weights that stay."""
    _, n, p = noise.dJ.shape
    return _open(np.zeros((n, p)), np.ones(n), np.zeros(noise.J.shape))


def optimal_weights(point: Evaluation, a: Floats, noise: Noise) -> Conditions:
    """Return the conditions of w = a / J."""
    second = a / point.J**2
    return _open(second[:, None] * point.dJ, np.ones(a.size), -second * noise.J)


def level(point: Evaluation, objective: int, dv: Floats, noise: Noise) -> Conditions:
    """Return the conditions of the least of the others at J_objective = v; dv is (sources,)."""
    is_held = np.arange(point.J.size) == objective
    f = np.zeros(noise.J.shape)
    f[:, objective] = dv - noise.J[:, objective]
    return _open(is_held[:, None] * point.dJ, (~is_held).astype(float), f)


# 8 arguments: those of the problem, and what is solved.
def boundary(
    point: Evaluation,
    w: Floats,
    E: Floats,
    dE: Floats,
    beta: Floats,
    noise: Noise,
    equations: bool = False,
    top: Floats | None = None,
) -> tuple[Floats, Conditions]:
    """Return the weights in their right size and the conditions of a point of NBI.

    ``E`` (n, n) has a column an edge, which changes by ``dE`` (sources, n, n). The point was
    projected from ``beta`` (n,) in their simplex, or that of the ranges up to ``top`` (n,), which
    stay, by the ``equations`` of Das & Dennis or with bounds.
    """
    utopia, dutopia = np.diag(E), np.einsum("mii->mi", dE)
    P, dP = E - utopia[:, None], dE - dutopia[:, :, None]
    if top is not None:
        P, dP = np.diag(top - utopia), -dutopia[:, :, None] * np.eye(top.size)
    n, dn = P.sum(axis=1), dP.sum(axis=2)
    active = np.ones(n.size, dtype=np.bool_) if equations else active_bounds(w * n)
    w = w / (w[active] @ n[active])
    above = point.J - utopia - P @ beta  # n c
    tau = float((above / n)[active].mean())
    moved = dutopia + dP @ (beta + tau) - noise.J
    f = np.where(active, moved, -RHO * dn / n**2)
    e = np.where(active, n, 0.0)[:, None]
    h = -(dn[:, active] @ w[active])[:, None]
    slack = tau * n - above

    def switch(dw: Floats, dJ: Floats, dtau: Floats) -> bool:
        hardly = w * n - RHO <= np.linalg.norm(dw * n + w * dn, axis=0)
        close = slack <= np.linalg.norm(moved - dJ + dtau * n, axis=0)
        return bool(np.where(active, hardly, close).any())

    fixed = {} if equations else {"switch": switch}
    return w, Conditions(active[:, None] * point.dJ, (~active).astype(float), e, f, h, **fixed)


@dataclass(frozen=True)
class Scatter:
    """Changes of a solution by each source of error, of standard deviation one."""

    theta: Floats  # (sources, p) changes of the parameters
    J: Floats  # (sources, n) changes of the objectives at the solution, of its own data
    free: Floats  # (p, d) directions over the ranges that no data determine, orthonormal
    warnings: tuple[LinearisationWarning, ...]  # reasons why the linearisation may not be valid

    @property
    def covariance(self) -> Floats:
        """Covariance of the parameters, (p, p), without the directions that are free."""
        return self.theta.T @ self.theta


def spaces(problem: Problem, evaluation: Evaluation, w: Floats) -> tuple[Bools, Floats, Floats]:
    """Return which parameters the slope of w^T J presses against a bound, and bases (p, .).

    The bases are over the ranges: of what residuals determine, and of what is free. Free is where
    no residual changes to first order and their squares do not to second order.
    """
    area = np.multiply.outer(span := problem.upper - problem.lower, span)
    G, B = evaluation.gauss_newton, np.tensordot(np.abs(w), evaluation.H, axes=1) * area
    u = (evaluation.theta - problem.lower) / span
    parts, slope = np.abs(w[:, None] * evaluation.dJ) * span, w @ evaluation.dJ * span
    pressed = np.abs(slope) > PRESSED * (parts.sum(axis=0).max() + np.abs(B).max())
    held = pressed & np.where(slope > 0, u <= AT_BOUND, u >= 1 - AT_BOUND)
    top = np.abs(G).max(axis=(1, 2))
    G = np.tensordot(1 / np.where(top > 0, top, 1.0), G, axes=1) * area
    basis = np.eye(held.size)[:, ~held]
    lam, V = np.linalg.eigh(basis.T @ G @ basis)
    basis, flat = basis @ V, lam <= FLAT * max(float(lam.max(initial=0.0)), TINY)
    N = basis[:, flat]
    mu, U = np.linalg.eigh(N.T @ B @ N)
    bent = np.abs(mu) > BENT * np.abs(B).max()
    return held, np.hstack([basis[:, ~flat], N @ U[:, bent]]), N @ U[:, ~bent]


def scatter(
    problem: Problem, evaluation: Evaluation, w: Floats, conditions: Conditions, noise: Noise
) -> Scatter:
    """Return how a solution with weights w (n,), and second derivatives, moves with the data."""
    span = problem.upper - problem.lower
    held, Q, free = spaces(problem, evaluation, w)
    B = span[:, None] * Q  # parameters for unit changes of what is determined
    dJ = evaluation.dJ @ B
    second = np.tensordot(w, evaluation.H, axes=1)
    W, c = B.T @ second @ B, conditions
    (n, k), q = c.e.shape, Q.shape[1]
    system = np.block(
        [
            [W, dJ.T, np.zeros((q, k))],
            [c.C @ B, np.diag(c.D), -c.e],
            [np.zeros((k, q)), c.e.T, np.zeros((k, k))],
        ]
    )
    slope = np.einsum("mnp,n->mp", noise.dJ, w)
    x = _solve_scaled(system, np.hstack([-slope @ B, c.f, c.h]).T).T
    theta, dw, dtau = x[:, :q] @ B.T, x[:, q : q + n], x[:, q + n :]
    J = noise.J + theta @ evaluation.dJ.T
    slope = (slope + theta @ second + dw @ evaluation.dJ) * span
    room = np.minimum(evaluation.theta - problem.lower, problem.upper - evaluation.theta)
    reach = np.linalg.norm(theta, axis=0)
    leaves = np.abs(w @ evaluation.dJ * span) <= np.linalg.norm(slope, axis=0)
    holds = {
        LinearisationWarning.SADDLE: not _is_minimum(W, c.C @ B, dJ, c),
        LinearisationWarning.MEETS: ((room < reach) & (reach > 0) & ~held).any(),
        LinearisationWarning.LEAVES: leaves[held].any(),
        LinearisationWarning.SWITCHES: c.switch(dw, theta @ evaluation.dJ.T, dtau),
    }
    return Scatter(theta, J, free, tuple(x for x in holds if holds[x]))


def _is_minimum(W: Floats, C: Floats, dJ: Floats, c: Conditions) -> bool:
    """Return whether second derivatives are positive along all that equations leave open.

    Weights that follow the solution, dw = f - C dtheta, bring those of f with them.
    """
    if len(W) == 0:
        return True
    equations = c.D == 0
    L = W - dJ[~equations].T @ C[~equations]
    Z = np.eye(len(W))
    if equations.any():
        rows = np.hstack([C, c.e])[equations]
        rows = rows / np.linalg.norm(rows, axis=1, keepdims=True)
        C, e = rows[:, : len(W)], rows[:, len(W) :]
        Z = scipy.linalg.null_space(scipy.linalg.null_space(e.T).T @ C if e.size else C)
    return bool((np.linalg.eigvalsh(Z.T @ (L + L.T) @ Z) > 0).all())


def _solve_scaled(A: Floats, b: Floats) -> Floats:
    """Solve A x = b with the rows and columns of A brought to size one."""
    rows = np.abs(A).max(axis=1, initial=0.0, keepdims=True)
    rows = np.where(rows > 0, rows, 1.0)
    columns = np.abs(A / rows).max(axis=0, initial=0.0)
    columns = np.where(columns > 0, columns, 1.0)
    x = scipy.linalg.lstsq(A / rows / columns, b / rows, cond=DEPENDENT)[0]
    return np.asarray(x / columns[:, None])


@record
@dataclass(frozen=True)
class Local:
    """What the scatter of a point follows from."""

    evaluation: Evaluation  # with second derivatives
    noise: Noise  # of its objectives
    slopes: Mapping[str, Floats]  # derivatives (modes, p) of predicted quantities


# 6 arguments: the front, its points, and what is known of them.
def front_scatter(
    problem: Problem,
    front: Front,
    points: Sequence[SolvedPoint],
    known: Mapping[str, Local],
    a: Floats,
    sizes: Floats,
) -> dict[str, Scatter]:
    """Return the scatter of the points for which it is defined, by label.

    It is not where the solver knows no weights: objectives jump there, or a search ended before.
    """
    level_of: dict[int, Floats] = {}  # changes of the least value of each objective
    ends: dict[str, tuple[Floats, Floats]] = {}
    out: dict[str, Scatter] = {}
    conditions: Conditions
    for solved in in_order(points):
        role, text, w = solved.role, solved.label, solved.solution.weights
        beta = solved.solution.beta
        if role.kind == "end" and role.ends[0] in out:
            out[text] = out[role.ends[0]]
        if text not in known:
            continue
        point, noise = known[text].evaluation, known[text].noise
        match role.kind:
            case "edge":
                w, conditions = edge_weights(role.objective, sizes), given_weights(noise)
            case "weights" if w.any():
                conditions = given_weights(noise)
            case "optimal":
                w, conditions = a / point.J, optimal_weights(point, a, noise)
            case "level" if role.objective in level_of:
                dv = (1 + role.tolerance) * level_of[role.objective]
                conditions = level(point, role.objective, dv, noise)
            case "boundary" if beta is not None and w.any() and {*role.ends} <= set(ends):
                E = np.array([ends[label][0] for label in role.ends]).T
                dE = np.stack([ends[label][1] for label in role.ends], axis=2)
                top = np.array([x.J[i] for i, x in enumerate(role.worst)]) if role.worst else None
                w, conditions = boundary(point, w, E, dE, beta, noise, role.equations, top)
            case _:
                continue
        found = scatter(problem, point, w, conditions, noise)
        warnings = (*found.warnings, *doubts(front, solved, found, a, sizes))
        out[text] = replace(found, warnings=warnings)
        ends[text] = point.J, out[text].J
        if role.kind == "edge":
            level_of[role.objective] = out[text].J[:, role.objective]
    return out


def doubts(
    front: Front, point: SolvedPoint, scatter: Scatter, a: Floats, sizes: Floats
) -> Iterator[LinearisationWarning]:
    """Yield the warnings that other models of the front raise, and a search that has not ended."""
    J, kind = point.solution.J, point.role.kind
    reach = np.linalg.norm(scatter.J, axis=0)
    ends = [end.J for gap in front.gaps for end in gap.ends]
    if kind == "boundary" and any((np.abs(J - end) <= reach).all() for end in ends):
        yield LinearisationWarning.ENDS
    programme: Scalarisation = LogSum(a)
    others = front.optimal[1:] if kind == "optimal" else []
    if kind == "edge":
        i = point.role.objective
        programme, others = weighted(edge_weights(i, sizes)), front.edges[i].minima[1:]
    if others:
        rise = float(np.linalg.norm(scatter.J @ programme.gradient(J)))
        if any(programme.value(x.J) - programme.value(J) <= rise for x in others):
            yield LinearisationWarning.RIVAL
    if not point.solution.converged:
        yield LinearisationWarning.UNSOLVED


@dataclass(frozen=True)
class Posterior:
    """A Gaussian approximation around the most probable model."""

    axes: Floats  # (p, m) principal axes, one standard deviation long
    held: Bools  # (p,) parameters that a bound holds
    free: Floats  # (p, d) directions over the ranges that keep their prior, orthonormal

    @property
    def covariance(self) -> Floats:
        """Covariance (p, p) of the parameters; 0 for those that are held."""
        return self.axes @ self.axes.T


def laplace(problem: Problem, evaluation: Evaluation, a: Floats) -> Posterior | None:
    """Return the posterior around a minimum of sum a ln J; ``a`` (n,) counts the properties.

    The evaluation has second derivatives. None where the point is no regular minimum: an objective
    vanishes, or the curvature is not positive in all directions that residuals determine.
    """
    J, span = evaluation.J, problem.upper - problem.lower
    if not (J > 0).all():
        return None
    w = a / J
    held, Q, free = spaces(problem, evaluation, w)
    B = span[:, None] * Q
    of_weights = evaluation.dJ.T @ ((a / J**2)[:, None] * evaluation.dJ)
    half = B.T @ (np.tensordot(w, evaluation.H, axes=1) - of_weights) @ B / 2
    lam, V = np.linalg.eigh(half)
    if lam.size and lam[0] <= 0:
        return None
    return Posterior(B @ V / np.sqrt(lam), held, free)
