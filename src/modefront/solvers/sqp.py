r"""Sequential quadratic programming with exact gradients and a Hessian that is learned.

Solves :math:`\min f(J(\theta))` subject to :math:`A J(\theta) = b` and bounds, for any member of
`modefront.solvers.scalarisation`. With multipliers :math:`\lambda` and the weights

.. math:: w = \partial f / \partial J + A^T \lambda

of the objectives, the Hessian of the Lagrangian is

.. math:: B = \sum_i w_i (H_i + S_i) + \partial J^T f'' \partial J

where :math:`H_i` is the known part (Gauss-Newton's) and :math:`S_i` the rest, learned from
differences of gradients (symmetric rank one, Conn, Gould & Toint 1991). Because S belongs to
the objectives and not to the programme, it carries over from one programme to its neighbour: that
is what makes the second point of a front cheaper than the first. Where residuals vanish, S is a
burden: it is sized down as they do, and B is taken with it or without it, whichever predicted the
last step better (Dennis, Gay & Welsch 1981, doi:10.1145/355958.355965).

Steps solve a quadratic programme within a box, the trust region; they are judged by the augmented
Lagrangian

.. math:: f + \lambda^T c + \tfrac\nu2 \|c\|^2, \qquad c = A J - b,

which, unlike an exact penalty, does not reject good steps near the solution. Far from it,
multipliers may be absurd: they are bounded, and a step that leaves the constraints by much more
than the start did is shortened. A stationary point with clearly negative curvature is tried to be
left once.

Where parameters outnumber data, minima lie in valleys that bend, and a step along the valley ends
on its slope: residuals change by :math:`\tfrac12 s^T \partial^2 r\, s`, which no step of any length
worth making survives. A poor step of a slow solution is therefore corrected: with the derivatives
at its end, the shortest second step brings the residuals to what the first one had predicted,

.. math:: \partial r(\theta + s)\, s_2 = r(\theta) + \partial r(\theta)\, s - r(\theta + s) ,

in the least-squares sense, the residuals of each objective times the root of its weight, and
together with the constraints (a second-order correction; Nocedal & Wright, *Numerical
Optimization*, 2006, section 15.6, where it is for constraints alone). Both steps are judged as one.

Variables are :math:`u = (\theta - lower) / (upper - lower)`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
import scipy.linalg

from modefront._typing import Floats
from modefront.solvers.problem import Evaluation, Problem, Residual
from modefront.solvers.qp import solve_qp
from modefront.solvers.scalarisation import Scalarisation
from modefront.work.codec import record

SADDLE = 1e-3
"""Negative curvature, over the greatest one, above which a stationary point is left again."""

PENALTY = 10.0
"""Weight of the constraints in the augmented Lagrangian, at least."""

FUNNEL = 10.0
"""Growth of the violation of the start, up to which a step is judged; 1 is always allowed."""

STEEP = 1e6
"""Greatest multiplier of a constraint, with objective and constraints in their own units."""

SWITCH = 0.5
"""Share of the error of a prediction, below which the other model is the better one."""

FREE = 1e-4
"""Gradient, over the greatest curvature, below which a bound does not hold a variable."""

PATIENCE = 30
"""Iterations in which the violation of the constraints is to be halved, from the worst of these, or
there is no way."""

CORRECTIONS, POOR, CUT = 2, 0.5, 1e-4
"""Corrections of a step at most; share of the predicted reduction below which a step is corrected;
least singular value, over the greatest, along which it is."""

SLOW = 10
"""Iterations after which a solution counts as slow, and its steps are corrected."""

NOISE = 1e-11
"""Relative error of the objectives that a step is not blamed for: that of a large eigenproblem."""


@record
class Status(Enum):
    """How a solution ended; the value says what it means and what to do about it."""

    CONVERGED = "converged"
    STALLED = (
        "no step improves it further: the constraints cannot be met from there, the objectives are "
        "not smooth, or bounds conflict"
    )
    UNBOUNDED = "what is minimised falls without bound: an objective vanishes"
    EXHAUSTED = "the limit of iterations was reached: more iterations, or another start"
    SAMPLED = "the method has no tolerance: more evaluations, or normal-boundary intersection"
    GIVEN = "a model that was given, not sought"
    INFEASIBLE = "the model cannot be evaluated at the start: narrower bounds, or another start"


@dataclass(frozen=True)
class Options:
    """Tolerances, relative to the range of the parameters and to the scale of the constraints.

    Without ``learn``, only the known part of the second derivatives is used: slower, but its null
    space is exact where the objectives do not change at all in some direction.
    """

    step: float = 1e-7
    constraint: float = 1e-7
    reduction: float = 1e-14
    iterations: int = 100
    radius: float = 0.15
    learn: bool = True


@record
@dataclass(frozen=True)
class Solution:
    """A solution of one programme.

    Attributes
    ----------
    at : the objectives and their derivatives there
    learned : (n, p, p) learned part S of the second derivatives, for the next programme
    weights : (n,) weights w of the objectives at which it is stationary
    violation : greatest violation of the constraints
    status : how it ended
    evaluations : evaluations that it took
    beta : (n,) the point of the simplex that it was projected from, by normal-boundary
        intersection; None of another programme
    """

    at: Evaluation
    learned: Floats
    weights: Floats
    violation: float
    status: Status
    evaluations: int
    beta: Floats | None = None

    @property
    def converged(self) -> bool:
        """Whether the tolerances were met, or none apply."""
        return self.status in (Status.CONVERGED, Status.GIVEN)


def given(at: Evaluation) -> Solution:
    """Return the solution that a given model is."""
    return replace(begin(at), status=Status.GIVEN, violation=0.0)


def begin(at: Evaluation) -> Solution:
    """Return a start for `solve` from an evaluation."""
    n, p = at.J.size, at.theta.size
    status = Status.EXHAUSTED if at.feasible else Status.INFEASIBLE
    return Solution(at, np.zeros((n, p, p)), np.zeros(n), np.inf, status, 0)


def solve(
    problem: Problem, programme: Scalarisation, start: Solution, options: Options | None = None
) -> Solution:
    """Solve a programme from the point at which ``start`` ended, with what was learned there.

    The start itself is not evaluated again. Steps to points at which the objectives are not
    defined are shortened.
    """
    options = options or Options()
    if not start.at.feasible:
        return replace(start, status=Status.INFEASIBLE, evaluations=0)
    span = problem.upper - problem.lower
    learned = start.learned if options.learn else np.zeros_like(start.learned)
    state = State(start.at, learned)
    trusted = bool(learned.any())
    radius, penalty = options.radius, PENALTY
    multipliers: Floats | None = None
    escaped, proposed, worst, failed = False, np.inf, np.inf, 0
    farthest = max(1.0, FUNNEL * _length(programme.A @ start.at.J - programme.b))
    for count in range(options.iterations + 1):
        at = state.at
        value, df, A = programme.value(at.J), programme.gradient(at.J), programme.A
        if value == -np.inf:
            return Solution(at, state.learned, df, 0.0, Status.UNBOUNDED, count)
        c = A @ at.J - programme.b
        dJ = at.dJ * span
        g, dc = df @ dJ, A @ dJ
        lo = np.maximum((problem.lower - at.theta) / span, -radius)
        hi = np.minimum((problem.upper - at.theta) / span, radius)
        most = STEEP * float(np.abs(df).max()) / float(np.abs(A).max(initial=np.finfo(float).tiny))
        if multipliers is None:
            multipliers = _multipliers(dc, g, lo, hi, most)
        w = df + A.T @ multipliers
        H = at.H + state.learned if trusted else at.H
        B = np.tensordot(w, H, axes=1) * np.outer(span, span)
        B += dJ.T @ programme.hessian(at.J) @ dJ
        s = solve_qp(B, g, dc, -c, lo, hi)
        multipliers = _multipliers(dc, g + B @ s, lo - s, hi - s, most)
        w = df + A.T @ multipliers

        if _length(s) < 0.99 * radius:
            proposed = _length(s)
        violation = _length(c)
        worst = max(worst, violation)
        if count % PATIENCE == 0:
            if violation > max(options.constraint, 0.5 * worst) and count > 0:
                return Solution(at, state.learned, w, violation, Status.STALLED, count)
            worst = violation
        still = _length(s) <= options.step or bool(abs(g @ s) <= options.reduction * abs(value))
        if still and violation <= options.constraint and not escaped:
            escaped, s = True, _off_the_saddle(B, g + multipliers @ dc, dc, lo, hi)
            still = not s.any()
        if still and violation <= options.constraint:
            return Solution(at, state.learned, w, violation, Status.CONVERGED, count)
        if _length(s) <= np.finfo(float).eps or radius <= options.step * 1e-3:
            # Steps that were not held back were below the tolerance: rounding of J stops it here.
            there = proposed <= options.step and violation <= 10 * options.constraint
            status = Status.CONVERGED if there else Status.STALLED
            return Solution(at, state.learned, w, violation, status, count)
        if count == options.iterations:
            break

        after = c + dc @ s
        gain = -(g + multipliers @ dc) @ s - 0.5 * s @ B @ s
        drop = 0.5 * (c @ c - after @ after)
        if drop > 0:
            penalty = max(PENALTY, 0.1 * penalty, float(-2 * gain / drop))
        predicted = gain + penalty * drop
        new = problem.evaluate(np.clip(at.theta + s * span, problem.lower, problem.upper))
        if not new.feasible:
            radius = _length(s) / 4
            continue

        merit = _Merit(programme, multipliers, penalty)
        actual = merit.at(at) - merit.at(new)
        rows = _Rows(programme, w, penalty, span)
        for _ in range(CORRECTIONS):
            if not at.residuals or count < SLOW or failed > 1 or actual > POOR * predicted:
                break
            theta = rows.corrected(problem, at, s, new)
            corrected = None if theta is None else problem.evaluate(theta)
            if corrected is None or not merit.at(corrected) < merit.at(new):
                failed += 1
                break
            new, actual, failed = corrected, merit.at(at) - merit.at(corrected), 0
        if _length(programme.A @ new.J - programme.b) > farthest:
            radius = _length(s) / 4
            continue
        unsaid = 0.5 * w @ (state.learned @ (s * span) @ (s * span)) * (1 if trusted else -1)
        if abs(actual - predicted - unsaid) < SWITCH * abs(actual - predicted):
            trusted = not trusted
        noise = NOISE * (abs(value) + np.abs(multipliers) @ np.abs(programme.A @ at.J))
        ratio = (actual + noise) / (predicted + noise) if predicted > -noise else -1.0
        if options.learn:
            state = state.learn(new)
        if ratio > 1e-4:
            state = replace(state, at=new)
        if ratio < 0.25:
            radius = _length(s) / (4 if ratio < 1e-4 else 2)
        elif ratio > 0.7 and _length(s) > 0.9 * radius:
            radius = min(2 * radius, 1.0)
    return Solution(state.at, state.learned, w, violation, Status.EXHAUSTED, options.iterations)


@dataclass(frozen=True)
class _Merit:
    """The augmented Lagrangian."""

    programme: Scalarisation
    multipliers: Floats
    penalty: float

    def at(self, point: Evaluation) -> float:
        """Return its value; infinite where the objectives are not defined."""
        if not point.feasible:
            return np.inf
        c = self.programme.A @ point.J - self.programme.b
        return float(
            self.programme.value(point.J) + self.multipliers @ c + 0.5 * self.penalty * (c @ c)
        )


@dataclass(frozen=True)
class _Rows:
    """The residuals of the objectives, times the roots of their weights, and the constraints."""

    programme: Scalarisation
    w: Floats
    penalty: float
    span: Floats

    def corrected(
        self, problem: Problem, at: Evaluation, s: Floats, new: Evaluation
    ) -> Floats | None:
        """Return parameters near a new point whose rows are as they were predicted for the step.

        The correction is the shortest one, within the bounds; None where none is of any use.
        """
        before, after = self._of(at), self._of(new)
        miss = after.r - (before.r + before.dr @ s)
        taken = (new.theta - at.theta) / self.span
        free = (new.theta > problem.lower) & (new.theta < problem.upper)
        free |= np.abs(s) == 0
        step = np.zeros(s.size)
        step[free] = np.linalg.lstsq(after.dr[:, free], -miss, rcond=CUT)[0]
        if _length(step) > _length(taken):
            return None
        return np.clip(new.theta + step * self.span, problem.lower, problem.upper)

    def _of(self, at: Evaluation) -> Residual:
        roots = np.sqrt(np.maximum(self.w, 0.0))
        A, hold = self.programme.A, np.sqrt(self.penalty)
        pairs = list(zip(roots.tolist(), at.residuals, strict=True))
        return Residual(
            np.concatenate([*(x * own.r for x, own in pairs), hold * (A @ at.J)]),
            np.vstack([*(x * own.dr for x, own in pairs), hold * (A @ at.dJ)]) * self.span,
        )


def _length(s: Floats) -> float:
    return float(np.max(np.abs(s), initial=0.0))


def _off_the_saddle(B: Floats, g: Floats, dc: Floats, lo: Floats, hi: Floats) -> Floats:
    """Return a step along clearly negative curvature within the constraints, or zeros.

    ``g`` is the gradient of the Lagrangian: a variable at a bound that it does not hold there is
    as free as those within.
    """
    s = np.zeros(g.size)
    flat = np.abs(g) <= FREE * np.abs(B).max()
    free = ((lo < 0) & (hi > 0)) | (flat & (lo < hi))
    Z = scipy.linalg.null_space(dc[:, free]) if dc.size else np.eye(int(free.sum()))
    if Z.shape[1] == 0:
        return s
    curvature, V = np.linalg.eigh(Z.T @ B[np.ix_(free, free)] @ Z)
    if curvature[0] < -SADDLE * np.abs(curvature).max():
        v = Z @ V[:, 0]
        v[np.abs(v) < FREE] = 0.0
        v *= -1.0 if g[free] @ v > 0 else 1.0
        there, back = (
            way * np.min(room[way != 0] / way[way != 0])
            for way, room in _ways(v, lo[free], hi[free])
        )
        s[free] = 0.5 * (there if there.any() else back)
    return s


def _ways(v: Floats, lo: Floats, hi: Floats) -> list[tuple[Floats, Floats]]:
    """Return a direction and its opposite, each with the room that the box leaves it."""
    return [(way, np.where(way > 0, hi, lo)) for way in (v, -v)]


@dataclass(frozen=True)
class State:
    """The point reached and what has been learned of the second derivatives (n, p, p)."""

    at: Evaluation
    learned: Floats

    def learn(self, new: Evaluation) -> State:
        """Return the state with what an evaluation tells of the second derivatives.

        What was known is sized before it is corrected, by s^T y / s^T S s where that is below 1,
        so that it vanishes with the residuals.
        """
        s = new.theta - self.at.theta
        unknown = new.dJ - self.at.dJ - new.H @ s
        claimed = np.abs(self.learned @ s @ s)
        size = np.minimum(np.abs(unknown @ s), claimed) / np.where(claimed > 0, claimed, 1.0)
        known = size[:, None, None] * self.learned
        v = unknown - known @ s
        along = v @ s
        sure = np.abs(along) > 1e-6 * np.linalg.norm(v, axis=1) * np.linalg.norm(s)
        scale = np.where(sure, 1 / np.where(sure, along, 1.0), 0.0)
        learned = known + scale[:, None, None] * v[:, :, None] * v[:, None, :]
        return State(self.at, learned)


def _multipliers(dc: Floats, g: Floats, lo: Floats, hi: Floats, most: float) -> Floats:
    """Return the multipliers for which g + dc^T lambda is least on the variables within bounds.

    Where the constraints hardly depend on those, they say nothing, and ``most`` bounds them.
    """
    free = (lo < 0) & (hi > 0)
    found = np.linalg.lstsq(dc[:, free].T, -g[free], rcond=None)[0]
    return np.asarray(np.clip(found, -most, most))
