"""Tables in CSV: modal data, frequency response functions, and the records of blows.

``docs/study-file.md`` and ``docs/identification.md`` describe them. Separators are those that the
header has most of, names in quotes apart, or as a line ``sep=;`` before it says.
"""

import csv
import math
import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from modefront._typing import Complexes, Floats
from modefront.data.modal import ModalData, Pairs
from modefront.data.responses import FORCE, TIME, Channel
from modefront.errors import Fault, InputError, reason, refuse, suggestion
from modefront.inputs import MOST_DATA, available_memory, ended_column, file_size, wrong
from modefront.options import mapping, text
from modefront.outputs import write_table
from modefront.rounding import LARGEST
from modefront.text import NAME, clean

KEYS, SENSOR = ("set", "mode"), "sensor"
QUANTITIES = ("frequency", "damping")
PAIR = "pair"

SEPARATORS = ",;\t"

STD = "_std"
FREQUENCY, SECONDS, COHERENCE = "frequency", "time", "_coherence"
PAIRS = (("_re", "_im"), ("_magnitude", "_rad"), ("_magnitude", "_deg"))  # endings of columns
LISTED = 5  # faults that are listed of one file

NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)(e[+-]?[0-9]+)?", re.IGNORECASE)
"""Python itself would read more as numbers: 1_000, nan, digits of any script."""

DECIMAL_COMMA = re.compile(r"^(\s*[+-]?[0-9]*),([0-9]*(?:e[+-]?[0-9]+)?\s*)$", re.IGNORECASE)
"""A number with a decimal comma, before and behind it."""

COLUMNS = mapping(  # of a file
    "a table, column in the file = column of modal data, or sensor", text("a text")
)

MOST_FAULTS = 100  # faults of rows after which the rest is not looked at

EXPECTED = "a finite number or an empty field"

Key = tuple[str, int]  # data set and mode
Rows = dict[Key, tuple[int, dict[str, float]]]  # line of each, and values by column
Said = tuple[str, str, str]  # a column, what is expected in it, and what was found


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
        bases = [name, *(name.removesuffix(end) for end in endings if name.endswith(end))]
        known = [base for base in bases if base in columns][:1]
        used.update(known)
        out.append(columns[known[0]] + name[len(known[0]) :] if known else name)
    return out, used


def read_csv(
    path: Path | str, sensors: Sequence[str] | None = None, columns: Mapping[str, str] | None = None
) -> ModalData:
    """Return the modal data of a CSV file.

    Parameters
    ----------
    path
        File with the columns ``set, mode, frequency, damping``, then one a sensor, and standard
        deviations in columns of the same names with ``_std`` behind them; frequencies in Hz. The
        columns ``set`` and ``damping`` may be left out, and those of sensors without data, but
        not of all. Semicolons and tabs separate columns as well as commas do, and decimal commas
        are read where commas separate none.
    sensors
        Names of the sensors, in the order of the shapes; those of the columns unless given.
    columns
        Names that columns of the file stand for, by their own; those of deviations follow.

    Raises
    ------
    InputError
        With every row and column in which something is wrong.
    """
    table = read_table(Path(path), "a file of modal data")
    own = table.header
    header, used = renamed(own, columns or {}, (STD,))
    refuse(
        Fault(str(path), f"columns {clean(name, NAME)!r}", "a column of it", suggestion(name, own))
        for name in columns or {}
        if name not in used
    )
    if len(header) > 20_000:
        raise wrong(table.path, "up to 20000 columns", str(len(header)), f"line {table.line}")
    if sensors is None:
        named = [name for name in dict.fromkeys(header) if name.isprintable() and name]
        sensors = [name for name in named if not is_reserved(name, set(header))]
    refuse(table.at(table.line, *said) for said in _header_faults(header, sensors))
    rows: Rows = {}
    for line, fields in table.rows:
        key, row, found = _row(dict(zip(header, fields, strict=True)), sensors)
        table.faults += [table.at(line, *said) for said in found]
        if key in rows:
            expected, place = "each mode of a data set once", "columns 'set' and 'mode'"
            if "set" not in header:
                expected = "each mode once, or a column 'set' that tells data sets apart"
                place = "column 'mode'"
            table.faults.append(Fault(str(path), f"line {line}, {place}", expected, f"{key} again"))
        elif key is not None:
            rows[key] = line, row
    table.close()
    pairs = _pairs(table, rows) if PAIR in header and PAIR not in sensors else ()
    return _assembled(table.path, rows, tuple(sensors), pairs)


