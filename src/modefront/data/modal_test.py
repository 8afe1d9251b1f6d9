"""The test file: the files of a modal test with their references, and the options.

TOML with the tables ``[test]``, ``[identify]``, ``[impact]``, ``[sensors]`` and a table ``[[set]]``
for every data set, which is a setup of an ambient test. A universal file or a CSV file alone is a
test of one set.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from modefront._typing import Floats
from modefront.data.csv import read_test_csv
from modefront.data.impact import ESTIMATORS, Averaged, Contents, Windows, averaged_blows
from modefront.data.records import ORDERS as RECORDED
from modefront.data.records import Records, SetFiles, read_records
from modefront.data.responses import ORDERS, Channel, DataSet, assemble, joined
from modefront.data.uff import is_universal, read_uff
from modefront.errors import Fault, InputError, refuse, suggestion
from modefront.inputs import wrong
from modefront.json_schema import NOT_NEGATIVE, array
from modefront.options import Table, is_name, numbers, read_toml, repeated, rising

KINDS = ("hammer", "ambient")
"""Kinds of tests."""

MOST_MODES = 200
"""Modes that a test file may ask for."""


@dataclass(frozen=True)
class ByHand:
    """Modes that are chosen by hand.

    Attributes
    ----------
    keep, drop : numbers of the modes that stay alone, and that do not
    seeds : frequencies in Hz at which there is to be a mode
    """

    keep: tuple[int, ...] = ()
    drop: tuple[int, ...] = ()
    seeds: tuple[float, ...] = ()


@dataclass(frozen=True)
class ModalTest:
    """A modal test.

    Attributes
    ----------
    name : of the test
    band : in Hz, or None for all lines
    modes : their number, or None where it is to be found
    sets : the data sets with functions
    setups : the records of an ambient test, which has no functions
    chosen : what is chosen by hand
    places : (3,) positions of sensors and (3,) directions, by name; of sensors that are placed
    """

    name: str
    band: tuple[float, float] | None
    modes: int | None
    sets: tuple[DataSet, ...]
    setups: tuple[Records, ...] = ()
    chosen: ByHand = ByHand()
    places: Mapping[str, tuple[Floats, Floats]] = field(default_factory=dict)


@dataclass(frozen=True)
class _Settings:
    quantity: str = ""
    sensors: dict[str, str] = field(default_factory=dict)
    windows: Windows | None = None
    decay: float = 0.0


def read_test(path: Path) -> ModalTest:
    """Return the test of a test file, a universal file or a CSV file; raises InputError."""
    if path.suffix.lower() == ".toml":
        return _from_toml(path)
    settings = _Settings()
    if is_universal(path):
        contents = [read_uff(path)]
    elif path.suffix.lower() == ".csv":
        contents = [read_test_csv(path, "reference")]
        settings = _Settings("accelerance")
    else:
        expected = "a universal file (.uff), a CSV file (.csv) or a test file (.toml)"
        found = "no such file" if not path.exists() else "none of these"
        raise wrong(path, expected, found)
    data_set = _assembled(contents, path.stem, settings)
    if path.suffix.lower() == ".csv":
        note = f"{path}: the file does not say its quantity: taken for accelerance"
        data_set = replace(data_set, warnings=(note, *data_set.warnings))
    return ModalTest(path.stem, None, None, (data_set,))


def _from_toml(path: Path) -> ModalTest:
    root, _ = read_toml(path, "a test file")
    name, ambient, settings = _test_table(root)
    if not ambient:
        settings = replace(settings, windows=_impact_table(root))
    band, modes, chosen = _identify_table(root)
    places = _geometry_table(root)
    sets = _set_tables(root, settings.sensors, ambient)
    root.close()
    refuse(root.faults)
    data_sets: list[DataSet] = []
    setups: list[Records] = []
    if ambient:
        setups = _records(root, sets, settings.quantity or "acceleration")
        sensors = [sensor for each in setups for sensor in each.sensors]
    else:
        data_sets = [_data_set(root, each, settings) for each in sets]
        sensors = [sensor for each in data_sets for sensor in each.data.responses]
    for place in places:
        if place not in sensors:
            root.fault(f"[geometry] {place}", "a sensor of the files", suggestion(place, sensors))
    refuse(root.faults)
    parts = tuple(data_sets), tuple(setups), chosen, places
    return ModalTest(name or path.stem, band, modes, *parts)


def _records(root: Table, sets: Sequence[SetFiles], quantity: str) -> list[Records]:
    """Return the records of an ambient test, of which every set is a setup."""
    out = [read_records(each, quantity) for each in sets]
    joined_to = set(out[0].sensors)
    for each in out[1:]:
        if joined_to.isdisjoint(each.sensors):
            expected = f"a sensor that another set has: {', '.join(sorted(joined_to)[:8])}"
            found = ", ".join(each.sensors[:8])
            raise InputError(Fault(root.file, f"[[set]] {each.name!r}", expected, found))
        joined_to.update(each.sensors)
    return out


def _data_set(root: Table, known: SetFiles, settings: _Settings) -> DataSet:
    pairs = zip(known.files, known.references, strict=True)
    contents = [_contents(root, file, reference, known.columns) for file, reference in pairs]
    for unused in sorted(frozenset.intersection(*(x.unused for x in contents))):
        expected = "a column of the CSV files of the set"
        root.fault(f"[[set]] {known.name!r} columns", expected, repr(unused))
    refuse(root.faults)
    its_own = replace(settings, decay=known.decay)
    return _assembled(contents, known.name, its_own, root)


def _test_table(root: Table) -> tuple[str, bool, _Settings]:
    title, quantity, ambient = "", "", False
    table = root.table("test", "a table [test]")
    if table:
        title = table.text("name", default=None) or ""
        ambient = table.choice("kind", KINDS, KINDS[0]) == "ambient"
        quantity = table.choice("quantity", tuple(RECORDED if ambient else ORDERS), None) or ""
        table.close()
    sensors: dict[str, str] = {}
    table = root.table("sensors", default=None)
    if table:
        for name in table.values:
            channel = table.text(name, "node and direction of a channel, such as '1Z'")
            if channel:
                sensors[channel.upper().replace("+", "")] = name
        table.close()
    return title, ambient, _Settings(quantity, sensors)


def _identify_table(root: Table) -> tuple[tuple[float, float] | None, int | None, ByHand]:
    table = root.table("identify", default=None)
    if not table:
        return None, None, ByHand()
    expected = "a band [low, high] in Hz, 0 <= low < high"
    limits = table.value("band", numbers(expected, array(NOT_NEGATIVE, 2, 2), rising), None)
    modes = table.take(
        "modes",
        f"'auto' or a number of modes from 1 to {MOST_MODES}",
        lambda x: x == "auto" or (type(x) is int and 1 <= x <= MOST_MODES),
        "auto",
    )
    modes_expected = "a list of numbers of modes, from 1"
    whole = [
        table.value(key, numbers(modes_expected, array({"type": "integer", "minimum": 1})), ())
        for key in ("keep", "drop")
    ]
    expected = "a list of frequencies in Hz"
    seeds = table.value("seed", numbers(expected, array(NOT_NEGATIVE)), ())
    table.close()
    band = (limits[0], limits[1]) if limits else None
    keep, drop = (tuple(map(int, chosen or ())) for chosen in whole)
    return band, None if modes == "auto" else int(modes), ByHand(keep, drop, tuple(seeds or ()))


def _geometry_table(root: Table) -> dict[str, tuple[Floats, Floats]]:
    """Return the places of ``[geometry]``: sensor = [x, y, z, direction, of three numbers too]."""
    table, out = root.table("geometry", default=None), {}
    six = numbers("x, y, z and a direction, six numbers", array({"type": "number"}, 6, 6))
    for name in table.values if table else ():
        if table and (values := table.value(name, six)) is not None:
            place = np.array(values)
            size = float(np.linalg.norm(place[3:]))
            if not size:
                table.fault(name, "a direction that is not zero", "zeros")
            out[name] = place[:3], place[3:] / (size or 1.0)
    return out


def _impact_table(root: Table) -> Windows | None:
    table = root.table("impact", default=None)
    if not table:
        return None
    seconds = "a time in s above zero"
    estimator = table.choice("estimator", ESTIMATORS, "H1")
    force_window = table.number("force_window", seconds, None, above=0)
    if table.values.get("exponential") == "none":
        table.requested.append("exponential")
        exponential = math.inf
    else:
        seconds = "a time constant in s above zero, or 'none'"
        exponential = table.number("exponential", seconds, None, above=0)
    windows = Windows(estimator, force_window, exponential)
    table.close()
    return windows


def _set_tables(root: Table, channels: Mapping[str, str], ambient: bool) -> list[SetFiles]:
    out = []
    for number, table in enumerate(root.tables("set", required=True), start=1):
        name = table.text("name", default=str(number)) or str(number)
        names = table.take("files", "a list of files", _are_names, ...) or []
        files = tuple(Path(root.file).parent / file for file in names)
        known = SetFiles(name, files, table.names("columns"), channels)
        if ambient:
            rate = table.number("rate", "samples per s, above zero", None, above=0)
            sensors = tuple(table.take("sensors", "a list of names", _are_names, []))
            for sensor in repeated(sensors):
                table.fault("sensors", "each sensor once", f"{sensor!r} twice")
            known = replace(known, rate=rate, sensors=sensors)
        else:
            known = replace(known, references=_references(table, files), decay=_decay(table))
        table.close()
        out.append(known)
    for name in repeated(known.name for known in out):
        root.fault("[[set]]", "a name for each data set", f"{name!r} twice")
    return out


def _references(table: Table, files: Sequence[Path]) -> tuple[str, ...]:
    references = table.take("reference", "one reference a file", _are_names, None)
    if references is not None and len(references) == len(files):
        return tuple(references)
    if references is not None:
        found = f"{len(references)} for {len(files)} files"
        table.fault("reference", "one reference a file", found)
    for file in files if references is None else ():
        if not is_universal(file):
            table.fault("reference", f"the reference of {file.name}", "nothing")
    return ("",) * len(files)


def _decay(table: Table) -> float:
    window = table.table("window", "a table { exponential = time constant in s }", None)
    if window is None:
        return 0.0
    tau = window.number("exponential", "a time constant in s above zero", above=0)
    window.close()
    return 1 / tau if tau else 0.0


def _are_names(value: object) -> bool:
    return isinstance(value, list) and bool(value) and all(map(is_name, value))


def _contents(root: Table, path: Path, reference: str, columns: Mapping[str, str]) -> Contents:
    try:
        if not is_universal(path):
            return read_test_csv(path, reference, columns)
        contents = replace(read_uff(path), unused=frozenset(columns))
    except InputError as error:
        root.faults.extend(error.faults)
        return Contents()
    if not reference:
        return contents
    return replace(
        contents,
        channels=tuple(replace(channel, reference=reference) for channel in contents.channels),
        blows=tuple(replace(blow, reference=reference) for blow in contents.blows),
    )


def _assembled(
    contents: Sequence[Contents], name: str, settings: _Settings, root: Table | None = None
) -> DataSet:
    """Return one data set with the names of the test file, at the side that has the sensors."""
    averaged = _functions(contents, name, settings, root)
    channels = averaged.channels
    responses = {channel.response for channel in channels}
    references = {channel.reference for channel in channels}
    named = settings.sensors
    if named:
        plain = {channel.replace("-", "") for channel in named}
        turned = len(plain & references) > len(plain & responses)
        missing = plain - (references if turned else responses)
        if missing and root is not None:
            for label in sorted(missing):
                labels = sorted(references if turned else responses)
                root.fault(
                    f"[sensors] {named.get(label, '')}",
                    "a channel of the files: " + ", ".join(labels[:8]),
                    suggestion(label, labels),
                )
            raise InputError(root.faults)
    else:
        turned = len(references) > len(responses) == 1
    named_channels = [_named(channel, named) for channel in channels]
    out = assemble(named_channels, settings.quantity, name, turned)
    noise = {_name(label, named)[0]: each for label, each in averaged.force_noise.items()}
    known = None
    if not turned:  # else each point of the hammer, now a response, has noise of its own
        known = joined([noise.get(label) for label in out.data.references])
    data = replace(out.data, decay=averaged.decay, force_noise=known)
    return DataSet(name, data, (*averaged.warnings, *out.warnings))


def _functions(
    contents: Sequence[Contents], name: str, settings: _Settings, root: Table | None
) -> Averaged:
    channels = tuple(channel for content in contents for channel in content.channels)
    blows = [blow for content in contents for blow in content.blows]
    windows, wrong = settings.windows, None
    if channels and blows:
        wrong = "either functions or records of blows", "both"
    elif channels and windows:
        found = "frequency response functions: 'window' in their [[set]] says how they were made"
        wrong = "records of blows in time, for [impact]", found
    elif blows and settings.decay:
        wrong = "functions, for 'window'", "records of blows: [impact] has their windows"
    if wrong and root is not None:
        raise InputError(Fault(root.file, f"[[set]] {name!r}", *wrong))
    if not blows:
        return Averaged(channels, (), settings.decay, {})
    return averaged_blows(blows, windows or Windows(), settings.quantity)


def _named(channel: Channel, names: dict[str, str]) -> Channel:
    response, response_sign = _name(channel.response, names)
    reference, reference_sign = _name(channel.reference, names)
    H = response_sign * reference_sign * channel.H
    return replace(channel, reference=reference, response=response, H=H)


def _name(channel: str, names: dict[str, str]) -> tuple[str, int]:
    """Return the name of a channel and the sign of its direction in ``[sensors]``, as in 1-Z."""
    for known, name in names.items():
        if known.replace("-", "") == channel:
            return name, -1 if "-" in known else 1
    return channel, 1
