"""Errors of frequencies of plates, shells and cantilevers: docs/elements.md has the table.

    python benchmarks/elements.py [NAME ...]

prints errors of the first five in per cent, of quadrilaterals and of triangles, at 8, 16 and 32
elements a side: of hinged plates against Mindlin's closed form, of shells against bricks of 20
nodes (one over the thickness), of the thinnest, which bricks cannot resolve, against triangles.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
from scipy.sparse.linalg import eigsh, spsolve

from modefront import fem
from modefront._typing import Floats, Ints

STEEL = fem.Material(E=2.1e11, nu=0.3, rho=7850.0)
Surface = Callable[[Floats, Floats, Floats], Floats]
"""Points (nodes, 3) at the height z over the point (x, y) of the unit square."""


def frequencies(structure: fem.Structure, count: int = 5) -> Floats:
    """Return the first circular frequencies of a structure."""
    model = fem.assemble(structure)
    K, M = model.stiffness.at(np.zeros(0)).tocsc(), model.mass.at(np.zeros(0)).tocsc()
    return np.sqrt(np.sort(eigsh(K, count, M, sigma=0.0, return_eigenvectors=False)))


def at_edges(X: Floats, which: str) -> Ints:
    """Return the nodes of a unit square at all edges, at x = 0, or at both ends of x."""
    low, high = np.isclose(X[:, :2], 0), np.isclose(X[:, :2], 1)
    chosen = {"all": (low | high).any(1), "root": low[:, 0], "ends": (low | high)[:, 0]}
    return np.flatnonzero(chosen[which])


def plate(h: float, angle: float, clamped: bool, n: int, triangles: bool) -> Floats:
    """Return the frequencies of a rhombic plate of side 1 and skew angle in degrees."""
    X, cells = fem.grids.plate(1.0, 1.0, n, n)
    border, a = at_edges(X, "all"), np.radians(angle)
    if clamped:
        held = [fem.Support(border)]
    else:
        held = [fem.Support(np.arange(len(X)), ("x", "y", "rz")), fem.Support(border, ("z",))]
        held += [
            fem.Support(at_edges(X[:, [d, 1 - d, 2]], "ends"), (f"r{'xy'[d]}",))
            for d in ((0, 1) if not angle else ())
        ]
    X = np.column_stack([X[:, 0] + np.sin(a) * X[:, 1], np.cos(a) * X[:, 1], X[:, 2]])
    cells = fem.grids.triangles(cells) if triangles else cells
    return frequencies(fem.Structure(X, (fem.Shells("plate", cells, STEEL, h),), tuple(held)))


def plate_of_bricks(n: int, h: float, angle: float) -> Floats:
    """Return the frequencies of a clamped plate of bricks of 20 nodes, two over the depth."""
    X, cells = fem.grids.quadratic_bricks(*fem.grids.box((1.0, 1.0, h), (n, n, 2)))
    held = (fem.Support(at_edges(X, "all"), ("x", "y", "z")),)
    a = np.radians(angle)
    X = np.column_stack([X[:, 0] + np.sin(a) * X[:, 1], np.cos(a) * X[:, 1], X[:, 2]])
    structure = fem.Structure(X, (fem.Solids("plate", cells, STEEL),), held)
    return frequencies(structure)


def mindlin(h: float) -> Floats:
    """Return the frequencies of a simply supported unit square plate with shear."""
    G = STEEL.E / (2 * (1 + STEEL.nu))
    D, S = STEEL.E * h**3 / (12 * (1 - STEEL.nu**2)), 5 / 6 * G * h
    m, r = STEEL.rho * h, STEEL.rho * h**3 / 12
    k2 = np.pi**2 * np.array([2, 5, 5, 8, 10])
    # (S k2 - m w2)(D k2 + S - r w2) - S^2 k2 = 0
    roots = [np.roots([m * r, -(m * (D * k + S) + r * S * k), S * D * k**2]).min() for k in k2]
    return np.sqrt(np.real(roots))


def graph(
    height: Callable[[Floats, Floats], Floats], slope: Callable[..., tuple[Floats, Floats]]
) -> Surface:
    """Return the surface z(x, y) over a unit square around the origin."""

    def points(x: Floats, y: Floats, z: Floats) -> Floats:
        x, y = x - 0.5, y - 0.5
        p, q = slope(x, y)
        normal = np.column_stack([-p, -q, np.ones(len(x))])
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        return np.column_stack([x, y, height(x, y)]) + z[:, None] * normal

    return points


def cylinder(x: Floats, y: Floats, z: Floats) -> Floats:
    """Return points of a quarter of a cylinder of radius 1 and length 1, bent along x."""
    a = np.pi / 2 * x
    return np.column_stack([(1 + z) * np.sin(a), y, (1 + z) * np.cos(a)])


def twisted(x: Floats, y: Floats, z: Floats) -> Floats:
    """Return points of the twisted beam of MacNeal and Harder, 12 x 1.1."""
    a, arm = np.pi / 2 * x, 1.1 * (y - 0.5)
    return np.column_stack(
        [12 * x, arm * np.cos(a) - z * np.sin(a), arm * np.sin(a) + z * np.cos(a)]
    )


def hook(x: Floats, y: Floats, z: Floats) -> Floats:
    """Return points of Raasch's hook (inches): arcs of 60° of radius 14 and 150° of 46, 20 wide."""
    first, second = np.radians(60), np.radians(150)
    lengths = 14 * first, 46 * second
    s = x * sum(lengths)
    a = np.minimum(s / 14, first)
    b = np.maximum(s - lengths[0], 0) / 46
    turn = a - b
    u = 14 * np.sin(a) + 46 * (np.sin(first) - np.sin(first - b))
    v = 14 * (1 - np.cos(a)) + 46 * (np.cos(first - b) - np.cos(first))
    return np.column_stack([u - z * np.sin(turn), v + z * np.cos(turn), -20 * y])