@dataclass
class Table:
    """A table of a CSV file."""

    path: Path
    line: int  # of the header
    header: list[str]  # names of the columns
    rows: list[tuple[int, list[str]]]  # lines, and as many fields
    faults: list[Fault]  # other rows, and what is found wrong while the table is read

    def at(self, line: int, column: str, expected: str, found: str) -> Fault:
        """Return the fault of a field."""
        place = f"line {line}, column {clean(column, NAME)!r}"
        return Fault(str(self.path), place, expected, found)

    def close(self, column: int = -1) -> None:
        """Raise InputError for faults, without any row, and where a column may be cut off."""
        refuse(self.faults)
        if not self.rows:
            raise wrong(self.path, "at least one row below the header", "the end", "line 2")
        ended_column(self.path, (fields[column] for _, fields in self.rows))


def read_table(path: Path, what: str) -> Table:
    """Return the table of a file; raises InputError for what is no CSV, and for an empty file."""
    rows = table_rows(path, what)
    first, fields = next(rows, (1, []))
    if not fields:
        raise wrong(path, "a header of column names", "an empty file", "line 1")
    header = "\0".join(map(str.strip, fields)).rstrip("\0").split("\0")
    width, table = len(header), Table(path, first, header, [], [])
    for line, row in rows:
        values = list(map(str.strip, row))
        if not any(values[width:]):  # fields without a name may be empty
            values = values[:width]
        if len(values) == width:
            table.rows.append((line, values))
        elif len(table.faults) <= MOST_FAULTS:
            expected = f"{width} fields, as in the header"
            table.faults.append(Fault(str(path), f"line {line}", expected, str(len(values))))
    return table


def number(text: str) -> float:
    """Return the number that a field holds; NaN for an empty one, infinity for anything else."""
    return float(text) if NUMBER.fullmatch(text) else math.inf if text else math.nan


def read_covariance(path: Path, data: ModalData, columns: Mapping[str, str]) -> ModalData:
    """Return modal data with the covariances of shapes of a CSV file; raises InputError.

    A row is a component of a shape: columns ``set, mode, sensor``, then one a sensor; ``columns``
    maps them to those of the data; ``set`` may be left out for one set.
    """
    known = {"set": data.sets, "mode": tuple(map(str, data.modes)), SENSOR: data.sensors}
    C = np.full((*data.shape.shape, len(data.sensors)), np.nan)
    table = read_table(path, "a file of covariances of shapes")
    keys = table.header[: table.header.index(SENSOR) + 1] if SENSOR in table.header else []
    names = renamed(table.header[len(keys) :], columns, ())[0]
    if sorted(keys) not in (["mode", SENSOR], ["mode", SENSOR, "set"])[len(data.sets) > 1 :]:
        found = clean(", ".join(table.header[:6]), NAME) or "nothing"
        raise wrong(path, "set, mode, sensor, then a column a sensor", found, f"line {table.line}")
    refuse(
        table.at(table.line, x, "a sensor of the data, once", suggestion(x, data.sensors))
        for k, x in enumerate(names)
        if x not in data.sensors or x in names[:k]
    )
    places = [data.sensors.index(name) for name in names]
    for line, fields in table.rows:
        row = {"set": data.sets[0]} | dict(zip(keys, fields, strict=False))
        row[SENSOR] = columns.get(row[SENSOR], row[SENSOR])
        said = [
            (key, f"one of {', '.join(known[key][:8])}", suggestion(text, known[key]))
            for key, text in row.items()
            if text not in known[key]
        ]
        said += [
            (name, EXPECTED, repr(text))
            for name, text in zip(names, fields[len(keys) :], strict=True)
            if math.isinf(number(text))
        ]
        place = tuple(known[key].index(row[key]) for key in known) if not said else ()
        if place and np.isfinite(C[place]).any():
            said.append((SENSOR, "each component of a shape once", "one again"))
        table.faults += [table.at(line, *each) for each in said]
        if not said:
            C[place][places] = list(map(number, fields[len(keys) :]))
    table.close()
    try:
        return data.with_covariance(C)
    except InputError as error:
        raise InputError(replace(fault, file=str(path)) for fault in error.faults) from None


