"""Contents of a netCDF file as plain arrays and texts: for processes that read files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import h5netcdf
import h5py
import numpy as np

from modefront.hdf5 import check_file

HIDDEN = frozenset(
    ("_Netcdf4Coordinates", "_Netcdf4Dimid", "_NCProperties", "_nc3_strict", "_nc4_non_coord")
)
"""Attributes that the format keeps for itself."""

Arrays = dict[str, np.ndarray[Any, Any]]


def contents(path: Path) -> tuple[Arrays, dict[str, Any]]:
    """Return the arrays of a file by their places, and all else: dimensions, texts, attributes.

    Raises ForeignError where the file refers to others.
    """
    arrays: Arrays = {}
    with h5py.File(path, "r") as file:
        check_file(file)
    with h5netcdf.File(path, "r") as data:
        variables = {}
        for number, (name, variable) in enumerate(data.variables.items()):
            place = f"variable {number}"
            variables[name] = {
                "dimensions": list(variable.dimensions),
                "values": _plain(arrays, place, variable[...]),
                "attributes": _attributes(arrays, place, variable.attrs),
            }
        return arrays, {
            "variables": variables,
            "attributes": _attributes(arrays, "file", data.attrs),
        }


def _attributes(arrays: Arrays, place: str, attributes: Mapping[str, Any]) -> dict[str, Any]:
    """Return attributes in the form of JSON, and put their numbers among the arrays."""
    named = {name: attributes[name] for name in attributes if name not in HIDDEN}
    return {
        name: _plain(arrays, f"{place} attribute {number}", value)
        for number, (name, value) in enumerate(named.items())
    }


def _plain(arrays: Arrays, place: str, value: Any) -> Any:
    """Return texts as lists, with their shape; numbers are put among the arrays, by their place."""
    if isinstance(value, bytes):
        value = value.decode("utf-8", "backslashreplace")
    array = np.asarray(value)
    if array.dtype.kind in "OUST":
        texts = [_text(each) for each in array.ravel().tolist()]
        return {"texts": texts, "shape": list(array.shape)}
    if array.dtype.kind not in "biuf":
        raise ValueError(f"values of the type {array.dtype}, which are neither numbers nor texts")
    arrays[place] = array
    return {"place": place}


def _text(value: Any) -> str:
    """Return a text; what is none becomes its description, which is no text of results."""
    return value.decode("utf-8", "backslashreplace") if isinstance(value, bytes) else str(value)
