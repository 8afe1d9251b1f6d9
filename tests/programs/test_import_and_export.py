"""``modefront import`` and ``export`` as they are typed, with CalculiX where it is installed."""

from __future__ import annotations

import csv
import json
import re
import shutil
import subprocess
from pathlib import Path

import click
import numpy as np
import pytest
import scipy.io
import scipy.linalg
import scipy.optimize
import scipy.sparse
from click.testing import CliRunner, Result
from program_files import dense, labels, structure, write_op4, write_opensees

from modefront.cli.main import cli
from modefront.errors import InputError
from modefront.models.dofs import read_dofs
from modefront.models.matrices import MatrixModel
from modefront.programs import PROGRAMS
from modefront.programs.base import JobOptions, read_job, read_mesh
from modefront.residuals.problem import UpdatingProblem
from modefront.results.files import read_dataset
from modefront.study.check import check
from modefront.study.examples import write_example
from modefront.study.export import node_motion
from modefront.study.file import load

DATA = Path(__file__).parents[3] / "shared" / "data" / "fe"
CCX = shutil.which("ccx")
needs_ccx = pytest.mark.skipif(CCX is None, reason="CalculiX (ccx) is not installed")
needs_data = pytest.mark.skipif(not DATA.is_dir(), reason="there is no ../shared/data/fe")


def modefront(*arguments: object) -> Result:
    return CliRunner().invoke(cli, [str(x) for x in arguments])


def add_data(folder: Path, sensors: dict[str, str], rows: list[list[float]]) -> Path:
    """Add measured modes and sensors to an imported study, as its user does."""
    header = ["set", "mode", "frequency", "damping", *sensors]
    with (folder / "modes.csv").open("w", newline="") as stream:
        csv.writer(stream).writerows([header, *([1, k, *row] for k, row in enumerate(rows, 1))])
    study = folder / "study.toml"
    lines = [f"{name} = {place}" for name, place in sensors.items()]
    text = '\n[data]\nfile = "modes.csv"\n\n[model.sensors]\n' + "\n".join(lines) + "\n"
    study.write_text(study.read_text() + text)
    return study


def estimate(problem: UpdatingProblem) -> np.ndarray:
    """Return the parameters of least squares of all residuals."""

    def residuals(theta: np.ndarray) -> np.ndarray:
        return np.concatenate([r.r for r in problem.residuals(theta)])

    def slopes(theta: np.ndarray) -> np.ndarray:
        return np.concatenate([r.dr for r in problem.residuals(theta)])

    bounds = problem.lower, problem.upper
    tolerances = {"ftol": 1e-15, "xtol": 1e-12, "gtol": 1e-15}
    result = scipy.optimize.least_squares(
        residuals, problem.start, slopes, bounds=bounds, **tolerances
    )
    return np.asarray(result.x)


@pytest.fixture
def small(tmp_path: Path) -> Path:
    """A folder with the study of a small structure, imported and with measured modes."""
    for name, values in {"base": {}, "E": {"E": 2.0}, "k": {"k": 3.0}}.items():
        write_opensees(tmp_path / name, *structure(**values), labels())
    (tmp_path / "base_nodes.csv").write_text("12,0,0,0\n3,1,0,0\n7,1,1,0\n40,0,1,0\n5,0,0,1\n")
    (tmp_path / "base_elements.csv").write_text("1,12,3,7,40\n2,12,5\n")
    (tmp_path / "base.tcl").write_text("set k 300.0\nset E 40.0\n")
    (tmp_path / "k.tcl").write_text("set k 900.0\nset E 40.0\n")
    result = modefront(
        *("import", "opensees", tmp_path / "base", "--parameter", f"E={tmp_path / 'E'}"),
        *("--parameter", f"k={tmp_path / 'k'}", "--factor", "k=3", "-o", tmp_path / "study"),
    )
    assert result.exit_code == 0, result.output
    K, M = structure(E=1.2, k=0.8)
    lam, vectors = np.linalg.eig(np.linalg.solve(M, K))
    order = np.argsort(lam.real)[:5]
    sensors = {
        "a": '{ node = 12, direction = "z" }',
        "b": '{ node = 3, direction = "-x" }',
        "c": '{ node = 40, direction = "z" }',
        "d": "{ node = 7, direction = [0, 3, 4] }",
        "e": "12",
    }
    rows = []
    for k in order:
        phi = vectors[:, k].real
        shape = [phi[2], -phi[3], phi[11], 0.6 * phi[7] + 0.8 * phi[8], phi[12]]
        rows.append([np.sqrt(lam[k].real) / (2 * np.pi), 0.01, *shape])
    add_data(tmp_path / "study", sensors, rows)
    return tmp_path / "study"


