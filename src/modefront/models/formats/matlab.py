"""Files of MATLAB, of version 5 and of version 7.3, which is HDF5."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import h5py
import scipy.io
import scipy.sparse

from modefront.errors import suggestion
from modefront.models.formats.base import MatrixFormat, check_square, wrong


def read(path: Path, name: str | None) -> Any:
    """Return one variable of a MATLAB file; without a name, the only square matrix in it."""
    hdf5 = h5py.is_hdf5(path)
    variables = _version_7_3(path) if hdf5 else _version_5(path)
    if name is None:
        matrices = [key for key, shape in variables.items() if len(shape) == 2 and min(shape) > 1]
        if len(matrices) != 1:
            expected = 'one matrix, or { file = "...", name = "..." } to say which'
            raise wrong(path, expected, ", ".join(matrices) or "none")
        name = matrices[0]
    if name not in variables:
        raise wrong(path, "the name of a variable in it", suggestion(name, list(variables)))
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
        check_square(path, shape)
        parts = (item[key][()] for key in ("data", "ir", "jc"))
        A = scipy.sparse.csc_array(tuple(parts), shape=shape)
    A.check_format(full_check=True)
    return A


MATLAB = MatrixFormat(".mat", read, has_names=True)
