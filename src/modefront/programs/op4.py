r"""OUTPUT4 files of Nastran: binary or text, matrices dense, sparse, or sparse and BIGMAT.

A file holds matrices one after the other. Each has a header (columns, rows, form, type, name) and
then its columns, of which each has a header (column, first row, words): dense where the first row
is given; where it is 0, strings of consecutive rows follow, each with a header of its own,

- one word IS with L = IS / 65536 - 1 words and first row IS - 65536 (L + 1), or
- for BIGMAT, whose number of rows is negative, two words: L + 1 and the first row.

A column beyond the last one ends the matrix. In binary files these are records of Fortran; words
have 4 bytes (or 8, where integers have 8), so that a double may take two. Text has headers in
fields of 8 characters and values in the format that the first line names, such as ``1P,3E23.16``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from modefront._typing import Bools, Floats, Ints
from modefront.errors import reason
from modefront.inputs import counted
from modefront.programs.base import Entries, fixed_width, wrong

STRING = 65536
"""Unit of the length in the header of a string."""

CHUNK = 2**20
"""Lines of text that are converted at once."""

PRECISIONS = {1: 6e-8, 2: 1e-15}
"""Relative errors of the types of numbers: single and double; others are complex."""

EXPECTED = "a matrix of Nastran's OUTPUT4"


@dataclass(frozen=True, eq=False)
class Op4Matrix:
    """A matrix of a file.

    Attributes
    ----------
    rows, columns : size
    precision : relative error of its numbers
    entries : rows and columns from 0, and values
    """

    rows: int
    columns: int
    precision: float
    entries: Entries


def read_op4(path: Path) -> Mapping[str, Op4Matrix]:
    """Return all matrices of a file by their names.

    Raises InputError for a file that is none of OUTPUT4, is cut off or holds complex numbers.
    """
    data = np.fromfile(path, dtype=np.uint8)
    if data.size < 8:
        raise wrong(path, EXPECTED, f"{data.size} bytes")
    layout = _Layout.of(data)
    return dict(_text(path, data) if layout is None else _binary(path, data, layout))


# Binary files


@dataclass(frozen=True)
class _Layout:
    """Layout of a binary file: byte order, and the bytes of a word."""

    order: str
    word: int

    @staticmethod
    def of(data: np.ndarray) -> _Layout | None:
        """Return the layout that the length of the first record tells; None for text."""
        for order in "<>":
            length = int(data[:4].view(order + "i4")[0])
            if length in (24, 48):
                return _Layout(order, length // 6)
        return None


def _binary(path: Path, data: np.ndarray, layout: _Layout) -> Iterator[tuple[str, Op4Matrix]]:
    pad = np.zeros(-data.size % 4, np.uint8)
    lengths = np.concatenate([data, pad]).view(layout.order + "i4")
    position = 0
    while position < data.size:
        head, position = _record(path, data, lengths, position)
        if head.size != 6 * layout.word:
            raise wrong(path, "the header of a matrix", f"a record of {head.size} bytes")
        integers = head[: 4 * layout.word].view(f"{layout.order}i{layout.word}").tolist()
        name = head[4 * layout.word :].tobytes().decode("latin-1").strip().upper()
        columns, rows, _, kind = integers
        precision = _precision(path, name, kind, rows)
        contents = _Columns(layout, kind, rows < 0)
        while True:
            column, position = _record(path, data, lengths, position)
            if not contents.add(path, name, column, columns):
                break
        yield name, Op4Matrix(abs(rows), columns, precision, contents.entries())


def _record(
    path: Path, data: np.ndarray, lengths: np.ndarray, position: int
) -> tuple[np.ndarray, int]:
    """Return the record at a position, and the position of the next one."""
    end = position + 4 + (int(lengths[position // 4]) if position + 4 <= data.size else 0)
    if position + 4 > data.size or end < position + 4 or end + 4 > data.size or position % 4:
        raise wrong(path, "whole matrices, each with its end", "a file that is cut off")
    if lengths[end // 4] != lengths[position // 4]:
        raise wrong(path, f"records of Fortran ({EXPECTED})", "lengths that differ")
    return data[position + 4 : end], end + 4


def _precision(path: Path, name: str, kind: int, rows: int) -> float:
    if kind not in PRECISIONS:
        raise wrong(path, "real numbers", f"numbers of type {kind} (complex) in '{name}'")
    if rows == 0:
        raise wrong(path, "matrices with rows", f"none in '{name}'")
    return PRECISIONS[kind]


def _check_order(path: Path, name: str, listed: Sequence[int], columns: int) -> None:
    """Raise InputError where numbers of columns do not ascend to the one beyond the last."""
    for before, column in pairwise(listed):
        if not before < column <= columns + 1:
            expected = f"columns of '{name}' once, from 1 to {columns + 1}"
            raise wrong(path, expected, f"{column} behind {before}")


class _Columns:
    """Columns of a matrix of a binary file, gathered one after the other."""

    def __init__(self, layout: _Layout, kind: int, big: bool) -> None:
        self._integer = f"{layout.order}i{layout.word}"
        size = 8 if layout.word == 8 or kind == 2 else 4
        self._real = f"{layout.order}f{size}"
        self._per_value = size // layout.word or 1
        self._word, self._big, self._last = layout.word, big, 0
        self._column: list[int] = []
        self._first: list[int] = []
        self._length: list[int] = []
        self._values: list[np.ndarray] = []

    def add(self, path: Path, name: str, record: np.ndarray, columns: int) -> bool:
        """Take a column; return whether it is not the one beyond the last, which ends all."""
        words = record[: 3 * self._word].view(self._integer).tolist()
        if len(words) < 3:
            raise wrong(path, "columns of a matrix", f"a record of {record.size} bytes in '{name}'")
        column, row, count = words
        _check_order(path, name, [self._last, column], columns)
        self._last = column
        if column > columns:
            return False
        body = record[3 * self._word :]
        counted(path, f"column {column} of '{name}'", "words", count, body.size / self._word)
        if row > 0:
            values = body.view(self._real)
            self._take(column, row, values.size)
            self._values.append(values)
            return True
        strings = self._strings(body)
        if strings is None:
            raise wrong(
                path, "strings that fill a column", f"others in column {column} of '{name}'"
            )
        self._values.append(strings)
        self._column += [column] * (len(self._length) - len(self._column))
        return True

    def _take(self, column: int, row: int, length: int) -> None:
        self._column.append(column)
        self._first.append(row)
        self._length.append(length)

    def _strings(self, body: np.ndarray) -> np.ndarray | None:
        """Return the values of all strings of a column; None where they do not fill it."""
        native = body.view(self._integer).astype(f"=i{self._word}")
        words = native.data  # its items are Python's integers, made only where needed
        position, end = 0, len(words)
        header = 2 if self._big else 1
        headers: list[int] = []
        while position < end:
            if self._big and position + 1 < end:
                length, row = words[position] - 1, words[position + 1]
            else:
                length = words[position] // STRING - 1
                row = words[position] - STRING * (length + 1)
            if (
                length <= 0
                or row <= 0
                or position + header + length > end
                or length % self._per_value
            ):
                return None
            headers.append(position)
            self._first.append(row)
            self._length.append(length // self._per_value)
            position += header + length
        keep = np.ones(len(words), bool)
        for k in range(header):
            keep[np.array(headers, dtype=np.intp) + k] = False
        return body.reshape(-1, self._word)[keep].reshape(-1).view(self._real)

    def entries(self) -> Entries:
        """Return rows, columns and values of all columns."""
        values = np.concatenate(self._values) if self._values else np.zeros(0)
        length = np.array(self._length, dtype=np.intp)
        row = _runs(np.array(self._first, dtype=np.intp) - 1, length)
        column = np.repeat(np.array(self._column, dtype=np.int32) - 1, length)
        return _without_zeros(row, column, values.astype(float))


def _runs(first: Ints, length: Ints) -> np.ndarray:
    """Return first, first + 1, … for every run of a length, one run after the other."""
    starts = np.cumsum(length) - length
    total = int(length.sum())
    kind = np.int32 if total < 2**31 else np.int64
    out: np.ndarray = np.repeat((first - starts).astype(kind), length)
    out += np.arange(total, dtype=kind)
    return out


def _without_zeros(row: np.ndarray, column: np.ndarray, values: Floats) -> Entries:
    used = values != 0
    return Entries(row[used], column[used], values[used])


# Text


@dataclass(frozen=True, eq=False)
class _Lines:
    """Lines of a text: where they begin and end, and which hold values."""

    data: np.ndarray
    start: Ints
    end: Ints

    def line(self, k: int) -> bytes:
        return self.data[self.start[k] : self.end[k]].tobytes()


def _text(path: Path, data: np.ndarray) -> Iterator[tuple[str, Op4Matrix]]:
    lines = _lines(data)
    count, position = lines.start.size, 0
    while position < count:
        if not lines.line(position).strip():
            position += 1
            continue
        head = _Head.of(path, lines.line(position))
        is_data = _hold_values(lines, position + 1)
        stop = _end_of(path, lines, position + 1, is_data, head)
        if not is_data[stop + 1 : stop + 2].any():
            raise wrong(path, f"a value behind the last column of '{head.name}'", "none")
        yield head.name, _matrix(path, lines, (position + 1, stop), is_data, head)
        position = stop + 2  # the column beyond the last, and its value


def _lines(data: np.ndarray) -> _Lines:
    parts = [
        np.flatnonzero(data[k : k + 2**26] == ord("\n")) + k for k in range(0, data.size, 2**26)
    ]
    end = np.concatenate(parts)
    if end.size == 0 or end[-1] != data.size - 1:
        end = np.append(end, data.size)
    start = np.append(0, end[:-1] + 1)
    returns = (end > start) & (data[np.maximum(end - 1, 0)] == ord("\r"))
    return _Lines(data, start, end - returns)


@dataclass(frozen=True)
class _Head:
    """Header of a matrix in a text file."""

    name: str
    rows: int
    columns: int
    big: bool
    width: int
    precision: float

    @staticmethod
    def of(path: Path, line: bytes) -> _Head:
        text = line.decode("latin-1")
        try:
            columns, rows, _, kind = (int(text[k : k + 8]) for k in range(0, 32, 8))
        except ValueError:
            raise wrong(path, EXPECTED, repr(text[:60])) from None
        form = re.search(r"\d+[EDG](\d+)\.(\d+)", text[40:].upper())
        if form is None:
            raise wrong(path, f"{EXPECTED} with its format, such as 1P,3E23.16", repr(text[:60]))
        name = text[32:40].strip().upper()
        precision = max(_precision(path, name, kind, rows), 10.0 ** -int(form[2]))
        return _Head(name, abs(rows), columns, rows < 0, int(form[1]), precision)


def _hold_values(lines: _Lines, first: int) -> Bools:
    """Return which lines from ``first`` on hold values: those with a point where these have it."""
    out = np.zeros(lines.start.size, bool)
    length = lines.end - lines.start
    offset = None
    for k in range(first, min(first + 10, lines.start.size)):
        text = lines.line(k)
        if b"." in text:
            offset = text.index(b".")
            break
    if offset is not None:
        long = length > offset
        out[long] = lines.data[lines.start[long] + offset] == ord(".")
    out[:first] = False
    return out


def _end_of(path: Path, lines: _Lines, first: int, is_data: Bools, head: _Head) -> int:
    """Return the line of the column beyond the last one."""
    mark = b"%8d" % (head.columns + 1)
    for k in np.flatnonzero(~is_data[first:]) + first:
        text = lines.line(int(k))
        if text[:8] == mark and len(text.rstrip()) > 16:
            return int(k)
    raise wrong(path, f"all columns of '{head.name}', and its end", "a file that is cut off")


def _matrix(
    path: Path, lines: _Lines, extent: tuple[int, int], is_data: Bools, head: _Head
) -> Op4Matrix:
    first, stop = extent
    chosen = is_data[first:stop]
    headers = np.flatnonzero(~chosen)
    column = np.zeros(headers.size, np.int32)
    row = np.zeros(headers.size, np.int32)
    words = np.zeros(headers.size, np.int64)
    place = np.zeros(headers.size, np.intp)
    is_string = np.zeros(headers.size, bool)
    listed, of_strings = [0], [0]
    current = 0
    try:
        for n, k in enumerate((headers + first).tolist()):
            text = lines.line(k).rstrip()
            if len(text) > 16:
                current, row[n] = int(text[:8]), int(text[8:16])
                words[n] = int(text[16:]) if row[n] else 0
                of_strings.append(0 if row[n] else int(text[16:]))
                listed.append(current)
            elif head.big:
                words[n], row[n] = int(text[:8]) - 1, int(text[8:])
            else:
                words[n], row[n] = int(text) // STRING - 1, int(text) % STRING
            column[n], place[n], is_string[n] = current, len(listed) - 1, len(text) <= 16
    except (ValueError, OverflowError):
        raise wrong(path, f"headers of columns in '{head.name}'", repr(text[:40])) from None
    belongs = np.cumsum(~chosen)[chosen] - 1
    if belongs.size and belongs.min() < 0:
        raise wrong(path, f"the header of a column in '{head.name}'", "values")
    positions = np.flatnonzero(chosen) + first
    per_line = (lines.end[positions] - lines.start[positions] + head.width - 1) // head.width
    values = _values(path, lines, positions, per_line, head.width)
    length = np.bincount(belongs, weights=per_line, minlength=headers.size).astype(np.intp)
    _check_order(path, head.name, listed, head.columns)
    strings = np.bincount(place, np.where(is_string, words, 0), len(listed))
    of_headers = (2 if head.big else 1) * np.bincount(place, is_string, len(listed))
    whole = any((strings + k * of_headers == of_strings).all() for k in (0, 1))
    if not whole or all((words != size * length).any() for size in (1, 2)):
        expected = f"as many values in every column of '{head.name}' as its headers say"
        raise wrong(path, expected, f"{int(length.sum())} values in {int(words.sum())} words")
    rows = _runs(row.astype(np.intp) - 1, length)
    columns = np.repeat(column - 1, length)
    return Op4Matrix(head.rows, head.columns, head.precision, _without_zeros(rows, columns, values))


def _values(path: Path, lines: _Lines, positions: Ints, per_line: Ints, width: int) -> Floats:
    """Return the numbers of the lines at ``positions``, ``per_line`` in each of them."""
    out = np.zeros(int(per_line.sum()))
    place = np.cumsum(per_line) - per_line
    for count in np.unique(per_line).tolist():
        chosen = np.flatnonzero(per_line == count)
        for k in range(0, chosen.size, CHUNK):
            part = chosen[k : k + CHUNK]
            index = lines.start[positions[part]][:, None] + np.arange(count * width)
            text = np.minimum(index, lines.data.size - 1)
            text = lines.data[text]
            text[index >= lines.end[positions[part]][:, None]] = ord(" ")
            try:
                numbers = fixed_width(text.tobytes(), width)
            except ValueError as error:
                raise wrong(path, f"numbers of {width} characters", reason(error)) from None
            out[place[part][:, None] + np.arange(count)] = numbers.reshape(-1, count)
    return out
