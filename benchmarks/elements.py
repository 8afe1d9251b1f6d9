"""Errors of plates, shells and cantilevers, with verdicts: docs/elements.md has the table.

    python benchmarks/elements.py [NAME ...]

prints the least and the greatest error of the first five frequencies in per cent, of quadrilaterals
and of triangles, at 8, 16 and 32 elements a side: of hinged square plates against Mindlin's closed
form, of all others against solids of high order, which are made here; and deflections of published
problems. NAME is a part of what is printed: without any, all are, which takes half an hour; the
others are bricks and thickness.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import product
from typing import NamedTuple

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, eigsh, splu, spsolve

from modefront import fem
from modefront._typing import Bools, Floats, Ints
from modefront.fem.elements.common import elasticity
from modefront.fem.elements.shapes import Cell, gradients

TARGET = 2.0
"""Error in per cent at 16 elements a side that none should exceed."""

STEEL = fem.Material(E=2.1e11, nu=0.3, rho=7850.0)
Surface = Callable[[Floats, Floats, Floats], Floats]
"""Points (nodes, 3) at the height z over the point (x, y) of the unit square."""


def frequencies(structure: fem.Structure, count: int = 5, theta: Sequence[float] = ()) -> Floats:
    """Return the first circular frequencies of a structure."""
    model, at = fem.assemble(structure), np.array(theta, dtype=float)
    K, M = model.stiffness.at(at).tocsc(), model.mass.at(at).tocsc()
    return np.sqrt(np.sort(eigsh(K, count, M, sigma=0.0, return_eigenvectors=False)))


def at_edges(X: Floats, which: str) -> Ints:
    """Return the nodes of a unit square at all edges, at x = 0, or at both ends of x."""
    low, high = np.isclose(X[:, :2], 0), np.isclose(X[:, :2], 1)
    chosen = {"all": (low | high).any(1), "root": low[:, 0], "ends": (low | high)[:, 0]}
    return np.flatnonzero(chosen[which])


def skew(angle: float) -> Surface:
    """Return the map of the unit square to a rhombus; the angle is in degrees."""
    a = np.radians(angle)
    return lambda x, y, z: np.column_stack([x + np.sin(a) * y, np.cos(a) * y, z])


def divided(cells: Ints, triangles: bool, leaning: bool = False) -> Ints:
    """Return the cells, or triangles along their shorter diagonals."""
    return fem.grids.triangles(np.roll(cells, -leaning, axis=1)) if triangles else cells


def plate(h: float, angle: float, clamped: bool, n: int, triangles: bool) -> Floats:
    """Return the frequencies of a rhombic plate of side 1 and skew angle in degrees."""
    X, cells = fem.grids.plate(1.0, 1.0, n, n)
    border = at_edges(X, "all")
    if clamped:
        held = [fem.Support(border)]
    else:
        held = [fem.Support(np.arange(len(X)), ("x", "y", "rz")), fem.Support(border, ("z",))]
        held += [
            fem.Support(at_edges(X[:, [d, 1 - d, 2]], "ends"), (f"r{'xy'[d]}",))
            for d in ((0, 1) if not angle else ())
        ]
    group = (fem.Shells("plate", divided(cells, triangles, angle > 0), STEEL, h),)
    return frequencies(fem.Structure(skew(angle)(*X.T), group, tuple(held)))


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


sphere = graph(
    lambda x, y: np.sqrt(1 - x**2 - y**2),
    lambda x, y: (-x / np.sqrt(1 - x**2 - y**2), -y / np.sqrt(1 - x**2 - y**2)),
)
saddle = graph(lambda x, y: x**2 - y**2, lambda x, y: (2 * x, -2 * y))

SHELLS: tuple[tuple[str, Surface, str, tuple[float, ...]], ...] = (
    ("cylinder, a quarter", cylinder, "root", (0.01, 0.001)),
    ("cylinder, a quarter, all edges held", cylinder, "all", (0.01,)),
    ("sphere", sphere, "root", (0.1, 0.01, 0.001)),
    ("saddle", saddle, "root", (0.1, 0.01, 0.001)),
    ("cooling tower, a quarter", hyperbolic, "ends", (0.01,)),
    ("twisted beam", twisted, "root", (0.32,)),
)
"""Surfaces over the unit square, what is clamped, and thicknesses."""


def shell(surface: Surface, clamped: str, h: float, n: int, triangles: bool) -> Floats:
    """Return the frequencies of a shell of n x n elements."""
    X, cells = fem.grids.plate(1.0, 1.0, n, n)
    held = (fem.Support(at_edges(X, clamped)),)
    group = (fem.Shells("shell", divided(cells, triangles), STEEL, h),)
    return frequencies(fem.Structure(surface(*X.T), group, held))


LINES = np.array([0.0, 0.04, 0.16, 0.33, 0.5, 0.67, 0.84, 0.96, 1.0])
FINER = np.array([0.0, 0.006, 0.04, 0.16, 0.33, 0.5, 0.67, 0.84, 0.96, 0.994, 1.0])
DEGREE = 5
"""Elements of the solids of high order in each direction of the surface, and their degree; those
that resolve the corners of hinged skew plates."""


def lobatto(degree: int) -> Floats:
    """Return the nodes of Gauss, Legendre and Lobatto on [-1, 1]."""
    inner = np.polynomial.legendre.Legendre.basis(degree).deriv().roots().real
    return np.concatenate([[-1.0], np.sort(inner), [1.0]])


def solid_of_high_order(
    surface: Surface, h: float, held: Callable[[Floats], Bools], lines: Floats = LINES
) -> Floats:
    """Return the frequencies of a solid about a surface, as accurate as four digits.

    Over the thickness, degree 2 has the stretch and the bending of thin ones, 4 the shear of thick
    ones. ``held`` says which displacements (nodes, 3) are held at points (nodes, 3) of the square.
    """
    through, lines = (4, LINES[[0, 1, 3, 4, 5, 7, 8]]) if h >= 0.1 else (2, lines)
    degrees = (DEGREE, DEGREE, through)
    cell = Cell(
        np.array(list(product(*map(lobatto, degrees)))),
        np.array(list(product(*(range(degree + 1) for degree in degrees)))),
    )
    rules = [np.polynomial.legendre.leggauss(degree + 1) for degree in degrees]
    xi, w = (np.array(list(product(*(rule[k] for rule in rules)))) for k in (0, 1))
    N, dN = cell.shape(xi)
    steps = np.diff(lines)[:, None] * (1 + lobatto(DEGREE)[None, :-1]) / 2
    line = np.append((lines[:-1, None] + steps).ravel(), 1.0)
    points = np.array(list(product(line, line, lobatto(through) * h / 2)))
    X = surface(*points.T)
    grid = np.arange(len(points)).reshape(len(line), len(line), -1)
    at = [slice(DEGREE * k, DEGREE * (k + 1) + 1) for k in range(len(lines) - 1)]
    cells = np.array([grid[i, j].ravel() for i in at for j in at])
    dofs = (3 * cells[:, :, None] + np.arange(3)).reshape(len(cells), -1)
    K, M = sparse.csc_array((3 * len(X),) * 2), sparse.csc_array((3 * len(X),) * 2)
    C = elasticity(STEEL, np.eye(3))
    for nodes, own in zip(cells, dofs, strict=True):
        g, det = gradients(X[nodes][None], dN)
        weight, place = (
            np.abs(det[0]) * w.prod(1),
            (np.repeat(own, len(own)), np.tile(own, len(own))),
        )
        k = np.einsum("p,pja,ijkl,plb->aibk", weight, g[0], C, g[0], optimize=True)
        m = np.einsum("p,pa,pb,ij->aibj", STEEL.rho * weight, N, N, np.eye(3), optimize=True)
        K += sparse.csc_array((k.ravel(), place), shape=K.shape)
        M += sparse.csc_array((m.ravel(), place), shape=K.shape)
    free = np.flatnonzero(~held(points).ravel())
    K, M = K[free][:, free], M[free][:, free]
    lu = splu(K, "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    inverse = LinearOperator(K.shape, lu.solve)
    return np.sqrt(np.sort(eigsh(K, 5, M, 0.0, OPinv=inverse, return_eigenvectors=False)))


def held_at(which: str, points: Floats, hinged: bool = False) -> Bools:
    """Return the displacements (nodes, 3) held at edges: all, or those of a hinged plate."""
    held = np.zeros(points.shape, dtype=bool)
    edges = at_edges(points, which)
    held[edges] = True
    if hinged:
        held[edges, :2] = False
        held[np.abs(points[:, 2]) < 1e-12, :2] = True
    return held


class Case(NamedTuple):
    """Frequencies with a reference: name, reference, and found by elements a side, triangles."""

    name: str
    reference: Callable[[], Floats]
    found: Callable[[int, bool], Floats]


def cases() -> Iterator[Case]:
    """Yield all plates and shells."""
    for h in (0.001, 0.01, 0.1, 0.2):
        yield Case(f"hinged plate, h = {h:g}", partial(mindlin, h), partial(plate, h, 0, False))
    for angle, clamped in product((0.0, 30.0, 45.0, 60.0), (True, False)):
        for h in (0.001, 0.01, 0.1, 0.2)[: 3 if angle else 4 * clamped]:
            kind = ("clamped" if clamped else "hinged") + " plate"
            held = partial(held_at, "all", hinged=not clamped)
            yield Case(
                f"{kind}, {angle:g}°, h = {h:g}",
                partial(solid_of_high_order, skew(angle), h, held, LINES if clamped else FINER),
                partial(plate, h, angle, clamped),
            )
    for name, surface, clamped_at, thicknesses in SHELLS:
        for h in thicknesses:
            yield Case(
                f"{name}, h = {h:g}",
                partial(solid_of_high_order, surface, h, partial(held_at, clamped_at)),
                partial(shell, surface, clamped_at, h),
            )


def deflection(structure: fem.Structure, load: Floats) -> float:
    """Return the work of a load (nodes, 6)."""
    model = fem.assemble(structure)
    forces = model.dofs.T.T @ load.ravel()
    return float(forces @ spsolve(model.stiffness.at(np.zeros(0)).tocsc(), forces))


def hook_tip(n: int, triangles: bool) -> float:
    """Return the deflection across the tip of Raasch's hook in inches."""
    X, cells = fem.grids.plate(1.0, 1.0, n, n)
    tip = np.isclose(X[:, 0], 1)
    share = np.where(tip, 1.0, 0.0)
    share[tip & (np.isclose(X[:, 1], 0) | np.isclose(X[:, 1], 1))] = 0.5
    load = np.zeros((len(X), 6))
    load[:, 2] = share / share.sum()
    material = fem.Material(3300.0, 0.35, 1.0)
    group = (fem.Shells("hook", divided(cells, triangles), material, 2.0),)
    held = (fem.Support(at_edges(X, "root")),)
    return deflection(fem.Structure(hook(*X.T), group, held), load)


