"""Interface of formats of matrix files, and the checks that all of them make."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from modefront.errors import Fault, InputError
from modefront.inputs import available_memory

MOST = 2**31 - 1
"""Degrees of freedom, as many as indices of 32 bits can count."""

PER_ENTRY, PER_ROW = 64, 64
"""Bytes that a matrix takes an entry and a row while it is read and made symmetric."""

RATIO, LARGE = 200, 64 * 10**6
"""Growth of compressed content, and the size in bytes, beyond which both are too much."""


@dataclass(frozen=True)
class Header:
    """Shape and number of entries that a file announces.

    Attributes
    ----------
    shape : numbers of rows and columns
    entries : number of entries that are stored, all of them for a full matrix
    """

    shape: tuple[int, ...]
    entries: int


@dataclass(frozen=True)
class MatrixFormat:
    """A format of files that hold matrices.

    Attributes
    ----------
    suffix : ending of the names of its files
    header : returns what a file announces, of a path and the name of a matrix in the file, None
        for the only one, without making room for the matrix; may raise anything for a damaged file
    read : returns the matrix, an array or a sparse one, likewise, of a file with a header that was
        found possible
    has_names : whether a file holds several matrices with names
    """

    suffix: str
    header: Callable[[Path, str | None], Header]
    read: Callable[[Path, str | None], Any]
    has_names: bool = False


def wrong(path: Path, expected: str, found: str, place: str = "file") -> InputError:
    """Return the error of a file, or of a place in it."""
    return InputError(Fault(str(path), place, expected, found))


def check_header(path: Path, header: Header) -> None:
    """Raise InputError where a matrix is not square, or larger than can be solved or kept."""
    shape = header.shape
    if len(shape) != 2 or shape[0] != shape[1] or shape[0] == 0:
        raise wrong(path, "a square matrix", " x ".join(map(str, shape)) or "a single number")
    if shape[0] > MOST:
        raise wrong(path, "a readable matrix", f"{shape[0]} rows, more than {MOST}")
    if header.entries > shape[0] ** 2 * 4:  # entries may repeat, but not that often
        found = f"{header.entries} entries announced for {shape[0]} x {shape[1]}"
        raise wrong(path, "a readable matrix", found)
    need, free = PER_ENTRY * header.entries + PER_ROW * shape[0], available_memory()
    if need > free:
        expected = f"a matrix that fits into the {free / 1e9:.3g} GB of memory that are free"
        found = f"{header.entries} entries in {shape[0]} rows, which take {need / 1e9:.3g} GB"
        raise wrong(path, expected, found)


def check_compressed(data: Any, index: Any, pointer: Any, lines: int) -> None:
    """Raise ValueError where the parts of a matrix of compressed rows or columns do not fit.

    ``pointer`` says where each of so many lines begins among the entries, and where the last ends;
    programs may keep room for entries beyond. SciPy would follow it out of the arrays.
    """
    if pointer.size != lines + 1 or pointer[0] != 0 or (np.diff(pointer) < 0).any():
        raise ValueError(f"{pointer.size} beginnings of {lines} rows or columns, or falling ones")
    if not len(data) == index.size >= int(pointer[-1]):
        raise ValueError(f"{len(data)} entries at {index.size} places, {pointer[-1]} announced")


def check_growth(path: Path, content: int, compressed: int) -> None:
    """Raise InputError where compressed content grows to more than data would."""
    if content > LARGE and content > RATIO * compressed:
        found = f"{content / 1e6:.4g} MB compressed to {compressed / 1e6:.3g} MB"
        raise wrong(path, "a readable matrix", found)
