"""HDF5 files that hold what they show: no links to others, no data kept elsewhere.

A netCDF-4 file is an HDF5 file in which each dimension is a scale that its variables refer to. One
that has no variable of its own name is a scale without values
(https://docs.unidata.ucar.edu/netcdf-c/current/file_format_specifications.html).
"""

from collections.abc import Mapping
from pathlib import Path
from typing import IO, Any

import h5py
import numpy as np
import scipy.sparse

from modefront.datasets import Dataset

WITHOUT_VALUES = b"This is a netCDF dimension but not a netCDF variable."
"""What the name of a scale without values begins with."""

HIDDEN = (  # attributes that say how a file, or `xarray`, holds a variable
    *("CLASS", "NAME", "REFERENCE_LIST", "DIMENSION_LIST", "_nc3_strict", "_NCProperties"),
    *("_Netcdf4Dimid", "_Netcdf4Coordinates", "_FillValue", "dtype", "coordinates"),
)


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


def write_netcdf(data: Dataset, stream: IO[bytes], groups: Mapping[str, Dataset]) -> None:
    """Write a dataset, and others in groups, to a file that is open for reading and writing."""
    with h5py.File(stream, "w", track_order=True) as file:
        _fill(file, data, 0)
        for name, each in groups.items():
            _fill(file.create_group(name, track_order=True), each, len(data.sizes))


def _fill(group: h5py.Group, data: Dataset, first: int) -> None:
    """Write a dataset to a group, whose dimensions have numbers from ``first`` on in the file."""
    text = h5py.string_dtype()
    for name, variable in data.variables.items():
        x = variable.values
        held = {"b": np.int8, "U": text, "O": text, "T": text}.get(x.dtype.kind, x.dtype)
        item = group.create_dataset(name, data=x.astype(held))
        item.attrs.update(variable.attrs)
        if x.dtype.kind == "b":
            item.attrs["dtype"] = "bool"  # as `xarray` has it
    for k, (name, size) in enumerate(data.sizes.items(), first):
        label = str(name).encode()
        if name not in data.variables:
            group.create_dataset(name, (size,), ">f4")
            label = WITHOUT_VALUES + b"%10d" % size
        group[name].make_scale(label)
        group[name].attrs["_Netcdf4Dimid"] = np.int32(k)
    for name, variable in data.variables.items():
        if variable.dims != (name,):
            for axis, dimension in zip(group[name].dims, variable.dims, strict=True):
                axis.attach_scale(group[dimension])
    group.attrs.update(data.attrs)


def contents(path: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return all variables of a netCDF file by name, in their order, and the attributes of all.

    Variables are dimensions, values and attributes; groups are left out. Raises ValueError where
    the file refers to others.
    """
    variables: dict[str, Any] = {}
    with h5py.File(path, "r") as file:
        check_tree(file)
        for name, item in file.items():
            scale = np.bytes_(item.attrs.get("NAME", b""))
            if isinstance(item, h5py.Dataset) and not scale.startswith(WITHOUT_VALUES):
                dims = (name,) if item.is_scale else tuple(x[0].name[1:] for x in item.dims)
                variables[name] = dims, _values(item), _attributes(item)
        return variables, _attributes(file)


def _values(item: h5py.Dataset) -> np.ndarray[Any, Any]:
    if h5py.check_string_dtype(item.dtype):
        return np.asarray(item.asstr()[...], dtype=str)
    return np.asarray(item[...], bool if item.attrs.get("dtype") == "bool" else None)


def _attributes(item: h5py.Dataset | h5py.File) -> dict[str, Any]:
    """Return the attributes of a variable or of all; a list of one value is that value."""
    out: dict[str, Any] = {}
    for name, kept in item.attrs.items():
        x = np.asarray("" if isinstance(kept, h5py.Empty) else kept)
        x = np.char.decode(x, "utf-8") if x.dtype.kind == "S" else x
        if name not in HIDDEN:
            out[name] = x.item() if x.size == 1 else x.tolist()
    return out
