"""Elementary failures, and samples of z given one of them.

Failure is the union of the elementary failures E_oj = {|x_oj| > b}, whose probabilities are known:

    P_oj = P(E_oj) = 2 Φ(-β_oj),     β_oj = b/σ_oj.

Given E_oj, z has the standard normal density but for its component u = z·a_oj/σ_oj = x_oj/σ_oj
along the design excitation, which is a normal number beyond ±β_oj. So a standard normal z is made
a sample given E_oj by putting that component right (S. K. Au, J. L. Beck, Probab. Eng. Mech. 16
(2001) 193-207, doi:10.1016/S0266-8920(01)00002-9, sec. 4):

    z* = z + (r - u) a_oj/σ_oj,      r = -Φ⁻¹(v Φ(-β_oj)),   v uniform in (0, 1].

The elementary failure itself is drawn with probability P_oj/ΣP. Nothing that is computed from z*
changes with its sign, so x_oj > b stands for both sides. z is the same for all levels.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.special import log_ndtr, ndtr, ndtri_exp

from modefront.reliability.estimate import Prepare, Weigh
from modefront.reliability.gaussian import Convolution, GaussianResponse, IndexArray
from modefront.response.system import FloatArray


@dataclass(frozen=True, eq=False)
class ElementaryFailures:
    """The elementary failures at one barrier, made by `elementary_failures`.

    Attributes
    ----------
    response : the map from z to x
    level : barrier b
    cumulative : (n_outputs · n,) sums of P_oj over the steps of one output after another
    """

    response: GaussianResponse
    level: float
    cumulative: FloatArray

    @property
    def total(self) -> float:
        """ΣP, the sum over all elementary failures, which may exceed 1."""
        return float(self.cumulative[-1])


@dataclass(frozen=True, eq=False)
class Failed:
    """Samples, each given an elementary failure drawn with probability P_oj/ΣP.

    Attributes
    ----------
    z : (samples, n_inputs, n) z*
    output, step : (samples,) o and j, counted from 0, of the elementary failure that each sample
        was given
    """

    z: FloatArray
    output: IndexArray
    step: IndexArray


def elementary_failures(response: GaussianResponse, level: float) -> ElementaryFailures:
    """Return the elementary failures at the barrier `level`."""
    # Before the load sets in there is no response, and β is infinite.
    with np.errstate(divide="ignore"):
        beta = level / response.deviation.ravel()
    return ElementaryFailures(response, level, np.cumsum(2 * ndtr(-beta)))


def given_failure(failures: ElementaryFailures, z: FloatArray, uniform: FloatArray) -> Failed:
    """Make samples given failure of standard normal ones.

    Parameters
    ----------
    failures : the elementary failures, of which one at least has a probability above zero
    z : (samples, n_inputs, n) standard normal numbers
    uniform : (2, samples) uniform numbers in [0, 1): the choice of the elementary failure, and 1 -
        v
    """
    response, cumulative = failures.response, failures.cumulative
    # The last failure of non-zero probability is meant by a number that rounding brings to ΣP.
    last = int(np.searchsorted(cumulative, cumulative[-1], "left"))
    drawn = np.minimum(np.searchsorted(cumulative, uniform[0] * cumulative[-1], "right"), last)
    output, step = np.unravel_index(drawn, response.deviation.shape)
    a, sigma = response.design_excitation(output, step), response.deviation[output, step]
    # In logarithms, as far out in the tail 1 - Φ(β) is zero in floating point.
    r = -ndtri_exp(np.log1p(-uniform[1]) + log_ndtr(-failures.level / sigma))
    u = np.einsum("sik,sik->s", z, a) / sigma
    a *= ((r - u) / sigma)[:, None, None]
    a += z
    return Failed(a, output, step)


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
