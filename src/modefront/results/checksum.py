"""The checksum of results: over names, dimensions, types, values and attributes of all variables.

It does not depend on how a file lays these out: truth values and whole numbers count as integers of
64 bits, other numbers as floats of 64 bits, and texts in UTF-8.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

NAME = "checksum"
"""Attribute that holds the checksum, which it leaves out."""

BYTES = 16
"""Length of the checksum."""


def checksum(data: xr.Dataset) -> str:
    """Return the checksum of a dataset, BLAKE2b in hexadecimal digits."""
    digest = hashlib.blake2b(digest_size=BYTES)
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
        if name != NAME
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
