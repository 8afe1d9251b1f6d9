"""What poles all over the band explain of the residuals of a fit."""

from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
import scipy.fft
from scipy.ndimage import percentile_filter

from modefront._typing import Complexes, Floats
from modefront.identification.noise import square
from modefront.identification.problem import Problem, gram
from modefront.rounding import TINY

HEAVIEST = 0.1  # greatest damping ratio of the poles that are looked for in residuals
NEIGHBOURHOOD = 32  # half bandwidths about a pole in which those of its damping tell the noise
UPPER = 0.8  # share of these poles that explain less than the level that tells the noise
DRAWS, SEED = 1000, 1  # matrices of noise that tell what poles explain of it, and their seed
MOST_PLACES = 1 << 18  # places of the grid of lines, at most
PORTION = 32  # responses whose products with poles are computed at once
ROUNDING = 1e-12  # share of the greatest energy of a pole's function below which there is none

LEAST_OWN = 0.01
"""Share of a pole's function that modes of the fit do not make up, at least: of less, rounding and
differences between the weights of responses are as large."""


def alike(pole: complex, others: Complexes) -> Floats:
    """Return the squared correlation of a pole's function with those of others."""
    return 4 * pole.real * others.real / np.abs(pole + others.conj()) ** 2


@dataclass(frozen=True)
class Scan:
    """Poles all over the band, and what each explains of the residuals of a fit."""

    lam: Complexes  # (poles,) half bandwidths, and steps, go up from those of lines by factors of 2
    gain: Floats  # (poles,) 2 Delta J of each in units of its noise
    L: Complexes  # (poles, references) its participation factors
    # (poles,) variance of the noise, as poles of the same damping find it in the neighbourhood; at
    # least that of the residuals, and 1, the variance of the data
    noise: Floats

    def noise_of(self, lam: Complexes) -> Floats:
        """Return the variance of the noise at other poles, (others,)."""
        return np.array([self.noise[alike(pole, self.lam).argmax()] for pole in lam])


@cache
def _expected(rows: int, columns: int) -> float:
    """Return the quantile of the greatest squared singular value of noise of unit variance."""
    rng = np.random.default_rng(SEED)
    z = (rng.standard_normal((2, DRAWS, rows, columns)) * [[[[1]]], [[[1j]]]]).sum(axis=0)
    greatest = np.linalg.eigvalsh(z @ z.conj().swapaxes(1, 2))[:, -1] / 2
    return float(np.quantile(greatest, UPPER))


