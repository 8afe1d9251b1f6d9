"""Modes from universal files: files of pyuff are read, and faulty ones are refused in words."""

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from modefront.data.modal import ModalData
from modefront.data.uff import NodalModes, read_uff55, write_uff55
from modefront.errors import InputError
from modefront.study.check import check
from modefront.study.examples import write_example
from modefront.study.file import load
from modefront.study.measured import _by_coordinates

pyuff = pytest.importorskip("pyuff")

NODES = [3, 7]
SHAPES = np.array([[[0.5, 0.0, 0.1], [1.0, 0.0, -0.2]], [[1.0, 0.0, 0.3], [-0.6, 0.0, 0.4]]])


def normal_mode(number: int, frequency: float, values: np.ndarray[Any, Any]) -> dict[str, Any]:
    written: dict[str, Any] = pyuff.prepare_55(
        *("NONE", "NONE", "NONE", "NONE", "NONE", 1, 2, 2, 8, 2, 3),
        r1=values[:, 0],
        r2=values[:, 1],
        r3=values[:, 2],
        load_case=1,
        mode_n=number,
        freq=frequency,
        modal_m=1.0,
        modal_damp_vis=0.01 * number,
        modal_damp_his=0.0,
        node_nums=NODES,
    )
    return written


def write(path: Path, *more: dict[str, Any]) -> Path:
    modes = [normal_mode(r + 1, 4.0 + 7 * r, values) for r, values in enumerate(SHAPES)]
    pyuff.UFF(str(path)).write_sets([*more, *modes], "add")
    return path


def geometry(number: int) -> dict[str, Any]:
    nothing, zero = [0, 0], [0.0, 0.0]
    prepare = {15: pyuff.prepare_15, 2411: pyuff.prepare_2411}[number]
    out: dict[str, Any] = prepare(NODES, nothing, nothing, nothing, [0.0, 1.5], zero, [2.0, 4.0])
    return out


@pytest.mark.parametrize("number", [15, 2411])
def test_normal_modes_with_geometry(number: int, tmp_path: Path) -> None:
    modes = read_uff55(write(tmp_path / "modes.uff", geometry(number)))
    assert modes.measured == ("3X", "3Z", "7X", "7Z")
    np.testing.assert_allclose(modes.position, [[0.0, 0.0, 2.0], [1.5, 0.0, 4.0]])
    np.testing.assert_allclose(modes.data.frequency, [[4.0, 11.0]])
    np.testing.assert_allclose(modes.data.damping, [[0.01, 0.02]])
    place = modes.place("-7z")
    assert place is not None
    data = modes.at({"top": place, "low": (0, np.array([0.6, 0, 0.8, 0, 0, 0]))})
    np.testing.assert_allclose(data.shape, [[[0.2, 0.38], [-0.4, 0.84]]])


def test_complex_modes_of_several_sets_are_read_as_they_were_written(tmp_path: Path) -> None:
    pole = complex(-0.3, 25.0)
    shape = np.array([1.0, -0.5]) * np.exp(0.7j)
    write_uff55(
        tmp_path / "a.uff", ["a", "b"], [{1: (pole, shape)}, {1: (2 * pole, shape)}], ["1Z", "2X"]
    )
    modes = read_uff55(tmp_path / "a.uff")
    assert (modes.data.sets, modes.data.modes, modes.measured) == (("a", "b"), (1,), ("1Z", "2X"))
    np.testing.assert_allclose(modes.data.frequency[:, 0], np.abs([pole, 2 * pole]) / (2 * np.pi))
    np.testing.assert_allclose(modes.data.damping, 0.3 / abs(pole), rtol=1e-4)
    z, x = modes.shape[0, 0, 0, 2], modes.shape[0, 0, 1, 0]
    assert x / z == pytest.approx(-0.5, rel=1e-4)