def test_an_imported_study_needs_data_and_sensors_only(small: Path) -> None:
    study = load(small / "study.toml")
    first, _ = (small / "study.toml").read_text().split("\n", 1)
    assert first == "#:schema study.schema.json"
    assert (small / "study.schema.json").is_file()
    assert study.problem.model.directions == ("x", "y", "z")
    assert estimate(study.problem) == pytest.approx([1.2, 0.8], rel=1e-6)


def test_the_sensor_that_is_proposed_can_move(tmp_path: Path) -> None:
    for name, values in {"base": {}, "E": {"E": 2.0}}.items():
        K, M = (A[:14, :14] for A in structure(**values))  # the last node is held along z
        write_opensees(tmp_path / name, K, M, labels()[:14])
    runs = "opensees", tmp_path / "base", "--parameter", f"E={tmp_path / 'E'}"
    result = modefront("import", *runs, "-o", tmp_path / "study")
    assert result.exit_code == 0, result.output
    study = tmp_path / "study" / "study.toml"
    text, count = re.subn(r"^# (?=\[|file|a =)", "", study.read_text(), flags=re.MULTILINE)
    assert count == 4
    study.write_text(text)
    (study.parent / "modes.csv").write_text("mode,frequency,a\n1,2.0,1.0\n")
    assert load(study).problem.model.sensors == ("a",)


@pytest.mark.parametrize(
    ("deck", "text"),
    [
        (
            "set k 900.0\nset E 40.0\n",
            "k: the decks differ by a factor of 3 (line 1), but the run is",
        ),
        ("set k 600.0\nset E 40.0\n", ""),
        ("set k 900.0\nset E 50.0\n", ""),
        ("set k 900.0\nset F 40.0\n", ""),
        ("set k 900.0\n", ""),
    ],
)
def test_a_factor_that_the_decks_contradict(small: Path, deck: str, text: str) -> None:
    (small.parent / "k.tcl").write_text(deck)
    result = modefront(
        *("import", "opensees", small.parent / "base"),
        *("--parameter", f"k={small.parent / 'k'}", "-o", small.parent / "again"),
    )
    assert result.exit_code == 0, result.output + str(result.exception)
    assert text in result.output
    assert ("the decks differ" in result.output) == bool(text)


def test_a_list_of_directions_makes_a_sensor_each(small: Path) -> None:
    file, data = small / "study.toml", small / "modes.csv"
    text = file.read_text()
    single = load(file).problem.model.sensors
    file.write_text(text.replace('a = { node = 12, direction = "z" }', LISTED))
    header, *rows = data.read_text().splitlines()
    header = ",".join("pz" if name == "a" else name for name in header.split(","))
    data.write_text("\n".join([f"{header},py", *(f"{row}," for row in rows)]))
    result = load(file).problem.model
    assert set(result.sensors) == {*single, "pz", "py"} - {"a"}