def twisted_tip(h: float, direction: int, n: int, triangles: bool) -> float:
    """Return the deflection of the tip of the twisted beam in inches, n by n / 4 elements."""
    X, cells = fem.grids.plate(1.0, 1.0, n, n // 4)
    points = twisted(*X.T)
    load = np.zeros((len(X), 6))
    load[np.argmin(np.linalg.norm(points - [12, 0, 0], axis=1)), direction] = 1.0
    group = (fem.Shells("beam", divided(cells, triangles), fem.Material(29e6, 0.22, 1.0), h),)
    held = (fem.Support(at_edges(X, "root")),)
    return deflection(fem.Structure(points, group, held), load)


def pinched(n: int, triangles: bool) -> float:
    """Return the deflection of an eighth of a pinched cylinder with diaphragms."""
    X, cells = fem.grids.plate(1.0, 1.0, n, n)
    low, high, a = np.isclose(X, 0), np.isclose(X, 1), np.pi / 2 * X[:, 1]
    points = np.column_stack([300 * X[:, 0], 300 * np.sin(a), 300 * np.cos(a)])
    held = (
        fem.Support(np.flatnonzero(low[:, 0]), ("y", "z")),
        fem.Support(np.flatnonzero(high[:, 0]), ("x", "ry", "rz")),
        fem.Support(np.flatnonzero(low[:, 1]), ("y", "rx", "rz")),
        fem.Support(np.flatnonzero(high[:, 1]), ("z", "rx", "ry")),
    )
    load = np.zeros((len(X), 6))
    load[high[:, 0] & low[:, 1], 2] = 0.5
    group = (fem.Shells("shell", divided(cells, triangles), fem.Material(3e6, 0.3, 1.0), 3.0),)
    return deflection(fem.Structure(points, group, held), load)


def hemisphere(n: int, triangles: bool) -> float:
    """Return the deflection of a quarter of a hemisphere with a hole of 18°, pulled and pressed."""
    X, cells = fem.grids.plate(1.0, 1.0, n, n)
    low, high = np.isclose(X, 0), np.isclose(X, 1)
    a, b = np.pi / 2 * X[:, 0], np.radians(72) * X[:, 1]
    points = 10 * np.column_stack([np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)])
    held = (
        fem.Support(np.flatnonzero(low[:, 0]), ("y", "rx", "rz")),
        fem.Support(np.flatnonzero(high[:, 0]), ("x", "ry", "rz")),
        fem.Support(0, ("z",)),
    )
    load = np.zeros((len(X), 6))
    load[0, 0], load[high[:, 0] & low[:, 1], 1] = 0.5**0.5, -(0.5**0.5)
    material = fem.Material(6.825e7, 0.3, 1.0)
    group = (fem.Shells("shell", divided(cells, triangles), material, 0.04),)
    return deflection(fem.Structure(points, group, held), load)


