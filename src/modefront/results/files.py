"""Results in a netCDF file: written whole or not at all, and checked when they are read."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from modefront.errors import Fault, InputError, reason
from modefront.inputs import available_memory, file_size
from modefront.isolated import isolated
from modefront.outputs import output
from modefront.results.checksum import NAME as CHECKSUM
from modefront.results.checksum import checksum
from modefront.results.remarks import CHANGED
from modefront.results.schema import FORMAT, faults, missing, variables_in
from modefront.results.soundness import unsound
from modefront.text import NAME, clean

FILE = "results.nc"

READER = "modefront.results.netcdf:contents"

SECONDS = 120.0
"""Time that reading may take."""


def write(data: xr.Dataset, path: Path) -> None:
    """Write a dataset with its checksum, whole or not at all."""
    import h5netcdf
    from xarray.backends.h5netcdf_ import H5NetCDFStore

    # `to_netcdf` would import Dask, with all that belongs to it, for a lock between processes.
    with output(path, lasting=True) as stream, h5netcdf.File(stream, "w") as file:
        data.assign_attrs({CHECKSUM: checksum(data)}).dump_to_store(H5NetCDFStore(file))


def read_dataset(folder: Path, *, whole: bool = True) -> xr.Dataset:
    """Return the results in a folder.

    A ``whole`` file has all variables that belong together. An attribute `CHANGED` says where the
    checksum does not fit. Raises InputError where there are no results, where they are not those of
    modefront, and where they are of another format.
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
        text = (
            f"format {clean(version, NAME)}, of another version of modefront: run the study again"
        )
        raise InputError(Fault(str(path), "attribute 'format'", expected, text))
    found = list(faults(data)) or list(missing(data) if whole else ()) or list(unsound(data))
    wrong = [Fault(str(path), *parts) for parts in found]
    if wrong:
        raise InputError(wrong)
    kept = data.attrs.pop(CHECKSUM, "")
    if kept != checksum(data):
        has = "values that do not fit its" if kept else "no"
        data.attrs[CHANGED] = f"{FILE} has {has} checksum: it is not as a run has written it"
    return _plain(data)


def written_for(path: Path) -> str | None:
    """Return the hash of the inputs of results; None where the file cannot be read."""
    try:
        inputs = _read(path).attrs.get("inputs")
    except Exception:  # what is raised for a damaged file is not documented
        return None
    return inputs if isinstance(inputs, str) else None


def _read(path: Path) -> xr.Dataset:
    """Return the contents of a netCDF file, read in a process that damaged files may end."""
    arrays, texts = isolated(READER, path, SECONDS, available_memory())

    def value(part: Mapping[str, Any]) -> Any:
        if "place" in part:
            return arrays[part["place"]]
        return np.array(part["texts"], dtype=object).reshape(part["shape"])

    def attributes(parts: Mapping[str, Any]) -> dict[str, Any]:
        values = {name: value(part) for name, part in parts.items()}
        return {name: each[()] if each.ndim == 0 else each for name, each in values.items()}

    variables = {
        name: xr.Variable(each["dimensions"], value(each["values"]), attributes(each["attributes"]))
        for name, each in texts["variables"].items()
    }
    raw = xr.Dataset(variables, attrs=attributes(texts["attributes"]))
    return xr.decode_cf(raw, decode_times=False)


def _plain(data: xr.Dataset) -> xr.Dataset:
    """Return results in which truth is true or false, and no text holds orders to a terminal."""
    changed: dict[str, xr.Variable] = {}
    variables = variables_in(data)
    for name, variable in data.variables.items():
        known = variables.get(str(name))
        if known is not None and known.values == "truth" and variable.dtype != bool:
            changed[str(name)] = variable.astype(bool)
        if variable.dtype.kind in "UOT":
            texts = [clean(text) for text in variable.values.ravel().tolist()]
            if texts != variable.values.ravel().tolist():
                values = np.array(texts, dtype=object).reshape(variable.shape)
                changed[str(name)] = xr.Variable(variable.dims, values, variable.attrs)
    out = data.assign(changed)
    attributes = data.attrs.items()
    out.attrs = {k: _lines(value) if isinstance(value, str) else value for k, value in attributes}
    return out


def _lines(text: str) -> str:
    """Return a text of one or more lines without orders to a terminal."""
    return "\n".join(map(clean, text.split("\n")))