def test_sensors_in_local_axes(small: Path) -> None:
    file = small / "study.toml"
    model = load(file).problem.model
    assert isinstance(model, MatrixModel)
    before = model.selection.toarray()[model.sensors.index("d")]
    axes = "axes = [[0, 3, 4], [1, 0, 0]]"
    text = file.read_text()
    file.write_text(text.replace("direction = [0, 3, 4]", f'direction = "x", {axes}'))
    turned = load(file).problem.model
    assert isinstance(turned, MatrixModel)
    row = turned.selection.toarray()[turned.sensors.index("d")]
    assert row == pytest.approx(before)
    for direction, message in (('"rz"', "x, y or z where axes are given"), ('"x"', "two vectors")):
        wrong = axes if "rz" in direction else "axes = [[1, 0, 0], [2, 0, 0]]"
        file.write_text(text.replace("direction = [0, 3, 4]", f"direction = {direction}, {wrong}"))
        with pytest.raises(InputError, match=message):
            load(file)


LISTED = 'p = { node = 12, direction = ["z", "-y"] }'


def test_an_imported_study_has_the_geometry_of_its_deck(small: Path) -> None:
    model = load(small / "study.toml").problem.model
    assert isinstance(model, MatrixModel)
    geometry = model.geometry
    assert geometry is not None
    number = sorted({node for node, _ in labels()})
    assert [number[k] for k in geometry.sensor_nodes] == [12, 3, 40, 7, 5]
    assert geometry.sensor_directions.tolist() == [
        *([0, 0, 1], [-1, 0, 0], [0, 0, 1], [0, 0.6, 0.8], [1, 0, 0]),
    ]
    assert {cells.type: cells.nodes.shape for cells in geometry.cells} == {
        "quad": (1, 4),
        "line": (1, 2),
    }
    shapes = np.random.default_rng(0).standard_normal((15, 2))
    moved = geometry.displacement(shapes)
    sensed = np.einsum("mkd,kd->km", moved[:, geometry.sensor_nodes], geometry.sensor_directions)
    assert sensed == pytest.approx(model.selection @ shapes)


@pytest.mark.parametrize(
    ("place", "message"),
    [
        ('{ node = 12, direction = ["z", "-z"] }', "a list of different ones"),
        ('{ node = 13, direction = "z" }', "a node with degrees of freedom, 3, 5, 7, 12, 40"),
        ('{ node = 12, direction = "rx" }', "node 12 can move .x, y, z., found rx, which is held"),
        ('{ node = 12, direction = "up" }', "one of x, -x, y, -y, z, -z"),
        ("{ node = 12, direction = [0, 0, 0] }", "a vector"),
        ('{ node = 0, direction = "z" }', "a whole number from 1"),
        ('{ node = 12, directoin = "z" }', "did you mean 'direction'"),
        ("{ node = 12 }", "direction: expected .*found nothing"),
    ],
)
def test_sensors_by_node_that_there_are_not(small: Path, place: str, message: str) -> None:
    file = small / "study.toml"
    file.write_text(file.read_text().replace('{ node = 12, direction = "z" }', place))
    with pytest.raises(InputError, match=message):
        load(file)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('dofs = "dofs.csv"\n', "", 'nodes and directions need dofs = "dofs.csv"'),
        ('dofs = "dofs.csv"', 'dofs = "none.csv"', "a table of degrees of freedom, found no such"),
        ('dofs = "dofs.csv"', 'dofs = "modes.csv"', "expected node,direction"),
        ('mesh = "mesh.npz"', 'mesh = "dofs.csv"', "nodes and elements .mesh.npz."),
        (
            'z = { direction = "z"',
            'z = { direction = "z", node = 0',
            "node: expected a whole number from 1",
        ),
        ('z = { direction = "z"', 'z = { direction = "z", directoin = "x"', "node: expected"),
        ('"k" = "stiffness-k.npz"', '"k^x" = "stiffness-k.npz"', "a product of powers"),
        ('"k" = "stiffness-k.npz"', '"1/k" = "stiffness-k.npz"', None),
        ("bounds = [0.5, 2.0]", "bounds = [-1.0, 2.0]", None),
    ],
)
def test_what_is_wrong_with_an_imported_study(
    small: Path, old: str, new: str, message: str | None
) -> None:
    file = small / "study.toml"
    file.write_text(file.read_text().replace(old, new))
    if message is None:
        load(file)
        return
    with pytest.raises(InputError, match=message):
        load(file)


