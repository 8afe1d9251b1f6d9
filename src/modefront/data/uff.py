"""Universal files: functions or records of blows from dataset 58, modes into dataset 55.

Modes are read in `modefront.data.uff55`.

The text of the file is checked first: files without datasets or cut off are refused, and exponents
written with D are mended here, since `pyuff`, which decodes the datasets, returns nothing
or fails without a place. `pyuff` is an extra, imported where it is used.

Format: Structural Dynamics Research Laboratory, University of Cincinnati, *Universal File
Formats*, datasets 55, 58 and 58b.
"""

from __future__ import annotations

import re
import tempfile
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from modefront.data.blows import Blow, Contents
from modefront.data.channels import Channel
from modefront.errors import Fault, InputError, reason
from modefront.inputs import read_text_bytes

FRF, COHERENCE, TIME = 4, 6, 1
"""Types of functions in dataset 58."""

FORCES = (9, 13)
"""Data types of the force of a hammer: reaction force, excitation force."""

QUANTITIES = {8: "receptance", 11: "mobility", 12: "accelerance"}
"""Quantities of the numerator: displacement, velocity, acceleration."""

AXES = {1: "X", 2: "Y", 3: "Z", 4: "RX", 5: "RY", 6: "RZ"}
"""Directions by their numbers in universal files."""

DELIMITER = re.compile(rb"^[ ]{4}-1[ \t]*\r?$", re.MULTILINE)
END_OF_BINARY = re.compile(rb"\r?\n?[ ]{4}-1[ \t]*\r?$", re.MULTILINE)
EXPONENT = re.compile(rb"(?<=[0-9.])[Dd](?=[+-]?[0-9])")

HEADERS = {55: 9, 58: 13}
"""Lines before the numbers of a dataset, that of its beginning included."""

RECORD_7 = 8
"""Line of dataset 58 with the kind and the number of values, first abscissa and increment."""

LARGEST = 2 * 10**9
"""Bytes of a universal file, at most."""

WHAT = "a universal file with frequency response functions or records of blows (dataset 58)"


@dataclass(frozen=True)
class Block:
    """One dataset of a universal file: its number, the line where it begins, its bytes."""

    number: int
    line: int
    start: int
    end: int
    binary: bool


def read_uff(path: Path) -> Contents:
    """Return the frequency response functions of a universal file, with their coherence.

    Where it has none, the records of blows: of the force and of the responses in time. Raises
    InputError where the file holds neither, is cut off or cannot be decoded.
    """
    file, content = str(path), read_text_bytes(path, WHAT, LARGEST)
    datasets = blocks(content, file)
    functions = [block for block in datasets if block.number == 58]
    if not functions:
        numbers = ", ".join(str(n) for n in dict.fromkeys(block.number for block in datasets))
        raise InputError(Fault(file, "datasets", WHAT, f"datasets {numbers} only"))
    decoded = [(block, _function(content, block, file)) for block in functions]
    kinds = {int(values["func_type"]) for _, values in decoded}
    if FRF in kinds:
        return Contents(channels=tuple(_channels(decoded, file)))
    blows = _blows(decoded, file) if TIME in kinds else []
    if not blows:
        expected = (
            "frequency response functions (type 4), or records in time (type 1) of the excitation "
            "force and of responses, among the functions of dataset 58"
        )
        found = f"functions of type {', '.join(map(str, sorted(kinds)))} only"
        if TIME in kinds:
            found += ", none of them a force and its responses"
        raise InputError(Fault(file, "dataset 58", expected, found))
    return Contents(blows=tuple(blows))


def _channels(decoded: Sequence[tuple[Block, Mapping[str, Any]]], file: str) -> list[Channel]:
    channels, coherences = [], {}
    for block, values in decoded:
        kind = int(values["func_type"])
        if kind == FRF:
            channels.append(_channel(values, block, file))
        elif kind == COHERENCE:
            coherence = _channel(values, block, file)
            coherences[coherence.reference, coherence.response] = np.abs(coherence.H)
    return [
        replace(channel, coherence=coherences.get((channel.reference, channel.response)))
        for channel in channels
    ]


