"""The ambient test of the example ambient-test: simulated records.

The three-story building of the hammer tests, shaken at all floors by noise that is white up to a
corner, and at the first by a machine. The equations of motion are discretised exactly for forces
that are linear between samples. Two accelerometers with noise measure in three setups. The modes
that ``modefront identify`` finds are among the files of the example.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy.linalg as la
import scipy.signal as signal

from modefront._typing import Floats
from modefront.outputs import write_text
from modefront.study.examples.hammer_test import DAMPING, FLOORS, MASSES, STIFFNESS, THETA

SETUPS = {
    "outer": ("floor1", "floor3"),
    "upper": ("floor2", "floor3"),
    "lower": ("floor1", "floor2"),
}
RATE, FINE, DURATION, SETTLING = 50, 4, 200, 20  # samples per s, as many in the integration; s
CORNER, COMMON, NOISE = 15.0, 0.3, 0.02  # Hz; share of common force; of the rms
MACHINE = 8.3  # Hz
SEED = 2011


def files() -> list[str]:
    """Return the names of the files that `write` writes."""
    return sorted(f"{name}.csv" for name in SETUPS)


def write(folder: Path) -> None:
    """Simulate the test and write the records of its setups into a folder."""
    rng = np.random.default_rng(SEED)
    for name, sensors in SETUPS.items():
        write_text(folder / f"{name}.csv", _records(sensors, rng))


def _records(sensors: tuple[str, ...], rng: np.random.Generator) -> str:
    """Return the CSV file of one setup."""
    y = _accelerations(rng)[[FLOORS.index(name) for name in sensors]]
    y = y + NOISE * y.std(axis=1, keepdims=True) * rng.standard_normal(y.shape)
    rows = [
        ",".join([f"{k / RATE:.2f}", *(f"{value:.4g}" for value in row)])
        for k, row in enumerate(y.T)
    ]
    return "\n".join([",".join(["time", *sensors]), *rows]) + "\n"


def _accelerations(rng: np.random.Generator) -> Floats:
    """Return the accelerations of all floors in m/s², (floors, samples)."""
    k = STIFFNESS * np.append(THETA, 0.0)
    K = np.diag(k[:-1] + k[1:]) - np.diag(k[1:-1], 1) - np.diag(k[1:-1], -1)
    squared, shapes = la.eigh(K, np.diag(MASSES))
    step = 1 / (RATE * FINE)
    white = rng.standard_normal((len(FLOORS) + 1, (DURATION + SETTLING) * RATE * FINE))
    corner = np.exp(-2 * np.pi * CORNER * step)
    noise = signal.lfilter([1 - corner], [1, -corner], white, axis=1)
    force = np.sqrt(1 - COMMON) * noise[:-1] + np.sqrt(COMMON) * noise[-1]
    force[0] += force[0].std() * np.sin(2 * np.pi * MACHINE * step * np.arange(force.shape[1]))
    q = []
    for omega2, zeta, f in zip(squared, DAMPING, shapes.T @ force, strict=True):
        system = [1.0, 0.0, 0.0], [1.0, 2 * zeta * np.sqrt(omega2), omega2]
        b, a, _ = signal.cont2discrete(system, step, "foh")
        q.append(signal.lfilter(b[0], a, f))
    y = shapes @ np.array(q)[:, SETTLING * RATE * FINE :]
    out: Floats = signal.decimate(y, FINE, ftype="fir")
    return out
