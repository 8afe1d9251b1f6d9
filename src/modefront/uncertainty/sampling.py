r"""Models drawn from the posterior: randomised maximum likelihood.

Each draw is the model that fits data with other errors, and where these say nothing is nearest to a
model of the prior (docs/uncertainty.md; Kitanidis 1995, doi:10.1029/94WR02740; Oliver, He &
Reynolds 1996). Where residuals are linear and bounds far these are independent draws from the
posterior. It is an approximation elsewhere, which follows curved sets of equivalent models and
reaches all minima. ``benchmarks/calibration.py`` measures it. Markov chains take a hundred times as
many models where the data leave much open.

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
from modefront.work.codec import record
from modefront.work.task import Executor, Task, seed_sequence

PRIOR = 2.5e-3
"""Weight of the distance from the model of the prior: a normal prior of twenty ranges."""

BATCH = 10
"""Draws of a task."""

DRAWS = 100
"""Draws for intervals: the 5 % quantile has an error of a sixth of a standard deviation."""

NAMES = ("misfit", "distance from the prior")
"""Objectives of a draw."""

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


@record
@dataclass(frozen=True)
class Draws:
    """Models drawn from the posterior, with what they predict.

    Attributes
    ----------
    theta : (draws, p) parameters
    frequency, mac : (draws, modes) of the pairs of measured modes that are most likely
    """

    theta: Floats
    frequency: Floats
    mac: Floats


def draw_models(noise: NoiseModel, theta: Floats, count: int, seed: int, work: Executor) -> Draws:
    """Return models drawn from the posterior, with its maximum at theta (p,)."""
    tasks = [
        Task(
            ("sample-posterior", k + 1),
            drawn,
            (noise, theta, BATCH),
            seed_sequence(seed, "sample-posterior", k + 1),
        )
        for k in range(-(-count // BATCH))
    ]
    work.expect({"sample-posterior": len(tasks)})
    parts = work.run(tasks)
    return Draws(
        *(
            np.concatenate([getattr(part, name) for part in parts])[:count]
            for name in ("theta", "frequency", "mac")
        )
    )


def drawn(noise: NoiseModel, theta: Floats, count: int, *, rng: np.random.Generator) -> Draws:
    """Return some models drawn from the posterior, with its maximum at theta (p,)."""
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
        disturbed = _Scaled(s, Distance(problem, prior, PRIOR), errors)
        target = Wrapped(problem, disturbed.evaluate, NAMES)
        starts = [target.evaluate(prior), disturbed.of(best)]
        found = [solve(target, weighted(w), begin(x), _LOOSE) for x in starts if x.feasible]
        model = min(found, key=lambda x: float(w @ x.J)).evaluation
        out.append(_within_bounds(noise, s, model, rng))
    none = np.empty(0)
    return Draws(
        np.array([x.theta for x in out]),
        *(np.array([x.quantities.get(name, none) for x in out]) for name in ("frequency", "mac")),
    )


def _within_bounds(
    noise: NoiseModel, s: Floats, model: Evaluation, rng: np.random.Generator
) -> Evaluation:
    """Return a draw of which parameters that are at bounds are drawn again."""
    lower, upper = noise.problem.lower, noise.problem.upper
    span, sides = upper - lower, at_bounds(model.theta, lower, upper)
    if not sides.any():
        return model
    scaled = _Scaled(s, Distance(noise.problem, noise.problem.start, 0.0))
    target = Wrapped(noise.problem, scaled.evaluate, NAMES)
    here = target.evaluate(model.theta)
    for j in rng.permutation(np.flatnonzero(sides)):
        theta = here.theta
        r = np.concatenate([x.r for x in here.residuals])
        dr = np.vstack([x.dr for x in here.residuals]) * span
        A = dr.T @ dr + PRIOR * np.eye(span.size)
        free, v = at_bounds(theta, lower, upper) == 0, np.zeros(span.size)
        v[j] = -sides[j]
        v[free] = -np.linalg.solve(A[np.ix_(free, free)], A[free, j] * v[j])
        ends = np.where(v > 0, upper, lower) - theta
        reach = float((ends[v != 0] / (v * span)[v != 0]).min())
        a, g = float(v @ A @ v), float(v @ dr.T @ r)
        t = truncated(-g / a, a**-0.5, reach, rng)
        there = target.evaluate(np.clip(theta + t * v * span, lower, upper))
        excess = float((there.J - here.J).sum()) - a * t**2 - 2 * g * t
        if rng.random() < np.exp(-max(excess, 0.0) / 2):
            here = there
    return here


def truncated(mean: float, std: float, reach: float, rng: np.random.Generator) -> float:
    """Return a draw of a Gaussian between 0 and ``reach``, by inversion in its left tail."""
    if mean > reach / 2:
        return reach - truncated(reach - mean, std, reach, rng)
    inner, outer = log_ndtr(np.array([mean, mean - reach]) / std)
    u = rng.random()
    t = mean - std * ndtri_exp(inner + np.log1p(u * np.expm1(outer - inner)))
    return float(np.clip(t, 0.0, reach))


@dataclass(frozen=True)
class _Scaled:
    """Residuals over their standard deviations and a distance; with other errors where given."""

    s: Floats
    prior: Distance
    errors: Sequence[Floats] = ()

    def evaluate(
        self, problem: Problem, theta: Floats, derivatives: bool, second: bool
    ) -> Evaluation:
        """Return the misfit and the distance, always with the derivatives that residuals take."""
        del derivatives, second
        return self.of(problem.evaluate(theta))

    def of(self, found: Evaluation) -> Evaluation:
        """Return them from an evaluation."""
        if not found.feasible:
            return replace(found, J=np.full(2, np.inf))
        errors = self.errors or [np.zeros(x.r.size) for x in found.residuals]
        parts = [
            Residual((x.r + e) / np.sqrt(v), x.dr / np.sqrt(v))
            for x, e, v in zip(found.residuals, errors, self.s, strict=True)
        ]
        misfit = Residual(np.concatenate([x.r for x in parts]), np.vstack([x.dr for x in parts]))
        r, dr, _ = self.prior.residuals(found.theta)
        both = (misfit, Residual(r, np.diag(dr)))
        slopes = ObjectiveDerivatives(
            np.array([2 * x.r @ x.dr for x in both]), np.array([2 * x.dr.T @ x.dr for x in both])
        )
        J = np.array([x.r @ x.r for x in both])
        return Evaluation(found.theta, J, slopes, found.quantities, both)
