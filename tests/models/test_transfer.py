"""Models in their load cases: dense, sparse and meshed ones, massless and rigid-body motion."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse

from modefront import fem
from modefront._typing import Floats
from modefront.errors import ModelError
from modefront.models.base import LoadCase, Transfer
from modefront.models.matrices import MatrixModel, SensorSpec, affine, matrices, select
from modefront.models.mesh import mesh_model
from modefront.predictions.peak_response import derivatives
from modefront.predictions.system import ModalSystem, modes_reaching
from modefront.work.task import Costs

N = 60
PLACES: dict[str, SensorSpec] = {"low": 3, "pair": [(40, 0.5), (41, 0.5)]}
OUTPUTS: dict[str, SensorSpec] = {"top": N - 1, "massless": 20}
SHAKEN = LoadCase(({"top": 1.0}, {"top": 1.0, "low": -1.0}, {"massless": 2.0}), base="x")
PUSHED = LoadCase(SHAKEN.outputs, ({"top": 1.0}, {"pair": 3.0, "massless": -1.0}))
THETA = np.array([1.3])


def response(system: ModalSystem, omega: float) -> np.ndarray:
    """Return the receptance (1, outputs, inputs) at a circular frequency."""
    return derivatives(system, np.array([omega + 0j]), "receptance")[0]


def spring_chain(*, grounded: bool = True, dense: bool) -> MatrixModel:
    """Return a chain with massless degrees of freedom, as dense or as sparse matrices."""
    k = 1000.0 * (1 + 0.3 * np.cos(np.arange(N)))
    k[0] *= grounded
    K = np.diag(k) + np.diag(np.append(k[1:], 0.0)) - np.diag(k[1:], 1) - np.diag(k[1:], -1)
    m = 1 + 0.2 * np.sin(np.arange(N))
    m[20:25] = 0.0
    stiffness = affine(["k"], {"k": scipy.sparse.csr_array(K)}, N)
    mass = affine(["k"], {"base": scipy.sparse.csr_array(np.diag(m))}, N)
    return MatrixModel(
        ("k",),
        tuple(PLACES),
        select(PLACES, N),
        stiffness.dense() if dense else stiffness,
        mass.dense() if dense else mass,
        dict(zip(OUTPUTS, select(OUTPUTS, N).toarray(), strict=True)),
        {"x": np.ones(N)},
    )


def products(result: Transfer) -> Floats:
    """Return the products of modal loads and shapes, which no sign changes: (o, i, modes)."""
    out: Floats = np.einsum("om,mi->oim", result.output, result.input)
    return out


def agree(first: Transfer, other: Transfer) -> None:
    assert first.modes.lam == pytest.approx(other.modes.lam, rel=1e-9, abs=1e-9)
    scale = np.abs(products(other)).max()
    assert products(first) == pytest.approx(products(other), abs=1e-9 * scale)
    assert (first.static is None) == (other.static is None)
    if first.static is not None and other.static is not None:
        assert first.static == pytest.approx(other.static, rel=1e-9)
    if first.rigid is not None and other.rigid is not None:
        assert first.rigid == pytest.approx(other.rigid, rel=1e-12)


@pytest.mark.parametrize("load_case", [SHAKEN, PUSHED], ids=["base", "forces"])
@pytest.mark.parametrize("grounded", [True, False])
def test_sparse_and_dense_models_agree(load_case: LoadCase, grounded: bool, costs: Costs) -> None:
    dense = spring_chain(grounded=grounded, dense=True)
    sparse = spring_chain(grounded=grounded, dense=False)
    transfer = dense.transfer(THETA, 6, load_case)
    assert costs.eigenproblems == 1
    other = sparse.transfer(THETA, 6, load_case)
    assert costs.eigenproblems == 2
    agree(transfer, other)
    assert (transfer.static is None) == (not grounded)
    if not grounded:
        assert transfer.modes.lam[0] == other.modes.lam[0] == 0


@pytest.mark.parametrize("dense", [True, False])
def test_few_modes_and_the_static_response_are_the_direct_solution(dense: bool) -> None:
    """Massless degrees of freedom have no part in any mode: only the correction has theirs."""
    model = spring_chain(dense=dense)
    parts = model.stiffness.at(THETA), model.mass.at(THETA)
    K, M = (scipy.sparse.csr_array(A).toarray() for A in parts)
    columns = [1.0 * np.eye(N)[N - 1], 1.5 * (np.eye(N)[40] + np.eye(N)[41]) - np.eye(N)[20]]
    rows = np.array([np.eye(N)[N - 1], np.eye(N)[N - 1] - np.eye(N)[3], 2 * np.eye(N)[20]])
    result = model.transfer(THETA, 12, PUSHED)
    assert result.static == pytest.approx(rows @ np.linalg.solve(K, np.array(columns).T), rel=1e-9)
    omega = np.sqrt(result.modes.lam)
    system = ModalSystem(omega, np.full(12, 1e-6), result.input, result.output, result.static)
    w = 0.5 * (omega[0] + omega[1])
    exact = rows @ np.linalg.solve(K - w**2 * M, np.array(columns).T)
    error = abs(response(system, w)[0].real - exact).max()
    bare = ModalSystem(omega, np.full(12, 1e-6), result.input, result.output)
    # What the correction leaves is smaller by (w / omega_13)^2.
    assert error < 0.02 * abs(response(bare, w)[0].real - exact).max()


def test_rigid_body_motion_is_that_of_newtons_law() -> None:
    """Far below its first elastic mode, a free structure is one mass."""
    model = spring_chain(grounded=False, dense=True)
    result = model.transfer(THETA, N - 5, PUSHED)
    system = ModalSystem(np.sqrt(result.modes.lam), np.zeros(N - 5), result.input, result.output)
    w = 1e-3 * system.omega[1]
    mass = 1 + 0.2 * np.sin(np.arange(N))
    mass[20:25] = 0.0
    assert response(system, w)[0, 0, 0] == pytest.approx(-1 / (mass.sum() * w**2), rel=1e-4)


def test_a_base_that_moves_everything_moves_the_whole_mass() -> None:
    """The squares of the modal loads of base motion add up to the mass that can move."""
    model = spring_chain(dense=True)
    result = model.transfer(THETA, N - 5, SHAKEN)
    mass = 1 + 0.2 * np.sin(np.arange(N))
    mass[20:25] = 0.0
    assert (result.input**2).sum() == pytest.approx(mass.sum(), rel=1e-10)
    assert result.rigid == pytest.approx(np.array([[1.0], [0.0], [2.0]]))


def cantilever(elements: int) -> MatrixModel:
    X, cells = fem.grids.line(np.zeros(3), np.array([0.0, 0.0, 2.0]), elements)
    steel = fem.Material(E=210e9, nu=0.3, rho=7850.0)
    structure = fem.Structure(
        nodes=X,
        groups=(fem.Beams("mast", cells, steel, fem.rectangle(0.04, 0.03), (1.0, 0.0, 0.0)),),
        supports=(fem.Support(0),),
        masses=(fem.Mass("head", elements, 20.0),),
        links=(fem.Link(elements - 1, [elements]),),
        sensors=(fem.Sensor("top", elements, "x"),),
        parameters=(fem.Parameter("E", "E", ("mast",)),),
    )
    middle = fem.Sensor("middle", elements // 2, "x")
    return mesh_model(structure, ["E"], outputs=[middle])


@pytest.mark.parametrize("elements", [10, 60])
def test_a_mesh_is_what_its_matrices_are(elements: int) -> None:
    mesh = cantilever(elements)
    assert mesh.places == ("top", "middle")
    assert mesh.directions == ("x", "y", "z")
    K, M = (
        scipy.sparse.csr_array(A) for A in (mesh.stiffness.at(np.ones(1)), mesh.mass.at(np.ones(1)))
    )
    rows = {
        "top": mesh.selection.toarray()[0],
        "middle": mesh.outputs["middle"],
        "x": mesh.base["x"],
    }
    spec = {
        name: [(int(dof), float(row[dof])) for dof in np.flatnonzero(row)]
        for name, row in rows.items()
    }
    given = matrices(
        ["E"],
        {"E": K},
        {"base": M},
        {"top": spec["top"]},
        outputs={"middle": spec["middle"]},
        base={"x": spec["x"]},
    )
    outputs = ({"top": 1.0}, {"top": 1.0, "middle": -2.0})
    for load_case in (LoadCase(outputs, base="x"), LoadCase(outputs, ({"middle": 5.0},))):
        first, other = (model.transfer(np.array([1.2]), 5, load_case) for model in (mesh, given))
        assert first.modes.lam == pytest.approx(other.modes.lam, rel=1e-8)
        assert first.static == pytest.approx(other.static, rel=1e-7)
        assert products(first) == pytest.approx(products(other), rel=1e-6, abs=1e-9)


def test_a_base_moves_a_mass_on_an_inclined_support_as_far_as_it_slides() -> None:
    slide = fem.Support(0, ("x",), axes=((1.0, 2.0, 0.0), (0.0, 1.0, 0.0)))
    structure = fem.Structure(
        nodes=np.zeros((1, 3)),
        springs=(fem.Spring("k", 0, 400.0, "x"),),
        masses=(fem.Mass("m", 0, 3.0),),
        supports=(slide, fem.Support(0, ("z", "rx", "ry", "rz"))),
        sensors=(fem.Sensor("u", 0, "x"),),
        parameters=(fem.Parameter("k", "spring", ("k",)),),
    )
    model = mesh_model(structure, ["k"])
    assert model.directions == ("x", "y")
    for direction, along in (("x", 4 / 5), ("y", 1 / 5)):  # squares of (2, -1) / sqrt(5)
        result = model.transfer(np.ones(1), 1, LoadCase(({"u": 1.0},), base=direction))
        assert result.input**2 == pytest.approx(3.0 * along)


def test_static_deflection_of_a_cantilever() -> None:
    """F (3 L x^2 - x^3) / 6EI half-way up; shear adds less than a thousandth."""
    model = cantilever(20)
    result = model.transfer(np.ones(1), 2, LoadCase(({"middle": 1.0},), ({"top": 1.0},)))
    assert result.static is not None
    inertia, F, L, x = 0.04**3 * 0.03 / 12, 1.0, 2.0, 1.0
    bending = F * (3 * L * x**2 - x**3) / (6 * 210e9 * inertia)
    # The link at the top makes the last tenth of a metre rigid, which does not change this.
    assert result.static[0, 0] == pytest.approx(bending, rel=1e-3)


def test_how_many_modes_reach_a_frequency() -> None:
    model = spring_chain(dense=True)
    f = model.modes(THETA, N - 5, derivatives=False).frequency
    for count in (1, 2, 7, 30, N - 5):
        between = f[count - 1] * (1 - 1e-9)
        assert modes_reaching(model, THETA, between, 3) == count
    assert modes_reaching(model, THETA, 2 * f[-1], 3) == N - 5, "all that have a finite frequency"


def test_more_modes_than_there_are() -> None:
    with pytest.raises(ModelError, match="only 55 have a finite frequency"):
        spring_chain(dense=True).transfer(THETA, 56, PUSHED)
