"""Simulates what was measured in the modal tests of two examples, and identifies the modes of one.

    python examples/modal_tests.py [FOLDER]

FOLDER holds the folders of the examples; by default it is that of the package.

The hammer tests are of the three-story building as chains M0 and M1 (with the added masses), its
stories of stiffness theta k0 with `THETA`. The hammer hits the second and the third floor five
times each, and again in every one of three data sets. The noise of an accelerometer is
`RESPONSE_NOISE` of its rms, that of the hammer `FORCE_NOISE` of the force; functions are H1
estimates with their coherence. The modes of each model are identified from its test file, as
``modefront identify`` does.

In the ambient test the building is shaken at all floors by noise that is white up to a corner, and
at the first by a machine. The equations of motion are discretised exactly for forces that are
linear between samples. Two accelerometers with noise measure in three setups.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import scipy.linalg as la
import scipy.signal as signal

from modefront._typing import Complexes, Floats
from modefront.data.csv import write_csv
from modefront.data.modal_test import read_test
from modefront.identification.methods.hammer import identify
from modefront.identification.sets import combine

EXAMPLES = Path(__file__).parents[1] / "src" / "modefront" / "study" / "examples"

THETA = np.array([1.10, 0.95, 1.05])
MASSES = 22.6 * np.array([1.0, 1.0, 0.76])  # kg
ADDED = {"m0": 0.0, "m1": 9.5}  # kg a floor
STIFFNESS = 84763.8  # N/m
DAMPING = np.array([0.010, 0.012, 0.009])
LINES = np.arange(1.0, 25.05, 0.1)  # Hz
BLOWS, SETS, RESPONSE_NOISE, FORCE_NOISE = 5, 3, 0.02, 0.01
HAMMER_SEED = 2008
FLOORS = ("floor1", "floor2", "floor3")
HAMMER = ("floor2", "floor3")

SETUPS = {
    "outer": ("floor1", "floor3"),
    "upper": ("floor2", "floor3"),
    "lower": ("floor1", "floor2"),
}
RATE, FINE, DURATION, SETTLING = 50, 4, 200, 20  # samples per s, as many in the integration; s
CORNER, COMMON, NOISE = 15.0, 0.3, 0.02  # Hz; share of common force; of the rms
MACHINE = 8.3  # Hz
AMBIENT_SEED = 2011


def accelerances(added: float) -> Complexes:
    """Return exact accelerances, (hammer, floors, lines)."""
    k = STIFFNESS * np.append(THETA, 0.0)
    K = np.diag(k[:-1] + k[1:]) - np.diag(k[1:-1], 1) - np.diag(k[1:-1], -1)
    squared, shapes = la.eigh(K, np.diag(MASSES + added))
    omega, s = np.sqrt(squared)[:, None], 2j * np.pi * LINES
    response = s**2 / (s**2 + 2 * DAMPING[:, None] * omega * s + squared[:, None])
    hit = shapes[[FLOORS.index(name) for name in HAMMER]]
    out: Complexes = np.einsum("jr,ir,rk->jik", hit, shapes, response)
    return out


def hammer_tests(folder: Path) -> None:
    """Simulate the tests of both models, and identify their modes, in a folder with test files."""
    rng = np.random.default_rng(HAMMER_SEED)
    for model, added in ADDED.items():
        H = accelerances(added)
        for name, j in _tests(model):
            (folder / name).write_text(_measured(H[j], rng), encoding="ascii")
    for model in ADDED:
        test = read_test(folder / f"test-{model}.toml")
        identified = [identify(part.data, test.band, test.modes) for part in test.sets]
        modes = combine([part.name for part in test.sets], identified)
        write_csv(folder / f"modes-{model}.csv", modes.data, modes.damping_std)


def _tests(model: str) -> list[tuple[str, int]]:
    """Return the file and the position of the hammer of every test of a model."""
    return [
        (f"{model}-set{number}-{name}.csv", j)
        for number in range(1, SETS + 1)
        for j, name in enumerate(HAMMER)
    ]


def _measured(H: Complexes, rng: np.random.Generator) -> str:
    """Return the CSV file of one reference."""

    def circular(*shape: int) -> Complexes:
        out: Complexes = rng.standard_normal(shape) + 1j * rng.standard_normal(shape)
        return out / np.sqrt(2)

    rms = np.sqrt(np.mean(np.abs(H) ** 2, axis=1, keepdims=True))
    response = H + RESPONSE_NOISE * rms * circular(BLOWS, *H.shape)
    force = 1 + FORCE_NOISE * circular(BLOWS, 1, H.shape[1])
    cross = np.mean(force.conj() * response, axis=0)
    power, response_power = (
        np.mean(np.abs(force) ** 2, axis=0),
        np.mean(np.abs(response) ** 2, axis=0),
    )
    h1, coherence = cross / power, np.abs(cross) ** 2 / (power * response_power)
    ends = ("re", "im", "coherence")
    header = ["frequency", *(f"{name}_{end}" for name in FLOORS for end in ends)]
    columns = [part for i in range(len(H)) for part in (h1[i].real, h1[i].imag, coherence[i])]
    rows = [
        ",".join([f"{f:.6g}", *(f"{value:.6g}" for value in row)])
        for f, row in zip(LINES, np.transpose(columns), strict=True)
    ]
    return "\n".join([",".join(header), *rows]) + "\n"


def ambient_test(folder: Path) -> None:
    """Simulate the test and write the records of its setups into a folder."""
    rng = np.random.default_rng(AMBIENT_SEED)
    for name, sensors in SETUPS.items():
        (folder / f"{name}.csv").write_text(_records(sensors, rng), encoding="ascii")


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


def main() -> None:
    """Write the files of both examples."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else EXAMPLES
    hammer_tests(folder / "hammer-test")
    ambient_test(folder / "ambient-test")


if __name__ == "__main__":
    main()
