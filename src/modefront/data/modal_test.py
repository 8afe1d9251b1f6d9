"""The test file: the files of a modal test with their references, and the options.

``docs/identification.md`` describes it, and the records of ambient tests. A universal file or a CSV
file alone is a test of one set; a data set of an ambient test is a setup.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from modefront import options as opt
from modefront._typing import Floats
from modefront.data.csv import COLUMNS, SECONDS, read_numbers, read_test_csv, renamed
from modefront.data.impact import EVEN, Blow, Windows, averaged, blows_of, unevenness
from modefront.data.responses import EXPECTED, FRF, ORDERS, TIME, Channel, DataSet, assemble
from modefront.data.uff import is_universal, read_functions, read_uff
from modefront.errors import Fault, InputError, noted, refuse, suggestion
from modefront.inputs import MOST_DATA, file_size, wrong
from modefront.rounding import LARGEST
from modefront.work.isolated import isolated

RECORDED = {"displacement": 0, "velocity": 1, "acceleration": 2}  # number of differentiations
WHAT = "a file with records in time"
MOST_MODES = 200  # modes that a test file may ask for

FILES, SENSORS, REFERENCES = (
    opt.Requirement(
        words, opt.array(opt.NAME, 1), further=lambda names: all(map(opt.is_name, names))
    )
    for words in ("a list of files", "a list of names", "one reference a file")
)
RATE = opt.number("samples per s, above zero", above=0)
TAU = opt.number("a time constant in s above zero", above=0)
WINDOW = opt.keys(["exponential"], exponential=TAU)
CHANNELS = opt.mapping(
    "a table, name = channel", opt.text("node and direction of a channel, such as '1Z'")
)
PLACES = opt.mapping(
    "a table, sensor = place",
    opt.numbers(
        "x, y, z and a direction that is not zero, six numbers",
        opt.array({"type": "number"}, 6, 6),
        lambda six: any(six[3:]),
    ),
)
MODES = opt.Requirement(
    "a list of numbers of modes, from 1", opt.array(opt.whole(1, 10**9).schema), tuple
)

IDENTIFY = opt.keys(
    (),
    band=opt.numbers(
        "a band [low, high] in Hz, 0 <= low < high", opt.array(opt.NOT_NEGATIVE, 2, 2), opt.rising
    ),
    modes=opt.Requirement(
        f"'auto' or a number of modes from 1 to {MOST_MODES}",
        opt.any_of({"enum": ["auto"]}, opt.whole(1, MOST_MODES).schema),
        lambda value: None if value == "auto" else value,
    ),
    keep=MODES,
    drop=MODES,
    seed=opt.numbers("a list of frequencies in Hz", opt.array(opt.NOT_NEGATIVE)),
)


@dataclass(frozen=True)
class Records:
    """Records of one setup, measured at once."""

    name: str  # of the setup
    sensors: tuple[str, ...]  # names
    rate: float  # samples per second
    values: Floats  # (sensors, samples)
    quantity: str = "acceleration"  # ``"displacement"``, ``"velocity"`` or ``"acceleration"``
    still: tuple[str, ...] = ()  # names of channels that do not move, which are left out

    @property
    def duration(self) -> float:
        """Length in s."""
        return self.values.shape[1] / self.rate


@dataclass(frozen=True)
class SetFiles:
    """The files of one data set, and what they do not say themselves."""

    name: str  # of the data set
    files: tuple[Path, ...]  # paths
    columns: Mapping[str, str] = field(default_factory=dict)  # names by those in CSV files
    channels: Mapping[str, str] = field(default_factory=dict)  # names by node and axis, 1Z or 1-Z
    rate: float | None = None  # samples per second, for arrays
    sensors: tuple[str, ...] = ()  # names of the channels of arrays
    references: tuple[str, ...] = ()  # one a file of functions, empty where it says its own
    decay: float = 0.0  # what an exponential window added to the decay of the functions, in 1/s
    quantity: str = ""  # of functions or records; empty where the test file does not say
    windows: Windows | None = None  # of records of blows; None where the test file has none


def joined(sets: Sequence[Sequence[object]]) -> list[int]:
    """Return an order of sets of sensors: each shares some with those before it where one does."""
    left, out, known = [*range(len(sets))], list[int](), set[object]()
    while left:
        k = next((k for k in left if not known.isdisjoint(sets[k])), left[0])
        left.remove(k)
        out.append(k)
        known |= {*sets[k]}
    return out


def channel_name(channel: str, names: Mapping[str, str]) -> tuple[str, int]:
    """Return the name of a channel, such as 1Z, and the sign of its direction, as 1-Z has it."""
    label = next((known for known in names if known.replace("-", "") == channel), "")
    return names.get(label, channel), -1 if "-" in label else 1


def read_records(setup: SetFiles) -> Records:
    """Return the records of a setup; raises InputError with what is wrong."""
    names, rows, rates = list[str](), list[Floats](), list[float]()
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
    if others := [x for x, name in setup.columns.items() if name not in (*names, SECONDS)]:
        found = ", ".join(map(repr, others))
        raise wrong(setup.files[0], "a column of the CSV files of the set", found, "columns")
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
        if header.count(SECONDS) != 1 or len(header) < 2:
            expected = "a column 'time' in s, and one for every sensor"
            expected += " ('columns' in [[set]] renames others)"
            raise wrong(path, expected, ", ".join(header[:6]), "line 1")
        column = header.index(SECONDS)
        names = [name for name in header if name != SECONDS]
        rows = np.nan_to_num(np.delete(values, column, axis=1).T, nan=0.0)  # empty columns
        return names, rows, _rate(path, values[:, column])
    functions = [x for x in read_functions(path) if x.kind == TIME]
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


def read_arrays(path: Path) -> dict[str, Any]:
    """Return the numbers of a file of NumPy or MATLAB by name, in a process with limits."""
    if path.suffix.lower() == ".npy":
        return {"array": np.load(path, allow_pickle=False)}
    import h5py  # takes time
    from scipy.io import loadmat

    from modefront import hdf5

    shapes = hdf5.variables(path) if h5py.is_hdf5(path) else {}  # of MATLAB 7.3
    read = {name: hdf5.variable(path, name) for name, shape in shapes.items() if shape}
    arrays = {k: x for k, x in (read or loadmat(path)).items() if isinstance(x, np.ndarray)}
    return {name: x for name, x in arrays.items() if x.dtype.kind in "fiuc"}


def _of_array(path: Path, setup: SetFiles) -> tuple[Sequence[str], Floats, float]:
    file_size(path, WHAT, MOST_DATA)
    if setup.rate is None or not setup.sensors:
        expected = "'rate' and 'sensors' in its [[set]], which the file does not say"
        raise wrong(path, expected, "nothing", "records")
    read = isolated(f"{__name__}:read_arrays", path, "an array of numbers")
    arrays, count = list(read.values()), len(setup.sensors)
    real = [x for x in arrays if x.size and x.dtype.kind in "fiu"]
    tables = [x for x in real if x.ndim == 2 and count in x.shape]
    if len(tables) != 1:
        expected = f"one array of samples by {count} sensors, which are real numbers"
        found = [f"{' x '.join(map(str, x.shape))} of {x.dtype}" for x in arrays]
        raise wrong(path, expected, ", ".join(found) or "none")
    table = np.asarray(tables[0], float)
    return setup.sensors, table if len(table) == count else table.T, setup.rate


def _rate(path: Path, time: Floats) -> float:
    """Return the samples per second of a time axis that is even but for its digits."""
    if found := unevenness(time):
        raise wrong(path, "a time axis of even steps", found, "time")
    # Products of steps and numbers have rounding.
    return float(f"{(len(time) - 1) / float(time[-1] - time[0]):.12g}")


@dataclass(frozen=True)
class ModalTest:
    """A modal test."""

    name: str  # of the test
    band: tuple[float, float] | None  # in Hz, or None for all lines
    modes: int | None  # their number, or None where it is to be found
    sets: tuple[DataSet, ...]  # the data sets with functions
    setups: tuple[Records, ...] = ()  # the records of an ambient test, which has no functions
    # (3,) positions and (3,) directions of sensors that are placed, by name
    places: Mapping[str, tuple[Floats, Floats]] = field(default_factory=dict)
    keep: tuple[int, ...] = ()  # keep, drop: numbers of the modes that stay alone, and that do not
    drop: tuple[int, ...] = ()
    seeds: tuple[float, ...] = ()  # frequencies in Hz at which there is to be a mode


def read_test(path: Path) -> ModalTest:
    """Return the test of a test file, a universal file or a CSV file; raises InputError."""
    if path.suffix.lower() == ".toml":
        return _from_toml(path)
    known, notes = SetFiles(path.stem, (path,), references=("",)), list[str]()
    if path.suffix.lower() == ".csv" and not is_universal(path):
        known = replace(known, references=("reference",), quantity="accelerance")
        notes = [f"{path}: the file does not say its quantity: taken for accelerance"]
    elif not is_universal(path):
        expected = "a universal file (.uff), a CSV file (.csv) or a test file (.toml)"
        raise wrong(path, expected, "none of these" if path.exists() else "no such file")
    data_set = _data_set(opt.Table(str(path), "", {}, []), known)
    data_set = replace(data_set, warnings=(*notes, *data_set.warnings))
    return ModalTest(path.stem, None, None, (data_set,))


def _from_toml(path: Path) -> ModalTest:
    root, _ = opt.read_toml(path, "a test file")
    name, quantity, ambient = path.stem, "", False
    if table := root.table("test", "a table [test]"):
        name = table.text("name", default=None) or name
        ambient = table.value("kind", opt.one_of("hammer", "ambient"), "hammer") == "ambient"
        quantity = table.value("quantity", opt.one_of(*RECORDED if ambient else ORDERS), "")
        table.close()
    named: dict[str, str] = root.value("sensors", CHANNELS, {})
    channels = {channel.upper().replace("+", ""): sensor for sensor, channel in named.items()}
    windows = None
    if not ambient and (table := root.table("impact", default=None)):
        windows = table.record(Windows)
    table = root.table("identify", default=None)
    given = (table.read(IDENTIFY) if table else None) or {}
    placed: dict[str, Sequence[float]] = root.value("geometry", PLACES, {})
    places = {
        name: (np.array(six[:3]), np.array(six[3:]) / np.linalg.norm(six[3:]))
        for name, six in placed.items()
    }
    common = SetFiles("", (), channels=channels, quantity=quantity, windows=windows)
    sets = _set_tables(root, ambient, common)
    root.close()
    refuse(root.faults)
    records, sensors = tuple(map(read_records, sets)) if ambient else (), list[str]()
    setups = [records[k] for k in joined([x.sensors for x in records])]
    for setup in setups:
        if sensors and {*sensors}.isdisjoint(setup.sensors):
            expected = f"a sensor that another set has: {', '.join(sorted({*sensors})[:8])}"
            found = ", ".join(setup.sensors[:8])
            raise InputError(Fault(root.file, f"[[set]] {setup.name!r}", expected, found))
        sensors += setup.sensors
    data_sets = () if ambient else tuple(_data_set(root, each) for each in sets)
    sensors += [x for each in data_sets for x in each.data.responses]
    others = [x for each in data_sets for x in each.data.references]
    known = dict.fromkeys([*sensors, *others, *(x for each in setups for x in each.still)])
    labels = [named.get(name, name) for name in known]
    for sensor in (x for x in named if x not in known):
        expected = "a channel of the files: " + ", ".join(labels[:8])
        root.fault(f"[sensors] {sensor}", expected, suggestion(named[sensor], labels))
    for place in places:
        if place not in sensors:
            root.fault(f"[geometry] {place}", "a sensor of the files", suggestion(place, sensors))
    refuse(root.faults)
    band, modes = given.get("band"), given.get("modes")
    keep, drop, seeds = (tuple(given.get(key, ())) for key in ("keep", "drop", "seed"))
    return ModalTest(name, band, modes, data_sets, tuple(setups), places, keep, drop, seeds)


def _set_tables(root: opt.Table, ambient: bool, common: SetFiles) -> list[SetFiles]:
    out = []
    for position, table in enumerate(root.tables("set", required=True), start=1):
        name = table.text("name", default=str(position)) or str(position)
        files = tuple(map(table.path, table.value("files", FILES) or []))
        columns = table.value("columns", COLUMNS, {})
        known = replace(common, name=name, files=files, columns=columns)
        if ambient:
            rate = table.value("rate", RATE, None)
            sensors = tuple(table.value("sensors", SENSORS, []))
            for sensor in opt.repeated(sensors):
                table.fault("sensors", "each sensor once", f"{sensor!r} twice")
            known = replace(known, rate=rate, sensors=sensors)
        else:
            references = table.value("reference", REFERENCES, None)
            if references is None:
                for file in (file for file in files if not is_universal(file)):
                    table.fault("reference", f"the reference of {file.name}", "nothing")
            elif len(references) != len(files):
                found = f"{len(references)} for {len(files)} files"
                table.fault("reference", "one reference a file", found)
            window = table.table("window", "a table { exponential = time constant in s }", None)
            tau = (window.read(WINDOW) if window else None) or {"exponential": np.inf}
            given = tuple(references or [""] * len(files))
            known = replace(known, references=given, decay=1 / tau["exponential"])
        table.close()
        out.append(known)
    for name in opt.repeated(known.name for known in out):
        root.fault("[[set]]", "a name for each data set", f"{name!r} twice")
    return out


def _data_set(root: opt.Table, known: SetFiles) -> DataSet:
    """Return one data set with the names of the test file, at the side that has the sensors."""
    channels, blows, used = list[Channel](), list[Blow](), set[str]()
    for file, reference in zip(known.files, known.references, strict=True):
        with noted(root.faults):
            if is_universal(file):
                found = read_uff(file)
            else:
                found, of_file = read_test_csv(file, known.columns)
                used |= of_file
            found = [replace(x, reference=reference or x.reference) for x in found]
            channels += [x for x in found if x.kind == FRF]
            blows += blows_of(x for x in found if x.kind == TIME)
    refuse(root.faults)
    place = f"[[set]] {known.name!r}"
    for unused in sorted(known.columns.keys() - used):
        root.fault(f"{place} columns", "a column of the CSV files of the set", repr(unused))
    if channels and blows:
        root.fault(place, "either functions or records of blows", "both")
    elif channels and known.windows:
        made = "frequency response functions: 'window' in their [[set]] says how they were made"
        root.fault(place, "records of blows in time, for [impact]", made)
    elif blows and known.decay:
        made = "records of blows: [impact] has their windows"
        root.fault(place, "functions, for 'window'", made)
    refuse(root.faults)
    warnings, decay = list[str](), known.decay
    if blows:
        channels, warnings, decay = averaged(blows, known.windows or Windows())
    responses = {channel.response for channel in channels}
    references = {channel.reference for channel in channels}
    names, turned = known.channels, len(references) > len(responses) == 1
    if names:
        plain = {channel.replace("-", "") for channel in names}
        turned = len(plain & references) > len(plain & responses)
    named = []
    for channel in channels:
        response, sign = channel_name(channel.response, names)
        reference, other = channel_name(channel.reference, names)
        H = channel.H if sign == other else -channel.H
        named.append(replace(channel, reference=reference, response=response, H=H))
    out = assemble(named, known.quantity, known.name, turned, decay)
    return replace(out, warnings=(*warnings, *out.warnings))