def test_setups_without_names_may_have_other_nodes_and_more_modes(tmp_path: Path) -> None:
    files = [lines_of(count=count) for count in (2, 3)]
    second = "".join(f"{n:10d}" for n in (4, 1, 2))
    more = [x.replace(second, f"{second[:20]}{3:10d}") for x in files[1][len(files[1]) // 2 :]]
    path = tmp_path / "a.uff"
    path.write_text("\n".join([*files[0], *files[1], *more]) + "\n")
    modes = read_uff55(path)
    assert (modes.data.sets, modes.data.modes) == (("1", "2"), (1, 2, 3))
    assert np.isfinite(modes.data.frequency).tolist() == [[True, True, False], [True] * 3]


def test_a_sensor_without_node_takes_none_that_another_has(tmp_path: Path) -> None:
    shape = np.array([1.0, -0.5, 0.25], complex)
    write_uff55(tmp_path / "a.uff", ["a"], [{1: (complex(-0.3, 25.0), shape)}], ["2X", "top", "1X"])
    modes = read_uff55(tmp_path / "a.uff")
    assert modes.measured == ("1X", "2X", "3X")
    assert modes.shape[0, 0, :, 0] / modes.shape[0, 0, 1, 0] == pytest.approx([0.25, 1, -0.5])


def test_a_mode_that_does_not_move_the_sensors_has_no_shape(tmp_path: Path) -> None:
    shapes = np.array([[0.5, 1.0, 0.0], [0.0, 0.0, 1.0]], complex)
    modes = {k: (complex(-0.3, 25.0 * k), shape) for k, shape in enumerate(shapes, 1)}
    write_uff55(tmp_path / "a.uff", ["a"], [modes], ["1Z", "2Z", "1X"])
    read = read_uff55(tmp_path / "a.uff")
    data = read.at({name: place for name in ("1Z", "2Z") if (place := read.place(name))})
    assert np.isfinite(data.shape).all(axis=2).tolist() == [[True, False]]
    assert np.isfinite(data.frequency).all()


def system(kind: int, label: int = 4) -> dict[str, Any]:
    """A coordinate system whose x is the y of space, and y its z; its origin is at (0, 0, 1)."""
    rows = np.array([[0.0, 1, 0], [0, 0, 1], [1, 0, 0], [0, 0, 1]])
    written: dict[str, Any] = pyuff.prepare_2420(1, "part", [label], [kind], [8], ["local"], [rows])
    return written


def at_point(label: int) -> dict[str, Any]:
    prepare = pyuff.prepare_2411
    out: dict[str, Any] = prepare(
        NODES, [0, 0], [0, label], [0, 0], [0.0, 1.5], [0.0, 2.0], [2.0, 3.0]
    )
    return out


def test_components_are_along_the_displacement_system_of_their_node(tmp_path: Path) -> None:
    modes = read_uff55(write(tmp_path / "a.uff", at_point(4), system(0)))
    assert modes.local(0, np.eye(6)[2]).tolist() == [0, 0, 1, 0, 0, 0]
    assert modes.local(1, np.eye(6)[1]).tolist() == [1, 0, 0, 0, 0, 0]
    assert modes.in_space(1, np.eye(6)[0]).tolist() == [0, 1, 0, 0, 0, 0]
    # Along y of space is along x of node 7, along x of space along its z.
    data = modes.at(
        {"y": (1, modes.local(1, np.eye(6)[1])), "x": (1, modes.local(1, np.eye(6)[0]))}
    )
    np.testing.assert_allclose(data.shape, [[[1.0, -0.2], [-0.6, 0.4]]])


def test_cylindrical_systems_and_those_that_are_not_known(tmp_path: Path) -> None:
    # Node 7 is at (2, 2) in the plane of the system, so that the radius points along (1, 1).
    modes = read_uff55(write(tmp_path / "a.uff", at_point(4), system(1)))
    c = np.sqrt(0.5)
    np.testing.assert_allclose(modes.axes[1], [[0, c, c], [0, -c, c], [1, 0, 0]], atol=1e-12)
    spherical = read_uff55(write(tmp_path / "b.uff", at_point(4), system(2)))
    assert np.isnan(spherical.axes[1]).all()
    other = read_uff55(write(tmp_path / "c.uff", at_point(5), system(0)))
    assert np.isnan(other.axes[1]).all()
    unsaid = read_uff55(write(tmp_path / "d.uff", at_point(5)))
    np.testing.assert_array_equal(unsaid.axes[1], np.eye(3))


def test_older_systems_turn_components_and_coordinates(tmp_path: Path) -> None:
    # The same system as that of `system`, by its origin, a point on x, and one in the plane x-z.
    points = [[0.0, 0, 1, 0, 5, 1], [2.0, 3, 1]]
    numbers = ["".join(f"{x:13.5E}" for x in row) for row in points]
    head = "".join(f"{x:10d}" for x in (4, 0, 0, 8, 1))
    text = "\n".join(["    -1", "    18", head, "local", *numbers, "    -1", ""])
    known = pyuff.prepare_15(NODES, [0, 4], [0, 4], [0, 0], [0.0, 1.5], [0.0, 2.0], [2.0, 3.0])
    path = write(tmp_path / "a.uff", known)
    path.write_text(text + path.read_text())
    modes = read_uff55(path)
    np.testing.assert_allclose(modes.axes[1], [[0, 1, 0], [0, 0, 1], [1, 0, 0]], atol=1e-12)
    np.testing.assert_allclose(modes.position, [[0.0, 0.0, 2.0], [3.0, 1.5, 3.0]])
    path.write_text(path.read_text().replace(head, head[:20] + f"{3:10d}" + head[30:]))
    other = read_uff55(path)  # of a system in another one
    assert np.isnan(other.axes[1]).all()
    assert np.isnan(other.position[1]).all()


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"nothing", "this is no universal file"),
        (b"    -1\n    15\n    -1\n", r"expected .* modes \(dataset 55\), found datasets 15 only"),
        (b"    -1\n    55\n", "expected the end of dataset 55"),
        (b"    -1\n    55\nNONE\n    -1\n", "expected a dataset 55"),
    ],
)
def test_files_without_modes_are_refused(content: bytes, says: str, tmp_path: Path) -> None:
    (tmp_path / "modes.uff").write_bytes(content)
    with pytest.raises(InputError, match=says):
        read_uff55(tmp_path / "modes.uff")


