"""What the posterior says about a most probable model: draws, misfit, bounds and measurements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.uncertainty.freed import Freed, freed
from modefront.uncertainty.laplace import Posterior
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


def infer(noise: NoiseModel, theta: Floats, count: int, seed: int, work: Executor) -> Inference:
    """Return what follows from the posterior with its maximum at theta (p,), by ``count`` draws."""
    draws = draw_models(noise, theta, count, seed, work)
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
