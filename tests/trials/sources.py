"""Right files of every format that is read, and the commands that read them."""

from __future__ import annotations

import contextlib
import io
import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np
import scipy.io
import scipy.sparse
from faultless import DATA, K0, K1, K2, PREDICTIONS, M
from faultless import STUDY as FULL
from program_files import (
    labels,
    structure,
    write_abaqus,
    write_ansys,
    write_calculix,
    write_dmig,
    write_op4,
    write_op4_text,
    write_opensees,
)
from simulation import THREE_STORY, accelerance, three_story_shapes

STUDY = """\
[study]
name = "two masses"
seed = 1

[data]
file = "{data}"
{channels}
[model]
kind = "matrices"
stiffness = {{ base = "B.npy", k = "{matrix}" }}
mass = {{ base = "M.npy" }}
{sensors}

[[parameter]]
name = "k"
nominal = 1.0
bounds = [0.2, 5.0]

[[group]]
name = "frequencies"
frequency = "all"

[[group]]
name = "shapes"
shape = "all"

[pareto]
points = 2

[search]
doubt = 0.5
"""

SENSORS = "sensors = { low = 0, top = [[0, 0.5], [1, 0.5]] }"

MESH = """\
[study]
name = "{name}"

[data]
file = "of-meshes.csv"

[model]
kind = "mesh"
file = "{name}"
sensors = {{ low = {{ node = 1, direction = "{direction}" }} }}
material = {{ steel = {{ E = 2e11, nu = 0.3, rho = 7850.0 }} }}
scale = {{ k = {{ quantity = "E", of = ["all"] }} }}

[[model.group]]
name = "all"
elements = "{kind}"
material = "steel"
{section}

[[model.support]]
nodes = [0{held}]

[[parameter]]
name = "k"
nominal = 1.0
bounds = [0.2, 5.0]

[[group]]
name = "frequencies"
frequency = "all"
"""

TEST = """\
[test]
name = "blows"
quantity = "accelerance"

[identify]
band = [1.0, 24.0]
modes = 3

[[set]]
name = "a"
files = ["frf.csv"]
reference = ["top"]
"""

CHANNELS = """
[sensors]
low = "1Z"
middle = "2Z"
top = "3Z"
"""

NODES = {"low": 3, "top": 7}
"""Nodes of sensors."""

K = 1000.0 * np.array([[5.0, -2.0], [-2.0, 2.0]])


@dataclass(frozen=True)
class Case:
    """A file that is spoilt, and the command that reads it.

    Attributes
    ----------
    file : in the folder of all of them
    command : arguments of ``modefront``
    written : what the command writes, and is removed before the next one
    """

    file: str
    command: tuple[str, ...]
    written: str = ""


def right_files(folder: Path) -> list[Case]:
    """Write files in which nothing is wrong, and return which commands read each of them."""
    return [
        *_studies(folder),
        *_matrices(folder),
        *_functions(folder),
        *_meshes(folder),
        *_jobs(folder),
        *run_study(folder),
    ]


def _studies(folder: Path) -> list[Case]:
    (folder / "modes.csv").write_text(DATA)
    (folder / "full.toml").write_text(FULL)
    short = FULL.replace(PREDICTIONS, "").replace("draws = 3\n", "")
    (folder / "short.toml").write_text(short)
    modes = folder / "modes.uff"
    modes.write_text(_uff55())
    np.save(folder / "M.npy", M)
    np.save(folder / "B.npy", K1)
    np.save(folder / "K.npy", K)
    places = ", ".join(f'{x} = {{ node = {n}, direction = "x" }}' for x, n in NODES.items())
    sensors = f'sensors = {{ {places} }}\ndofs = "dofs.csv"'
    (folder / "dofs.csv").write_text("node,direction\n3,x\n7,x\n")
    text = STUDY.format(
        data="modes.uff",
        channels='sensors = { low = "3X", top = "7X" }',
        matrix="K.npy",
        sensors=sensors,
    )
    (folder / "uff.toml").write_text(text)
    (folder / "K-npy.toml").write_text(
        STUDY.format(data="modes.csv", channels="", matrix="K.npy", sensors=SENSORS)
    )
    _runs(folder)
    return [
        Case("full.toml", ("check", "full.toml")),
        Case("short.toml", ("check", "short.toml")),
        Case("K-npy.toml", ("check", "K-npy.toml")),
        Case("modes.csv", ("check", "K-npy.toml")),
        Case("modes.uff", ("check", "uff.toml")),
        Case("dofs.csv", ("check", "uff.toml")),
    ]


