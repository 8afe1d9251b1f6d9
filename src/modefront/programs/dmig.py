"""DMIG entries of Nastran in large fields, as punch files hold them.

Each column has a line ``DMIG*  NAME  node  component``, followed by a line
``*  node  component  value`` for every row, in fields of 16 characters behind one of 8; the line
``DMIG  NAME  0  form …`` before them tells whether only one triangle is listed. A component of 0
is a scalar point.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from modefront._typing import Floats, Ints
from modefront.errors import reason
from modefront.inputs import ended
from modefront.programs.base import fixed_width, wrong

FIELD = 16
"""Characters of a large field."""

COMPLEX = (3, 4)
"""Types of complex numbers in the header."""


@dataclass(frozen=True, eq=False)
class DmigMatrix:
    """A matrix by nodes and components.

    Attributes
    ----------
    row, column : (entries, 2) node and component
    value : (entries,)
    precision : relative error of its numbers
    """

    row: Ints
    column: Ints
    value: Floats
    precision: float


def read_dmig(path: Path) -> Mapping[str, DmigMatrix]:
    """Return all matrices of a punch file by their names.

    Raises InputError for a file without any, with complex numbers, or cut off.
    """
    data = np.fromfile(path, dtype=np.uint8)
    ended(path)
    end = np.flatnonzero(data == ord("\n"))
    start = np.append(0, end[:-1] + 1)
    end = end - ((end > start) & (data[np.maximum(end - 1, 0)] == ord("\r")))
    first = data[np.minimum(start, max(data.size - 1, 0))]
    is_entry = (first == ord("*")) & (end > start)
    is_column = _begins(data, start, end, b"DMIG*")
    _refuse_complex(path, data, start, end)
    columns = np.flatnonzero(is_column)
    if columns.size == 0:
        raise wrong(path, "DMIG entries in large fields ('DMIG*')", "none")
    entries = np.flatnonzero(is_entry & (np.cumsum(is_column) > 0))
    owner = np.cumsum(is_column)[entries] - 1
    names = [_cut(data, start[k] + 8, end[k]).decode("latin-1").strip() for k in columns.tolist()]
    _check_headers(path, data, (start, end), (columns, entries), names)
    labels = _whole(path, _fields(data, start, end, columns, (1, 2)))
    rows = _whole(path, _fields(data, start, end, entries, (0, 1)))
    texts = _fields(data, start, end, entries, (2,))
    try:
        values = _numbers(texts)
    except ValueError as error:
        raise wrong(path, "numbers in the fourth field", reason(error)) from None
    precision = 10.0 ** -_digits(texts)
    numbers = {name: k for k, name in enumerate(dict.fromkeys(names))}
    kind = np.array([numbers[name] for name in names])[owner]
    return {
        name.upper(): DmigMatrix(
            rows[kind == k], labels[owner[kind == k]], values[kind == k], precision
        )
        for name, k in numbers.items()
    }


def _check_headers(
    path: Path,
    data: np.ndarray,
    extent: tuple[Ints, Ints],
    lines: tuple[Ints, Ints],
    names: list[str],
) -> None:
    """Refuse columns of another name than the header before them, and entries without a column."""
    is_header = _begins(data, *extent, b"DMIG ")
    headers, before = np.flatnonzero(is_header), np.cumsum(is_header)
    if not headers.size:
        return
    columns, entries = lines
    of_headers = [
        "",
        *(data[extent[0][k] + 8 :][:8].tobytes().decode("latin-1").strip() for k in headers),
    ]
    for k, name in zip(columns.tolist(), names, strict=True):
        if (found := of_headers[before[k]]) != name:
            raise wrong(
                path, f"a header 'DMIG {name}' before its columns", repr(found), f"line {k + 1}"
            )
    alone = entries[before[entries] != before[columns[np.searchsorted(columns, entries) - 1]]]
    if alone.size:
        raise wrong(path, "a column ('DMIG*') before its entries", "none", f"line {alone[0] + 1}")


def _begins(data: np.ndarray, start: Ints, end: Ints, text: bytes) -> np.ndarray:
    out = end - start >= len(text)
    for k, character in enumerate(text):
        out &= data[np.minimum(start + k, data.size - 1)] == character
    return out


def _refuse_complex(path: Path, data: np.ndarray, start: Ints, end: Ints) -> None:
    """Refuse matrices whose header, ``DMIG NAME 0 form type``, says complex numbers."""
    for k in np.flatnonzero(_begins(data, start, end, b"DMIG ")).tolist():
        line = data[start[k] : end[k]].tobytes()
        kind = line[32:40].strip() or b"2"
        if kind.isdigit() and int(kind) in COMPLEX:
            raise wrong(path, "real numbers", f"type {int(kind)} (complex)", f"line {k + 1}")


def _cut(data: np.ndarray, first: int, last: int) -> bytes:
    return data[first : min(first + FIELD, last)].tobytes()


def _fields(
    data: np.ndarray, start: Ints, end: Ints, lines: Ints, fields: tuple[int, ...]
) -> list[np.ndarray]:
    """Return the bytes (lines, 16) of some fields, filled up with spaces."""
    out = []
    for field in fields:
        index = start[lines][:, None] + 8 + FIELD * field + np.arange(FIELD)
        text = data[np.minimum(index, data.size - 1)]
        text[index >= end[lines][:, None]] = ord(" ")
        out.append(text)
    return out


def _whole(path: Path, fields: list[np.ndarray]) -> Ints:
    try:
        numbers = [fixed_width(text.tobytes(), FIELD) for text in fields]
    except ValueError as error:
        raise wrong(path, "nodes and components in fields of 16", reason(error)) from None
    return np.column_stack(numbers).astype(np.intp)


def _numbers(texts: list[np.ndarray]) -> Floats:
    """Return real numbers, also those that Nastran writes without the E of the exponent."""
    text = texts[0].tobytes()
    try:
        return fixed_width(text, FIELD)
    except ValueError:
        parts = (text[k : k + FIELD] for k in range(0, len(text), FIELD))
        return np.array([real(part.decode("latin-1")) for part in parts])


def real(text: str) -> float:
    """Return a number as Nastran writes it: ``1.5``, ``1.5+3``, ``1.5D3``, ``1.5E+3``."""
    text = text.strip().upper().replace("D", "E")
    if "E" not in text:
        sign = max(text.rfind("+"), text.rfind("-"))
        if sign > 0:
            text = f"{text[:sign]}E{text[sign:]}"
    return float(text)


def _digits(texts: list[np.ndarray]) -> int:
    """Return the digits behind the point that most numbers have."""
    if not len(texts[0]):
        return 15
    shown = texts[0][: 10**4].tobytes().decode("latin-1").upper().replace("D", "E")
    parts = [shown[k : k + FIELD].split("E")[0].strip() for k in range(0, len(shown), FIELD)]
    return max(len(part.partition(".")[2].split("+")[0].split("-")[0]) for part in parts)
