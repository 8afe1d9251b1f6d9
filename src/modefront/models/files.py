"""Matrices from files of any format: real, symmetric and without entries that overflow."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import numpy as np
import scipy.sparse

from modefront._typing import Bools
from modefront.errors import InputError, reason
from modefront.inputs import file_size
from modefront.models.formats import FORMATS
from modefront.models.formats.base import MatrixFormat, check_header, wrong

LARGEST = 1e100
"""Entries above it overflow in products."""

SYMMETRY = 1e-8
"""Greatest difference of A and its transpose, over the greatest entry, that passes for rounding."""

R = TypeVar("R")


def matrix_size(path: Path | str, name: str | None = None) -> int:
    """Return the number of rows of the square matrix that a file announces, without reading it.

    Parameters
    ----------
    path, name
        As `read_matrix` has them.

    Raises
    ------
    InputError
        If there is no such file, or it announces what cannot be: more than it holds, than fits
        into the memory, or another matrix than a square one.
    """
    path = Path(path)
    kind = _format(path, name)
    file_size(path, "a matrix")
    header = _tried(path, name, kind.header)
    check_header(path, header)
    return header.shape[0]


def read_matrix(path: Path | str, name: str | None = None) -> scipy.sparse.coo_array:
    """Return a real symmetric matrix from a file, exactly symmetrised and without zeros.

    Parameters
    ----------
    path
        Matrix Market ``.mtx``, SciPy sparse ``.npz``, NumPy ``.npy`` or MATLAB ``.mat``. Nothing is
        unpickled.
    name
        Name of the matrix in a ``.mat`` file; None for the only one.

    Raises
    ------
    InputError
        If the file cannot be read, or the matrix is not square, finite, real and symmetric.
    """
    path = Path(path)
    size = matrix_size(path, name)
    matrix = _tried(path, name, _format(path, name).read)
    if tuple(matrix.shape) != (size, size):
        raise wrong(path, "a readable matrix", "another shape than it announces")
    if matrix.dtype.kind not in "biuf":
        raise wrong(path, "real numbers", f"{matrix.dtype}")
    with np.errstate(over="ignore"):  # what is infinite is refused below
        A = scipy.sparse.coo_array(matrix.astype(float))
    A.sum_duplicates()
    _check_entries(path, A, ~np.isfinite(A.data), "finite numbers")
    _check_entries(path, A, np.abs(A.data) > LARGEST, f"numbers up to {LARGEST:g}")
    difference = scipy.sparse.coo_array(A - A.T)
    if np.abs(difference.data).max(initial=0) > SYMMETRY * np.abs(A.data).max(initial=0):
        worst = int(np.argmax(np.abs(difference.data)))
        i, j = int(difference.row[worst]), int(difference.col[worst])
        rows = A.tocsr()
        raise wrong(
            path,
            "a symmetric matrix",
            f"{rows[i, j]:.6g}, and {rows[j, i]:.6g} across the diagonal",
            f"row {i}, column {j} (from 0)",
        )
    symmetric = scipy.sparse.coo_array((A + A.T) / 2)
    symmetric.eliminate_zeros()
    return symmetric


def _format(path: Path, name: str | None) -> MatrixFormat:
    """Return the format of a file by its ending; one with names, where a name is given."""
    kind = {each.suffix: each for each in FORMATS}.get(path.suffix)
    if kind is None:
        suffixes = ", ".join(each.suffix for each in FORMATS)
        raise wrong(path, f"a name that ends in {suffixes}", f"'{path.name}'")
    if name is not None and not kind.has_names:
        named = " or ".join(each.suffix for each in FORMATS if each.has_names)
        expected = f"a {named} file, as only these have names for matrices"
        raise wrong(path, expected, f"'{path.name}'")
    return kind


def _tried(path: Path, name: str | None, read: Callable[[Path, str | None], R]) -> R:
    """Return the matrix that a format reads from a file; raises InputError for a damaged one."""
    try:
        return read(path, name)
    except InputError:
        raise
    except Exception as error:  # what the readers raise for a damaged file is not documented
        raise wrong(path, "a readable matrix", reason(error)) from None


def _check_entries(path: Path, A: scipy.sparse.coo_array, refused: Bools, expected: str) -> None:
    """Refuse a matrix of which some entries are refused, naming the first of them."""
    if refused.any():
        first = int(np.argmax(refused))
        place = f"row {A.row[first]}, column {A.col[first]} (from 0)"
        raise wrong(path, expected, f"{A.data[first]:g}", place)
