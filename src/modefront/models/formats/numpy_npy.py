"""Arrays of NumPy; objects in them are refused, so that nothing is unpickled."""

from __future__ import annotations

import math
from pathlib import Path
from typing import IO, Any

import numpy as np

from modefront.models.formats.base import Header, MatrixFormat

READERS = {
    (1, 0): np.lib.format.read_array_header_1_0,
    (2, 0): np.lib.format.read_array_header_2_0,
}


def header(path: Path, _: str | None) -> Header:
    """Return the header of a file; see `MatrixFormat`."""
    with path.open("rb") as stream:
        shape, _order, dtype = array_header(stream)
        size = path.stat().st_size - stream.tell()
    check_size(shape, dtype, size)
    return Header(shape, math.prod(shape))


def read(path: Path, _: str | None) -> Any:
    """Return the array of a file; see `MatrixFormat`."""
    with path.open("rb") as stream:
        return np.lib.format.read_array(stream, allow_pickle=False)


def array_header(stream: IO[bytes]) -> tuple[tuple[int, ...], bool, np.dtype[Any]]:
    """Return shape, order and type of the array in a stream, which is left at its values.

    Raises ValueError for what is no array of plain values.
    """
    try:
        version = np.lib.format.read_magic(stream)
    except ValueError:
        raise ValueError("no array of NumPy, or the end in its first eight bytes") from None
    if version not in READERS:
        raise ValueError(f"an array of the version {version[0]}.{version[1]}")
    try:
        shape, order, dtype = READERS[version](stream)
    except ValueError:  # NumPy's messages are about its own options and syntax trees
        raise ValueError("a header that does not say type, order and shape of an array") from None
    if dtype.hasobject:
        raise ValueError("Object arrays cannot be loaded: they could run code")
    if any(n < 0 for n in shape):
        raise ValueError(f"an array of the shape {shape}")
    return shape, order, dtype


def check_size(shape: tuple[int, ...], dtype: np.dtype[Any], size: int) -> None:
    """Raise ValueError where an array of this shape and type takes other than ``size`` bytes."""
    needed = math.prod(shape) * dtype.itemsize
    if needed != size:
        raise ValueError(f"{needed} bytes of values announced, {size} there")


NUMPY_NPY = MatrixFormat(".npy", header, read)
