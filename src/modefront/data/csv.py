"""Modal data in CSV: ``set, mode, frequency, damping``, then one column a sensor.

One row is one mode of one data set; frequencies are in Hz and damping is the ratio to critical.
An empty field is not measured. The columns ``set`` and ``damping`` may be left out. Standard
deviations, where known, are in columns of the same name with ``_std`` behind it; that of damping
is checked, and used by nothing so far.

Columns are separated by commas, semicolons or tabs, whichever the header has most of. Where they
are not separated by commas, numbers may have decimal commas, as spreadsheets write them.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Collection, Sequence
from pathlib import Path

import numpy as np

from modefront._typing import Floats
from modefront.data.modal import ModalData
from modefront.errors import Fault, InputError, suggestion

KEYS = ("set", "mode")
QUANTITIES = ("frequency", "damping")
OPTIONAL = ("set", "damping")
"""Columns that may be left out: all rows are of one data set then, no damping is measured."""

ONLY_SET = "1"
"""Name of the data set of a file that names none."""

SEPARATORS = ",;\t"

STD = "_std"

NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)(e[+-]?[0-9]+)?", re.IGNORECASE)
"""Python itself would read more as numbers: 1_000, nan, digits of any script."""

MOST_MODES = 10**6

FREQUENCIES = 1e-9, 1e12
"""Frequencies in Hz beyond which a number must be a slip."""

SHAPES = 1e-100, 1e100
"""Greatest components of a mode shape of which the squares are still numbers."""


def is_reserved(name: str, sensors: Collection[str]) -> bool:
    """Return whether a column of this name would be another one than that of a sensor."""
    base = name.removesuffix(STD)
    return name in (*KEYS, *QUANTITIES) or (base != name and base in (*QUANTITIES, *sensors))


def read_csv(path: Path | str, sensors: Sequence[str] | None = None) -> ModalData:
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

    Raises
    ------
    InputError
        With every row and column in which something is wrong.
    """
    path, file = Path(path), str(path)
    header, lines, decimal_comma = _table(path)
    if sensors is None:
        sensors = [
            name
            for name in dict.fromkeys(header)
            if name.isprintable() and name and not is_reserved(name, header)
        ]
    faults = [_fault(file, 1, *found) for found in _header_faults(header, sensors)]
    if faults:
        raise InputError(faults)
    if not lines:
        raise InputError(Fault(file, "line 2", "a row for each measured mode", "the end"))

    rows: dict[tuple[str, int], dict[str, float]] = {}
    for number, fields in lines:
        if len(fields) != len(header):
            wanted = f"{len(header)} fields, as in the header"
            faults.append(Fault(file, f"line {number}", wanted, str(len(fields))))
            continue
        texts = dict(zip(header, fields, strict=True))
        key, values, found = _row(texts, decimal_comma)
        faults += [_fault(file, number, *one) for one in found]
        if key is not None and key in rows:
            place = f"line {number}, columns 'set' and 'mode'"
            expected = "each mode of a data set once"
            if "set" not in header:
                place = f"line {number}, column 'mode'"
                expected = "each mode once, or a column 'set' that tells data sets apart"
            faults.append(Fault(file, place, expected, f"{key} again"))
        elif key is not None:
            rows[key] = values
            if not found:
                faults += [_fault(file, number, *one) for one in _empty_faults(values, sensors)]
    if faults:
        raise InputError(faults)
    return _assemble(rows, tuple(sensors))


def write_csv(
    path: Path, data: ModalData, damping_std: Floats | None = None, digits: int = 9
) -> None:
    """Write modal data with standard deviations, those of damping where given; whole or not at all.

    Modes of which a data set has neither frequency nor shape are left out.
    """
    stds = ("frequency", "damping", *data.sensors)
    header = [*KEYS, *QUANTITIES, *data.sensors, *(name + STD for name in stds)]
    unknown = np.full(data.frequency.shape, np.nan) if damping_std is None else damping_std
    rows = []
    for k, name in enumerate(data.sets):
        for r, mode in enumerate(data.modes):
            values = [data.frequency[k, r], data.damping[k, r], *data.shape[k, r]]
            values += [data.frequency_std[k, r], unknown[k, r], *data.shape_std[k, r]]
            if np.isfinite(values).any():
                texts = ["" if math.isnan(value) else f"{value:.{digits}g}" for value in values]
                rows.append([name, str(mode), *texts])
    temporary = path.with_name(path.name + ".part")
    with temporary.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)
    temporary.replace(path)


def _fault(file: str, line: int, column: str, expected: str, found: str) -> Fault:
    return Fault(file, f"line {line}, column {column!r}", expected, found)


