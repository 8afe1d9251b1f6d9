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

import re
from collections.abc import Iterator, Mapping
from operator import length_hint
from pathlib import Path
from typing import TypeAlias

import numpy as np
import scipy.sparse
from scipy.io import FortranEOFError, FortranFile

from modefront._typing import Floats, Ints
from modefront.errors import reason
from modefront.inputs import ended, fortran, wrong

STRING = 65536  # unit of the length in the header of a string

PRECISIONS = {1: 6e-8, 2: 1e-15}  # relative errors of single and double; others are complex

Op4Matrix: TypeAlias = tuple[scipy.sparse.coo_array, float]  # with the relative error of entries

DmigMatrix: TypeAlias = tuple[Ints, Floats, float]
"""Labels (entries, 4) of rows and columns, each a node and a component; values (entries,); and the
relative error of these."""


def read_op4(path: Path) -> Mapping[str, Op4Matrix]:
    """Return all matrices of a file by their names; raises InputError for broken, complex ones."""
    data = path.read_bytes()
    lengths = {order: int(np.frombuffer(data[:4].ljust(4), order + "i4")[0]) for order in "<>"}
    binary = next(((order, x // 6) for order, x in lengths.items() if x in (24, 48)), None)
    lines = [] if binary else data.split(b"\n")
    ahead = iter(lines)
    try:
        return dict(_binary(path, *binary) if binary else _text(ahead))
    except (ValueError, OSError, TypeError) as error:  # Fortran's errors are any of these
        expected = "whole matrices of real numbers of Nastran's OUTPUT4"
        place = f"line {len(lines) - length_hint(ahead)}" if lines else "file"
        raise wrong(path, expected, f"{reason(error)}; is it cut off?", place) from None


class _Columns:
    """Columns of a matrix: values in consecutive rows, in the order of a file."""

    def __init__(self, name: str, header: list[int]) -> None:
        self.columns, rows, _, kind = header
        self.name, self.precision = name.strip().upper(), PRECISIONS.get(kind, 0.0)
        if not self.precision:
            raise ValueError(f"numbers of type {kind} (complex) in '{self.name}'")
        self.rows, self.big, self.column = abs(rows), rows < 0, 0
        self.places: list[tuple[int, int, int]] = []  # column, first row, words

    def begin(self, column: int) -> bool:
        """Begin a column; return whether it is not the one beyond the last, which ends all."""
        if not self.column < column <= self.columns + 1:
            raise ValueError(f"column {column} of '{self.name}' behind {self.column}")
        self.column = column
        return column <= self.columns

    def matrix(self, values: Floats, length: Ints, precision: float = 0.0) -> tuple[str, Op4Matrix]:
        """Return name and matrix with the values of all strings, of which each has a length."""
        column, first, _ = np.array(self.places, dtype=np.intp).reshape(-1, 3).T
        start = first - 1 - (np.cumsum(length) - length)
        row = (np.repeat(start, length) + np.arange(values.size)).astype(np.int32)
        column = np.repeat(column - 1, length).astype(np.int32)
        used = values != 0
        entries = values[used].astype(float), (row[used], column[used])
        A = scipy.sparse.coo_array(entries, shape=(self.rows, self.columns))
        return self.name, (A, max(self.precision, precision))


def _binary(path: Path, order: str, word: int) -> Iterator[tuple[str, Op4Matrix]]:
    integer = np.dtype(f"{order}i{word}")
    with FortranFile(path, header_dtype=order + "u4") as file:

        def record() -> bytes:
            try:
                return bytes(file.read_record("u1"))
            except FortranEOFError:
                return b""

        while head := record():
            if len(head) != 6 * word:
                raise ValueError(f"a record of {len(head)} bytes in place of a header")
            header = np.frombuffer(head, integer, 4).tolist()
            matrix, bodies = _Columns(head[4 * word :].decode("latin-1"), header), list[Ints]()
            real = np.dtype(f"{order}f{8 if word == 8 or header[3] == 2 else 4}")
            while True:
                content = record()
                column, row, count = np.frombuffer(content, integer, 3).tolist()
                if not matrix.begin(column):
                    break
                if len(content) != (3 + count) * word:
                    found = f"{len(content) / word - 3:g} of {count} words"
                    raise ValueError(f"{found} in column {column} of '{matrix.name}'")
                body = np.frombuffer(content, integer, offset=3 * word)
                bodies.append(body if row > 0 else _strings(matrix, body))
                if row > 0:
                    matrix.places.append((column, row, count))
            values = np.concatenate([np.zeros(0, integer), *bodies]).astype(integer).view(real)
            words = np.array([x for *_, x in matrix.places], dtype=np.intp)
            per_value = real.itemsize // word
            if (words % per_value).any():
                raise ValueError(f"half a value in '{matrix.name}'")
            yield matrix.matrix(values, words // per_value)


def _strings(matrix: _Columns, body: Ints) -> Ints:
    """Return the words of the values of all strings of a column, given as words."""
    words = body.astype(body.dtype.newbyteorder("=")).data  # Python's integers only where needed
    position, header = 0, 1 + matrix.big
    keep = np.ones(body.size, bool)
    while position < body.size:
        if matrix.big and position + 1 < body.size:
            length, row = words[position] - 1, words[position + 1]
        else:
            length, row = words[position] // STRING - 1, words[position] % STRING
        after = position + header + length
        if length <= 0 or row <= 0 or after > body.size:
            raise ValueError(f"strings that do not fill column {matrix.column} of '{matrix.name}'")
        keep[position : position + header] = False
        matrix.places.append((matrix.column, row, length))
        position = after
    return body[keep]


def _text(lines: Iterator[bytes]) -> Iterator[tuple[str, Op4Matrix]]:
    """Yield the matrices of a text.

    Lines of values have a point, headers of strings are shorter than those of columns. Headers
    count words: of a double two, or one. Those of columns count the headers of strings, or not.
    """
    for head in map(bytes.rstrip, lines):
        if not head:
            continue
        text = head.decode("latin-1")
        matrix = _Columns(text[32:40], [int(text[k : k + 8]) for k in range(0, 32, 8)])
        form = re.search(r"\d+[EDG](\d+)\.(\d+)", text[40:].upper())
        if form is None:
            raise ValueError(f"{text[:60]!r} without a format, such as 1P,3E23.16")
        width, texts, counts, sums = int(form[1]), list[bytes](), list[int](), list[list[int]]()
        for line in map(bytes.rstrip, lines):
            if b"." in line and counts:
                fields = -(-len(line) // width)
                texts.append(line.ljust(fields * width))
                counts[-1] += fields
                continue
            if len(line) <= 16 and sums:
                whole = int(line[:8] if matrix.big else line)
                length, row = (whole, int(line[8:])) if matrix.big else divmod(whole, STRING)
                sums[-1][1] += length - 1
                sums[-1][2] += 1 + matrix.big
                matrix.places.append((matrix.column, row, length - 1))
            else:
                column, row, words = int(line[:8]), int(line[8:16]), int(line[16:])
                if not matrix.begin(column):
                    break
                if not row:
                    sums.append([words, 0, 0])
                    continue
                matrix.places.append((column, row, words))
            counts.append(0)
        else:
            raise ValueError(f"the end of the file in '{matrix.name}'")
        if b"." not in next(lines, b""):
            raise ValueError(f"no value behind the last column of '{matrix.name}'")
        stated, given = np.array([words for *_, words in matrix.places]), np.array(counts)
        total, strings, headers = np.array(sums).reshape(-1, 3).T
        if not any((stated == size * given).all() for size in (1, 2)) or not any(
            (total == strings + k * headers).all() for k in (0, 1)
        ):
            raise ValueError(f"other numbers of values in '{matrix.name}' than its headers say")
        content = b"".join(texts).replace(b"D", b"E").replace(b"d", b"e")
        fixed = np.frombuffer(content, f"S{width}")
        try:
            values = fixed.astype(float)
        except ValueError:  # Fortran leaves out the E before three digits
            values = np.array([fortran(field.decode("latin-1")) for field in fixed.tolist()])
        yield matrix.matrix(values, given, 10.0 ** -int(form[2]))


def read_dmig(path: Path) -> Mapping[str, DmigMatrix]:
    """Return all matrices of a punch file by their names; raises InputError likewise."""
    ended(path)
    entries: dict[str, list[tuple[tuple[int, ...], float, str]]] = {}
    with path.open(encoding="latin-1") as stream:
        header, column, name = "", tuple[int, ...](), ""
        for number, line in enumerate(stream, start=1):
            fields = line[8:24].strip(), line[24:40].strip(), line[40:56].strip()
            try:
                if line.startswith("DMIG "):
                    header, column = line[8:16].strip().upper(), ()
                    if header in entries:
                        raise ValueError(f"the header of '{header}' again")
                    if line[32:40].strip() in ("3", "4"):
                        raise ValueError("complex numbers")
                elif line.startswith("DMIG*"):
                    name, column = fields[0].upper(), (int(fields[1]), int(fields[2]))
                    if header not in ("", name):
                        raise ValueError(f"a column of '{name}' behind the header of '{header}'")
                    entries.setdefault(name, [])
                elif line.startswith("*") and line.strip() != "*" and (entries or header):
                    if not column:
                        raise ValueError("an entry without a column ('DMIG*') before it")
                    label = int(fields[0]), int(fields[1]), *column
                    entries[name].append((label, fortran(fields[2]), fields[2]))
            except ValueError as error:
                expected = "a line of DMIG of real numbers, in large fields"
                raise wrong(path, expected, reason(error), f"line {number}") from None
    if not entries:
        raise wrong(path, "DMIG entries in large fields ('DMIG*')", "none")
    known = (text.lstrip("+-").upper() for x in entries.values() for *_, text in x[: 10**4])
    behind = (re.split("[DE+-]", text)[0].partition(".")[2] for text in known)
    precision = 10.0 ** -max(map(len, behind), default=15)
    out = {}
    for name, rows in entries.items():
        labels = np.array([label for label, *_ in rows], dtype=np.intp).reshape(-1, 4)
        out[name] = labels, np.array([value for _, value, _ in rows]), precision
    return out
