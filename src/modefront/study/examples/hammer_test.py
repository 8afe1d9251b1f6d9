"""The hammer tests of the example hammer-test: simulated functions, and the modes they give.

The three-story building as chains M0 and M1 (with the added masses), its stories of stiffness
theta k0 with `THETA`. The hammer hits the second and the third floor five times each, and again
in every one of three data sets. The noise of an accelerometer is `RESPONSE_NOISE` of its rms, that
of the hammer `FORCE_NOISE` of the force; functions are H1 estimates with their coherence. The modes
of each model are identified from its test file, as ``modefront identify`` does.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy.linalg as la

from modefront._typing import Complexes
from modefront.data.csv import write_csv
from modefront.data.modal_test import read_test
from modefront.identification.methods.hammer import identify
from modefront.identification.sets import combine, modal_data_of
from modefront.outputs import write_text

THETA = np.array([1.10, 0.95, 1.05])
MASSES = 22.6 * np.array([1.0, 1.0, 0.76])  # kg
ADDED = {"m0": 0.0, "m1": 9.5}  # kg a floor
STIFFNESS = 84763.8  # N/m
DAMPING = np.array([0.010, 0.012, 0.009])
LINES = np.arange(1.0, 25.05, 0.1)  # Hz
BLOWS, SETS, RESPONSE_NOISE, FORCE_NOISE = 5, 3, 0.02, 0.01
SEED = 2008
FLOORS = ("floor1", "floor2", "floor3")
HAMMER = ("floor2", "floor3")


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


def files() -> list[str]:
    """Return the names of the files that `write` writes."""
    functions = [name for model in ADDED for name, *_ in _tests(model)]
    return sorted([*functions, *(f"modes-{model}.csv" for model in ADDED)])


def write(folder: Path) -> None:
    """Simulate the tests of both models, and identify their modes, in a folder with test files."""
    rng = np.random.default_rng(SEED)
    for model, added in ADDED.items():
        H = accelerances(added)
        for name, j in _tests(model):
            write_text(folder / name, _measured(H[j], rng))
    for model in ADDED:
        test = read_test(folder / f"test-{model}.toml")
        identified = [identify(part.assembled.data, test.band, test.modes) for part in test.sets]
        modes = combine([part.name for part in test.sets], identified)
        write_csv(folder / f"modes-{model}.csv", modal_data_of(modes), modes.damping_std)


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
