"""Finite-element programs, their options and jobs, and meshes for pictures."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import astuple, dataclass
from pathlib import Path
from typing import Any, Literal, TypeAlias

import numpy as np
import scipy.sparse

from modefront._typing import Floats, Ints
from modefront.errors import reason
from modefront.inputs import file_size, wrong
from modefront.isolated import isolated
from modefront.models.dofs import DofTable
from modefront.outputs import output
from modefront.text import Shown

CORNERS: Mapping[str, int] = {
    "vertex": 1,
    "line": 2,
    "triangle": 3,
    "quad": 4,
    "tetra": 4,
    "pyramid": 5,
    "wedge": 6,
    "hexahedron": 8,
}
"""Types of cells, as meshio and VTK call them, and their nodes; further nodes are left out."""


@dataclass(frozen=True, eq=False, repr=False)
class ProgramMesh(Shown):
    """Nodes by their numbers, and cells between them.

    Attributes
    ----------
    number : (nodes,) numbers of the program, ascending
    coordinates : (nodes, 3)
    cells : (cells, k) numbers of nodes, by the type of the cell
    """

    number: Ints
    coordinates: Floats
    cells: Mapping[str, Ints]


def mesh_of(nodes: Mapping[int, Floats], elements: Iterable[tuple[str, list[int]]]) -> ProgramMesh:
    """Return the mesh of nodes and of elements, each a type of cell and nodes, corners first.

    Elements with unknown nodes, or fewer than corners, are left out.
    """
    number = np.array(sorted(nodes), dtype=np.intp)
    coordinates = np.array([nodes[n] for n in number.tolist()], dtype=float).reshape(-1, 3)
    cells: dict[str, list[list[int]]] = {}
    for kind, members in elements:
        corners = members[: CORNERS[kind]]
        if len(corners) == CORNERS[kind] and nodes.keys() >= set(corners):
            cells.setdefault(kind, []).append(corners)
    return ProgramMesh(
        number, coordinates, {kind: np.array(x, np.intp) for kind, x in cells.items()}
    )


def refuse_unknown_nodes(path: Path, known: Collection[int], nodes: Iterable[int]) -> None:
    """Raise InputError where an element has a node that is not in its file."""
    missing = next((node for node in nodes if node not in known), None)
    if missing is not None:
        raise wrong(path, "all nodes of its elements", f"no node {missing}", "nodes")


def arrays_of(mesh: ProgramMesh) -> dict[str, Any]:
    """Return the arrays of a mesh by their names."""
    cells = {f"cells_{kind}": table for kind, table in mesh.cells.items()}
    return {"number": mesh.number, "coordinates": mesh.coordinates, **cells}


def mesh_from(arrays: Mapping[str, Any]) -> ProgramMesh:
    """Return the mesh of its arrays; raises ValueError where they do not belong together."""
    cells = {name.removeprefix("cells_"): table for name, table in arrays.items()}
    number, coordinates = cells.pop("number"), cells.pop("coordinates")
    if coordinates.shape != (number.size, 3) or not all(
        table.shape[1:] == (CORNERS[kind],) and np.isin(table, number).all()
        for kind, table in cells.items()
    ):
        raise ValueError("arrays that do not belong together")
    return ProgramMesh(number.astype(np.intp), coordinates.astype(float), cells)


def write_mesh(path: Path, mesh: ProgramMesh) -> None:
    """Write a mesh as arrays of NumPy."""
    with output(path) as stream:
        np.savez(stream, **arrays_of(mesh))


def read_mesh(path: Path) -> ProgramMesh:
    """Return a mesh that `write_mesh` has written.

    Raises InputError for any other file.
    """
    file_size(path, "nodes and elements (mesh.npz)")
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
            return mesh_from({name: file[name] for name in file.files})
    except Exception as error:  # what NumPy raises for a damaged file is not documented
        raise wrong(path, "nodes and elements (mesh.npz)", reason(error)) from None


Matrix: TypeAlias = scipy.sparse.csr_array

Quantity = Literal["stiffness", "mass"]


@dataclass(frozen=True, eq=False, repr=False)
class Job(Shown):
    """Matrices of one job of a program.

    Attributes
    ----------
    name : file or files, for messages
    stiffness, mass : (N, N), symmetric, rows compressed
    dofs : node and direction of each degree of freedom
    precision : relative error of the numbers as they are written
    mesh : nodes and elements where the deck is at hand; None where it is not
    notes : what the program did to the model, and what was done about it
    """

    name: str
    stiffness: Matrix
    mass: Matrix
    dofs: DofTable
    precision: float
    mesh: ProgramMesh | None = None
    notes: tuple[str, ...] = ()

    @property
    def size(self) -> int:
        """Number of degrees of freedom N."""
        return self.dofs.size

    @property
    def matrices(self) -> Mapping[Quantity, Matrix]:
        """Both matrices by their names."""
        return {"stiffness": self.stiffness, "mass": self.mass}

    @property
    def labelled(self) -> bool:
        """Whether the program's files tell nodes and directions; else there are only numbers."""
        return bool((self.dofs.node > 0).any())


@dataclass(frozen=True)
class JobOptions:
    """Options of the command line for all jobs.

    Attributes
    ----------
    stiffness, mass : names of the matrices in files that hold several; None for the usual ones
    dofs : a table of degrees of freedom, for files that do not tell nodes; None where they do
    deck : the input file, for coordinates and elements; None for one beside the matrices
    """

    stiffness: str | None = None
    mass: str | None = None
    dofs: Path | None = None
    deck: Path | None = None


def read_job(program: str, path: Path, options: JobOptions) -> Job:
    """Return a job of a program; raises InputError where its files cannot be read, for any cause.

    A program is a module beside this one, whose function ``read`` takes a path and options, and
    returns `modefront.programs.reading.Listed`.
    """
    given = (program, *(str(text or "") for text in astuple(options)))
    reader, expected = "modefront.programs.reading:parts_of_job", f"a job of {program}"
    arrays, texts = isolated(reader, path, expected, arguments=given)
    dofs = DofTable(*(arrays.pop(part) for part in ("node", "direction", "weight")))
    shape, parts = (dofs.size, dofs.size), range(3)
    K, M = (Matrix(tuple(arrays.pop(f"{A}{k}") for k in parts), shape=shape) for A in "KM")
    name, precision, notes = texts
    return Job(name, K, M, dofs, precision, mesh_from(arrays) if arrays else None, tuple(notes))
