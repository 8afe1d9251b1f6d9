"""Records in time of an ambient test: what sensors measure while nobody measures the forces.

Files are CSV with a column ``time`` in s and one for every sensor, universal files with functions
of type 1 in dataset 58, NumPy's ``.npy``, or MATLAB's ``.mat`` (up to version 7); of the last two,
a two-dimensional array whose longer side is time, with rate and names from the test file.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from modefront._typing import Floats
from modefront.data.csv import read_numbers, renamed
from modefront.data.impact import EVEN, TIME, Windows
from modefront.data.responses import EXPECTED
from modefront.data.uff import TIME as OF_TIME
from modefront.data.uff import read_functions
from modefront.inputs import MOST_DATA, file_size, wrong
from modefront.isolated import IsolatedError, Read, isolated
from modefront.rounding import LARGEST

ORDERS = {"displacement": 0, "velocity": 1, "acceleration": 2}
"""Number of differentiations of the displacement in each quantity."""

WHAT = "a file with records in time"


@dataclass(frozen=True)
class Records:
    """Records of one setup, measured at once.

    Attributes
    ----------
    name : of the setup
    sensors : names
    rate : samples per second
    values : (sensors, samples)
    quantity : ``"displacement"``, ``"velocity"`` or ``"acceleration"``
    still : names of channels that do not move, which are left out
    """

    name: str
    sensors: tuple[str, ...]
    rate: float
    values: Floats
    quantity: str = "acceleration"
    still: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Raise ValueError where the arrays do not fit."""
        if self.values.ndim != 2 or len(self.values) != len(self.sensors):
            expected = f"records of {len(self.sensors)} sensors, (sensors, samples)"
            raise ValueError(f"expected {expected}, found {self.values.shape}")
        if self.quantity not in ORDERS:
            raise ValueError(f"expected one of {', '.join(ORDERS)}, found {self.quantity!r}")
        if not np.isfinite(self.values).all():
            raise ValueError("expected finite numbers")

    @property
    def duration(self) -> float:
        """Length in s."""
        return self.values.shape[1] / self.rate


@dataclass(frozen=True)
class SetFiles:
    """The files of one data set, and what they do not say themselves.

    Attributes
    ----------
    name : of the data set
    files : paths
    columns : names of columns in CSV files and what they are here
    channels : names by node and direction in universal files, such as 1Z or 1-Z
    rate : samples per second, for arrays
    sensors : names of the channels of arrays
    references : one a file of functions, empty where it says its own
    decay : what an exponential window added to the decay of the functions, in 1/s
    quantity : of functions or records; empty where the test file does not say
    windows : of records of blows; None where the test file has none
    """

    name: str
    files: tuple[Path, ...]
    columns: Mapping[str, str] = field(default_factory=dict)
    channels: Mapping[str, str] = field(default_factory=dict)
    rate: float | None = None
    sensors: tuple[str, ...] = ()
    references: tuple[str, ...] = ()
    decay: float = 0.0
    quantity: str = ""
    windows: Windows | None = None


def channel_name(channel: str, names: Mapping[str, str]) -> tuple[str, int]:
    """Return the name of a channel, such as 1Z, and the sign of its direction, as 1-Z has it."""
    label = next((known for known in names if known.replace("-", "") == channel), channel)
    return names.get(label, channel), -1 if "-" in label else 1


def read_records(setup: SetFiles) -> Records:
    """Return the records of a setup; raises InputError with what is wrong."""
    names: list[str] = []
    rows: list[Floats] = []
    rates: list[float] = []
    for path in setup.files:
        found, values, rate = _of_file(path, setup)
        rates.append(rate)
        if abs(rate / rates[0] - 1) > EVEN or (rows and values.shape[1] != len(rows[0])):
            expected = f"{len(rows[0])} samples at {rates[0]:g} per s, as in {setup.files[0]}"
            raise wrong(path, expected, f"{values.shape[1]} at {rate:g} per s", "records")
        for name, row in zip(found, values, strict=True):
            if name in names:
                raise wrong(path, "each sensor once", "another", f"sensor {name!r}")
            if not (np.abs(row) <= LARGEST).all():
                raise wrong(path, EXPECTED, "others", f"sensor {name!r}")
            names.append(name)
            rows.append(row)
    moving = {name: row for name, row in zip(names, rows, strict=True) if np.ptp(row) > 0}
    if not moving:
        raise wrong(setup.files[0], "a sensor that moves", "none", "records")
    still = tuple(name for name in names if name not in moving)
    quantity, values = setup.quantity or "acceleration", np.array([*moving.values()])
    return Records(setup.name, tuple(moving), rates[0], values, quantity, still)


