"""A netCDF file read in whole, in a process that it may end: what ends well here does so again."""

from __future__ import annotations

from itertools import chain
from pathlib import Path
from typing import Any

import h5netcdf
import h5py
import numpy as np

from modefront.hdf5 import check_file

Values = np.ndarray[Any, Any]

Contents = dict[str, tuple[tuple[str, ...], Values, dict[str, Any]]]
"""Dimensions, values and attributes of variables."""


def try_file(path: Path) -> tuple[dict[str, Values], dict[str, Any]]:
    """Read all variables and attributes, and return nothing of them.

    Raises ForeignError where the file refers to others, ValueError for values that are neither
    numbers nor texts.
    """
    with h5py.File(path, "r") as file:
        check_file(file)
    variables, attributes = contents(path)
    parts = [(values, *own.values()) for _, values, own in variables.values()]
    for value in chain(attributes.values(), *parts):
        if (kind := np.asarray(value).dtype).kind not in "OUSTbiuf":
            raise ValueError(f"values of the type {kind}, neither numbers nor texts")
    return {}, {}


def contents(path: Path) -> tuple[Contents, dict[str, Any]]:
    """Return the variables and the attributes of a file.

    Names of dimensions and values are those of h5py: h5netcdf looks for the dimensions of a
    variable anew whenever it is asked for either.
    """
    with h5netcdf.File(path, "r") as file, h5py.File(path, "r") as plain:
        variables = {
            name: (_dimensions(name, plain[name]), _values(plain[name]), dict(each.attrs))
            for name, each in file.variables.items()
        }
        return variables, dict(file.attrs)


def _dimensions(name: str, item: h5py.Dataset) -> tuple[str, ...]:
    return (name,) if item.is_scale else tuple(each[0].name[1:] for each in item.dims)


def _values(item: h5py.Dataset) -> Values:
    return np.asarray(item.asstr()[...] if h5py.check_string_dtype(item.dtype) else item[...])
