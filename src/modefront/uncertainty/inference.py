"""What the posterior says about a most probable model: draws, misfit, bounds and measurements.

A bound that excludes the truth also drives other parameters to theirs. All bounds that hold the
model are widened at once, and only those beyond which it then lies are to blame.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Floats
from modefront.optim.problem import at_bounds
from modefront.uncertainty.laplace import Posterior
from modefront.uncertainty.most_probable import maximum
from modefront.uncertainty.planning import Candidates, candidates
from modefront.uncertainty.prior import NoiseModel, prior_widths
from modefront.uncertainty.sampling import Draws, draw_models
from modefront.work.codec import record
from modefront.work.task import Executor, Task


@record
@dataclass(frozen=True)
class Fit:
    """How the most probable model fits, and what could be measured besides.

    Attributes
    ----------
    misfit, nominal : (n,) root mean square errors of the groups, and those of the nominal model,
        over those expected
    pairs : (modes,) the model mode that is most likely to be each measured one, from 1
    candidates : further measurements
    """

    misfit: Floats
    nominal: Floats
    pairs: Floats
    candidates: Candidates


@record
@dataclass(frozen=True)
class Freed:
    """The most probable model between wider bounds.

    Attributes
    ----------
    theta : (p,) its parameters
    misfit : (n,) its root mean square errors over those expected
    """

    theta: Floats
    misfit: Floats


@dataclass(frozen=True)
class Inference:
    """The posterior, and what its maximum says.

    Attributes
    ----------
    draws : models drawn from the posterior
    fit : of its maximum
    freed : the maximum between wider bounds; None where no bound holds it
    widths : (p,) of the 90 % intervals of the priors
    assumed : in words, which errors are assumed; empty for none
    """

    draws: Draws
    fit: Fit
    freed: Freed | None
    widths: Floats
    assumed: str

    @property
    def gaussian(self) -> Posterior:
        """The Gaussian with the covariance of the draws."""
        p = self.widths.size
        lam, V = np.linalg.eigh(np.cov(self.draws.theta, rowvar=False).reshape(p, p))
        moved = lam > np.finfo(float).eps * lam.max(initial=0.0)
        axes = V[:, moved] * np.sqrt(lam[moved])
        return Posterior(axes, np.zeros(p, dtype=np.bool_), np.zeros((p, 0)))


def infer(
    noise: NoiseModel, maxima: Sequence[Floats], count: int, seed: int, work: Executor
) -> Inference:
    """Return what follows from the posterior with maxima (p,), the greatest first, by draws."""
    draws, theta = draw_models(noise, maxima, count, seed, work), maxima[0]
    (fit,) = work.run([Task(("most-probable", "fit"), _fit, (noise, theta))])
    return Inference(
        draws, fit, freed(noise, theta, work), prior_widths(noise.problem), noise.assumed
    )


def _fit(noise: NoiseModel, theta: Floats) -> Fit:
    """Return how a model fits."""
    problem = noise.problem
    found, nominal = problem.evaluate(theta), problem.evaluate(problem.start, derivatives=False)
    misfit, before = (noise.over_expected(x.J) for x in (found, nominal))
    return Fit(misfit, before, found.quantities["paired_mode"], candidates(noise, found))


def freed(noise: NoiseModel, theta: Floats, work: Executor) -> Freed | None:
    """Return the most probable model without the bounds that hold theta (p,).

    None where no bound holds it, and where the search without them does not converge.
    """
    lower, upper = noise.problem.lower, noise.problem.upper
    sides = at_bounds(theta, lower, upper)
    if not sides.any():
        return None
    wider_lower, wider_upper = wider(lower, upper)
    problem = replace(
        noise.problem,
        lower=np.where(sides < 0, wider_lower, lower),
        upper=np.where(sides > 0, wider_upper, upper),
    )
    (found,) = work.run(
        [Task(("most-probable", "freed"), _freed, (replace(noise, problem=problem), theta))]
    )
    out: Freed | None = found
    return out


def wider(lower: Floats, upper: Floats) -> tuple[Floats, Floats]:
    """Return bounds (p,) that are farther away by the range, or by the ratio of positive ones."""
    positive = lower > 0
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(positive, upper / lower, 1.0)
        below = np.where(positive, lower / ratio, 2 * lower - upper)
        above = np.where(positive, upper * ratio, 2 * upper - lower)
    return below, above


def _freed(noise: NoiseModel, theta: Floats) -> Freed | None:
    """Return the model to which theta (p,) leads; None where the search does not converge."""
    found = maximum(noise, theta)
    return Freed(found.theta, noise.over_expected(found.J[:-1])) if found.converged else None
