"""Tables in CSV: modal data, frequency response functions, and the records of blows.

``docs/study-file.md`` and ``docs/identification.md`` describe them. Commas, semicolons or tabs
separate the columns, whichever the header has most of, or as a line ``sep=;`` before it says. Where
they are no commas, numbers may have decimal commas, as spreadsheets write them. Empty columns
without names at the end are left out.
"""

from __future__ import annotations

import csv
import math
import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from typing import TextIO

import numpy as np

from modefront._typing import Complexes, Floats
from modefront.data.impact import TIME, Contents, blow_of_columns
from modefront.data.modal import ModalData
from modefront.data.responses import Channel
from modefront.errors import Fault, InputError, reason, refuse, suggestion
from modefront.inputs import MOST_DATA, available_memory, ended_column, file_size, refuse_holes
from modefront.outputs import write_table
from modefront.rounding import LARGEST
from modefront.rounding import LARGEST as LARGEST_NUMBER
from modefront.text import NAME, clean

KEYS = ("set", "mode")
QUANTITIES = ("frequency", "damping")
PAIR = "pair"

SEPARATORS = ",;\t"

STD = "_std"

NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)(e[+-]?[0-9]+)?", re.IGNORECASE)
"""Python itself would read more as numbers: 1_000, nan, digits of any script."""

DECIMAL_COMMA = re.compile(r"^(\s*[+-]?[0-9]*),([0-9]*(?:e[+-]?[0-9]+)?\s*)$", re.IGNORECASE)
"""A number with a decimal comma, before and behind it."""

MOST_FAULTS = 100
"""Faults of rows after which the rest is not looked at."""


def is_reserved(name: str, sensors: Collection[str]) -> bool:
    """Return whether a column of this name would be another one than that of a sensor."""
    base = name.removesuffix(STD)
    return name in (*KEYS, PAIR, *QUANTITIES) or (base != name and base in (*QUANTITIES, *sensors))


def renamed(
    header: Sequence[str], columns: Mapping[str, str], endings: Sequence[str]
) -> tuple[list[str], set[str]]:
    """Return the names of columns after a map, and what of the map names one of them.

    A key of ``columns`` is the whole name of a column, or its beginning before one of ``endings``.

    >>> renamed(["acc 1", "acc 1_std"], {"acc 1": "top"}, ["_std"])
    (['top', 'top_std'], {'acc 1'})
    """
    out, used = [], set()
    for name in header:
        ends = ("", *(end for end in endings if name.endswith(end)))
        end = next((end for end in ends if name[: len(name) - len(end)] in columns), None)
        base = name if end is None else name[: len(name) - len(end)]
        used |= set() if end is None else {base}
        out.append(name if end is None else columns[base] + end)
    return out, used