def study(folder: Path, sensors: str) -> Path:
    """Return the three-story study with its modes in a universal file."""
    write_example("three-story-c0", folder)
    rows = np.loadtxt(folder / "modes.csv", delimiter=",", skiprows=1, usecols=(2, 4, 5, 6))
    poles = [complex(-0.01, 2 * np.pi * f) for f in rows[:, 0]]
    shapes = dict(enumerate(zip(poles, rows[:, 1:].astype(complex), strict=True), 1))
    write_uff55(folder / "modes.uff", ["a"], [shapes], ["11X", "12X", "13X"])
    file = folder / "study.toml"
    data = f'file = "modes.uff"\n{sensors}'
    file.write_text(
        file.read_text(encoding="utf-8").replace('file = "modes.csv"', data, 1), encoding="utf-8"
    )
    return file


PLACES = '[data.sensors]\nfloor1 = "11X"\nfloor2 = { node = 12, direction = "-x" }\nfloor3 = "13x"'


def test_a_study_takes_modes_from_a_universal_file(tmp_path: Path) -> None:
    loaded = load(study(tmp_path, PLACES))
    plain = tmp_path / "plain"
    write_example("three-story-c0", plain)
    shape = load(plain / "study.toml").problem.data.shape[0] * [1, -1, 1]
    result = loaded.problem.data.shape[0]
    np.testing.assert_allclose(result / result[:, :1], shape / shape[:, :1], rtol=1e-4)
    assert any("floor2 is reversed" in text for text in check(loaded).warnings)


def test_a_universal_file_of_a_study_is_known_by_its_content(tmp_path: Path) -> None:
    file = study(tmp_path, PLACES)
    before = load(file).problem.data
    (tmp_path / "modes.uff").rename(tmp_path / "modes.dat")
    file.write_text(file.read_text(encoding="utf-8").replace("modes.uff", "modes.dat"), "utf-8")
    np.testing.assert_array_equal(load(file).problem.data.shape, before.shape)


