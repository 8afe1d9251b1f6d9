"""What readers of programs have in common: files are listed, checked and handed on.

A program has a module with a function ``read``, which returns what the files of a job list. It runs
in a process of its own, with limits on time and memory, in which the matrices are checked too: they
are whole, finite and symmetric, and without what is held.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd
import scipy.sparse

from modefront._typing import Bools, Floats, Ints
from modefront.errors import reason
from modefront.inputs import ended, file_size, first_repeated, fortran, wrong
from modefront.isolated import Read
from modefront.models.dofs import DofTable, read_dofs
from modefront.programs.base import JobOptions, Matrix, ProgramMesh, arrays_of
from modefront.rounding import LARGEST, SYMMETRY


@dataclass(frozen=True, eq=False)
class Entries:
    """Entries of a matrix as a file lists them: one triangle, or both.

    Attributes
    ----------
    row, column : (entries,) from 0
    value : (entries,)
    shape : numbers of rows and columns, where the file tells them
    precision : relative error of the values, that of binary doubles unless given
    """

    row: Ints
    column: Ints
    value: Floats = field(repr=False)
    shape: tuple[int, int] | None = None
    precision: float = 1e-15


@dataclass(frozen=True, eq=False)
class Listed:
    """What the files of a job list, before it is checked.

    Attributes
    ----------
    files : that of the stiffness, and that of the mass
    entries : those of the stiffness, and those of the mass
    dofs : node and direction of each row; those of `unlabelled` where no file tells them
    free : which rows are not held, (N,), or what returns it, given both triangles; None for all
    counted : whether files say how many entries they have; else those that are cut off at a line
        show by mass without stiffness, which is refused
    mesh, notes : as in `Job`
    """

    files: tuple[Path, Path]
    entries: tuple[Entries, Entries]
    dofs: DofTable
    free: Bools | Callable[[Matrix, Matrix], Bools] | None = None
    counted: bool = True
    mesh: ProgramMesh | None = None
    notes: Sequence[str] = ()


def unlabelled(size: int) -> DofTable:
    """Return the table of degrees of freedom that belong to no node."""
    return DofTable(np.zeros(size, int), np.zeros(size, int), np.ones(size))


def given_table(options: JobOptions, size: int) -> DofTable | None:
    """Return the table of degrees of freedom of ``--dofs``, if any; it has to have so many rows."""
    table = read_dofs(options.dofs) if options.dofs else None
    if options.dofs and table and table.size != size:
        raise wrong(options.dofs, f"{size} rows, one a degree of freedom", str(table.size))
    return table


def read_job(path: Path, program: str, *given: str) -> Read:
    """Return the parts of a job of a program once it is checked; options are given as texts."""
    stiffness, mass, *files = (text or None for text in given)
    options = JobOptions(stiffness, mass, *(Path(file) if file else None for file in files))
    listed: Listed = importlib.import_module(f"modefront.programs.{program}").read(path, options)
    K, M = (
        upper(file, entries, listed.dofs)
        for file, entries in zip(listed.files, listed.entries, strict=True)
    )
    table, notes = listed.dofs, list(listed.notes)
    stiff = abs(K).sum(axis=0) + abs(K).sum(axis=1) > 0
    alone = np.flatnonzero(~stiff & (M.diagonal() != 0))
    if alone.size and not listed.counted:  # a text of the stiffness that is cut off at a line
        found = f"none at {alone.size} of them, the first {table.label(int(alone[0]))}"
        expected = "stiffness at all degrees of freedom that have mass (is the file cut off?)"
        raise wrong(listed.files[0], expected, found)
    unheld = listed.free(K, M) if callable(listed.free) else listed.free
    free = np.arange(table.size) if unheld is None else np.flatnonzero(unheld)
    if free.size < table.size:
        notes.append(f"{table.size - free.size} degrees of freedom that are held are left out")
        K, M = K[free][:, free].tocsr(), M[free][:, free].tocsr()
    if not (table.node > 0).any():
        notes.append("sensors can be given by degrees of freedom only, unless --dofs names nodes")
    arrays = {name: getattr(table, name)[free] for name in ("node", "direction", "weight")}
    for letter, A in (("K", K), ("M", M)):
        arrays |= {f"{letter}{k}": x for k, x in enumerate((A.data, A.indices, A.indptr))}
    if listed.mesh is not None:
        arrays |= arrays_of(listed.mesh)
    return arrays, [str(listed.files[0]), max(x.precision for x in listed.entries), notes]


def upper(path: Path, entries: Entries, dofs: DofTable) -> Matrix:
    """Return the upper triangle of a symmetric matrix of which one triangle or both are listed.

    Entries on both sides of the diagonal are both triangles, or one of them whose entries are
    turned here and there; in the latter no pair of places is given twice. Raises InputError where
    an index is beyond the size, a value is no number, an entry is listed again, or both triangles
    are listed and differ.
    """
    row, column, value, size = entries.row, entries.column, entries.value, dofs.size

    def label(i: int, j: int) -> str:
        return f"{dofs.label(int(i))} and {dofs.label(int(j))}"

    if row.size and (min(row.min(), column.min()) < 0 or max(row.max(), column.max()) >= size):
        found = f"row {int(max(row.max(), column.max())) + 1}"
        raise wrong(path, f"rows and columns from 1 to {size}", found)
    if not (good := np.abs(value) <= LARGEST).all():
        k = int(np.argmin(good))
        raise wrong(path, "finite numbers", f"{value[k]:g} at {label(row[k], column[k])}")
    if (again := first_repeated(row, column, size)) is not None:
        raise wrong(path, "each entry once", f"the one at {label(row[again], column[again])} again")
    below = row > column
    A, B = (
        scipy.sparse.coo_array((value[part], (i[part], j[part])), shape=(size, size)).tocsr()
        for part, i, j in ((~below, row, column), (below, column, row))
    )
    off = scipy.sparse.triu(A, k=1, format="csr")
    if (abs(off).sign() * abs(B).sign()).nnz == 0:
        return (A + B).tocsr()
    difference = scipy.sparse.coo_array(off - B)
    greatest = max(np.abs(A.data).max(initial=0), np.abs(B.data).max(initial=0))
    if np.abs(difference.data).max(initial=0) > SYMMETRY * greatest:
        k = int(np.argmax(np.abs(difference.data)))
        i, j = int(difference.row[k]), int(difference.col[k])
        raise wrong(
            path,
            "a symmetric matrix (damping, contact, friction and rotors make it unsymmetric)",
            f"{A[i, j]:.6g} at {label(i, j)}, and {B[i, j]:.6g} across",
        )
    half = Matrix(A - difference / 2)
    half.sort_indices()
    return half


def existing(path: Path, expected: str, advice: str) -> Path:
    """Return a path of a file that is there and not empty.

    Raises InputError, which says what to do, where it is not.
    """
    if file_size(path, f"{expected} ({advice})") > 0:
        return path
    raise wrong(path, f"{expected} ({advice})", "an empty one")


def columns(path: Path, separator: str, kinds: str, *, comment: str) -> list[np.ndarray]:
    """Return the columns of a table of numbers in a file.

    Lines that begin with ``comment`` are left out. ``kinds`` has a letter for each column, ``i``
    for whole numbers and ``f`` for real ones. Raises InputError for other lines.
    """
    ended(path)
    types = {k: np.int32 if kind == "i" else np.float64 for k, kind in enumerate(kinds)}
    form = {"sep": separator, "comment": comment, "skipinitialspace": True, "engine": "c"}
    try:
        table = pd.read_csv(
            path, header=None, dtype=types, names=range(len(kinds)), index_col=False, **form
        )
    except (ValueError, OSError, OverflowError) as error:
        expected = f"{len(kinds)} numbers in every line"
        raise wrong(path, expected, reason(error)) from None
    return [table[k].to_numpy() for k in range(len(kinds))]


def fixed_width(text: bytes, width: int) -> Floats:
    """Return numbers of a fixed width that follow each other without separators.

    A ``D`` stands for the ``E`` of an exponent, which Fortran leaves out before three digits.
    Raises ValueError where one is no number.
    """
    array = np.frombuffer(text.replace(b"D", b"E").replace(b"d", b"e"), dtype=f"S{width}")
    try:
        return np.asarray(array.astype(float))
    except ValueError:
        return np.array([fortran(field.decode("latin-1")) for field in array.tolist()])
