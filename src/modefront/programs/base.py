"""Finite-element programs: their options and jobs, meshes for pictures, and how jobs are read.

A program has a module with a function ``read``, which takes a path and options and returns what
the files of a job list. It runs in a process of its own, with limits on time and memory, in which
the matrices are checked too: they are whole, finite and symmetric, and without what is held.
"""

import importlib
import re
import warnings
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import astuple, dataclass
from pathlib import Path
from typing import Any, Literal, TypeAlias

import numpy as np
import scipy.sparse

from modefront._typing import Bools, Floats, Ints
from modefront.data.csv import NUMBER
from modefront.errors import reason, refusing
from modefront.fem.structure import FACES
from modefront.inputs import ended, file_size, first_repeated, wrong
from modefront.models.dofs import DofTable, read_dofs
from modefront.models.matrices import symmetrised
from modefront.outputs import output
from modefront.text import Shown
from modefront.work.codec import record
from modefront.work.isolated import isolated

CORNERS: Mapping[str, int] = {  # nodes of cells by types of meshio and VTK; others are left out
    **{"vertex": 1, "line": 2},
    **{kind: 1 + max(map(max, faces)) for kind, faces in FACES.items()},
}

Matrix: TypeAlias = scipy.sparse.csr_array
Quantity = Literal["stiffness", "mass"]


@record
@dataclass(frozen=True, eq=False, repr=False)
class ProgramMesh(Shown):
    """Nodes by their numbers, and cells between them."""

    number: Ints  # (nodes,) numbers of the program, ascending
    coordinates: Floats  # (nodes, 3)
    cells: Mapping[str, Ints]  # (cells, k) numbers of nodes, by the type of the cell


def mesh_of(nodes: Mapping[int, Floats], elements: Iterable[tuple[str, list[int]]]) -> ProgramMesh:
    """Return the mesh of nodes and of elements, each a type of cell and nodes, corners first.

    Elements with unknown nodes, or fewer than corners, are left out.
    """
    number = sorted(nodes)
    coordinates = np.array([nodes[n] for n in number], dtype=float).reshape(-1, 3)
    cells: dict[str, list[list[int]]] = {}
    for kind, members in elements:
        corners = members[: CORNERS[kind]]
        if len(corners) == CORNERS[kind] and nodes.keys() >= set(corners):
            cells.setdefault(kind, []).append(corners)
    tables = {kind: np.array(x, np.intp) for kind, x in cells.items()}
    return ProgramMesh(np.array(number, np.intp), coordinates, tables)


def refuse_unknown_nodes(path: Path, known: Collection[int], nodes: Iterable[int]) -> None:
    """Raise InputError where an element has a node that is not in its file."""
    missing = next((node for node in nodes if node not in known), None)
    if missing is not None:
        raise wrong(path, "all nodes of its elements", f"no node {missing}", "nodes")


def write_mesh(path: Path, mesh: ProgramMesh) -> None:
    """Write a mesh as arrays of NumPy."""
    cells: dict[str, Any] = {f"cells_{kind}": table for kind, table in mesh.cells.items()}
    with output(path) as stream:
        np.savez(stream, number=mesh.number, coordinates=mesh.coordinates, **cells)


def read_mesh(path: Path) -> ProgramMesh:
    """Return a mesh that `write_mesh` has written; raises InputError for any other file."""
    file_size(path, expected := "nodes and elements (mesh.npz)")
    with refusing(path, expected):  # what NumPy raises for a damaged file is not documented
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
            cells = {name.removeprefix("cells_"): file[name] for name in file.files}
        number, coordinates = cells.pop("number"), cells.pop("coordinates")
        if coordinates.shape != (number.size, 3) or not all(
            table.shape[1:] == (CORNERS[kind],) and np.isin(table, number).all()
            for kind, table in cells.items()
        ):
            raise ValueError("arrays that do not belong together")
        number, coordinates = number.astype(np.intp), coordinates.astype(float)
    return ProgramMesh(number, coordinates, cells)


