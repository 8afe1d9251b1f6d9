"""Numbers from large text files, read by vectorised parsers."""

from __future__ import annotations

import io
import re
from pathlib import Path
from typing import BinaryIO

import numpy as np
import scipy.io
import scipy.sparse

from modefront._typing import Floats
from modefront.complete import ended
from modefront.errors import InputError, reason
from modefront.inputs import available_memory
from modefront.isolated import IsolatedError, isolated, seconds_for
from modefront.models.formats.matrix_market import NUMERIC, read_entries
from modefront.programs.base import Entries, wrong

READER = f"{__name__}:lines_of_entries"

BLOCK = 2**24
"""Bytes that are read at once."""

BARE = re.compile(rb"(\d)([+-]\d{3})$")
"""An exponent of three digits, as Fortran writes it."""


class _Headed(io.RawIOBase):
    """A file with some lines before it."""

    def __init__(self, head: bytes, file: BinaryIO) -> None:
        super().__init__()
        self._head, self._file = head, file

    def readable(self) -> bool:
        return True

    def read(self, size: int = -1) -> bytes:
        head, self._head = self._head, b""
        return head or self._file.read(size)


def coordinates(path: Path, size: int, *, skip: int = 0) -> Entries:
    """Return the entries of a file of lines ``row column value``, counted from 1.

    ``skip`` bytes at its beginning are left out. SciPy's reader of Matrix Market files reads
    it, as that is what such lines are. Raises InputError where a line is none, or is cut off.
    """
    ended(path)
    count = 0
    with path.open("rb") as file:
        file.seek(skip)
        while block := file.read(BLOCK):
            if other := block.translate(None, NUMERIC):  # at some bytes the reader crashes
                raise wrong(path, "numbers", f"the byte {other[:1]!r}")
            count += block.count(b"\n")
    given = [str(size), str(count), str(skip)]
    seconds = seconds_for(path.stat().st_size)
    try:
        arrays, _ = isolated(READER, path, seconds, available_memory(), given)
    except IsolatedError as error:
        expected = f"lines 'row column value' with rows and columns from 1 to {size}"
        raise wrong(path, expected, reason(error)) from None
    return Entries(arrays["row"], arrays["column"], arrays["data"])


def lines_of_entries(
    path: Path, size: str, count: str, skip: str
) -> tuple[dict[str, np.ndarray], list[int]]:
    """Return the entries of such lines, read by SciPy: for processes that read files."""
    with path.open("rb") as file:
        file.seek(int(skip))
        head = f"%%MatrixMarket matrix coordinate real general\n{size} {size} {count}\n"
        matrix = scipy.io.mmread(_Headed(head.encode(), file))
    return {"row": matrix.row, "column": matrix.col, "data": matrix.data}, []


def columns(path: Path, separator: str, kinds: str, *, comment: str) -> list[np.ndarray]:
    """Return the columns of a table of numbers in a file.

    Lines that begin with ``comment`` are left out. ``kinds`` has a letter for each column, ``i``
    for whole numbers and ``f`` for real ones. Raises InputError for other lines.
    """
    import pandas as pd  # xarray needs it, so that it is there

    ended(path)
    types = {k: np.int32 if kind == "i" else np.float64 for k, kind in enumerate(kinds)}
    try:
        table = pd.read_csv(
            path,
            sep=separator,
            header=None,
            comment=comment,
            skipinitialspace=True,
            dtype=types,
            names=range(len(kinds)),
            index_col=False,
            engine="c",
        )
    except (ValueError, OSError, OverflowError) as error:
        expected = f"{len(kinds)} numbers in every line"
        raise wrong(path, expected, reason(error)) from None
    return [table[k].to_numpy() for k in range(len(kinds))]


def fixed_width(text: bytes, width: int) -> Floats:
    """Return numbers of a fixed width that follow each other without separators.

    A ``D`` stands for the ``E`` of an exponent, which Fortran leaves out before three digits.
    Raises ValueError where one is no number.
    """
    array = np.frombuffer(text.replace(b"D", b"E").replace(b"d", b"e"), dtype=f"S{width}")
    try:
        out: Floats = array.astype(float)
    except ValueError:
        out = np.array([float(BARE.sub(rb"\1E\2", field)) for field in array.tolist()])
    return out


def matrix_market(path: Path, *, square: bool = True) -> scipy.sparse.coo_array:
    """Return the matrix of a Matrix Market file, both triangles where it is symmetric.

    Raises InputError for a file that is none, is not ``square``, or holds complex numbers.
    """
    try:
        matrix = scipy.sparse.coo_array(read_entries(path, square=square))
    except InputError:
        raise
    except (ValueError, OSError, OverflowError, IsolatedError) as error:
        raise wrong(path, "a Matrix Market file", reason(error)) from None
    if matrix.dtype.kind not in "biuf":
        raise wrong(path, "real numbers", str(matrix.dtype))
    return matrix.astype(float)
