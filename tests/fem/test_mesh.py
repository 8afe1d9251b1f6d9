"""Meshes from files: groups by name, and messages for files that are none."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest
from structures import STEEL, frequencies

from modefront import fem
from modefront.errors import InputError
from modefront.fem.mesh import Mesh, read_mesh
from modefront.fem.structure import Cells
from modefront.work.isolated import isolated

meshio = pytest.importorskip("meshio")

X, QUADS = fem.grids.plate(1.0, 1.0, 4, 4)
TRIANGLES = fem.grids.triangles(QUADS[8:])
EDGE = np.array([[0, 1], [1, 2], [2, 3], [3, 4]])


def _write(path: Path, form: str) -> None:
    cells = [("line", EDGE), ("quad", QUADS[:8]), ("triangle", TRIANGLES)]
    if form == "vtk":
        meshio.Mesh(X, cells[1:]).write(path)
        return
    if form == "abaqus":
        # By hand: meshio writes sets of cells of several types with wrong numbers.
        def table(first: int, rows: Iterable[Iterable[float]]) -> str:
            return "".join(
                f"{n}, {', '.join(map(str, row))}\n" for n, row in enumerate(rows, first)
            )

        path.write_text(
            f"*NODE\n{table(1, X.tolist())}"
            f"*ELEMENT, TYPE=B31\n{table(1, (EDGE + 1).tolist())}"
            f"*ELEMENT, TYPE=S4\n{table(5, (QUADS[:8] + 1).tolist())}"
            f"*ELEMENT, TYPE=S3\n{table(13, (TRIANGLES + 1).tolist())}"
            "*ELSET, ELSET=root, GENERATE\n1, 4, 1\n"
            "*ELSET, ELSET=plate, GENERATE\n5, 28, 1\n"
            "*NSET, NSET=tip\n25\n"
        )
        return
    tags = [np.full(4, 1), np.full(8, 2), np.full(16, 2)]
    meshio.Mesh(
        X,
        cells,
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
        field_data={"root": np.array([1, 1]), "plate": np.array([2, 2])},
    ).write(path, file_format="gmsh22", binary=False)


@pytest.mark.parametrize(("form", "suffix"), [("gmsh", "msh"), ("abaqus", "inp")])
def test_groups_by_name(tmp_path: Path, form: str, suffix: str) -> None:
    path = tmp_path / f"plate.{suffix}"
    _write(path, form)
    mesh = read_mesh(path)
    blocks = mesh.cells_of("plate", "shell")
    assert [b.shape for b in blocks] == [(8, 4), (16, 3)]
    assert mesh.nodes_of("root").tolist() == [0, 1, 2, 3, 4]
    groups = tuple(fem.Shells("plate", cells, STEEL, 0.01) for cells in blocks)
    read = fem.Structure(mesh.nodes, groups, (fem.Support(mesh.nodes_of("root")),))
    direct = fem.Structure(
        X,
        (
            fem.Shells("plate", QUADS[:8], STEEL, 0.01),
            fem.Shells("plate", TRIANGLES, STEEL, 0.01),
        ),
        (fem.Support(np.arange(5)),),
    )
    expected = frequencies(fem.assemble(direct), 3)
    assert frequencies(fem.assemble(read), 3) == pytest.approx(expected, rel=1e-6)
    with pytest.raises(
        InputError, match=r"a group of the mesh \(plate, root\), found 'plat' \(did you"
    ):
        mesh.cells_of("plat", "shell")
    with pytest.raises(InputError, match="for a shell, found 'root' with cells of type line"):
        mesh.cells_of("root", "shell")
    with pytest.raises(InputError, match=r"a group or node set of the mesh .* found 'foot'"):
        mesh.nodes_of("foot")
    if form == "abaqus":
        assert mesh.nodes_of("tip").tolist() == [24]


def test_a_mesh_without_groups_is_one(tmp_path: Path) -> None:
    _write(tmp_path / "plate.vtk", "vtk")
    mesh = read_mesh(tmp_path / "plate.vtk")
    assert sorted(len(c) for c in mesh.cells_of("all", "shell")) == [8, 16]


def test_files_that_are_no_mesh(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(InputError, match="no such file"):
        read_mesh(tmp_path / "none.msh")
    (tmp_path / "broken.msh").write_text("this is no mesh\n")
    with pytest.raises(InputError, match=r"broken\.msh: file: expected a mesh"):
        read_mesh(tmp_path / "broken.msh")
    (tmp_path / "plate.docx").write_text("nor is this")
    with pytest.raises(InputError, match=r"plate\.docx: file: expected a mesh"):
        read_mesh(tmp_path / "plate.docx")
    assert capfd.readouterr() == ("", "")


def test_second_order_tetrahedra_keep_their_node_order(tmp_path: Path) -> None:
    nodes, bricks = fem.grids.box((1.0, 0.5, 0.5), (2, 1, 1))
    nodes, cells = fem.grids.tetrahedra(nodes, bricks)
    for form, suffix in (("gmsh", "msh"), ("vtk", "vtk")):
        path = tmp_path / f"box.{suffix}"
        meshio.Mesh(nodes, [("tetra10", cells)]).write(path, file_format=form)
        mesh = read_mesh(path)
        (result,) = mesh.cells_of("all", "solid")
        assert np.array_equal(result, cells)


@pytest.mark.parametrize(("kind", "error"), [("triangle6", 5e-3), ("quad8", 5e-3), ("quad9", 3e-3)])
def test_shells_of_nodes_between_corners_are_divided(kind: str, error: float) -> None:
    # A hinged plate of 8 x 8 cells is as good as one of 16 x 16 elements.
    nodes, _ = fem.grids.plate(1.0, 1.0, 16, 16)
    at = np.arange(17 * 17).reshape(17, 17)[:-2:2, :-2:2].reshape(-1, 1)
    square = at + np.array([0, 34, 36, 2, 17, 35, 19, 1, 18])
    cells = {
        "triangle6": np.concatenate([square[:, [0, 1, 2, 4, 5, 8]], square[:, [0, 2, 3, 8, 6, 7]]]),
        "quad8": square[:, :8],
        "quad9": square,
    }[kind]
    mesh = Mesh(nodes, (Cells("plate", kind, cells),), {})
    blocks = mesh.cells_of("plate", "shell")
    assert (
        sum(len(block) for block in blocks) == {"triangle6": 512, "quad8": 320, "quad9": 256}[kind]
    )
    groups = tuple(fem.Shells("plate", block, STEEL, 0.01) for block in blocks)
    used = np.unique(np.concatenate([block.ravel() for block in blocks]))
    edges = [(np.isclose(nodes[used, d], 0) | np.isclose(nodes[used, d], 1)) for d in (0, 1)]
    supports = (
        fem.Support(used, ("x", "y", "rz")),
        fem.Support(used[edges[0]], ("z", "rx")),
        fem.Support(used[edges[1]], ("z", "ry")),
    )
    found = frequencies(fem.assemble(fem.Structure(nodes, groups, supports)), 1)
    D = STEEL.E * 0.01**3 / (12 * (1 - STEEL.nu**2))
    assert found == pytest.approx(2 * np.pi**2 * np.sqrt(D / (STEEL.rho * 0.01)), rel=error)


INCLUDING = [
    ("a.inp", "*HEADING\nplate\n*include, input=secret.inp\n", "line 3: \\*include"),
    ("a.inp", "*NODE, NSET=all, INPUT=secret.txt\n", "line 1: \\*NODE"),
    ("a.bdf", "SOL 103\nINCLUDE 'secret.bdf'\nBEGIN BULK\n", "line 2: INCLUDE"),
    ("a.xdmf", "<Xdmf><DataItem>secret.h5:/x</DataItem></Xdmf>", "other files"),
    ("a.msh", "\x89HDF\r\n\x1a\n", "HDF5, which may refer to other files"),
]


@pytest.mark.parametrize(("name", "content", "says"), INCLUDING)
def test_a_mesh_is_one_file(name: str, content: str, says: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(content.encode("latin-1"))
    with pytest.raises(InputError, match=f"a mesh that is one file, found .*{says}"):
        read_mesh(tmp_path / name)


@pytest.mark.slow(3)
def test_files_that_would_be_read_without_an_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    os.mkfifo(tmp_path / "a.ply")
    with pytest.raises(InputError, match="expected a mesh, found a pipe"):
        read_mesh(tmp_path / "a.ply")
    for size, says in (
        (10**10, "up to 2000 MB, found 10000 MB"),
        (10**8, "a mesh that meshio can read, found "),
    ):
        with (tmp_path / "b.ply").open("wb") as stream:
            stream.write(b"ply\nformat ascii 1.0\n")
            stream.truncate(size)
        with pytest.raises(InputError, match=says):
            read_mesh(tmp_path / "b.ply")
    monkeypatch.setattr("modefront.work.isolated.LEAST_SECONDS", 3.0)
    (tmp_path / "c.ply").write_text("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n")
    with pytest.raises(InputError, match="expected a mesh that meshio can read, found "):
        read_mesh(tmp_path / "c.ply")


def test_a_reader_that_fails_takes_no_other_process_with_it(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("text")
    for function, says in (
        ("os:abort", "takes no arguments"),
        ("os:nothing", "nothing"),
        ("time:sleep", "float|integer"),
    ):
        with pytest.raises(InputError, match=f"a.txt: file: expected a text, found .*({says})"):
            isolated(function, tmp_path / "a.txt", "a text", 60.0, 4 * 10**9)


READER = """
def read(path):
    try:
        bytearray(10**12)
    except MemoryError as error:
        raise ValueError("it cannot be read") from error
"""


def test_a_reader_without_memory_says_so_whatever_it_makes_of_it(tmp_path: Path) -> None:
    (tmp_path / "reader.py").write_text(READER)
    call = "isolated('reader:read', Path('a.txt'), 'a text', 60.0, 10**9)"
    code = f"from pathlib import Path; from modefront.work.isolated import isolated; {call}"
    path = os.pathsep.join([str(tmp_path), *sys.path])
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
    )
    assert "a file that takes more than 1 GB to be read" in done.stderr.splitlines()[-1]
