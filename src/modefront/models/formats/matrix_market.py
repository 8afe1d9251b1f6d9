"""Matrix Market files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import scipy.io

from modefront.models.formats.base import MatrixFormat, check_square, wrong

SHORTEST = 2
"""Least number of characters that an entry takes."""


def read(path: Path, _: str | None) -> Any:
    """Return the matrix of a file; see `MatrixFormat`."""
    rows, columns, entries, *_ = scipy.io.mminfo(path)
    check_square(path, (rows, columns))  # before reading: SciPy divides by the number of rows
    size = path.stat().st_size
    if entries > size / SHORTEST:  # before room is made for them
        raise wrong(path, "a readable matrix", f"{entries} entries announced in {size} bytes")
    return scipy.io.mmread(path)


MATRIX_MARKET = MatrixFormat(".mtx", read)
