"""Sensors by node and direction, nodes by several groups, MED groups, all faults of a structure."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from modefront.errors import InputError
from modefront.fem.mesh import read_mesh
from modefront.models.matrices import MatrixModel
from modefront.models.reduced.model import ReducedModel
from modefront.study.examples import write_example
from modefront.study.file import load
from modefront.study.kinds.mesh import unused_groups

meshio = pytest.importorskip("meshio")

SENSORS = """floor1 = { node = 19, direction = "x" }
floor2 = { node = 37, direction = "x" }
floor3 = { node = 55, direction = "x" }
"""


def model(folder: Path, sensors: str, columns: str, *edits: tuple[str, str]) -> MatrixModel:
    """Return the model of the frame with other sensors; the data are 1 at each."""
    write_example("three-story-fe-c1", folder)
    study = folder / "study.toml"
    text = study.read_text(encoding="utf-8")
    for old, new in ((SENSORS, sensors), *edits):
        assert old in text, old
        text = text.replace(old, new)
    study.write_text(text, encoding="utf-8")
    ones = ",".join("1" for _ in columns.split(","))
    rows = "\n".join(f"{r},{4.0 * r},{ones}" for r in (1, 2, 3))
    (folder / "modes.csv").write_text(f"mode,frequency,{columns}\n{rows}\n")
    result = load(study).problem.model
    result = result.full if isinstance(result, ReducedModel) else result
    assert isinstance(result, MatrixModel)
    return result


def test_a_list_of_directions_makes_a_sensor_each(tmp_path: Path) -> None:
    listed = model(
        tmp_path / "a", 'p = { node = 19, direction = ["x", "-y", "rz"] }\n', "px,py,prz"
    )
    assert listed.sensors == ("px", "py", "prz")
    single = "px = { node = 19, direction = 'x' }\npy = { node = 19, direction = '-y' }\n"
    single += "prz = { node = 19, direction = 'rz' }\n"
    plain = model(tmp_path / "b", single, "px,py,prz")
    np.testing.assert_array_equal(listed.selection.toarray(), plain.selection.toarray())


def test_directions_in_local_axes(tmp_path: Path) -> None:
    axes = "axes = [[3.0, 4.0, 0.0], [0.0, 1.0, 0.0]]"
    local = model(
        tmp_path / "a",
        f'p = {{ node = 37, direction = ["x", "-y"], {axes} }}\n'
        f"q = {{ node = 37, direction = [1.0, 0.0, 1.0], {axes} }}\n",
        "px,py,q",
    )
    plain = model(
        tmp_path / "b",
        "px = { node = 37, direction = [0.6, 0.8, 0.0] }\n"
        "py = { node = 37, direction = [0.8, -0.6, 0.0] }\n"
        "q = { node = 37, direction = [0.6, 0.8, 1.0] }\n",
        "px,py,q",
    )
    np.testing.assert_allclose(local.selection.toarray(), plain.selection.toarray(), atol=1e-15)


@pytest.mark.parametrize(
    ("sensor", "says"),
    [
        ('direction = ["x", "x"]', "a list of different ones of x, -x"),
        ('direction = ["x", "-x"]', "a list of different ones of x, -x"),
        ('direction = ["x", 1.0]', "a list of different ones of x, -x"),
        ('direction = "x", axes = [[1, 0, 0], [2, 0, 0]]', "the local x axis, and one in the"),
        ('direction = "x", axes = [1, 0, 0]', "the local x axis, and one in the"),
        ('direction = "rx", axes = [[1, 0, 0], [0, 1, 0]]', "x, y or z where axes are given"),
    ],
)
def test_directions_and_axes_that_are_none(sensor: str, says: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as error:
        model(tmp_path, f"p = {{ node = 37, {sensor} }}\n", "px")
    assert says in str(error.value)


def test_supports_and_springs_at_several_groups(tmp_path: Path) -> None:
    springs = '[[model.spring]]\nname = "soft"\nstiffness = 1.0\ndirection = "y"\n'
    springs += 'nodes = ["story1", 37, "base"]\n[model.sensors]'
    edits = ('nodes = "base"', 'nodes = ["base", 0]'), ("[model.sensors]", springs)
    result = model(tmp_path / "a", SENSORS, "floor1,floor2,floor3", *edits)
    assert result.size == 576
    with pytest.raises(InputError) as error:
        model(
            tmp_path / "b",
            SENSORS,
            "floor1,floor2,floor3",
            ('nodes = "base"', 'nodes = ["bse", 114]'),
        )
    text = str(error.value)
    assert "nodes: expected a group or node set of the mesh" in text
    assert "found 'bse' (did you mean 'base'?)" in text
    assert "nodes from 0 to 113 (they are counted from 0), found 114" in text


def test_all_faults_of_a_structure_are_said_at_once(tmp_path: Path) -> None:
    edits = (
        ('name = "lead2"', 'name = "lead1"'),
        ('of = ["story3"]', 'of = ["stroy3"]'),
        ("orientation = [0.0, 1.0, 0.0]", "orientation = [1.0, 0.0, 0.0]"),
        (
            "[model.sensors]",
            '[[model.spring]]\nname = "s"\nnodes = 3\nstiffness = 1.0\n[model.sensors]',
        ),
    )
    sensors = SENSORS.replace("node = 37", "at = [9.0, 9.0, 9.0]")
    with pytest.raises(InputError) as error:
        model(tmp_path, sensors, "floor1,floor2,floor3", *edits)
    result = [str(fault) for fault in error.value.faults]
    for part in (
        "member 'lead1'",
        "found 'stroy3' (did you mean 'story3'?)",
        "group 'floors' orientation",
        "spring 's' direction: expected one, unless",
        "sensor 'floor2': expected a node within",
    ):
        assert sum(part in text for text in result) == 1, (part, result)


def test_faults_of_tables_do_not_hide_those_of_sensors_and_scales(tmp_path: Path) -> None:
    edits = (
        ('material = "joint"', 'material = "jont"'),
        ("nu = 0.3, rho = 7850.0 }\njoint", "nu = 0.7, rho = 7850.0 }\njoint"),
        ('nodes = "base"', 'nodes = "bse"'),
        ('of = ["story3"]', 'of = ["stroy3"]'),
    )
    with pytest.raises(InputError) as error:
        model(tmp_path, SENSORS.replace("node = 37", "node = 999"), "floor1,floor2,floor3", *edits)
    text = str(error.value)
    for part in (
        "material steel nu: expected Poisson's ratio between -1 and 0.5, found 0.7",
        "material: expected one of 'steel', 'joint'",
        "found 'bse' (did you mean 'base'?)",
        "sensors floor2: expected nodes from 0 to 113, found 999",
        "scale theta3 of: expected the name of a group, spring, mass or load, found 'stroy3'",
    ):
        assert text.count(part) == 1, part
    assert len(error.value.faults) == 5


def test_groups_of_med_files(tmp_path: Path) -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0]])
    mesh = meshio.Mesh(
        points,
        [("line", np.array([[0, 1], [1, 2], [2, 3]]))],
        point_data={"point_tags": np.array([2, 0, 3, 3])},
        cell_data={"cell_tags": [np.array([-6, -6, -7])]},
    )
    mesh.point_tags = {2: ["base"], 3: ["tip", "all"]}
    mesh.cell_tags = {-6: ["beam", "members"], -7: ["members"]}
    meshio.write(tmp_path / "frame.med", mesh)
    read = read_mesh(tmp_path / "frame.med")
    assert [len(cells) for cells in read.cells_of("beam", "beam")] == [2]
    assert [len(cells) for cells in read.cells_of("members", "beam")] == [3]
    assert read.nodes_of("base").tolist() == [0]
    assert read.nodes_of("all").tolist() == [2, 3]
    # A group of cells that have elements by another group is no mistake.
    assert unused_groups(read, (name for name in ["members"]), []) == []
    (unused,) = unused_groups(read, ["beam"], [])
    assert (unused.subject, unused.numbers["cells"]) == ("members", 3)
