r"""Matrices in files of Nastran: OUTPUT4, binary or text, and DMIG entries of punch files.

A file of OUTPUT4 holds dense, sparse or BIGMAT matrices one after the other. Each has a header
(columns, rows, form, type, name) and then its columns, of which each has a header (column, first
row, words): dense where the first row is given; where it is 0, strings of consecutive rows follow,
each with a header of its own,

- one word IS with L = IS / 65536 - 1 words and first row IS - 65536 (L + 1), or
- for BIGMAT, whose number of rows is negative, two words: L + 1 and the first row.

A column beyond the last one ends the matrix. In binary files these are records of Fortran; words
have 4 bytes (or 8, where integers have 8), so that a double may take two. Text has headers in
fields of 8 characters and values in the format that the first line names, such as ``1P,3E23.16``.

Each column of DMIG has a line ``DMIG*  NAME  node  component``, followed by a line
``*  node  component  value`` for every row, in fields of 16 characters behind one of 8. A component
of 0 is a scalar point.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TypeAlias

import numpy as np
from scipy.io import FortranEOFError, FortranFile

from modefront._typing import Floats, Ints
from modefront.errors import reason
from modefront.inputs import counted, ended, fortran, wrong
from modefront.programs.reading import Entries, fixed_width

STRING = 65536
"""Unit of the length in the header of a string."""

PRECISIONS = {1: 6e-8, 2: 1e-15}
"""Relative errors of the types of numbers: single and double; others are complex."""

EXPECTED = "a matrix of Nastran's OUTPUT4"


def read_op4(path: Path) -> Mapping[str, Entries]:
    """Return all matrices of a file by their names.

    Raises InputError for a file that is none of OUTPUT4, is cut off or holds complex numbers.
    """
    data = path.read_bytes()
    if len(data) < 8:
        raise wrong(path, EXPECTED, f"{len(data)} bytes")
    for order in "<>":
        length = int(np.frombuffer(data, order + "i4", 1)[0])
        if length in (24, 48):
            return dict(_binary(path, order, length // 6))
    return dict(_text(path, deque(line.rstrip() for line in data.split(b"\n"))))


class _Pieces:
    """Values in consecutive rows of the columns of a matrix, in the order of a file."""

    def __init__(self, path: Path, name: str, header: list[int]) -> None:
        self.columns, rows, _, kind = header
        if kind not in PRECISIONS:
            raise wrong(path, "real numbers", f"numbers of type {kind} (complex) in '{name}'")
        if rows == 0:
            raise wrong(path, "matrices with rows", f"none in '{name}'")
        self.path, self.name, self.precision = path, name, PRECISIONS[kind]
        self.rows, self.big, self.column = abs(rows), rows < 0, 0
        self.places: list[tuple[int, int, int]] = []  # column, first row, length

    def begin(self, column: int) -> bool:
        """Begin a column; return whether it is not the one beyond the last, which ends all."""
        if not self.column < column <= self.columns + 1:
            expected = f"columns of '{self.name}' once, from 1 to {self.columns + 1}"
            raise wrong(self.path, expected, f"{column} behind {self.column}")
        self.column = column
        return column <= self.columns

    def matrix(self, values: np.ndarray, precision: float = 0.0) -> tuple[str, Entries]:
        """Return name and matrix with the values of all pieces, one behind the other."""
        column, first, length = np.array(self.places, dtype=np.intp).reshape(-1, 3).T
        start = first - 1 - (np.cumsum(length) - length)
        row = (np.repeat(start, length) + np.arange(values.size)).astype(np.int32)
        column = np.repeat(column - 1, length).astype(np.int32)
        used = values != 0
        shape, precision = (self.rows, self.columns), max(self.precision, precision)
        entries = Entries(row[used], column[used], values[used].astype(float), shape, precision)
        return self.name, entries


def _binary(path: Path, order: str, word: int) -> Iterator[tuple[str, Entries]]:
    integer = f"{order}i{word}"
    with FortranFile(path, header_dtype=order + "u4") as file:

        def record() -> bytes:
            try:
                return bytes(file.read_record("u1"))
            except FortranEOFError:
                return b""
            except (OSError, ValueError) as error:
                expected = f"whole records of Fortran ({EXPECTED})"
                raise wrong(path, expected, f"a file that is cut off: {reason(error)}") from None

        while head := record():
            if len(head) != 6 * word:
                raise wrong(path, "the header of a matrix", f"a record of {len(head)} bytes")
            name = head[4 * word :].decode("latin-1").strip().upper()
            header = np.frombuffer(head, integer, 4).tolist()
            pieces, values = _Pieces(path, name, header), [np.zeros(0)]
            real = np.dtype(f"{order}f{8 if word == 8 or header[3] == 2 else 4}")
            while True:
                content = record()
                if len(content) < 3 * word:
                    found = f"a record of {len(content)} bytes in '{name}'; is it cut off?"
                    raise wrong(path, "columns of a matrix, and its end", found)
                column, row, count = np.frombuffer(content, integer, 3).tolist()
                if not pieces.begin(column):
                    break
                body = content[3 * word :]
                counted(path, f"column {column} of '{name}'", "words", count, len(body) / word)
                if row > 0:
                    values.append(np.frombuffer(body, real))
                    pieces.places.append((column, row, values[-1].size))
                else:
                    values.append(_strings(pieces, np.frombuffer(body, integer), real))
            yield pieces.matrix(np.concatenate(values))


def _strings(pieces: _Pieces, body: np.ndarray, real: np.dtype[np.floating]) -> np.ndarray:
    """Return the values of all strings of a column, given as words; they have to fill it."""
    words = body.astype(body.dtype.newbyteorder("=")).data  # Python's integers only where needed
    position, header, per_value = 0, 1 + pieces.big, max(real.itemsize // body.itemsize, 1)
    keep = np.ones(body.size, bool)
    while position < body.size:
        if pieces.big and position + 1 < body.size:
            length, row = words[position] - 1, words[position + 1]
        else:
            length, row = words[position] // STRING - 1, words[position] % STRING
        after = position + header + length
        if length <= 0 or row <= 0 or after > body.size or length % per_value:
            found = f"others in column {pieces.column} of '{pieces.name}'"
            raise wrong(pieces.path, "strings that fill a column", found)
        keep[position : position + header] = False
        pieces.places.append((pieces.column, row, length // per_value))
        position = after
    return body[keep].view(real)


def _text(path: Path, lines: deque[bytes]) -> Iterator[tuple[str, Entries]]:
    """Yield the matrices of a text; lines of values are those with a point."""
    while lines:
        if not (text := lines.popleft().decode("latin-1")):
            continue
        try:
            header = [int(text[k : k + 8]) for k in range(0, 32, 8)]
        except ValueError:
            raise wrong(path, EXPECTED, repr(text[:60])) from None
        form = re.search(r"\d+[EDG](\d+)\.(\d+)", text[40:].upper())
        if form is None:
            raise wrong(path, f"{EXPECTED} with its format, such as 1P,3E23.16", repr(text[:60]))
        pieces, width = _Pieces(path, text[32:40].strip().upper(), header), int(form[1])
        texts = _columns(pieces, lines, width)
        if not lines or b"." not in lines.popleft():
            raise wrong(path, f"a value behind the last column of '{pieces.name}'", "none")
        try:
            values = fixed_width(b"".join(texts), width)
        except ValueError as error:
            raise wrong(path, f"numbers of {width} characters", reason(error)) from None
        yield pieces.matrix(values, 10.0 ** -int(form[2]))


def _columns(pieces: _Pieces, lines: deque[bytes], width: int) -> list[bytes]:
    """Take the lines of all columns, and return their values as text.

    Headers count words: of a double either two, or one. They count those of headers of strings,
    or not.
    """
    texts: list[bytes] = []
    sizes, headers = {1, 2}, {0, 1}
    path, name = pieces.path, pieces.name

    def numbers(*fields: bytes) -> list[int]:
        """Return the whole numbers in fields of a header."""
        try:
            return [int(field) for field in fields]
        except ValueError:
            found = repr(b"".join(fields).decode("latin-1")[:40])
            raise wrong(path, f"headers of columns in '{name}'", found) from None

    def take(row: int, words: int) -> None:
        """Take the lines of values from the present one on, so many words in all."""
        count = 0
        while lines and b"." in lines[0]:
            fields = -(-len(lines[0]) // width)
            texts.append(lines.popleft().ljust(fields * width))
            count += fields
        sizes.intersection_update(size for size in (1, 2) if words == size * count)
        if not sizes:
            expected = f"as many values in every column of '{name}' as its headers say"
            raise wrong(path, expected, f"{count} values in {words} words")
        pieces.places.append((pieces.column, row, count))

    while True:
        if not lines or not lines[0]:
            raise wrong(path, f"all columns of '{name}', and its end", "a file that is cut off")
        line = lines.popleft()
        column, row, words = numbers(line[:8], line[8:16], line[16:])
        if not pieces.begin(column):
            return texts
        if row:
            take(row, words)
            continue
        strings = count = 0
        while lines and 0 < len(lines[0]) <= 16:
            line = lines.popleft()
            length, first = (
                numbers(line[:8], line[8:]) if pieces.big else divmod(numbers(line)[0], STRING)
            )
            take(first, length - 1)
            strings, count = strings + length - 1, count + 1 + pieces.big
        headers.intersection_update(k for k in (0, 1) if strings + k * count == words)
        if not headers:
            expected = f"as many words in column {column} of '{name}' as its header says"
            raise wrong(path, expected, str(words))


DmigMatrix: TypeAlias = tuple[Ints, Floats, float]
"""Labels (entries, 4) of rows and columns, each a node and a component; values (entries,); and the
relative error of these."""


def read_dmig(path: Path) -> Mapping[str, DmigMatrix]:
    """Return all matrices of a punch file by their names.

    Raises InputError for a file without any, with complex numbers, or cut off.
    """
    ended(path)
    entries: dict[str, list[tuple[list[int], str]]] = {}
    header, column, name = None, list[int](), ""
    with path.open(encoding="latin-1") as stream:
        for number, line in enumerate(stream, start=1):
            place = f"line {number}"
            if line.startswith("DMIG "):
                header, column = line[8:16].strip(), []
                if header.upper() in entries:
                    expected = f"the header 'DMIG {header}' once, before its columns"
                    raise wrong(path, expected, "one after them", place)
                kind = line[32:40].strip()
                if kind.isdigit() and int(kind) in (3, 4):
                    raise wrong(path, "real numbers", f"type {int(kind)} (complex)", place)
            elif line.startswith("DMIG*"):
                name = line[8:24].strip()
                if header not in (None, name):
                    expected = f"a header 'DMIG {name}' before its columns"
                    raise wrong(path, expected, repr(header), place)
                column = _label(path, place, line[24:40], line[40:56])
                entries.setdefault(name.upper(), [])
            elif line.startswith("*") and line.strip() != "*" and (entries or header is not None):
                if not column:
                    raise wrong(path, "a column ('DMIG*') before its entries", "none", place)
                label = _label(path, place, line[8:24], line[24:40])
                entries[name.upper()].append(([*label, *column], line[40:56]))
    if not entries:
        raise wrong(path, "DMIG entries in large fields ('DMIG*')", "none")
    known = (text.strip().lstrip("+-").upper() for x in entries.values() for _, text in x[: 10**4])
    behind = (re.split("[DE+-]", text)[0].partition(".")[2] for text in known)
    precision, out = 10.0 ** -max(map(len, behind), default=15), dict[str, DmigMatrix]()
    for each, rows in entries.items():
        labels = np.array([labels for labels, _ in rows], dtype=np.intp).reshape(-1, 4)
        try:
            out[each] = labels, np.array([fortran(text) for _, text in rows]), precision
        except ValueError as error:
            raise wrong(path, "numbers in the fourth field", reason(error)) from None
    return out


def _label(path: Path, place: str, *fields: str) -> list[int]:
    try:
        return [int(field) for field in fields]
    except ValueError as error:
        raise wrong(path, "nodes and components in fields of 16", reason(error), place) from None
