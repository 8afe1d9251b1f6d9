"""The first-passage problem; docs/methods/first-passage.md states it, and has the sources.

Densities are per rad/s. The noise may be modulated, q(t_k + Δt/2) w_k, and may then pass the filter
(ω_g² + 2iζ_g ω_g ω) / (ω_g² - ω² + 2iζ_g ω_g ω) of a soil, the absolute acceleration of a damped
oscillator on a base accelerated by it (H. Tajimi, Proc. 2nd World Conf. Earthquake Eng. (1960)
781-797).

The response o at t_j is a convolution with the pulse response h scaled by sqrt(2πS/Δt), done for
many samples at once by the fast Fourier transform,

    x_oj = Σ_i Σ_{k<j} h_oi[j-1-k] q_k z_ik  =  a_oj · z,        z ~ N(0, I).

The pulse response is exact for a load held constant over a step: with ṡ = A s + B w for s = (q, q̇[,
f, ḟ]) of a mode and the filter, s(t + Δt) = Φ s(t) + Θ w, where exp([A B; 0 0] Δt) = [Φ Θ; 0 1].

The methods say how samples are drawn, and the weight of each, of which the mean is P. A z is made a
sample given the elementary failure E_oj, drawn with probability P_oj/ΣP, by putting its component u
along the design excitation right (Au & Beck 2001, sec. 4):

    z* = z + (r - u) a_oj/σ_oj,      r = -Φ⁻¹(v Φ(-β_oj)),   v uniform in (0, 1].

Weights are ΣP / N(z) of importance sampling; ΣP · 1[E_oj is the first in time of those that z
contains] of the additive rules, of mean 1/N over the failures of a sample; ΣP · Q(min ρ_oj) /
Σ Q(ρ_oj) with Q(ρ) = Γ(ν/2, ρ²/2)/Γ(ν/2) and ρ_oj = b/|x_oj(e)| of directional importance sampling,
z = R e with R integrated out; and 1[any |x_oj| > b] of Monte Carlo. Nothing that is computed from
z* changes with its sign, so x_oj > b stands for both sides. z is the same for all levels.

Samples are drawn in chunks; each has a generator of its own, spawned from the seed by its number,
and its size follows from the problem alone, so who computes it changes nothing.
"""

import math
import os
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np
from numpy.typing import NDArray
from scipy.fft import next_fast_len
from scipy.linalg import expm
from scipy.special import gammaincc, gammainccinv, log_ndtr, ndtr, ndtri_exp

from modefront._typing import Floats, Ints
from modefront.predictions.system import ModalSystem

LARGEST_ANGLE = np.pi / 2  # largest ω Δt: beyond a quarter of a period, times miss the peaks


@dataclass(frozen=True)
class FirstPassage:
    """A linear structure at rest, its Gaussian load, and the times at which it is looked at.

    The responses are displacements at the outputs of the system, of its modes alone: white noise
    has no quasi-static response. Rows of the ``output`` bring other barriers to a common one.
    """

    system: ModalSystem  # the structure, with n_inputs loads and n_outputs responses
    # 2πS of the white noise, independent at each input, with its two-sided spectral density S in
    # (unit of load)²/(rad/s)
    intensity: float
    duration: float  # T in s, a whole number of time steps
    time_step: float  # δt in s, at most a quarter of the shortest period of a mode or of the filter
    # ω_g in rad/s and ζ_g of the filter that the noise passes, or None
    soil: tuple[float, float] | None = None
    # q, mapping an (n,) array of times in s to (n,) factors; None for a constant 1
    modulation: Callable[[Floats], Floats] | None = None


