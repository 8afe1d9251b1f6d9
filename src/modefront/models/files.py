"""Matrices in files: Matrix Market, SciPy's sparse .npz and NumPy's .npy."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import scipy.io
import scipy.sparse

from modefront.errors import Fault, InputError

LARGEST = 1e100
"""Entries above it overflow in products."""

SYMMETRY = 1e-8
"""Greatest difference of A and its transpose, over the greatest entry, that passes for rounding."""


def read_matrix(path: Path) -> scipy.sparse.csr_array:
    """Return a real symmetric matrix, exactly symmetrised, with the entries that are not zero.

    Nothing is unpickled. Raises InputError that says what is wrong with the file or the matrix.
    """
    if path.suffix not in READERS:
        raise _wrong(path, f"a name that ends in {', '.join(READERS)}", f"'{path.name}'")
    try:
        A = READERS[path.suffix](path)
    except InputError:
        raise
    except FileNotFoundError:
        raise _wrong(path, "a matrix", "no such file") from None
    except Exception as error:  # what the readers raise for a damaged file is not documented
        raise _wrong(path, "a readable matrix", str(error) or type(error).__name__) from None
    _check_square(path, A.shape)
    if A.dtype.kind not in "biuf":
        raise _wrong(path, "real numbers", f"{A.dtype}")
    A = scipy.sparse.csr_array(A.astype(float))
    A.sum_duplicates()
    row, column = A.tocoo().coords
    wrong = np.flatnonzero(~np.isfinite(A.data))
    if wrong.size:
        i, j = row[wrong[0]], column[wrong[0]]
        raise _wrong(path, "finite numbers", f"{A.data[wrong[0]]}", f"row {i}, column {j} (from 0)")
    greatest = np.abs(A.data).max(initial=0.0)
    if greatest > LARGEST:
        raise _wrong(path, f"numbers up to {LARGEST:g}", f"{greatest:g}")
    difference = abs(A - A.T).tocoo()
    if difference.nnz and difference.data.max() > SYMMETRY * greatest:
        at = int(np.argmax(difference.data))
        i, j = (int(index[at]) for index in difference.coords)
        raise _wrong(
            path,
            "a symmetric matrix",
            f"{A[i, j]:.6g}, and {A[j, i]:.6g} across the diagonal",
            f"row {i}, column {j} (from 0)",
        )
    return scipy.sparse.csr_array((A + A.T) / 2)


def _wrong(path: Path, expected: str, found: str, place: str = "file") -> InputError:
    return InputError(Fault(str(path), place, expected, found))


def _check_square(path: Path, shape: tuple[int, ...]) -> None:
    if len(shape) != 2 or shape[0] != shape[1] or shape[0] == 0:
        raise _wrong(path, "a square matrix", " x ".join(map(str, shape)) or "a single number")


def _checked(path: Path, A: Any) -> Any:
    """Return a matrix of which all indices are within it, dense or sparse."""
    if not scipy.sparse.issparse(A):
        return np.asarray(A)
    _check_square(path, A.shape)
    if A.format in ("csr", "csc", "bsr"):
        A.check_format(full_check=True)  # wrong indices would be followed out of the array
    return scipy.sparse.csr_array(A)


def _read_mtx(path: Path) -> Any:
    with path.open("rb"):
        pass  # for the system's own words about what cannot be opened
    rows, columns, *_ = scipy.io.mminfo(path)
    _check_square(path, (rows, columns))  # before reading: SciPy divides by the number of rows
    return _checked(path, scipy.io.mmread(path))


def _read_npz(path: Path) -> Any:
    with path.open("rb") as stream:  # NumPy would leave a damaged file open
        return _checked(path, scipy.sparse.load_npz(stream))


def _read_npy(path: Path) -> Any:
    with path.open("rb") as stream:
        return np.asarray(np.lib.format.read_array(stream, allow_pickle=False))


READERS: Mapping[str, Callable[[Path], Any]] = {
    ".mtx": _read_mtx,
    ".npz": _read_npz,
    ".npy": _read_npy,
}
"""Readers by the ending of the file name."""
