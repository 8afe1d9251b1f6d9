"""Results in a netCDF file: written whole or not at all, and checked when they are read.

The checksum is over names, dimensions, types, values and attributes of all variables. It does not
depend on how a file lays these out: truth values and whole numbers count as integers of 64 bits,
other numbers as floats of 64 bits, and texts in UTF-8.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from modefront.errors import Fault, InputError, reason, refuse
from modefront.inputs import available_memory, file_size
from modefront.isolated import isolated
from modefront.outputs import output
from modefront.results.remarks import CHANGED
from modefront.results.schema import FORMAT, variables_in
from modefront.results.soundness import faults
from modefront.text import NAME, clean

FILE = "results.nc"

READER, SECONDS = "modefront.hdf5:contents", 120.0
"""Function that reads the file, and the time that it may take."""

CHECKSUM = "checksum"
"""Attribute that holds the checksum, which it leaves out."""


def write(data: xr.Dataset, path: Path) -> None:
    """Write a dataset with its checksum, whole or not at all."""
    import h5netcdf
    from xarray.backends.h5netcdf_ import H5NetCDFStore

    # `to_netcdf` would import Dask, with all that belongs to it, for a lock between processes.
    with output(path, lasting=True) as stream, h5netcdf.File(stream, "w") as file:
        data.assign_attrs({CHECKSUM: checksum(data)}).dump_to_store(H5NetCDFStore(file))


def read_dataset(folder: Path) -> xr.Dataset:
    """Return the results in a folder.

    An attribute `CHANGED` says where the checksum does not fit. Raises InputError where there are
    no results, where they are not those of modefront, and where they are of another format.
    """
    path = folder / FILE
    file_size(path, "results of a finished run")
    try:
        data = _read(path)
    except Exception as error:  # what is raised for a damaged file is not documented
        raise InputError(Fault(str(path), "file", "results in netCDF", reason(error))) from None
    version = data.attrs.get("format", 1 if "label" in data else None)
    if version is not None and not np.array_equal(version, FORMAT):
        expected = f"results of format {FORMAT}"
        text = f"format {clean(version, NAME)}, of another version of modefront: run it again"
        raise InputError(Fault(str(path), "attribute 'format'", expected, text))
    refuse(Fault(str(path), *parts) for parts in faults(data))
    kept = data.attrs.pop(CHECKSUM, "")
    if kept != checksum(data):
        has = "values that do not fit its" if kept else "no"
        data.attrs[CHANGED] = f"{FILE} has {has} checksum: it is not as a run has written it"
    return _plain(data)


def written_for(path: Path) -> str | None:
    """Return the hash of the inputs of results; None where the file cannot be read."""
    with suppress(Exception):  # what is raised for a damaged file is not documented
        return _read(path).attrs.get("inputs")
    return None


def checksum(data: xr.Dataset) -> str:
    """Return the checksum of a dataset, BLAKE2b in hexadecimal digits."""
    digest = hashlib.blake2b(digest_size=16)
    for name in sorted(data.variables, key=str):
        variable = data.variables[name]
        digest.update(_text("variable", name, *variable.dims))
        digest.update(_values(variable.values))
        digest.update(_attributes(variable.attrs))
    digest.update(_attributes(data.attrs))
    return digest.hexdigest()


def _attributes(attributes: Mapping[Any, Any]) -> bytes:
    """Return attributes in the order of their names; files do not tell one value from a list."""
    return b"".join(
        _text("attribute", name) + _values(np.atleast_1d(attributes[name]))
        for name in sorted(attributes, key=str)
        if name != CHECKSUM
    )


def _values(values: np.ndarray[Any, Any]) -> bytes:
    kind = {"b": "<i8", "i": "<i8", "u": "<i8", "f": "<f8"}.get(values.dtype.kind, "text")
    head = _text(kind, *values.shape)
    if kind == "text":
        return head + _text(*values.ravel().tolist())
    numbers = values.astype(kind)
    return head + np.where(np.isnan(numbers), np.nan, numbers).astype(kind).tobytes()


def _text(*parts: object) -> bytes:
    return json.dumps(list(map(str, parts))).encode()


def _read(path: Path) -> xr.Dataset:
    """Return the contents of a netCDF file, which a process that damaged files may end reads."""
    arrays, (variables, attributes) = isolated(READER, path, SECONDS, available_memory())
    values = {
        name: xr.Variable(dimensions, arrays[str(k)], own)
        for k, (name, dimensions, own) in enumerate(variables)
    }
    return xr.decode_cf(xr.Dataset(values, attrs=attributes), decode_times=False)


def _plain(data: xr.Dataset) -> xr.Dataset:
    """Return results in which truth is true or false, and no text holds orders to a terminal."""
    changed: dict[str, xr.Variable] = {}
    known = variables_in(data)
    for key, variable in data.variables.items():
        name = str(key)
        if name in known and known[name].values == "truth":
            changed[name] = variable.astype(bool)
        if variable.dtype.kind in "UOT":
            texts = np.array(list(map(clean, variable.values.ravel().tolist())), dtype=object)
            if (texts != variable.values.ravel()).any():
                values = texts.reshape(variable.shape)
                changed[name] = xr.Variable(variable.dims, values, variable.attrs)
    out = data.assign(changed)
    out.attrs = {
        key: "\n".join(map(clean, value.split("\n"))) if isinstance(value, str) else value
        for key, value in data.attrs.items()
    }
    return out
