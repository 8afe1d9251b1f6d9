"""Matrices from files of any format: real, symmetric and without entries that overflow.

The readers of other packages do not believe what a file announces, or end with it: they have a
process of their own, with limits on time and memory (`modefront.work.isolated`).
"""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import scipy

from modefront import inputs
from modefront.errors import suggestion
from modefront.models.matrices import symmetrised
from modefront.work.isolated import isolated


def read_entries(
    path: Path, name: str | None = None, *, square: bool = True, form: str | None = None
) -> scipy.sparse.coo_array:
    """Return the entries of a matrix of real numbers as its file lists them.

    Arguments and errors are those of `read_matrix`, but it need not be symmetric, nor ``square``.
    ``form`` is the ending of the format of a file that has another one.
    """
    form = form or path.suffix
    if form not in READERS:
        raise inputs.wrong(path, f"a name that ends in {', '.join(READERS)}", f"'{path.name}'")
    if name is not None and form not in (".mat", ".npz"):
        expected = "a .mat or .npz file, as only these have names for matrices"
        raise inputs.wrong(path, expected, f"'{path.name}'")
    inputs.file_size(path, "a matrix")
    arguments = (form, name or "", "square" if square else "")
    reader, expected = f"{__name__}:entries", "a readable matrix"
    parts, shape = isolated(reader, path, expected, arguments=arguments)
    return scipy.sparse.coo_array(parts, shape=shape)


def read_matrix(path: Path | str, name: str | None = None) -> scipy.sparse.coo_array:
    """Return a real symmetric matrix from a file, exactly symmetrised and without zeros.

    Parameters
    ----------
    path
        Matrix Market ``.mtx``, ``.npz`` of SciPy or NumPy, NumPy ``.npy`` or MATLAB ``.mat``.
        Nothing is unpickled.
    name
        Name of the matrix in a ``.mat`` or ``.npz`` file; None for the only one.

    Raises
    ------
    InputError
        If the file cannot be read, or the matrix is not square, finite, real and symmetric.
    """
    path = Path(path)
    A = read_entries(path, name)
    A.sum_duplicates()
    symmetric = scipy.sparse.coo_array(symmetrised(A.tocsr(), str(path), ""))
    symmetric.eliminate_zeros()
    return symmetric


# In the process that reads files


def entries(path: Path, form: str, name: str, square: str) -> tuple[Any, tuple[int, ...]]:
    """Return data and places of the entries of a matrix, and its numbers of rows and columns.

    ``form`` is the ending of its format, and ``name`` that of a matrix in the file, empty for the
    only one; a ``square`` one is expected unless that is empty. Raises InputError for others.
    """
    matrix = READERS[form](path, name)
    _check_shape(path, matrix.shape, square)
    if matrix.dtype.kind not in "biuf":
        raise inputs.wrong(path, "real numbers", str(matrix.dtype))
    if isinstance(matrix, np.ndarray):
        matrix = matrix.astype(float)  # of any order and precision
    A = scipy.sparse.coo_array(matrix)
    need, free = 64 * (A.nnz + A.shape[0]), inputs.available_memory()  # bytes, to be made symmetric
    if need > free:
        expected = f"a matrix that fits into the {free / 1e9:.3g} GB of memory that are free"
        found = f"{A.nnz} entries in {A.shape[0]} rows, which take {need / 1e9:.3g} GB"
        raise inputs.wrong(path, expected, found)
    return (A.data.astype(float), (A.row, A.col)), A.shape


def _check_shape(path: Path, shape: tuple[int, ...], square: str = "square") -> None:
    if len(shape) != 2 or (square and shape[0] != shape[1]) or 0 in shape:
        found = " x ".join(map(str, shape)) or "a single number"
        raise inputs.wrong(path, "a square matrix", found)
    if shape[0] >= 2**31:
        raise ValueError(f"{shape[0]} rows, more than indices of 32 bits can count")


def _matrix_market(path: Path, _: str) -> Any:
    rows, columns, _, layout, numbers, symmetry = scipy.io.mminfo(path)
    inputs.ended(path)
    _check_shape(path, (rows, columns), "")
    if layout == "array":  # of which the reader takes a triangle that is cut off
        lines = path.read_bytes().splitlines()
        words = sum(len(line.split()) for line in lines if not line.startswith(b"%"))
        triangle = rows * (rows - 1 if symmetry == "skew-symmetric" else rows + 1) // 2
        stored = rows * columns if symmetry == "general" else triangle
        inputs.counted(path, "file", "values", stored * (1 + (numbers == "complex")), words - 2)
    matrix = scipy.io.mmread(path, spmatrix=False)
    if isinstance(matrix, np.ndarray):
        return matrix
    if (again := inputs.first_repeated(matrix.row, matrix.col, matrix.shape[1])) is not None:
        place = f"row {matrix.row[again] + 1}, column {matrix.col[again] + 1}"
        raise inputs.wrong(path, "a readable matrix: each entry once", "it again", place)
    return matrix


def _numpy_npy(path: Path, _: str) -> Any:
    with path.open("rb") as stream:
        try:
            array = np.lib.format.read_array(stream, allow_pickle=False)
        except ValueError as error:
            if "Object arrays" in str(error):
                raise
            raise ValueError("no array of NumPy, or one that is cut off") from None
        inputs.counted(path, "file", "bytes of values", stream.tell(), path.stat().st_size)
    return array


def _npz(path: Path, name: str) -> Any:
    with np.load(path, allow_pickle=False) as arrays:
        if "format" not in arrays.files:  # of NumPy
            return arrays[_chosen(path, name, {key: arrays[key].shape for key in arrays.files})]
    A = scipy.sparse.load_npz(path)
    if hasattr(A, "check_format"):
        _check_shape(path, A.shape, "")
        A.check_format(full_check=True)  # wrong indices would be followed out of the array
        if (np.diff(A.indptr) < 0).any():  # not seen above where the last is 0
            raise ValueError("beginnings of rows or columns that fall")
    return A


def _matlab(path: Path, name: str) -> Any:
    import h5py  # takes time

    if h5py.is_hdf5(path):
        from modefront import hdf5

        return hdf5.variable(path, _chosen(path, name, hdf5.variables(path)))
    chosen = _chosen(path, name, {each: shape for each, shape, _ in scipy.io.whosmat(path)})
    A = scipy.io.loadmat(path, variable_names=[chosen], chars_as_strings=False)[chosen]
    if A.dtype.kind not in "biufc":
        raise ValueError(f"'{chosen}' is no matrix of numbers")
    if scipy.sparse.issparse(A):
        A.check_format(full_check=True)
    return A


def _chosen(path: Path, name: str, shapes: Mapping[str, tuple[int, ...]]) -> str:
    """Return the name of a variable that is there; without a name, of the only matrix."""
    if not name:
        matrices = [key for key, shape in shapes.items() if len(shape) == 2 and min(shape) > 1]
        if len(matrices) != 1:
            expected = 'one matrix, or { file = "...", name = "..." } to say which'
            raise inputs.wrong(path, expected, ", ".join(matrices) or "none")
        name = matrices[0]
    if name not in shapes:
        raise inputs.wrong(path, "the name of a variable in it", suggestion(name, list(shapes)))
    return name


READERS: Mapping[str, Callable[[Path, str], Any]] = {
    ".mtx": _matrix_market,
    ".npz": _npz,
    ".npy": _numpy_npy,
    ".mat": _matlab,
}
"""Reader of each format, by the ending of its files: a new one is named here, nowhere else."""
