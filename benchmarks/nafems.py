"""Natural frequencies of the NAFEMS benchmarks beside their published targets.

    python benchmarks/nafems.py [NAME ...]

prints target, frequency and difference of every mode, on meshes about as coarse as those of the
standard. Definitions and targets are those of "The Standard NAFEMS Benchmarks", TNSB, revision 3,
1990 (F. Abbassian, D. J. Dawswell, N. C. Knowles, "Selected Benchmarks for Natural Frequency
Analysis", R0015, 1987), as the manuals of Abaqus, Ansys, Code_Aster and OptiStruct quote them.
Where these differ, closed forms decide: FV5 twists with the constant of a square section (71.20 and
213.61 Hz, not 77.54 and 233.10 Hz of the polar moment of area), the fourth mode of FV42 is at
2117.0 Hz (not 2111.7).
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.sparse.linalg import eigsh

from modefront import fem
from modefront._typing import Floats

STEEL = fem.Material(E=200e9, nu=0.3, rho=8000.0)
IN_PLANE = ("z", "rx", "ry")
"""Directions that are held where a structure moves in x and y only."""


def frequencies(structure: fem.Structure, count: int, rigid: int = 0) -> Floats:
    """Return the first frequencies in Hz after the rigid motions."""
    model = fem.assemble(structure, floating=rigid > 0)
    K, M = model.stiffness.at(np.zeros(0)).tocsc(), model.mass.at(np.zeros(0)).tocsc()
    shift = -1e-3 * K.diagonal().sum() / M.diagonal().sum() if rigid else 0.0
    values = eigsh(K, count + rigid, M, sigma=shift, return_eigenvectors=False)
    return np.sqrt(np.sort(values)[rigid:]) / (2 * np.pi)


def double_cross() -> Floats:
    """FV2: eight arms of 5 m, pinned at their ends, four beams each."""
    X, cells, ends = [np.zeros((1, 3))], [], []
    for n in range(8):
        angle = n * np.pi / 4
        arm, _ = fem.grids.line(np.zeros(3), 5.0 * np.array([np.cos(angle), np.sin(angle), 0]), 4)
        X.append(arm[1:])
        nodes = [0, *(1 + 4 * n + k for k in range(4))]
        cells += list(pairwise(nodes))
        ends.append(nodes[-1])
    group = fem.Beams("arms", np.array(cells), STEEL, fem.rectangle(0.125, 0.125))
    held = (fem.Support(range(33), IN_PLANE), fem.Support(ends, ("x", "y")))
    return frequencies(fem.Structure(np.concatenate(X), (group,), held), 16)


def point_masses() -> Floats:
    """FV4: a cantilever of 10 m with masses 2 m to either side of its end, five beams."""
    X, cells = fem.grids.line(np.zeros(3), np.array([10.0, 0, 0]), 5)
    group = fem.Beams("beam", cells, STEEL, fem.circle(0.5))
    masses = [
        fem.Mass(f"m{n}", [5], mass, offset=(0, side, 0))
        for n, (mass, side) in enumerate(((1e4, 2.0), (1e3, -2.0)))
    ]
    return frequencies(fem.Structure(X, (group,), (fem.Support(0),), masses=masses), 6)


def deep_beam() -> Floats:
    """FV5: a beam of 10 m by 2 m by 2 m, held in x, y, z and twist at A, in y and z at B."""
    X, cells = fem.grids.line(np.zeros(3), np.array([10.0, 0, 0]), 5)
    group = fem.Beams("beam", cells, STEEL, fem.rectangle(2.0, 2.0))
    held = (fem.Support(0, ("x", "y", "z", "rx")), fem.Support(5, ("y", "z")))
    return frequencies(fem.Structure(X, (group,), held), 9)


def shells(thickness: float, n: int, edges: str, angle: float = 90.0) -> fem.Structure:
    """Return a plate of side 10 m, free, clamped at x = 0 or all around, that moves in z only."""
    X, cells = fem.grids.plate(10.0, 10.0, n, n)
    on = np.isclose(X, 0) | np.isclose(X, 10.0)
    columns = {"free": [], "root": [0], "all": [0, 1]}[edges]
    border = np.flatnonzero((on & (np.isclose(X, 0) | (edges == "all")))[:, columns].any(1))
    a = np.radians(angle)
    X = np.column_stack([X[:, 0] + np.cos(a) * X[:, 1], np.sin(a) * X[:, 1], X[:, 2]])
    held = [fem.Support(range(len(X)), ("x", "y", "rz"))]
    if len(border):
        held.append(fem.Support(border))
    return fem.Structure(X, (fem.Shells("plate", cells, STEEL, thickness),), held)


def tapered_membrane(n: int) -> Floats:
    """FV32: a membrane 10 m long, of 5 m at its root and 1 m at its tip, n x n / 2 shells."""
    X, cells = fem.grids.plate(10.0, 1.0, n, n // 2)
    X[:, 1] = (X[:, 1] - 0.5) * (5.0 - 0.4 * X[:, 0])
    root = np.flatnonzero(X[:, 0] == 0)
    held = (fem.Support(range(len(X)), IN_PLANE), fem.Support(root, ("x", "y")))
    return frequencies(fem.Structure(X, (fem.Shells("m", cells, STEEL, 0.05),), held), 6)


def hollow_sphere() -> Floats:
    """FV42: radii 1.8 and 6 m, radial motion: ten bricks of 20 nodes in a pyramid of 2 degrees.

    Supports across the radius of each node leave the radial motion.
    """
    X, cells = fem.grids.quadratic_bricks(*fem.grids.box((1.0, 1.0, 1.0), (10, 1, 1)))
    half = np.radians(1.0)
    direction = np.column_stack(
        [np.ones(len(X)), np.tan(half * (2 * X[:, 1] - 1)), np.tan(half * (2 * X[:, 2] - 1))]
    )
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    X = (1.8 + 4.2 * X[:, :1]) * direction
    across = np.array([0.0, 1.0, 0.0])
    held = [
        fem.Support(n, ("y", "z"), axes=(radius.tolist(), across.tolist()))
        for n, radius in enumerate(direction)
    ]
    return frequencies(fem.Structure(X, (fem.Solids("s", cells, STEEL),), held), 5)


def radial_modes(count: int = 5) -> Floats:
    """Closed form of FV42: roots of the determinant of the radial stresses at both surfaces.

    u = d/dr (A sin(k r) + B cos(k r)) / r, with k = omega / c and c^2 = (lam + 2 G) / rho.
    """
    E, nu = STEEL.E, STEEL.nu
    lam, G = E * nu / (1 + nu) / (1 - 2 * nu), STEEL.G
    c = np.sqrt((lam + 2 * G) / STEEL.rho)

    def determinant(k: Floats) -> Floats:
        rows = []
        for r in (1.8, 6.0):
            x = k * r
            for s, ds in ((np.sin(x), np.cos(x)), (np.cos(x), -np.sin(x))):
                # Stress of the potential s / r: -(lam + 2 G) k^2 s / r - 4 G / r d/dr (s / r).
                rows.append(-(lam + 2 * G) * k**2 * s / r - 4 * G / r * (k * ds / r - s / r**2))
        return np.asarray(rows[0] * rows[3] - rows[1] * rows[2])

    k = np.linspace(1e-3, 6.0, 600_001)
    value = determinant(k)
    at = np.flatnonzero(np.sign(value[1:]) != np.sign(value[:-1]))[:count]
    root = k[at] - value[at] * (k[at + 1] - k[at]) / (value[at + 1] - value[at])
    return np.asarray(root * c / (2 * np.pi))


def solid_plate(quadratic: bool) -> Floats:
    """FV52: 10 m by 10 m by 1 m, held in z along the lower edges: bricks of 20 or 8 nodes."""
    X, cells = fem.grids.box((10.0, 10.0, 1.0), (4, 4, 1) if quadratic else (8, 8, 3))
    if quadratic:
        X, cells = fem.grids.quadratic_bricks(X, cells)
    on = (np.isclose(X[:, :2], 0) | np.isclose(X[:, :2], 10.0)).any(1) & np.isclose(X[:, 2], 0)
    held = (fem.Support(np.flatnonzero(on), ("z",)),)
    return frequencies(fem.Structure(X, (fem.Solids("plate", cells, STEEL),), held), 7, rigid=3)


@dataclass(frozen=True)
class Case:
    """A benchmark.

    Attributes
    ----------
    title : what it is, and the mesh
    target : frequencies (modes,) in Hz
    solve : returns ours
    within : greatest difference in per cent that passes: about that of other programs' elements of
        as many nodes on this mesh
    """

    title: str
    target: Sequence[float]
    solve: Callable[[], Floats]
    within: float


CROSS = (11.336, *[17.709] * 7, 45.345, *[57.390] * 7)
MASSES = (1.723, 1.727, 7.413, 9.972, 18.155, 26.957)
DEEP = (42.650, 42.650, 71.20, 125.00, 148.15, 148.15, 213.61, 283.47, 283.47)
FREE = (1.622, 2.360, 2.922, 4.233, 4.233, 7.416)
THIN = (7.938, 12.835, 17.941, 19.133, 24.009, 27.922)
CANTILEVER = (0.421, 1.029, 2.582, 3.306, 3.753, 6.555)
THICK = (133.95, 201.41, 265.81, 282.74, 334.45, 386.62)
MEMBRANE = (44.623, 130.03, 162.70, 246.05, 379.90, 391.44)
SOLID = (45.897, 109.44, 109.44, 167.89, 193.59, 206.19, 206.19)


def plate(target: Sequence[float], within: float, h: float, n: int, edges: str) -> Case:
    """Return the case of a plate of n x n shells."""
    names = {"free": "free square", "root": "cantilevered square", "all": "clamped rhombic"}
    angle, rigid = (45.0 if edges == "all" else 90.0), (3 if edges == "free" else 0)
    title = f"{names[edges]} plate, {h} m thick, {n} x {n} shells"
    return Case(title, target, lambda: frequencies(shells(h, n, edges, angle), 6, rigid), within)


def membrane(n: int, within: float) -> Case:
    """Return the case of a membrane of n x n / 2 shells."""
    title = f"tapered membrane, {n} x {n // 2} shells"
    return Case(title, MEMBRANE, lambda: tapered_membrane(n), within)


CASES = {
    "FV2": Case("double cross, 32 beams", CROSS, double_cross, 1.0),
    "FV4": Case("masses off the end of a cantilever, 5 beams", MASSES, point_masses, 1.0),
    "FV5": Case("deep beam, 5 beams", DEEP, deep_beam, 6.5),
    "FV12": plate(FREE, 1.0, 0.05, 8, "free"),
    "FV15": plate(THIN, 4.5, 0.05, 12, "all"),
    "FV15, finer": plate(THIN, 2.0, 0.05, 24, "all"),
    "FV16": plate(CANTILEVER, 1.0, 0.05, 8, "root"),
    "FV22": plate(THICK, 5.0, 1.0, 10, "all"),
    "FV22, finer": plate(THICK, 2.5, 1.0, 20, "all"),
    "FV32": membrane(16, 4.0),
    "FV32, finer": membrane(32, 1.5),
    "FV42": Case("hollow sphere, 10 bricks", tuple(radial_modes()), hollow_sphere, 0.5),
    "FV52": Case("solid plate, 4 x 4 bricks of 20 nodes", SOLID, lambda: solid_plate(True), 2.5),
    "FV52, 8 nodes": Case("solid plate, 8 x 8 x 3 bricks", SOLID, lambda: solid_plate(False), 4.5),
}


def differences(case: Case) -> tuple[Floats, Floats]:
    """Return frequencies and their differences from the targets in per cent."""
    found, target = case.solve(), np.asarray(case.target)
    return found, 100 * (found / target - 1)


def main() -> None:
    for name in sys.argv[1:] or CASES:
        case = CASES[name]
        print(f"{name}: {case.title}")
        for target, found, error in zip(case.target, *differences(case), strict=True):
            print(f"    {target:9.3f} {found:9.3f} {error:+6.2f} %")


if __name__ == "__main__":
    main()
