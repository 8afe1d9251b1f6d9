"""Files of MATLAB, of version 5 and of version 7.3, which is HDF5."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import scipy.sparse

from modefront.errors import suggestion
from modefront.inputs import available_memory, is_hdf5
from modefront.isolated import Read, isolated, seconds_for
from modefront.models.formats.base import (
    Header,
    MatrixFormat,
    check_compressed,
    check_header,
    wrong,
)
from modefront.models.formats.matlab_5 import Variable, read_variable, variables

READER = "modefront.models.formats.matlab_7_3"


def header(path: Path, name: str | None) -> Header:
    """Return the header of one variable; without a name, of the only matrix in the file."""
    if is_hdf5(path):
        headers = _version_7_3(path)
        return headers[_chosen(path, name, {key: each.shape for key, each in headers.items()})]
    return _version_5(path, name).header


def read(path: Path, name: str | None) -> Any:
    """Return one variable of a file; without a name, the only square matrix in it."""
    if is_hdf5(path):
        shapes = {key: each.shape for key, each in _version_7_3(path).items()}
        return _from_hdf5(path, _chosen(path, name, shapes))
    return read_variable(path, _version_5(path, name))


def _version_5(path: Path, name: str | None) -> Variable:
    headers = {each.name: each for each in variables(path)}
    return headers[_chosen(path, name, {key: each.header.shape for key, each in headers.items()})]


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
    """Return the header of each variable of a file of version 7.3."""
    _, headers = _isolated(path, "headers")
    return {name: Header(tuple(shape), entries) for name, (shape, entries) in headers.items()}


def _from_hdf5(path: Path, name: str) -> Any:
    """Return a variable of a file of version 7.3."""
    arrays, shape = _isolated(path, "variable", name)
    if "values" in arrays:
        return arrays["values"]
    size = int(shape[0]), int(shape[1])
    check_header(path, Header(size, 0))
    if "data" not in arrays:
        return scipy.sparse.csc_array(size)
    check_compressed(arrays["data"], arrays["rows"], arrays["columns"], size[1])
    A = scipy.sparse.csc_array((arrays["data"], arrays["rows"], arrays["columns"]), shape=size)
    A.check_format(full_check=True)
    return A


def _isolated(path: Path, function: str, *arguments: str) -> Read:
    """Return contents read by the HDF5 library, in a process that damaged files may end."""
    seconds = seconds_for(path.stat().st_size)
    return isolated(f"{READER}:{function}", path, seconds, available_memory(), arguments)


MATLAB = MatrixFormat(".mat", header, read, has_names=True)
