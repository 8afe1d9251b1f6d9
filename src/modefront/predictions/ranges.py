r"""Least and greatest values of a prediction over models that fit the data equally well.

Where data leave combinations of parameters open, models form a set on which no residual changes,
and a point of a front stands for all of it. With the residuals r of all groups over the lengths of
their derivatives, of the singular values :math:`U \Sigma V^T` of the derivatives at the point
:math:`\theta_P` over the ranges of the parameters, and :math:`V_0` those that vanish, these models
are the solutions of

.. math:: \min \pm q(\theta) \quad\text{subject to}\quad
    \Sigma^{-1} U^T \big( r(\theta) - r(\theta_P) \big) = 0

within the bounds. Only derivatives of q along the null space of the equations count; they are
differences, of which there are as many as open combinations. Solutions at which an objective has
grown are no equivalent models (residuals that change to second order), and are left out.

With a slack s models are nearly as good, and for all i

.. math:: \min \pm q(\theta) \quad\text{subject to}\quad J_i(\theta) \le (1 + s) J_i(\theta_P) .

The constraints are a penalty on the greatest violation, exact from some factor on, which grows
until they are met. The next point starts where the last one ended, relative to it. A function along
a set of models has several extremes: where one of the ends of the open directions, alone and
together, promises more, the search goes on from the best of these.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import numpy as np

from modefront._typing import Floats
from modefront.optim.lexicographic import EXACT, RANK
from modefront.optim.problem import Evaluation, ObjectiveDerivatives, Problem, Wrapped, infeasible
from modefront.optim.scalarisation import Linear, Rows, no_rows
from modefront.optim.sqp import Options, Solution, begin, solve
from modefront.options import number

SAME = 1e-4
"""Growth of an objective, over itself, up to which models are equivalent: that of its root is far
below any error of measurement."""

FACTORS = (1e1, 1e2, 1e3, 1e4)
"""Penalties on violations of the slack, over the size of the prediction."""

_ENOUGH = Options(step=1e-5, constraint=1e-6, reduction=1e-8, iterations=40)
"""A range needs a thousandth of itself, and no more."""

MANY = 3
"""Open directions of which sums are tried: 26 models."""

SLACK = number("a share of 0 or more", least=0)

Values = Callable[[Floats], float]
"""Returns the prediction of a model (p,); NaN where it has none."""


@dataclass(frozen=True)
class Equivalent:
    """Models that are as good as one of a front.

    Attributes
    ----------
    problem : the problem
    model : evaluation of the model of the front
    slack : share by which objectives may be greater
    step : of differences of a prediction, over the ranges of the parameters
    """

    problem: Problem
    model: Evaluation
    slack: float
    step: float

    @property
    def span(self) -> Floats:
        """Ranges of the parameters, (p,)."""
        return self.problem.upper - self.problem.lower

    def equations(self) -> tuple[Floats, Floats]:
        """Return the rows (k, rows) of the equations, and their null space (p, d)."""
        dr = self._jacobian(self.model)
        U, sigma, Vt = np.linalg.svd(dr)
        k = int((sigma > RANK * sigma.max(initial=0.0)).sum())
        return U[:, :k].T / sigma[:k, None], Vt[k:].T

    def ends(self) -> list[Floats]:
        """Return the models (p,) at the bounds to which open directions and their sums lead."""
        lower, upper, theta = self.problem.lower, self.problem.upper, self.model.theta
        null, out = self.equations()[1], []
        for signs in product((-1, 0, 1), repeat=min(null.shape[1], MANY)):
            step = null[:, : len(signs)] @ signs * self.span
            moves = np.abs(step) > RANK * self.span
            if moves.any():
                room = np.where(step > 0, upper, lower)[moves] - theta[moves]
                reach = max(float((room / step[moves]).min()), 0.0)
                out.append(np.clip(theta + reach * step, lower, upper))
        return out

    def _lengths(self) -> list[float]:
        parts = [np.linalg.norm(x.dr * self.span) for x in self.model.residuals]
        return [float(x) if x > 0 else 1.0 for x in parts]

    def _jacobian(self, evaluation: Evaluation) -> Floats:
        lengths = self._lengths()
        return np.vstack(
            [x.dr * self.span / v for x, v in zip(evaluation.residuals, lengths, strict=True)]
        )

    def _vector(self, evaluation: Evaluation) -> Floats:
        lengths = self._lengths()
        return np.concatenate([x.r / v for x, v in zip(evaluation.residuals, lengths, strict=True)])

    @property
    def level(self) -> Floats:
        """Greatest objectives (n,)."""
        grown = np.sqrt((1 + max(self.slack, SAME)) * self.model.J)
        return np.asarray((grown + np.sqrt(EXACT) * np.array(self._lengths())) ** 2)

    def extreme(self, q: Values, size: float, sign: float, start: Floats) -> Solution | None:
        """Return the model with the least (sign 1) or greatest (-1) value; None without others.

        The solution has q over ``size`` as its last objective.
        """
        rows, null = self.equations()
        if self.slack == 0:
            if not null.shape[1]:
                return None
            k = len(rows)
            target = Wrapped(self.problem, self._with(q, size, rows), ("",) * (k + 1))
            equal = Rows(np.eye(k, k + 1), np.zeros(k))
            programme = Linear(np.append(np.zeros(k), sign), equal, no_rows(k + 1))
            found = solve(target, programme, begin(target.evaluate(start)), _ENOUGH)
            return found if self._as_good(found) else None
        n = self.model.J.size
        target = Wrapped(self.problem, self._with(q, size, None), ("",) * (n + 1))
        w, found = np.append(np.zeros(n), sign), begin(target.evaluate(start))
        for factor in FACTORS:
            C = np.vstack([np.zeros(n + 1), factor * np.eye(n, n + 1) / self.level[:, None]])
            programme = Linear(w, no_rows(n + 1), Rows(C, np.append(0.0, np.full(n, factor))))
            found = solve(target, programme, begin(found.evaluation), _ENOUGH)
            if self._as_good(found):
                return found
        return None

    def _as_good(self, found: Solution) -> bool:
        J = self.problem.evaluate(found.theta, derivatives=False).J
        return bool((self.level * (1 + SAME) - J >= 0).all())

    def _with(
        self, q: Values, size: float, rows: Floats | None
    ) -> Callable[[Problem, Floats, bool, bool], Evaluation]:
        """Return the evaluation of the equations, or the objectives, and of q over its size."""
        r0 = self._vector(self.model)

        def evaluation(problem: Problem, theta: Floats, _: bool, __: bool) -> Evaluation:
            found, value = problem.evaluate(theta), q(theta) / size
            n = (found.J.size if rows is None else len(rows)) + 1
            if not (found.feasible and np.isfinite(value)):
                return infeasible(theta, n)
            if rows is None:
                c, dc, H, along = found.J, found.dJ, found.H, np.eye(theta.size)
            else:
                dr = self._jacobian(found)
                c, dc = rows @ (self._vector(found) - r0), rows @ dr / self.span
                H = np.zeros((n - 1, theta.size, theta.size))
                along = np.linalg.svd(rows @ dr)[2][n - 1 :].T
            dq = self._slopes(q, theta, along) / size
            slopes = ObjectiveDerivatives(
                np.vstack([dc, dq]), np.concatenate([H, np.zeros((1, theta.size, theta.size))])
            )
            return Evaluation(theta, np.append(c, value), slopes)

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


# 6 arguments: the problem, the models, and what is sought.
def extreme(
    problem: Problem, thetas: Floats, q: Values, sign: float, slack: float, step: float
) -> float:
    """Return the least (sign 1) or greatest (-1) prediction over equivalent models.

    ``thetas`` (m, p) are models of a front, to which others are equivalent; they count too. NaN
    where none has a value.
    """
    best, shift = np.nan, np.zeros(problem.start.size)
    for theta in thetas:
        here, value = problem.evaluate(theta), q(theta)
        if not (here.feasible and np.isfinite(value)):
            continue
        size = abs(value) if value else 1.0
        each = Equivalent(problem, here, slack, step)
        start = np.clip(theta + shift, problem.lower, problem.upper)
        found = each.extreme(q, size, sign, start)
        if found is None and shift.any():
            found = each.extreme(q, size, sign, theta)
        reached = value if found is None else float(found.J[-1]) * size
        ends = each.ends()
        promises = np.array([sign * q(end) for end in ends])
        if (promises < sign * reached).any():
            other = each.extreme(q, size, sign, ends[int(np.nanargmin(promises))])
            if other is not None and sign * float(other.J[-1]) * size < sign * reached:
                found, reached = other, float(other.J[-1]) * size
        shift = np.zeros(theta.size) if found is None else found.theta - theta
        best = sign * float(np.nanmin([sign * best, sign * value, sign * reached]))
    return best