def read_csv(
    path: Path | str,
    sensors: Sequence[str] | None = None,
    columns: Mapping[str, str] | None = None,
) -> ModalData:
    """Return the modal data of a CSV file.

    Parameters
    ----------
    path
        File with the columns ``set, mode, frequency, damping``, then one a sensor, and standard
        deviations in columns of the same names with ``_std`` behind them; frequencies in Hz. The
        columns ``set`` and ``damping`` may be left out. Semicolons and tabs separate columns as
        well as commas do, and decimal commas are read where commas separate none.
    sensors
        Names of the sensors, in the order of the shapes; those of the columns unless given.
    columns
        Names that columns of the file stand for, by their own; those of deviations follow.

    Raises
    ------
    InputError
        With every row and column in which something is wrong.
    """
    path, file = Path(path), str(path)
    with _reader(path) as rows:
        first, fields = next(rows, (1, []))
        header = "\0".join(map(str.strip, fields)).rstrip("\0").split("\0") if fields else []
        own = header
        header, used = renamed(own, columns or {}, (STD,))
        refuse(
            Fault(file, f"columns {clean(name, NAME)!r}", "a column of it", suggestion(name, own))
            for name in columns or {}
            if name not in used
        )
        width = len(header)  # fields without a name behind the last one may be empty
        rows = ((k, row if any(map(str.strip, row[width:])) else row[:width]) for k, row in rows)
        if not header:
            raise InputError(Fault(file, "line 1", "a header of column names", "an empty file"))
        if len(header) > 20_000:
            expected = "up to 20000 columns"
            raise InputError(Fault(file, f"line {first}", expected, str(len(header))))
        if sensors is None:
            sensors = [
                name
                for name in dict.fromkeys(header)
                if name.isprintable() and name and not is_reserved(name, set(header))
            ]
        refuse(_fault(file, first, *found) for found in _header_faults(header, sensors))
        faults: list[Fault] = []
        keys: list[tuple[int, str, int]] = []
        table: list[list[float]] = []
        last: list[str] = []
        for number, fields in rows:
            if len(faults) > MOST_FAULTS:
                break
            last.append(fields[-1])
            if len(fields) != len(header):
                expected = f"{len(header)} fields, as in the header"
                faults.append(_fault(file, number, None, expected, str(len(fields))))
                continue
            texts = map(str.strip, fields)
            key, values, found = _row(dict(zip(header, texts, strict=True)), sensors)
            if key is not None:
                keys.append((number, *key))
                table.append(list(values.values()))
            faults += [_fault(file, number, *each) for each in found]
    if not last:
        raise InputError(Fault(file, "line 2", "a row for each measured mode", "the end"))
    repeated = _repeated(file, keys, has_sets="set" in header)
    faults += [] if len(faults) > MOST_FAULTS else list(islice(repeated, MOST_FAULTS))
    refuse(faults)
    ended_column(path, last)
    values_of = dict(zip((x for x in header if x not in KEYS), np.array(table).T, strict=True))
    return _assemble(path, keys, values_of, tuple(sensors))


def write_csv(
    path: Path, data: ModalData, damping_std: Floats | None = None, digits: int = 9
) -> None:
    """Write modal data with standard deviations, those of damping where given; whole or not at all.

    Modes of which a data set has neither frequency nor shape are left out.
    """
    columns = (*QUANTITIES, *data.sensors)
    header = [*KEYS, *columns, *(name + STD for name in columns)]
    header += [PAIR] * bool(data.pairs)
    other = {a: b for pair in data.pairs for a, b in (pair, pair[::-1])}
    unknown = np.full(data.frequency.shape, np.nan) if damping_std is None else damping_std
    rows = []
    for k, name in enumerate(data.sets):
        values = np.column_stack([data.frequency[k], data.damping[k], data.shape[k]])
        stds = np.column_stack([data.frequency_std[k], unknown[k], data.shape_std[k]])
        known = np.isfinite(values).any(axis=1)
        here = {mode for mode, any_known in zip(data.modes, known, strict=True) if any_known}
        for mode, row in zip(data.modes, np.hstack([values, stds]), strict=True):
            if mode in here:
                texts = ["" if math.isnan(value) else f"{value:.{digits}g}" for value in row]
                partner = str(other[mode]) if other.get(mode) in here else ""
                rows.append([name, str(mode), *texts, *[partner] * bool(data.pairs)])
    write_table(path, [header, *rows])


def _fault(file: str, line: int, column: str | None, expected: str, found: str) -> Fault:
    place = f"line {line}, column {clean(column, NAME)!r}" if column is not None else f"line {line}"
    return Fault(file, place, expected, found)


@contextmanager
def _reader(path: Path) -> Iterator[Iterator[tuple[int, list[str]]]]:
    """Return the numbered rows that are not blank; raises InputError for what is no CSV."""
    with opened(path, "a file of modal data") as (stream, separator, before):
        reader = csv.reader(stream, delimiter=separator, strict=True, skipinitialspace=True)
        rows = ((before + reader.line_num, row) for row in reader if any(map(str.strip, row)))
        try:
            if separator != ",":
                rows = ((k, [DECIMAL_COMMA.sub(r"\1.\2", x) for x in row]) for k, row in rows)
            yield rows
        except csv.Error as error:
            place = f"line {before + reader.line_num}"
            raise InputError(Fault(str(path), place, "CSV", reason(error))) from None