def write_covariance(path: Path, data: ModalData) -> None:
    """Write the covariances of the shapes of modal data, which have some; whole or not at all."""
    rows = [[*KEYS, SENSOR, *data.sensors]]
    C = np.asarray(data.shape_covariance)
    for k, r, s in np.argwhere(np.isfinite(C).any(axis=3)).tolist():
        texts = ["" if math.isnan(x) else f"{x:.9g}" for x in C[k, r, s].tolist()]
        rows.append([data.sets[k], str(data.modes[r]), data.sensors[s], *texts])
    write_table(path, rows)


def write_csv(
    path: Path, data: ModalData, damping_std: Floats | None = None, digits: int = 9
) -> None:
    """Write modal data with standard deviations, those of damping where given; whole or not at all.

    Modes of which a data set has neither frequency nor shape are left out.
    """
    columns = (*QUANTITIES, *data.sensors)
    rows = [[*KEYS, *columns, *(name + STD for name in columns), *[PAIR] * bool(data.pairs)]]
    other = {a: b for pair in data.pairs for a, b in (pair, pair[::-1])}
    unknown = np.full(data.frequency.shape, np.nan) if damping_std is None else damping_std
    for k, name in enumerate(data.sets):
        values = np.column_stack([data.frequency[k], data.damping[k], data.shape[k]])
        stds = np.column_stack([data.frequency_std[k], unknown[k], data.shape_std[k]])
        here = [data.modes[r] for r in np.flatnonzero(np.isfinite(values).any(axis=1))]
        for mode, row in zip(data.modes, np.hstack([values, stds]), strict=True):
            if mode in here:
                texts = ["" if math.isnan(value) else f"{value:.{digits}g}" for value in row]
                partner = str(other[mode]) if other.get(mode) in here else ""
                rows.append([name, str(mode), *texts, *[partner] * bool(data.pairs)])
    write_table(path, rows)


def table_rows(path: Path, what: str) -> Iterator[tuple[int, list[str]]]:
    """Yield the numbered rows that are not blank; raises InputError for what is no CSV."""
    lines, separator, before = _lines(path, what)
    reader = csv.reader(lines, delimiter=separator, strict=True, skipinitialspace=True)
    try:
        for row in reader:
            if separator != ",":
                row = [DECIMAL_COMMA.sub(r"\1.\2", field) for field in row]
            if any(map(str.strip, row)):
                yield before + reader.line_num, row
    except csv.Error as error:
        raise wrong(path, "CSV", reason(error), f"line {before + reader.line_num}") from None


