"""Measured functions scaled for a fit, and the functions of frequency that all of them share.

The *primitives* are those of `modefront.identification.modal_model`.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from modefront._typing import Bools, Complexes, Floats
from modefront.data.responses import ORDERS, ForceNoise, FrequencyResponses

RESIDUALS = (-4, -2, 0, 2)
"""Powers of s of the residual terms: what lightly damped modes below and above the band leave is
even in s. Two on either side cost deviations a hundredth; one may shift frequencies by them."""


@dataclass(frozen=True)
class Problem:
    """Data and weights, with frequencies over the highest one and functions over their size."""

    s: Complexes  # (lines,) (i omega + decay) / omega_max
    H: Complexes  # (references, responses, lines), 0 where not measured
    # of the shape of ``H``, 1/v, 0 where not measured; or (references, 1, lines) where all
    # responses share it, which makes their equations one
    weight: Floats
    order: int  # q
    decay: float = 0.0  # what an exponential window has decayed by at the end of the record, d T
    force_noise: tuple[ForceNoise, ...] = ()  # at each reference, if known; times in that of 1 / s

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


def problem(data: FrequencyResponses, variance: Floats) -> tuple[Problem, float, float]:
    """Return the scaled problem with the units of frequency (rad/s) and of H.

    The variance is of the shape of H, or (references, 1, lines); lines where it is not a positive
    number have no weight.
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
    noise = tuple(replace(x, times=x.times * omega) for x in data.force_noise)
    return Problem(s, H, weight, ORDERS[data.quantity], lag, noise), omega, size


def primitives(task: Problem, lam: Complexes, squares: bool = True) -> Complexes:
    """Return E, (2 modes + powers + 2 modes, lines); without the last ones unless ``squares``."""
    front, n, powers = task.s**task.order, len(lam), len(RESIDUALS)
    E = np.empty((2 * n + powers + 2 * n * squares, len(task.s)), complex)
    upper, lower = (1 / (task.s - poles[:, None]) for poles in (lam, lam.conj()))
    for base in (0, 2 * n + powers)[: 1 + squares]:
        E[base : base + 2 * n : 2] = front * (upper + lower)
        E[base + 1 : base + 2 * n : 2] = 1j * front * (upper - lower)
        upper, lower = upper * upper, lower * lower
    for row, power in enumerate(RESIDUALS, start=2 * n):
        E[row] = front * task.s**power
    return E


def gram(task: Problem, E: Complexes) -> Floats:
    """Return the weighted Gram matrices of the primitives, (references, responses, Q, Q).

    There is one for all responses where they share their weights.
    """
    M = np.zeros((*task.weight.shape[:2], len(E), len(E)))
    for place in np.ndindex(M.shape[:2]):
        weighted = E.view(float) * np.sqrt(task.weight[place]).repeat(2)
        M[place] = weighted @ weighted.T
    return M


def combined(coefficients: Floats, E: Complexes) -> Complexes:
    """Return real combinations of the primitives; real arithmetic takes half the time."""
    return (coefficients @ E.view(float)).view(complex)