@dataclass(frozen=True, eq=False, repr=False)
class Job(Shown):
    """Matrices of one job of a program."""

    name: str  # file, for messages
    stiffness: Matrix  # stiffness, mass: (N, N), symmetric, rows compressed
    mass: Matrix
    dofs: DofTable  # node and direction of each degree of freedom
    precision: float  # relative error of the numbers as they are written
    mesh: ProgramMesh | None = None  # nodes and elements; None where the deck is not at hand
    notes: tuple[str, ...] = ()  # what the program did to the model, and what was done about it

    @property
    def matrices(self) -> Mapping[Quantity, Matrix]:
        """Both matrices by their names."""
        return {"stiffness": self.stiffness, "mass": self.mass}


@dataclass(frozen=True)
class JobOptions:
    """Options of the command line for all jobs."""

    stiffness: str | None = None  # stiffness, mass: names among several; None for the usual ones
    mass: str | None = None
    dofs: Path | None = None  # a table of degrees of freedom, for files that do not tell nodes
    deck: Path | None = None  # the input file; None for one beside the matrices


def read_job(program: str, path: Path, options: JobOptions) -> Job:
    """Return a job of a program; raises InputError where its files cannot be read."""
    given = (program, *(str(text or "") for text in astuple(options)))
    reader, expected = f"{__name__}:parts_of_job", f"a job of {program}"
    job = isolated(reader, path, expected, arguments=given)
    name, *matrices, dofs, precision, mesh, notes = job
    K, M = (Matrix(parts, shape=(dofs.size, dofs.size)) for parts in matrices)
    return Job(name, K, M, dofs, precision, mesh, notes)


@dataclass(frozen=True, eq=False)
class Listed:
    """What the files of a job list, before it is checked."""

    files: tuple[Path, Path]  # that of the stiffness, and that of the mass
    matrices: Sequence[scipy.sparse.coo_array]  # stiffness and mass, one triangle or both
    dofs: DofTable  # node and direction of each row; `given_table` where no file tells them
    precision: float = 1e-15  # relative error of the numbers, that of binary doubles unless given
    # which rows are not held, (N,), given both matrices
    free: Callable[[Matrix, Matrix], Bools] = lambda K, _: np.ones(K.shape[0], bool)
    # whether files say how many entries they have; else those that are cut off at a line show by
    # mass without stiffness, which is refused
    counted: bool = True
    mesh: ProgramMesh | None = None  # mesh, notes: as in `Job`
    notes: Sequence[str] = ()


def turned(nodes: Sequence[object]) -> list[str]:
    """Return the note of nodes, or sets of them, whose directions are not those of the whole."""
    some = ", ".join(map(str, nodes[:6]))
    of = "directions of sensors, pictures and a base that moves are those of the nodes' own systems"
    return [f"{of} at node {some}"] * bool(some)


def entries_of(row: Ints, column: Ints, value: Floats, size: int) -> scipy.sparse.coo_array:
    """Return the entries of a matrix (size, size); raises ValueError where one is beyond it."""
    return scipy.sparse.coo_array((value, (row, column)), shape=(size, size))


def given_table(options: JobOptions, size: int) -> DofTable:
    """Return the table of degrees of freedom of ``--dofs``, or that of ones that have no node."""
    if not options.dofs:
        return DofTable(np.zeros(size, int), np.zeros(size, int), np.ones(size))
    table = read_dofs(options.dofs)
    if table.size != size:
        raise wrong(options.dofs, f"{size} rows, one a row of the matrices", str(table.size))
    return table


