"""Right files of every format that is read, and what becomes of them by chance."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import scipy.io
import scipy.sparse

K = 1000.0 * np.array([[5.0, -2.0], [-2.0, 2.0]])
M = np.diag([2.0, 1.0])

STUDY = """\
[study]
name = "two masses"
seed = 1

[data]
file = "modes.csv"

[model]
kind = "matrices"
stiffness = {{ k = "{matrix}" }}
mass = {{ base = "M.npy" }}
sensors = {{ low = 0, top = [[0, 0.5], [1, 0.5]] }}

[[parameter]]
name = "k"
nominal = 1.0
bounds = [0.2, 5.0]

[[group]]
name = "frequencies"
frequency = "all"

[pareto]
points = 2
"""

MESH = """\
[study]
name = "beam"

[data]
file = "modes.csv"

[model]
kind = "mesh"
file = "{mesh}"
sensors = {{ low = {{ node = 1, direction = "y" }}, top = {{ node = 2, direction = "y" }} }}
material = {{ steel = {{ E = 2e11, nu = 0.3, rho = 7850.0 }} }}
scale = {{ k = {{ quantity = "E", of = ["all"] }} }}

[[model.group]]
name = "all"
elements = "beam"
material = "steel"
section = {{ shape = "circle", diameter = 0.1 }}

[[model.support]]
nodes = [0]

[[parameter]]
name = "k"
nominal = 1.0
bounds = [0.2, 5.0]

[[group]]
name = "frequencies"
frequency = "all"
"""

DATA = """\
set,mode,frequency,damping,low,top,frequency_std
a,1,4.0,0.01,0.5,1.0,0.1
a,2,11.0,,1.0,-0.5,
"""

MATRICES = ("K.mtx", "K.npy", "K.npz", "K.mat", "K73.mat")
MESHES = ("beam.msh", "beam.vtk", "beam.inp", "beam.ply")

Case = tuple[str, tuple[str, ...]]
"""A file that is spoilt, and the command that reads it."""


def right_files(folder: Path) -> list[Case]:
    """Write files in which nothing is wrong, and return which commands read each of them."""
    (folder / "modes.csv").write_text(DATA)
    np.save(folder / "M.npy", M)
    scipy.io.mmwrite(folder / "K.mtx", scipy.sparse.coo_array(K))
    np.save(folder / "K.npy", K)
    scipy.sparse.save_npz(folder / "K.npz", scipy.sparse.csr_array(K))
    scipy.io.savemat(folder / "K.mat", {"K": scipy.sparse.csc_array(K), "z": "text"})
    with h5py.File(folder / "K73.mat", "w", userblock_size=512) as file:
        file["K"] = K
    cases: list[Case] = []
    for matrix in MATRICES:
        name = f"{matrix.replace('.', '-')}.toml"
        (folder / name).write_text(STUDY.format(matrix=matrix))
        cases.append((matrix, ("check", name)))
    cases += [("K-npy.toml", ("check", "K-npy.toml")), ("modes.csv", ("check", "K-npy.toml"))]
    lines = [f"{f / 10},{np.cos(f)},{np.sin(f)},{-np.sin(f)},{np.cos(f)}" for f in range(1, 60)]
    header = "frequency,low_re,low_im,top_re,top_im"
    (folder / "frf.csv").write_text("\n".join([header, *lines]))
    cases.append(("frf.csv", ("identify", "frf.csv", "-o", "identified.csv")))
    cases += _meshes(folder)
    return cases


def _meshes(folder: Path) -> list[Case]:
    import meshio

    mesh = meshio.Mesh(np.eye(3)[[0, 0, 0]] * [[0], [1], [2]], [("line", [[0, 1], [1, 2]])])
    out: list[Case] = []
    for name in MESHES:
        form = {"msh": "gmsh22", "vtk": "vtk42", "inp": "abaqus"}.get(name[5:])
        if form is None:
            triangle = meshio.Mesh(np.eye(3), [("triangle", [[0, 1, 2]])])
            triangle.write(folder / name, file_format="ply", binary=False)
        else:
            options = {} if form == "abaqus" else {"binary": False}
            mesh.write(folder / name, file_format=form, **options)
        (folder / f"{name[5:]}.toml").write_text(MESH.format(mesh=name))
        out.append((name, ("check", f"{name[5:]}.toml")))
    return out


def run_study(folder: Path) -> list[Case]:
    """Run a study and return which commands read its results."""
    command = [sys.executable, "-m", "modefront", "run", "K-npy.toml", "-o", "results"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    results = "results/results.nc"
    return [
        (results, ("show", "results")),
        (results, ("show", "results", "--format", "json")),
        (results, ("compare", "results", "results")),
    ]


WORDS = (
    *(
        b"*",
        b"\x1a",
        b"\x00",
        b"\xff" * 8,
        b"nan",
        b"inf",
        b"1e999",
        b"-1",
        b"99999999999999999999",
    ),
    *(b"\x1b]0;x\x07", b"\xc2\x9b31m", b"\n" * 50, b"[" * 2000, b"{" * 200, b'"', b",", b"%%"),
    *(b"a" * 5000, b"\xed\xb2\x80", b"../../etc/passwd", b"/dev/zero", b"*INCLUDE, INPUT=x\n"),
)
"""What is put into files."""


def mutated(content: bytes, rng: np.random.Generator) -> bytes:
    """Return content of which some is flipped, cut, doubled, moved, or replaced by `WORDS`."""
    out = bytearray(content)
    for _ in range(int(rng.integers(1, 5))):
        at = int(rng.integers(len(out) + 1))
        length = int(rng.integers(1, 40))
        kind = int(rng.integers(8))
        if kind == 0 and out:
            out[at % len(out)] ^= 1 << int(rng.integers(8))
        elif kind == 1 and out:
            out[at % len(out)] = int(rng.integers(256))
        elif kind == 2:
            del out[at:]
        elif kind == 3:
            del out[at : at + length]
        elif kind == 4:
            out[at:at] = out[at : at + length]
        elif kind == 5:
            out[at:at] = rng.bytes(length)
        else:
            word = WORDS[int(rng.integers(len(WORDS)))]
            out[at : at + (len(word) if kind == 6 else 0)] = word
    return bytes(out)
