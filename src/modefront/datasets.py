"""Arrays with named dimensions, and netCDF files of them.

A run makes an `ArrayDataset`: importing `xarray`, which has more, takes as long as a small study.

A netCDF-4 file is an HDF5 file in which each dimension is a scale that its variables refer to. One
that has no variable of its own name is a scale without values
(https://docs.unidata.ucar.edu/netcdf-c/current/file_format_specifications.html).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, TypeAlias

import h5py
import numpy as np

from modefront.hdf5 import check_tree

if TYPE_CHECKING:
    import xarray as xr

WITHOUT_VALUES = b"This is a netCDF dimension but not a netCDF variable."
"""What the name of a scale without values begins with."""

HIDDEN = (
    *("CLASS", "NAME", "REFERENCE_LIST", "DIMENSION_LIST", "_nc3_strict", "_NCProperties"),
    *("_Netcdf4Dimid", "_Netcdf4Coordinates", "_FillValue", "dtype", "coordinates"),
)
"""Attributes that say how a file, or `xarray`, holds a variable."""


@dataclass(frozen=True, eq=False)
class Array:
    """An array with names of its dimensions, and attributes that describe it."""

    dims: tuple[Any, ...]
    values: np.ndarray[Any, Any]
    attrs: Mapping[Any, Any] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class ArrayDataset:
    """Arrays by name that share dimensions; one named as its only dimension is a coordinate.

    Methods do what those of `xarray` do. Raises ValueError for arrays that do not fit together.
    """

    variables: Mapping[Any, Array]
    attrs: Mapping[Any, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name, variable in self.variables.items():
            shape = tuple(self.sizes[each] for each in variable.dims)
            if variable.values.shape != shape:
                raise ValueError(f"'{name}' has the shape {variable.values.shape}, not {shape}")

    @cached_property
    def sizes(self) -> dict[Any, int]:
        """Size of each dimension by its name."""
        every = self.variables.values()
        return {k: n for x in every for k, n in zip(x.dims, x.values.shape, strict=False)}

    def __getitem__(self, name: Any) -> Array:
        return self.variables[name]

    def __contains__(self, name: object) -> bool:
        return name in self.variables

    def isel(self, **chosen: Any) -> ArrayDataset:
        """Return what belongs to chosen places."""

        def of(variable: Array) -> Array:
            values, dims = variable.values, variable.dims
            for name, places in chosen.items():
                if name in dims:
                    values = values[(slice(None),) * dims.index(name) + (np.asarray(places),)]
                    dims = tuple(x for x in dims if x != name or np.ndim(places))
            return Array(dims, values, variable.attrs)

        return replace(self, variables={name: of(x) for name, x in self.variables.items()})

    def assign(self, variables: Mapping[Any, Array]) -> ArrayDataset:
        """Return these with further variables, or others in their place."""
        return replace(self, variables={**self.variables, **variables})

    def assign_coords(self, names: Mapping[str, Any]) -> ArrayDataset:
        """Return these with names of the places of some dimensions."""
        return self.assign({key: Array((key,), np.asarray(x)) for key, x in names.items()})

    def assign_attrs(self, attributes: Mapping[str, Any]) -> ArrayDataset:
        """Return these with further attributes of all, or others in their place."""
        return replace(self, attrs={**self.attrs, **attributes})


Dataset: TypeAlias = "ArrayDataset | xr.Dataset"
"""What results are read by: of a run, or of `xarray`."""


def write_netcdf(data: Dataset, stream: IO[bytes]) -> None:
    """Write a dataset to a file that is open for reading and writing."""
    text = h5py.string_dtype()
    with h5py.File(stream, "w", track_order=True) as file:
        for name, variable in data.variables.items():
            x = variable.values
            held = {"b": np.int8, "U": text, "O": text, "T": text}.get(x.dtype.kind, x.dtype)
            item = file.create_dataset(name, data=x.astype(held))
            item.attrs.update(variable.attrs)
            if x.dtype.kind == "b":
                item.attrs["dtype"] = "bool"  # as `xarray` has it
        for k, (name, size) in enumerate(data.sizes.items()):
            label = str(name).encode()
            if name not in data.variables:
                file.create_dataset(name, (size,), ">f4")
                label = WITHOUT_VALUES + b"%10d" % size
            file[name].make_scale(label)
            file[name].attrs["_Netcdf4Dimid"] = np.int32(k)
        for name, variable in data.variables.items():
            if variable.dims != (name,):
                for axis, dimension in zip(file[name].dims, variable.dims, strict=True):
                    axis.attach_scale(file[dimension])
        file.attrs.update(data.attrs)


def contents(path: Path) -> tuple[dict[str, Any], list[Any]]:
    """Return the values of all variables of a netCDF file in their order, and what belongs to them.

    That is the name, dimensions and attributes of each variable, and the attributes of the file.
    Raises ForeignError where the file refers to others.
    """
    arrays: dict[str, Any] = {}
    named: list[Any] = []
    with h5py.File(path, "r") as file:
        check_tree(file)
        for name, item in file.items():
            scale = np.bytes_(item.attrs.get("NAME", b""))
            if isinstance(item, h5py.Dataset) and not scale.startswith(WITHOUT_VALUES):
                dims = [name] if item.is_scale else [each[0].name[1:] for each in item.dims]
                arrays[str(len(named))] = _values(item)
                named.append([name, dims, _attributes(item)])
        return arrays, [named, _attributes(file)]


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