def _blows(decoded: Sequence[tuple[Block, Mapping[str, Any]]], file: str) -> list[Blow]:
    """Return the blows of records in time.

    A blow ends where one of its channels comes again, or another force.
    """
    groups: list[dict[str, tuple[Block, Mapping[str, Any]]]] = [{}]
    for block, values in decoded:
        if int(values["func_type"]) != TIME:
            continue
        is_force = int(values["ordinate_spec_data_type"]) in FORCES
        key = "" if is_force else _degree_of_freedom(values["rsp_node"], values["rsp_dir"])[0]
        if key in groups[-1]:
            groups.append({})
        groups[-1][key] = block, values
    return [_blow(group, file) for group in groups if "" in group and len(group) > 1]


def _blow(group: Mapping[str, tuple[Block, Mapping[str, Any]]], file: str) -> Blow:
    block, force = group[""]
    records, quantities = {}, set()
    for name, (of_record, values) in group.items():
        sign = _degree_of_freedom(values["rsp_node"], values["rsp_dir"])[1]
        records[name] = sign * np.asarray(values["data"], float)
        if len(records[name]) != len(force["data"]):
            place = f"line {of_record.line}, dataset 58"
            expected = f"{len(force['data'])} samples, as the force of line {block.line}"
            raise InputError(Fault(file, place, expected, str(len(records[name]))))
        if name:
            quantities.add(QUANTITIES.get(int(values["ordinate_spec_data_type"]), ""))
    if len(quantities) > 1:
        found = ", ".join(sorted(quantity or "others" for quantity in quantities))
        expected = "responses of one quantity"
        raise InputError(Fault(file, f"line {block.line}, dataset 58", expected, found))
    return Blow(
        file,
        f"line {block.line}, dataset 58",
        _degree_of_freedom(force["rsp_node"], force["rsp_dir"])[0],
        np.asarray(force["x"], float),
        records.pop(""),
        records,
        quantities.pop(),
    )


def blocks(content: bytes, file: str) -> list[Block]:
    """Return the datasets of a universal file; raises InputError for other files and torn ones."""
    out = []
    after, line, counted = 0, 1, 0
    while opening := DELIMITER.search(content, after):
        header = re.compile(rb"\r?\n[ ]*([0-9]{1,5})(b?)([^\n]*)").match(content, opening.end())
        line += content.count(b"\n", counted, opening.start())
        counted = opening.start()
        if not header:
            break
        number, binary = int(header[1]), bool(header[2])
        if binary:
            closing = _end_of_binary(content, header[3], header.end())
        else:
            closing = DELIMITER.search(content, header.end())
        if not closing:
            expected = f"the end of dataset {number}, a line with -1"
            raise InputError(Fault(file, f"line {line}", expected, "the end of the file"))
        out.append(Block(number, line, opening.start(), closing.end(), binary))
        after = closing.end()
    if not out:
        expected = "datasets between lines with -1 in columns 5 and 6"
        raise InputError(Fault(file, "file", expected, "none: this is no universal file"))
    return out


def _end_of_binary(content: bytes, header: bytes, start: int) -> re.Match[bytes] | None:
    """Return the end of a binary dataset, which follows on its values; None where there is none.

    The number of bytes in the header is wrong in files of some programs, `pyuff` among them; then
    it is that of the values that record 7 announces.
    """
    numbers = header.split()
    lines = int(numbers[2]) if len(numbers) > 3 else 11
    for number in range(lines + 1):
        if number == RECORD_7 - 1:
            record = content[start : content.find(b"\n", start)].split()[:3]
        start = content.find(b"\n", start) + 1
        if not start:
            return None
    sizes = [int(numbers[3])] if len(numbers) > 3 else []
    for size in [*sizes, *_sizes(record)]:
        if closing := END_OF_BINARY.match(content, start + size):
            return closing
    return None


def _sizes(record: Sequence[bytes]) -> list[int]:
    """Return bytes that the values may take, from the first three numbers of record 7."""
    try:
        kind, count, even = map(int, record)
    except ValueError:
        return []
    size, values = (8 if kind in (4, 6) else 4), (2 if kind in (5, 6) else 1)
    if even:
        return [count * values * size]
    return [count * (1 + values) * size, count * (4 + values * size)]


def _pyuff(file: str) -> ModuleType:
    try:
        import pyuff
    except ImportError:
        expected = "pyuff, which `pip install modefront[uff]` brings"
        raise InputError(Fault(file, "universal file", expected, "no such package")) from None
    module: ModuleType = pyuff
    return module