def scan(task: Problem, r: Complexes, misfit: float, E: Complexes, T: Floats) -> Scan:
    """Return what poles explain of residuals, (references, responses, lines), beside a fit.

    On an even grid of lines, the products of the residuals with a pole are a convolution. The
    ``misfit`` is the variance of the residuals in units of that of the data. Shapes and residual
    terms of the fit, primitives E combined by T, follow: what they make up of a pole's function
    explains nothing (Rao's score test). Their share is that of the mean weights of all responses.
    """
    front, f = task.s**task.order, task.s.imag
    step = max(float(np.diff(f).min()), float(np.ptp(f)) / MOST_PLACES)
    place = np.rint((f - f[0]) / step).astype(int)
    count = int(place[-1]) + 1
    size = 1 << (2 * count - 1).bit_length()
    offset = step * scipy.fft.fftfreq(size, 1 / size)

    def on_grid(values: Any) -> Any:
        out = np.zeros((*values.shape[:-1], size), values.dtype)
        np.add.at(out.T, place, values.T)
        return scipy.fft.fft(out)

    def every(stride: int, values: Any) -> Any:
        # that of a transform is the transform of as many parts on top of each other
        folded = values.reshape(*values.shape[:-1], stride, size // stride).mean(axis=-2)
        return scipy.fft.ifft(folded)[..., : -(-count // stride)]

    def over_root(products: Any, energy: Any) -> Any:
        G = np.maximum(energy.real, 0.0)
        return products / np.sqrt(np.where(ROUNDING * G.max(initial=0.0) < G, G, np.inf))

    weight, n_in = task.weights, len(r)
    parts = [slice(first, first + PORTION) for first in range(0, r.shape[1], PORTION)]
    products = [on_grid(weight[:, part] * r[:, part] * front.conj()) for part in parts]
    level = np.maximum(task.weight.mean(axis=2, keepdims=True), TINY)
    mean = np.mean(task.weight / level, axis=1, keepdims=True)
    own = parts if task.weight.shape == r.shape else [slice(None)] * len(parts)
    energies = [on_grid(task.weight[:, part] * square(front)) for part in own]
    mean_energy = on_grid(mean[:, 0] * square(front))
    of_fit = on_grid(mean * E * front.conj())
    columns = T @ _root(np.sum(T.swapaxes(1, 2) @ gram(replace(task, weight=mean), E)[:, 0] @ T, 0))
    out: list[list[Any]] = []
    widest = int(np.log2(max(HEAVIEST * f[-1] / step, 1)))
    for m in range(min(widest, count.bit_length()) + 1):
        half = step * 2**m
        kernel = 1 / (half + task.s[0].real + 1j * offset)
        of_pole, of_energy = scipy.fft.fft(kernel), scipy.fft.fft(square(kernel))
        lam = -half + 1j * (f[0] + step * np.arange(0, count, 2**m))
        S, total = np.zeros((len(lam), n_in, n_in), complex), np.zeros((n_in, len(lam)))
        for product, energy in zip(products, energies, strict=True):
            G = every(2**m, energy * of_energy)
            z = over_root(every(2**m, product * of_pole), G).transpose(2, 0, 1)
            S += z @ z.conj().swapaxes(1, 2)
            total += np.maximum(G.real, 0.0).mean(axis=1)
        G = every(2**m, mean_energy * of_energy)
        X = over_root(every(2**m, of_fit * of_pole), G[:, None]).transpose(2, 0, 1)
        X = (X[:, :, None] @ columns)[:, :, 0]
        most, factors = _most(S, X)
        factors /= np.sqrt(np.maximum(total.T, TINY))
        noise = percentile_filter(most, 100 * UPPER, 2 * NEIGHBOURHOOD + 1, mode="nearest")
        kept = half < HEAVIEST * lam.imag
        out.append([x[kept] for x in (lam, 2 * most, factors, noise)])
    lam, gain, L, noise = (np.concatenate(each) for each in zip(*out, strict=True))
    # the correlations of the noise of a line with all lines have the sum x coth x, x = d T
    widening = task.decay / np.tanh(task.decay) if task.decay else 1.0
    noise = np.maximum(noise / _expected(*task.live), max(misfit, 1.0) * widening)
    return Scan(lam, gain / noise, L, noise)


def _most(S: Complexes, X: Complexes) -> tuple[Floats, Complexes]:
    """Return the greatest of c^* S c / c^* (I - X X^* / 2) c at every pole, and its factors c.

    The rows of X are the functions of a pole at the references in the orthonormal basis of the fit;
    half of them is the mean over all phases of a residue.
    """
    left, basis = np.linalg.eigh(np.eye(S.shape[1]) - X @ X.conj().swapaxes(1, 2) / 2)
    basis /= np.sqrt(np.maximum(left, LEAST_OWN))[:, None]
    value, vector = np.linalg.eigh(basis.conj().swapaxes(1, 2) @ S @ basis)
    return value[:, -1], (basis @ vector[:, :, -1:])[..., 0]


def _root(G: Floats) -> Floats:
    """Return R with R R^T the inverse of G, in the directions in which G is not rounding."""
    scale = 1 / np.sqrt(np.maximum(G.diagonal(), TINY))
    value, vector = np.linalg.eigh(G * np.outer(scale, scale))
    kept = value > ROUNDING * value.max(initial=0.0)
    return scale[:, None] * vector[:, kept] / np.sqrt(value[kept])
