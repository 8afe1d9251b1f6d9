"""Results in a netCDF file: written whole or not at all, and read as they were written.

A file has a checksum of dimensions, type, values and attributes of each variable, and of each
attribute. It does not depend on how a file lays these out: truth values and whole numbers count as
integers of 64 bits, other numbers as floats of 64 bits, and texts in UTF-8.
"""

import hashlib
import json
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from modefront.datasets import Array, ArrayDataset, Dataset
from modefront.errors import Fault, InputError, refuse, refusing
from modefront.hdf5 import write_netcdf
from modefront.inputs import file_size
from modefront.outputs import output
from modefront.results.schema import ATTRIBUTES, FORMAT, VARIABLES
from modefront.text import NAME, clean
from modefront.work.isolated import isolated

FILE = "results.nc"

READER, SECONDS, EXPECTED = "modefront.hdf5:contents", 120.0, "results in netCDF"
"""Function that reads the file, the time that it may take, and what the file is."""

CHECKSUM = "checksum"  # attribute that holds the checksums, in JSON


def write(data: Dataset, path: Path) -> None:
    """Write a dataset with its checksums, whole or not at all.

    Draws are there once more as a group ``posterior`` with the dimensions that ArviZ expects.
    """
    drawn = {str(x): data[x] for x in data.variables if str(x).startswith("draw_")}
    if not drawn and "sample_theta" in data:
        drawn["draw_theta"] = data["sample_theta"]
    posterior = {
        name.removeprefix("draw_"): Array(("chain", "draw", *x.dims[1:]), x.values[None], x.attrs)
        for name, x in drawn.items()
    }
    for name in (str(x) for each in drawn.values() for x in each.dims if x in data.variables):
        posterior[name] = Array((name,), data[name].values, data[name].attrs)
    groups = {"posterior": ArrayDataset(posterior)} if drawn else {}
    with output(path, lasting=True) as stream:
        write_netcdf(data.assign_attrs({CHECKSUM: json.dumps(checksums(data))}), stream, groups)


def read_dataset(folder: Path) -> ArrayDataset:
    """Return the results in a folder, as a run has written them; others may have added to them.

    Raises InputError where there are no results, where they are of another format, and for what
    has changed since the run.
    """
    path = folder / FILE
    file_size(path, "results of a finished run")
    with refusing(path, EXPECTED):  # what is raised for a damaged file is not documented
        data = _read(path)
    version = data.attrs.get("format", 1 if "label" in data else None)
    if version is not None and not np.array_equal(version, FORMAT):
        expected = f"results of format {FORMAT}"
        text = f"format {clean(version, NAME)}, of another version of modefront: run it again"
        raise InputError(Fault(str(path), "attribute 'format'", expected, text))
    try:
        kept = dict(json.loads(data.attrs.get(CHECKSUM, "")))
    except (ValueError, TypeError):
        what = "attribute 'checksum'", "the checksums of a run, in JSON", "none"
        raise InputError(Fault(str(path), *what)) from None
    needed = [f"variable '{x.name}'" for x in VARIABLES.values() if x.required]
    needed += [f"attribute '{x.name}'" for x in ATTRIBUTES.values() if x.required]
    now, expected = checksums(data), "it as the run has written it"
    refuse(
        Fault(str(path), place, expected, "another" if place in now else "nothing")
        for place in dict.fromkeys([*needed, *kept])
        if now.get(place, "") != kept.get(place)
    )
    return replace(data, attrs={name: x for name, x in data.attrs.items() if name != CHECKSUM})


def written_for(path: Path) -> str | None:
    """Return the hash of the inputs of results; None where the file cannot be read."""
    with suppress(Exception):  # what is raised for a damaged file is not documented
        return _read(path).attrs.get("inputs")
    return None


def checksums(data: Dataset) -> dict[str, str]:
    """Return the checksums of variables and attributes by their places, BLAKE2b in hexadecimal."""
    of = {
        f"variable '{name}'": _text(*x.dims)
        + _values(x.values)
        # In the order of their names; files do not tell one value from a list.
        + b"".join(_text(key) + _values(np.atleast_1d(x.attrs[key])) for key in sorted(x.attrs))
        for name, x in data.variables.items()
    }
    of |= {
        f"attribute '{name}'": _values(np.atleast_1d(value))
        for name, value in data.attrs.items()
        if name != CHECKSUM
    }
    return {place: hashlib.blake2b(x, digest_size=8).hexdigest() for place, x in of.items()}


def _values(values: np.ndarray[Any, Any]) -> bytes:
    kind = {"b": "<i8", "i": "<i8", "u": "<i8", "f": "<f8"}.get(values.dtype.kind, "text")
    head = _text(kind, *values.shape)
    if kind == "text":
        return head + _text(*values.ravel().tolist())
    numbers = values.astype(kind)
    return head + np.where(np.isnan(numbers), np.nan, numbers).astype(kind).tobytes()


def _text(*parts: object) -> bytes:
    return json.dumps(list(map(str, parts))).encode()


def _read(path: Path) -> ArrayDataset:
    """Return the contents of a netCDF file, which a process that damaged files may end reads."""
    variables, attributes = isolated(READER, path, EXPECTED, SECONDS)
    return ArrayDataset({name: Array(*x) for name, x in variables.items()}, attributes)