@pytest.mark.parametrize(
    ("sensors", "says"),
    [
        ("", "floor1 = node and direction, one of 11X, 12X, 13X"),
        (PLACES.replace('"11X"', '"11Y"'), "one of 11X, 12X, 13X, found 11 along y"),
        (PLACES.replace('"11X"', '"14X"'), "floor1: expected one of 11X, 12X, 13X, found '14X'"),
        (PLACES.replace('"11X"', "11"), "node and direction, such as"),
        (PLACES.replace("node = 12", "node = 2"), "a node of the test, found 2"),
        (PLACES.replace('"-x"', '"u"'), "direction: expected one of x, -x"),
        (PLACES.replace("floor1", "flor1"), "did you mean 'floor1'"),
    ],
)
def test_sensors_that_the_file_does_not_have(sensors: str, says: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as error:
        load(study(tmp_path, sensors))
    assert says in str(error.value)


def test_sensors_of_a_mesh_are_found_by_coordinates_and_names(tmp_path: Path) -> None:
    empty, none = np.ones((1, 1)), np.ones((1, 1, 0))
    data = ModalData(("1",), (1,), (), empty, empty, none, empty, none)
    position, axes = np.array([[0.0, 0, 0], [1, 0, 0]]), np.tile(np.eye(3), (2, 1, 1))
    modes = NodalModes(data, np.array([5, 6]), position, axes, np.ones((1, 1, 2, 6)))
    assert modes.place("6RZ") is not None
    assert modes.place("floor1") is None
    assert modes.place("9X") is None
    sensor: dict[str, Any] = {"sensor_nodes": [2], "sensor_directions": np.eye(3)}
    mesh: Any = SimpleNamespace(nodes=np.array([[0.0, 0, 0], [2, 0, 0], [1, 0, 0]]), **sensor)
    place = _by_coordinates(modes, mesh, 0)
    assert place is not None
    assert place[0] == 1
    for scale in (1e-3, 1e3):  # all nodes of one are near one of the other
        mesh.nodes = scale * mesh.nodes
        assert _by_coordinates(modes, mesh, 0) is None
        mesh.nodes = mesh.nodes / scale


def lines_of(*, count: int = 3) -> list[str]:
    """Return the lines of a file with two modes at some nodes."""
    out = []
    for mode in (1, 2):
        out += ["    -1", "    55", *["NONE"] * 5, "".join(f"{n:10d}" for n in (1, 2, 2, 8, 2, 3))]
        out += ["".join(f"{n:10d}" for n in (2, 4, 1, mode))]
        out += ["".join(f"{x:13.5E}" for x in (4.0 * mode, 1.0, 0.01, 0.0))]
        for node in range(1, count + 1):
            out += [f"{node:10d}", "".join(f"{x:13.5E}" for x in (0.5 * node, 0.0, 0.1 * mode))]
        out += ["    -1"]
    return out


@pytest.mark.parametrize("count", [1, 3])
@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda x: x[: len(x) // 2 - 2] + x[len(x) // 2 - 1 :], "3 numbers, as its header says"),
        (lambda x: [*x[:12], x[11], *x[12:]], "line 12, dataset 55|dataset 55: expected"),
        (lambda x: [y.replace("8         2         3", f"8{2:10d}{2:10d}") for y in x], "3 or 6"),
        (lambda x: [y.replace("8         2         3", f"8{5:10d}{3:10d}") for y in x], "6 numb"),
        (lambda x: [x[0], "   55x", *x[2:]], "no universal file"),
        (lambda x: x[: len(x) // 2 - 1] + x[len(x) // 2 :], "a dataset: a line with -1 in columns"),
        (lambda x: [*x[:-3], f"{9:10d}", *x[-2:]], "same nodes in the geometry and in all modes"),
    ],
)
def test_what_the_header_declares_is_counted(
    count: int, change: Callable[[list[str]], list[str]], says: str, tmp_path: Path
) -> None:
    path = tmp_path / "a.uff"
    path.write_text("\n".join(lines_of(count=count)) + "\n")
    assert read_uff55(path).shape[0, :, -1, 0].tolist() == [0.5 * count] * 2
    path.write_text("\n".join(change(lines_of(count=count))) + "\n")
    with pytest.raises(InputError, match=says):
        read_uff55(path)


def test_a_header_with_a_blank_more_is_that_of_the_same_dataset(tmp_path: Path) -> None:
    text = "\n".join(lines_of()) + "\n"
    (tmp_path / "a.uff").write_text(text.replace("\n    55\n", "\n     55\n"))
    assert read_uff55(tmp_path / "a.uff").data.frequency.tolist() == [[4.0, 8.0]]
