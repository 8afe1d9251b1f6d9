"""Direct Monte Carlo: the fraction of samples that fail.

The weight of a sample is 1 if max_oj |x_oj| > b and 0 otherwise; its unit coefficient of
variation is sqrt((1 - P)/P). For checking the other methods where P is not small.
"""

import numpy as np

from modefront.reliability.estimate import Estimator, Weigh
from modefront.reliability.gaussian import Convolution, GaussianResponse
from modefront.response.system import FloatArray


def _prepare(response: GaussianResponse, levels: FloatArray) -> Weigh:
    def weigh(convolution: Convolution, rng: np.random.Generator, count: int) -> FloatArray:
        z = rng.standard_normal((count, response.n_inputs, response.n_steps))
        largest = np.zeros(count)
        for x in convolution.magnitudes(z):
            np.maximum(largest, x.max(axis=1), out=largest)
        return (largest > levels[:, None]).astype(np.float64)

    return weigh


monte_carlo = Estimator("Monte Carlo", _prepare)
