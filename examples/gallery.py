"""Writes what was measured in the simulated examples of the gallery, and the matrices of one.

    python examples/gallery.py [FOLDER]

FOLDER holds a folder for each example; by default it is that of the package. The true values are
those of the comments in the study files. Errors of measurement are Gaussian: a share of each
frequency, and a share of the greatest component of each shape. The matrices of the footbridge are
not made here but by CalculiX, from its deck.
"""

from __future__ import annotations

import csv
import sys
import tomllib
from pathlib import Path

import numpy as np
from scipy import sparse

import modefront as mf
from modefront._typing import Floats
from modefront.data.csv import write_csv

EXAMPLES = Path(__file__).parents[1] / "src" / "modefront" / "study" / "examples"
DIGITS = 5

FOOTBRIDGE = {"girders": 0.92, "deck": 1.25, "bearings": 0.6, "surfacing": 1.2}

WALLS = {"north": 1.2, "south": 0.9, "east": 1.0, "west": 0.8}
ACROSS = {"north": (0, 4.0), "south": (0, -5.0), "east": (1, 7.0), "west": (1, -8.0)}
"""Direction of each wall, 0 along x and 1 along y, and its distance from the middle in m."""
WALL = (8.0e7, 1.3e8)  # N/m, along x and y
FLOOR, RADIUS, FLOORS = 9.0e4, 6.1, 4  # kg, radius of gyration in m
UNEVEN = 0.06
"""Standard deviation of the stiffness of a wall from story to story, over its mean."""

SPRING, MASS = 4.0e8, 2.0e5  # N/m, kg
SOFT, SOFTER = 5, 0.7
"""Story of the eighteen that is weak, and its stiffness over that of the drawing."""

BRACED = (1.1, 0.95, 1.05, 0.9, 1.0)
BRACE = 0.25
"""Spring between the roof and the neighbour, over the stiffness of a story."""


def measured(
    true: tuple[Floats, Floats],
    sensors: tuple[str, ...],
    errors: tuple[float, float],
    rng: np.random.Generator,
    stated: bool,
) -> mf.ModalData:
    """Return frequencies and shapes (modes, sensors) with errors, of a size that may be stated."""
    frequency, shape = true
    shape = shape / np.abs(shape).max(axis=1, keepdims=True)
    return mf.modal_data(
        frequency * (1 + errors[0] * rng.standard_normal(frequency.shape)),
        shape + errors[1] * rng.standard_normal(shape.shape),
        sensors,
        frequency_std=errors[0] * frequency if stated else None,
        shape_std=np.full(shape.shape, errors[1]) if stated else None,
    )


def modes_of(K: Floats, M: Floats, count: int, rows: Floats) -> tuple[Floats, Floats]:
    """Return frequencies and shapes at the sensors, whose places are ``rows`` (n, sensors)."""
    places = {f"s{i}": list(enumerate(row)) for i, row in enumerate(rows.T.tolist())}
    modes = mf.matrices(["one"], {"one": K}, {"base": M}, places).modes(np.ones(1), count)
    return modes.frequency, modes.phi.T


def chain_stiffness(springs: Floats, top: float = 0.0) -> Floats:
    """Return the stiffness matrix of a chain, with a spring from its top to the ground."""
    out = np.diag(springs + np.append(springs[1:], top))
    return out - np.diag(springs[1:], 1) - np.diag(springs[1:], -1)


def footbridge(folder: Path) -> None:
    """Write the modes of the footbridge, at the true values of its study's own matrices."""
    with (folder / "study.toml").open("rb") as file:
        model = tomllib.load(file)["model"]
    with (folder / "dofs.csv").open(encoding="utf-8", newline="") as table:
        dofs = [
            (int(row["node"]), row["direction"], float(row["weight"]))
            for row in csv.DictReader(table)
        ]
    places = {
        name: [
            (k, weight)
            for k, (node, way, weight) in enumerate(dofs)
            if (node, way) == (at["node"], at["direction"])
        ]
        for name, at in model["sensors"].items()
    }
    stiffness, mass = (
        {name: sparse.load_npz(folder / file) for name, file in model[matrix].items()}
        for matrix in ("stiffness", "mass")
    )
    modes = mf.matrices(list(FOOTBRIDGE), stiffness, mass, places).modes(
        np.array(list(FOOTBRIDGE.values())), 5
    )
    rng = np.random.default_rng(30)
    data = measured((modes.frequency, modes.phi.T), tuple(places), (0.003, 0.01), rng, stated=True)
    write_csv(folder / "modes.csv", data, digits=DIGITS)