def _of_file(path: Path, setup: SetFiles) -> tuple[Sequence[str], Floats, float]:
    """Return names, records (sensors, samples) and samples per second of one file."""
    ending = path.suffix.lower()
    if ending in (".npy", ".mat"):
        return _of_array(path, setup)
    if ending == ".csv":
        own, values = read_numbers(path, WHAT)
        header, _ = renamed(own, setup.columns, ())
        if header.count(TIME) != 1 or len(header) < 2:
            expected = "a column 'time' in s, and one for every sensor"
            raise wrong(path, expected, ", ".join(header[:6]), "line 1")
        column = header.index(TIME)
        names = [name for name in header if name != TIME]
        rows = np.nan_to_num(np.delete(values, column, axis=1).T, nan=0.0)  # empty columns
        return names, rows, _rate(path, values[:, column])
    functions = [x.channel for x in read_functions(path) if x.kind == OF_TIME]
    if not functions:
        expected = "records in time (functions of type 1) in dataset 58"
        raise wrong(path, expected, "none", "dataset 58")
    if len(lengths := {len(x.H) for x in functions}) > 1:
        found = ", ".join(map(str, sorted(lengths)))
        raise wrong(path, "records of one length", found, "dataset 58")
    named = [channel_name(x.response, setup.channels) for x in functions]
    signs = np.array([[sign] for _, sign in named])
    values = signs * np.array([np.asarray(x.H, float) for x in functions])
    return [name for name, _ in named], values, _rate(path, functions[0].frequency)


def read_arrays(path: Path) -> Read:
    """Return the numbers of a file of NumPy or MATLAB by name, in a process with limits."""
    if path.suffix.lower() == ".npy":
        return {"array": np.load(path, allow_pickle=False)}, None
    from scipy.io import loadmat

    named = {k: x for k, x in loadmat(path).items() if isinstance(x, np.ndarray)}
    return {name: x for name, x in named.items() if x.dtype.kind in "fiuc"}, None


def _of_array(path: Path, setup: SetFiles) -> tuple[Sequence[str], Floats, float]:
    file_size(path, WHAT, MOST_DATA)
    if setup.rate is None or not setup.sensors:
        expected = "'rate' and 'sensors' in its [[set]], which the file does not say"
        raise wrong(path, expected, "nothing", "records")
    try:
        read, _ = isolated(f"{__name__}:read_arrays", path)
    except IsolatedError as error:
        raise wrong(path, "an array of numbers", str(error)) from None
    arrays, count = list(read.values()), len(setup.sensors)
    tables = [x for x in arrays if x.ndim == 2 and x.dtype.kind in "fiu" and count in x.shape]
    if len(tables) != 1:
        expected = f"one array of samples by {count} sensors"
        shapes = ", ".join(" x ".join(map(str, x.shape)) for x in arrays) or "none"
        raise wrong(path, expected, shapes)
    table = np.asarray(tables[0], float)
    return setup.sensors, table if len(table) == count else table.T, setup.rate


def _rate(path: Path, time: Floats) -> float:
    """Return the samples per second of a time axis that is even but for its digits."""
    count, length = len(time) - 1, float(time[-1] - time[0])
    if count < 2 or length <= 0:
        raise wrong(path, "ascending times", "others", "time")
    # Digits of times may move a sample by a part of a step.
    off = np.abs(time - time[0] - np.arange(count + 1) * (length / count)).max()
    if off > 0.3 * length / count:
        found = f"times off by up to {off:.3g} s, steps of {length / count:.3g} s"
        raise wrong(path, "a time axis of even steps", found, "time")
    return count / length
