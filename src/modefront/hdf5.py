"""HDF5 files that hold what they show: no links to others, no data kept elsewhere."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import h5py
import numpy as np
import scipy.sparse


class ForeignError(ValueError):
    """A file refers to others."""


def inner(group: h5py.Group, name: str) -> Any:
    """Return a group or dataset of a group that the file itself holds.

    Raises ForeignError for links to other files, soft links, and data that is kept elsewhere.
    """
    link = group.get(name, getlink=True)
    if isinstance(link, h5py.ExternalLink):
        raise ForeignError(f"'{name}' is a link to another file, '{link.filename}'")
    if not isinstance(link, h5py.HardLink):
        raise ForeignError(f"'{name}' is a link to another place")
    item = group[name]
    if isinstance(item, h5py.Dataset) and item.is_virtual:
        raise ForeignError(f"'{name}' is a virtual dataset, made of other files")
    if isinstance(item, h5py.Dataset) and item.id.get_create_plist().get_external_count():
        raise ForeignError(f"the data of '{name}' is kept in another file")
    return item


def check_tree(group: h5py.Group) -> None:
    """Raise ForeignError where any part of a group, at any depth, is kept elsewhere."""
    waiting = [group]
    while waiting:
        node = waiting.pop()
        waiting += [item for name in node if isinstance(item := inner(node, name), h5py.Group)]


def variables(path: Path) -> dict[str, tuple[int, ...]]:
    """Return the shapes of the variables of a file of MATLAB's version 7.3, () for no matrices."""
    with h5py.File(path, "r") as file:
        names = [name for name in file if not name.startswith("#")]  # where parts of cells are
        return {name: _shape(inner(file, name)) for name in names}


def variable(path: Path, name: str) -> Any:
    """Return a variable of a file of MATLAB's version 7.3, an array or a sparse matrix."""
    with h5py.File(path, "r") as file:
        item = inner(file, name)
        if isinstance(item, h5py.Dataset):
            return np.asarray(item[()]).T  # HDF5 keeps columns as rows
        if not (shape := _shape(item)):
            raise ValueError(f"'{name}' is no matrix of numbers")
        if "data" not in item:  # a matrix of zeros has none
            return scipy.sparse.csc_array(shape)
        data, rows, columns = (inner(item, part)[()] for part in ("data", "ir", "jc"))
        parts = data, rows.astype(np.int64), columns.astype(np.int64)
        A = scipy.sparse.csc_array(parts, shape=shape)
        A.check_format(full_check=True)
        return A


def _shape(item: h5py.Dataset | h5py.Group) -> tuple[int, ...]:
    if isinstance(item, h5py.Dataset):
        return tuple(item.shape or ())
    sparse = "MATLAB_sparse" in item.attrs
    return (int(item.attrs["MATLAB_sparse"]), inner(item, "jc").size - 1) if sparse else ()
