"""Matrices in files: Matrix Market, SciPy's sparse .npz, NumPy's .npy, and MATLAB's .mat."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import scipy.io
import scipy.sparse

from modefront.errors import Fault, InputError, suggestion

LARGEST = 1e100
"""Entries above it overflow in products."""

MOST = 2**31 - 1
"""Degrees of freedom, as many as indices of 32 bits can count."""

SYMMETRY = 1e-8
"""Greatest difference of A and its transpose, over the greatest entry, that passes for rounding."""

SHORTEST = 2
"""Least number of characters that an entry takes in a text file."""


def read_matrix(path: Path, name: str | None = None) -> scipy.sparse.coo_array:
    """Return a real symmetric matrix, exactly symmetrised, with its entries that are not zero.

    ``name`` says which one of a file of several variables (.mat); None where there is one matrix.
    Nothing is unpickled. Raises InputError that says what is wrong with the file or the matrix.
    """
    if path.suffix not in READERS:
        raise _wrong(path, f"a name that ends in {', '.join(READERS)}", f"'{path.name}'")
    if name is not None and path.suffix != ".mat":
        raise _wrong(path, "a .mat file, as only these have names for matrices", f"'{path.name}'")
    try:
        with path.open("rb"):
            pass  # for the system's own words about what cannot be opened
        found = _read_mat(path, name) if path.suffix == ".mat" else READERS[path.suffix](path)
    except InputError:
        raise
    except FileNotFoundError:
        raise _wrong(path, "a matrix", "no such file") from None
    except Exception as error:  # what the readers raise for a damaged file is not documented
        raise _wrong(path, "a readable matrix", str(error) or type(error).__name__) from None
    _check_square(path, found.shape)
    if found.dtype.kind not in "biuf":
        raise _wrong(path, "real numbers", f"{found.dtype}")
    A = scipy.sparse.coo_array(found).astype(float)
    A.sum_duplicates()
    _check_entries(path, A, ~np.isfinite(A.data), "finite numbers")
    _check_entries(path, A, np.abs(A.data) > LARGEST, f"numbers up to {LARGEST:g}")
    difference = scipy.sparse.coo_array(A - A.T)
    if np.abs(difference.data).max(initial=0) > SYMMETRY * np.abs(A.data).max(initial=0):
        at = int(np.argmax(np.abs(difference.data)))
        i, j = int(difference.row[at]), int(difference.col[at])
        rows = A.tocsr()
        raise _wrong(
            path,
            "a symmetric matrix",
            f"{rows[i, j]:.6g}, and {rows[j, i]:.6g} across the diagonal",
            f"row {i}, column {j} (from 0)",
        )
    symmetric = scipy.sparse.coo_array((A + A.T) / 2)
    symmetric.eliminate_zeros()
    return symmetric


def _wrong(path: Path, expected: str, found: str, place: str = "file") -> InputError:
    return InputError(Fault(str(path), place, expected, found))


def _check_square(path: Path, shape: tuple[int, ...]) -> None:
    if len(shape) != 2 or shape[0] != shape[1] or shape[0] == 0:
        raise _wrong(path, "a square matrix", " x ".join(map(str, shape)) or "a single number")
    if shape[0] > MOST:
        raise _wrong(path, "a readable matrix", f"{shape[0]} rows, more than {MOST}")


def _check_entries(path: Path, A: scipy.sparse.coo_array, wrong: Any, expected: str) -> None:
    """Refuse a matrix of which some entries are wrong, naming the first of them."""
    if wrong.any():
        at = int(np.argmax(wrong))
        place = f"row {A.row[at]}, column {A.col[at]} (from 0)"
        raise _wrong(path, expected, f"{A.data[at]:g}", place)


def _read_mtx(path: Path) -> Any:
    rows, columns, entries, *_ = scipy.io.mminfo(path)
    _check_square(path, (rows, columns))  # before reading: SciPy divides by the number of rows
    size = path.stat().st_size
    if entries > size / SHORTEST:  # before room is made for them
        raise _wrong(path, "a readable matrix", f"{entries} entries announced in {size} bytes")
    return scipy.io.mmread(path)


def _read_npz(path: Path) -> Any:
    with path.open("rb") as stream:  # NumPy would leave a damaged file open
        A = scipy.sparse.load_npz(stream)
    _check_square(path, A.shape)
    if A.format in ("csr", "csc", "bsr"):
        A.check_format(full_check=True)  # wrong indices would be followed out of the array
    return A


def _read_npy(path: Path) -> Any:
    with path.open("rb") as stream:
        return np.lib.format.read_array(stream, allow_pickle=False)


def _read_mat(path: Path, name: str | None = None) -> Any:
    """Return one variable of a MATLAB file; without a name, the only square matrix in it."""
    hdf5 = h5py.is_hdf5(path)
    variables = _version_7_3(path) if hdf5 else _version_5(path)
    if name is None:
        matrices = [key for key, shape in variables.items() if len(shape) == 2 and min(shape) > 1]
        if len(matrices) != 1:
            expected = 'one matrix, or { file = "...", name = "..." } to say which'
            raise _wrong(path, expected, ", ".join(matrices) or "none")
        name = matrices[0]
    if name not in variables:
        raise _wrong(path, "the name of a variable in it", suggestion(name, list(variables)))
    if hdf5:
        return _from_hdf5(path, name)
    return scipy.io.loadmat(path, variable_names=[name], spmatrix=False)[name]


def _version_5(path: Path) -> dict[str, tuple[int, ...]]:
    return {name: tuple(shape) for name, shape, _ in scipy.io.whosmat(path)}


def _version_7_3(path: Path) -> dict[str, tuple[int, ...]]:
    with h5py.File(path) as file:
        return {
            name: (_columns(item), _columns(item)) if isinstance(item, h5py.Group) else item.shape
            for name, item in file.items()
            if isinstance(item, h5py.Dataset) or "MATLAB_sparse" in item.attrs
        }


def _columns(group: h5py.Group) -> int:
    return int(group["jc"].size) - 1


def _from_hdf5(path: Path, name: str) -> Any:
    """Return a variable of a file of MATLAB's version 7.3, which keeps columns as HDF5."""
    with h5py.File(path) as file:
        item = file[name]
        if isinstance(item, h5py.Dataset):
            return item[()].T
        shape = int(item.attrs["MATLAB_sparse"]), _columns(item)
        _check_square(path, shape)
        parts = (item[key][()] for key in ("data", "ir", "jc"))
        A = scipy.sparse.csc_array(tuple(parts), shape=shape)
    A.check_format(full_check=True)
    return A


READERS: Mapping[str, Callable[[Path], Any]] = {
    ".mtx": _read_mtx,
    ".npz": _read_npz,
    ".npy": _read_npy,
    ".mat": _read_mat,
}
"""Readers by the ending of the file name."""
