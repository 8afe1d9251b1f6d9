"""Frequency response functions in CSV, or the records of a blow.

Functions have a column ``frequency`` in Hz, then for every response two columns: ``NAME_re`` and
``NAME_im``, or ``NAME_magnitude`` and its phase ``NAME_rad`` or ``NAME_deg``; and
``NAME_coherence`` where there is one. Records have a column ``time`` in s, a column ``force``, and
a column NAME for every response. A map gives columns of other names these. All columns of a file
belong to one reference. A response whose columns are empty is not
measured. Separators and decimal commas are those of modal data (`modefront.data.csv`).
"""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from modefront._typing import Complexes, Floats
from modefront.data.blows import TIME, Contents, blow_of_columns
from modefront.data.channels import Channel
from modefront.data.csv import NUMBER, SEPARATORS, opened, renamed
from modefront.errors import Fault, InputError, refuse, suggestion
from modefront.inputs import ended_column
from modefront.rounding import LARGEST

FREQUENCY, COHERENCE = "frequency", "_coherence"

PAIRS = (("_re", "_im"), ("_magnitude", "_rad"), ("_magnitude", "_deg"))
"""Endings of the two columns of a function, in each of its forms."""

ENDINGS = ("_re", "_im", "_magnitude", "_rad", "_deg", COHERENCE)

MOST_FAULTS = 5
"""Faults that are listed of one file."""


def read_test_csv(path: Path, reference: str, columns: Mapping[str, str] | None = None) -> Contents:
    """Return the functions or the blow of one file.

    ``columns`` maps names of the file to those above: of a column, or of a response without the
    endings of its columns. Raises InputError with what is wrong.
    """
    own, values = read_numbers(path, "a file of frequency response functions or records")
    header, used = renamed(own, columns or {}, ENDINGS)
    unused = frozenset((columns or {}).keys() - used)
    if TIME in header and FREQUENCY not in header:
        blow = blow_of_columns(str(path), header, values, reference)
        return Contents(blows=(blow,), unused=unused)
    forms = _forms(path, header)
    column = dict(zip(header, values.T, strict=True))
    given = {name for name, x in column.items() if np.isfinite(x).all()}
    channels = (
        Channel(
            str(path),
            f"columns {name + pair[0]!r} and {name + pair[1]!r}",
            reference,
            name,
            column[FREQUENCY],
            _function(path, name, pair, (column[name + pair[0]], column[name + pair[1]])),
            coherence=column[name + COHERENCE] if name + COHERENCE in given else None,
        )
        for name, pair in forms.items()
    )
    return Contents(tuple(channels), unused=unused)


def _function(
    path: Path, name: str, pair: tuple[str, str], parts: tuple[Floats, Floats]
) -> Complexes:
    """Return the function of two columns; raises InputError for a phase of another unit."""
    first, second = parts
    empty = [bool(np.isnan(part).any()) for part in parts]
    if all(empty):
        return np.zeros(first.shape, complex)
    if any(empty):
        place = f"column {name + pair[empty.index(True)]!r}"
        raise InputError(Fault(str(path), place, "numbers, as in the other column", "an empty one"))
    if pair == PAIRS[0]:
        return np.asarray(first + 1j * second)
    most = float(np.abs(second).max())
    faults = []
    if first.min() < 0:
        found = f"{first.min():g}: are these dB?"
        place = f"column {name + pair[0]!r}"
        faults.append(Fault(str(path), place, "magnitudes of 0 or more", found))
    degrees = pair[1] == "_deg"
    if (1 < most <= 3.15) if degrees else most > 100:  # half a turn in radians, or many of them
        unit = "degrees" if degrees else "radians"
        expected = f"a phase in {unit} (NAME_deg is in degrees, NAME_rad in radians)"
        found = f"{most:g} at most"
        faults.append(Fault(str(path), f"column {name + pair[1]!r}", expected, found))
    refuse(faults)
    phase = np.radians(second) if degrees else second
    return np.asarray(first * np.exp(1j * phase))


