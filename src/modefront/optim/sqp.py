r"""Sequential quadratic programming with exact first and second derivatives.

Solves :math:`\min f(J(\theta)) + \max_i\,(C J(\theta) - d)_i` subject to bounds, for any member of
`modefront.optim.scalarisation`. With multipliers :math:`\kappa` of the functions of which the
maximum counts, the weights w of the objectives and the Hessian of the Lagrangian are

.. math:: w = \partial f / \partial J + C^T \kappa, \qquad
    B = \sum_i w_i H_i + \partial J^T f'' \partial J .

:math:`H_i` is taken with or without the part S besides Gauss-Newton's, whichever predicted the last
step better. What a problem does not know of S is learned: a step s tells that

.. math:: S s = y, \qquad y = \partial J(\theta + s) - \partial J(\theta) - H(\theta + s)\, s .

The least symmetric change makes it so (Powell's; Dennis & Schnabel, *Numerical Methods for
Unconstrained Optimization*, 1983, section 9.2). Before, S is sized, as it vanishes with the
residuals (Dennis, Gay & Welsch 1981, doi:10.1145/355958.355965), unless H knows nothing.

Steps solve a quadratic programme within a box, the trust region (`modefront.optim.qp`), and are
judged by the augmented Lagrangian (`modefront.optim.linearised`, which has the other symbols). In a
curved valley a long step ends on its side, from where another one leads to the floor, far ahead:
where a step is poor, but the derivatives at its end promise that, the two are judged as one (the
watchdog; Nocedal & Wright 2006, section 15.6). One attempt is made to leave a stationary point with
clearly negative curvature.
"""

from dataclasses import dataclass, replace
from enum import Enum
from functools import partial

import numpy as np
import scipy.linalg

from modefront._typing import Floats
from modefront.optim.linearised import PENALTY, Linearised, UnitBox, augmented
from modefront.optim.problem import DISTINCT, Evaluation, Problem, room, without_jump
from modefront.optim.qp import QuadraticProgramme
from modefront.optim.scalarisation import LEAST, MARGIN, Constrained, Scalarisation, total
from modefront.work.codec import record
from modefront.work.progress import ITERATION, note

POOR, GOOD = 0.25, 0.7
"""Actual over predicted reduction below which the next step is shorter, and above which it may be
longer: the usual values (Nocedal & Wright, *Numerical Optimization*, 2006, algorithm 4.1). Any
reduction is taken, as a derivative costs as much."""

SADDLE = 1e-3
"""Curvature, over the greatest one, that is clearly some: where it is negative, a stationary point
is left again. A bound does not hold a variable up to that slope on the way."""


@record
class Status(Enum):
    """How a solution ended; the value says what it means and what to do about it."""

    CONVERGED = "converged"
    STALLED = "no step leads to a model that meets the equations of the point: another start"
    JUMP = (
        "no step improves it, however short: the objectives or their slopes jump there, or end, as "
        "where a measured mode is paired with another mode of the model"
    )
    UNBOUNDED = "what is minimised falls without bound: an objective vanishes"
    EXHAUSTED = "the limit of iterations was reached: more iterations, or another start"
    SAMPLED = "the method has no tolerance: more evaluations, or normal-boundary intersection"
    GIVEN = "a model that was given, not sought"
    INFEASIBLE = "the model cannot be evaluated at the start: narrower bounds, or another start"


@dataclass(frozen=True)
class Options:
    """Tolerances, relative to the range of the parameters and to what is minimised.

    A value of a programme without a maximum below ``negligible`` is as good as any.
    """

    step: float = 1e-7
    reduction: float = 1e-14
    iterations: int = 100
    radius: float = 0.15
    negligible: float = -np.inf


TIGHT = Options(reduction=1e-17)
"""Steps end at the tolerance of the parameters, whatever f: a sum of logarithms has any size."""


@record
@dataclass(frozen=True)
class Solution:
    """A solution of one programme."""

    evaluation: Evaluation  # of the model that it is
    weights: Floats  # (n,) weights w of the objectives at which it is stationary
    status: Status  # how it ended
    evaluations: int  # evaluations that it took
    # (n,) the point of the simplex that it was projected from, by normal-boundary intersection;
    # None of another programme
    beta: Floats | None = None
    # of a lexicographic minimum, of the minimisers on the path to it: epsilon, what is minimised,
    # and the others in it, (., 3)
    path: Floats | None = None

    @property
    def theta(self) -> Floats:
        """Parameters, shape (p,)."""
        return self.evaluation.theta

    @property
    def J(self) -> Floats:
        """Objectives, shape (n,)."""
        return self.evaluation.J

    @property
    def feasible(self) -> bool:
        """Whether the objectives are defined."""
        return self.evaluation.feasible

    @property
    def converged(self) -> bool:
        """Whether the tolerances were met as far as rounding allows, or none apply."""
        return self.status in (Status.CONVERGED, Status.GIVEN)


def given(evaluation: Evaluation) -> Solution:
    """Return the solution that a given model is."""
    return replace(begin(evaluation), status=Status.GIVEN)


