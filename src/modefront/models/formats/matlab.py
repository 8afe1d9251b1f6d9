"""Files of MATLAB, of version 5 and of version 7.3, which is HDF5."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import h5py
import scipy.sparse

from modefront.errors import suggestion
from modefront.hdf5 import inner
from modefront.models.formats.base import Header, MatrixFormat, check_header, wrong
from modefront.models.formats.matlab_5 import Variable, read_variable, variables


def header(path: Path, name: str | None) -> Header:
    """Return what a file announces of one variable; without a name, of the only matrix in it."""
    if h5py.is_hdf5(path):
        found = _version_7_3(path)
        return found[_chosen(path, name, {key: each.shape for key, each in found.items()})]
    return _version_5(path, name).header


def read(path: Path, name: str | None) -> Any:
    """Return one variable of a file; without a name, the only square matrix in it."""
    if h5py.is_hdf5(path):
        shapes = {key: each.shape for key, each in _version_7_3(path).items()}
        return _from_hdf5(path, _chosen(path, name, shapes))
    return read_variable(path, _version_5(path, name))


def _version_5(path: Path, name: str | None) -> Variable:
    found = {each.name: each for each in variables(path)}
    return found[_chosen(path, name, {key: each.header.shape for key, each in found.items()})]


def _chosen(path: Path, name: str | None, shapes: dict[str, tuple[int, ...]]) -> str:
    """Return the name of a variable that is there."""
    if name is None:
        matrices = [key for key, shape in shapes.items() if len(shape) == 2 and min(shape) > 1]
        if len(matrices) != 1:
            expected = 'one matrix, or { file = "...", name = "..." } to say which'
            raise wrong(path, expected, ", ".join(matrices) or "none")
        name = matrices[0]
    if name not in shapes:
        raise wrong(path, "the name of a variable in it", suggestion(name, list(shapes)))
    return name


def _version_7_3(path: Path) -> dict[str, Header]:
    """Return what is announced of each variable of a file of version 7.3."""
    with h5py.File(path, "r") as file:
        found = {}
        for name in file:
            if name.startswith("#"):
                continue  # where MATLAB keeps the parts of cells
            item = inner(file, name)
            if isinstance(item, h5py.Dataset):
                found[name] = Header(item.shape, item.size)
            elif "MATLAB_sparse" in item.attrs:
                columns = inner(item, "jc").size - 1
                entries = inner(item, "data").size if "data" in item else 0
                found[name] = Header((int(item.attrs["MATLAB_sparse"]), columns), entries)
        return found


def _from_hdf5(path: Path, name: str) -> Any:
    """Return a variable of a file of MATLAB's version 7.3, which keeps columns as HDF5."""
    with h5py.File(path, "r") as file:
        item = inner(file, name)
        if isinstance(item, h5py.Dataset):
            return item[()].T
        columns = inner(item, "jc")[()]
        shape = int(item.attrs["MATLAB_sparse"]), columns.size - 1
        check_header(path, Header(shape, 0))
        if "data" not in item:  # a matrix of zeros has none
            return scipy.sparse.csc_array(shape)
        rows = inner(item, "ir")[()]
        A = scipy.sparse.csc_array((inner(item, "data")[()], rows, columns), shape=shape)
    A.check_format(full_check=True)
    return A


MATLAB = MatrixFormat(".mat", header, read, has_names=True)