def test_parameters_of_quotients_stay_above_zero(small: Path) -> None:
    file = small / "study.toml"
    text = file.read_text().replace('"k" = "stiffness-k.npz"', '"1/k" = "stiffness-k.npz"')
    file.write_text(text.replace("bounds = [0.5, 2.0]", "bounds = [0.0, 2.0]"))
    with pytest.raises(InputError, match="'k' bounds: expected a lower bound above 0") as caught:
        load(file)
    assert len(caught.value.faults) == 1


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--parameter", "E"], "--parameter: expected NAME=RUN, found 'E'"),
        (["--parameter", "E=E", "--factor", "E=x"], "--factor: expected a number that is not 0"),
        (["--parameter", "E=E", "--check", "E"], "expected RUN:NAME=VALUE,NAME=VALUE, found 'E'"),
        (["--parameter", "E=E", "--function", "E="], "--function: expected NAME=TERM,TERM"),
        (["--parameter", "E=E", "--run", "ccx"], "--run: expected calculix, found 'opensees'"),
        ([], "Missing option '--parameter'"),
    ],
)
def test_options_that_are_wrong(tmp_path: Path, arguments: list[str], message: str) -> None:
    result = modefront("import", "opensees", tmp_path / "base", *arguments, "-o", tmp_path / "o")
    text = result.output + (str(result.exception) if result.exception else "")
    assert message in text
    assert not (tmp_path / "o").exists()


def test_the_command_names_all_programs() -> None:
    (program, *_) = cli.commands["import"].params
    assert isinstance(program.type, click.Choice)
    assert list(program.type.choices) == list(PROGRAMS)


def test_nothing_is_overwritten(small: Path) -> None:
    before = (small / "study.toml").read_bytes()
    base = small.parent / "base"
    run = modefront("import", "opensees", base, "--parameter", f"E={small.parent}/E", "-o", small)
    assert "nothing is overwritten" in str(run.exception)
    assert (small / "study.toml").read_bytes() == before


