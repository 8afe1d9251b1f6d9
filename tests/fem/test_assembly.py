"""The affine form: its terms against a direct build, its pattern, links, masses, sensors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import sparse
from structures import STEEL, frequencies, move_inner, rigid_motions, rotation

from modefront import fem
from modefront._typing import Floats
from modefront.errors import InputError

positive = st.floats(0.2, 5.0)
NONE = np.zeros(0)
"""Parameters of a structure that has none."""

CONCRETE = fem.Material(E=30e9, nu=0.2, rho=2400.0)


def _frame(theta: Floats, Q: Floats | None = None) -> fem.Structure:
    """Mixed structure whose properties are already scaled by theta."""
    e, d, t, k, m, g = theta
    Q = np.eye(3) if Q is None else Q
    plate, quads = fem.grids.plate(1.0, 0.8, 3, 3)
    plate = move_inner(plate, np.array([1 / 3, 0.8 / 3, 0]), 0.2, 0)
    legs = np.concatenate([plate[[0, 15]] - [0, 0, z] for z in (0.5, 1.0)])
    block, bricks = fem.grids.box((0.4, 0.3, 0.2), (2, 1, 1))
    block = block + np.array([0.3, 0.2, 0.5])
    X = np.concatenate([plate, legs, block]) @ Q.T
    steel = replace(STEEL, E=STEEL.E * e, rho=STEEL.rho * d)
    concrete = replace(CONCRETE, E=CONCRETE.E * e * g)
    base = 20 + np.arange(12)
    return fem.Structure(
        nodes=X,
        groups=(
            fem.Shells("deck", quads[:5], steel, 0.02 * t),
            fem.Shells("deck", fem.grids.triangles(quads[5:]), steel, 0.02 * t, offset=0.03),
            fem.Beams("legs", np.array([[0, 16], [16, 18], [15, 17], [17, 19]]), STEEL,
                      fem.rectangle(0.05, 0.03), orientation=Q[:, 0].tolist()),
            fem.Solids("block", bricks + 20, concrete),
        ),
        supports=(fem.Support([18, 19]),),
        springs=(
            fem.Spring("stay", [5], 1e6 * k, Q[:, 1].tolist()),
            fem.Spring("tie", [16], 2e6 * k, to=[17]),
        ),
        masses=(fem.Mass("lead", [10], 9.5 * m, inertia=(0.1 * m,) * 3, offset=Q[:, 2] * 0.1),),
        links=(fem.Link(6, base[np.arange(0, 12, 2)]),),
        sensors=(
            fem.Sensor("a", 10, Q[:, 0].tolist()),
            fem.Sensor("b", (Q @ plate[12]).tolist(), (-Q[:, 2]).tolist()),
            fem.Sensor("c", int(base[0]), Q[:, 2].tolist()),
        ),
    )  # fmt: skip


PARAMETERS = (
    fem.Parameter("e", "E", ("deck", "block")),
    fem.Parameter("d", "density", ("deck",)),
    fem.Parameter("t", "thickness", ("deck",)),
    fem.Parameter("k", "spring", ("stay", "tie")),
    fem.Parameter("m", "mass", ("lead",)),
    fem.Parameter("g", "E", ("block",)),
)


@settings(max_examples=5, deadline=None)
@given(st.tuples(*[positive] * 6))
def test_affine_form_is_the_direct_build(values: tuple[float, ...]) -> None:
    theta = np.array(values)
    theta[2] = 1.0  # shells of another thickness have another share of shear
    affine = fem.assemble(replace(_frame(np.ones(6)), parameters=PARAMETERS))
    direct = fem.assemble(_frame(theta))
    for result, expected in (
        (affine.stiffness.at(theta), direct.stiffness.at(NONE)),
        (affine.mass.at(theta), direct.mass.at(NONE)),
    ):
        assert abs(result - expected).max() < 1e-11 * abs(expected).max()


@pytest.mark.parametrize("triangles", [False, True])
@pytest.mark.parametrize(
    ("thickness", "factor", "rel"),
    [(0.01, 1.1, 1e-4), (0.01, 2.0, 2e-3), (0.03, 0.9, 3e-4), (0.03, 1.1, 3e-4), (0.03, 0.5, 5e-3)],
)
def test_another_thickness_is_nearly_the_direct_build(
    thickness: float, factor: float, rel: float, triangles: bool
) -> None:
    X, cells = fem.grids.plate(1.0, 1.0, 8, 8)
    cells = fem.grids.triangles(cells) if triangles else cells
    held = (fem.Support(np.flatnonzero(X[:, 0] == 0)),)

    def model(thickness: float) -> fem.StructureMatrices:
        shells = (fem.Shells("p", cells, STEEL, thickness),)
        return fem.assemble(fem.Structure(X, shells, held, parameters=(scaled,)))

    scaled = fem.Parameter("t", "thickness", ("p",))
    affine, theta = model(thickness), np.array([factor])
    K, M = affine.stiffness.at(theta), affine.mass.at(theta)
    w = np.sqrt(sparse.linalg.eigsh(K, 4, M, sigma=0.0, return_eigenvectors=False))
    assert np.sort(w) == pytest.approx(frequencies(model(thickness * factor), 4), rel=rel)


def test_terms_are_merged_and_the_constant_comes_first() -> None:
    model = fem.assemble(replace(_frame(np.ones(6)), parameters=PARAMETERS))
    assert model.stiffness.coefficients.exponents.tolist() == [
        [0, 0, 0, 0, 0, 0],
        *([1, 0, power, 0, 0, 0] for power in (5, 4, 3, 2, 1)),
        [1, 0, 0, 0, 0, 1],
        [0, 0, 0, 1, 0, 0],
    ]
    assert model.mass.coefficients.exponents.tolist() == [
        [0, 0, 0, 0, 0, 0],
        [0, 1, 3, 0, 0, 0],
        [0, 1, 1, 0, 0, 0],
        [0, 0, 0, 0, 1, 0],
    ]
    assert model.parameters == ("e", "d", "t", "k", "m", "g")


def test_pattern_and_matrices_are_symmetric_to_the_last_digit() -> None:
    model = fem.assemble(replace(_frame(np.ones(6)), parameters=PARAMETERS))
    for matrix in (model.stiffness, model.mass):
        n = matrix.size
        for term in matrix.terms.toarray().T:
            A = sparse.csr_array((term, matrix.indices, matrix.indptr), shape=(n, n))
            assert A.has_canonical_format
            assert abs(A - A.T).max() == 0
        pattern = sparse.csr_array(
            (np.ones(len(matrix.indices)), matrix.indices, matrix.indptr)
        ).toarray()
        assert np.array_equal(pattern, pattern.T)
    assert np.all(model.stiffness.at(np.ones(6)).diagonal() > 0)


def test_turning_the_structure_changes_no_frequency_and_no_sensor() -> None:
    unit = np.ones(6)
    rest = fem.assemble(_frame(unit))
    turned = fem.assemble(_frame(unit, rotation(np.random.default_rng(2))))
    w, w_turned = frequencies(rest, 8), frequencies(turned, 8)
    assert w_turned == pytest.approx(w, rel=1e-8)
    flexibility = [
        m.selection @ sparse.linalg.spsolve(m.stiffness.at(NONE).tocsc(), m.selection.T.toarray())
        for m in (rest, turned)
    ]
    assert flexibility[1] == pytest.approx(flexibility[0], rel=1e-7)


def test_total_mass_is_exact_with_links_and_offsets() -> None:
    structure = replace(_frame(np.ones(6)), supports=(), springs=())
    model = fem.assemble(structure, floating=True)
    X = np.asarray(structure.nodes)
    q = rigid_motions(X, 6).reshape(len(X), 6, 6)[*model.dofs.free.T]
    result = np.diag(q.T @ model.mass.at(NONE) @ q)[:3]
    deck, legs, block = 0.8 * 0.02 * 7850, 2 * 0.05 * 0.03 * 7850, 0.4 * 0.3 * 0.2 * 2400
    assert result == pytest.approx(deck + legs + block + 9.5, rel=1e-12)
    K = model.stiffness.at(NONE)
    assert np.abs(K @ q).max() < 1e-12 * abs(K).max()


def test_link_is_the_exact_transformation() -> None:
    X = np.array([[0, 0, 0], [1.0, 0, 0], [1.2, 0.3, 0.4], [2.0, 0.3, 0.4]])
    section = fem.circle(0.1)
    group = (fem.Beams("b", np.array([[0, 1], [2, 3]]), STEEL, section),)
    ground = (fem.Support(0),)
    linked = fem.assemble(fem.Structure(X, group, ground, links=(fem.Link(1, [2]),)))
    whole = fem.assemble(
        fem.Structure(X, group, springs=tuple(
            fem.Spring(f"{d}{n}", [n], 1.0, d) for d in fem.ALL for n in (0, 2)
        ))
    )  # fmt: skip
    springs = np.zeros((4, 6))
    springs[[0, 2]] = 1
    K = whole.stiffness.at(NONE).toarray() - np.diag(springs.ravel())
    T = linked.dofs.T.toarray()
    assert linked.stiffness.at(NONE).toarray() == pytest.approx(T.T @ K @ T, rel=1e-9, abs=1e-6)
    # The same beam with its end moved rigidly is an offset.
    offsets = ((0, 0, 0), (0, 0, 0)), (X[2] - X[1], (0, 0, 0))
    beams = tuple(
        fem.Beams("b", np.array([cell]), STEEL, section, offsets=r)
        for cell, r in zip(((0, 1), (1, 2)), offsets, strict=True)
    )
    offset = fem.assemble(fem.Structure(X[[0, 1, 3]], beams, ground))
    assert frequencies(offset, 6) == pytest.approx(frequencies(linked, 6), rel=1e-8)


def test_a_link_of_a_master_to_itself_is_none() -> None:
    X, cells = fem.grids.line(np.zeros(3), np.array([1.0, 0, 0]), 2)
    beam = (fem.Beams("beam", cells, STEEL, fem.circle(0.1)),)
    plain = fem.Structure(X, beam, (fem.Support(0),))
    K, linked = (
        fem.assemble(each).stiffness.at(NONE).toarray()
        for each in (plain, replace(plain, links=(fem.Link(1, [1]),)))
    )
    assert np.array_equal(K, linked)


def test_partial_link_leaves_the_other_directions_free() -> None:
    X = np.array([[0, 0, 0], [0, 0, 1.0], [1.0, 0, 0], [1.0, 0, 1.0]])
    group = (fem.Beams("c", np.array([[0, 1], [2, 3]]), STEEL, fem.circle(0.1)),)
    link = fem.Link(1, [3], ("x", "y", "rz"))
    model = fem.assemble(fem.Structure(X, group, (fem.Support([0, 2]),), links=(link,)))
    assert len(model.dofs.free) == 9
    q = np.zeros(9)
    turn = model.dofs.free.tolist().index([1, fem.DIRECTIONS.index("rz")])
    q[turn] = 1
    u = (model.dofs.T @ q).reshape(4, 6)
    assert u[3].tolist() == [0, 1, 0, 0, 0, 1]


def test_mass_with_offset_is_a_mass_on_a_rigid_arm() -> None:
    X = np.array([[0, 0, 0], [1.0, 0, 0], [1.1, 0.2, 0.3]])
    beam = (fem.Beams("b", np.array([[0, 1]]), STEEL, fem.circle(0.05)),)
    ground, inertia = (fem.Support(0),), (0.1, 0.2, 0.3)
    offset = fem.Mass("m", [1], 5.0, inertia, offset=X[2] - X[1])
    arm = fem.Mass("m", [2], 5.0, inertia)
    assembled = fem.assemble(fem.Structure(X, beam, ground, masses=(offset,)))
    two = fem.assemble(fem.Structure(X, beam, ground, masses=(arm,), links=(fem.Link(1, [2]),)))
    assert assembled.mass.at(NONE).toarray() == pytest.approx(
        two.mass.at(NONE).toarray(), rel=1e-12
    )


def test_springs_and_masses_make_the_chain() -> None:
    k, m, n = 1000.0, 2.0, 5
    X = np.zeros((n + 1, 3))
    X[:, 2] = np.arange(n + 1)
    springs = (fem.Spring("k", np.arange(n), k, "x", to=np.arange(1, n + 1)),)
    with pytest.raises(InputError, match="along their line"):
        fem.assemble(fem.Structure(X, springs=springs))
    springs = (fem.Spring("k", np.arange(n), k, to=np.arange(1, n + 1)),)
    masses = (fem.Mass("m", np.arange(1, n + 1), m),)
    supports = (
        fem.Support(0),
        fem.Support(np.arange(n + 1), ("x", "y")),
    )
    model = fem.assemble(fem.Structure(X, (), supports, springs, masses))
    j = np.arange(1, n + 1)
    theory = 2 * np.sqrt(k / m) * np.sin((2 * j - 1) * np.pi / (2 * (2 * n + 1)))
    assert frequencies(model, n) == pytest.approx(theory, rel=1e-9)


def test_eccentric_shell_is_the_strip_beside_its_nodes() -> None:
    # A clamped strip bends about its own middle, wherever its nodes are.
    X, cells = fem.grids.plate(1.0, 0.1, 10, 1)
    root = (fem.Support(np.flatnonzero(X[:, 0] == 0)),)
    material = replace(STEEL, nu=0.0)
    w = [
        frequencies(
            fem.assemble(fem.Structure(X, (fem.Shells("s", cells, material, 0.01, e),), root)), 3
        )
        for e in (0.0, 0.02)
    ]
    assert w[1][0] == pytest.approx(w[0][0], rel=2e-3)


@pytest.mark.slow(3)
def test_50000_dofs_have_a_term_for_each_power_of_the_thickness() -> None:
    X, cells = fem.grids.plate(1.0, 1.0, 91, 90)
    structure = fem.Structure(
        X,
        (fem.Shells("p", cells, STEEL, 0.01),),
        (fem.Support(np.flatnonzero(X[:, 0] == 0)),),
        parameters=(fem.Parameter("t", "thickness", ("p",)),),
    )
    model = fem.assemble(structure)
    assert len(model.dofs.free) == 49_686
    assert model.stiffness.coefficients.exponents.tolist() == [[5], [4], [3], [2], [1]]