def wall_matrices() -> tuple[dict[str, Floats], Floats]:
    """Return the stiffness of each wall by story (stories, n, n), and the mass matrix.

    Degrees of freedom are x, y and the turn of each floor, floor by floor, in m and rad.
    """
    parts = {}
    for name, (direction, distance) in ACROSS.items():
        row = np.zeros(3)
        row[direction] = 1.0
        row[2] = -distance if direction == 0 else distance
        stories = []
        for i in range(FLOORS):
            v = np.zeros((FLOORS, 3))
            v[i] = row
            if i:
                v[i - 1] = -row
            stories.append(WALL[direction] * np.outer(v, v))
        parts[name] = np.array(stories)
    mass = np.kron(np.eye(FLOORS), np.diag([FLOOR, FLOOR, FLOOR * RADIUS**2]))
    return parts, mass.astype(np.float64)


def three_groups(folder: Path) -> None:
    """Write the matrices of the building with four walls, and its modes."""
    parts, M = wall_matrices()
    for name, stories in parts.items():
        np.save(folder / f"stiffness-{name}.npy", stories.sum(axis=0))
    np.save(folder / "mass.npy", M)
    rng = np.random.default_rng(31)
    factors = {
        name: value * (1 + UNEVEN * rng.standard_normal(FLOORS)) for name, value in WALLS.items()
    }
    K = sum(
        (np.einsum("s,sij->ij", factors[name], stories) for name, stories in parts.items()),
        np.zeros_like(M),
    )
    sensors = tuple(
        f"{axis}{floor}{end}"
        for floor in (2, 4)
        for axis, end in (("x", "n"), ("x", "s"), ("y", "e"))
    )
    rows = np.zeros((3 * FLOORS, len(sensors)))
    for j, floor in enumerate((2, 4)):
        first = 3 * (floor - 1)
        rows[first, 3 * j : 3 * j + 2] = 1.0
        rows[first + 2, 3 * j : 3 * j + 3] = -4.0, 5.0, 7.0
        rows[first + 1, 3 * j + 2] = 1.0
    data = measured(modes_of(K, M, 6, rows), sensors, (0.003, 0.01), rng, stated=False)
    write_csv(folder / "modes.csv", data, digits=DIGITS)


def eighteen_stories(folder: Path) -> None:
    """Write the modes of the building of eighteen stories."""
    rng = np.random.default_rng(32)
    theta = np.ones(18)
    theta[SOFT - 1] = SOFTER
    floors = (3, 6, 10, 14, 18)
    rows = np.eye(18)[:, [floor - 1 for floor in floors]]
    true = modes_of(chain_stiffness(SPRING * theta), MASS * np.eye(18), 3, rows)
    sensors = tuple(f"floor{floor}" for floor in floors)
    data = measured(true, sensors, (0.002, 0.01), rng, stated=True)
    write_csv(folder / "modes.csv", data, digits=DIGITS)


def wrong_class(folder: Path) -> None:
    """Write the modes of five stories that lean on a neighbour at the roof."""
    rng = np.random.default_rng(33)
    springs = 1e8 * np.array(BRACED)
    K = chain_stiffness(springs, 1e8 * BRACE)
    true = modes_of(K, 5e4 * np.eye(5), 4, np.eye(5))
    sensors = tuple(f"floor{i + 1}" for i in range(5))
    data = measured(true, sensors, (0.002, 0.01), rng, stated=True)
    write_csv(folder / "modes.csv", data, digits=DIGITS)


def main() -> None:
    """Write the files of all examples that are simulated here."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else EXAMPLES
    for write in (footbridge, three_groups, eighteen_stories, wrong_class):
        write(folder / write.__name__.replace("_", "-"))


if __name__ == "__main__":
    main()
