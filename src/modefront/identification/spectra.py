"""Spectra of ambient records: transforms for the likelihood, half spectra for poles to start from.

docs/methods/ambient.md defines both. References of half spectra are the principal components
of the records.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy.fft
import scipy.linalg as la

from modefront._typing import Complexes, Floats
from modefront.data.modal_test import RECORDED, Records
from modefront.data.responses import FrequencyResponses
from modefront.identification.noise import square
from modefront.identification.spectral_density import Band
from modefront.rounding import TINY

REFERENCES = 12  # principal components that half spectra are taken with, one for each close mode
LAGS = 0.1  # longest lag over the length of the record: longer ones are mostly errors of estimation
MOST_LINES = 4096  # lines of half spectra, at most
LEFT = 0.05  # exponential window at the longest lag
BLOCK = 0.1  # width of a block of lines over the distance from the nearest pole
ROUNDING = 1e-9  # least background over the greatest power of a band
LEAST_SHARE = 1e-9  # share of a line that is left where a sine takes all of it, for rounding
SMOOTH = 0.02  # share of the lines over which half spectra are averaged for their weights


@dataclass(frozen=True)
class Transforms:
    """Transforms of the records of one setup at the lines of a band."""

    omega: Floats  # (lines,) rad/s
    F: Complexes  # (sensors, lines), scaled: the mean of F F^* is a two-sided spectral density
    order: int  # differentiations of the displacement in the records
    share: Floats  # (lines,) how much of a line there is beside the sines that were taken off
    sines: tuple[float, ...] = ()  # rad/s, of these

    def part(self, low: float, high: float, poles: Floats) -> Band:
        """Return a band, low and high in rad/s, in blocks over which the density hardly changes.

        ``poles`` are frequencies and half bandwidths of modes in rad/s, (2, modes): blocks are
        narrow beside the half bandwidth of the nearest one, and beside the distance from it.
        """
        kept = (self.omega >= low) & (self.omega <= high)
        omega, F = self.omega[kept], self.F[:, kept]
        distance = np.maximum(np.abs(omega - poles[0][:, None]), poles[1][:, None]).min(axis=0)
        size = np.maximum(BLOCK * distance / (self.omega[1] - self.omega[0]), 1.0)
        first = np.flatnonzero(np.diff(np.floor(np.cumsum(1 / size) + ROUNDING), prepend=-1.0))
        ends = np.append(first[1:], len(omega))
        lines = ends - first
        count = np.maximum(np.add.reduceat(self.share[kept], first), LEAST_SHARE)
        parts = [F[:, start:end] for start, end in zip(first, ends, strict=True)]
        products = np.array([part @ part.conj().T for part in parts], complex)
        products /= count[:, None, None]
        middle = np.add.reduceat(omega, first) / lines
        value = np.linalg.eigvalsh(np.tensordot(count, products, 1).real / count.sum())
        floor = np.full(len(F), max(value[0], ROUNDING * value[-1]))
        return Band(middle, count, products, self.order, floor)


def _without_trends(values: Floats) -> Floats:
    """Return records, (sensors, samples), without the straight line that is nearest to each."""
    samples = values.shape[1]
    line = np.column_stack([np.arange(1.0, samples + 1) / samples, np.ones(samples)])
    columns = values.T.copy()
    return np.asarray((columns - line @ la.lstsq(line, columns)[0]).T)


def transforms(records: Records, low: float, high: float) -> Transforms:
    """Return the transforms at the lines of a band in Hz."""
    y = _without_trends(records.values)
    samples = y.shape[1]
    f = scipy.fft.rfftfreq(samples, 1 / records.rate)
    kept = (f >= low) & (f <= high) & (f > 0)
    F = scipy.fft.rfft(y, axis=1)[:, kept] / np.sqrt(samples * records.rate)
    return Transforms(2 * np.pi * f[kept], F, RECORDED[records.quantity], np.ones(F.shape[1]))


def with_lines(records: Records, omega: Floats, change: Complexes) -> Records:
    """Return records whose transforms at lines in rad/s are changed, (sensors, lines)."""
    samples = records.values.shape[1]
    F = np.zeros((len(change), samples // 2 + 1), complex)
    F[:, np.rint(omega * records.duration / (2 * np.pi)).astype(int)] = change
    y = scipy.fft.irfft(F * np.sqrt(samples * records.rate), samples, axis=1)
    return replace(records, values=records.values + y)


def half_spectra(records: Records, low: float, high: float) -> tuple[FrequencyResponses, Floats]:
    """Return half spectra within a band in Hz, and their variance up to a factor, (1, 1, lines)."""
    y = _without_trends(records.values)
    y = y / np.maximum(y.std(axis=1, keepdims=True), TINY)
    samples = y.shape[1]
    lags = int(min(LAGS * samples, MOST_LINES * records.rate / (high - low)))
    size = scipy.fft.next_fast_len(samples + lags, real=True)
    Y = scipy.fft.rfft(y, size, axis=1)
    f = scipy.fft.rfftfreq(size, 1 / records.rate)
    inside = (f >= low) & (f <= high)
    cross = (Y[:, inside] @ Y[:, inside].conj().T).real
    U = np.linalg.eigh(cross)[1][:, ::-1][:, :REFERENCES]
    decay = float(-np.log(LEFT) * records.rate / lags)
    window = np.exp(-decay * np.arange(lags) / records.rate)
    window[0] = 0.0
    parts = []
    for reference in U.T @ Y:
        R = scipy.fft.irfft(Y * reference.conj(), size, axis=1)[:, :lags] / samples
        parts.append(scipy.fft.rfft(R * window, axis=1))
    lines = scipy.fft.rfftfreq(lags, 1 / records.rate)
    kept = (lines >= low) & (lines <= high)
    H: Complexes = np.array(parts)[..., kept]
    names = tuple(f"principal {j + 1}" for j in range(len(H)))
    data = FrequencyResponses(lines[kept], H, "receptance", names, records.sensors, decay=decay)
    power = square(H).mean(axis=(0, 1))
    width = max(int(SMOOTH * len(power)), 1)
    smooth = np.convolve(np.pad(power, width, mode="edge"), np.ones(2 * width + 1), "valid")
    return data, np.asarray(smooth / (2 * width + 1))[None, None]
