"""Errors of elements that are thick, skew, distorted or curved: docs/elements.md has the table.

    python benchmarks/elements.py

prints errors of the first frequency, in per cent: of thick simply supported plates against
Mindlin's closed form, of the others against finer meshes of other elements.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from scipy.sparse.linalg import eigsh

from modefront import fem
from modefront._typing import Floats, Ints
from modefront.fem.limits import limits_of

STEEL = fem.Material(E=2.1e11, nu=0.3, rho=7850.0)


def first(structure: fem.Structure) -> float:
    """Return the first circular frequency of a structure."""
    model = fem.assemble(structure)
    K, M = model.stiffness.at(np.zeros(0)).tocsc(), model.mass.at(np.zeros(0)).tocsc()
    lam = eigsh(K, 1, M, sigma=0.0, return_eigenvectors=False)
    return float(np.sqrt(lam[0]))


def edge(X: Floats) -> Ints:
    """Return the nodes of the border of a unit square, before it is skew or curved."""
    on = np.isclose(X[:, :2], 0) | np.isclose(X[:, :2], 1)
    return np.flatnonzero(on.any(axis=1))


def thick(h: float, clamped: bool, n: int = 24) -> float:
    """Return the first frequency of a unit square plate of quadrilaterals."""
    X, cells = fem.grids.plate(1.0, 1.0, n, n)
    held = ("z", "rx", "ry") if clamped else ("z",)
    supports = (fem.Support(np.arange(len(X)), ("x", "y", "rz")), fem.Support(edge(X), held))
    return first(fem.Structure(X, (fem.Shells("plate", cells, STEEL, h),), supports))


def mindlin(h: float) -> float:
    """Return the first frequency of a simply supported unit square plate with shear."""
    k2, G = 2 * np.pi**2, STEEL.E / (2 * (1 + STEEL.nu))
    D, S = STEEL.E * h**3 / (12 * (1 - STEEL.nu**2)), 5 / 6 * G * h
    m, r = STEEL.rho * h, STEEL.rho * h**3 / 12
    # (S k2 - m w2)(D k2 + S - r w2) - S^2 k2 = 0
    c = [m * r, -(m * (D * k2 + S) + r * S * k2), S * k2 * (D * k2 + S) - S**2 * k2]
    return float(np.sqrt(np.roots(c).min()))


def clamped_bricks(h: float, n: int = 24) -> float:
    """Return the first frequency of a clamped unit square plate of bricks, four over its depth."""
    X, cells = fem.grids.box((1.0, 1.0, h), (n, n, 4))
    supports = (fem.Support(edge(X), ("x", "y", "z")),)
    return first(fem.Structure(X, (fem.Solids("plate", cells, STEEL),), supports))


def skew(n: int, angle: float, triangles: bool, clamped: bool) -> float:
    """Return the first frequency of a rhombic plate with thickness 1/200."""
    X, cells = fem.grids.plate(1.0, 1.0, n, n)
    border, a = edge(X), np.radians(angle)
    X = np.column_stack([X[:, 0] + np.sin(a) * X[:, 1], np.cos(a) * X[:, 1], X[:, 2]])
    held = ("z", "rx", "ry") if clamped else ("z",)
    supports = (fem.Support(np.arange(len(X)), ("x", "y", "rz")), fem.Support(border, held))
    cells = fem.grids.triangles(cells) if triangles else cells
    return first(fem.Structure(X, (fem.Shells("plate", cells, STEEL, 1 / 200),), supports))


SURFACES: Mapping[str, Callable[[Floats, Floats], Floats]] = {
    "cylinder": lambda x, y: np.sqrt(1 - x**2) + 0 * y,
    "sphere": lambda x, y: np.sqrt(1 - x**2 - y**2),
    "saddle": lambda x, y: x**2 - y**2,
}
"""Height over a unit square around the origin; radii of 1 (the saddle: 1/2) there."""


def curved(n: int, surface: str, triangles: bool, h: float) -> tuple[float, str]:
    """Return the first frequency of a curved shell clamped at one edge, and what is warned of."""
    X, cells = fem.grids.plate(1.0, 1.0, n, n)
    clamp = np.flatnonzero(np.isclose(X[:, 0], 0))
    x, y = X[:, 0] - 0.5, X[:, 1] - 0.5
    X = np.column_stack([x, y, SURFACES[surface](x, y)])
    cells = fem.grids.triangles(cells) if triangles else cells
    shells = (fem.Shells("shell", cells, STEEL, h),)
    structure = fem.Structure(X, shells, (fem.Support(clamp),))
    messages = [text for text in limits_of(structure, X).warnings(0.0) if "radius" in text]
    return first(structure), messages[0][messages[0].index("up to") : -8] if messages else ""


def cantilever(count: int, distortion: float, quadratic: bool = False) -> tuple[float, str]:
    """Return the first frequency of a cantilever 10 x 1 x 1 of bricks, and what is warned of.

    Inner sections lean to and fro by this share of the length of a brick.
    """
    X, cells = fem.grids.box((10.0, 1.0, 1.0), (count, 1, 1))
    step = 10.0 / count
    inner = (X[:, 0] > 1e-9) & (X[:, 0] < 10 - 1e-9)
    sign = np.where(np.round(X[:, 0] / step) % 2 == 0, 1.0, -1.0)
    X = X.copy()
    X[inner, 0] += (distortion * step * sign * (X[:, 2] - 0.5))[inner]
    if quadratic:
        X, cells = fem.grids.quadratic_bricks(X, cells)
    held = (fem.Support(np.flatnonzero(X[:, 0] < 1e-9), ("x", "y", "z")),)
    structure = fem.Structure(X, (fem.Solids("beam", cells, STEEL),), held)
    warnings = limits_of(structure, X).warnings(0.0)
    return first(structure), warnings[0][:60] if warnings else ""


def main() -> None:
    """Print all errors."""
    print("thick plates of shells, 24 x 24: error of the eigenvalue")
    for h in (0.02, 0.05, 0.1, 0.2):
        expected = 100 * 2 * np.pi**2 * h**2 / (5 * 0.7)
        result = 100 * ((thick(h, False) / mindlin(h)) ** 2 - 1)
        print(f"  simply supported, h = {h:g} a: {result:5.1f} %  (closed form {expected:.1f} %)")
    for h in (0.1, 0.2):
        result = 100 * ((thick(h, True) / clamped_bricks(h)) ** 2 - 1)
        print(f"  clamped, h = {h:g} a: {result:5.1f} %  (against bricks)")
    print("rhombic plates of quadrilaterals: error of the frequency (against 64 x 64)")
    for angle in (30.0, 45.0, 60.0):
        for clamped in (False, True):
            fine = skew(64, angle, False, clamped)
            errors = [100 * (skew(n, angle, False, clamped) / fine - 1) for n in (6, 12, 24)]
            other = 100 * (skew(64, angle, True, clamped) / fine - 1)
            text = ", ".join(f"{error:+.1f}" for error in errors)
            name = "clamped" if clamped else "simply supported"
            print(f"  {angle:g} degrees, {name}: {text} % at 6, 12, 24; triangles {other:+.2f} %")
    print("curved shells: stiffness over that of 64 x 64 quadrilaterals; triangles, quadrilaterals")
    for surface in SURFACES:
        for h in (0.01, 0.001):
            fine = curved(64, surface, False, h)[0]
            for n in (4, 8, 16, 32):
                result, warned = curved(n, surface, True, h)
                quads = (curved(n, surface, False, h)[0] / fine) ** 2
                ratio = (result / fine) ** 2
                print(f"  {surface}, {h:g}, {n} x {n}: {ratio:.2f}, {quads:.2f} {warned}")
    print("cantilevers of bricks: error of the frequency (against 40 bricks of 20 nodes)")
    fine = cantilever(40, 0.0, True)[0]
    for count in (5, 10, 20):
        for distortion in (0.0, 0.1, 0.2, 0.3):
            result, warned = cantilever(count, distortion)
            other = 100 * (cantilever(count, distortion, True)[0] / fine - 1)
            text = f"{100 * (result / fine - 1):+.1f} %, of 20 nodes {other:+.2f} %"
            print(f"  {count} bricks, {distortion:g}: {text}  {warned}")


if __name__ == "__main__":
    main()