def hyperbolic(x: Floats, y: Floats, z: Floats) -> Floats:
    """Return points of a quarter of a cooling tower, r^2 = 1 + (2 y - 1)^2, by its mid-surface."""
    a, height = np.pi / 2 * x, 2 * y - 1
    r = np.sqrt(1 + height**2)
    scale = z / np.sqrt(r**2 + height**2)
    radius = r + scale * r
    return np.column_stack([radius * np.cos(a), radius * np.sin(a), height - scale * height])


SURFACES: Mapping[str, tuple[Surface, str, tuple[float, ...]]] = {
    "cylinder": (cylinder, "root", (0.01, 0.001)),
    "pinched cylinder": (cylinder, "all", (0.01, 0.001)),
    "sphere": (
        graph(
            lambda x, y: np.sqrt(1 - x**2 - y**2),
            lambda x, y: (-x / np.sqrt(1 - x**2 - y**2), -y / np.sqrt(1 - x**2 - y**2)),
        ),
        "root",
        (0.1, 0.01, 0.001),
    ),
    "saddle": (
        graph(lambda x, y: x**2 - y**2, lambda x, y: (2 * x, -2 * y)),
        "root",
        (0.1, 0.01, 0.001),
    ),
    "hyperbolic shell": (hyperbolic, "ends", (0.01, 0.001)),
    "twisted beam": (twisted, "root", (0.32, 0.0032)),
    "Raasch's hook": (hook, "root", (2.0,)),
}
"""Surfaces over the unit square, what is clamped, and thicknesses."""


def shell(name: str, h: float, n: int, triangles: bool) -> Floats:
    """Return the frequencies of a shell of n x n elements."""
    surface, clamped, _ = SURFACES[name]
    X, cells = fem.grids.plate(1.0, 1.0, n, n)
    held = (fem.Support(at_edges(X, clamped)),)
    cells = fem.grids.triangles(cells) if triangles else cells
    group = (fem.Shells("shell", cells, STEEL, h),)
    return frequencies(fem.Structure(surface(*X.T), group, held))


def shell_of_bricks(n: int, name: str, h: float) -> Floats:
    """Return the frequencies of a shell of bricks of 20 nodes, n x n and one over the thickness."""
    surface, clamped, _ = SURFACES[name]
    X, cells = fem.grids.quadratic_bricks(*fem.grids.box((1.0, 1.0, h), (n, n, 1)))
    held = (fem.Support(at_edges(X, clamped), ("x", "y", "z")),)
    X = surface(X[:, 0], X[:, 1], X[:, 2] - h / 2)
    return frequencies(fem.Structure(X, (fem.Solids("shell", cells, STEEL),), held))


