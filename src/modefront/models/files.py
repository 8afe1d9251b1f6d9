"""Matrices in files: Matrix Market, SciPy's sparse .npz and NumPy's .npy."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import scipy.io
import scipy.sparse

from modefront._typing import Floats
from modefront.errors import Fault, InputError

LARGEST = 1e100
"""Entries above it overflow in products."""

SYMMETRY = 1e-8
"""Greatest difference of A and its transpose, over the greatest entry, that passes for rounding."""


def read_matrix(path: Path) -> Floats:
    """Return a real symmetric matrix, exactly symmetrised.

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
    A = A.astype(float)
    if not np.isfinite(A).all():
        i, j = np.argwhere(~np.isfinite(A))[0]
        raise _wrong(path, "finite numbers", f"{A[i, j]}", f"row {i}, column {j} (from 0)")
    greatest = np.abs(A).max()
    if greatest > LARGEST:
        raise _wrong(path, f"numbers up to {LARGEST:g}", f"{greatest:g}")
    difference = np.abs(A - A.T)
    if difference.max() > SYMMETRY * greatest:
        i, j = np.unravel_index(np.argmax(difference), A.shape)
        raise _wrong(
            path,
            "a symmetric matrix",
            f"{A[i, j]:.6g}, and {A[j, i]:.6g} across the diagonal",
            f"row {i}, column {j} (from 0)",
        )
    out: Floats = (A + A.T) / 2
    return out


def _wrong(path: Path, expected: str, found: str, place: str = "file") -> InputError:
    return InputError(Fault(str(path), place, expected, found))


def _check_square(path: Path, shape: tuple[int, ...]) -> None:
    if len(shape) != 2 or shape[0] != shape[1] or shape[0] == 0:
        raise _wrong(path, "a square matrix", " x ".join(map(str, shape)) or "a single number")


def _dense(path: Path, A: Any) -> np.ndarray[Any, Any]:
    if not scipy.sparse.issparse(A):
        return np.asarray(A)
    _check_square(path, A.shape)
    if A.format in ("csr", "csc", "bsr"):
        A.check_format(full_check=True)  # wrong indices would be followed out of the array
    return np.asarray(A.toarray())


def _read_mtx(path: Path) -> np.ndarray[Any, Any]:
    with path.open("rb"):
        pass  # for the system's own words about what cannot be opened
    rows, columns, *_ = scipy.io.mminfo(path)
    _check_square(path, (rows, columns))  # before reading: SciPy divides by the number of rows
    return _dense(path, scipy.io.mmread(path))


def _read_npz(path: Path) -> np.ndarray[Any, Any]:
    with path.open("rb") as stream:  # NumPy would leave a damaged file open
        return _dense(path, scipy.sparse.load_npz(stream))


def _read_npy(path: Path) -> np.ndarray[Any, Any]:
    with path.open("rb") as stream:
        return np.asarray(np.lib.format.read_array(stream, allow_pickle=False))


READERS: Mapping[str, Callable[[Path], np.ndarray[Any, Any]]] = {
    ".mtx": _read_mtx,
    ".npz": _read_npz,
    ".npy": _read_npy,
}
"""Readers by the ending of the file name."""
