"""Numbers from large text files, read by vectorised parsers."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from modefront._typing import Floats
from modefront.complete import ended
from modefront.errors import reason
from modefront.programs.base import Entries, wrong

BARE = re.compile(rb"(\d)([+-]\d{3})$")
"""An exponent of three digits, as Fortran writes it."""


def coordinates(path: Path) -> Entries:
    """Return the entries of a file of lines ``row column value``, counted from 1.

    Raises InputError where a line is none, or is cut off.
    """
    row, column, value = columns(path, r"\s+", "iif", comment="#")
    return Entries(row - 1, column - 1, value)


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