def _runs(folder: Path) -> None:
    """Write the studies of `RUNS` that are not among the others."""
    small = (folder / "K-npy.toml").read_text()
    search = small[small.index("[search]") :]
    whole = (
        FULL.replace(PREDICTIONS, "")
        .replace("draws = 3\n", "")
        .replace("models = 50", "models = 8")
    )
    whole = whole[: whole.index("[search]")] + search + whole[whole.index("[identifiability]") :]
    (folder / "chain.toml").write_text(whole.replace("points = 5", "points = 3"))
    evolution = 'method = "nsga2"\npoints = 3\npopulation = 8\nevaluations = 60'
    (folder / "nsga2.toml").write_text(small.replace("points = 2", evolution))
    passage = PREDICTIONS.replace("samples = 20", "samples = 4").replace("0.02", "0.01")
    outputs = "outputs = { middle = [[0, 0.7], [1, 0.3]] }\nbase = { x = [0, 1] }\n\n[[parameter]]"
    predicting = small.replace("[[parameter]]", outputs, 1)
    (folder / "predict.toml").write_text(predicting + "\n" + passage)


def _uff55() -> str:
    """Return two modes at two nodes, as a universal file has them."""
    out = []
    for mode, (f, low, top) in enumerate([(4.0, 0.5, 1.0), (11.0, 1.0, -0.5)], start=1):
        out += ["    -1", "    55", *["NONE"] * 5]
        out += [f"{1:10d}{2:10d}{2:10d}{8:10d}{2:10d}{3:10d}", f"{2:10d}{4:10d}{0:10d}{mode:10d}"]
        out += ["".join(f"{x:13.5E}" for x in (f, 1.0, 0.01, 0.0))]
        for node, value in ((3, low), (7, top)):
            out += [f"{node:10d}", "".join(f"{x:13.5E}" for x in (value, 0.0, 0.1))]
        out += ["    -1"]
    return "\n".join(out) + "\n"


def _matrices(folder: Path) -> list[Case]:
    """Write K in every format of matrices."""
    sparse = scipy.sparse.csc_array(K)
    scipy.io.mmwrite(folder / "K.mtx", scipy.sparse.coo_array(K))
    scipy.io.mmwrite(folder / "array.mtx", K)
    scipy.sparse.save_npz(folder / "K.npz", scipy.sparse.csr_array(K))
    scipy.sparse.save_npz(folder / "coo.npz", scipy.sparse.coo_array(K), compressed=False)
    scipy.io.savemat(folder / "K.mat", {"K": sparse, "z": "text"})
    scipy.io.savemat(folder / "packed.mat", {"K": K}, do_compression=True)
    with h5py.File(folder / "K73.mat", "w", userblock_size=512) as file:
        file["K"] = K
    with h5py.File(folder / "sparse73.mat", "w", userblock_size=512) as file:
        group = file.create_group("K")
        group.attrs["MATLAB_sparse"] = np.uint64(2)
        parts = {"data": sparse.data, "ir": sparse.indices, "jc": sparse.indptr}
        for name, part in parts.items():
            values = part if name == "data" else part.astype("u8")
            group.create_dataset(name, data=values, chunks=(2,), compression="gzip")
    names = ["K.mtx", "array.mtx", "K.npy", "K.npz", "coo.npz"]
    names += ["K.mat", "packed.mat", "K73.mat", "sparse73.mat"]
    cases = []
    for name in names:
        study = f"of-{name.replace('.', '-')}.toml"
        text = STUDY.format(data="modes.csv", channels="", matrix=name, sensors=SENSORS)
        (folder / study).write_text(text)
        cases.append(Case(name, ("check", study)))
    for name, A in (("K0", K0), ("K1", K1), ("K2", K2)):
        scipy.io.mmwrite(folder / f"{name}.mtx", scipy.sparse.coo_array(A))
    return cases