DEFLECTIONS: tuple[tuple[str, float, Callable[[int, bool], float]], ...] = (
    ("twisted beam, tip in plane, h = 0.32", 5.424e-3, partial(twisted_tip, 0.32, 2)),
    ("twisted beam, tip across, h = 0.32", 1.754e-3, partial(twisted_tip, 0.32, 1)),
    ("twisted beam, tip in plane, h = 0.0032", 5256.0, partial(twisted_tip, 0.0032, 2)),
    ("twisted beam, tip across, h = 0.0032", 1294.0, partial(twisted_tip, 0.0032, 1)),
    ("Raasch's hook, tip", 5.02, hook_tip),
    ("pinched cylinder", 1.8248e-5, pinched),
    ("hemisphere with a hole", 0.093, hemisphere),
)
"""Published deflections: R. H. MacNeal, R. L. Harder, doi:10.1016/0168-874X(85)90003-4;
T. Belytschko et al., doi:10.1016/0045-7825(85)90035-0; the thin twisted beam in J. C. Simo,
D. D. Fox, M. S. Rifai 1989; the hook, of solids, in N. F. Knight 1997."""


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


def relative(
    found: Callable[[int, bool], Floats | float], exact: Floats | float, n: int, triangles: bool
) -> Floats:
    """Return the relative errors."""
    return np.atleast_1d(found(n, triangles) / exact - 1)