@dataclass(frozen=True, eq=False)
class GaussianResponse:
    """The map from z (n_inputs, n) to the responses x (n_outputs, n) at t_1 … t_n."""

    modulation: Floats  # (n,) q
    # (n_outputs, n_inputs, n_frequencies) transform of h, padded so that nothing wraps round
    spectrum: NDArray[np.complex128]
    # (n_outputs, n_inputs, 2n - 1) h backwards in time, then zeros: the window of length n at n - 1
    # - j is h_oi[j - k], k = 0 … n-1
    backwards: Floats
    deviation: Floats  # (n_outputs, n) σ

    @property
    def load(self) -> tuple[int, int]:
        """Numbers (n_inputs, n) of loads and times."""
        return self.backwards.shape[1], self.deviation.shape[1]

    def design_excitation(self, output: Ints, step: Ints) -> Floats:
        """Return a_oj, (samples, n_inputs, n), for (samples,) pairs; step j counts from 0."""
        direction, n = np.empty((output.size, *self.load)), self.load[1]
        for row, o, start in zip(direction, output, n - 1 - step, strict=True):
            np.multiply(self.backwards[o, :, start : start + n], self.modulation, out=row)
        return direction


@final
class Convolution:
    """Turns so many samples of z into |x|, in memory of its own: fresh arrays cost more time."""

    def __init__(self, response: GaussianResponse, samples: int) -> None:
        self.response, (inputs, n) = response, response.load
        size, load = next_fast_len(2 * n - 1, real=True), (samples, inputs)
        self._padded = np.zeros((*load, size))
        self._spectrum = np.empty((*load, size // 2 + 1), dtype=np.complex128)
        self._product = np.empty((2, samples, size // 2 + 1), dtype=np.complex128)
        self._x = np.empty((samples, size))

    def magnitudes(self, z: Floats) -> Iterator[Floats]:
        """Yield |x| of one output after another, each (samples, n), for z (samples, n_inputs, n).

        Each is overwritten by the next, so that memory does not grow with their number.
        """
        count, inputs, n = z.shape
        padded, load, x = self._padded[:count], self._spectrum[:count], self._x[:count]
        product, term = self._product[:, :count]
        np.multiply(z, self.response.modulation, out=padded[..., :n])
        np.fft.rfft(padded, out=load)
        for spectrum in self.response.spectrum:
            np.multiply(load[:, 0], spectrum[0], out=product)
            for i in range(1, inputs):
                product += np.multiply(load[:, i], spectrum[i], out=term)
            np.fft.irfft(product, x.shape[-1], out=x)
            yield np.abs(x[:, :n], out=x[:, :n])


def pulse_response(problem: FirstPassage) -> Floats:
    """Return the outputs (n_outputs, n_inputs, n) after a unit pulse on [0, Δt) at one input."""
    shapes, size = problem.system, 3 if problem.soil is None else 5
    generator = np.zeros((shapes.omega.size, size, size))  # [A B; 0 0] of each mode
    generator[:, 0, 1] = 1
    generator[:, 1, 0] = -(shapes.omega**2)
    generator[:, 1, 1] = -2 * shapes.zeta * shapes.omega
    if problem.soil is None:
        generator[:, 1, 2] = 1
    else:
        omega, zeta = problem.soil
        generator[:, 1, 2:4] = omega**2, 2 * zeta * omega
        generator[:, 2, 3] = 1
        generator[:, 3, 2:] = -(omega**2), -2 * zeta * omega, 1
    step = np.asarray(expm(generator * problem.time_step))
    power, states = step[:, :-1, :-1], step[:, :-1, -1:]
    steps = round(problem.duration / problem.time_step)
    while states.shape[-1] < steps:
        # Not `@`: sums of two to four terms need no BLAS, whose threads may change the last digit.
        states = np.concatenate([states, np.einsum("mij,mjk->mik", power, states)], axis=-1)
        power = np.einsum("mij,mjk->mik", power, power)
    modal = states[:, 0, :steps]
    return np.einsum("om,mi,mk->oik", shapes.output, shapes.input, modal)


def gaussian_response(problem: FirstPassage) -> GaussianResponse:
    """Return the map from standard normal numbers to the responses of `problem`."""
    h = pulse_response(problem) * np.sqrt(problem.intensity / problem.time_step)
    n = h.shape[-1]
    middle = np.asarray((np.arange(n) + 0.5) * problem.time_step)
    q = np.ones(n) if problem.modulation is None else problem.modulation(middle)
    size = next_fast_len(2 * n - 1, real=True)
    squares = (np.fft.rfft(h**2, size) * np.fft.rfft(q**2, size)).sum(axis=1)
    variance = np.fft.irfft(squares, size)[:, :n]
    return GaussianResponse(
        modulation=q,
        spectrum=np.fft.rfft(h, size),
        backwards=np.concatenate([h[..., ::-1], np.zeros((*h.shape[:-1], n - 1))], axis=-1),
        # Rounding may leave a variance of zero, before the load sets in, just below it.
        deviation=np.sqrt(np.maximum(variance, 0)),
    )


NEGLIGIBLE = 1e-22  # Q(ρ_oj) over the largest that is left out: millions are below rounding


def elementary_failures(response: GaussianResponse, level: float) -> Floats:
    """Return sums (n_outputs · n,) of P_oj, output after output; the last, ΣP, may exceed 1."""
    # Before the load sets in there is no response, and β is infinite.
    with np.errstate(divide="ignore"):
        beta = level / response.deviation.ravel()
    return np.cumsum(2 * ndtr(-beta))


Share = Callable[[Floats, tuple[Ints, Ints], float, Iterator[Floats]], Floats]
"""Returns the part of ΣP that each sample stands for, (samples,): of samples z* (samples, n_inputs,
n), each given an elementary failure drawn with probability P_oj/ΣP, of o and j (samples,) of that,
counted from 0, the level, and |x| of one output after another."""


# 6 arguments: the levels with what belongs to them, and the samples.
def _given_failures(
    share: Share,
    levels: Floats,
    sums: Sequence[Floats],
    convolution: Convolution,
    z: Floats,
    rng: np.random.Generator,
) -> Floats:
    """Return the weights ΣP · share (n_levels, samples), of the same numbers z at every level."""
    response, uniform = convolution.response, rng.random((2, len(z)))
    weights = np.zeros((levels.size, len(z)))
    for row, level, cumulative in zip(weights, levels.tolist(), sums, strict=True):
        # At a barrier so high that P is below the smallest float, the estimate is zero;
        # its coefficient of variation, infinite, says that there were no samples.
        if cumulative[-1] == 0:
            continue
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
        row[:] = cumulative[-1] * share(a, (output, step), level, convolution.magnitudes(a))
    return weights


def _one_of_all(z: Floats, _: tuple[Ints, Ints], level: float, sizes: Iterator[Floats]) -> Floats:
    exceedances = np.zeros(len(z))
    for x in sizes:
        exceedances += np.count_nonzero(x > level, axis=1)
    # The failure that was drawn is one of them, even where rounding leaves it on the barrier.
    return 1 / np.maximum(exceedances, 1)


def _first(z: Floats, drawn: tuple[Ints, Ints], level: float, sizes: Iterator[Floats]) -> Floats:
    first, steps = np.ones(len(z), dtype=bool), np.arange(z.shape[-1])
    for output, x in enumerate(sizes):
        # At the time of the failure drawn, outputs of lower number come before it.
        end = drawn[1] + (output < drawn[0])
        first &= ~np.any((x > level) & (steps < end[:, None]), axis=1)
    return first.astype(np.float64)


def _any_radius(z: Floats, _: tuple[Ints, Ints], level: float, sizes: Iterator[Floats]) -> Floats:
    count, half_nu = len(z), z[0].size / 2
    # Below, y = ρ²/2 throughout; x is that of z* and not of e, hence the radius.
    energy = np.einsum("sik,sik->s", z, z) / 2
    # Each sample fails, so min ρ is at most its radius, and Q(min ρ) at least Q(radius). Most x
    # are so small beside the largest that their Q is nothing; they are not worth computing.
    least = NEGLIGIBLE * gammaincc(half_nu, energy)
    floor = level * np.sqrt(energy / gammainccinv(half_nu, least))
    largest, total = np.zeros((2, count))
    for x in sizes:
        np.maximum(largest, x.max(axis=1), out=largest)
        # Flat: NumPy finds the few that are true of a row many times faster than of a table.
        sample, step = np.divmod(np.flatnonzero(x > floor[:, None]), x.shape[1])
        y = energy[sample] * (level / x[sample, step]) ** 2
        total += np.bincount(sample, gammaincc(half_nu, y), count)
    shortest = gammaincc(half_nu, energy * (level / largest) ** 2)
    return np.asarray(shortest / total, dtype=np.float64)


METHODS: Final[Mapping[str, Share | None]] = {
    **{"importance": _one_of_all, "directional": _any_radius, "additive": _first},
    "monte-carlo": None,  # failures are counted
}
"""The methods by the names that a user gives them."""

LARGEST_CHUNK = 32  # samples in a chunk: enough for the loops in C, few enough for the cache

MOST_WORKERS = 8  # threads at most, of some 100 MB each; how many there are changes no digit
LARGEST_BLOCK = 2**20  # normal numbers in a chunk, 8 MB: keeps a worker to some 100 MB


def spawn(seed: np.random.SeedSequence, number: int) -> np.random.SeedSequence:
    """Return the child of that number; unlike `seed.spawn`, the same one whenever asked for."""
    key = (*seed.spawn_key, number)
    return np.random.SeedSequence(seed.entropy, spawn_key=key, pool_size=seed.pool_size)


# 6 arguments: the method, what is asked of it, and how.
def estimate(
    method: Share | None,
    problem: FirstPassage,
    levels: Floats,
    samples: int,
    seed: np.random.SeedSequence,
    workers: int = 0,
) -> tuple[Floats, Floats]:
    """Return P and the coefficient of variation of its estimate at barriers, (n_levels,) each.

    ``method`` is one of `METHODS`. Where no sample failed, P is zero and the coefficient infinite.
    """
    response = gaussian_response(problem)
    sums = [elementary_failures(response, level) for level in levels.tolist()]
    largest = LARGEST_BLOCK // math.prod(response.load)
    chunk = min(max(largest, 1), LARGEST_CHUNK)
    workers = workers or min(os.cpu_count() or 1, MOST_WORKERS)
    own = threading.local()  # a convolution for each thread

    def begin() -> None:
        own.convolution = Convolution(response, chunk)

    def weights_of(number: int) -> Floats:
        count = min(chunk, samples - number * chunk)
        rng = np.random.default_rng(spawn(seed, number))
        z = rng.standard_normal((count, *response.load))
        if method is not None:
            return _given_failures(method, levels, sums, own.convolution, z, rng)
        greatest = np.max([x.max(axis=1) for x in own.convolution.magnitudes(z)], axis=0)
        return (greatest > levels[:, None]).astype(np.float64)

    with ThreadPoolExecutor(workers, initializer=begin) as pool:
        chunks = pool.map(weights_of, range(-(-samples // chunk)))
        weights = np.concatenate(list(chunks), axis=1)
    P = weights.mean(axis=1)
    std = weights.std(axis=1, ddof=1)
    unit = np.divide(std, P, out=np.full(P.size, np.inf), where=P > 0)
    return P, unit / np.sqrt(samples)


def step_effect(
    method: Share | None,
    problem: FirstPassage,
    levels: Floats,
    samples: int,
    seed: np.random.SeedSequence,
) -> tuple[Floats, Floats]:
    """Return P with half the time step over P, and its standard error, (n_levels,) each.

    Looked at on a finer grid, a response is seen to leave [-b, b] more often, and the noise is held
    constant for a shorter time: the ratio shows how much of P is owed to the step. The estimates
    are of independent samples, and the error is to first order in theirs. NaN where P is zero.
    """
    finer = replace(problem, time_step=problem.time_step / 2)
    (P, own), (halved, other) = (
        estimate(method, each, levels, samples, spawn(seed, k))
        for k, each in enumerate((problem, finer))
    )
    ratio = np.divide(halved, P, out=np.full(P.size, np.nan), where=P > 0)
    return ratio, ratio * np.hypot(own, other)