def test_a_model_is_exported(small: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    study = small / "study.toml"
    text = study.read_text() + "\n[pareto]\npoints = 3\n[identifiability]\nmodels = 0\n"
    text += "[search]\ndoubt = 0.5\n[noise]\nweight = 0\n"
    data = (small / "modes.csv").read_text()
    study.write_text(text)
    (small / "modes.csv").write_text(data.replace("0.01", "0.02"))
    assert modefront("run", study, "-o", small / "results").exit_code in (0, 1)
    result = modefront("export", small / "results", "--point", "equal-weights", "--modes", 4)
    assert result.exit_code == 0, result.output + str(result.exception)
    folder = small / "results" / "export-equal-weights"
    values = json.loads((folder / "parameters.json").read_text())["parameters"]
    rows = list(csv.reader((folder / "parameters.csv").read_text().splitlines()))
    assert {name: float(value) for name, value in rows[1:]} == values
    K, M = structure(E=values["E"], k=values["k"])
    for name, right in (("K", K), ("M", M)):
        for computed in (
            scipy.io.mmread(folder / f"{name}.mtx", spmatrix=False).toarray(),
            scipy.sparse.load_npz(folder / f"{name}.npz").toarray(),
        ):
            assert np.abs(computed - right).max() < 1e-12 * right.max()
    assert read_dofs(folder / "dofs.csv").node.tolist() == [n for n, _ in labels()]
    deck = (folder / "deck.txt").read_text()
    assert f"set k {300 * values['k']:.9g}" in deck
    assert "a factor of what was changed" in deck, "there is no deck with another E"
    _check_shapes(folder, K, M)
    assert "warning" not in (folder / "parameters.json").read_text()
    found, says = read_dataset(small / "results"), "Do not use any of these models: …"
    refused = found.assign_attrs({"reference": "", "verdict": f"{says}\nmore"})
    monkeypatch.setattr("modefront.study.export.read_dataset", lambda _: refused)
    result = modefront("export", small / "results", "--point", "equal-weights", "-o", small / "a")
    assert says in result.output.splitlines()
    assert json.loads((small / "a" / "parameters.json").read_text())["warning"] == says
    assert says in (small / "a" / "deck.txt").read_text()


def test_the_study_of_results_is_found_wherever_it_lies(
    small: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study, results = small / "study.toml", tmp_path / "elsewhere" / "deep" / "results"
    text = study.read_text() + "\n[pareto]\npoints = 2\n[identifiability]\nmodels = 0\n"
    study.write_text(text + "[search]\ndoubt = 0.5\n[noise]\nweight = 0\n")
    assert modefront("run", study, "-o", results).exit_code in (0, 1)
    result = modefront("export", results, "-o", tmp_path / "a")
    assert result.exit_code == 0, result.output + str(result.exception)
    shutil.rmtree(results / "tasks")
    lost = str(modefront("export", results, "-o", tmp_path / "b").exception)
    assert "found none: pass --study FILE" in lost
    monkeypatch.chdir(small)
    assert modefront("export", results, "-o", tmp_path / "b").exit_code == 0
    study.write_text(study.read_text().replace("bounds = [0.5, 2.0]", "bounds = [0.5, 1.9]"))
    changed = str(modefront("export", results, "-o", tmp_path / "c").exception)
    assert f"'{study}' with other inputs than those of the results: changed since" in changed
    other = str(modefront("export", results, "--study", study, "-o", tmp_path / "c").exception)
    assert "other inputs: run it again" in other
    study.unlink()
    assert not (tmp_path / "c").exists()


def _check_shapes(folder: Path, K: np.ndarray, M: np.ndarray) -> None:
    """The universal file and the VTU file have the nodes, and the modes of K and M."""
    meshio, pyuff = pytest.importorskip("meshio"), pytest.importorskip("pyuff")
    file = pyuff.UFF(str(folder / "modes.uff"))
    assert list(file.get_set_types()) == [2411, 2412, 55, 55, 55, 55]
    grid = meshio.read(folder / "modes.vtu")
    nodes = grid.point_data["node"].ravel()
    assert grid.points[list(nodes).index(5)].tolist() == [0, 0, 1]
    assert {block.type for block in grid.cells} == {"quad", "line"}
    for k in range(4):
        mode = file.read_sets(k + 2)
        place = [list(mode["node_nums"]).index(node) for node, _ in labels()[::3]]
        shape = np.column_stack([mode[r][place] for r in ("r1", "r2", "r3")]).ravel().real
        lam = (2 * np.pi * mode["freq"]) ** 2
        assert np.abs(K @ shape - lam * M @ shape).max() < 1e-3 * np.abs(K @ shape).max()
        name = next(name for name in grid.point_data if name.startswith(f"mode {k + 1},"))
        drawn = grid.point_data[name][np.searchsorted(nodes, mode["node_nums"])]
        assert drawn == pytest.approx(np.column_stack([mode[f"r{i}"] for i in (1, 2, 3)]), abs=1e-4)


def test_an_export_says_what_it_lacks(small: Path, tmp_path: Path) -> None:
    assert "results of a finished run" in str(modefront("export", small).exception)


# CalculiX


def ccx(folder: Path, *jobs: str) -> None:
    for job in jobs:
        subprocess.run([str(CCX), job], cwd=folder, check=True, capture_output=True)


def printed(path: Path) -> tuple[list[float], list[dict[int, list[float]]]]:
    """Return frequencies and displacements of all modes that CalculiX prints into a .dat file."""
    head, *blocks = path.read_text().split("E I G E N V A L U E    N U M B E R")
    rows = [line.split() for line in head.split("P A R T I C I P A T I O N")[0].splitlines()]
    frequencies = [float(row[3]) for row in rows if len(row) == 5 and row[0].isdigit()]
    shapes = []
    for block in blocks:
        lines = [line.split() for line in block.splitlines()]
        shapes.append({int(x[0]): list(map(float, x[1:])) for x in lines if len(x) == 4})
    return frequencies, shapes


RUNS = ("plate", "columns", "spring", "mass")


@needs_ccx
def test_from_decks_of_calculix_to_true_parameters(tmp_path: Path) -> None:
    write_example("calculix", tmp_path / "decks")
    decks, study = tmp_path / "decks", tmp_path / "imported"
    ccx(decks, "nominal", *RUNS, "check", "frequencies", "true")
    result = modefront(
        *("import", "calculix", decks / "nominal.inp", "-o", study),
        *(x for name in RUNS for x in ("--parameter", f"{name}={decks / name}")),
        *("--check", f"{decks / 'check'}:plate=1.5,columns=0.7,spring=3,mass=0.5"),
    )
    assert result.exit_code == 0, result.output + str(result.exception)
    assert re.search(
        r"the run for checking is what the terms say, to \d\.\de-1[3-6]", result.output
    )
    assert "spring: stiffness, at 1 degree of freedom, of rank 1" in result.output

    frequencies, _ = printed(decks / "frequencies.dat")
    shown = re.search(r"frequencies of the nominal model: (.*) Hz", result.output)
    assert shown
    assert [float(x) for x in shown[1].split()] == pytest.approx(frequencies[:6], rel=2e-5)

    # Nodes of the plate, one with the mass and one with the spring, and of a column.
    nodes = [(3, 2), (8, 2), (12, 2), (18, 2), (1, 0), (5, 1), (10, 0), (401, 0), (402, 1)]
    measured, shapes = printed(decks / "true.dat")
    rows = [
        [f, 0.01, *(shape[node][d] for node, d in nodes)]
        for f, shape in zip(measured[:6], shapes, strict=False)
    ]
    sensors = {f"n{n}{d}": f'{{ node = {n}, direction = "{"xyz"[d]}" }}' for n, d in nodes}
    problem = load(add_data(study, sensors, rows)).problem
    assert estimate(problem) == pytest.approx([0.85, 1.15, 1.4, 0.8], rel=2e-4)


def test_the_example_leads_to_the_true_parameters_within_its_errors(tmp_path: Path) -> None:
    write_example("calculix", tmp_path)
    study = load(tmp_path / "study.toml")
    assert check(study).warnings == ()
    assert estimate(study.problem) == pytest.approx([0.85, 1.15, 1.4, 0.8], rel=0.02)
    text = study.file.read_text(encoding="utf-8").replace("n3z = { node = 3,", "n3z = { node = 13,")
    study.file.write_text(text, encoding="utf-8")
    (warning,) = check(study.file).warnings
    assert warning.startswith("sensor n3z fits the data at node 3 and not at node 13, where the")


@needs_ccx
def test_the_example_holds_what_calculix_writes(tmp_path: Path) -> None:
    write_example("calculix", tmp_path)
    ccx(tmp_path, "nominal")
    nominal = modefront(
        *("import", "calculix", tmp_path / "nominal", "--parameter"),
        *(f"mass={tmp_path / 'nominal'}", "-o", tmp_path / "o"),
    )
    assert "found the same" in str(nominal.exception)
    dofs, mesh = read_dofs(tmp_path / "dofs.csv"), read_mesh(tmp_path / "mesh.npz")
    labels = [line.split(".") for line in (tmp_path / "nominal.dof").read_text().split()]
    assert np.abs(dofs.node).tolist() == [int(node) for node, _ in labels]
    assert mesh.number.size == 33
    number, motion = node_motion(dofs, mesh, np.ones((dofs.size, 1)))
    moving = motion[0, :, :3].any(axis=1)
    assert number[~moving].tolist() == [100, 200, 300, 400, 901], "the supports"
    assert motion[0, moving, :3] == pytest.approx(1.0)


CANTILEVER = """*NODE, NSET=NALL
1, 0., 0., 0.
2, .3, 0., 0.
3, .7, 0., 0.
4, 1., 0., 0.
5, 0., .5, 0.
6, .3, .5, 0.
7, .7, .5, 0.
8, 1., .5, 0.
500, 1., .2, .2
*ELEMENT, TYPE=S4, ELSET=PLATE
1, 1,2,6,5
2, 2,3,7,6
3, 3,4,8,7
*MATERIAL, NAME=STEEL
*ELASTIC
2.1E11, 0.3
*DENSITY
7800.
*SHELL SECTION, ELSET=PLATE, MATERIAL=STEEL
0.01
*NSET, NSET=EDGE
4, 8
*BOUNDARY
1,1,6
5,1,6
"""


@needs_ccx
@pytest.mark.parametrize(
    ("constraint", "refused"),
    [
        ("*EQUATION\n2\n8,3,1.,4,3,-1.\n", {(8, "z")}),
        (
            "*RIGID BODY, NSET=EDGE, REF NODE=500\n",
            {(node, d) for node in (4, 8, 500) for d in "xyz"},
        ),
        ("*ELEMENT, TYPE=MASS, ELSET=M\n9, 8\n*MASS, ELSET=M\n2.\n", set()),
    ],
)
def test_sensors_at_nodes_of_shells_that_are_tied(
    constraint: str, refused: set[tuple[int, str]], tmp_path: Path
) -> None:
    deck = CANTILEVER + constraint
    matrices = "*STEP\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n*END STEP\n"
    (tmp_path / "a.inp").write_text(deck + matrices)
    (tmp_path / "b.inp").write_text(
        deck + "*STEP\n*FREQUENCY\n3\n*NODE PRINT, NSET=NALL\nU\n*END STEP\n"
    )
    ccx(tmp_path, "a", "b")
    job = read_job("calculix", tmp_path / "a", JobOptions())
    _, shapes = printed(tmp_path / "b.dat")
    _, vectors = scipy.linalg.eigh(dense(job.mass), dense(job.stiffness))
    nodes = (2, 3, 4, 6, 7, 8, 500)
    places = {}
    for node, direction in ((n, d) for n in nodes for d in "xyz"):
        try:
            places[node, direction] = job.dofs.sensor(node, direction)
        except LookupError:
            continue
    assert refused <= {(n, d) for n in nodes for d in "xyz"} - places.keys()
    assert {(n, d) for n in (2, 3, 6, 7) for d in "xyz"} <= places.keys()
    # Modes of the rigid body about its edge are too close for shapes of seven digits.
    for k in range(0 if "RIGID" in constraint else 3):
        phi = vectors[:, -1 - k]
        mine = [sum(w * phi[dof] for dof, w in place) for place in places.values()]
        right = [shapes[k][node]["xyz".index(direction)] for node, direction in places]
        assert abs(np.dot(mine, right)) == pytest.approx(
            np.linalg.norm(mine) * np.linalg.norm(right), rel=1e-6
        )


@needs_ccx
def test_thickness_of_shells_of_calculix(tmp_path: Path) -> None:
    deck = """*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 2., 0., 0.
4, 0., 1., 0.
5, 1., 1., 0.
6, 2., 1., 0.
*ELEMENT, TYPE=S4, ELSET=PLATE
1, 1,2,5,4
2, 2,3,6,5
*MATERIAL, NAME=STEEL
*ELASTIC
2.1E11, 0.3
*DENSITY
7800.
*SHELL SECTION, ELSET=PLATE, MATERIAL=STEEL
THICKNESS
*BOUNDARY
1,1,6
4,1,6
*STEP
*FREQUENCY, SOLVER=MATRIXSTORAGE
*END STEP
"""
    for name, t in (("base", 0.01), ("two", 0.02), ("three", 0.03), ("check", 0.015)):
        (tmp_path / f"{name}.inp").write_text(deck.replace("THICKNESS", str(t)))
    ccx(tmp_path, "base", "two", "three", "check")
    common = ["import", "calculix", tmp_path / "base", "--parameter", f"t={tmp_path / 'two'}"]
    check = ["--check", f"{tmp_path / 'check'}:t=1.5"]
    refused = modefront(*common, *check, "-o", tmp_path / "one")
    assert "affine in 't'" in str(refused.exception)
    runs = ["--parameter", f"t={tmp_path / 'three'}", "--factor", "t=2", "--factor", "t=3"]
    result = modefront(
        *common, *runs, "--function", "t=t,1/t", *check, "-o", tmp_path / "two-terms"
    )
    assert result.exit_code == 0, result.output + str(result.exception)
    assert "1/t: stiffness" in result.output


# Files of Nastran and Ansys


@needs_data
def test_the_plate_of_nastran(tmp_path: Path) -> None:
    for suffix in (".op4", ".dat"):
        shutil.copy(DATA / f"nastran_plate{suffix}", tmp_path / f"plate{suffix}")
    _stiffer_spring(tmp_path / "plate.op4", tmp_path / "spring.op4")
    shutil.copy(DATA / "nastran_plate.dat", tmp_path / "spring.dat")
    result = modefront(
        *("import", "nastran", tmp_path / "plate.op4", "--parameter"),
        *(f"spring={tmp_path / 'spring.op4'}", "--factor", "spring=3", "-o", tmp_path / "study"),
    )
    assert result.exit_code == 0, result.output + str(result.exception)
    shown = re.search(r"frequencies of the nominal model: (.*) Hz", result.output)
    lines = (DATA / "nastran_plate_frequencies.txt").read_text().splitlines()
    right = [float(line) for line in lines if not line.startswith("#")]
    assert shown
    assert [float(x) for x in shown[1].split()] == pytest.approx(right, rel=2e-5)
    assert "spring: stiffness, at 1 degree of freedom, of rank 1" in result.output
    dofs = read_dofs(tmp_path / "study" / "dofs.csv")
    ((dof, weight),) = dofs.sensor(25, "z")
    term = scipy.sparse.load_npz(tmp_path / "study" / "stiffness-spring.npz").tocoo()
    assert (dof, weight, dof) == (int(term.row[0]), 1.0, int(term.col[0]))
    assert term.data == pytest.approx([1e5])
    with pytest.raises(LookupError, match="rz, which is held or not in the model"):
        dofs.sensor(13, "rz")
    assert read_mesh(tmp_path / "study" / "mesh.npz").cells["quad"].shape == (16, 4)


def _stiffer_spring(source: Path, target: Path) -> None:
    """Copy a file with the spring at node 25 z (row 114 of KAA) at three times its stiffness."""
    job = read_job("nastran", source, JobOptions())
    K = dense(job.stiffness)
    K[113, 113] += 2e5
    write_op4(target, {"KAA": K, "MAA": dense(job.mass)}, "sparse")


@needs_data
def test_a_deck_that_does_not_fit_its_matrices(tmp_path: Path) -> None:
    shutil.copy(DATA / "nastran_plate.op4", tmp_path / "plate.op4")
    deck = (DATA / "nastran_plate.dat").read_text()
    command = [
        "import",
        "nastran",
        tmp_path / "plate",
        "--parameter",
        "E=none",
        "-o",
        tmp_path / "o",
    ]
    (tmp_path / "plate.dat").write_text(deck.replace("SPC1,1,12,5,10", "SPC1,1,12,5"))
    text = str(modefront(*command).exception)
    assert "134 degrees of freedom, as the matrices have, in the deck (or --dofs FILE)" in text
    (tmp_path / "plate.dat").write_text(deck.replace("SPC1,1,12,5,10", "SPC1,1,12,22,10"))
    assert "a stiffness matrix that fits the nodes" in str(modefront(*command).exception)


@needs_data
def test_the_solid_of_ansys() -> None:
    job = read_job("ansys", DATA / "ansys.full", JobOptions())
    assert (job.dofs.size, scipy.sparse.triu(job.stiffness).nnz) == (900, 39023 - 63)
    M = job.mass
    masses = [M[job.dofs.direction == d][:, job.dofs.direction == d].sum() for d in (1, 2, 3)]
    assert masses == pytest.approx([masses[0]] * 3)
    K = job.stiffness
    residue = K @ (job.dofs.direction == 1).astype(float)
    assert (np.abs(residue) > 1e-6 * (abs(K) @ np.ones(900))).sum() < 100, "near the supports only"
