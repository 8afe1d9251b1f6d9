"""HDF5 files that hold what they show: no links to others, no data kept elsewhere."""

from collections.abc import Mapping
from pathlib import Path
from typing import IO, Any

import h5netcdf
import h5py
import numpy as np
import scipy.sparse

from modefront.datasets import Dataset

HIDDEN = ("_FillValue", "dtype", "coordinates")  # how `xarray` holds a variable


def inner(group: h5py.Group, name: str) -> Any:
    """Return a group or dataset that the file itself holds; raises ValueError for any other."""
    link = group.get(name, getlink=True)
    if isinstance(link, h5py.ExternalLink):
        raise ValueError(f"'{name}' is a link to another file, '{link.filename}'")
    if not isinstance(link, h5py.HardLink):
        raise ValueError(f"'{name}' is a link to another place")
    item = group[name]
    if isinstance(item, h5py.Dataset) and item.is_virtual:
        raise ValueError(f"'{name}' is a virtual dataset, made of other files")
    if isinstance(item, h5py.Dataset) and item.id.get_create_plist().get_external_count():
        raise ValueError(f"the data of '{name}' is kept in another file")
    return item


def check_tree(group: h5py.Group) -> None:
    """Raise ValueError where any part of a group, at any depth, is kept elsewhere."""
    names: list[str] = []
    group.visit_links(names.append)  # once each, whatever groups hold each other
    for name in names:
        inner(group, name)


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


def write_netcdf(data: Dataset, stream: IO[bytes]) -> None:
    """Write a dataset to a file that is open for reading and writing."""
    text = h5py.string_dtype()
    with h5netcdf.File(stream, "w") as file:
        file.dimensions = dict(data.sizes)
        for name, variable in data.variables.items():
            x = variable.values
            held = {"b": np.int8, "U": text, "O": text, "T": text}.get(x.dtype.kind, x.dtype)
            item = file.create_variable(name, variable.dims, held, x.astype(held))
            item.attrs.update(variable.attrs)
            if x.dtype.kind == "b":
                item.attrs["dtype"] = "bool"  # as `xarray` has it
        file.attrs.update(data.attrs)


def contents(path: Path) -> tuple[dict[str, Any], list[Any]]:
    """Return the values of all variables of a netCDF file in their order, and what belongs to them.

    That is the name, dimensions and attributes of each, and those of the file. Raises ValueError
    where the file refers to others.
    """
    arrays: dict[str, Any] = {}
    named: list[Any] = []
    with h5py.File(path, "r") as whole:
        check_tree(whole)
        file = h5netcdf.File(whole, "r")
        for name, item in file.variables.items():
            kind = bool if item.attrs.get("dtype") == "bool" else None
            is_text = h5py.check_string_dtype(whole[name].dtype) is not None
            values = whole[name].asstr()[...].astype(str) if is_text else item[...]
            arrays[str(len(named))] = np.asarray(values, kind)
            named.append([name, list(item.dimensions), _attributes(item.attrs)])
        return arrays, [named, _attributes(file.attrs)]


def _attributes(kept: Mapping[str, Any]) -> dict[str, Any]:
    """Return the attributes of a variable or of all; a list of one value is that value."""
    out: dict[str, Any] = {}
    for name in (name for name in kept if name not in HIDDEN):
        x = np.asarray("" if isinstance(kept[name], h5py.Empty) else kept[name])
        x = np.char.decode(x, "utf-8") if x.dtype.kind == "S" else x
        out[name] = x.item() if x.size == 1 else x.tolist()
    return out
