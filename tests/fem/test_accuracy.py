"""Frequencies and deflections against closed forms, and the rates at which they converge."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve
from structures import STEEL, boundary, frequencies, move_inner, rate, rotation, solve_inner

from modefront import fem
from modefront._typing import Floats

Surface = Callable[[Floats, Floats], Floats]

# Roots of cos(x) cosh(x) = -1.
CANTILEVER = np.array([1.875104068711961, 4.694091132974175])


def _beam_model(
    count: int, section: fem.Section, supports: tuple[fem.Support, ...], Q: Floats
) -> fem.StructureMatrices:
    X, cells = fem.grids.line(np.zeros(3), np.array([1.0, 0, 0]), count)
    group = fem.Beams("b", cells, STEEL, section, orientation=Q[:, 1].tolist())
    return fem.assemble(fem.Structure(X @ Q.T, (group,), supports))


def test_cantilever_beam_of_8_elements() -> None:
    b_y, b_z = 0.01, 0.004
    Q = rotation(np.random.default_rng(0))
    model = _beam_model(8, fem.rectangle(b_y, b_z), (fem.Support(0),), Q)
    theory = np.concatenate(
        [CANTILEVER**2 * np.sqrt(STEEL.E * b**2 / 12 / STEEL.rho) for b in (b_y, b_z)]
    )
    result = frequencies(model, 3)
    assert result == pytest.approx(np.sort(theory)[:3], rel=5e-4)


def _hinged_errors(section: fem.Section, theory: float) -> list[float]:
    errors = []
    for n in (2, 4, 8, 16):
        supports = (fem.Support(0, ("x", "y", "z", "rx")), fem.Support(n, ("y", "z", "rx")))
        result = frequencies(_beam_model(n, section, supports, np.eye(3)), 1)[0]
        errors.append(result / theory - 1)
    return errors


def test_hinged_beam_with_rigid_shear_converges_with_order_4() -> None:
    h, k = 0.05, np.pi
    section = replace(fem.rectangle(h, h), kappa_y=np.inf, kappa_z=np.inf)
    theory = np.sqrt(STEEL.E * h**2 / 12 * k**4 / STEEL.rho / (1 + k**2 * h**2 / 12))
    errors = _hinged_errors(section, theory)
    assert abs(errors[1]) < 3e-4
    assert np.all(rate(errors) > 3.8)


def test_hinged_stocky_timoshenko_beam_converges_with_order_2() -> None:
    h, k = 0.2, np.pi
    section = fem.rectangle(h, h)
    # EI k^4 - rho A w^2 - rho I (1 + E / kappa G) k^2 w^2 + rho^2 I / (kappa G) w^4 = 0.
    kappa_G, r2 = section.kappa_y * STEEL.G, h**2 / 12
    linear = -(1 + k**2 * r2 * (1 + STEEL.E / kappa_G))
    c = [STEEL.rho * r2 / kappa_G, linear, k**4 * STEEL.E * r2 / STEEL.rho]
    errors = _hinged_errors(section, np.sqrt(np.roots(c).min()))
    assert abs(errors[2]) < 1e-3
    assert np.all(rate(errors) > 1.9)


def test_beam_is_exact_in_statics_with_one_element() -> None:
    L, F, section = 1.0, 1000.0, fem.hollow_rectangle(0.2, 0.1, 0.01)
    model = _beam_model(1, section, (fem.Support(0),), np.eye(3))
    K = model.stiffness.at(np.zeros(0)).tocsc()
    for d, inertia, kappa in ((1, section.I_z, section.kappa_y), (2, section.I_y, section.kappa_z)):
        u = spsolve(K, F * (np.arange(6) == d))
        exact = F * L**3 / (3 * STEEL.E * inertia) + F * L / (kappa * STEEL.G * section.A)
        assert u[d] == pytest.approx(exact, rel=1e-12)
    assert spsolve(K, F * (np.arange(6) == 3))[3] == pytest.approx(F * L / STEEL.G / section.J)


def mindlin(h: float, k2: float) -> float:
    """Circular frequency of a simply supported steel plate with shear at the wave number sqrt(k2).

    (S k2 - m w2)(D k2 + S - r w2) = S^2 k2 (R. D. Mindlin 1951, doi:10.1115/1.4010217).
    """
    D, S = STEEL.E * h**3 / (12 * (1 - STEEL.nu**2)), 5 / 6 * STEEL.G * h
    m, r = STEEL.rho * h, STEEL.rho * h**3 / 12
    c = [m * r, -(m * (D * k2 + S) + r * S * k2), S * D * k2**2]
    return float(np.sqrt(np.roots(c).min()))


def _plate_errors(
    n: int, amplitude: float, seed: int, triangles: bool, h: float = 1 / 200
) -> Floats:
    """Relative errors of four frequencies of a simply supported square of thickness h."""
    X, cells = fem.grids.plate(1.0, 1.0, n, n)
    X = move_inner(X, np.array([1 / n, 1 / n, 0]), amplitude, seed)
    cells = fem.grids.triangles(cells) if triangles else cells
    edges_x, edges_y = boundary(X, (0,)), boundary(X, (1,))
    supports = (
        fem.Support(np.arange(len(X)), ("x", "y", "rz")),
        fem.Support(edges_x, ("z", "rx")),
        fem.Support(edges_y, ("z", "ry")),
    )
    model = fem.assemble(fem.Structure(X, (fem.Shells("p", cells, STEEL, h),), supports))
    theory = [mindlin(h, k2) for k2 in np.pi**2 * np.array([2, 5, 5, 8])]
    return np.asarray(frequencies(model, 4) / theory - 1)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("triangles", [False, True])
def test_thin_plate_on_a_distorted_mesh(triangles: bool, seed: int) -> None:
    assert np.abs(_plate_errors(16, 0.2, seed, triangles)).max() < 0.0125


@pytest.mark.parametrize("triangles", [False, True])
def test_thin_plate_converges_with_order_2(triangles: bool) -> None:
    errors = [_plate_errors(n, 0.2, 1, triangles, 1 / 1000) for n in (8, 16, 32)]
    for mode in range(4):
        assert np.all(rate([e[mode] for e in errors]) > 1.6)


@pytest.mark.parametrize("triangles", [False, True])
@pytest.mark.parametrize("length", [2, 8])
def test_shell_bends_in_its_plane_exactly(length: int, triangles: bool) -> None:
    # Pure bending from its values at both ends: no parasitic shear at any aspect ratio.
    L, b, t = 4.0, 0.5, 0.01
    X, cells = fem.grids.plate(L, b, length, 1)
    cells = fem.grids.triangles(cells) if triangles else cells
    model = fem.assemble(fem.Structure(X, (fem.Shells("p", cells, STEEL, t),)), floating=True)
    x, y = X[:, 0], X[:, 1] - b / 2
    u = np.zeros((len(X), 6))
    u[:, 0], u[:, 5] = x * y, -x
    u[:, 1] = -(x**2 + STEEL.nu * y**2) / 2
    given = np.zeros(u.shape, dtype=bool)
    given[boundary(X, (0,))] = True
    # The triangle has the exact energy; its loads on the free sides vanish in the mean only.
    error = np.abs(solve_inner(model, u, given) - u).max()
    assert error < (5e-3 if triangles else 1e-9) * np.abs(u).max()
    node, direction = model.dofs.free.T
    q = u[node, direction]
    energy = q @ (model.stiffness.at(np.zeros(0)) @ q) / 2
    assert energy == pytest.approx(STEEL.E * t * b**3 / 12 * L / 2, rel=1e-9)


def skew(angle: float) -> Surface:
    a = np.radians(angle)
    return lambda x, y: np.stack([x + np.sin(a) * y, np.cos(a) * y, 0 * x], 1)


def sphere(x: Floats, y: Floats) -> Floats:
    return np.stack([x - 0.5, y - 0.5, np.sqrt(1 - (x - 0.5) ** 2 - (y - 0.5) ** 2)], 1)


def saddle(x: Floats, y: Floats) -> Floats:
    return np.stack([x - 0.5, y - 0.5, (x - 0.5) ** 2 - (y - 0.5) ** 2], 1)


def twisted(x: Floats, y: Floats) -> Floats:
    arm, angle = 1.1 * (y - 0.5), np.pi / 2 * x
    return np.stack([12 * x, arm * np.cos(angle), arm * np.sin(angle)], 1)


def cylinder(x: Floats, y: Floats) -> Floats:
    return np.stack([np.sin(np.pi / 2 * x), y, np.cos(np.pi / 2 * x)], 1)


def _shell_frequencies(
    surface: Surface, h: float, n: int, held: tuple[int, ...], triangles: bool
) -> Floats:
    """First five frequencies of a shell over the unit square, clamped at 1 or at all edges."""
    X, cells = fem.grids.plate(1.0, 1.0, n, n)
    edges = boundary(X, held) if len(held) == 2 else np.flatnonzero(X[:, 0] == 0)
    # Along the shorter diagonals of skew plates, as mesh generators divide.
    cells = fem.grids.triangles(np.roll(cells, 1, axis=1)) if triangles else cells
    group = (fem.Shells("s", cells, STEEL, h),)
    structure = fem.Structure(surface(X[:, 0], X[:, 1]), group, (fem.Support(edges),))
    return frequencies(fem.assemble(structure), 5)


@pytest.mark.parametrize("triangles", [False, True])
@pytest.mark.parametrize(
    ("surface", "h", "held", "reference"),
    [
        (skew(0), 0.2, (0, 1), [8426.3, 14755.1, 14755.1, 19384.2, 19384.2]),
        (skew(45), 0.001, (0, 1), [102.82, 166.85, 232.63, 246.41, 309.58]),
        (skew(60), 0.001, (0, 1), [190.46, 278.26, 362.86, 456.52, 477.18]),
        (skew(60), 0.01, (0, 1), [1899.91, 2772.15, 3610.70, 4536.72, 4742.27]),
        (skew(60), 0.1, (0, 1), [14602.1, 19773.7, 24494.3, 28680.7, 29315.3]),
        (cylinder, 0.01, (0, 1), [1790.05, 1859.33, 2384.21, 2652.88, 2975.86]),
        (sphere, 0.001, (0,), [21.594, 27.149, 57.291, 80.328, 128.82]),
        (saddle, 0.001, (0,), [14.775, 15.341, 52.441, 56.349, 150.74]),
    ],
    ids=[
        *("thick", "skew by 45", "skew by 60, thin", "skew by 60", "skew by 60, thick"),
        *("cylinder", "sphere", "saddle"),
    ],
)
def test_shells_of_16_elements_a_side(
    surface: Surface, h: float, held: tuple[int, ...], reference: list[float], triangles: bool
) -> None:
    # The references are solids of high order: `solid_of_high_order` in benchmarks/elements.py.
    found = _shell_frequencies(surface, h, 16, held, triangles)
    assert np.abs(found / reference - 1).max() < 0.02


@pytest.mark.parametrize("triangles", [False, True])
def test_narrow_elements_twist_as_thick_shells_do(triangles: bool) -> None:
    # Shear near the edges takes 15 % of the stiffness; elements are 11 times as long as wide.
    found = _shell_frequencies(twisted, 0.32, 16, (0,), triangles)
    assert np.abs(found / [11.984, 30.765, 96.416, 151.94, 216.46] - 1).max() < 0.02


@pytest.mark.parametrize("triangles", [pytest.param(False, marks=pytest.mark.slow(2)), True])
def test_curved_shells_converge_with_order_2(triangles: bool) -> None:
    # An eighth of a cylinder with diaphragms: no corner or edge is singular.
    w = []
    for n in (8, 16, 32):
        X, cells = fem.grids.plate(np.pi / 2, 1.0, n, n)
        low, high = np.isclose(X, 0), np.isclose(X, [np.pi / 2, 1.0, 1.0])
        supports = (
            fem.Support(np.flatnonzero(low[:, 1]), ("x", "z", "ry")),
            fem.Support(np.flatnonzero(high[:, 1]), ("y", "rx", "rz")),
            fem.Support(np.flatnonzero(low[:, 0]), ("x", "ry", "rz")),
            fem.Support(np.flatnonzero(high[:, 0]), ("z", "rx", "ry")),
        )
        points = np.stack([np.sin(X[:, 0]), X[:, 1], np.cos(X[:, 0])], 1)
        cells = fem.grids.triangles(cells) if triangles else cells
        group = (fem.Shells("s", cells, STEEL, 0.1),)
        w.append(frequencies(fem.assemble(fem.Structure(points, group, supports)), 3))
    first, second = np.abs(np.diff(w, axis=0))
    assert np.all(first / second > 2**1.5)


@pytest.mark.parametrize("triangles", [False, True])
def test_hook_of_raasch(triangles: bool) -> None:
    # N. F. Knight 1997: 5.02 inches in solids; arcs of 60° and 150°, across which it is loaded.
    n, first = 16, np.radians(60)
    X, cells = fem.grids.plate(1.0, 1.0, n, n)
    cells = fem.grids.triangles(cells) if triangles else cells
    s = X[:, 0] * (14 * first + 46 * np.radians(150))
    a, b = np.minimum(s / 14, first), np.maximum(s - 14 * first, 0) / 46
    u = 14 * np.sin(a) + 46 * (np.sin(first) - np.sin(first - b))
    v = 14 * (1 - np.cos(a)) + 46 * (np.cos(first - b) - np.cos(first))
    group = (fem.Shells("hook", cells, fem.Material(3300.0, 0.35, 1.0), 2.0),)
    root = fem.Support(np.flatnonzero(X[:, 0] == 0))
    model = fem.assemble(fem.Structure(np.stack([u, v, 20 * X[:, 1]], 1), group, (root,)))
    load = np.zeros((len(X), 6))
    load[X[:, 0] == 1, 2] = np.where(np.isin(X[X[:, 0] == 1, 1], (0, 1)), 0.5, 1) / n
    forces = model.dofs.T.T @ load.ravel()
    tip = forces @ spsolve(model.stiffness.at(np.zeros(0)).tocsc(), forces)
    assert tip == pytest.approx(5.02, rel=0.02)


@pytest.mark.parametrize("triangles", [False, True])
def test_pulled_and_pressed_hemisphere(triangles: bool) -> None:
    # R. H. MacNeal, R. L. Harder: with a hole of 18°, bending without stretch; 0.093 refined.
    n = 16
    X, cells = fem.grids.plate(1.0, 1.0, n, n)
    cells = fem.grids.triangles(cells) if triangles else cells
    a, b = np.pi / 2 * X[:, 0], np.radians(72) * X[:, 1]
    points = 10 * np.stack([np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)], 1)
    supports = (
        fem.Support(np.flatnonzero(X[:, 0] == 0), ("y", "rx", "rz")),
        fem.Support(np.flatnonzero(X[:, 0] == 1), ("x", "ry", "rz")),
        fem.Support(0, ("z",)),
    )
    group = (fem.Shells("s", cells, fem.Material(6.825e7, 0.3, 1.0), 0.04),)
    model = fem.assemble(fem.Structure(points, group, supports))
    load = np.zeros((len(X), 6))
    load[0, 0], load[n * (n + 1), 1] = 1.0, -1.0
    forces = model.dofs.T.T @ load.ravel()
    u = model.dofs.T @ spsolve(model.stiffness.at(np.zeros(0)).tocsc(), forces)
    assert u[0] == pytest.approx(0.093, rel=0.01)


@pytest.mark.parametrize(
    ("shape", "quadratic", "expected"),
    [
        ("regular", False, (0.978, 0.973)),
        ("trapezoids", False, (0.047, 0.030)),
        ("regular", True, (0.970, 0.961)),
        ("parallelograms", True, (0.967, 0.941)),
        ("trapezoids", True, (0.886, 0.920)),
    ],
)
def test_slender_cantilever_of_distorted_bricks(
    shape: str, quadratic: bool, expected: tuple[float, float]
) -> None:
    # R. H. MacNeal, R. L. Harder: 6 x 0.2 x 0.1 of six bricks that lean by 45°, over the exact
    # deflections. Those of 20 nodes are in the collection; no brick of 8 nodes that passes the
    # patch test bends as a trapezoid.
    X, cells = fem.grids.box((6.0, 0.2, 0.1), (6, 1, 1))
    section = np.round(X[:, 0])
    base = {"regular": 0.0, "parallelograms": 1.0, "trapezoids": -1.0}[shape]
    inner = (section > 0) & (section < 6)
    X[inner, 0] += base ** section[inner] * (X[inner, 1] - 0.1)
    if quadratic:
        X, cells = fem.grids.quadratic_bricks(X, cells)
    root = fem.Support(np.flatnonzero(X[:, 0] < 1e-9), ("x", "y", "z"))
    group = (fem.Solids("s", cells, fem.Material(1e7, 0.3, 1.0)),)
    model = fem.assemble(fem.Structure(X, group, (root,)))
    K, tip = model.stiffness.at(np.zeros(0)).tocsc(), X[:, 0] > 6 - 1e-9
    for direction, exact, share in ((1, 0.1081, expected[0]), (2, 0.4321, expected[1])):
        load = np.zeros((len(X), 6))
        load[tip, direction] = 1 / tip.sum()
        forces = model.dofs.T.T @ load.ravel()
        assert forces @ spsolve(K, forces) / exact == pytest.approx(share, abs=1.5e-3)


def test_twisted_beam_of_warped_shells() -> None:
    # R. H. MacNeal, R. L. Harder, doi:10.1016/0168-874X(85)90003-4: tip displacements.
    L, b, t = 12.0, 1.1, 0.32
    X, cells = fem.grids.plate(L, b, 24, 4)
    angle, arm = np.pi / 2 * X[:, 0] / L, X[:, 1] - b / 2
    twisted = np.stack([X[:, 0], arm * np.cos(angle), arm * np.sin(angle)], 1)
    material = fem.Material(29e6, 0.22, 1.0)
    root = np.flatnonzero(X[:, 0] == 0)
    end = np.flatnonzero(X[:, 0] == L)
    sensors = (
        fem.Sensor("y", (L, 0, 0), "y"),
        fem.Sensor("z", (L, 0, 0), "z"),
    )
    assert len(end) == 5
    model = fem.assemble(
        fem.Structure(
            twisted,
            (fem.Shells("s", cells, material, t),),
            (fem.Support(root),),
            sensors=sensors,
        )
    )
    K = model.stiffness.at(np.zeros(0)).tocsc()
    S = model.selection.toarray()
    flexibility = S @ spsolve(K, S.T)
    # At the tip the section stands along z: z is in its plane, y across it.
    assert flexibility[1, 1] == pytest.approx(5.424e-3, rel=0.02)
    assert flexibility[0, 0] == pytest.approx(1.754e-3, rel=0.02)


def test_cylindrical_roof_under_its_weight() -> None:
    # Scordelis-Lo roof in the same collection, 0.3006 at the middle of the free edge where shells
    # are refined (T. Belytschko et al., doi:10.1016/0045-7825(85)90035-0).
    n, R, L, t = 16, 25.0, 50.0, 0.25
    X, cells = fem.grids.plate(L / 2, np.radians(40), n, n)
    s, a = X[:, 0], X[:, 1]
    roof = np.stack([s, R * np.sin(a), R * np.cos(a)], 1)
    material = fem.Material(4.32e8, 0.0, 1.0)
    supports = (
        fem.Support(np.flatnonzero(s == 0), ("y", "z")),
        fem.Support(np.flatnonzero(s == L / 2), ("x", "ry", "rz")),
        fem.Support(np.flatnonzero(a == 0), ("y", "rx", "rz")),
    )
    group = (fem.Shells("roof", cells, material, t),)
    sensor = (fem.Sensor("edge", tuple(roof[-1].tolist()), "z"),)
    model = fem.assemble(fem.Structure(roof, group, supports, sensors=sensor))
    weight = np.where(model.dofs.free[:, 1] == 2, 1.0, 0.0)
    load = model.mass.at(np.zeros(0)) @ weight * (-90.0 / t)
    u = spsolve(model.stiffness.at(np.zeros(0)).tocsc(), load)
    assert (model.selection @ u)[0] == pytest.approx(-0.3006, rel=0.01)


def test_cantilever_of_bricks_with_one_through_the_thickness() -> None:
    X, cells = fem.grids.box((25.0, 1.0, 1.0), (25, 1, 1))
    root = fem.Support(np.flatnonzero(X[:, 0] == 0), ("x", "y", "z"))
    model = fem.assemble(fem.Structure(X, (fem.Solids("s", cells, STEEL),), (root,)))
    theory = CANTILEVER[0] ** 2 / 25**2 * np.sqrt(STEEL.E / 12 / STEEL.rho)
    assert frequencies(model, 2) == pytest.approx(theory, rel=5e-3)


@pytest.mark.parametrize(
    ("kind", "counts", "order"),
    [
        ("brick", (3, 5, 8), 2),
        ("tetrahedra", (3, 4, 5), 4),
        ("wedges", (2, 3, 4), 4),
        ("quadratic_bricks", (2, 3, 4), 4),
    ],
)
def test_solids_converge_to_the_shear_mode_of_a_box(
    kind: str, counts: tuple[int, ...], order: int
) -> None:
    # Faces that slide: u = (sin pi x cos pi y, -cos pi x sin pi y, 0), w^2 = 2 pi^2 G / rho.
    theory = np.pi * np.sqrt(2 * STEEL.G / STEEL.rho)
    errors = []
    for n in counts:
        X, cells = fem.grids.box((1.0, 1.0, 1.0), (n, n, n))
        if kind != "brick":
            X, cells = getattr(fem.grids, kind)(X, cells)
        supports = tuple(
            fem.Support(boundary(X, (d,)), (name,)) for d, name in enumerate(("x", "y", "z"))
        )
        model = fem.assemble(fem.Structure(X, (fem.Solids("s", cells, STEEL),), supports))
        errors.append(frequencies(model, 1)[0] / theory - 1)
    orders = np.log(np.abs(errors[:-1]) / np.abs(errors[1:])) / np.log(
        np.array(counts[1:]) / np.array(counts[:-1])
    )
    assert np.all(orders > order - 0.6), (errors, orders)


def test_free_box_has_six_zero_frequencies() -> None:
    X, cells = fem.grids.box((1.0, 0.5, 0.3), (3, 2, 2))
    model = fem.assemble(fem.Structure(X, (fem.Solids("s", cells, STEEL),)), floating=True)
    w = frequencies(model, 7, shift=1e4)
    assert np.all(w[:6] < 1e-3 * w[6])
