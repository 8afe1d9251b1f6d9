"""Direct Monte Carlo: the fraction of samples that fail.

The weight of a sample is 1 if max_oj |x_oj| > b and 0 otherwise; its unit coefficient of
variation is sqrt((1 - P)/P). For checking the other methods where P is not small.
"""

import numpy as np
from numpy.typing import ArrayLike

from modefront.reliability.estimate import Estimate, Weigh, estimate
from modefront.reliability.gaussian import Convolution, GaussianResponse
from modefront.reliability.problem import FirstPassage
from modefront.response.checks import FloatArray


def monte_carlo(
    problem: FirstPassage,
    levels: ArrayLike,
    samples: int,
    seed: np.random.SeedSequence,
    workers: int = 1,
) -> tuple[Estimate, ...]:
    """Estimate the first-passage probability at each of (n_levels,) barriers by counting.

    See `modefront.reliability.estimate.estimate` for errors.
    """
    return estimate("Monte Carlo", _prepare, problem, levels, samples, seed, workers)


def _prepare(response: GaussianResponse, levels: FloatArray) -> Weigh:
    def weigh(convolution: Convolution, rng: np.random.Generator, count: int) -> FloatArray:
        z = rng.standard_normal((count, response.n_inputs, response.n_steps))
        largest = np.zeros(count)
        for x in convolution.magnitudes(z):
            np.maximum(largest, x.max(axis=1), out=largest)
        return (largest > levels[:, None]).astype(np.float64)

    return weigh