@contextmanager
def opened(path: Path, what: str) -> Iterator[tuple[TextIO, str, int]]:
    """Open a table; yield the stream at its header, the separator, and the lines before.

    Raises InputError for what is no text, too large, or torn.
    """
    size = file_size(path, what, min(MOST_DATA, available_memory() // 4))
    try:
        refuse_holes(path, what, size)
        with path.open(newline="", encoding="utf-8-sig") as stream:
            lines, first = 1, stream.readline(10**6)
            while first and not first.strip(SEPARATORS + " \r\n"):
                lines, first = lines + 1, stream.readline(10**6)
            declared = re.fullmatch(r'"?sep=([,;\t])"?[,;\t \r\n]*', first, re.IGNORECASE)
            if declared:  # as spreadsheets say what separates the columns
                yield stream, declared[1], lines
            else:
                stream.seek(0)
                yield stream, max(SEPARATORS, key=first.count), 0
    except InputError:
        raise
    except (OSError, ValueError, csv.Error) as error:
        raise InputError(Fault(str(path), "file", "CSV in UTF-8", reason(error))) from None


def _repeated(
    file: str, keys: Sequence[tuple[int, str, int]], *, has_sets: bool
) -> Iterator[Fault]:
    place, expected = "columns 'set' and 'mode'", "each mode of a data set once"
    if not has_sets:
        place = "column 'mode'"
        expected = "each mode once, or a column 'set' that tells data sets apart"
    seen: set[tuple[str, int]] = set()
    for line, name, mode in keys:
        if (name, mode) in seen:
            yield Fault(file, f"line {line}, {place}", expected, f"{(name, mode)} again")
        seen.add((name, mode))


def _header_faults(header: Sequence[str], sensors: Sequence[str]) -> list[tuple[str, str, str]]:
    """Return (column, expected, found) for everything that is wrong with the header."""
    required = (*KEYS, *QUANTITIES, *sensors)
    known = dict.fromkeys((*required, PAIR, *(name + STD for name in (*QUANTITIES, *sensors))))
    counts, faults = Counter(header), []
    for k, name in enumerate(name for name in counts if name not in known):
        found = suggestion(name, known) if k < 20 else repr(clean(name, NAME))  # takes time
        faults.append((name, "the name of a quantity or of a sensor of the model", found))
    missing = [name for name in required if name not in (*counts, "set", "damping")]
    faults += [(name, "this column", "no such column") for name in missing]
    several = [(name, count) for name, count in counts.items() if count > 1]
    return faults + [(name, "each column once", f"{n} of this name") for name, n in several]


_Row = tuple[tuple[str, int] | None, dict[str, float], list[tuple[str, str, str]]]
"""The key (set, mode) of a row, None for a wrong one, its values, and its faults."""


def _row(texts: dict[str, str], sensors: Sequence[str]) -> _Row:
    faults: list[tuple[str, str, str]] = []
    values: dict[str, float] = {}
    name, mode = texts.get("set", "1"), texts["mode"]
    if not name or not name.isprintable():
        faults.append(("set", "the name of a data set", repr(name)))
    if not re.fullmatch("[0-9]{1,9}", mode) or not 1 <= int(mode) <= 10**6:
        faults.append(("mode", f"a whole number from 1 to {10**6}", repr(mode)))
    key = None if faults else (name, int(mode))
    for column, text in texts.items():
        if column not in KEYS:
            is_number = NUMBER.fullmatch(text) is not None
            values[column] = float(text) if is_number else math.nan
            if text and (expected := _range(column, values[column])):
                faults.append((column, expected, text if is_number else repr(text)))
    if key is None or faults:
        return key, values, faults
    shape = [values[name] for name in sensors if not math.isnan(values[name])]
    greatest = max(map(abs, shape), default=1.0)
    if not greatest:
        faults.append((sensors[0], "a mode shape that is not zero at all sensors", "only zeros"))
    elif not 1 / LARGEST_NUMBER <= greatest <= LARGEST_NUMBER:  # squares have to be numbers
        ends = f"from {1 / LARGEST_NUMBER:g} to {LARGEST_NUMBER:g}"
        expected = f"a mode shape with its greatest component {ends}"
        faults.append((sensors[0], expected, f"{greatest:g}"))
    elif not shape and math.isnan(values["frequency"]):
        faults.append(("frequency", "a frequency or a mode shape", "neither"))
    return key, values, faults


def _range(column: str, value: float) -> str:
    """Return the range expected of a value that is out of it; empty for a value within."""
    if not math.isfinite(value):
        return "a finite number or an empty field"
    if column == "frequency" and not 1e-9 <= value <= 1e12:
        return "a frequency above 0 Hz, from 1e-09 to 1e+12"
    if column == "damping" and not 0 <= value < 1:
        percent = f" (if {value:g} % is meant: {value / 100:g})" if 1 <= value <= 100 else ""
        return f"a damping ratio from 0 to below 1{percent}"
    return "a standard deviation of 0 or more" if column.endswith(STD) and value < 0 else ""


def _assemble(
    path: Path,
    keys: Sequence[tuple[int, str, int]],
    columns: Mapping[str, Floats],
    sensors: tuple[str, ...],
) -> ModalData:
    """Return the data of all rows; raises InputError where they are spread over too many sets."""
    pairs = _pairs(path, keys, columns[PAIR]) if PAIR in columns and PAIR not in sensors else ()
    sets = tuple(dict.fromkeys(name for _, name, _ in keys))
    modes = tuple(sorted({mode for _, _, mode in keys}))
    size = 8 * len(sets) * len(modes) * len(columns)
    if size > available_memory() // 2:
        found = f"{len(keys)} rows of {len(sets)} sets and {len(modes)} modes"
        raise InputError(Fault(str(path), "rows", "most modes in every data set", found))
    places = {name: k for k, name in enumerate(sets)}
    row = [places[name] for _, name, _ in keys]
    column = np.searchsorted(modes, [mode for _, _, mode in keys])

    def collect(*names: str) -> Floats:
        out = np.full((len(sets), len(modes), len(names)), np.nan)
        for k, name in enumerate(names):
            if name in columns:
                out[row, column, k] = columns[name]
        return out

    return ModalData(
        sets,
        modes,
        sensors,
        collect("frequency")[..., 0],
        collect("damping")[..., 0],
        collect(*sensors),
        collect("frequency" + STD)[..., 0],
        collect(*(name + STD for name in sensors)),
        pairs,
    )


def _pairs(
    path: Path, keys: Sequence[tuple[int, str, int]], other: Floats
) -> tuple[tuple[int, int], ...]:
    named = {(name, mode): x for (_, name, mode), x in zip(keys, other, strict=True) if x == x}
    lines = {(name, mode): line for line, name, mode in keys}
    faults = [
        _fault(str(path), lines[name, mode], PAIR, "the other mode of a pair of this set", f"{x:g}")
        for (name, mode), x in named.items()
        if x in (mode, math.inf) or x % 1 or named.get((name, int(x))) != mode
    ]
    pairs = {tuple(sorted((mode, int(x)))) for (_, mode), x in named.items()}
    members = [mode for pair in pairs for mode in pair]
    if not faults and len(members) > len(set(members)):
        twice = next(mode for mode in members if members.count(mode) > 1)
        expected = "each mode in one pair, the same in all sets"
        faults.append(Fault(str(path), f"column {PAIR!r}", expected, f"mode {twice} in two"))
    refuse(faults)
    return tuple(sorted((a, b) for a, b in pairs))


FREQUENCY, COHERENCE = "frequency", "_coherence"

PAIRS = (("_re", "_im"), ("_magnitude", "_rad"), ("_magnitude", "_deg"))
"""Endings of the two columns of a function, in each of its forms."""

ENDINGS = ("_re", "_im", "_magnitude", "_rad", "_deg", COHERENCE)

LISTED = 5
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
    refuse(faults[:LISTED])
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
        if len(faults) >= LISTED:
            break
    refuse(faults[:LISTED])
    ended_column(path, (row[full[-1]] for row in whole))
    return header, values