def decode(content: bytes, block: Block, file: str) -> Mapping[str, Any]:
    """Return one dataset as pyuff reads it; raises InputError where it cannot."""
    pyuff = _pyuff(file)
    text = content[block.start : block.end] + b"\n"
    if not block.binary:
        text = with_exponents_of_c(text, block.number)
    place = f"line {block.line}, dataset {block.number}"
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "one.uff"
        copy.write_bytes(text)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                values: Mapping[str, Any] = pyuff.UFF(str(copy)).read_sets(0)
        except Exception as error:  # pyuff raises bare Exceptions
            expected = f"a dataset {block.number}"
            raise InputError(Fault(file, place, expected, reason(error))) from None
    return values


def with_exponents_of_c(text: bytes, number: int) -> bytes:
    """Return a dataset with the exponents of its numbers written with E, its names unchanged."""
    lines = HEADERS.get(number, 2)
    *head, body = text.split(b"\n", lines)
    if number == 58 and len(head) > RECORD_7:
        head[RECORD_7] = EXPONENT.sub(b"E", head[RECORD_7])
    return b"\n".join([*head, EXPONENT.sub(b"E", body)]).replace(b"\r\n", b"\n")


def _function(content: bytes, block: Block, file: str) -> Mapping[str, Any]:
    """Return a dataset 58 that holds as many values as its header says."""
    values, place = decode(content, block, file), f"line {block.line}, dataset 58"
    try:
        count, data = int(values["num_pts"]), np.asarray(values["data"])
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(Fault(file, place, "a dataset 58", reason(error))) from None
    if len(data) != count or len(np.atleast_1d(values["x"])) != count:
        raise InputError(Fault(file, place, f"{count} values, as its header says", str(len(data))))
    return values


def _channel(values: Mapping[str, Any], block: Block, file: str) -> Channel:
    response, sign = _degree_of_freedom(values["rsp_node"], values["rsp_dir"])
    reference, other = _degree_of_freedom(values["ref_node"], values["ref_dir"])
    quantity = QUANTITIES.get(int(values["ordinate_spec_data_type"]), "")
    place = f"line {block.line}, dataset 58 of {reference} to {response}"
    H = sign * other * np.asarray(values["data"], complex)
    x = np.asarray(values["x"], float)
    return Channel(file, place, reference, response, x, H, quantity)


def _degree_of_freedom(node: object, direction: object) -> tuple[str, int]:
    """Return the name of a degree of freedom, such as ``1Z``, and the sign of its direction."""
    number = int(float(str(direction or 0)))
    return f"{int(float(str(node)))}{AXES.get(abs(number), '')}", -1 if number < 0 else 1


def write_uff55(
    path: Path,
    sets: Sequence[str],
    modes: Sequence[Sequence[tuple[complex, np.ndarray[Any, np.dtype[np.complex128]]]]],
    sensors: Sequence[str],
) -> None:
    """Write modes as complex eigenvectors of first order, dataset 55 (analysis type 3).

    ``modes`` holds, for every data set, poles in rad/s and complex shapes at the sensors; sensors
    that are named by node and direction keep both, others are numbered from 1, in X.
    """
    pyuff = _pyuff(str(path))
    places = [_place(name, i) for i, name in enumerate(sensors)]
    nodes = list(dict.fromkeys(node for node, _ in places))
    names = ", ".join(sensors)[:79]
    written = []
    for name, listed in zip(sets, modes, strict=True):
        for number, (pole, phi) in enumerate(listed, start=1):
            values = np.zeros((3, len(nodes)), complex)
            for (node, axis), value in zip(places, phi, strict=True):
                values[axis, nodes.index(node)] = value
            written.append(
                pyuff.prepare_55(
                    model_type=1,
                    id1=f"set {name}"[:79],
                    id2=f"mode {number}, {abs(pole) / (2 * np.pi):.9g} Hz",
                    id3=names or "NONE",
                    id4="NONE",
                    id5="NONE",
                    analysis_type=3,
                    data_ch=2,
                    spec_data_type=8,
                    data_type=5,
                    n_data_per_node=3,
                    r1=values[0],
                    r2=values[1],
                    r3=values[2],
                    node_nums=nodes,
                    load_case=1,
                    mode_n=number,
                    eig=pole,
                    modal_a=0j,
                    modal_b=0j,
                )
            )
    path.unlink(missing_ok=True)
    pyuff.UFF(str(path)).write_sets(written, "add")


def _place(name: str, index: int) -> tuple[int, int]:
    matched = re.fullmatch(r"([0-9]+)([XYZ])", name)
    return (int(matched[1]), "XYZ".index(matched[2])) if matched else (index + 1, 0)
