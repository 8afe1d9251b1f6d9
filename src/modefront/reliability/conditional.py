"""Common part of the methods that sample given an elementary failure."""

from collections.abc import Callable, Iterator

import numpy as np

from modefront.reliability.elementary import Failed, elementary_failures, given_failure
from modefront.reliability.estimate import Prepare, Weigh
from modefront.reliability.gaussian import Convolution, GaussianResponse
from modefront.response.checks import FloatArray

Share = Callable[[Failed, float, Iterator[FloatArray]], FloatArray]
"""(samples, level, |x| by output) → the part of ΣP that each sample stands for, (samples,)."""


def conditional(share: Share) -> Prepare:
    """Return the weights ΣP · share, with the same normal numbers at every level."""

    def prepare(response: GaussianResponse, levels: FloatArray) -> Weigh:
        everywhere = [elementary_failures(response, level) for level in levels.tolist()]

        def weigh(convolution: Convolution, rng: np.random.Generator, count: int) -> FloatArray:
            z = rng.standard_normal((count, response.n_inputs, response.n_steps))
            uniform = rng.random((2, count))
            weights = np.zeros((levels.size, count))
            for row, failures in zip(weights, everywhere, strict=True):
                # At a barrier so high that P is below the smallest float, the estimate is zero;
                # its coefficient of variation, infinite, says that there were no samples.
                if failures.total > 0:
                    failed = given_failure(failures, z, uniform)
                    magnitudes = convolution.magnitudes(failed.z)
                    row[:] = failures.total * share(failed, failures.level, magnitudes)
            return weights

        return weigh

    return prepare
