"""Every column of the data left out, misspelt and given fields that it cannot have."""

from pathlib import Path

import numpy as np
import pytest
from faultless import DATA
from refusals import Check, edited

import modefront as mf

NO_FIELD = "x nan NaN inf -inf infinity 1e999 1_0 0x10 1,5 ٤ １ 1e 1.2.3 -- true 4.0Hz =1+1"
COLUMNS = [
    # column, expected, wrong fields
    ("set", "the name of a data set", ['""', '" "', '"a\nb"', "a\x1b[0m"]),
    (
        "mode",
        "a whole number from 1 to 1000000",
        ["", "0", "-1", "+1", "1.0", "1e0", "first", "nan", "1_0", "٤", "²", "1000001", "9" * 5000],
    ),
    (
        "frequency",
        "a frequency above 0 Hz",
        ["0", "-4.0", "1e-300", "1e300"],
    ),
    ("damping", "a damping ratio from 0 to below 1", ["-0.01", "1", "2.5"]),
    ("frequency_std", "a standard deviation of 0 or more", ["-0.1"]),
    ("low_std", "a standard deviation of 0 or more", ["-0.1"]),
    *(
        (column, "a finite number or an empty field", NO_FIELD.replace("1,5", '"1,5"').split())
        for column in ("frequency", "damping", "low", "top", "frequency_std", "low_std")
    ),
]


@pytest.mark.parametrize(
    ("column", "expected", "fields"), COLUMNS, ids=[f"{c}: {e}" for c, e, _ in COLUMNS]
)
def test_every_column_of_the_data_refuses_what_it_cannot_hold(
    column: str, expected: str, fields: list[str], folder: Path, refused: Check
) -> None:
    header, first, *others = DATA.splitlines()
    for field in fields:
        row = first.split(",")
        row[header.split(",").index(column)] = field
        (folder / "modes.csv").write_text("\n".join([header, ",".join(row), *others]))
        line = 2 + field.count("\n")
        refused(
            folder / "chain.toml",
            f"modes.csv: line {line}, column '{column}': expected {expected} ... , found ",
        )


@pytest.mark.parametrize("column", DATA.splitlines()[0].split(","))
def test_every_column_of_the_data_misspelt_missing_and_repeated(
    column: str, folder: Path, refused: Check
) -> None:
    rows = [line.split(",") for line in DATA.splitlines()]
    i = rows[0].index(column)
    place = f"modes.csv: line 1, column '{column}'"

    def write(rows: list[list[str]]) -> Path:
        (folder / "modes.csv").write_text("\n".join(map(",".join, rows)))
        return folder / "chain.toml"

    misspelt = [[*rows[0][:i], column + "x", *rows[0][i + 1 :]], *rows[1:]]
    unknown = f"expected the name of a quantity or of a sensor of the model, found '{column}x'"
    refused(write(misspelt), f"column '{column}x': {unknown} (did you mean '{column}'?)")
    if column in ("mode", "frequency", "low"):  # low_std is there
        refused(write(misspelt), f"{place}: expected this column, found no such column")
        missing = [row[:i] + row[i + 1 :] for row in rows]
        refused(write(missing), f"{place}: expected this column, found no such column")
    repeated = [[*row, row[i]] for row in rows]
    refused(write(repeated), f"{place}: expected each column once, found 2 of this name")


def test_sensors_without_a_column_have_no_data(folder: Path, refused: Check) -> None:
    study, data = folder / "chain.toml", folder / "modes.csv"
    study.write_text(edited(study.read_text(), ("low = 0", "low = 0, roof = 1")))
    shape = mf.load(study).problem.data.shape
    assert np.isnan(shape).all(axis=(0, 1)).tolist() == [False, True, False]
    data.write_text("mode,frequency\n1,4\n2,11\n")
    refused(study, "'low': expected the column of at least one sensor of the model, found no such")


TWICE = "columns 'set' and 'mode': expected each mode of a data set once, found ('a', 1) again"
SHAPE = "line 2, column 'low': expected a mode shape "

ROWS = [
    ("a,2,11.0,", "a,1,11.0,", f"modes.csv: line 3, {TWICE}"),
    ("a,2,11.0,", "a,01,11.0,", f"modes.csv: line 3, {TWICE}"),
    ("0.01\na", "0.01,7\na", "modes.csv: line 2: expected 8 fields, as in the header, found 9"),
    ("0.1,0.01\na", "0.1\na", "modes.csv: line 2: expected 8 fields, as in the header, found 7"),
    ("set,", "set;", "modes.csv: line 1, column 'mode': expected this column, found no such"),
    ("low_std\n", "low_std,,x\n", "modes.csv: line 1, column '': ... found ''"),
    ("low_std\n", "mode_std\n", "line 1, column 'mode_std': ... found 'mode_std'"),
    ("low_std\n", "lοw_std\n", "line 1, column 'lοw_std': expected the name of a quantity"),
    ("0.5,1.0,0.1", "0,0.0,0.1", SHAPE + "that is not zero at all sensors, found only zeros"),
    ("0.5,1.0,0.1", "0.5,1e200,0.1", SHAPE + "with its greatest component ... , found 1e+200"),
    ("0.5,1.0,0.1", "1e-200,0,0.1", SHAPE + "with its greatest component ... , found 1e-200"),
    ("4.0,0.01,0.5,1.0,", ",0.01,,,", "column 'frequency': expected a frequency or a mode shape"),
    ("a,2,11.0,", 'a,"2,11.0,', "modes.csv: line 4: expected CSV, found unexpected end of data"),
    ("a,2,11.0,", '"a"x,2,11.0,', "modes.csv: line 3: expected CSV, found ',' expected after"),
    ("b,1,4.1", "b,3,4.1", "[data] file: expected at most 2 modes, as the model has, found 3"),
    ("a,2,11.0,,1.0,-0.5", "a,2,11.0,,,", "shape: expected one of the measured modes [1], found 2"),
]


@pytest.mark.parametrize(("old", "new", "says"), ROWS)
def test_contradictions_of_the_data(
    old: str, new: str, says: str, folder: Path, refused: Check
) -> None:
    (folder / "modes.csv").write_text(edited(DATA, (old, new)))
    refused(folder / "chain.toml", says)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "file: expected a file of modal data, found an empty file"),
        (b"\n\n , ,\n", "line 1: expected a header of column names, found an empty file"),
        (
            DATA.splitlines()[0].encode(),
            "line 2: expected at least one row below the header, found the end",
        ),
        (b"\xff\xfe\x00", "file: expected CSV in UTF-8, found the byte 0xff at position 0"),
        (DATA.encode("utf-16"), "file: expected CSV in UTF-8, found the byte 0xff at position 0"),
        (DATA.encode() + b"x" * 200_000, "line 5: expected CSV, found field larger than"),
        (b"\x00" * 100, "line 1, column 'mode': expected this column, found no such column"),
    ],
)
def test_files_that_are_no_data(content: bytes, says: str, folder: Path, refused: Check) -> None:
    (folder / "modes.csv").write_bytes(content)
    refused(folder / "chain.toml", f"modes.csv: {says}")
