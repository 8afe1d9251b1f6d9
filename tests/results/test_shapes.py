"""Mode shapes at all nodes beside the measured ones, and as a VTU file."""

from __future__ import annotations

from pathlib import Path

import meshio
import numpy as np
import pytest

import modefront as mf
from modefront.results.results import Results


def chain_results() -> Results:
    """Return the results of a chain whose modes are measured in scales of their own."""
    model = mf.chain(["k"], [1.0, 1.0], [300.0, 200.0], stiffness_parameters=["k", None])
    modes = model.modes(np.array([1.0]), 2)
    data = mf.modal_data(
        1.1 * modes.frequency, modes.phi.T * [[2.0], [-30.0]], ("floor1", "floor2")
    )
    groups = [mf.Group("f", frequency="all"), mf.Group("s", shape="all")]
    problem = mf.updating_problem(model, data, groups, {"k": (0.5, 2.0)}, {"k": 1.0})
    search = mf.Search(doubt=0.5)
    return mf.solve(problem, points=3, search=search, noise=mf.NoisePrior(weight=0))


@pytest.fixture(scope="module")
def results() -> Results:
    return chain_results()


def test_shapes_are_in_the_scale_of_the_model(results: Results) -> None:
    shapes = results.shapes("nominal")
    assert shapes.geometry is not None
    assert shapes.displacement is not None
    assert shapes.displacement.shape == (2, 3, 3)
    np.testing.assert_allclose(np.abs(shapes.displacement).max(axis=(1, 2)), 1)
    np.testing.assert_array_equal(shapes.displacement[:, 0], 0)  # the ground
    model = results.nominal
    expected = model.modes().shape / np.abs(model.modes().shape).max(axis=0)
    np.testing.assert_allclose(np.abs(shapes.displacement[:, 1:, 0].T), np.abs(expected))
    np.testing.assert_allclose(shapes.measured[0], shapes.computed)  # exact at the nominal model
    np.testing.assert_allclose(shapes.displacement[:, 1:, 0], shapes.computed)
    assert results.problem is not None
    measured = results.problem.data.shape[0]
    np.testing.assert_array_equal(np.sign(shapes.computed), np.sign(measured))


def test_shapes_need_the_study(results: Results) -> None:
    with pytest.raises(mf.ModelError, match="expected results with their study"):
        Results(results.dataset).shapes("nominal")
    with pytest.raises(KeyError, match="nbi-1"):
        results.shapes("none")


def test_a_vtu_file_holds_nodes_cells_and_shapes(results: Results, tmp_path: Path) -> None:
    results.write_vtu(tmp_path / "shapes.vtu", "edge-f")
    mesh = meshio.read(tmp_path / "shapes.vtu")
    assert len(mesh.points) == 3
    assert [(block.type, block.data.tolist()) for block in mesh.cells] == [
        ("line", [[0, 1], [1, 2]])
    ]
    names = list(mesh.point_data)
    assert [name.split(" (")[0] for name in names[:2]] == ["mode 1", "mode 2"]
    assert names[2:] == ["mode 1 measured", "mode 2 measured"]
    np.testing.assert_array_equal(mesh.point_data["mode 1 measured"][0], 0)
    assert (abs(mesh.point_data["mode 1 measured"][1:, 0]) > 0).all()
    assert [path.name for path in tmp_path.iterdir()] == ["shapes.vtu"]


def test_a_vtu_file_needs_geometry_and_a_folder(results: Results, tmp_path: Path) -> None:
    with pytest.raises(mf.InputError, match="expected a file that can be written"):
        results.write_vtu(tmp_path / "none" / "shapes.vtu", 0)
    model = mf.matrices(["k"], {"k": np.array([[4.0]])}, {"base": np.eye(1)}, {"top": 0})
    data = mf.modal_data(np.array([0.3]), np.array([[1.0]]), ("top",))
    problem = mf.updating_problem(
        model, data, [mf.Group("f", frequency="all")], {"k": (0.5, 2.0)}, {"k": 1.0}
    )
    bare = mf.solve(problem, search=mf.Search(doubt=0.5), noise=mf.NoisePrior(weight=0))
    assert bare.shapes("nominal").displacement is None
    with pytest.raises(mf.ModelError, match="expected a model with geometry"):
        bare.write_vtu(tmp_path / "shapes.vtu", "nominal")


def test_nodes_of_finite_elements_move_as_their_free_degrees_of_freedom_do() -> None:
    X, cells = mf.fem.grids.line(np.zeros(3), np.array([0.0, 0.0, 1.0]), 4)
    steel = mf.fem.Material(E=210e9, nu=0.3, rho=7850.0)
    beam = mf.fem.Structure(
        nodes=np.vstack([X, [[0.5, 0.0, 1.0]]]),
        groups=(mf.fem.Beams("beam", cells, steel, mf.fem.circle(0.02)),),
        supports=(mf.fem.Support(0),),
        links=(mf.fem.Link(4, 5),),
        sensors=(mf.fem.Sensor("tip", 4, "-y"), mf.fem.Sensor("arm", 5, (1.0, 0.0, 1.0))),
        parameters=(mf.fem.Parameter("k", "E", ("beam",)),),
    )
    model = mf.mesh_model(beam, ["k"])
    geometry = model.geometry
    assert geometry is not None
    assert [(block.group, block.type) for block in geometry.cells] == [("beam", "line")]
    shapes = model.full_modes(np.array([1.0]), 3).Phi
    moved = geometry.displacement(shapes)
    assert moved.shape == (3, 6, 3)
    position = moved[:, geometry.sensor_nodes]
    seen = (position * geometry.sensor_directions).sum(axis=2)
    np.testing.assert_allclose(seen, (model.selection @ shapes).T, atol=1e-12)
