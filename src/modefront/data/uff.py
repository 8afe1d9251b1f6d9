"""Universal files: functions or records of blows from dataset 58, modes into dataset 55.

Modes are read in `modefront.data.uff55`. A dataset stands between two lines with -1; what it
declares is compared with what it holds.

Format: Structural Dynamics Research Laboratory, University of Cincinnati, *Universal File
Formats*, datasets 55, 58 and 58b.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from modefront._typing import Complexes, Floats
from modefront.data.blows import Blow, Contents
from modefront.data.channels import Channel
from modefront.errors import Fault, InputError, reason
from modefront.inputs import MOST_DATA, counted, fortran, read_text_bytes
from modefront.outputs import write_text

FRF, COHERENCE, TIME = 4, 6, 1
"""Types of functions in dataset 58."""

FORCES = (9, 13)
"""Data types of the force of a hammer: reaction force, excitation force."""

QUANTITIES = {8: "receptance", 11: "mobility", 12: "accelerance"}
"""Quantities of the numerator: displacement, velocity, acceleration."""

AXES = {1: "X", 2: "Y", 3: "Z", 4: "RX", 5: "RY", 6: "RZ"}
"""Directions by their numbers in universal files."""

OPENING = re.compile(
    rb"(?:\xef\xbb\xbf)?\s*^[ ]{4}-1[ \t]*\r?\n[ ]*([0-9]{1,5})(b?)(?!\S)([^\n]*)(?:\n|\Z)",
    re.MULTILINE,
)
CLOSING = re.compile(rb"^[ ]{4}-1[ \t]*\r?$", re.MULTILINE)
END_OF_BINARY = re.compile(rb"\r?\n?[ ]{4}-1[ \t]*\r?$", re.MULTILINE)

KNOWN = (15, 55, 58, 2411, 2420)
"""Datasets that are read, whose numbers may have blanks before them as no other line has."""

BLANK = b" \t\r\n\0\x1a"
"""Bytes that may stand behind the last dataset."""

NEXT = re.compile(r"(?<=[0-9.])(?=[+-][0-9]*\.)")
"""Beginning of a number that follows on another one without a blank."""

NUMERIC = b"0123456789+-.eEdDnNaAiIfFtTyY \t\r\n"
"""Bytes of numbers, of nan and infinity among them, and of what separates them."""

HEADER, RECORD_7 = 11, 6
"""Lines of dataset 58 before its numbers; the one with their kind and number, from 0."""

FIELDS_6 = (0, 5, 15, 20, 30, 41, 51, 55, 66, 76, 80)
"""Columns of the fields of record 6 of dataset 58."""

KINDS = {2: "f4", 4: "f8", 5: "c8", 6: "c16"}
"""Types of values in dataset 58, as NumPy knows them."""

WHAT = "a universal file with frequency response functions or records of blows (dataset 58)"


@dataclass(frozen=True)
class Block:
    """One dataset of a universal file: its number, the line where it begins, its bytes.

    Attributes
    ----------
    number, line : its number, and the line where it begins
    start, end : bytes behind its number, and before the line that ends it
    binary : the words behind the number of a binary dataset; None for one of text
    """

    number: int
    line: int
    start: int
    end: int
    binary: list[str] | None

    @property
    def place(self) -> str:
        """Place in the file, for messages."""
        return f"line {self.line}, dataset {self.number}"


def read_uff(path: Path) -> Contents:
    """Return the frequency response functions of a universal file, with their coherence.

    Where it has none, the records of blows: of the force and of the responses in time. Raises
    InputError where the file holds neither, is cut off or cannot be decoded.
    """
    file, decoded = str(path), read_functions(path)
    kinds = {values.kind for _, values in decoded}
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


def read_functions(path: Path) -> list[tuple[Block, Function]]:
    """Return all datasets 58 of a universal file; raises InputError where it has none."""
    file, content = str(path), read_text_bytes(path, WHAT, MOST_DATA)
    datasets = blocks(content, file)
    functions = [block for block in datasets if block.number == 58]
    if not functions:
        numbers = ", ".join(str(n) for n in dict.fromkeys(block.number for block in datasets))
        raise InputError(Fault(file, "datasets", WHAT, f"datasets {numbers} only"))
    return [(block, _function(content, block, file)) for block in functions]


@dataclass(frozen=True, eq=False)
class Function:
    """A dataset 58: its type, what it is of, its degrees of freedom, abscissae and values."""

    kind: int
    ordinate: int
    response: tuple[str, int]
    reference: tuple[str, int]
    x: Floats
    data: Floats | Complexes


def _channels(decoded: Sequence[tuple[Block, Function]], file: str) -> list[Channel]:
    channels, coherences = [], {}
    for block, values in decoded:
        if values.kind == FRF:
            channels.append(_channel(values, block, file))
        elif values.kind == COHERENCE:
            coherence = _channel(values, block, file)
            coherences[coherence.reference, coherence.response] = np.abs(coherence.H)
    return [
        replace(channel, coherence=coherences.get((channel.reference, channel.response)))
        for channel in channels
    ]


def _blows(decoded: Sequence[tuple[Block, Function]], file: str) -> list[Blow]:
    """Return the blows of records in time.

    A blow ends where one of its channels comes again, or another force.
    """
    groups: list[dict[str, tuple[Block, Function]]] = [{}]
    for block, values in decoded:
        if values.kind != TIME:
            continue
        key = "" if values.ordinate in FORCES else values.response[0]
        if key in groups[-1]:
            groups.append({})
        groups[-1][key] = block, values
    return [_blow(group, file) for group in groups if "" in group and len(group) > 1]


def _blow(group: Mapping[str, tuple[Block, Function]], file: str) -> Blow:
    block, force = group[""]
    records, quantities = {}, set()
    for name, (of_record, values) in group.items():
        records[name] = values.response[1] * np.asarray(values.data, float)
        if len(records[name]) != len(force.data):
            place = f"line {of_record.line}, dataset 58"
            expected = f"{len(force.data)} samples, as the force of line {block.line}"
            raise InputError(Fault(file, place, expected, str(len(records[name]))))
        if name:
            quantities.add(QUANTITIES.get(values.ordinate, ""))
    if len(quantities) > 1:
        found = ", ".join(sorted(quantity or "others" for quantity in quantities))
        expected = "responses of one quantity"
        raise InputError(Fault(file, f"line {block.line}, dataset 58", expected, found))
    return Blow(
        file,
        f"line {block.line}, dataset 58",
        force.response[0],
        force.x,
        records.pop(""),
        records,
        quantities.pop(),
    )


def blocks(content: bytes, file: str) -> list[Block]:
    """Return the datasets of a universal file; raises InputError for other files and torn ones."""
    out: list[Block] = []
    after, line, seen = 0, 1, 0
    while opening := OPENING.match(content, after):
        line += content.count(b"\n", seen, opening.start(1)) - 1
        seen = content.rfind(b"\n", 0, opening.start(1))
        number, binary = int(opening[1]), bool(opening[2])
        if number not in KNOWN and opening.end(1) - content.rfind(b"\n", 0, opening.start(1)) != 7:
            expected = "the number of a dataset, which ends in column 6"
            found = repr(opening[0].splitlines()[-1].decode("latin-1"))
            raise InputError(Fault(file, f"line {line + 1}", expected, found))
        if binary:
            closing = _end_of_binary(content, opening[3], opening.end())
        else:
            closing = CLOSING.search(content, opening.end())
        if not closing:
            expected = f"the end of dataset {number}, a line with -1"
            raise InputError(Fault(file, f"line {line}", expected, "the end of the file"))
        words = opening[3].decode("latin-1").split()
        out.append(Block(number, line, opening.end(), closing.start(), words if binary else None))
        after = closing.end()
    if not out:
        expected = "datasets between lines with -1 in columns 5 and 6"
        raise InputError(Fault(file, "file", expected, "none: this is no universal file"))
    if rest := content[after:].strip(BLANK):
        line = content.count(b"\n", 0, content.find(rest, after)) + 1
        expected = "a dataset: a line with -1 in columns 5 and 6, then one with its number"
        found = rest[:40].partition(b"\n")[0].decode("latin-1").strip()
        raise InputError(Fault(file, f"line {line}", expected, repr(found)))
    return out


def _end_of_binary(content: bytes, header: bytes, start: int) -> re.Match[bytes] | None:
    """Return the end of a binary dataset, which follows on its values; None where there is none.

    The number of bytes in the header is wrong in files of some programs, `pyuff` among them; then
    it is that of the values that record 7 announces.
    """
    numbers = header.split()
    try:
        lines = int(numbers[2]) if len(numbers) > 3 else HEADER
        sizes = [int(numbers[3])] if len(numbers) > 3 else []
    except ValueError:
        return None
    for number in range(lines):
        if number == RECORD_7:
            record = content[start : content.find(b"\n", start)].split()[:3]
        start = content.find(b"\n", start) + 1
        if not start:
            return None
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


def text_lines(content: bytes, block: Block) -> list[str]:
    """Return the lines of a dataset behind the one with its number."""
    return content[block.start : block.end].decode("utf-8", "replace").splitlines()


def reals(text: str) -> list[float]:
    """Return numbers as Fortran writes them; raises ValueError for anything else.

    >>> reals(" 1.5D+00-2.50000E+00 1.00000-100")
    [1.5, -2.5, 1e-100]
    """
    return [fortran(word) for word in NEXT.sub(" ", text).split()]


def _function(content: bytes, block: Block, file: str) -> Function:
    """Return a dataset 58 that holds as many values as its header says."""
    *lines, body = content[block.start : block.end].split(b"\n", HEADER)
    head = [line.decode("utf-8", "replace") for line in lines]
    try:
        six = [head[5][a:b].strip() for a, b in pairwise(FIELDS_6)]
        form, count, even = (int(head[RECORD_7][k : k + 10]) for k in (0, 10, 20))
        first, step = (reals(head[RECORD_7][k : k + 13])[0] for k in (30, 43))
        if even not in (0, 1):
            raise ValueError(f"abscissae of the kind {even}")
        x, data = _values(file, block, body, (form, count, even))
        return Function(
            int(six[0]),
            int(head[8][:10]),
            _degree_of_freedom(six[5], six[6]),
            _degree_of_freedom(six[8], six[9]),
            np.asarray(first + np.arange(count) * step) if even else x,
            data,
        )
    except (ValueError, IndexError, KeyError, OverflowError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(Fault(file, block.place, "a dataset 58", reason(error))) from None


def _values(
    file: str, block: Block, body: bytes, record: tuple[int, int, int]
) -> tuple[Floats, Floats | Complexes]:
    """Return abscissae, none where these are even, and values, of the form, number and spacing."""
    form, count, even = record
    is_complex = form in (5, 6)
    if block.binary is not None:
        order = "<" if block.binary[:1] == ["1"] else ">"
        y, x = order + KINDS[form], order + ("f4" if form in (2, 5) else "f8")
        kinds = [np.dtype([("x", each), ("y", y)][even:]) for each in (x, order + "f4")]
        kind = next((each for each in kinds if len(body) == count * each.itemsize), kinds[0])
        counted(file, block.place, "bytes of values", count * kind.itemsize, len(body))
        table = np.frombuffer(body, kind)
        of_x = np.zeros(0) if even else table["x"].astype(float)
        return of_x, table["y"].astype(complex if is_complex else float)
    if other := body.translate(None, NUMERIC):
        raise ValueError(f"the byte {other[:1]!r} among the values")
    try:
        numbers = np.array(body.split(), dtype=float)
    except ValueError:
        numbers = np.array(reals(body.decode("ascii")))
    columns = (1 - even) + (2 if is_complex else 1)
    counted(file, block.place, "values", count, numbers.size / columns)
    points = [line.count(b".") for line in body.rstrip().split(b"\n")]
    if sum(points) == numbers.size and max(points[1:], default=0) > min(points[:-1], default=0):
        raise ValueError("a line with fewer values than one behind it")
    rows = numbers.reshape(-1, columns).T
    of_y = rows[1 - even :]
    return rows[0], of_y[0] + 1j * of_y[1] if is_complex else of_y[0]


def _channel(values: Function, block: Block, file: str) -> Channel:
    (response, sign), (reference, other) = values.response, values.reference
    place = f"{block.place} of {reference} to {response}"
    H = sign * other * np.asarray(values.data, complex)
    return Channel(
        file, place, reference, response, values.x, H, QUANTITIES.get(values.ordinate, "")
    )


def _degree_of_freedom(node: str, direction: str) -> tuple[str, int]:
    """Return the name of a degree of freedom, such as ``1Z``, and the sign of its direction."""
    if bool(node) != bool(direction):
        raise ValueError(f"a node {node!r} with the direction {direction!r}")
    number = int(direction or 0)
    return f"{int(node or 0)}{AXES.get(abs(number), '')}", -1 if number < 0 else 1


def write_uff55(
    path: Path,
    sets: Sequence[str],
    modes: Sequence[Sequence[tuple[complex, np.ndarray[Any, np.dtype[np.complex128]]]]],
    sensors: Sequence[str],
    pairs: Sequence[Sequence[tuple[int, int]]] = (),
) -> None:
    """Write modes as complex eigenvectors of first order, dataset 55 (analysis type 3).

    ``modes`` holds, for every data set, poles in rad/s and complex shapes at the sensors; sensors
    that are named by node and direction keep both, others are numbered from 1, in X. ``pairs``
    holds positions of modes of one pole, for every data set; none unless given.
    """
    places = [_place(name, i) for i, name in enumerate(sensors)]
    nodes = list(dict.fromkeys(node for node, _ in places))
    rows, axes = [nodes.index(node) for node, _ in places], [axis for _, axis in places]
    written = []
    for name, listed, paired in zip(sets, modes, pairs or [()] * len(sets), strict=True):
        other = {a + 1: b + 1 for pair in paired for a, b in (pair, pair[::-1])}
        for number, (pole, phi) in enumerate(listed, start=1):
            values = np.zeros((len(nodes), 3), complex)
            values[rows, axes] = phi
            frequency = f"mode {number}, {abs(pole) / (2 * np.pi):.9g} Hz"
            frequency += f", pair with mode {other[number]}" if number in other else ""
            texts = (f"set {name}"[:79], frequency, ", ".join(sensors)[:79] or "NONE")
            parameters = (pole.real, pole.imag, 0.0, 0.0, 0.0, 0.0)
            content = dataset_55(texts, number, parameters, nodes, values)
            written.append(f"    -1\n    55\n{content}    -1\n")
    write_text(path, "".join(written))


def dataset_55(
    texts: Sequence[str],
    number: int,
    parameters: Sequence[float],
    nodes: Sequence[int],
    values: Floats | Complexes,
) -> str:
    """Return a dataset 55 behind the line of its number: displacements in a mode.

    ``values`` (nodes, 3 or 6) are those of a normal mode where they are real, else of a complex one
    of first order; ``parameters`` belong to the one or the other, and ``texts`` begin the dataset.
    """
    kind, data = (3, 5) if np.iscomplexobj(values) else (2, 2)
    rows = np.ascontiguousarray(values).view(float).tolist()
    size = values.shape[1]
    integers = (1, kind, 3 if size == 6 else 2, 8, data, size), (2, len(parameters), 1, number)
    lines = [*texts, *["NONE"] * (5 - len(texts))]
    lines += ["".join(f"{x:10d}" for x in record) for record in integers]
    lines.append("".join(f"{x:13.5E}" for x in parameters))
    for node, row in zip(nodes, rows, strict=True):
        lines += [f"{node:10d}", "".join(f"{x:13.5E}" for x in row)]
    return "\n".join(lines) + "\n"


def _place(name: str, index: int) -> tuple[int, int]:
    matched = re.fullmatch(r"([0-9]+)([XYZ])", name)
    return (int(matched[1]), "XYZ".index(matched[2])) if matched else (index + 1, 0)
