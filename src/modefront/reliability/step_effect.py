"""Effect of the time step on a first-passage probability.

Looked at on a finer grid, a response is seen to leave [-b, b] more often, and the noise is held
constant for a shorter time. Halving the step shows how much of P is owed to it.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from modefront.reliability.estimate import Estimate, Estimator, spawn
from modefront.reliability.problem import FirstPassage


@dataclass(frozen=True)
class StepEffect:
    """Two estimates of the same probability, with the time step given and with half of it.

    Attributes
    ----------
    given, halved
        The two estimates, from independent samples.

    """

    given: Estimate
    halved: Estimate

    @property
    def ratio(self) -> float:
        """Return P with the halved step over P with the given one; nan if that is zero."""
        given = self.given.probability
        return self.halved.probability / given if given > 0 else np.nan

    @property
    def standard_error(self) -> float:
        """Return the standard error of the ratio, to first order in those of the estimates."""
        pair = (self.given.coefficient_of_variation, self.halved.coefficient_of_variation)
        return float(self.ratio * np.hypot(*pair))


def step_effect(
    estimator: Estimator,
    problem: FirstPassage,
    levels: ArrayLike,
    samples: int,
    seed: np.random.SeedSequence,
    workers: int = 1,
) -> tuple[StepEffect, ...]:
    """Estimate the probability at each level with the time step given and with half of it."""
    finer = replace(problem, time_step=problem.time_step / 2)
    given = estimator(problem, levels, samples, spawn(seed, 0), workers)
    halved = estimator(finer, levels, samples, spawn(seed, 1), workers)
    return tuple(StepEffect(*pair) for pair in zip(given, halved, strict=True))
