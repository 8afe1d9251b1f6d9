"""Interface of finite-element programs: matrices, their degrees of freedom, and a mesh."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import scipy.sparse

from modefront._typing import Bools, Floats, Ints
from modefront.errors import Fault, InputError, reason
from modefront.inputs import ended, file_size, first_repeated
from modefront.models.dofs import DofTable
from modefront.programs.mesh import ProgramMesh
from modefront.rounding import LARGEST, SYMMETRY

DOUBLE = 1e-15
"""Relative error of numbers that are written as binary doubles: a few roundings of the program."""


@dataclass(frozen=True, eq=False)
class Job:
    """Matrices of one job of a program.

    Attributes
    ----------
    name : file or files, for messages
    stiffness, mass : upper triangles (N, N), rows compressed
    dofs : node and direction of each degree of freedom
    precision : relative error of the numbers as they are written
    labelled : whether the program's files tell nodes and directions; else there are only numbers
    mesh : nodes and elements where the deck is at hand; None where it is not
    notes : what the program did to the model, and what was done about it
    """

    name: str
    stiffness: scipy.sparse.csr_array
    mass: scipy.sparse.csr_array
    dofs: DofTable
    precision: float
    labelled: bool = True
    mesh: ProgramMesh | None = None
    notes: tuple[str, ...] = ()

    @property
    def size(self) -> int:
        """Number of degrees of freedom N."""
        return self.dofs.size


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


@dataclass(frozen=True)
class Program:
    """A finite-element program.

    Attributes
    ----------
    name : as the command line names it
    read : returns a job, given its path as on the command line
    eliminates : whether degrees of freedom of negative nodes are to be eliminated where that is
        exact; they are kept otherwise
    """

    name: str
    read: Callable[[Path, JobOptions], Job]
    eliminates: bool = False

    def job(self, path: Path, options: JobOptions) -> Job:
        """Return a job; raises InputError where its files cannot be read, whatever the cause."""
        try:
            return self.read(path, options)
        except InputError:
            raise
        except Exception as error:  # damaged files fail in more ways than can be listed
            raise wrong(path, f"a job of {self.name}", reason(error)) from None


@dataclass(frozen=True, eq=False)
class Entries:
    """Entries of a matrix as a file lists them: one triangle, or both.

    Attributes
    ----------
    row, column : (entries,) from 0
    value : (entries,)
    """

    row: Ints
    column: Ints
    value: Floats = field(repr=False)


def upper(path: Path, size: int, entries: Entries, dofs: DofTable) -> scipy.sparse.csr_array:
    """Return the upper triangle of a symmetric matrix of which one triangle or both are listed.

    Raises InputError where an index is beyond the size, a value is no number, an entry is listed
    again, or both triangles are listed and differ.
    """
    row, column, value = entries.row, entries.column, entries.value
    if row.size and (min(row.min(), column.min()) < 0 or max(row.max(), column.max()) >= size):
        found = f"row {int(max(row.max(), column.max())) + 1}"
        raise wrong(path, f"rows and columns from 1 to {size}", found)
    good = np.abs(value) <= LARGEST
    if not good.all():
        k = int(np.argmin(good))
        place = f"{dofs.label(int(row[k]))} and {dofs.label(int(column[k]))}"
        raise wrong(path, "finite numbers", f"{value[k]:g} at {place}")
    if (again := first_repeated(row, column, size)) is not None:
        place = f"{dofs.label(int(row[again]))} and {dofs.label(int(column[again]))}"
        raise wrong(path, "each entry once", f"the one at {place} again")
    below = row > column
    if below.any() and (row < column).any():
        return _symmetric(path, size, entries, below, dofs)
    if below.any():
        row, column = column, row
    return _compressed(size, row, column, value)


def _compressed(size: int, row: Ints, column: Ints, value: Floats) -> scipy.sparse.csr_array:
    out = scipy.sparse.coo_array((value, (row, column)), shape=(size, size)).tocsr()
    out.sum_duplicates()
    return out


def _symmetric(
    path: Path, size: int, entries: Entries, below: Bools, dofs: DofTable
) -> scipy.sparse.csr_array:
    """Return the upper triangle where entries are on both sides of the diagonal.

    These are both triangles, or one of them whose entries are turned here and there; in the latter
    no pair of places is given twice.
    """
    row, column, value = entries.row, entries.column, entries.value
    above = ~below
    A = _compressed(size, row[above], column[above], value[above])
    B = _compressed(size, column[below], row[below], value[below])
    off = A - scipy.sparse.dia_array((A.diagonal()[None], [0]), shape=A.shape)
    if (abs(off).sign() * abs(B).sign()).nnz == 0:
        return (A + B).tocsr()
    difference = scipy.sparse.coo_array(off - B)
    greatest = max(np.abs(A.data).max(initial=0), np.abs(B.data).max(initial=0))
    worst = np.abs(difference.data).max(initial=0)
    if worst > SYMMETRY * greatest:
        k = int(np.argmax(np.abs(difference.data)))
        i, j = int(difference.row[k]), int(difference.col[k])
        raise wrong(
            path,
            "a symmetric matrix (damping, contact, friction and rotors make it unsymmetric)",
            f"{A[i, j]:.6g} at {dofs.label(i)} and {dofs.label(j)}, and {B[i, j]:.6g} across",
        )
    half = scipy.sparse.csr_array(A - difference / 2)
    half.sort_indices()
    return half


def whole(triangle: scipy.sparse.csr_array) -> scipy.sparse.csr_array:
    """Return the symmetric matrix of an upper triangle."""
    strict = scipy.sparse.triu(triangle, k=1, format="csr")
    return scipy.sparse.csr_array(triangle + strict.T)


def kept(job_matrix: scipy.sparse.csr_array, dofs: Ints) -> scipy.sparse.csr_array:
    """Return the rows and columns of some degrees of freedom, ascending, of an upper triangle."""
    return job_matrix[dofs][:, dofs].tocsr()


def refuse_mass_alone(
    path: Path, K: scipy.sparse.csr_array, M: scipy.sparse.csr_array, dofs: DofTable
) -> None:
    """Refuse a text file whose stiffness ends before the mass does: it is cut off at a line."""
    alone = np.flatnonzero((abs(K).sum(axis=0) + abs(K).sum(axis=1) == 0) & (M.diagonal() != 0))
    if alone.size:
        found = f"none at {alone.size} of them, the first {dofs.label(int(alone[0]))}"
        expected = "stiffness at all degrees of freedom that have mass (is the file cut off?)"
        raise wrong(path, expected, found)


def wrong(path: Path, expected: str, found: str, place: str = "file") -> InputError:
    """Return the error of a file, or of a place in it."""
    return InputError(Fault(str(path), place, expected, found))


def existing(path: Path, expected: str, advice: str) -> Path:
    """Return a path of a file that is there and not empty.

    Raises InputError, which says what to do, where it is not.
    """
    if file_size(path, f"{expected} ({advice})") > 0:
        return path
    raise wrong(path, f"{expected} ({advice})", "an empty one")


BARE = re.compile(rb"(\d)([+-]\d{3})$")
"""An exponent of three digits, as Fortran writes it."""


def coordinates(path: Path) -> Entries:
    """Return the entries of a file of lines ``row column value``, counted from 1.

    Raises InputError where a line is none, or is cut off.
    """
    row, column, value = columns(path, r"\s+", "iif", comment="#")
    return Entries(row - 1, column - 1, value)


def columns(path: Path, separator: str, kinds: str, *, comment: str) -> list[np.ndarray]:
    """Return the columns of a table of numbers in a file.

    Lines that begin with ``comment`` are left out. ``kinds`` has a letter for each column, ``i``
    for whole numbers and ``f`` for real ones. Raises InputError for other lines.
    """
    import pandas as pd  # xarray needs it, so that it is there

    ended(path)
    types = {k: np.int32 if kind == "i" else np.float64 for k, kind in enumerate(kinds)}
    try:
        table = pd.read_csv(
            path,
            sep=separator,
            header=None,
            comment=comment,
            skipinitialspace=True,
            dtype=types,
            names=range(len(kinds)),
            index_col=False,
            engine="c",
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
        out: Floats = array.astype(float)
    except ValueError:
        out = np.array([float(BARE.sub(rb"\1E\2", field)) for field in array.tolist()])
    return out
