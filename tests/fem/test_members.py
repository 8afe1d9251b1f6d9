"""Releases, bars, springs and masses, couplings, skew supports and prestress: closed forms."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy import linalg
from scipy.sparse.linalg import eigsh
from structures import STEEL, frequencies, rate, rotation

from modefront import fem
from modefront._typing import Floats, Ints
from modefront.errors import InputError

NONE = np.zeros(0)
SLENDER = fem.Section(A=1e-2, I_y=4e-6, I_z=1e-6, J=3e-6, kappa_y=np.inf, kappa_z=np.inf)
Y, Z = (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def span(length: float = 3.0, count: int = 8, **options: Any) -> tuple[Floats, Ints, fem.Beams]:
    """A beam along x with local y along global y."""
    X, cells = fem.grids.line(np.zeros(3), np.array([length, 0, 0]), count)
    group = fem.Beams("beam", cells, STEEL, SLENDER, orientation=Y)
    return X, cells, replace(group, **options)


def stiffness(model: fem.StructureMatrices, theta: Floats = NONE) -> Floats:
    """K(theta), dense."""
    return np.asarray(model.stiffness.at(theta).toarray())


def flexibility(model: fem.StructureMatrices) -> Floats:
    """Displacements at the sensors of unit forces there."""
    K = model.stiffness.at(np.ones(len(model.parameters)))
    L = model.selection.toarray()
    return np.asarray(L @ linalg.solve(K.toarray(), L.T))


# --- beams ------------------------------------------------------------------------------------


def test_released_ends_are_hinges() -> None:
    X, cells, group = span(count=8)
    groups = [
        replace(group, cells=cells[:1], releases=(("ry", "rz"), ())),
        replace(group, cells=cells[1:-1]),
        replace(group, cells=cells[-1:], releases=((), ("ry", "rz"))),
    ]
    clamped = (fem.Support([0, len(X) - 1]),)
    model = fem.assemble(fem.Structure(X, groups, clamped))
    j, wave = np.array([1, 1, 2, 2, 3]), np.sqrt(STEEL.E / STEEL.rho / SLENDER.A)
    inertia = np.array([SLENDER.I_z, SLENDER.I_y])[[0, 1, 0, 1, 0]]
    theory = np.sort((j * np.pi / 3.0) ** 2 * wave * np.sqrt(inertia))
    assert frequencies(model, 5) == pytest.approx(theory, rel=2e-3)


def test_a_release_is_a_link_that_is_left_open() -> None:
    # An oblique, eccentric beam with releases at both ends, and the same with nodes of its own.
    X = np.array([[0, 0, 0], [0.1, 0.2, 0.0], [1.0, 0.7, 0.9], [1.1, 0.9, 0.7], [2.0, 1.0, 1.0]])
    section = fem.rectangle(0.08, 0.12)
    side = (0.3, -0.2, 1.0)
    axis = (X[2] - X[1]) / np.linalg.norm(X[2] - X[1])
    y = np.asarray(side) - axis * (axis @ side)
    offsets = (X[1] - X[0], X[2] - X[3])
    tail = fem.Beams("tail", np.array([[3, 4]]), STEEL, section, side)
    held = (fem.Support([0, 4]),)
    sensors = [fem.Sensor(d, 3, d) for d in fem.DIRECTIONS]
    hinged = fem.Beams(
        "b", np.array([[0, 3]]), STEEL, section, side, offsets, (("rx", "ry"), ("z", "rz"))
    )
    one = fem.assemble(fem.Structure(X, (hinged, tail), held, sensors=sensors))
    plain = replace(hinged, cells=np.array([[1, 2]]), offsets=np.zeros((2, 3)), releases=((), ()))
    soft, stiff = 0.0, 1e13
    at = [
        fem.Spring("s1", [1], [stiff, stiff, stiff, soft, soft, stiff], axes=(axis, y)),
        fem.Spring("s2", [2], [stiff, stiff, soft, stiff, stiff, soft], to=[5], axes=(axis, y)),
    ]
    two = fem.assemble(
        fem.Structure(
            np.concatenate([X, X[2:3]]),
            (plain, tail),
            held,
            at,
            links=(fem.Link(3, [5]),),
            sensors=sensors,
        )
    )
    assert flexibility(one) == pytest.approx(flexibility(two), rel=1e-4, abs=1e-12)


def test_releases_keep_the_rigid_motions_and_the_mass() -> None:
    X, cells, group = span(count=4)
    groups = [
        replace(group, cells=cells[:2], releases=((), ())),
        replace(group, cells=cells[2:3], releases=(("rz",), ())),
        replace(group, cells=cells[3:], releases=((), ())),
    ]
    model = fem.assemble(fem.Structure(X, groups, (fem.Support(0), fem.Support([4], ("y", "z")))))
    free = fem.assemble(fem.Structure(X, (group,), (fem.Support(0, ("x",)),)), floating=True)
    assert len(model.dofs.free) == 22
    for direction in range(3):
        q = (free.dofs.free[:, 1] == direction).astype(float)
        mass = STEEL.rho * SLENDER.A * (3.0 if direction else 0.0)
        assert direction == 0 or q @ free.mass.at(NONE) @ q == pytest.approx(mass, rel=1e-12)


def test_bending_and_twist_are_coupled_by_the_shear_centre() -> None:
    # Fork supports: sin(pi x / L) in w and theta; w_c = w - y_s theta of the centroid.
    e, L = 0.07, 3.0
    section = replace(SLENDER, J=1e-8, shear_centre=(e, 0.0))
    X, _, group = span(L, 32, section=section)
    held = (fem.Support([0, 32], ("y", "z", "rx")), fem.Support(0, ("x",)))
    model = fem.assemble(fem.Structure(X, (group,), held))
    # Nodes are at the centroid: forks hold its y and z and the twist, so the shear centre too.
    k = np.pi / L
    A, polar = section.A, section.I_y + section.I_z
    K = np.diag([STEEL.E * section.I_y * k**4, STEEL.G * section.J * k**2])
    rotary = section.I_y * k**2
    M = STEEL.rho * np.array([[A + rotary, -A * e], [-A * e, polar + A * e**2]])
    coupled = np.sqrt(linalg.eigh(K, M, eigvals_only=True))
    alone = np.sqrt(STEEL.E * section.I_z * k**4 / STEEL.rho / (A + section.I_z * k**2))
    assert coupled[0] < 0.95 * np.sqrt(K[1, 1] / M[1, 1])  # far from the twist alone
    found = frequencies(model, 12)
    for each in (*coupled, alone):
        assert np.abs(found / each - 1).min() < 1e-3


@pytest.mark.parametrize("kind", ["bar", "beam", "twist"])
def test_axial_motion_and_twist_converge_with_the_fourth_power(kind: str) -> None:
    # The third mode of a clamped and free bar: omega = 5 pi / 2 c / L.
    errors = []
    for count in (4, 8, 16):
        X, cells, group = span(2.0, count)
        free = "rx" if kind == "twist" else "x"
        held = [fem.Support(0, (free,))]
        held += [fem.Support(np.arange(count + 1), tuple(d for d in fem.ALL if d != free))]
        bars = fem.Trusses("bar", cells, STEEL, SLENDER.A)
        model = fem.assemble(fem.Structure(X, (bars if kind == "bar" else group,), held))
        speed = STEEL.E / STEEL.rho
        if kind == "twist":
            speed = STEEL.G * SLENDER.J / STEEL.rho / (SLENDER.I_y + SLENDER.I_z)
        theory = 2.5 * np.pi * np.sqrt(speed) / 2.0
        errors.append(frequencies(model, 3)[2] / theory - 1)
    assert rate(errors) == pytest.approx([4.0, 4.0], abs=0.4)


# --- bars -------------------------------------------------------------------------------------


def test_bars_carry_axial_forces_only() -> None:
    X = np.array([[0, 0, 0], [2.0, 0, 0], [0, 1.0, 0], [1.0, 1.0, 2.0], [0.5, 0.3, 1.5]])
    cells = np.array([[0, 4], [1, 4], [2, 4], [3, 4]])
    bars = fem.Trusses("t", cells, STEEL, 1e-3)
    model = fem.assemble(fem.Structure(X, (bars,), (fem.Support([0, 1, 2, 3]),)))
    along = X[4] - X[:4]
    L = np.linalg.norm(along, axis=1)[:, None]
    K = (along / L).T @ (STEEL.E * 1e-3 / L * along / L)
    assert len(model.dofs.free) == 3
    assert stiffness(model) == pytest.approx(K, rel=1e-12)
    M = np.eye(3) * STEEL.rho * 1e-3 * L.sum() / 3
    M += (along / L).T @ (STEEL.rho * 1e-3 * L / 12 * along / L)
    assert model.mass.at(NONE).toarray() == pytest.approx(M, rel=1e-12)


def string(count: int, tension: float) -> fem.Structure:
    """A string of bars from wall to wall, held in z."""
    X, cells = fem.grids.line(np.zeros(3), np.array([2.0, 0, 0]), count)
    held = (fem.Support([0, count]), fem.Support(np.arange(count + 1), ("z",)))
    parameters = (fem.Parameter("tension", "prestress", ("cable",)),) if tension else ()
    group = fem.Trusses("cable", cells, STEEL, 1e-4, force=tension)
    return fem.Structure(X, (group,), held, parameters=parameters)


def test_string_under_tension() -> None:
    count, tension = 12, 5e3
    model = fem.assemble(string(count, tension))
    j, h, m = np.arange(1, 5), 2.0 / count, STEEL.rho * 1e-4
    wave = np.cos(j * np.pi / count)
    exact = np.sqrt(6 * tension / (m * h**2) * (1 - wave) / (2 + wave))  # of these elements
    assert frequencies(model, 4) == pytest.approx(exact, rel=1e-9)
    assert exact == pytest.approx(j * np.pi / 2.0 * np.sqrt(tension / m), rel=0.06)
    K = [model.stiffness.at(np.array([theta])) for theta in (1.0, 4.0)]
    lateral = model.dofs.free[:, 1] == 1
    ratio = K[1].toarray()[np.ix_(lateral, lateral)] - 4 * K[0].toarray()[np.ix_(lateral, lateral)]
    assert abs(ratio).max() < 1e-9 * abs(K[0]).max()


def test_a_string_needs_tension() -> None:
    with pytest.raises(InputError, match=r"mechanism.* can move freely in y \(11 independent"):
        fem.assemble(string(12, 0.0))


# --- prestress --------------------------------------------------------------------------------


def column(
    load: fem.Load, count: int = 8, ends: str = "hinged", **options: object
) -> fem.Structure:
    """A column along x, fixed at its foot or hinged at both ends, that bends in x-y."""
    X, _, group = span(3.0, count, **options)
    foot = fem.ALL if ends == "fixed" else ("x", "y", "z", "rx")
    held = [fem.Support(0, foot), fem.Support(np.arange(count + 1), ("z", "rx", "ry"))]
    held += [fem.Support(count, ("y",))] if ends == "hinged" else []
    parameters = (fem.Parameter("P", "prestress", (load.name,)),)
    return fem.Structure(X, (group,), held, loads=(load,), parameters=parameters)


def critical(model: fem.StructureMatrices) -> float:
    """The least factor on the load at which K is singular."""
    K, with_load = (model.stiffness.at(np.array([theta])).tocsc() for theta in (0.0, 1.0))
    (least,) = eigsh(K - with_load, 1, K, which="LA", return_eigenvectors=False)
    return float(1 / least)


EULER = np.pi**2 * STEEL.E * SLENDER.I_z / 9.0


def test_column_loses_its_stiffness_up_to_the_load_of_euler() -> None:
    P = 0.25 * EULER
    model = fem.assemble(column(fem.Load("P", [8], (-P, 0, 0))))
    w = []
    for theta in (0.0, 1.0, 2.0, 3.96, -4.0):
        K, M = stiffness(model, np.array([theta])), model.mass.at(np.ones(1)).toarray()
        w.append(np.sqrt(linalg.eigh(K, M, eigvals_only=True, subset_by_index=[0, 0])[0]))
    expected = 1 - 0.25 * np.array([0.0, 1.0, 2.0, 3.96, -4.0])
    assert (np.array(w) / w[0]) ** 2 == pytest.approx(expected, rel=1e-4, abs=1e-4)
    assert critical(model) == pytest.approx(4.0, rel=1e-4)


def test_shear_lowers_the_critical_load() -> None:
    # F. Engesser, 1891: 1 / P = 1 / P_E + 1 / (kappa G A).
    section = replace(SLENDER, kappa_y=1e-3)
    rigidity = 1e-3 * STEEL.G * SLENDER.A
    model = fem.assemble(column(fem.Load("P", [32], (-1.0, 0, 0)), 32, section=section))
    assert critical(model) == pytest.approx(1 / (1 / EULER + 1 / rigidity), rel=1e-3)


def test_column_under_its_own_weight() -> None:
    # A. G. Greenhill, 1881: q L^3 = 7.8373 EI.
    weight = STEEL.rho * SLENDER.A
    load = fem.Load("weight", acceleration=(-1.0, 0, 0))
    model = fem.assemble(column(load, 16, "fixed"))
    g = 7.8373 * STEEL.E * SLENDER.I_z / 3.0**3 / weight
    assert critical(model) == pytest.approx(g, rel=2e-3)


def test_heated_column_between_walls() -> None:
    heated = 0.5 * np.pi**2 * SLENDER.I_z / SLENDER.A / 9.0
    structure = column(fem.Load("heat", strains={"beam": heated}))
    walls = (*structure.supports, fem.Support(8, ("x",)))
    model = fem.assemble(replace(structure, supports=walls))
    assert critical(model) == pytest.approx(2.0, rel=1e-4)
    # Free to expand, there is no force.
    free = fem.assemble(structure)
    change = stiffness(free, np.array([1.0])) - stiffness(free, np.array([0.0]))
    assert abs(change).max() < 1e-9 * abs(stiffness(free, np.array([0.0]))).max()


def hinged_plate(load: fem.Load, n: int = 12, held: tuple[fem.Support, ...] = ()) -> fem.Structure:
    """A square plate of side 2 with hinged edges, of offset shells, that may move in its plane."""
    X, cells = fem.grids.plate(2.0, 2.0, n, n)
    on = np.isclose(X[:, :2], 0) | np.isclose(X[:, :2], 2.0)
    supports = [
        fem.Support(np.flatnonzero(on.any(1)), ("z",)),
        fem.Support(np.flatnonzero(X[:, 0] == 0), ("x",)),
        fem.Support(np.flatnonzero(X[:, 1] == 0), ("y",)),
        *held,
    ]
    group = fem.Shells("plate", cells, STEEL, 0.01)
    parameters = (fem.Parameter("N", "prestress", (load.name,)),)
    return fem.Structure(X, (group,), supports, loads=(load,), parameters=parameters)


D = STEEL.E * 0.01**3 / 12 / (1 - STEEL.nu**2)


def edge_forces(n: int, total: float) -> list[fem.Load]:
    """Forces along x at the edge x = 2 of the plate, uniform."""
    edge = np.arange(n * (n + 1), (n + 1) ** 2)
    inner, ends = total / n, total / n / 2
    return [
        fem.Load("N", edge[1:-1], (inner, 0, 0)),
        fem.Load("ends", edge[[0, -1]], (ends, 0, 0)),
    ]


def test_plate_in_tension_and_compression() -> None:
    # omega^2 = (D pi^4 (m^2 + n^2)^2 / a^4 + N pi^2 m^2 / a^2) / (rho h), a = 2.
    n, N = 16, 0.5 * 4 * np.pi**2 * D / 4
    loads = edge_forces(n, -2.0 * N)
    structure = replace(
        hinged_plate(loads[0], n),
        loads=loads,
        parameters=(fem.Parameter("N", "prestress", ("N", "ends")),),
    )
    model = fem.assemble(structure)
    M = model.mass.at(np.ones(1)).tocsc()
    for theta in (-2.0, 0.0, 1.0):
        K = model.stiffness.at(np.array([theta])).tocsc()
        w2 = np.sort(eigsh(K, 2, M, sigma=0.0, return_eigenvectors=False))
        expected = [
            (D * np.pi**4 * (m**2 + 1) ** 2 / 16 - theta * N * np.pi**2 * m**2 / 4) / 78.5
            for m in (1, 2)
        ]
        expected.append((D * np.pi**4 * 25 / 16 - theta * N * np.pi**2 / 4) / 78.5)
        assert w2 == pytest.approx(np.sort(expected)[:2], rel=0.02)
    assert critical(model) == pytest.approx(2.0, rel=0.01)


@pytest.mark.parametrize("offset", [0.0, 0.02])
def test_heated_plate_between_walls(offset: float) -> None:
    # G. H. Bryan, 1891: N = 2 pi^2 D / a^2 in both directions; N = E h strain / (1 - nu).
    strain = 0.4 * 2 * np.pi**2 * D / 4 * (1 - STEEL.nu) / STEEL.E / 0.01
    factors = []
    for n in (8, 16):
        plate = hinged_plate(fem.Load("heat", strains={"plate": strain}), n)
        X, cells = fem.grids.plate(2.0, 2.0, n, n)
        walls = [fem.Support(np.flatnonzero(X[:, d] == 2.0), ("xy"[d],)) for d in range(2)]
        # The mid-surface is at the first nodes, those of the elements are rigid arms below them.
        structure = replace(
            plate,
            nodes=np.concatenate([X, X - [0, 0, offset]]),
            groups=(fem.Shells("plate", cells + len(X), STEEL, 0.01, offset),),
            links=[fem.Link(k, [k + len(X)]) for k in range(len(X))],
            supports=(*plate.supports, *walls),
        )
        factors.append(critical(fem.assemble(structure)) / 2.5 - 1)
    assert 0 < factors[1] < 0.01
    assert rate(factors)[0] == pytest.approx(2.0, abs=0.2)


def test_column_of_bricks_buckles_at_the_load_of_euler() -> None:
    X, bricks = fem.grids.box((4.0, 0.2, 0.1), (8, 1, 1))
    X, bricks = fem.grids.quadratic_bricks(X, bricks)
    top = np.flatnonzero(X[:, 0] == 4.0)
    weight = np.where(np.isclose(X[top, 1:], [0.1, 0.05]).any(1), 1 / 3, -1 / 12)  # of a face
    loads = [
        fem.Load(f"P{k}", top[weight == w], (-w, 0, 0)) for k, w in enumerate(np.unique(weight))
    ]
    held = (fem.Support(np.flatnonzero(X[:, 0] == 0)),)
    names = tuple(load.name for load in loads)
    model = fem.assemble(
        fem.Structure(
            X,
            (fem.Solids("column", bricks, replace(STEEL, nu=0.0)),),
            held,
            loads=loads,
            parameters=(fem.Parameter("P", "prestress", names),),
        )
    )
    euler = np.pi**2 * STEEL.E * 0.2 * 0.1**3 / 12 / 4 / 4.0**2
    assert critical(model) == pytest.approx(euler, rel=0.01)


def test_a_given_force_is_that_of_a_load() -> None:
    P = 0.5 * EULER
    loaded = column(fem.Load("P", [8], (-P, 0, 0)))
    given = replace(
        loaded,
        loads=(),
        groups=(span(force=-P)[2],),
        parameters=(fem.Parameter("P", "prestress", ("beam",)),),
    )
    for theta in (np.array([1.0]), np.array([-0.3])):
        expected = stiffness(fem.assemble(loaded), theta)
        assert stiffness(fem.assemble(given), theta) == pytest.approx(
            expected, abs=1e-9 * abs(expected).max()
        )


def test_loads_that_buckle_the_structure_are_refused() -> None:
    with pytest.raises(InputError, match="below the critical ones"):
        fem.assemble(column(fem.Load("P", [8], (-1.1 * EULER, 0, 0))))
    loaded = column(fem.Load("P", [8], (-1.0, 0, 0)))
    given = replace(loaded, groups=(span(force=-1.1 * EULER)[2],), loads=(), parameters=())
    with pytest.raises(InputError, match="below the critical ones"):
        fem.assemble(given)


def test_a_load_is_carried_by_links_and_couplings() -> None:
    # The same column with the force on a node that only a coupling and a link carry.
    structure = column(fem.Load("P", [10], (-EULER / 2, 0, 0)))
    X = np.concatenate([np.asarray(structure.nodes), [[3.0, 0, 0], [3.5, 0, 0]]])
    links = (fem.Link(8, [9]), fem.Link(9, [10], ("x", "y", "z")))
    model = fem.assemble(replace(structure, nodes=X, links=links))
    assert critical(model) == pytest.approx(2.0, rel=1e-4)


# --- springs and masses -----------------------------------------------------------------------


def test_rigid_body_on_six_springs_in_axes_of_their_own() -> None:
    Q = rotation(np.random.default_rng(5))
    k = np.array([1e4, 3e4, 7e4, 40.0, 90.0, 20.0])
    m, inertia = 8.0, np.array([0.3, 0.5, 0.9])
    X = np.array([[0.2, 0.1, 0.3]])
    spring = fem.Spring("mount", [0], k.tolist(), axes=(Q[0].tolist(), Q[1].tolist()))
    mass = fem.Mass("body", [0], m, Q.T @ np.diag(inertia) @ Q)
    model = fem.assemble(fem.Structure(X, springs=(spring,), masses=(mass,)))
    theory = np.sort(np.sqrt(k / np.repeat([1.0, 1.0], 3) / [m, m, m, *inertia]))
    assert frequencies(model, 6) == pytest.approx(theory, rel=1e-9)


def test_six_springs_between_distant_nodes_resist_no_rigid_motion() -> None:
    rng = np.random.default_rng(6)
    Q, X = rotation(rng), rng.normal(size=(2, 3))
    k = rng.uniform(1, 9, 6)
    spring = fem.Spring("s", [0], k.tolist(), to=[1], axes=(Q[0].tolist(), Q[1].tolist()))
    masses = [fem.Mass(f"m{n}", [n], 1.0, (1.0, 1.0, 1.0)) for n in range(2)]
    model = fem.assemble(fem.Structure(X, springs=(spring,), masses=masses), floating=True)
    K = stiffness(model)
    assert np.sum(np.abs(linalg.eigvalsh(K)) < 1e-9) == 6
    # Held at one end, the other one yields as if the springs were at the middle.
    A = np.eye(6)
    A[:3, 3:] = np.cross(np.eye(3), (X[0] - X[1]) / 2).T
    A = linalg.block_diag(Q, Q) @ A
    assert K[6:, 6:] == pytest.approx(A.T @ np.diag(k) @ A, rel=1e-9, abs=1e-9)


def test_masses_that_differ_by_direction() -> None:
    X, _, group = span()
    pile = fem.Mass("water", [4], (0.0, 20.0, 5.0), offset=(0, 0, 0.1))
    model = fem.assemble(fem.Structure(X, (group,), (fem.Support(0),), masses=(pile,)))
    bare = fem.assemble(fem.Structure(X, (group,), (fem.Support(0),)))
    added = (model.mass.at(NONE) - bare.mass.at(NONE)).toarray()
    at = np.flatnonzero(model.dofs.free[:, 0] == 4)
    expected = np.diag([0, 20.0, 5.0, 20 * 0.01, 0, 0])
    expected[1, 3] = expected[3, 1] = -20 * 0.1
    assert added[np.ix_(at, at)] == pytest.approx(expected, abs=1e-12)


# --- couplings and supports -------------------------------------------------------------------

RIM, QUADS = fem.grids.plate(1.0, 0.6, 5, 4)
PLATE = fem.Shells("plate", QUADS, STEEL, 0.01)
FOOT = fem.Support(np.flatnonzero(RIM[:, 0] == 0))
EDGE = np.flatnonzero(RIM[:, 0] == 1.0)


def coupled(weights: Floats, directions: tuple[str, ...] = fem.ALL) -> fem.Structure:
    """A plate with a node off its edge that has the mean motion of the edge."""
    X = np.concatenate([RIM, [[1.3, 0.2, 0.1]]])
    edge = np.concatenate([EDGE, [12]])
    coupling = fem.Coupling(len(RIM), edge, weights, directions)
    return fem.Structure(X, (PLATE,), (FOOT,), couplings=(coupling,))


def test_a_coupling_distributes_forces_by_statics() -> None:
    rng = np.random.default_rng(7)
    structure = coupled(rng.uniform(0.5, 2.0, 6))
    model = fem.assemble(structure)
    X = np.asarray(structure.nodes)
    f = np.zeros((len(X), 6))
    f[-1] = rng.normal(size=6)
    at = np.zeros_like(f)
    at[*model.dofs.free.T] = model.dofs.T.T @ f.ravel()
    assert at[:, :3].sum(0) == pytest.approx(f[-1, :3])
    assert np.cross(X - X[-1], at[:, :3]).sum(0) == pytest.approx(f[-1, 3:])
    assert abs(at[:, 3:]).max() == 0
    # A force at the weighted centroid is shared by the weights.
    w = np.asarray(structure.couplings[0].weights)
    of = np.asarray(structure.couplings[0].of)
    centre = replace(structure, nodes=np.concatenate([RIM, [w @ X[of] / w.sum()]]))
    T = fem.assemble(centre).dofs.T
    assert (T[6 * len(RIM)].toarray()[T[6 * of].toarray().argmax(1)]) == pytest.approx(w / w.sum())


def test_a_coupling_stiffens_nothing() -> None:
    structure = coupled(np.ones(6))
    mass = (fem.Mass("m", [len(RIM)], 3.0, (0.01, 0.02, 0.03)),)
    plain = fem.assemble(fem.Structure(RIM, (PLATE,), (FOOT,)))
    assert abs(stiffness(fem.assemble(structure)) - stiffness(plain)).max() < 1e-3
    found = fem.assemble(replace(structure, masses=mass))
    linked = replace(structure, couplings=(), links=(fem.Link(len(RIM), [*EDGE, 12]),), masses=mass)
    assert (frequencies(found, 3) < frequencies(fem.assemble(linked), 3)).all()
    assert (frequencies(found, 3) < frequencies(plain, 3)).all()


def test_a_coupling_to_a_line_has_no_rotation_about_it() -> None:
    structure = coupled(np.ones(6))
    line = replace(structure.couplings[0], of=EDGE, weights=1.0)
    with pytest.raises(InputError, match=r"expected nodes .* do not determine x, z, ry of node 30"):
        fem.assemble(replace(structure, couplings=(line,)))
    on_it = np.concatenate([RIM, [[1.0, 0.3, 0.0]]])
    fewer = replace(line, directions=("x", "y", "z", "rx", "rz"))
    model = fem.assemble(replace(structure, nodes=on_it, couplings=(fewer,)))
    assert len(model.dofs.free) == 6 * (len(RIM) - 5)


def test_skew_supports_are_those_of_the_structure_turned() -> None:
    Q = rotation(np.random.default_rng(8))
    X, _, group = span(count=6)
    section = fem.rectangle(0.1, 0.2)
    held = (fem.Support(0, ("x", "y", "z", "rx")), fem.Support([6], ("y", "z")))
    sensors = (fem.Sensor("x", 3, "x"), fem.Sensor("y", 3, "y"), fem.Sensor("end", 6, "x"))
    straight = fem.Structure(X, (replace(group, section=section),), held, sensors=sensors)
    turned = fem.Structure(
        X @ Q,
        (replace(group, section=section, orientation=Q[1].tolist()),),
        [replace(each, axes=(Q[0].tolist(), Q[1].tolist())) for each in held],
        sensors=[
            replace(each, direction=Q["xyz".index(str(each.direction))].tolist())
            for each in sensors
        ],
    )
    models = [fem.assemble(each) for each in (straight, turned)]
    assert frequencies(models[1], 6) == pytest.approx(frequencies(models[0], 6), rel=1e-8)
    assert flexibility(models[1]) == pytest.approx(flexibility(models[0]), rel=1e-7)


def test_oblique_supports_of_one_node_hold_what_both_hold() -> None:
    X = np.array([[0, 0, 0], [1.0, 0, 0]])
    springs = (fem.Spring("s", [1], (3.0, 5.0, 7.0, 0, 0, 0)),)
    masses = (fem.Mass("m", [1], 1.0),)
    rollers = [fem.Support(1, ("x",), axes=((1, 1, 0), Z)), fem.Support(1, ("x",), axes=(Y, Z))]
    both = fem.assemble(fem.Structure(X, (), rollers, springs, masses))
    assert frequencies(both, 1) == pytest.approx(np.sqrt([7.0]))
    # One roller along (1, 1, 0): u = (a, -a, z).
    one = fem.assemble(fem.Structure(X, (), rollers[:1], springs, masses))
    assert frequencies(one, 2) == pytest.approx(np.sqrt([4.0, 7.0]))


# --- orthotropic materials --------------------------------------------------------------------

SPRUCE = fem.Orthotropic(E=(11e9, 0.9e9, 0.5e9), nu=(0.37, 0.42, 0.47), G=(0.7e9, 0.6e9, 0.05e9),
                         rho=450.0)  # fmt: skip


def test_oblique_stiffness_of_orthotropic_material() -> None:
    # S. W. Tsai: 1 / E_x = c^4 / E_1 + s^4 / E_2 + (1 / G_12 - 2 nu_12 / E_1) s^2 c^2.
    angle = np.radians(25.0)
    c, s = np.cos(angle), np.sin(angle)
    R = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    E, nu, G = SPRUCE.E, SPRUCE.nu, SPRUCE.G
    expected = c**4 / E[0] + s**4 / E[1] + (1 / G[0] - 2 * nu[0] / E[0]) * s**2 * c**2
    X, bricks = fem.grids.box((1.0, 0.3, 0.2), (3, 2, 2))
    axes = (R[0].tolist(), R[1].tolist())
    held = (
        fem.Support(np.flatnonzero(X[:, 0] == 0), ("x",)),
        fem.Support(0, ("y", "z")),
        fem.Support(2, ("y",)),
    )
    end = np.flatnonzero(X[:, 0] == 1.0)
    model = fem.assemble(fem.Structure(X, (fem.Solids("w", bricks, SPRUCE, axes),), held))
    area = np.ones(len(end)) / 4  # of bricks at each node, over one brick
    for d, size in ((1, 0.3), (2, 0.2)):
        area[np.isclose(X[end, d], 0) | np.isclose(X[end, d], size)] /= 2
    f = np.zeros((len(X), 6))
    f[end, 0] = 1e3 * area
    # Free to shear and contract: a state of uniform stress.
    q = linalg.solve(stiffness(model), model.dofs.T.T @ f.ravel())
    u = (model.dofs.T @ q).reshape(-1, 6)[end, 0]
    assert u == pytest.approx(1e3 / 0.06 * expected, rel=1e-9)


def spruce_plate(h: float, n: int, axis: Floats, Q: Floats | None = None) -> fem.Structure:
    """A rectangular plate 1.0 by 0.8 with hinged edges, turned by Q; axis 1 along `axis`."""
    X, cells = fem.grids.plate(1.0, 0.8, n, n)
    Q = np.eye(3) if Q is None else Q
    axes = (Q[0].tolist(), Q[1].tolist())
    ends = [
        np.flatnonzero(np.isclose(X[:, d], 0) | np.isclose(X[:, d], s))
        for d, s in ((0, 1.0), (1, 0.8))
    ]
    held = [
        fem.Support(np.arange(len(X)), ("x", "y", "rz"), axes),
        fem.Support(ends[0], ("z", "rx"), axes),
        fem.Support(ends[1], ("z", "ry"), axes),
    ]
    shells = fem.Shells("plate", cells, SPRUCE, h, direction=(axis @ Q).tolist())
    return fem.Structure(X @ Q, (shells,), held)


def navier(h: float, across: bool = False) -> Floats:
    """Closed form of `spruce_plate` with shear (J. N. Reddy, "Mechanics of Laminated Plates")."""
    S = SPRUCE.compliance()[np.ix_([0, 1, 5], [0, 1, 5])]
    D = np.linalg.inv(S) * h**3 / 12
    G_x, G_y = (5 / 6 * h * G for G in SPRUCE.G[1:])
    if across:
        D, (G_x, G_y) = D[np.ix_([1, 0, 2], [1, 0, 2])], (G_y, G_x)
    found = []
    for m in range(1, 5):
        for n in range(1, 5):
            a, b = m * np.pi, n * np.pi / 0.8
            K = np.array([
                [G_x * a**2 + G_y * b**2, G_x * a, G_y * b],
                [G_x * a, D[0, 0] * a**2 + D[2, 2] * b**2 + G_x, (D[0, 1] + D[2, 2]) * a * b],
                [G_y * b, (D[0, 1] + D[2, 2]) * a * b, D[2, 2] * a**2 + D[1, 1] * b**2 + G_y],
            ])  # fmt: skip
            M = SPRUCE.rho * np.diag([h, h**3 / 12, h**3 / 12])
            found.append(linalg.eigh(K, M, eigvals_only=True)[0])
    return np.sqrt(np.sort(found))


@pytest.mark.parametrize(("h", "within"), [(0.002, 0.025), (0.08, 0.02)])
@pytest.mark.parametrize("across", [False, True])
def test_orthotropic_plates(h: float, within: float, across: bool) -> None:
    axis = np.eye(3)[int(across)]
    theory = navier(h, across)[:4]
    w = frequencies(fem.assemble(spruce_plate(h, 16, axis)), 4)
    assert w == pytest.approx(theory, rel=within)


def test_turning_an_orthotropic_plate_changes_no_frequency() -> None:
    axis = np.array([np.cos(0.4), np.sin(0.4), 0.0])
    rest = frequencies(fem.assemble(spruce_plate(0.05, 6, axis)), 4)
    Q = rotation(np.random.default_rng(9))
    turned = frequencies(fem.assemble(spruce_plate(0.05, 6, axis, Q)), 4)
    assert turned == pytest.approx(rest, rel=1e-7)


def test_isotropic_constants_of_an_orthotropic_material_are_the_material() -> None:
    E, nu, G = STEEL.E, STEEL.nu, STEEL.G
    same = fem.Orthotropic((E, E, E), (nu, nu, nu), (G, G, G), STEEL.rho)
    X, cells = fem.grids.plate(1.0, 0.5, 3, 2)
    X[:, 2] = 0.3 * X[:, 0] ** 2 - 0.2 * X[:, 0] * X[:, 1]
    B, bricks = fem.grids.box((1.0, 0.5, 0.5), (2, 1, 1))
    for nodes, group in (
        (X, fem.Shells("g", cells, STEEL, 0.05)),
        (X, fem.Shells("g", fem.grids.triangles(cells), STEEL, 0.05)),
        (B, fem.Solids("g", bricks, STEEL)),
    ):
        where: dict[str, Any] = (
            {"direction": (1.0, 0.4, 0.2)} if isinstance(group, fem.Shells) else {}
        )
        other = replace(group, material=same, **where)
        K = [
            stiffness(fem.assemble(fem.Structure(nodes, (each,), (fem.Support([0, 1, 2]),))))
            for each in (group, other)
        ]
        assert abs(K[1] - K[0]).max() < 1e-12 * abs(K[0]).max()


# --- what is refused --------------------------------------------------------------------------


def refused(structure: fem.Structure) -> str:
    """The message of a structure that is refused."""
    with pytest.raises(InputError) as caught:
        fem.assemble(structure)
    return str(caught.value)


def test_hinges_that_make_a_mechanism_are_found() -> None:
    X, cells, group = span(count=4)
    groups = (
        replace(group, cells=cells[:2]),
        replace(group, cells=cells[2:3], releases=(("rz",), ())),
        replace(group, cells=cells[3:]),
    )
    hinged = fem.Structure(X, groups, (fem.Support(0),))
    assert "can move freely in y, rz (1 independent" in refused(hinged)
    fem.assemble(replace(hinged, supports=(fem.Support(0), fem.Support([4], ("y",)))))
    # A ball joint on a support holds the rest; a hinge without anything behind it is loose.
    loose = replace(group, cells=cells[3:], releases=((), ("ry",)))
    ends = fem.Structure(X, (replace(group, cells=cells[:3]), loose), (fem.Support(0),))
    model = fem.assemble(ends)
    assert len(model.dofs.free) == 23  # its rotation has neither stiffness nor mass


def held(X: Floats, group: fem.Beams) -> fem.StructureMatrices:
    """Beams that are held at their first node."""
    return fem.assemble(fem.Structure(X, (group,), (fem.Support(0),)))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"releases": (("rx",), ("rx",))}, "group 'beam' releases: expected those that leave the"),
        ({"releases": (("w",), ())}, "releases: expected a list for either end, of x, y"),
        ({"offsets": 1.0}, "offsets: expected a vector of 3 numbers for either end, found 1"),
        ({"orientation": (0, 0, 0)}, "orientation: expected a vector of 3 numbers, not all"),
    ],
)
def test_wrong_beams(change: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        held(*span(**change)[::2])


def test_wrong_members() -> None:
    X, cells, group = span()
    sound = fem.Structure(X, (group,), (fem.Support(0),))
    fem.assemble(sound)
    wooden: Any = SPRUCE
    changes: tuple[tuple[dict[str, Any], str], ...] = (
        ({"springs": (fem.Spring("k", [1], (0.0,) * 6),)}, "'k' stiffness: expected 6 stiffnesses"),
        ({"springs": (fem.Spring("k", [1], (1.0,) * 6, "x"),)}, "without a direction"),
        ({"springs": (fem.Spring("k", [1], 1.0, "x", axes=(Y, Z)),)}, "they are for 6"),
        ({"couplings": (fem.Coupling(1, [1, 2]),)}, "coupling 0: expected other nodes than 1"),
        ({"couplings": (fem.Coupling(1, [2, 3], [1.0]),)}, "coupling 0: expected other nodes"),
        ({"loads": (fem.Load("P"),)}, "load 'P': expected forces at nodes"),
        ({"loads": (fem.Load("P", [99], (1, 0, 0)),)}, "load 'P': expected nodes from 0 to 8"),
        ({"loads": (fem.Load("P", strains={"b": 1.0}),)}, "has strains: beam, found 'b'"),
        (
            {"parameters": (fem.Parameter("p", "prestress", ("beam",)),)},
            "has prestress: none has, found 'beam'",
        ),
        (
            {"groups": (fem.Beams("b", cells, wooden, fem.circle(0.1)),)},
            "material: expected an isotropic one",
        ),
    )
    for change, message in changes:
        assert message in refused(replace(sound, **change))
    loaded = replace(sound, supports=(), loads=(fem.Load("P", [8], (1.0, 0, 0)),))
    with pytest.raises(InputError, match="found a floating one"):
        fem.assemble(loaded, floating=True)


def test_orthotropic_shells_need_a_direction() -> None:
    structure = spruce_plate(0.01, 2, np.eye(3)[0])
    (shells,) = structure.groups
    assert isinstance(shells, fem.Shells)
    for direction, message in ((None, "axis 1 of the material is, found n"), (Z, "not normal to")):
        wrong = replace(shells, direction=direction)
        assert message in refused(replace(structure, groups=(wrong,)))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"E": (1.0, 0.0, 1.0)}, "E: expected three values of E above 0"),
        ({"G": (1.0, 1.0)}, "G: expected three values of G above 0"),
        ({"nu": (0.3, 0.3)}, "nu: expected three values of nu"),
        (
            {"nu": (4.0, 0.0, 0.0)},
            "nu: expected ratios that leave the elasticity positive definite",
        ),
    ],
)
def test_orthotropic_constants_out_of_range(change: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        replace(SPRUCE, **change)


def test_a_moment_on_a_bar_is_refused() -> None:
    structure = string(3, 1e3)
    moment = fem.Load("M", [1], (0, 0, 0, 0, 0, 1.0))
    assert "expected what resists rz of node 1" in refused(replace(structure, loads=(moment,)))
