"""Frequency response functions in CSV, or the records of a blow.

Functions have a column ``frequency`` in Hz, then two columns ``NAME_re`` and ``NAME_im`` for every
response, and ``NAME_coherence`` where there is one. Records have a column ``time`` in s, a column
``force``, and a column NAME for every response. All columns of a file belong to one reference.
Separators and decimal commas are those of modal data (`modefront.data.csv`).
"""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from modefront._typing import Floats
from modefront.data.blows import TIME, Contents, blow_of_columns
from modefront.data.channels import Channel
from modefront.data.csv import NUMBER, SEPARATORS, find_separator
from modefront.errors import Fault, InputError, reason, suggestion
from modefront.inputs import MOST_DATA, available_memory, ended_column, file_size, refuse_holes
from modefront.rounding import LARGEST

FREQUENCY, REAL, IMAGINARY, COHERENCE = "frequency", "_re", "_im", "_coherence"

MOST_FAULTS = 5
"""Faults that are listed of one file."""


def read_test_csv(path: Path, reference: str) -> Contents:
    """Return the functions or the blow of one file; raises InputError with what is wrong."""
    header, values = read_numbers(path, "a file of frequency response functions or records")
    if TIME in header and FREQUENCY not in header:
        return Contents(blows=(blow_of_columns(str(path), header, values, reference),))
    names = _names(path, header)
    column = dict(zip(header, values.T, strict=True))
    channels = (
        Channel(
            str(path),
            f"columns {name + REAL!r} and {name + IMAGINARY!r}",
            reference,
            name,
            column[FREQUENCY],
            column[name + REAL] + 1j * column[name + IMAGINARY],
            coherence=column.get(name + COHERENCE),
        )
        for name in names
    )
    return Contents(tuple(channels))


def _names(path: Path, header: Sequence[str]) -> list[str]:
    """Return the names of the responses, in the order of the columns."""
    file = str(path)
    faults = []
    if FREQUENCY not in header:
        found = "no such column"
        faults.append(Fault(file, f"line 1, column {FREQUENCY!r}", "this column", found))
    names = [name.removesuffix(REAL) for name in header if name.endswith(REAL)]
    known = {FREQUENCY, *(name + end for name in names for end in (REAL, IMAGINARY, COHERENCE))}
    for name in dict.fromkeys(header):
        if header.count(name) > 1:
            faults.append(Fault(file, f"line 1, column {name!r}", "each column once", "another"))
        if name not in known:
            expected = "frequency, or NAME_re, NAME_im or NAME_coherence of a response"
            faults.append(
                Fault(file, f"line 1, column {name!r}", expected, suggestion(name, known))
            )
    for name in names:
        if name + IMAGINARY not in header:
            place = f"line 1, column {name + IMAGINARY!r}"
            faults.append(Fault(file, place, "this column", "no such column"))
    if not names:
        expected = "columns NAME_re and NAME_im of at least one response"
        faults.append(Fault(file, "line 1", expected, ", ".join(header[:6])))
    if faults:
        raise InputError(faults[:MOST_FAULTS])
    return names


def read_numbers(path: Path, what: str) -> tuple[list[str], Floats]:
    """Return the header and the rows of a CSV file of numbers; raises InputError."""
    file = str(path)
    size = file_size(path, what, min(MOST_DATA, available_memory() // 4))
    try:
        refuse_holes(path, what, size)
        with path.open(newline="", encoding="utf-8-sig") as stream:
            separator, before = find_separator(stream)
            reader = csv.reader(stream, delimiter=separator)
            header = [field.strip() for field in next(reader, [])]
            rows = stream.read().splitlines()
    except InputError:
        raise
    except (OSError, ValueError, csv.Error) as error:
        raise InputError(Fault(file, "file", "CSV in UTF-8", reason(error))) from None
    if separator != ",":
        rows = [row.replace(",", ".") for row in rows]
    start = before + 2
    numbered = [(k, row) for k, row in enumerate(rows, start) if row.strip(SEPARATORS + " ")]
    if not any(header):
        raise InputError(Fault(file, "line 1", "a header of column names", "an empty file"))
    if not numbered:
        raise InputError(Fault(file, "line 2", "a row for each line of frequency", "the end"))
    ended_column(path, (row.rpartition(separator)[2] for _, row in numbered))
    try:
        texts = [row for _, row in numbered]
        values = np.loadtxt(texts, delimiter=separator, comments=None, ndmin=2)
        if values.shape == (len(numbered), len(header)) and (np.abs(values) <= LARGEST).all():
            return header, values
    except ValueError:
        pass
    values, faults = _one_by_one(
        file, header, [(number, row.split(separator)) for number, row in numbered]
    )
    if faults:
        raise InputError(faults[:MOST_FAULTS])
    return header, values


def _one_by_one(
    file: str, header: Sequence[str], rows: Sequence[tuple[int, list[str]]]
) -> tuple[Floats, list[Fault]]:
    """Return numbered rows of numbers, and what is wrong with them."""
    faults: list[Fault] = []
    values = np.empty((len(rows), len(header)))
    for position, (number, fields) in enumerate(rows):
        if len(fields) != len(header):
            expected = f"{len(header)} fields, as in the header"
            faults.append(Fault(file, f"line {number}", expected, str(len(fields))))
            continue
        for k, field in enumerate(fields):
            text = field.strip()
            if NUMBER.fullmatch(text) and abs(float(text)) <= LARGEST:
                values[position, k] = float(text)
            else:
                place = f"line {number}, column {header[k]!r}"
                faults.append(Fault(file, place, f"a finite number up to {LARGEST:g}", repr(text)))
        if len(faults) >= MOST_FAULTS:
            break
    return values, faults