def begin(evaluation: Evaluation) -> Solution:
    """Return a start for `solve` from an evaluation."""
    status = Status.EXHAUSTED if evaluation.feasible else Status.INFEASIBLE
    return Solution(evaluation, np.zeros(evaluation.J.size), status, 0)


def solve(
    problem: Problem,
    programme: Scalarisation,
    start: Solution,
    options: Options | None = None,
    known: Solution | None = None,
) -> Solution:
    """Solve a programme from the point at which ``start`` ended.

    The start itself is not evaluated again where its second derivatives are known. Steps to points
    at which the objectives are not defined are shortened. A step to a ``known`` solution is not
    made: that is what the start leads to. Where objectives jump, the programme is solved along the
    jump, and then from there, as long as it gains.
    """
    options = options or Options()
    known = known if known and known.converged else None
    if not start.feasible:
        return replace(start, status=Status.INFEASIBLE, evaluations=0)
    best, jump = _descend(problem, programme, start, options, known)
    while jump is not None:
        end = jump.along(programme, best)
        gains = end.feasible and total(programme, end.J) < total(programme, best.J)
        spent = best.evaluations + end.evaluations
        if not gains or end.status is Status.JUMP:
            return replace(end if gains else best, evaluations=spent)
        here = best
        best, jump = _descend(problem, programme, end, options, known)
        best = replace(best, evaluations=spent + best.evaluations)
        if np.abs((best.theta - here.theta) / (problem.upper - problem.lower)).max() <= DISTINCT:
            break
    return best


@dataclass(frozen=True)
class _Jump:
    """A jump of the objectives of a problem, which a smooth one has not."""

    problem: Problem
    smooth: Problem
    start: Evaluation  # of the smooth one, next to the jump

    def along(self, programme: Scalarisation, here: Solution) -> Solution:
        """Return the best model along a jump from one next to it.

        Its status is `Status.JUMP` if it is stationary but for the jump. Where another one meets
        it, it is the best one along both.
        """
        slopes = self.start.dJ * (self.problem.upper - self.problem.lower)
        units = np.linalg.norm([here.weights @ slopes[:-1], slopes[-1]], axis=1)
        within = Constrained(programme, *np.maximum(units, LEAST).tolist())
        found, other = _descend(self.smooth, within, begin(self.start), Options())
        if other and -found.J[-1] <= 4 * DISTINCT * within.last:
            corner = other.along(within, found)
            found = replace(corner, evaluations=found.evaluations + corner.evaluations)
        end = self.problem.evaluate(found.theta, second=True)
        ended = found.status in (Status.CONVERGED, Status.JUMP)
        held = ended and abs(found.J[-1]) <= 2 * MARGIN * within.last
        status = Status.JUMP if held else Status.EXHAUSTED
        return Solution(end, found.weights[:-1] * within.unit, status, found.evaluations + 2)


def _jump(problem: Problem, here: Evaluation, beyond: Evaluation) -> _Jump | None:
    """Return the jump between two models next to each other, None where the problem knows none."""
    smooth = without_jump(problem, here, beyond)
    if smooth is None:
        return None
    start = smooth.evaluate(here.theta, second=True)
    slope = np.linalg.norm(start.dJ[-1] * (problem.upper - problem.lower))
    # The step that crossed it was shorter than that: the radius falls to a quarter of a step.
    is_near = slope > np.finfo(float).eps and -start.J[-1] <= 4 * DISTINCT * slope
    return _Jump(problem, smooth, start) if is_near else None


