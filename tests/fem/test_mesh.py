"""Meshes from files: groups by name, and messages for files that are none."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest
from structures import STEEL, frequencies

from modefront import fem
from modefront.fem.mesh import read_mesh

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
    with pytest.raises(fem.FemError, match="no group of cells named 'plat'; there are: plate"):
        mesh.cells_of("plat", "shell")
    with pytest.raises(fem.FemError, match="'root' has cells of the type line; a shell can"):
        mesh.cells_of("root", "shell")
    with pytest.raises(fem.FemError, match="no group or set of nodes named 'foot'"):
        mesh.nodes_of("foot")
    if form == "abaqus":
        assert mesh.nodes_of("tip").tolist() == [24]


def test_a_mesh_without_groups_is_one(tmp_path: Path) -> None:
    _write(tmp_path / "plate.vtk", "vtk")
    mesh = read_mesh(tmp_path / "plate.vtk")
    assert sorted(len(c) for c in mesh.cells_of("all", "shell")) == [8, 16]


def test_files_that_are_no_mesh(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(fem.FemError, match="no such file"):
        read_mesh(tmp_path / "none.msh")
    (tmp_path / "broken.msh").write_text("this is no mesh\n")
    with pytest.raises(fem.FemError, match=r"broken\.msh: expected a mesh"):
        read_mesh(tmp_path / "broken.msh")
    (tmp_path / "plate.docx").write_text("nor is this")
    with pytest.raises(fem.FemError, match=r"plate\.docx: expected a mesh"):
        read_mesh(tmp_path / "plate.docx")
    assert capfd.readouterr() == ("", "")


def test_second_order_tetrahedra_keep_their_node_order(tmp_path: Path) -> None:
    nodes, bricks = fem.grids.box((1.0, 0.5, 0.5), (2, 1, 1))
    nodes, cells = fem.grids.tetrahedra(nodes, bricks)
    for form, suffix in (("gmsh", "msh"), ("vtk", "vtk")):
        path = tmp_path / f"box.{suffix}"
        meshio.Mesh(nodes, [("tetra10", cells)]).write(path, file_format=form)
        mesh = read_mesh(path)
        (found,) = mesh.cells_of("all", "solid")
        assert np.array_equal(found, cells)
