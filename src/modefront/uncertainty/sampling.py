r"""Models drawn from the posterior: randomised maximum likelihood.

Each draw is the model that fits data with other errors, and is nearest to a model of the prior:

.. math:: \theta = \arg\min \sum_i \frac{\|r_i(\theta) + \varepsilon_i\|^2}{s_i}
    + \delta \sum_j \frac{(\theta_j - \vartheta_j)^2}{range_j^2}, \qquad
    \varepsilon_i \sim N(0, s_i), \quad \vartheta \sim U(bounds),

with :math:`\delta` so small that it decides only where the data say nothing (Kitanidis 1995,
doi:10.1029/94WR02740; Oliver, He & Reynolds 1996). Where residuals are linear and bounds far these
are independent draws from the posterior. It is an approximation elsewhere, which follows curved
sets of equivalent models and reaches all minima. ``benchmarks/calibration.py`` measures it. Markov
chains take a hundred times as many models where the data leave much open.

Draws that would be beyond a bound lie at it, while the posterior has no such atom. Each parameter j
at a bound is drawn again along the line :math:`\theta + t v`, :math:`v_j` one range inwards, on
which those within their bounds follow, :math:`v_F = -A_{FF}^{-1} A_{Fj} v_j`, with :math:`A =
\partial r^T \partial r` of the residuals over their standard deviations. To first order t is
Gaussian,

.. math:: q(t) \propto e^{-a t^2 / 2 - g t}, \qquad a = v^T A v, \quad g = v^T \partial r^T r,

truncated where the line ends; it is taken with the probability of Metropolis, the ratio of the
posterior over q to that at the bound. Of one parameter and a linear residual the draws are exact.

The variances are drawn from their marginal distribution with the parameters linearised about the
most probable model, at which :math:`q_i` counts the directions that group i determines,

.. math:: s_i \sim \frac{J_i' - S_i + \nu m_i}{\chi^2_{a_i + \nu - q_i}}, \qquad
    q_i = \mathrm{tr} \Big[\Big(\sum_k w_k G_k + \delta\Big)^{-1} w_i G_i\Big],

with :math:`G_i = \partial r_i^T \partial r_i` and w the weights. Of one group of linear residuals
this gives Student's distribution with :math:`a + \nu - p` degrees of freedom, exactly.

The problem is solved from the model of the prior and from the most probable one; the better
solution is taken.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from scipy.special import log_ndtr, ndtri_exp

from modefront._typing import Floats
from modefront.optim.problem import (
    Evaluation,
    ObjectiveDerivatives,
    Problem,
    Residual,
    Wrapped,
    at_bounds,
)
from modefront.optim.scalarisation import weighted
from modefront.optim.sqp import Options, begin, solve
from modefront.uncertainty.prior import Distance, NoiseModel, drawn_prior
from modefront.work.task import Executor, Task, seed_sequence

PRIOR = 2.5e-3
"""Weight of the distance from the model of the prior: a normal prior of twenty ranges."""

BATCH = 10
"""Draws of a task."""

DRAWS = 100
"""Draws for intervals: the 5 % quantile has an error of a sixth of a standard deviation."""

_LOOSE = Options(step=1e-4, reduction=1e-8, iterations=40)
"""Draws need a hundredth of their scatter, and no more."""


@dataclass(frozen=True)
class Variances:
    """The distribution of the variances s (n,): ``scale`` / chi-square of ``dof``."""

    scale: Floats
    dof: Floats

    def draw(self, rng: np.random.Generator) -> Floats:
        """Return variances (n,)."""
        out: Floats = self.scale / rng.chisquare(self.dof)
        return out


def variances(noise: NoiseModel, evaluation: Evaluation) -> Variances:
    """Return the distribution of the variances; ``evaluation`` is of the most probable model."""
    logs = noise.programme.logs
    span = noise.problem.upper - noise.problem.lower
    slope = Distance(noise.problem, noise.problem.start, PRIOR).residuals(evaluation.theta)[1]
    w = logs.gradient(evaluation.J)
    G = np.array([x.dr.T @ x.dr for x in evaluation.residuals]) * np.outer(span, span)
    inverse = np.linalg.inv(np.tensordot(w, G, axes=1) + np.diag((slope * span) ** 2))
    q = w * np.einsum("jk,ikj->i", inverse, G)
    return Variances(evaluation.J + logs.floor, np.maximum(logs.a - q, noise.weight))


def draw_models(noise: NoiseModel, theta: Floats, count: int, seed: int, work: Executor) -> Floats:
    """Return models (count, p) drawn from the posterior, with its maximum at theta (p,)."""
    tasks = [
        Task(
            ("sample-posterior", k + 1),
            _drawn,
            (noise, theta, BATCH),
            seed_sequence(seed, "sample-posterior", k + 1),
        )
        for k in range(-(-count // BATCH))
    ]
    return np.concatenate(work.run(tasks))[:count]


def _drawn(noise: NoiseModel, theta: Floats, count: int, *, rng: np.random.Generator) -> Floats:
    """Return draws (count, p)."""
    problem = noise.problem
    best = problem.evaluate(theta)
    of, w = variances(noise, best), np.ones(2)
    out = []
    for _ in range(count):
        s = of.draw(rng)
        prior = drawn_prior(problem, rng)
        errors = [
            np.sqrt(v) * rng.normal(size=x.r.size) for v, x in zip(s, best.residuals, strict=True)
        ]
        disturbed = _Disturbed(s, errors, Distance(problem, prior, PRIOR))
        target = Wrapped(problem, disturbed.evaluate, ("misfit", "distance from the prior"))
        starts = [target.evaluate(prior), disturbed.of(best)]
        found = [solve(target, weighted(w), begin(x), _LOOSE) for x in starts if x.feasible]
        theta = min(found, key=lambda x: float(w @ x.J)).theta
        out.append(_within_bounds(noise, s, theta, rng))
    return np.array(out)


def _within_bounds(noise: NoiseModel, s: Floats, theta: Floats, rng: np.random.Generator) -> Floats:
    """Return a draw (p,) of which parameters that are at bounds are drawn again."""
    lower, upper = noise.problem.lower, noise.problem.upper
    span, sides = upper - lower, at_bounds(theta, lower, upper)
    here = _Local.at(noise, s, theta) if sides.any() else None
    for j in rng.permutation(np.flatnonzero(sides)):
        A = here.dr.T @ here.dr + PRIOR * np.eye(span.size)
        free, v = at_bounds(here.theta, lower, upper) == 0, np.zeros(span.size)
        v[j] = -sides[j]
        v[free] = -np.linalg.solve(A[np.ix_(free, free)], A[free, j] * v[j])
        ends = np.where(v > 0, upper, lower) - here.theta
        reach = float((ends[v != 0] / (v * span)[v != 0]).min())
        a, g = float(v @ A @ v), float(v @ here.dr.T @ here.r)
        t = truncated(-g / a, a**-0.5, reach, rng)
        end = np.clip(here.theta + t * v * span, lower, upper)
        there = _Local.at(noise, s, end)
        excess = there.r @ there.r - here.r @ here.r - a * t**2 - 2 * g * t
        if rng.random() < np.exp(-max(excess, 0.0) / 2):
            here = there
    return theta if here is None else here.theta


def truncated(mean: float, std: float, reach: float, rng: np.random.Generator) -> float:
    """Return a draw of a Gaussian between 0 and ``reach``, by inversion in its left tail."""
    inner, outer = log_ndtr(np.array([mean, mean - reach]) / std)
    u = rng.random()
    t = mean - std * ndtri_exp(inner + np.log1p(u * np.expm1(outer - inner)))
    return float(np.clip(t, 0.0, reach))


@dataclass(frozen=True)
class _Local:
    """Residuals r over their standard deviations with normal priors, and dr over the ranges."""

    theta: Floats
    r: Floats
    dr: Floats

    @classmethod
    def at(cls, noise: NoiseModel, s: Floats, theta: Floats) -> Self:
        """Return those of a model; infinite ones where it is not defined."""
        problem = noise.problem
        found = problem.evaluate(theta)
        r, dr, _ = Distance(problem, problem.start, 0.0).residuals(theta)
        if not found.feasible:
            return cls(theta, np.full(1, np.inf), np.zeros((1, theta.size)))
        parts = zip(found.residuals, np.sqrt(s), strict=True)
        rows = [(x.r / root, x.dr / root) for x, root in parts]
        return cls(
            theta,
            np.concatenate([*(x for x, _ in rows), r]),
            np.vstack([*(x for _, x in rows), np.diag(dr)]) * (problem.upper - problem.lower),
        )


@dataclass(frozen=True)
class _Disturbed:
    """Residuals with other errors, over their standard deviations, and a model of the prior."""

    s: Floats
    errors: Sequence[Floats]
    prior: Distance

    def evaluate(
        self, problem: Problem, theta: Floats, derivatives: bool, second: bool
    ) -> Evaluation:
        """Return the misfit and the distance; residuals take derivatives, whether asked or not."""
        del derivatives
        return self.of(problem.evaluate(theta, second=second))

    def of(self, found: Evaluation) -> Evaluation:
        """Return them from an evaluation."""
        if not found.feasible:
            return replace(found, J=np.full(2, np.inf))
        parts = [
            Residual((x.r + e) / np.sqrt(v), x.dr / np.sqrt(v))
            for x, e, v in zip(found.residuals, self.errors, self.s, strict=True)
        ]
        misfit = Residual(np.concatenate([x.r for x in parts]), np.vstack([x.dr for x in parts]))
        r, dr, _ = self.prior.residuals(found.theta)
        distance = Residual(r, np.diag(dr))
        both = (misfit, distance)
        slopes = ObjectiveDerivatives(
            np.array([2 * x.r @ x.dr for x in both]), np.array([2 * x.dr.T @ x.dr for x in both])
        )
        return Evaluation(
            found.theta,
            np.array([x.r @ x.r for x in both]),
            slopes,
            residuals=both,
        )