def _functions(folder: Path) -> list[Case]:
    """Write frequency response functions as CSV and in universal files, and a test file."""
    f = np.arange(1.0, 24.0, 0.25)
    H = accelerance(f, THREE_STORY, np.array([0.02, 0.02, 0.02]), three_story_shapes(), [2])[0]
    names = ("low", "middle", "top")
    header = ",".join(["frequency", *(f"{name}_{part}" for name in names for part in ("re", "im"))])
    columns = np.column_stack([f, *(part for row in H for part in (row.real, row.imag))])
    lines = [",".join(f"{x:.9g}" for x in row) for row in columns]
    (folder / "frf.csv").write_text("\n".join([header, *lines]) + "\n")
    (folder / "frf.uff").write_text("".join(_uff58(k, row, f) for k, row in enumerate(H, start=1)))
    (folder / "test.toml").write_text(TEST)
    uff = TEST.replace('"frf.csv"', '"frf.uff"').replace('reference = ["top"]\n', "")
    (folder / "test-uff.toml").write_text(uff + CHANNELS)
    out = "identified.csv"
    return [
        Case("test.toml", ("identify", "test.toml", "-o", out), out),
        Case("frf.csv", ("identify", "test.toml", "-o", out), out),
        Case("frf.uff", ("identify", "test-uff.toml", "-o", out), out),
    ]


def _uff58(node: int, H: np.ndarray, f: np.ndarray) -> str:
    values = [f"{x:13.5E}" for pair in zip(H.real, H.imag, strict=True) for x in pair]
    body = "\n".join("".join(values[k : k + 6]) for k in range(0, len(values), 6))
    return (
        "    -1\n    58\nNONE\nNONE\n01-Jan-26 00:00:00\nNONE\nNONE\n"
        f"    4         0    0         0 NONE      {node:10d}   3 NONE               3   3\n"
        f"         5{len(H):10d}         1{f[0]:13.5E}{f[1] - f[0]:13.5E}  0.00000E+00\n"
        "        18    0    0    0 NONE                 Hz                  \n"
        "        12    0    0    0 NONE                 NONE                \n"
        "        13    0    0    0 NONE                 NONE                \n"
        "         0    0    0    0 NONE                 NONE                \n"
        f"{body}\n    -1\n"
    )


