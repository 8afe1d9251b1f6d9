"""Records of ambient tests in all formats, and what is wrong with files."""

from pathlib import Path

import h5py
import numpy as np
import pytest
from scipy.io import savemat

from modefront._typing import Floats
from modefront.data.modal_test import read_test
from modefront.errors import InputError

T = np.arange(200) / 16.0
Y = np.random.default_rng(0).standard_normal((2, 200)).round(4)
HEAD = '[test]\nkind = "ambient"\n[[set]]\n'


def _csv(header: str = "time,a,b", rows: Floats | None = None) -> str:
    table = np.column_stack([T, *Y]) if rows is None else rows
    return "\n".join([header, *(",".join(f"{x:.6g}" for x in row) for row in table)]) + "\n"


def _uff() -> str:
    blocks = []
    for node, row in enumerate(Y, start=1):
        values = [f"{x:13.5E}" for x in row]
        lines = ["".join(values[k : k + 6]) for k in range(0, len(values), 6)]
        blocks += [
            "    -1",
            "    58",
            *("NONE", "NONE", "01-Jan-26 00:00:00", "NONE", "NONE"),
            f"    1         0    0         0 NONE      {node:10d}   3 NONE               0   0",
            f"         2{len(row):10d}         1{0.0:13.5E}{T[1]:13.5E}  0.00000E+00",
            "        17    0    0    0 NONE                 s                   ",
            "        12    0    0    0 NONE                 NONE                ",
            *["         0    0    0    0 NONE                 NONE                "] * 2,
            *lines,
            "    -1",
        ]
    return "\n".join([*blocks, ""])


def _write(folder: Path, ending: str) -> str:
    """Write the records in a format; return what its set says besides the file."""
    path = folder / f"y.{ending}"
    arrays = 'rate = 16.0\nsensors = ["a", "b"]\n'
    if ending == "csv":
        path.write_text(_csv())
        return ""
    if ending == "uff":
        path.write_text(_uff())
        return '[sensors]\na = "1Z"\nb = "2-Z"\n'
    if ending == "npy":
        np.save(path, Y.T)
    elif ending == "7.3.mat":
        with h5py.File(path, "w") as file:  # which keeps columns as rows
            file["y"], file["fs"] = Y.T, [[16.0]]
    else:
        savemat(path, {"y": Y, "fs": 16.0})
    return arrays


@pytest.mark.parametrize("ending", ["csv", "uff", "npy", "mat", "7.3.mat"])
def test_every_format_gives_the_records(tmp_path: Path, ending: str) -> None:
    more = _write(tmp_path, ending)
    (tmp_path / "t.toml").write_text(f'{HEAD}files = ["y.{ending}"]\n{more}')
    (records,) = read_test(tmp_path / "t.toml").setups
    assert records.sensors == ("a", "b")
    assert records.rate == pytest.approx(16.0)
    assert records.duration == pytest.approx(12.5)
    signs = np.array([[1.0], [-1.0 if ending == "uff" else 1.0]])
    np.testing.assert_allclose(records.values, signs * Y, rtol=1e-5)


def test_files_of_a_set_are_measured_at_once_and_still_channels_are_left_out(
    tmp_path: Path,
) -> None:
    (tmp_path / "1.csv").write_text(_csv("time,a,b"))
    still = np.column_stack([T, Y[0], np.ones(200)])
    (tmp_path / "2.csv").write_text(_csv("t,c,d", still))
    text = HEAD + 'files = ["1.csv", "2.csv"]\ncolumns = { t = "time" }\n'
    (tmp_path / "t.toml").write_text(text)
    (records,) = read_test(tmp_path / "t.toml").setups
    assert (records.sensors, records.still) == (("a", "b", "c"), ("d",))


@pytest.mark.parametrize(
    ("text", "more", "message"),
    [
        (_csv("Zeit [s],a,b"), "", r"'columns' in \[\[set\]\] renames others"),
        (_csv("time,a,a"), "", "sensor 'a': expected each sensor once"),
        (_csv(rows=np.column_stack([T**2, *Y])), "", "time: expected a time axis of even steps"),
        (
            "time,a,b\n,1,2\n,3,1\n,2,3\n",
            "",
            "time: expected a time axis of even steps, found others",
        ),
        (_csv(rows=np.column_stack([T, 0 * Y[0], 0 * Y[1]])), "", "a sensor that moves"),
        (_csv(), '[[set]]\nfiles = ["z.csv"]\n', "expected a sensor that another set has: a, b"),
        (_csv(), 'columns = { x = "c" }\n', "columns: expected a column of the CSV files"),
        (_csv(), '[sensors]\nq = "9Z"\n', "sensors. q: expected a channel of the files: a, b, f"),
        (_csv(), 'reference = ["a"]\n', "expected a known key"),
        (_csv(), 'quantity = "receptance"\n', "expected a known key"),
    ],
)
def test_what_is_wrong_is_said(tmp_path: Path, text: str, more: str, message: str) -> None:
    (tmp_path / "y.csv").write_text(text)
    (tmp_path / "z.csv").write_text(_csv("time,c,d"))
    (tmp_path / "t.toml").write_text(f'{HEAD}files = ["y.csv"]\n{more}')
    with pytest.raises(InputError, match=message):
        read_test(tmp_path / "t.toml")


def test_setups_are_joined_by_their_sensors_whatever_their_order(tmp_path: Path) -> None:
    for name, two in (("1", "a,b"), ("2", "c,d"), ("3", "d,a")):
        (tmp_path / f"{name}.csv").write_text(_csv(f"time,{two}"))
    sets = [f'[[set]]\nfiles = ["{name}.csv"]\n' for name in "123"]
    (tmp_path / "t.toml").write_text('[test]\nkind = "ambient"\n' + "".join(sets))
    setups = read_test(tmp_path / "t.toml").setups
    assert [each.sensors for each in setups] == [("a", "b"), ("d", "a"), ("c", "d")]
    assert [each.name for each in setups] == ["1", "3", "2"]


def test_arrays_need_a_rate_names_and_the_right_shape(tmp_path: Path) -> None:
    two = 'rate = 16.0\nsensors = ["a", "b"]\n'
    for shape, kind, more, message in (
        ((5, 5), float, "", "'rate' and 'sensors' in its"),
        ((5, 5), float, two, "samples by 2 sensors, which are real numbers, found 5 x 5 of float"),
        ((0, 2), float, two, "which are real numbers, found 0 x 2 of float64"),
        ((5, 2), complex, two, "which are real numbers, found 5 x 2 of complex128"),
    ):
        np.save(tmp_path / "y.npy", np.zeros(shape, kind))
        (tmp_path / "t.toml").write_text(f'{HEAD}files = ["y.npy"]\n{more}')
        with pytest.raises(InputError, match=message):
            read_test(tmp_path / "t.toml")
