"""The responses at the times t_j as a linear map of independent standard normal numbers.

With h the pulse response scaled by sqrt(2πS/Δt), the response o at t_j is

    x_oj = Σ_i Σ_{k<j} h_oi[j-1-k] q_k z_ik  =  a_oj · z,        z ~ N(0, I),

a convolution, done for many samples at once by the fast Fourier transform. The pulse response is
exact for a load held constant over a step: with ṡ = A s + B w for s = (q, q̇[, f, ḟ]) of a mode and
the filter, s(t + Δt) = Φ s(t) + Θ w, where exp([A B; 0 0] Δt) = [Φ Θ; 0 1].

======  ==========================================  ==========================
symbol  meaning                                     shape
======  ==========================================  ==========================
z       normal numbers of one sample                (n_inputs, n)
x       responses                                   (n_outputs, n), at t_1 …
h       pulse response for unit normal numbers      (n_outputs, n_inputs, n)
q       modulation                                  (n,)
σ       standard deviation of x                     (n_outputs, n)
======  ==========================================  ==========================
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray
from scipy.fft import next_fast_len
from scipy.linalg import expm

from modefront.reliability.problem import FirstPassage
from modefront.response.system import FloatArray, ModalSystem

IndexArray = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class GaussianResponse:
    """The map from z to x, made by `gaussian_response`.

    Attributes
    ----------
    modulation : (n,) q
    spectrum : (n_outputs, n_inputs, n_frequencies) transform of h, padded so that nothing wraps
        round
    backwards : (n_outputs, n_inputs, 2n - 1) h backwards in time, then zeros: the window of length
        n at n - 1 - j is h_oi[j - k], k = 0 … n-1
    deviation : (n_outputs, n) σ
    """

    modulation: FloatArray
    spectrum: NDArray[np.complex128]
    backwards: FloatArray
    deviation: FloatArray

    @property
    def n_inputs(self) -> int:
        """Number of loads."""
        return int(self.backwards.shape[1])

    @property
    def n_steps(self) -> int:
        """Number n of times."""
        return int(self.deviation.shape[1])

    def design_excitation(self, output: IndexArray, step: IndexArray) -> FloatArray:
        """Return a_oj, (samples, n_inputs, n), for (samples,) pairs; step j counts from 0."""
        n = self.n_steps
        direction = np.empty((output.size, self.n_inputs, n))
        for row, o, start in zip(direction, output, n - 1 - step, strict=True):
            np.multiply(self.backwards[o, :, start : start + n], self.modulation, out=row)
        return direction


@final
class Convolution:
    """Turns samples of z into |x|, in memory of its own: one for each worker.

    Fresh arrays for every chunk would cost more time than the transforms.

    Parameters
    ----------
    response : the map from z to x
    samples : the largest number of samples at once
    """

    def __init__(self, response: GaussianResponse, samples: int) -> None:
        size = _fft_size(response.n_steps)
        load = (samples, response.n_inputs)
        self._response = response
        self._padded = np.zeros((*load, size))
        self._spectrum = np.empty((*load, size // 2 + 1), dtype=np.complex128)
        self._product = np.empty((2, samples, size // 2 + 1), dtype=np.complex128)
        self._x = np.empty((samples, size))

    def magnitudes(self, z: FloatArray) -> Iterator[FloatArray]:
        """Yield |x| of one output after another, each (samples, n), for z (samples, n_inputs, n).

        One output at a time, so that memory does not grow with their number; each is overwritten
        by the next.
        """
        count, n = z.shape[0], self._response.n_steps
        padded, load, x = self._padded[:count], self._spectrum[:count], self._x[:count]
        product, term = self._product[:, :count]
        np.multiply(z, self._response.modulation, out=padded[..., :n])
        np.fft.rfft(padded, out=load)
        for spectrum in self._response.spectrum:
            np.multiply(load[:, 0], spectrum[0], out=product)
            for i in range(1, self._response.n_inputs):
                product += np.multiply(load[:, i], spectrum[i], out=term)
            np.fft.irfft(product, x.shape[-1], out=x)
            yield np.abs(x[:, :n], out=x[:, :n])


def pulse_response(problem: FirstPassage) -> FloatArray:
    """Return the outputs at t_1 … t_n after a unit pulse on [0, Δt) at one input.

    The array is (n_outputs, n_inputs, n), in units of output per unit load.
    """
    generator = _generator(problem.system, problem.soil)
    step = np.asarray(expm(generator * problem.time_step))
    power, states = step[:, :-1, :-1], step[:, :-1, -1:]
    while states.shape[-1] < problem.steps:
        # Not `@`: sums of two to four terms need no BLAS, whose threads may change the last digit.
        states = np.concatenate([states, np.einsum("mij,mjk->mik", power, states)], axis=-1)
        power = np.einsum("mij,mjk->mik", power, power)
    modal = states[:, 0, : problem.steps]
    shapes = problem.system
    outputs: FloatArray = np.einsum("om,mi,mk->oik", shapes.output, shapes.input, modal)
    return outputs


def _generator(system: ModalSystem, soil: tuple[float, float] | None) -> FloatArray:
    """Return [A B; 0 0] of each mode, (m, 3, 3), or (m, 5, 5) with a filter."""
    size = 3 if soil is None else 5
    generator = np.zeros((system.omega.size, size, size))
    generator[:, 0, 1] = 1
    generator[:, 1, 0] = -(system.omega**2)
    generator[:, 1, 1] = -2 * system.zeta * system.omega
    if soil is None:
        generator[:, 1, 2] = 1
    else:
        omega, zeta = soil
        generator[:, 1, 2:4] = omega**2, 2 * zeta * omega
        generator[:, 2, 3] = 1
        generator[:, 3, 2:] = -(omega**2), -2 * zeta * omega, 1
    return generator


def gaussian_response(problem: FirstPassage) -> GaussianResponse:
    """Return the map from standard normal numbers to the responses of `problem`."""
    h = pulse_response(problem) * np.sqrt(problem.intensity / problem.time_step)
    n = h.shape[-1]
    middle = np.asarray((np.arange(n) + 0.5) * problem.time_step)
    q = np.ones(n) if problem.modulation is None else problem.modulation(middle)
    size = _fft_size(n)
    squares = (np.fft.rfft(h**2, size) * np.fft.rfft(q**2, size)).sum(axis=1)
    variance = np.fft.irfft(squares, size)[:, :n]
    return GaussianResponse(
        modulation=q,
        spectrum=np.fft.rfft(h, size),
        backwards=np.concatenate([h[..., ::-1], np.zeros((*h.shape[:-1], n - 1))], axis=-1),
        # Rounding may leave a variance of zero, before the load sets in, just below it.
        deviation=np.sqrt(np.maximum(variance, 0)),
    )


def _fft_size(n: int) -> int:
    return int(next_fast_len(2 * n - 1, real=True))