def show(name: str, error: Callable[[int, bool], Floats], target: float) -> bool:
    """Print the least and greatest errors in per cent with a verdict, which is returned."""
    errors = {(n, kind): 100 * error(n, kind) for n in (8, 16, 32) for kind in (False, True)}
    rows = [
        "  ".join(
            f"{errors[n, kind].min():+6.2f} {errors[n, kind].max():+6.2f}" for n in (8, 16, 32)
        )
        for kind in (False, True)
    ]
    good = [bool(np.abs(errors[16, kind]).max() <= target) for kind in (False, True)]
    verdict = "  ".join("holds" if each else "FAILS" for each in good)
    print(f"{name:40s} {rows[0]}   {rows[1]}   {verdict}", flush=True)
    return all(good)


def bricks() -> None:
    """Print errors of the first frequency of distorted cantilevers, of 8 and of 20 nodes."""
    finest = cantilever(40, 0.0, True)
    for count, distortion in product((5, 10, 20), (0.0, 0.2, 0.3)):
        rows = [100 * (cantilever(count, distortion, q) / finest - 1) for q in (False, True)]
        text = f"{rows[0]:+.2f} %, of 20 nodes {rows[1]:+.2f} %"
        print(f"{count} bricks, {distortion:g}: {text}", flush=True)


def thickness() -> None:
    """Print how far frequencies at other thicknesses are from those of a new model."""
    for angle, size in product((0.0, 45.0), (6.0, 4.0, 1.0)):
        X, cells = fem.grids.plate(1.0, 1.0, 12, 12)
        held = (fem.Support(at_edges(X, "all")),)
        parameter = (fem.Parameter("t", "thickness", ("plate",)),)
        h, errors = 1 / 12 / size, []
        for factor, kind in product((0.5, 0.9, 1.1, 2.0), (False, True)):
            own, new = (
                fem.Shells("plate", divided(cells, kind, angle > 0), STEEL, t)
                for t in (h, h * factor)
            )
            structure = fem.Structure(skew(angle)(*X.T), (own,), held, parameters=parameter)
            w = frequencies(fem.Structure(skew(angle)(*X.T), (new,), held))
            errors.append(np.abs(frequencies(structure, theta=[factor]) / w - 1).max())
        text = "  ".join(f"{100 * error:.2f}" for error in errors)
        print(f"{angle:g}°, size {size:g} t, at 0.5, 0.9, 1.1, 2 of t: {text} %", flush=True)


def main(names: list[str]) -> None:
    """Print all errors, or those whose names have one of the given parts."""
    print(f"target {TARGET:g} % at 16: quadrilaterals at 8, 16, 32 elements a side   triangles")
    held = []
    for name, reference, found in cases():
        if not names or any(part in name for part in names):
            held.append(show(name, partial(relative, found, reference()), TARGET))
    print("deflections, whose errors are twice those of frequencies")
    for name, published, deflected in DEFLECTIONS:
        if not names or any(part in name for part in names):
            held.append(show(name, partial(relative, deflected, published), 2 * TARGET))
    print(f"{sum(held)} of {len(held)} hold, of quadrilaterals and triangles")
    if not names or "bricks" in names:
        bricks()
    if not names or "thickness" in names:
        thickness()


if __name__ == "__main__":
    main(sys.argv[1:])