def _table(path: Path) -> tuple[list[str], list[tuple[int, list[str]]], bool]:
    """Return the header, the numbered rows that are not blank, whether decimals have commas."""
    try:
        with path.open(newline="", encoding="utf-8-sig") as stream:
            first = stream.readline()
            while first and not first.strip(SEPARATORS + " \r\n"):
                first = stream.readline()
            separator = max(SEPARATORS, key=first.count)
            stream.seek(0)
            reader = csv.reader(stream, delimiter=separator, strict=True, skipinitialspace=True)
            try:
                rows = [(reader.line_num, [field.strip() for field in row]) for row in reader]
            except csv.Error as error:
                place = f"line {reader.line_num}"
                raise InputError(Fault(str(path), place, "CSV", str(error))) from None
    except InputError:
        raise
    except FileNotFoundError:
        raise InputError(Fault(str(path), "file", "a file of modal data", "no such file")) from None
    except (OSError, ValueError) as error:
        raise InputError(Fault(str(path), "file", "CSV in UTF-8", str(error))) from None
    rows = [(number, row) for number, row in rows if any(row)]
    if not rows:
        raise InputError(Fault(str(path), "line 1", "a header of column names", "an empty file"))
    return rows[0][1], rows[1:], separator != ","


def _header_faults(header: Sequence[str], sensors: Sequence[str]) -> list[tuple[str, str, str]]:
    """Return (column, expected, found) for everything that is wrong with the header."""
    required = (*KEYS, *QUANTITIES, *sensors)
    known = (*required, *(name + STD for name in (*QUANTITIES, *sensors)))
    faults = [
        (name, "the name of a quantity or of a sensor of the model", suggestion(name, known))
        for name in dict.fromkeys(header)
        if name not in known
    ]
    faults += [
        (name, "this column", "no such column")
        for name in required
        if name not in header and name not in OPTIONAL
    ]
    for name in dict.fromkeys(header):
        if header.count(name) > 1:
            faults.append((name, "each column once", f"{header.count(name)} of this name"))
    return faults


def _row(
    texts: dict[str, str], decimal_comma: bool
) -> tuple[tuple[str, int] | None, dict[str, float], list[tuple[str, str, str]]]:
    """Return the key (set, mode), the values and the faults of one row."""
    faults: list[tuple[str, str, str]] = []
    values: dict[str, float] = {}
    name, mode = texts.get("set", ONLY_SET), texts["mode"]
    if not name or not name.isprintable():
        faults.append(("set", "the name of a data set", repr(name)))
    if not re.fullmatch("[0-9]{1,9}", mode) or not 1 <= int(mode) <= MOST_MODES:
        faults.append(("mode", f"a whole number from 1 to {MOST_MODES}", repr(mode)))
    key = None if faults else (name, int(mode))
    for column, text in texts.items():
        if column in KEYS:
            continue
        values[column] = math.nan
        if not text:
            continue
        plain = text.replace(",", ".") if decimal_comma and "." not in text else text
        if not NUMBER.fullmatch(plain):
            faults.append((column, "a finite number or an empty field", repr(text)))
            continue
        value = float(plain)
        expected = _range(column, value)
        if expected:
            faults.append((column, expected, text))
        values[column] = value
    return key, values, faults


def _range(column: str, value: float) -> str:
    """Return what is expected of a value that is out of range; empty where it is not."""
    if not math.isfinite(value):
        return "a finite number or an empty field"
    least, most = FREQUENCIES
    if column == "frequency" and not least <= value <= most:
        return f"a frequency above 0 Hz, from {least:g} to {most:g}"
    if column == "damping" and not 0 <= value < 1:
        percent = f" (if {value:g} % is meant: {value / 100:g})" if 1 <= value <= 100 else ""
        return f"a damping ratio from 0 to below 1{percent}"
    if column.endswith(STD) and value < 0:
        return "a standard deviation of 0 or more"
    return ""


def _empty_faults(values: dict[str, float], sensors: Sequence[str]) -> list[tuple[str, str, str]]:
    """Return faults of rows in which nothing is measured or the shape vanishes."""
    shape = [values[name] for name in sensors if not math.isnan(values[name])]
    if shape and not any(shape):
        return [(sensors[0], "a mode shape that is not zero at all sensors", "only zeros")]
    greatest = max(map(abs, shape), default=1.0)
    if math.isfinite(greatest) and not SHAPES[0] <= greatest <= SHAPES[1]:
        expected = f"a mode shape with its greatest component from {SHAPES[0]:g} to {SHAPES[1]:g}"
        return [(sensors[0], expected, f"{greatest:g}")]
    if not shape and math.isnan(values["frequency"]):
        return [("frequency", "a frequency or a mode shape", "neither")]
    return []


def _assemble(rows: dict[tuple[str, int], dict[str, float]], sensors: tuple[str, ...]) -> ModalData:
    sets = tuple(dict.fromkeys(name for name, _ in rows))
    modes = tuple(sorted({mode for _, mode in rows}))

    def collect(*columns: str) -> Floats:
        return np.array(
            [
                [[rows.get((k, r), {}).get(name, math.nan) for name in columns] for r in modes]
                for k in sets
            ]
        )

    return ModalData(
        sets,
        modes,
        sensors,
        collect("frequency")[..., 0],
        collect("damping")[..., 0],
        collect(*sensors),
        collect("frequency" + STD)[..., 0],
        collect(*(name + STD for name in sensors)),
    )