def _forms(path: Path, header: Sequence[str]) -> dict[str, tuple[str, str]]:
    """Return the endings of the two columns of every response, in the order of the columns."""
    file = str(path)
    faults = []
    if FREQUENCY not in header:
        found = "no such column"
        faults.append(Fault(file, f"line 1, column {FREQUENCY!r}", "this column", found))
    forms: dict[str, tuple[str, str]] = {}
    for first in dict.fromkeys(pair[0] for pair in PAIRS):
        for name in (x.removesuffix(first) for x in header if x.endswith(first)):
            whole = [pair for pair in PAIRS if pair[0] == first and name + pair[1] in header]
            if len(whole) != 1 or name in forms:
                wanted = " or ".join(repr(name + b) for a, b in PAIRS if a == first)
                has = "both" if whole else "no such column"
                faults.append(Fault(file, f"line 1, column {wanted}", "this column", has))
            forms[name] = whole[0] if whole else (first, first)
    known = {FREQUENCY, *(n + end for n, pair in forms.items() for end in (*pair, COHERENCE))}
    for name in dict.fromkeys(header):
        if header.count(name) > 1:
            faults.append(Fault(file, f"line 1, column {name!r}", "each column once", "another"))
        if name not in known:
            expected = "frequency, or NAME_re and NAME_im, NAME_magnitude and NAME_rad or NAME_deg,"
            expected += " or NAME_coherence of a response; 'columns' in [[set]] renames others"
            found = suggestion(name, known)
            faults.append(Fault(file, f"line 1, column {name!r}", expected, found))
    if not forms:
        expected = "columns NAME_re and NAME_im of at least one response"
        faults.append(Fault(file, "line 1", expected, ", ".join(header[:6])))
    refuse(faults[:MOST_FAULTS])
    return forms


def read_numbers(path: Path, what: str) -> tuple[list[str], Floats]:
    """Return the header and the rows of a CSV file of numbers; NaN in columns that are empty.

    Raises InputError.
    """
    file = str(path)
    with opened(path, what) as (stream, separator, before):
        header = [field.strip() for field in next(csv.reader(stream, delimiter=separator), [])]
        rows = stream.read().splitlines()
    if separator != ",":
        rows = [row.replace(",", ".") for row in rows]
    start = before + 2
    numbered = [(k, row) for k, row in enumerate(rows, start) if row.strip(SEPARATORS + " ")]
    if not any(header):
        raise InputError(Fault(file, "line 1", "a header of column names", "an empty file"))
    if not numbered:
        raise InputError(Fault(file, "line 2", "a row for each line of frequency", "the end"))
    texts = [row for _, row in numbered]
    try:
        values = np.loadtxt(texts, delimiter=separator, comments=None, ndmin=2)
        if values.shape == (len(numbered), len(header)) and (np.abs(values) <= LARGEST).all():
            ended_column(path, (row.rpartition(separator)[2] for row in texts))
            return header, values
    except ValueError:
        pass
    fields = [(number, [x.strip() for x in row.split(separator)]) for number, row in numbered]
    whole = [row for _, row in fields if len(row) == len(header)]
    full = [k for k in range(len(header)) if any(row[k] for row in whole)]
    values, faults = np.full((len(fields), len(header)), np.nan), list[Fault]()
    for position, (number, row) in enumerate(fields):
        if len(row) != len(header):
            expected = f"{len(header)} fields, as in the header"
            faults.append(Fault(file, f"line {number}", expected, str(len(row))))
            continue
        for k in full:
            if NUMBER.fullmatch(row[k]) and abs(float(row[k])) <= LARGEST:
                values[position, k] = float(row[k])
            else:
                place, expected = f"column {header[k]!r}", f"a finite number up to {LARGEST:g}"
                faults.append(Fault(file, f"line {number}, {place}", expected, repr(row[k])))
        if len(faults) >= MOST_FAULTS:
            break
    refuse(faults[:MOST_FAULTS])
    ended_column(path, (row[full[-1]] for row in whole))
    return header, values