def _lines(path: Path, what: str) -> tuple[list[str], str, int]:
    """Return the lines of a table, the separator, and how many lines are left out before them."""
    file_size(path, what, min(MOST_DATA, available_memory() // 4))
    try:
        with path.open(newline="", encoding="utf-8-sig") as stream:
            lines = stream.readlines()
    except (OSError, ValueError) as error:
        raise wrong(path, "CSV in UTF-8", reason(error)) from None
    header = (k for k, line in enumerate(lines) if line.strip(SEPARATORS + " \r\n"))
    first = next(header, len(lines))
    text = "".join(lines[first : first + 1])
    if declared := re.fullmatch(r'"?sep=([,;\t])"?[,;\t \r\n]*', text, re.IGNORECASE):
        return lines[first + 1 :], declared[1], first + 1  # as spreadsheets say it
    return lines, max(SEPARATORS, key=re.sub('"[^"]*"', "", text).count), 0


def _header_faults(header: Sequence[str], sensors: Sequence[str]) -> list[Said]:
    quantities, counts = (*QUANTITIES, *sensors), Counter(header)
    known = dict.fromkeys((*KEYS, *quantities, PAIR, *(name + STD for name in quantities)))
    faults = list[Said]()
    for k, name in enumerate(name for name in counts if name not in known):
        found = suggestion(name, known) if k < 20 else repr(clean(name, NAME))  # takes time
        faults.append((name, "the name of a quantity or of a sensor of the model", found))
    required = ("mode", "frequency", *(name for name in sensors if name + STD in counts))
    none = "no such column ('columns' in [data] renames others)"
    faults += [(name, "this column", none) for name in required if name not in counts]
    if sensors and counts.keys().isdisjoint(sensors):
        faults.append((sensors[0], "the column of at least one sensor of the model", none))
    several = [(name, count) for name, count in counts.items() if count > 1]
    return faults + [(name, "each column once", f"{n} of this name") for name, n in several]


def _row(
    texts: Mapping[str, str], sensors: Sequence[str]
) -> tuple[Key | None, dict[str, float], list[Said]]:
    """Return the key of a row, None for a wrong one, its values, and its faults."""
    faults, values = list[Said](), dict[str, float]()
    name, mode = texts.get("set", "1"), texts["mode"]
    if not name or not name.isprintable():
        faults.append(("set", "the name of a data set", repr(name)))
    if not re.fullmatch("[0-9]{1,9}", mode) or not 1 <= int(mode) <= 10**6:
        faults.append(("mode", f"a whole number from 1 to {10**6}", repr(mode)))
    key = None if faults else (name, int(mode))
    for column, given in texts.items():
        if column not in KEYS:
            values[column] = number(given)
            if given and (expected := _range(column, values[column])):
                found = given if NUMBER.fullmatch(given) else repr(given)
                faults.append((column, expected, found))
    there = [name for name in sensors if not math.isnan(values.get(name, math.nan))]
    greatest = max((abs(values[name]) for name in there), default=1.0)
    if faults:
        pass
    elif not greatest:
        faults.append((there[0], "a mode shape that is not zero at all sensors", "only zeros"))
    elif not 1 / LARGEST <= greatest <= LARGEST:  # squares have to be numbers
        expected = f"a mode shape with its greatest component from {1 / LARGEST:g} to {LARGEST:g}"
        faults.append((there[0], expected, f"{greatest:g}"))
    elif not there and math.isnan(values["frequency"]):
        faults.append(("frequency", "a frequency or a mode shape", "neither"))
    return key, values, faults


def _range(column: str, value: float) -> str:
    """Return the range expected of a value that is out of it; empty for a value within."""
    if not math.isfinite(value):
        return EXPECTED
    if column == "frequency" and not 1e-9 <= value <= 1e12:
        return "a frequency above 0 Hz, from 1e-09 to 1e+12"
    if column == "damping" and not 0 <= value < 1:
        percent = f" (if {value:g} % is meant: {value / 100:g})" if 1 <= value <= 100 else ""
        return f"a damping ratio from 0 to below 1{percent}"
    return "a standard deviation of 0 or more" if column.endswith(STD) and value < 0 else ""


def _assembled(path: Path, rows: Rows, sensors: tuple[str, ...], pairs: Pairs) -> ModalData:
    """Return the data of all rows; raises InputError where they are spread over too many sets."""
    sets = tuple(dict.fromkeys(name for name, _ in rows))
    modes = tuple(sorted({mode for _, mode in rows}))
    if 16 * len(sets) * len(modes) * (2 + len(sensors)) > available_memory() // 2:
        found = f"{len(rows)} rows of {len(sets)} sets and {len(modes)} modes"
        raise wrong(path, "most modes in every data set", found, "rows")
    places = {name: k for k, name in enumerate(sets)}
    row = [places[name] for name, _ in rows]
    column = np.searchsorted(modes, [mode for _, mode in rows])
    names = (*QUANTITIES, "frequency" + STD, *sensors, *(name + STD for name in sensors))
    out = np.full((len(sets), len(modes), len(names)), np.nan)
    out[row, column] = [[each.get(name, np.nan) for name in names] for _, each in rows.values()]
    f, zeta, f_std = np.moveaxis(out[..., :3], -1, 0).copy()
    phi, phi_std = (x.copy() for x in np.split(out[..., 3:], 2, axis=-1))
    return ModalData(sets, modes, sensors, f, zeta, phi, f_std, phi_std, pairs)


def _pairs(table: Table, rows: Rows) -> Pairs:
    other = {key: x for key, (_, row) in rows.items() if not math.isnan(x := row[PAIR])}
    refuse(
        table.at(rows[name, mode][0], PAIR, "the other mode of a pair of this set", f"{x:g}")
        for (name, mode), x in other.items()
        if x == mode or x % 1 or other.get((name, int(x))) != mode
    )
    pairs = {(mode, int(x)) for (_, mode), x in other.items() if mode < x}
    count = Counter(mode for pair in pairs for mode in pair)
    if twice := [mode for mode, number in count.items() if number > 1]:
        expected = "each mode in one pair, the same in all sets"
        raise wrong(table.path, expected, f"mode {twice[0]} in two", f"column {PAIR!r}")
    return tuple(sorted(pairs))


def read_test_csv(
    path: Path, columns: Mapping[str, str] | None = None
) -> tuple[list[Channel], set[str]]:
    """Return the functions or the blow of one file, which does not say their reference.

    ``columns`` maps names of the file, with or without the endings of columns of a response; what
    of them names a column is returned too. Raises InputError with what is wrong.
    """
    own, values = read_numbers(path, "a file of frequency response functions or records")
    endings = (*dict.fromkeys(end for pair in PAIRS for end in pair), COHERENCE)
    header, used = renamed(own, columns or {}, endings)
    column, file = dict(zip(header, values.T, strict=True)), str(path)
    is_blow = SECONDS in header and FREQUENCY not in header
    forms, said = _forms(header) if not is_blow else ({}, [])
    names = [name for name in header if name not in (SECONDS, FORCE)]
    if is_blow and FORCE not in header:
        said.append((repr(FORCE), "the record of the force", "no such column"))
    if is_blow and not names:
        said.append(("", "columns of at least one response", ", ".join(header)))
    twice = [(repr(x), "each column once", "another") for x, n in Counter(header).items() if n > 1]
    refuse(
        Fault(file, f"line 1, column {name}" if name else "line 1", *each)
        for name, *each in [*twice, *said][:LISTED]
    )
    if is_blow:
        time, known = column[SECONDS], (file, "columns", "")
        force = Channel(*known, FORCE, time, column[FORCE], FORCE, TIME)
        rows = ((name, np.nan_to_num(column[name], nan=0.0)) for name in names)  # empty columns
        return [force, *(Channel(*known, name, time, x, "", TIME) for name, x in rows)], used
    channels = []
    for name, pair in forms.items():
        first, second = (name + end for end in pair)
        place = file, f"columns {first!r} and {second!r}", "", name
        coherence = column.get(name + COHERENCE)
        if coherence is not None and np.isnan(coherence).any():
            coherence = None
        H = _function(path, {x: column[x] for x in (first, second)}, pair)
        channels.append(Channel(*place, column[FREQUENCY], H, coherence=coherence))
    return channels, used


def _function(path: Path, columns: Mapping[str, Floats], form: tuple[str, str]) -> Complexes:
    """Return the function of two columns; raises InputError for a phase of another unit."""
    places = [f"column {name!r}" for name in columns]
    first, second = columns.values()
    empty = [bool(np.isnan(part).any()) for part in (first, second)]
    if all(empty):
        return np.zeros(first.shape, complex)
    if any(empty):
        expected = "numbers, as in the other column"
        raise wrong(path, expected, "an empty one", places[empty.index(True)])
    if form == PAIRS[0]:
        return np.asarray(first + 1j * second)
    most, degrees = float(np.abs(second).max()), form[1] == "_deg"
    if first.min() < 0:
        raise wrong(path, "magnitudes of 0 or more", f"{first.min():g}: are these dB?", places[0])
    if (1 < most <= 3.15) if degrees else most > 100:  # half a turn in radians, or many of them
        unit = "degrees" if degrees else "radians"
        expected = f"a phase in {unit} (NAME_deg is in degrees, NAME_rad in radians)"
        raise wrong(path, expected, f"{most:g} at most", places[1])
    return np.asarray(first * np.exp(1j * (np.radians(second) if degrees else second)))


def _forms(header: Sequence[str]) -> tuple[dict[str, tuple[str, str]], list[Said]]:
    """Return the endings of the two columns of every response, in their order, and faults."""
    said = [] if FREQUENCY in header else [(repr(FREQUENCY), "this column", "no such column")]
    forms: dict[str, tuple[str, str]] = {}
    for first in dict.fromkeys(pair[0] for pair in PAIRS):
        for name in (x.removesuffix(first) for x in header if x.endswith(first)):
            whole = [pair for pair in PAIRS if pair[0] == first and name + pair[1] in header]
            if len(whole) != 1 or name in forms:
                wanted = " or ".join(repr(name + b) for a, b in PAIRS if a == first)
                said.append((wanted, "this column", "both" if whole else "no such column"))
            forms[name] = whole[0] if whole else (first, first)
    known = {FREQUENCY, *(n + end for n, pair in forms.items() for end in (*pair, COHERENCE))}
    for name in dict.fromkeys(name for name in header if name not in known):
        expected = "frequency, or NAME_re and NAME_im, NAME_magnitude and NAME_rad or NAME_deg,"
        expected += " or NAME_coherence of a response; 'columns' in [[set]] renames others"
        said.append((repr(name), expected, suggestion(name, known)))
    if not forms:
        expected = "columns NAME_re and NAME_im of at least one response"
        said.append(("", expected, ", ".join(header[:6])))
    return forms, said


def read_numbers(path: Path, what: str) -> tuple[list[str], Floats]:
    """Return header and rows of a CSV file of numbers, NaN in empty columns; raises InputError."""
    lines, separator, _ = _lines(path, what)
    with suppress(ValueError, csv.Error):
        reader = csv.reader(lines, delimiter=separator, skipinitialspace=True)
        header = [field.strip() for field in next(reader, [])]
        texts = [x for line in lines[1:] if (x := line.rstrip("\r\n")).strip(SEPARATORS + " ")]
        texts = texts if separator == "," else [x.replace(",", ".") for x in texts]
        values = np.loadtxt(texts or ["?"], delimiter=separator, comments=None, ndmin=2)
        if values.shape == (len(texts), len(header)) and (np.abs(values) <= LARGEST).all():
            ended_column(path, (row.rpartition(separator)[2] for row in texts))
            return header, values
    table = read_table(path, what)
    full = [k for k in range(len(table.header)) if any(row[k] for _, row in table.rows)]
    values = np.full((len(table.rows), len(table.header)), np.nan)
    for out, (line, row) in zip(values, table.rows, strict=True):
        out[full] = [number(row[k]) for k in full]
        for k in full:
            if not abs(out[k]) <= LARGEST and len(table.faults) < LISTED:
                expected = f"a finite number up to {LARGEST:g}"
                table.faults.append(table.at(line, table.header[k], expected, repr(row[k])))
    table.close(full[-1] if full else -1)
    return table.header, values
