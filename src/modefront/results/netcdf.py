"""A netCDF file read in whole, in a process of its own (`modefront.isolated`)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import h5netcdf
import h5py
import numpy as np

from modefront.hdf5 import check_tree
from modefront.isolated import Read


def contents(path: Path) -> Read:
    """Return the values of all variables in their order, and what belongs to them.

    That is the name, dimensions and attributes of each variable, and the attributes of the file.
    Names of dimensions and values are those of h5py: h5netcdf looks for the dimensions of a
    variable anew whenever it is asked for either. Raises ForeignError where the file refers to
    others, ValueError for values that are neither numbers nor texts.
    """
    with h5py.File(path, "r") as plain:
        check_tree(plain)
        with h5netcdf.File(path, "r") as file:
            variables = [
                [name, _dimensions(name, plain[name]), _attributes(each.attrs)]
                for name, each in file.variables.items()
            ]
            arrays = {str(k): _values(plain[name]) for k, (name, *_) in enumerate(variables)}
            return arrays, [variables, _attributes(file.attrs)]


def _dimensions(name: str, item: h5py.Dataset) -> list[str]:
    return [name] if item.is_scale else [each[0].name[1:] for each in item.dims]


def _values(item: h5py.Dataset) -> np.ndarray[Any, Any]:
    if h5py.check_string_dtype(item.dtype):
        return np.asarray(item.asstr()[...], dtype=str)
    return _sound(np.asarray(item[...]))


def _attributes(attributes: Any) -> dict[str, Any]:
    return {name: _sound(np.asarray(value)).tolist() for name, value in attributes.items()}


def _sound(values: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    if values.dtype.kind not in "OUSTbiuf":
        raise ValueError(f"values of the type {values.dtype.kind}, neither numbers nor texts")
    return values
