"""What readers of programs have in common: files are listed, checked and handed on.

A program has a module with a function ``read``, which returns what the files of a job list. It runs
in a process of its own, with limits on time and memory, in which the matrices are checked too: they
are whole, finite and symmetric, and without what is held.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
import scipy.sparse

from modefront._typing import Bools, Floats, Ints
from modefront.errors import reason
from modefront.inputs import ended, file_size, first_repeated, fortran, wrong
from modefront.isolated import Read
from modefront.models.dofs import DofTable, read_dofs
from modefront.models.matrices import symmetrised
from modefront.programs.base import JobOptions, Matrix, ProgramMesh, arrays_of


@dataclass(frozen=True, eq=False)
class Listed:
    """What the files of a job list, before it is checked.

    Attributes
    ----------
    files : that of the stiffness, and that of the mass
    matrices : stiffness and mass as they are listed, one triangle or both
    dofs : node and direction of each row; those of `given_table` where no file tells them
    precision : relative error of the numbers, that of binary doubles unless given
    free : which rows are not held, (N,), or what returns it, given both matrices; None for all
    counted : whether files say how many entries they have; else those that are cut off at a line
        show by mass without stiffness, which is refused
    mesh, notes : as in `Job`
    """

    files: tuple[Path, Path]
    matrices: Sequence[scipy.sparse.coo_array]
    dofs: DofTable
    precision: float = 1e-15
    free: Bools | Callable[[Matrix, Matrix], Bools] | None = None
    counted: bool = True
    mesh: ProgramMesh | None = None
    notes: Sequence[str] = ()


def entries_of(row: Ints, column: Ints, value: Floats, size: int) -> scipy.sparse.coo_array:
    """Return the entries of a matrix (size, size); raises ValueError where one is beyond it."""
    return scipy.sparse.coo_array((value, (row, column)), shape=(size, size))


def given_table(options: JobOptions, size: int) -> DofTable:
    """Return the table of degrees of freedom of ``--dofs``, or that of ones that have no node."""
    if options.dofs:
        return read_dofs(options.dofs)
    return DofTable(np.zeros(size, int), np.zeros(size, int), np.ones(size))


def parts_of_job(path: Path, program: str, *given: str) -> Read:
    """Return the parts of a job of a program once it is checked; options are given as texts."""
    stiffness, mass, *files = (text or None for text in given)
    options = JobOptions(stiffness, mass, *(Path(file) if file else None for file in files))
    listed: Listed = importlib.import_module(f"modefront.programs.{program}").read(path, options)
    pairs = zip(listed.files, listed.matrices, strict=True)
    K, M = (whole(file, entries, listed.dofs) for file, entries in pairs)
    table, notes = listed.dofs, list(listed.notes)
    alone = np.flatnonzero((abs(K).sum(axis=0) == 0) & (M.diagonal() != 0))
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
    return arrays, [str(listed.files[0]), listed.precision, notes]


def whole(path: Path, listed: scipy.sparse.coo_array, dofs: DofTable) -> Matrix:
    """Return the symmetric matrix of which one triangle or both are listed.

    Entries on both sides of the diagonal are both triangles, or one of them whose entries are
    turned here and there; in the latter no pair of places is given twice. Raises InputError where
    a value is no number, an entry is listed again, or both triangles are listed and differ.
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
