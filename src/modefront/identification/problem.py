"""Measured functions scaled for a fit, and the functions of frequency that all of them share.

The *primitives* are those of `modefront.identification.modal_model`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product

import numpy as np

from modefront._typing import Bools, Complexes, Floats
from modefront.data.responses import ORDERS, ForceNoise, FrequencyResponses

RESIDUALS: tuple[tuple[int, ...], ...] = ((), (-2, 0), (-3, -2, 0, 1), (-4, -3, -2, 0, 1, 2))
"""Powers of s of the residual terms, by the number of terms on either side."""

CHUNK = 1 << 20
"""Numbers in an intermediate array of products."""

FEW = 16
"""Functions up to which a Gram matrix of each is faster than the products of all pairs."""


@dataclass(frozen=True)
class Problem:
    """Data and weights, with frequencies over the highest one and functions over their size.

    Attributes
    ----------
    s : (lines,) (i omega + decay) / omega_max
    H : (references, responses, lines), 0 where not measured
    weight : of the shape of ``H``, 1/v, 0 where not measured; or (references, 1, lines) where all
        responses share it, which makes their equations one
    order : q
    powers : powers of s of the residual terms
    decay : what an exponential window has decayed by at the end of the record, d T
    force_noise : noise of the force channel, where it is known; times in the unit of 1 / s
    """

    s: Complexes
    H: Complexes
    weight: Floats
    order: int
    powers: tuple[int, ...]
    decay: float = 0.0
    force_noise: ForceNoise | None = None

    @cached_property
    def count(self) -> int:
        """Number of real equations."""
        return 2 * int(np.count_nonzero(self.weights))

    @cached_property
    def live(self) -> tuple[int, int]:
        """Numbers of references and responses that were measured."""
        measured: Bools = np.any(self.weights, axis=2)
        return int(measured.any(axis=1).sum()), int(measured.any(axis=0).sum())

    @property
    def weights(self) -> Floats:
        """The weights, of the shape of ``H``."""
        return np.broadcast_to(self.weight, self.H.shape)

    @property
    def correlation(self) -> float:
        """Sum of the correlations of the noise of a line with all lines, x coth x for x = d T."""
        return self.decay / math.tanh(self.decay) if self.decay else 1.0


def problem(data: FrequencyResponses, variance: Floats, level: int) -> tuple[Problem, float, float]:
    """Return the scaled problem with the units of frequency (rad/s) and of H.

    ``level`` is the number of residual terms on either side of the band. The variance is of the
    shape of H, or (references, 1, lines); lines where it is not a positive number have no weight.
    """
    omega = 2 * np.pi * data.frequency[-1]
    measured = data.measured
    power = np.where(measured, data.H.real**2 + data.H.imag**2, 0.0).sum()
    size = float(np.sqrt(power / np.count_nonzero(measured)))
    used = measured & np.isfinite(variance) & (variance > 0)
    if variance.shape == used.shape:
        variance = np.where(used, variance, np.inf)
    weight: Floats = np.ascontiguousarray(size**2 / variance)
    s = (2j * np.pi * data.frequency + data.decay) / omega
    H: Complexes = np.ascontiguousarray(np.where(used, data.H, 0) / size)
    lag = data.decay / float(np.median(np.diff(data.frequency)))
    order, noise = ORDERS[data.quantity], data.force_noise
    if noise is not None:
        noise = replace(noise, times=tuple(t * omega for t in noise.times))
    return Problem(s, H, weight, order, RESIDUALS[level], lag, noise), omega, size


def primitives(task: Problem, lam: Complexes, squares: bool = True) -> Complexes:
    """Return E, (2 modes + powers + 2 modes, lines); without the last ones unless ``squares``."""
    front, n, powers = task.s**task.order, len(lam), len(task.powers)
    E = np.empty((2 * n + powers + 2 * n * squares, len(task.s)), complex)
    upper, lower = (1 / (task.s - poles[:, None]) for poles in (lam, lam.conj()))
    for base in (0, 2 * n + powers)[: 1 + squares]:
        E[base : base + 2 * n : 2] = front * (upper + lower)
        E[base + 1 : base + 2 * n : 2] = 1j * front * (upper - lower)
        upper, lower = upper * upper, lower * lower
    for row, power in enumerate(task.powers, start=2 * n):
        E[row] = front * task.s**power
    return E


def gram(task: Problem, E: Complexes) -> Floats:
    """Return the weighted Gram matrices of the primitives, (references, responses, Q, Q).

    There is one for all responses where they share their weights.
    """
    flat = task.weight.reshape(-1, len(task.s))
    M = np.zeros((len(flat), len(E), len(E)))
    if len(flat) <= FEW:
        root, parts = np.sqrt(flat).repeat(2, axis=1), E.view(float)
        size = max(CHUNK // max(len(E), 1), 1)
        for start, k in product(range(0, parts.shape[1], size), range(len(M))):
            lines = slice(start, start + size)
            weighted = parts[:, lines] * root[k, lines]
            M[k] += weighted @ weighted.T
    else:
        p, q = np.triu_indices(len(E))
        for lines, values in products(E):
            M[:, p, q] += flat[:, lines] @ values.T
        M[:, q, p] = M[:, p, q]
    return M.reshape(*task.weight.shape[:2], len(E), len(E))


def products(E: Complexes) -> Iterator[tuple[slice, Floats]]:
    """Yield portions of lines with the real products of all pairs of functions.

    Pairs are in the order of ``np.triu_indices``.
    """
    pairs = len(E) * (len(E) + 1) // 2
    size = max(CHUNK // max(pairs, 1), 1)
    for start in range(0, E.shape[1], size):
        portion = E[:, start : start + size]
        real, imag = portion.real.copy(), portion.imag.copy()
        products, scratch = np.empty((pairs, real.shape[1])), np.empty_like(real)
        first = 0
        for p in range(len(E)):  # the rows of an upper triangle
            rows = products[first : first + len(E) - p]
            np.multiply(real[p], real[p:], out=rows)
            rows += np.multiply(imag[p], imag[p:], out=scratch[p:])
            first += len(rows)
        yield slice(start, start + size), products


def combined(coefficients: Floats, E: Complexes) -> Complexes:
    """Return real combinations of the primitives; real arithmetic takes half the time."""
    out: Complexes = (coefficients @ E.view(float)).view(complex)
    return out