def hook_deflection(n: int, triangles: bool) -> float:
    """Return the deflection across the tip of Raasch's hook in inches, 5.02 in fine solids."""
    X, cells = fem.grids.plate(1.0, 1.0, n, n)
    tip = np.isclose(X[:, 0], 1)
    held = (fem.Support(at_edges(X, "root")),)
    cells = fem.grids.triangles(cells) if triangles else cells
    group = (fem.Shells("hook", cells, fem.Material(3300.0, 0.35, 1.0), 2.0),)
    model = fem.assemble(fem.Structure(hook(*X.T), group, held))
    share = np.where(tip, 1.0, 0.0)
    share[tip & (np.isclose(X[:, 1], 0) | np.isclose(X[:, 1], 1))] = 0.5
    load = np.zeros((len(X), 6))
    load[:, 2] = share / share.sum()
    q = spsolve(model.stiffness.at(np.zeros(0)).tocsc(), model.dofs.T.T @ load.ravel())
    return float(load.ravel() @ (model.dofs.T @ q))


def cantilever(count: int, distortion: float, quadratic: bool = False) -> float:
    """Return the first frequency of a cantilever 10 x 1 x 1 of bricks.

    Inner sections lean to and fro by this share of the length of a brick.
    """
    X, cells = fem.grids.box((10.0, 1.0, 1.0), (count, 1, 1))
    step = 10.0 / count
    inner = (X[:, 0] > 1e-9) & (X[:, 0] < 10 - 1e-9)
    sign = np.where(np.round(X[:, 0] / step) % 2 == 0, 1.0, -1.0)
    X[inner, 0] += (distortion * step * sign * (X[:, 2] - 0.5))[inner]
    if quadratic:
        X, cells = fem.grids.quadratic_bricks(X, cells)
    held = (fem.Support(np.flatnonzero(X[:, 0] < 1e-9), ("x", "y", "z")),)
    return float(frequencies(fem.Structure(X, (fem.Solids("beam", cells, STEEL),), held), 1)[0])


def show(name: str, reference: Floats, found: Callable[[int, bool], Floats]) -> None:
    """Print the errors of quadrilaterals and triangles."""
    for n in (8, 16, 32):
        rows = [100 * (found(n, triangles) / reference - 1) for triangles in (False, True)]
        text = "   ".join(" ".join(f"{error:+6.2f}" for error in row) for row in rows)
        print(f"{name:32s} {n:2d}   {text}", flush=True)


def main(names: list[str]) -> None:
    """Print all errors, or those of the names that are given."""
    print("error of five frequencies in per cent, quadrilaterals   triangles")
    for h in (0.001, 0.01, 0.1, 0.2) if not names or "hinged" in names else ():
        show(f"hinged plate, h = {h:g}", mindlin(h), partial(plate, h, 0, False))
    for h in (0.001, 0.1, 0.2) if not names or "clamped" in names else ():
        fine = plate_of_bricks(20, h, 0) if h > 0.01 else plate(h, 0, True, 64, True)
        show(f"clamped plate, h = {h:g}", fine, partial(plate, h, 0, True))
    for angle in (30.0, 45.0, 60.0) if not names or "skew" in names else ():
        for clamped in (False, True):
            fine = plate(0.005, angle, clamped, 64, False)
            text = f"{angle:g}° plate, {'clamped' if clamped else 'hinged'}"
            show(text, fine, partial(plate, 0.005, angle, clamped))
    for name, (_, _, thicknesses) in SURFACES.items():
        for h in thicknesses if not names or name in names else ():
            fine = shell_of_bricks(32, name, h) if h > 0.005 else shell(name, h, 80, True)
            show(f"{name}, h = {h:g}", fine, partial(shell, name, h))
    if not names or "hook" in names:
        for n in (8, 16, 32):
            tips = [hook_deflection(n, triangles) for triangles in (False, True)]
            print(f"Raasch's hook, tip {n}: {tips[0]:.3f} {tips[1]:.3f}")
    if not names or "bricks" in names:
        finest = cantilever(40, 0.0, True)
        for count in (5, 10, 20):
            for distortion in (0.0, 0.2, 0.3):
                rows = [
                    100 * (cantilever(count, distortion, q) / finest - 1) for q in (False, True)
                ]
                text = f"{rows[0]:+.2f} %, of 20 nodes {rows[1]:+.2f} %"
                print(f"{count} bricks, {distortion:g}: {text}")


if __name__ == "__main__":
    main(sys.argv[1:])
