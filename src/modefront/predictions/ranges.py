r"""Least and greatest values of a prediction over a front and all models that are equivalent.

docs/methods/first-passage.md says which programmes are solved. Neighbours on a front are points of
which the ball with both as poles holds no other one (Gabriel & Sokal 1969, doi:10.2307/2412323);
half-way between them lies the point of the front for the middle of their objectives.

Equivalent models have the residuals of a point, over the lengths of their derivatives. With the
singular values :math:`U \Sigma V^T` of these derivatives over the ranges of the parameters,

.. math:: \min \pm q(\theta) \quad\text{subject to}\quad
    \Sigma^{-1} U^T \big( r(\theta) - r(\theta_P) \big) = 0,

or, with a slack s, :math:`J_i(\theta) \le (1 + s) J_i(\theta_P)`. Only derivatives of q along the
null space :math:`V_0` of the equations count. Solutions at which an objective has grown are left
out. The constraints are a penalty on the greatest violation, which grows until they are met: from
where it has led, or from the start again where no equivalent model is near that. Where
the bounds to which :math:`V_0 V_0^T e_j` leads promise more, the search goes on from there.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.linalg import null_space

from modefront._typing import Bools, Floats
from modefront.front.dominance import undominated
from modefront.front.subproblems import RHO
from modefront.optim.lexicographic import EXACT, RANK, TIE
from modefront.optim.problem import Evaluation, Problem, Wrapped, infeasible, room
from modefront.optim.scalarisation import achievement, weighted
from modefront.optim.sqp import Options, Solution, begin, solve
from modefront.options import number

SURE = 1e-3
"""Share of its greatest value that the end of a range needs, and of the range of a parameter below
which the front is not solved for between models."""

SAME = 1e-4
"""Growth of an objective, over itself, up to which models are equivalent: that of its root is far
below any error of measurement."""

FACTORS = (1e1, 1e2, 1e3, 1e4)  # penalties on violations, over the size of the prediction
NEAR = 1e-3  # weight of distances from a model, over the ranges, beside the equations
_ENOUGH = Options(step=1e-5, reduction=1e-8, iterations=40)  # a range needs a thousandth of itself
SLACK = number("a share of 0 or more", least=0)

Values = Callable[[Floats], float]  # returns the prediction of a model (p,); NaN where it has none


@dataclass(frozen=True)
class Sampled:
    """A front at some of its models."""

    theta: Floats  # theta, J: (m, p) and (m, n) parameters and objectives
    J: Floats
    is_open: bool  # whether others are equivalent to these
    slack: float = 0.0  # share by which objectives of models may be greater that count
    # (k, p) and (k, n) parameters and objectives of other models, of which some may be equivalent
    others: tuple[Floats, Floats] | None = None
    # what has been solved for half-way between two models, for any prediction
    between: dict[bytes, list[Solution]] = field(default_factory=dict, repr=False)

    @cached_property
    def ranges(self) -> Floats:
        """Ranges of the objectives, (n,); 1 for none."""
        ranges = np.ptp(self.J, axis=0)
        return np.where(ranges > 0, ranges, 1.0)


@dataclass(frozen=True)
class Equivalent:
    """Models that are as good as one of a front."""

    problem: Problem  # the problem
    model: Evaluation  # evaluation of the model of the front
    slack: float  # share by which objectives may be greater
    step: float  # of differences of a prediction, over the ranges of the parameters

    def extreme(self, q: Values, sign: float, known: Iterable[Floats] = ()) -> float:
        """Return the least (sign 1) or greatest (-1) value of a prediction; NaN without any.

        ``known`` models (p,) are equivalent, too.
        """
        theta, reached = self.model.theta, q(self.model.theta)
        is_open = self.slack > 0 or self.equations[1].shape[1] > 0
        for other in known if np.isfinite(reached) else ():
            if sign * (value := q(other)) < sign * reached:
                theta, reached = other, value
        first = start = theta if is_open and np.isfinite(reached) else None
        size = abs(reached) if reached else 1.0
        while start is not None:
            found = self._solve(q, size, sign, start)
            if found is not None and sign * found[1] < sign * reached:
                theta, reached = found
            elif start is not first:
                break
            start = self._farther(q, sign, theta, reached)
        return reached

    def _farther(self, q: Values, sign: float, theta: Floats, reached: float) -> Floats | None:
        """Return the model (p,) at the bounds that promises most; None where none promises more."""
        null, bounds = self.equations[1], (self.problem.lower, self.problem.upper)
        best, best_value = None, reached - sign * SURE * abs(reached)
        known: list[Floats] = []
        for v in (null @ null.T)[np.abs(null).max(axis=1, initial=0.0) > RANK]:
            v = v / np.linalg.norm(v)
            if any(abs(v @ x) > 1 - RANK for x in known):
                continue
            known.append(v)
            along = np.where(np.abs(v) > RANK, v, 0.0) * self.span
            for step in (along, -along):
                end = np.clip(theta + max(room(theta, step, *bounds), 0.0) * step, *bounds)
                value = q(end)
                if sign * value < sign * best_value:
                    best, best_value = end, value
        return best

    @property
    def span(self) -> Floats:
        """Ranges of the parameters, (p,)."""
        return self.problem.upper - self.problem.lower

    @cached_property
    def equations(self) -> tuple[Floats, Floats]:
        """The rows (k, rows) of the equations, and their null space (p, d)."""
        U, sigma, Vt = np.linalg.svd(self._residuals(self.model)[1])
        k = int((sigma > RANK * sigma.max(initial=0.0)).sum())
        return U[:, :k].T / sigma[:k, None], Vt[k:].T

    @cached_property
    def _lengths(self) -> list[float]:
        parts = [np.linalg.norm(x.dr * self.span) for x in self.model.residuals]
        return [float(x) if x > 0 else 1.0 for x in parts]

    def _residuals(self, evaluation: Evaluation) -> tuple[Floats, Floats]:
        """Return residuals over their lengths, and their derivatives over the ranges."""
        parts = list(zip(evaluation.residuals, self._lengths, strict=True))
        dr = [x.dr * self.span / v for x, v in parts]
        return np.concatenate([x.r / v for x, v in parts]), np.vstack(dr)

    @property
    def level(self) -> Floats:
        """Greatest objectives (n,)."""
        grown = np.sqrt((1 + max(self.slack, SAME)) * self.model.J)
        return np.asarray((grown + np.sqrt(EXACT) * np.array(self._lengths)) ** 2)

    def holds(self, J: Floats) -> Bools:
        """Return whether models with objectives J (..., n) are equivalent."""
        return np.asarray((self.level * (1 + SAME) >= J).all(axis=-1))

    def _solve(
        self, q: Values, size: float, sign: float, start: Floats
    ) -> tuple[Floats, float] | None:
        """Return the model (p,) of the extreme to which a start leads and q, about ``size``, there.

        None where that is no equivalent model.
        """
        if self.slack == 0:  # the corners of a simplex about the middle: all are 0 there alone
            n = len(self.equations[0])
            C, d = null_space(np.ones((1, n + 1))), np.zeros(n + 1)
        else:
            n = self.model.J.size
            C, d = np.vstack([np.zeros(n), np.diag(1 / self.level)]), np.append(0.0, np.ones(n))
        target = Wrapped(self.problem, self._with(q, size), ("",) * (n + 1))
        w, at = np.append(np.zeros(n), sign), begin(target.evaluate(start))
        rows = np.pad(C, ((0, 0), (0, 1)))
        best: tuple[Floats, float] | None = None
        for factor in FACTORS:
            programme = achievement(w, rows, d, factor)
            found = solve(target, programme, at, _ENOUGH)
            for theta in (found.theta, self._nearest(found.theta)):
                if self.holds(self.problem.evaluate(theta, derivatives=False).J):
                    value, at = q(theta), begin(found.evaluation)
                    if best is None or sign * value < sign * best[1]:
                        best = theta, value
                    if theta is found.theta:
                        return best
        return best

    def _nearest(self, theta: Floats) -> Floats:
        """Return the model (p,) nearest to another one at which the equations hold.

        Solutions miss them where they are at a bound: q is only known to change along them.
        """
        if self.slack > 0:
            return theta

        def evaluation(problem: Problem, x: Floats, _: bool, __: bool) -> Evaluation:
            found = problem.evaluate(x)
            if not found.feasible:
                return infeasible(x, 1)
            c, dc = self._missing(found)
            r = np.append(c, NEAR * (x - theta) / self.span)
            dr = np.vstack([dc, np.diag(NEAR / self.span)])
            return Evaluation(x, np.array([r @ r]), 2 * r[None] @ dr, 2 * (dr.T @ dr)[None])

        target = Wrapped(self.problem, evaluation, ("",))
        return solve(target, weighted(np.ones(1)), begin(target.evaluate(theta))).theta

    def _missing(self, found: Evaluation) -> tuple[Floats, Floats]:
        """Return what is missing in the equations (k,) at a model, and its derivatives (k, p)."""
        (r, dr), (r0, _) = self._residuals(found), self._residuals(self.model)
        return self.equations[0] @ (r - r0), self.equations[0] @ dr / self.span

    def _with(self, q: Values, size: float) -> Callable[[Problem, Floats, bool, bool], Evaluation]:
        """Return the evaluation of the equations, or the objectives, and of q over its size."""

        def evaluation(problem: Problem, theta: Floats, _: bool, __: bool) -> Evaluation:
            found, value = problem.evaluate(theta), q(theta) / size
            c, dc, H, along = found.J, found.dJ, found.H, np.eye(theta.size)
            n = (found.J.size if self.slack else len(self.equations[0])) + 1
            if not (found.feasible and np.isfinite(value)):
                return infeasible(theta, n)
            if self.slack == 0:
                c, dc = self._missing(found)
                H = np.zeros((n - 1, theta.size, theta.size))
                along = np.linalg.svd(dc * self.span)[2][n - 1 :].T
            dq = self._slopes(q, theta, along) / size
            H = np.concatenate([H, np.zeros((1, theta.size, theta.size))])
            return Evaluation(theta, np.append(c, value), np.vstack([dc, dq]), H)

        return evaluation

    def _slopes(self, q: Values, theta: Floats, along: Floats) -> Floats:
        """Return the derivatives (p,) of q along orthonormal directions (p, d) over the ranges."""
        lower, upper = self.problem.lower, self.problem.upper
        out = np.zeros(theta.size)
        for v in along.T:
            ends = [np.clip(theta + s * self.step * v * self.span, lower, upper) for s in (1, -1)]
            change = (ends[0] - ends[1]) / self.span
            length = float(v @ change)
            if length > 0:
                slope = (q(ends[0]) - q(ends[1])) / length
                out += v * slope if np.isfinite(slope) else 0.0
        return out / self.span


@dataclass
class _Along:
    """Models of a front that are solved for where a prediction may have its least value."""

    problem: Problem  # the problem
    front: Sampled  # some of its models, and what is known between them
    value: Callable[[Floats], float]  # returns the value of a model of the front
    known: list[tuple[Floats, Floats, float]] = field(default_factory=list)  # theta, J and value
    halved: set[tuple[int, int]] = field(default_factory=set)  # pairs that were solved between

    def least(self) -> float:
        """Return the least value; NaN without any."""
        while pairs := set(self._promising()):
            for pair in sorted(pairs):
                self._halve(*pair)
        return min((x for *_, x in self.known if np.isfinite(x)), default=np.nan)

    def _promising(self) -> Iterator[tuple[int, int]]:
        """Yield the neighbours between which less than the least value may lie."""
        values = np.array([x for *_, x in self.known])
        known = np.isfinite(values)
        scaled = np.array([J for _, J, _ in self.known]) / self.front.ranges
        squares = ((scaled[:, None] - scaled) ** 2).sum(axis=2)
        needed = values.min(where=known, initial=np.inf)
        needed -= SURE * np.abs(values).max(where=known, initial=0.0)
        for k in np.flatnonzero(known).tolist():
            inside = (squares[k][:, None] + squares < squares[k]).any(axis=0)
            near = np.flatnonzero(~inside & known & (np.arange(values.size) != k))
            rise = values[near] - values[k]
            if near.size and rise.min() >= 0 and values[k] - rise.max() / 8 < needed:
                pairs = ((min(k, j), max(k, j)) for j in near.tolist())
                yield from (pair for pair in pairs if pair not in self.halved)

    def _halve(self, a: int, b: int) -> None:
        """Add the model half-way between two of them, if it is another one."""
        self.halved.add((a, b))
        one, other = self.known[a][0], self.known[b][0]
        if _apart(self.problem, one, other) <= SURE:
            return
        key = np.append(one, other).tobytes()
        if key not in self.front.between:
            self.front.between[key] = self._between(a, b)
        known = np.array([J for _, J, _ in self.known])
        for found in self.front.between[key]:
            if undominated(found.J[None], known, self.front.ranges).all():
                self.known.append((found.theta, found.J, self.value(found.theta)))

    def _between(self, a: int, b: int) -> list[Solution]:
        """Return the model half-way between two; where their branches end if none is nearer."""
        (one, J, _), (other, at, _), unit = self.known[a], self.known[b], self.front.ranges
        ends = np.array([J, at]) / unit
        middle = ends.mean(axis=0)
        for starts in ([(one + other) / 2], [one, other]):
            found = [
                self._toward(middle, begin(self.problem.evaluate(x, second=True))) for x in starts
            ]
            best = min(found, key=lambda x: float((x.J / unit - middle).max()))
            if (best.J / unit - middle).max() < (ends - middle).max(axis=1).min() - TIE:
                return [best]
        return [x for start in (one, other) if (x := self._end_of(start, middle))]

    def _toward(self, target: Floats, start: Solution) -> Solution:
        """Return the model nearest to objectives over their ranges, of those that a start sees."""
        unit = self.front.ranges
        programme = achievement(RHO / unit, np.diag(1 / unit), target)
        return solve(self.problem, programme, start, _ENOUGH)

    def _end_of(self, theta: Floats, target: Floats) -> Solution | None:
        """Return the last model toward a target on the branch of another that none dominates."""
        known, unit = np.array([J for _, J, _ in self.known]), self.front.ranges
        here, found = begin(self.problem.evaluate(theta, second=True)), None
        first, low, high = here.J / unit, 0.0, 1.0
        while high - low > SURE:
            share = (low + high) / 2
            there = self._toward(first + share * (target - first), here)
            if there.feasible and undominated(there.J[None], known, unit).all():
                here, found, low = there, there, share
            else:
                high = share
        return found if _apart(self.problem, theta, here.theta) > SURE else None


def _apart(problem: Problem, one: Floats, other: Floats) -> float:
    return float(np.abs((one - other) / (problem.upper - problem.lower)).max())


# 6 arguments: the problem, the front, and what is sought.
def extreme(
    problem: Problem, front: Sampled, values: Floats, q: Values, sign: float, step: float
) -> float:
    """Return the least (sign 1) or greatest (-1) prediction over a front; NaN without any.

    ``values`` (m,) are those of its models, ``step`` is that of `Equivalent`.
    """

    def value(theta: Floats) -> float:
        if not front.is_open:
            return sign * q(theta)
        models, known = Equivalent(problem, problem.evaluate(theta), front.slack, step), theta[:0]
        if front.others is not None:
            known, J = front.others
            known = known[models.holds(J)]
        return sign * models.extreme(q, sign, known)

    along = _Along(problem, front, value)
    for theta, J, known in zip(front.theta, front.J, sign * values, strict=True):
        if all(_apart(problem, theta, other) > SURE for other, *_ in along.known):
            along.known.append((theta, J, value(theta) if front.is_open else float(known)))
    return sign * along.least()