# More than 60 lines: one step, with all that it changes.
def _descend(
    problem: Problem,
    programme: Scalarisation,
    start: Solution,
    options: Options,
    known: Solution | None = None,
) -> tuple[Solution, _Jump | None]:
    """Return a solution by steps that fall, and the jump of the objectives that ends it, if any."""
    evaluation, count = start.evaluation, -1
    if not evaluation.derivatives:
        evaluation, count = problem.evaluate(evaluation.theta, second=True), 0
    unit = UnitBox(problem)
    local = Linearised(unit, programme, evaluation)
    S = local.x.H - local.G
    trusted, escaped = evaluation.exact, False
    radius, penalty = options.radius, PENALTY / programme.maximised.slope**2
    kappa: Floats | None = None
    rejected = False  # whether the last step was
    sought = False  # whether a jump was sought at this model
    proposal = np.inf  # length of the last step that the trust region did not hold back
    calm: tuple[float, Solution] | None = None  # where, and how long, steps promised only rounding
    while True:
        count += 1
        note(f"{ITERATION}{count + 1}")
        if not local.y.size and local.f <= options.negligible:
            ended = Status.UNBOUNDED if local.f == -np.inf else Status.CONVERGED
            return Solution(evaluation, local.df, ended, count), None
        H = local.G + S if trusted else local.G
        qp, s, active, kappa = local.step(H, radius, kappa)
        w = local.weights(kappa)
        far = float(np.abs(s).max())
        held = far >= radius
        proposal = proposal if held else far
        if known and not held:
            end = unit.after(evaluation.theta, s)
            if np.abs((end - known.theta) / unit.span).max() <= DISTINCT:
                return replace(known, evaluations=count), None
        still = far <= options.step or local.unchanging(s, options.reduction)
        still = still and not (held and rejected)  # a radius that has fallen shortens any step
        if still and not escaped:
            escaped, s = True, _off_the_saddle(qp, local.slope(kappa), active)
            still, far = not s.any(), float(np.abs(s).max())
        status: Status | None = None
        if still:
            status = Status.CONVERGED
        elif far <= np.finfo(float).eps or radius <= options.step:
            # Steps that were not held back were below the tolerance: rounding of J stops it here.
            status = Status.CONVERGED if proposal <= options.step else Status.JUMP
        here = Solution(evaluation, w, status or Status.EXHAUSTED, count)
        if status or count >= options.iterations:
            return here, None

        predicted, penalty = local.predicted(qp.B, s, kappa, penalty)
        noise = local.noise(kappa)
        rests = predicted <= noise
        if calm and rests and far >= calm[0]:  # the objectives tell no more
            return replace(calm[1], status=Status.CONVERGED, evaluations=count), None
        calm = (far, here) if rests else None
        new = local.after(s)
        if not new.feasible:
            radius, rejected = far / 4, True
            continue
        merit = partial(augmented, programme, kappa, penalty)
        actual = merit(evaluation) - merit(new)
        miss, ahead = actual - predicted, Linearised(unit, programme, new)
        rest = 0.5 * w @ (S @ s @ s) * (1 if trusted else -1)
        trusted ^= bool(abs(miss - rest) < abs(miss))
        if not evaluation.exact:
            S = learned_from(S, local.x, ahead.x)
        if actual < POOR * predicted and new.exact:
            # The end of a poor step, or if the derivatives there promise a better model than
            # both, the better one of it and of the end of a step from there.
            _, s, *_ = ahead.step(ahead.x.H if trusted else ahead.G, radius, None)
            promised = merit(replace(new, J=ahead.promised(s)))
            if promised < min(merit(evaluation), merit(new)):
                new, count = min(new, ahead.after(s), key=merit), count + 1
                actual = merit(evaluation) - merit(new)
        ratio = (actual + noise) / (predicted + noise) if predicted > -noise else -1.0
        if ratio > 0:
            evaluation, rejected, sought = new, False, False
            local = ahead if new is ahead.evaluation else Linearised(unit, programme, new)
            S = local.x.H - local.G if evaluation.exact else S
            if ratio < POOR:
                radius = far / 2
            elif ratio > GOOD and far >= radius:
                radius = min(2 * radius, 1.0)
        else:
            radius, rejected = far / 4, True
            if radius <= DISTINCT and not sought:
                sought, jump = True, _jump(problem, evaluation, new)
                if jump:
                    return Solution(evaluation, w, Status.JUMP, count), jump


def learned_from(S: Floats, before: Evaluation, after: Evaluation) -> Floats:
    """Return S (n, p, p) with what the difference of two evaluations tells of it."""
    s = after.theta - before.theta
    if not s.any():
        return S
    y = after.dJ - before.dJ - after.H @ s
    claimed = np.abs(S @ s @ s)
    size = np.minimum(np.abs(y @ s), claimed) / np.where(claimed > 0, claimed, 1.0)
    size[~after.H.any(axis=(1, 2))] = 1.0
    S = size[:, None, None] * S
    v, u = y - S @ s, s / (s @ s)
    vu = v[:, :, None] * u
    return np.asarray(S + vu + vu.transpose(0, 2, 1) - (v @ s)[:, None, None] * np.outer(u, u))


def _off_the_saddle(qp: QuadraticProgramme, slope: Floats, active: list[int]) -> Floats:
    """Return a step along clearly negative curvature within the constraints, or zeros.

    ``slope`` is that of the Lagrangian: a variable at a bound that it does not hold there is as
    free as those within.
    """
    lo, hi, E = qp.lo, qp.hi, qp.ties(active)
    s = np.zeros(slope.size)
    flat = np.abs(slope) <= SADDLE * np.abs(qp.B).max()
    free = ((lo < 0) & (hi > 0)) | (flat & (lo < hi))
    Z = scipy.linalg.null_space(E[:, free]) if E.size else np.eye(int(free.sum()))
    if Z.shape[1] == 0:
        return s
    curvature, V = np.linalg.eigh(Z.T @ qp.B[np.ix_(free, free)] @ Z)
    if curvature[0] < -SADDLE * np.abs(curvature).max():
        v = Z @ V[:, 0]
        v[np.abs(v) < SADDLE] = 0.0
        v *= -1.0 if slope[free] @ v > 0 else 1.0
        ahead, behind = (room(0 * v, side * v, lo[free], hi[free]) for side in (1, -1))
        s[free] = 0.5 * v * (ahead or -behind)
    return s