def _meshes(folder: Path) -> list[Case]:
    """Write a beam, a plate and a brick in formats of meshes."""
    import meshio

    (folder / "of-meshes.csv").write_text("set,mode,frequency,damping,low\na,1,40.0,0.01,1.0\n")
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    box = np.vstack([corners, corners + np.array([0, 0, 1])])
    beam = meshio.Mesh([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [("line", [[0, 1], [1, 2]])])
    plate = meshio.Mesh(corners, [("triangle", [[0, 1, 2], [0, 2, 3]])])
    brick = meshio.Mesh(box, [("hexahedron", [[0, 1, 2, 3, 4, 5, 6, 7]])])
    circle = 'section = { shape = "circle", diameter = 0.1 }'
    of_beam = {"kind": "beam", "direction": "y", "held": "", "section": circle}
    of_plate = {"kind": "shell", "direction": "z", "held": ", 3", "section": "thickness = 0.02"}
    of_brick = {"kind": "solid", "direction": "x", "held": ", 3, 4, 7", "section": ""}
    forms = {
        "beam.msh": ("gmsh22", of_beam, beam),
        "bin.msh": ("gmsh", of_beam, beam),
        "beam.vtk": ("vtk42", of_beam, beam),
        "bin.vtu": ("vtu", of_brick, brick),
        "beam.inp": ("abaqus", of_beam, beam),
        "plate.ply": ("ply", of_plate, plate),
        "brick.med": ("med", of_brick, brick),
        "plate.bdf": ("nastran", of_plate, plate),
        "plate.stl": ("stl", of_plate, plate),
        "brick.mesh": ("medit", of_brick, brick),
    }
    cases = []
    for name, (form, parts, mesh) in forms.items():
        options = {"binary": False} if form in ("gmsh22", "vtk42", "ply", "stl") else {}
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            mesh.write(folder / name, file_format=form, **options)
        study = f"of-{name.replace('.', '-')}.toml"
        (folder / study).write_text(MESH.format(name=name, **parts))
        cases.append(Case(name, ("check", study)))
    return cases


@dataclass(frozen=True)
class Job:
    """How the jobs of a program are written.

    Attributes
    ----------
    program : its name
    given : what the command line is given, for the name of a job
    write : writes the files of a job, given its name, stiffness and mass
    files : those of a job
    """

    program: str
    given: str
    write: Callable[[Path, np.ndarray, np.ndarray], None]
    files: tuple[str, ...]


def _opensees(path: Path, K: np.ndarray, M: np.ndarray) -> None:
    write_opensees(path, K, M, labels())
    Path(f"{path}_nodes.csv").write_text("12,0,0,0\n3,1,0,0\n7,1,1,0\n40,0,1,0\n5,2,0,1\n")
    Path(f"{path}_elements.csv").write_text("1,12,3\n2,12,3,7,40\n")


def _calculix(path: Path, K: np.ndarray, M: np.ndarray) -> None:
    write_calculix(path, K, M, labels())
    nodes = "".join(f"{n}, {k}., 0., 1.\n" for k, n in enumerate((12, 3, 7, 40, 5)))
    deck = f"*NODE\n{nodes}*ELEMENT, TYPE=C3D4\n1, 12, 3, 7, 40\n*SPRING\n"
    path.with_name(f"{path.name}.inp").write_text(deck)


def _punched(path: Path, K: np.ndarray, M: np.ndarray) -> None:
    write_dmig(path.with_name(f"{path.name}.pch"), {"KAAX": K, "MAAX": M}, labels())
    grids = "".join(f"GRID,{n},,{k}.,0.,1.\n" for k, n in enumerate((12, 3, 7, 40, 5)))
    deck = f"BEGIN BULK\n{grids}CTETRA,1,1,12,3,7,40\nSPC1,1,123,12,THRU,13\nENDDATA\n"
    path.with_name(f"{path.name}.bdf").write_text(deck)


def _binary(path: Path, K: np.ndarray, M: np.ndarray) -> None:
    write_op4(path.with_name(f"{path.name}.op4"), {"KAA": K, "MAA": M}, "sparse")


def _text(path: Path, K: np.ndarray, M: np.ndarray) -> None:
    write_op4_text(path.with_name(f"{path.name}.op4"), {"KAA": K, "MAA": M}, "bigmat")


def _ansys(path: Path, K: np.ndarray, M: np.ndarray) -> None:
    write_ansys(path.with_name(f"{path.name}.full"), K, M, labels())


def _abaqus(path: Path, K: np.ndarray, M: np.ndarray) -> None:
    write_abaqus(path, K, M, labels())


JOBS = {
    "cal": Job("calculix", "{}", _calculix, ("{}.sti", "{}.mas", "{}.dof", "{}.inp")),
    "aba": Job("abaqus", "{}", _abaqus, ("{}_STIF1.mtx", "{}_MASS1.mtx")),
    "bin": Job("nastran", "{}.op4", _binary, ("{}.op4",)),
    "txt": Job("nastran", "{}.op4", _text, ("{}.op4",)),
    "pch": Job("nastran", "{}.pch", _punched, ("{}.pch", "{}.bdf")),
    "ans": Job("ansys", "{}.full", _ansys, ("{}.full",)),
    "ops": Job(
        *("opensees", "{}", _opensees),
        ("{}_K.npz", "{}_dofs.csv", "{}_nodes.csv", "{}_elements.csv"),
    ),
}


def _jobs(folder: Path) -> list[Case]:
    """Write jobs of all programs, with one parameter."""
    cases = []
    for short, job in JOBS.items():
        base, run = f"{short}-base", f"{short}-E"
        job.write(folder / base, *structure())
        job.write(folder / run, *structure(E=2.0))
        given = job.given.format(base), "--parameter", f"E={job.given.format(run)}"
        command = ("import", job.program, *given, "--modes", "2", "-o", "imported")
        cases += [Case(file.format(base), command, "imported") for file in job.files]
    return cases


def run_study(folder: Path) -> list[Case]:
    """Run a study and return which commands read its results."""
    command = [sys.executable, "-m", "modefront", "run", "K-npy.toml", "-o", "results"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    kept = sorted((folder / "results" / "tasks").rglob("*.npz"))
    results = "results/results.nc"
    again = ("run", "K-npy.toml", "-o", "results")
    return [
        Case(results, ("show", "results", "--all")),
        Case(results, ("show", "results", "--format", "json")),
        Case(results, ("compare", "results", "results")),
        Case(results, again),
        Case(os.fspath(kept[0].relative_to(folder)), again),
        Case(os.fspath(kept[-1].relative_to(folder)), again),
    ]


READING = (
    ("show", "results", "--all"),
    ("show", "results", "--format", "json"),
    ("compare", "results", "results"),
    ("show", "results", "--figures", "--figure-format", "png"),
    ("report", "results"),
    ("export", "results"),
)
"""Commands that read results."""

RUNS = ("K-npy.toml", "chain.toml", "nsga2.toml", "predict.toml", "of-beam-msh.toml")
"""Studies of several kinds, which are run in seconds."""
