r"""What to measure next: how much each further mode or sensor would narrow each parameter.

docs/uncertainty.md has the covariance with the rows R (rows, p) of further residuals. New
measurements are as exact as those that there are, :math:`\tau` by median, with the variance of the
group of their kind; the factor of a shape is fitted.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from modefront._typing import Bools, Floats, Ints
from modefront.modes.result import Modes
from modefront.optim.problem import Evaluation
from modefront.uncertainty.prior import Distance, NoiseModel
from modefront.work.codec import record


@record
@dataclass(frozen=True)
class Candidates:
    """Measurements that could be made.

    Attributes
    ----------
    frequency : (candidates,) of the model mode to be measured at all sensors; 0 for a sensor
    sensor : the sensor at which all measured modes are to be measured; empty for a mode
    gain : (candidates, p) share by which the standard deviation of a parameter becomes less
    """

    frequency: Floats
    sensor: tuple[str, ...]
    gain: Floats


def candidates(noise: NoiseModel, evaluation: Evaluation) -> Candidates:
    """Return what could be measured besides the data; ``evaluation`` is most probable."""
    problem = noise.problem
    span = problem.upper - problem.lower
    w = noise.programme.logs.gradient(evaluation.J)
    slope = Distance(problem, problem.start, 12.0).residuals(evaluation.theta)[1]
    G = sum(v * x.dr.T @ x.dr for v, x in zip(w, evaluation.residuals, strict=True))
    C = np.linalg.inv((G + np.diag(slope**2)) * np.outer(span, span))
    modes, pairs = problem.modes(evaluation.theta)
    gains, frequencies, sensors = [], [], []
    for frequency, sensor, rows in _Further(noise, w, modes, pairs.index).rows():
        R = rows * span
        X = C @ R.T
        less = np.einsum("jr,jr->j", np.linalg.solve(np.eye(len(R)) + R @ X, X.T).T, X)
        gains.append(1 - np.sqrt(np.maximum(1 - less / np.diag(C), 0.0)))
        frequencies.append(frequency)
        sensors.append(sensor)
    gain = np.array(gains).reshape(-1, span.size)
    return Candidates(np.array(frequencies), tuple(sensors), gain)


@dataclass(frozen=True)
class _Further:
    """Residuals of further measurements, at the modes of the most probable model.

    Attributes
    ----------
    w : (n,) weights of the groups
    index : (measured modes,) model modes that are paired
    """

    noise: NoiseModel
    w: Floats
    modes: Modes
    index: Ints

    def rows(self) -> Iterator[tuple[float, str, Floats]]:
        """Yield the frequency of a mode or the name of a sensor, and the rows (., p) of each."""
        data, modes = self.noise.problem.data, self.modes
        measured: Bools = np.asarray(np.isfinite(data.shape).any(axis=0))
        seen: Bools = np.asarray(measured.any(axis=0))
        for q in sorted(set(range(modes.lam.size)) - set(self.index.tolist())):
            parts = []
            if np.isfinite(data.frequency).any() and modes.frequency[q] > 0:
                parts.append(self._frequency(q))
            if modes.phi[seen, q].any():
                parts.append(self._shape(q, seen))
            if parts:
                yield float(modes.frequency[q]), "", np.vstack(parts)
        for s in np.flatnonzero(~seen).tolist():
            parts = [
                self._component(q, s, measured[r])
                for r, q in enumerate(self.index.tolist())
                if modes.phi[measured[r], q].any()
            ]
            if parts:
                yield 0.0, data.sensors[s], np.array(parts)

    def _frequency(self, q: int) -> Floats:
        """Return the row (1, p) of the frequency of a mode."""
        data = self.noise.problem.data
        known = np.isfinite(data.frequency)
        tau = float(np.median((data.frequency_std / data.frequency)[known]))
        f, df = self.modes.frequency[q], self.modes.dfrequency[q]
        return self._size("frequency") * df[None] / (tau * f)

    def _chi(self, q: int, sensors: Bools) -> tuple[Floats, Floats]:
        """Return a shape over expected errors, and its derivatives, at some sensors."""
        data = self.noise.problem.data
        top = np.nanmax(np.abs(data.shape), axis=2, initial=0.0, keepdims=True)
        known = np.isfinite(data.shape) & (top > 0)
        tau = float(np.median((data.shape_std / np.where(top > 0, top, 1.0))[known]))
        phi, dphi = self.modes.phi[:, q], self.modes.dphi[:, q]
        size = self._size("shape") / (tau * np.abs(phi).max())
        return size * phi[sensors], size * dphi[sensors]

    def _shape(self, q: int, sensors: Bools) -> Floats:
        """Return the rows (sensors, p) of a shape."""
        chi, dchi = self._chi(q, sensors)
        return dchi - np.outer(chi, chi @ dchi / (chi @ chi))

    def _component(self, q: int, s: int, others: Bools) -> Floats:
        """Return the row (p,) of a component that is added to others."""
        chi, dchi = self._chi(q, others)
        alone = np.arange(others.size) == s
        (x,), (dx,) = self._chi(q, alone)
        b = chi @ chi
        out: Floats = (dx - x * (chi @ dchi) / b) / np.sqrt(1 + x**2 / b)
        return out

    def _size(self, kind: str) -> float:
        """Return the root of the weight of the groups with members of a kind; one without."""
        own = [
            v
            for v, group in zip(self.w, self.noise.problem.groups, strict=True)
            if group.modes_of(kind)
        ]
        return float(np.sqrt(np.mean(own))) if own else 1.0
