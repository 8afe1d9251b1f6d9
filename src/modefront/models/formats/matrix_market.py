"""Matrix Market files.

SciPy's reader is fast, but ends the process at some bytes that no matrix holds; so the header is
read here, what follows is looked through, and the reader has a process of its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import scipy.io
import scipy.sparse

from modefront.complete import counted, ended, first_repeated
from modefront.inputs import available_memory
from modefront.isolated import isolated, seconds_for
from modefront.models.formats.base import Header, MatrixFormat, check_header, wrong

SHORTEST = {"pattern": 4, "integer": 6, "real": 6, "complex": 8}
"""Characters that a line of an entry takes at least, by the kind of numbers."""

SYMMETRIES = ("general", "symmetric", "skew-symmetric", "hermitian")

READER = f"{__name__}:entries"

LONGEST = 2**16
"""Characters of a line of the header, at most; the format allows 1024."""

COMMENTS = 10**5
"""Lines of comments, at most."""

NUMERIC = b"0123456789+-.eEdDnNaAiIfFtTyY \t\r\n"
"""Bytes of numbers, of nan and infinity among them, and of what separates them."""

CHUNK = 2**24
"""Bytes that are checked at once."""

WHAT = "a readable matrix"


@dataclass(frozen=True)
class _Announced:
    """Header of a file: its words, the matrix, and where the entries begin."""

    layout: str
    numbers: str
    symmetry: str
    header: Header
    start: int


def header(path: Path, _: str | None) -> Header:
    """Return the header of a file; see `MatrixFormat`."""
    return _announced(path).header


def read(path: Path, _: str | None) -> Any:
    """Return the matrix of a file; see `MatrixFormat`."""
    return read_entries(path)


def read_entries(path: Path, *, square: bool = True) -> Any:
    """Return the matrix of a file, which may have another shape where it need not be ``square``.

    Raises InputError and ValueError for a file that is damaged.
    """
    announced = _announced(path, square=square)
    size = path.stat().st_size - announced.start
    stored = announced.header.entries
    if announced.layout == "array":
        rows = announced.header.shape[0]
        triangle = rows * (rows - 1 if announced.symmetry == "skew-symmetric" else rows + 1) // 2
        stored = rows * announced.header.shape[1] if announced.symmetry == "general" else triangle
        shortest = 2
    else:
        shortest = SHORTEST[announced.numbers]
    ended(path)
    if stored * shortest > size:
        raise wrong(path, WHAT, f"{stored} entries announced in {size} bytes")
    found, before = 0, b" "
    with path.open("rb") as stream:
        stream.seek(announced.start)
        while chunk := stream.read(CHUNK):
            found += len(chunk.split()) - (len((before + chunk[:1]).strip()) == 2)
            before = chunk[-1:]
            if other := chunk.translate(None, NUMERIC):
                raise wrong(path, WHAT, f"the byte {other[:1]!r} among the entries")
    if announced.layout == "array":
        counted(path, "file", "values", stored * (1 + (announced.numbers == "complex")), found)
    seconds = seconds_for(path.stat().st_size)
    arrays, shape = isolated(READER, path, seconds, available_memory())
    if "values" in arrays:
        return arrays["values"]
    repeated = first_repeated(arrays["row"], arrays["column"], int(shape[1]))
    if repeated is not None:
        row, column = (int(arrays[name][repeated]) + 1 for name in ("row", "column"))
        raise wrong(path, f"{WHAT}: each entry once", "it again", f"row {row}, column {column}")
    entries = arrays["data"], (arrays["row"], arrays["column"])
    return scipy.sparse.coo_array(entries, shape=(int(shape[0]), int(shape[1])))


def entries(path: Path) -> tuple[dict[str, np.ndarray[Any, Any]], list[int]]:
    """Return the entries of a file as plain arrays, by SciPy: for processes that read files."""
    matrix = scipy.io.mmread(path)
    if isinstance(matrix, np.ndarray):
        return {"values": matrix}, list(matrix.shape)
    return {"data": matrix.data, "row": matrix.row, "column": matrix.col}, list(matrix.shape)


def _announced(path: Path, *, square: bool = True) -> _Announced:
    """Return the header of a file; raises InputError for one that the format does not have."""
    with path.open("rb") as stream:
        words = stream.readline(LONGEST).decode("utf-8", "replace").split()
        if len(words) != 5 or words[0] != "%%MatrixMarket" or words[1].lower() != "matrix":
            raise wrong(path, WHAT, "no line '%%MatrixMarket matrix ...'", "line 1")
        layout, numbers, symmetry = (word.lower() for word in words[2:])
        for word, known in (
            (layout, ("coordinate", "array")),
            (numbers, tuple(SHORTEST)),
            (symmetry, SYMMETRIES),
        ):
            if word not in known:
                raise wrong(path, f"{WHAT}: {' or '.join(known)}", f"'{word}'", "line 1")
        if (layout, numbers) == ("array", "pattern"):
            raise wrong(path, WHAT, "an array of a pattern, which has no values", "line 1")
        for number in range(2, COMMENTS):
            line = stream.readline(LONGEST)
            if not line:
                raise wrong(path, WHAT, "the end of the file", f"line {number}")
            if line.strip() and not line.lstrip().startswith(b"%"):
                break
        counts = line.split()
        expected = 3 if layout == "coordinate" else 2
        if len(counts) != expected or not all(x.isdigit() and len(x) < 20 for x in counts):
            text = line.decode("utf-8", "replace").strip()
            raise wrong(path, f"{WHAT}: {expected} sizes", f"'{text}'", f"line {number}")
        sizes = [int(x) for x in counts]
        entries = sizes[2] if layout == "coordinate" else sizes[0] * sizes[1]
        header = Header((sizes[0], sizes[1]), entries)
        if square:
            check_header(path, header)
        elif sizes[0] * sizes[1] < entries:
            raise wrong(path, WHAT, f"{entries} entries announced for {sizes[0]} x {sizes[1]}")
        return _Announced(layout, numbers, symmetry, header, stream.tell())


MATRIX_MARKET = MatrixFormat(".mtx", header, read)
