r"""What to measure next: how much each further mode or sensor would narrow each parameter.

docs/uncertainty.md has the covariance with the rows R (rows, p) of further residuals. New
measurements are as exact as those that there are, :math:`\tau` by median, with the variance of the
group of their kind; the factor of a shape is fitted.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np

from modefront._typing import Bools, Floats
from modefront.optim.problem import Evaluation
from modefront.uncertainty.prior import NoiseModel


def candidates(noise: NoiseModel, evaluation: Evaluation) -> dict[str, Any]:
    """Return what could be measured besides the data, as values of results.

    That are a model mode at all sensors, by its frequency, or all measured modes at a further
    sensor, and the shares (candidates, p) by which the standard deviation of a parameter becomes
    less. ``evaluation`` is most probable.
    """
    problem = noise.problem
    span = problem.upper - problem.lower
    C = np.linalg.inv(noise.precision(evaluation) * np.outer(span, span))
    found = list(_further(noise, evaluation))
    gain = np.zeros((len(found), span.size))
    for k, (_, _, rows) in enumerate(found):
        R = rows * span
        X = C @ R.T
        less = np.einsum("jr,jr->j", np.linalg.solve(np.eye(len(R)) + R @ X, X.T).T, X)
        gain[k] = 1 - np.sqrt(np.maximum(1 - less / np.diag(C), 0.0))
    return {
        "candidate_frequency": np.array([f for f, *_ in found]),
        "candidate_sensor": [name for _, name, _ in found],
        "candidate_gain": gain,
    }


def _further(noise: NoiseModel, evaluation: Evaluation) -> Iterator[tuple[float, str, Floats]]:
    """Yield the frequency of a mode or the name of a sensor, and the residuals' rows (., p)."""
    problem, data = noise.problem, noise.problem.data
    modes, pairs = problem.modes(evaluation.theta)
    w = noise.logs.gradient(evaluation.J)

    def size(kind: str, std: Floats, values: Floats) -> float:
        """Return the root of the weight of a group of this kind over the expected error."""
        known = np.isfinite(values) & (values != 0)
        tau = float(np.median((std / np.where(known, values, 1.0))[known])) if known.any() else 1.0
        own = [v for v, x in zip(w, problem.groups, strict=True) if x.modes_of(kind)]
        return float(np.sqrt(np.mean(own or [1.0]))) / tau

    top = np.nanmax(np.abs(data.shape), axis=2, initial=0.0, keepdims=True)
    of_shape = size("shape", data.shape_std, np.where(np.isfinite(data.shape), top, 0.0))
    of_frequency = size("frequency", data.frequency_std, data.frequency)

    def shape(q: int, sensors: Bools) -> tuple[Floats, Floats]:
        """Return a shape over expected errors, and its derivatives, at some sensors."""
        unit = of_shape / np.abs(modes.phi[:, q]).max()
        return unit * modes.phi[sensors, q], unit * modes.dphi[sensors, q]

    measured: Bools = np.asarray(np.isfinite(data.shape).any(axis=0))
    seen: Bools = np.asarray(measured.any(axis=0))
    for q in sorted(set(range(modes.lam.size)) - set(pairs.index.tolist())):
        parts, f = [], modes.frequency[q]
        if np.isfinite(data.frequency).any() and f > 0:
            parts.append(of_frequency * modes.dfrequency[q][None] / f)
        if modes.phi[seen, q].any():
            chi, dchi = shape(q, seen)
            parts.append(dchi - np.outer(chi, chi @ dchi / (chi @ chi)))
        if parts:
            yield float(f), "", np.vstack(parts)
    for s in np.flatnonzero(~seen).tolist():
        rows = []
        for others, q in zip(measured, pairs.index.tolist(), strict=True):
            if modes.phi[others, q].any():
                (x,), (dx,) = shape(q, np.arange(seen.size) == s)
                chi, dchi = shape(q, others)
                b = chi @ chi
                rows.append((dx - x * (chi @ dchi) / b) / np.sqrt(1 + x**2 / b))
        if rows:
            yield 0.0, data.sensors[s], np.array(rows)