def parts_of_job(path: Path, program: str, *given: str) -> tuple[Any, ...]:
    """Return the parts of a job of a program once it is checked; options are given as texts."""
    stiffness, mass, *files = (text or None for text in given)
    options = JobOptions(stiffness, mass, *(Path(file) if file else None for file in files))
    listed: Listed = importlib.import_module(f"modefront.programs.{program}").read(path, options)
    pairs = zip(listed.files, listed.matrices, strict=True)
    K, M = (whole(*pair, listed.dofs) for pair in pairs)
    table, notes = listed.dofs, list(listed.notes)
    alone = np.flatnonzero((abs(K).sum(axis=0) == 0) & (M.diagonal() != 0))
    if alone.size and not listed.counted:  # a text of the stiffness that is cut off at a line
        found = f"none at {alone.size} of them, the first {table.label(int(alone[0]))}"
        expected = "stiffness at all degrees of freedom that have mass (is the file cut off?)"
        raise wrong(listed.files[0], expected, found)
    free = np.flatnonzero(listed.free(K, M))
    if free.size < table.size:
        notes.append(f"{table.size - free.size} degrees of freedom that are held are left out")
        K, M = K[free][:, free].tocsr(), M[free][:, free].tocsr()
    if not (table.node > 0).any():
        notes.append("sensors can be given by degrees of freedom only, unless --dofs names nodes")
    matrices = ((A.data, A.indices, A.indptr) for A in (K, M))
    dofs = DofTable(table.node[free], table.direction[free], table.weight[free])
    return str(listed.files[0]), *matrices, dofs, listed.precision, listed.mesh, tuple(notes)


def whole(path: Path, listed: scipy.sparse.coo_array, dofs: DofTable) -> Matrix:
    """Return the symmetric matrix of which one triangle or both are listed.

    In one triangle, entries may be turned here and there. Raises InputError where a value is no
    number, an entry is listed again, or both triangles are listed and differ.
    """

    def label(i: int, j: int) -> str:
        return f"{dofs.label(i)} and {dofs.label(j)}"

    if listed.shape != (dofs.size, dofs.size) or not dofs.size:
        found = " x ".join(map(str, listed.shape))
        raise wrong(path, f"{dofs.size or 'some'} rows and columns, as its table has rows", found)
    if (again := first_repeated(listed.row, listed.col, dofs.size)) is not None:
        place = label(listed.row[again], listed.col[again])
        raise wrong(path, "each entry once", f"the one at {place} again")
    A = Matrix(listed)
    other = A - scipy.sparse.diags_array(A.diagonal(), format="csr")
    if not (abs(other).sign() * abs(other.T).sign()).nnz:
        A = A + other.T
    return Matrix(symmetrised(A, str(path), "", label))


def existing(path: Path, expected: str, advice: str) -> Path:
    """Return a path of a file; raises InputError, with advice, where it is empty or not there."""
    file_size(path, f"{expected} ({advice})")
    return path


def columns(path: Path, separator: str | None, kinds: str, *, comment: str) -> list[np.ndarray]:
    """Return the columns of a table of numbers in a file, between blanks or a separator.

    ``kinds`` has a letter for each column, ``i`` for whole numbers and ``f`` for real ones. Raises
    InputError for other lines.
    """
    ended(path)
    form = [(str(k), np.int32 if kind == "i" else np.float64) for k, kind in enumerate(kinds)]
    try:
        with warnings.catch_warnings(action="error"):  # without any lines
            table = np.loadtxt(path, form, comment, separator, ndmin=1, encoding="latin-1")
    except (ValueError, OverflowError, UserWarning) as error:
        numbers = {"i": r"[+-]?\d+", "f": NUMBER.pattern}
        row = re.compile(r"\s*[\s,.]\s*".join(numbers[kind] for kind in kinds), re.IGNORECASE)
        with path.open(encoding="latin-1") as file:
            rows = ((k, x.partition(comment)[0].strip()) for k, x in enumerate(file, start=1))
            bad = ((repr(x[:60]), f"line {k}") for k, x in rows if x and not row.fullmatch(x))
            found = next(bad, (reason(error), "file"))
        raise wrong(path, f"{len(kinds)} numbers in every line", *found) from None
    return [table[name] for name, _ in form]
