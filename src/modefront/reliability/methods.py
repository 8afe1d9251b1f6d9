"""The methods: how samples are drawn, and the weight of each, of which the mean is P.

docs/methods/first-passage.md names the elementary failures E_oj and the sources. A standard normal
z is made a sample given E_oj by putting its component u along the design excitation right (Au &
Beck 2001, sec. 4):

    z* = z + (r - u) a_oj/σ_oj,      r = -Φ⁻¹(v Φ(-β_oj)),   v uniform in (0, 1].

E_oj is drawn with probability P_oj/ΣP. Weights are ΣP / N(z) of importance sampling; ΣP · 1[E_oj
is the first in time of those that z contains] of the additive rules, of mean 1/N over the failures
of a sample; ΣP · Q(min ρ_oj) / Σ Q(ρ_oj) with Q(ρ) = Γ(ν/2, ρ²/2)/Γ(ν/2) and ρ_oj =
b/|x_oj(e)| of directional importance sampling, z = R e with R integrated out; and 1[any |x_oj| > b]
of Monte Carlo.

Nothing that is computed from z* changes with its sign, so x_oj > b stands for both sides. z is the
same for all levels.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np
from scipy.special import gammaincc, gammainccinv, log_ndtr, ndtr, ndtri_exp

from modefront.reliability.estimate import Prepare, Weigh
from modefront.reliability.gaussian import Convolution, GaussianResponse, IndexArray
from modefront.response.system import FloatArray

NEGLIGIBLE = 1e-22
"""The Q(ρ_oj) left out, relative to the largest: even millions of them are below rounding."""


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


def elementary_failures(response: GaussianResponse, level: float) -> FloatArray:
    """Return the sums of P_oj over the steps of one output after another, (n_outputs · n,).

    The last one, ΣP, may exceed 1.
    """
    # Before the load sets in there is no response, and β is infinite.
    with np.errstate(divide="ignore"):
        beta = level / response.deviation.ravel()
    return np.cumsum(2 * ndtr(-beta))


def given_failure(
    response: GaussianResponse,
    level: float,
    cumulative: FloatArray,
    z: FloatArray,
    uniform: FloatArray,
) -> Failed:
    """Make samples given failure of standard normal ones.

    Parameters
    ----------
    response, level : the map from z to x, and the barrier
    cumulative : `elementary_failures` there, of which one at least has a probability above zero
    z : (samples, n_inputs, n) standard normal numbers
    uniform : (2, samples) uniform numbers in [0, 1): the choice of the elementary failure, and 1 -
        v
    """
    # The last failure of non-zero probability is meant by a number that rounding brings to ΣP.
    last = int(np.searchsorted(cumulative, cumulative[-1], "left"))
    drawn = np.minimum(np.searchsorted(cumulative, uniform[0] * cumulative[-1], "right"), last)
    output, step = np.unravel_index(drawn, response.deviation.shape)
    a, sigma = response.design_excitation(output, step), response.deviation[output, step]
    # In logarithms, as far out in the tail 1 - Φ(β) is zero in floating point.
    r = -ndtri_exp(np.log1p(-uniform[1]) + log_ndtr(-level / sigma))
    u = np.einsum("sik,sik->s", z, a) / sigma
    a *= ((r - u) / sigma)[:, None, None]
    a += z
    return Failed(a, output, step)


Share = Callable[[Failed, float, Iterator[FloatArray]], FloatArray]
"""(samples, level, |x| by output) → the part of ΣP that each sample stands for, (samples,)."""


def conditional(share: Share) -> Prepare:
    """Return the weights ΣP · share, with the same normal numbers at every level."""

    def prepare(response: GaussianResponse, levels: FloatArray) -> Weigh:
        sums = [elementary_failures(response, level) for level in levels.tolist()]

        def weigh(convolution: Convolution, rng: np.random.Generator, count: int) -> FloatArray:
            z = rng.standard_normal((count, response.n_inputs, response.n_steps))
            uniform = rng.random((2, count))
            weights = np.zeros((levels.size, count))
            for row, level, cumulative in zip(weights, levels.tolist(), sums, strict=True):
                # At a barrier so high that P is below the smallest float, the estimate is zero;
                # its coefficient of variation, infinite, says that there were no samples.
                if cumulative[-1] > 0:
                    failed = given_failure(response, level, cumulative, z, uniform)
                    row[:] = cumulative[-1] * share(failed, level, convolution.magnitudes(failed.z))
            return weights

        return weigh

    return prepare


def _one_of_all(failed: Failed, level: float, magnitudes: Iterator[FloatArray]) -> FloatArray:
    exceedances = np.zeros(failed.z.shape[0])
    for x in magnitudes:
        exceedances += np.count_nonzero(x > level, axis=1)
    # The failure that was drawn is one of them, even where rounding leaves it on the barrier.
    return 1 / np.maximum(exceedances, 1)


def _first(failed: Failed, level: float, magnitudes: Iterator[FloatArray]) -> FloatArray:
    first = np.ones(failed.z.shape[0], dtype=bool)
    steps = np.arange(failed.z.shape[-1])
    for output, x in enumerate(magnitudes):
        # At the time of the failure drawn, outputs of lower number come before it.
        end = failed.step + (output < failed.output)
        first &= ~np.any((x > level) & (steps < end[:, None]), axis=1)
    return first.astype(np.float64)


def _any_radius(failed: Failed, level: float, magnitudes: Iterator[FloatArray]) -> FloatArray:
    count = failed.z.shape[0]
    half_nu = failed.z[0].size / 2
    # Below, y = ρ²/2 throughout; x is that of z* and not of e, hence the radius.
    energy = np.einsum("sik,sik->s", failed.z, failed.z) / 2
    # Each sample fails, so min ρ is at most its radius, and Q(min ρ) at least Q(radius). Most x
    # are so small beside the largest that their Q is nothing; they are not worth computing.
    least = NEGLIGIBLE * gammaincc(half_nu, energy)
    floor = level * np.sqrt(energy / gammainccinv(half_nu, least))
    largest = np.zeros(count)
    total = np.zeros(count)
    for x in magnitudes:
        np.maximum(largest, x.max(axis=1), out=largest)
        # Flat: NumPy finds the few that are true of a row many times faster than of a table.
        sample, step = np.divmod(np.flatnonzero(x > floor[:, None]), x.shape[1])
        y = energy[sample] * (level / x[sample, step]) ** 2
        total += np.bincount(sample, gammaincc(half_nu, y), count)
    shortest = gammaincc(half_nu, energy * (level / largest) ** 2)
    return np.asarray(shortest / total, dtype=np.float64)


def _counted(response: GaussianResponse, levels: FloatArray) -> Weigh:
    def weigh(convolution: Convolution, rng: np.random.Generator, count: int) -> FloatArray:
        z = rng.standard_normal((count, response.n_inputs, response.n_steps))
        largest = np.zeros(count)
        for x in convolution.magnitudes(z):
            np.maximum(largest, x.max(axis=1), out=largest)
        return (largest > levels[:, None]).astype(np.float64)

    return weigh


METHODS: Final = MappingProxyType(
    {
        "importance": conditional(_one_of_all),
        "directional": conditional(_any_radius),
        "additive": conditional(_first),
        "monte-carlo": _counted,
    }
)
"""The methods by the names that a user gives them."""
