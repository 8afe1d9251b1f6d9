"""Universal files: functions or records of blows in dataset 58, modes of a test in dataset 55.

A dataset stands between two lines with -1; what it declares is compared with what it holds.
``docs/study-file.md`` says how modes are read. ``pair with mode NUMBER`` at the end of one of the
first lines of a dataset 55 says that both shapes are a basis of a plane.

Format: Structural Dynamics Research Laboratory, University of Cincinnati, *Universal File
Formats*, datasets 15, 18, 55, 58, 58b, 2411 and 2420.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from modefront._typing import Complexes, Floats, Ints
from modefront.data.impact import blows_of
from modefront.data.modal import ModalData
from modefront.data.responses import COHERENCE, FORCE, FRF, TIME, Channel
from modefront.errors import Fault, refuse, refusing
from modefront.inputs import MOST_DATA, counted, fortran, once, read_text_bytes, wrong
from modefront.outputs import write_text
from modefront.rounding import LARGEST

CLOSING = re.compile(rb"^[ ]{4}-1[ \t]*\r?$", re.MULTILINE)
BINARY_CLOSING = re.compile(rb"    -1[ \t]*\r?(?=[\s\0\x1a]*(\Z|^    -1[ \t]*\r?\n))", re.MULTILINE)
"""The end of a binary dataset, with the end of the file or the next dataset behind it. The number
of bytes in the header is wrong in files of some programs, `pyuff` among them."""

QUANTITIES = {8: "receptance", 11: "mobility", 12: "accelerance"}  # by that of the numerator
AXES = {1: "X", 2: "Y", 3: "Z", 4: "RX", 5: "RY", 6: "RZ"}  # directions by their numbers
SUFFIXES = (".uff", ".unv", ".uf", ".bunv", ".ufb")  # ends of names of universal files
REAL = {2: 1, 5: 2}  # numbers of a value by the type of data
NAMES = tuple(AXES.values())  # directions in the order of the components
KNOWN = (15, 18, 55, 58, 2411, 2420)  # datasets that are read; no other line may begin as theirs

OPENING = re.compile(
    rb"(?:\xef\xbb\xbf)?\s*^[ ]{4}-1[ \t]*\r?\n[ ]*([0-9]{1,5})(b?)(?!\S)([^\n]*)(?:\n|\Z)",
    re.MULTILINE,
)
HEADER, RECORD_7 = 11, 6  # lines of dataset 58 before its numbers; that with their number, from 0
Point = tuple[int, int, int, Floats]  # node, systems of coordinates and displacement, coordinates
System = tuple[int, Floats, Floats]  # of coordinates: type, axes (3, 3) in rows, and origin (3,)


@dataclass(frozen=True)
class Block:
    """One dataset of a universal file."""

    file: Path  # file, number, line: its file, its number, and the line where it begins
    number: int
    line: int
    body: bytes  # what it holds, behind its number
    binary: list[str] | None  # words behind the number of a binary dataset; None for one of text

    @property
    def place(self) -> str:
        """Place in the file, for messages."""
        return f"line {self.line}, dataset {self.number}"

    @property
    def lines(self) -> list[str]:
        """Lines of what it holds, without blank ones at its end."""
        return self.body.decode("utf-8", "replace").rstrip().splitlines()


def _decoded(
    path: Path, what: str, needed: int, readers: Mapping[int, Callable[[Block], Sequence[Any]]]
) -> dict[int, list[Any]]:
    """Return what readers return for datasets of their numbers; refuse broken ones, and none."""
    known = blocks(read_text_bytes(path, what, MOST_DATA), path)
    numbers = list(dict.fromkeys(block.number for block in known))
    if needed not in numbers:
        raise wrong(path, what, f"datasets {', '.join(map(str, numbers))} only", "datasets")
    out: dict[int, list[Any]] = {number: [] for number in readers}
    for block in (block for block in known if block.number in readers):
        kinds = ValueError, LookupError, OverflowError
        with refusing(path, f"a dataset {block.number}", *kinds, place=block.place):
            out[block.number] += readers[block.number](block)
    return out


def read_functions(path: Path) -> list[Channel]:
    """Return all datasets 58 of a universal file; raises InputError where it has none."""
    what = "a universal file with frequency response functions or records of blows (dataset 58)"
    return _decoded(path, what, 58, {58: _function})[58]


def read_uff(path: Path) -> list[Channel]:
    """Return the functions of a universal file with their coherence, or else the records of blows.

    Raises InputError where the file holds neither, is cut off or cannot be decoded.
    """
    functions = read_functions(path)
    kinds = {x.kind for x in functions}
    if FRF in kinds:
        measured, others = ([x for x in functions if x.kind == kind] for kind in (FRF, COHERENCE))
        coherence = {(x.reference, x.response): np.abs(x.H) for x in others}
        pairs = ((x, coherence.get((x.reference, x.response))) for x in measured)
        return [replace(x, H=np.asarray(x.H, complex), coherence=known) for x, known in pairs]
    if blows := blows_of(x for x in functions if x.kind == TIME):
        return [replace(x, H=np.asarray(x.H, float)) for blow in blows for x in blow.values()]
    expected = (
        "frequency response functions (type 4), or records in time (type 1) of the excitation "
        "force and of responses, among the functions of dataset 58"
    )
    found = f"functions of type {', '.join(map(str, sorted(kinds)))} only"
    found += ", none of them a force and its responses" * (TIME in kinds)
    raise wrong(path, expected, found, "dataset 58")


def blocks(content: bytes, file: Path) -> list[Block]:
    """Return the datasets of a universal file; raises InputError for other files and torn ones."""
    out: list[Block] = []
    after, line, seen = 0, 1, 0
    while opening := OPENING.match(content, after):
        line += content.count(b"\n", seen, opening.start(1)) - 1
        seen = content.rfind(b"\n", 0, opening.start(1))
        number, binary = int(opening[1]), bool(opening[2])
        if number not in KNOWN and opening.end(1) - seen != 7:
            expected = "the number of a dataset, which ends in column 6"
            found = repr(opening[0].splitlines()[-1].decode("latin-1"))
            raise wrong(file, expected, found, f"line {line + 1}")
        closing = (BINARY_CLOSING if binary else CLOSING).search(content, opening.end())
        if not closing:
            expected = f"the end of dataset {number}, a line with -1"
            raise wrong(file, expected, "the end of the file", f"line {line}")
        words = opening[3].decode("latin-1").split()
        body = content[opening.end() : closing.start()]
        out.append(Block(file, number, line, body, words if binary else None))
        after = closing.end()
    if not out:
        expected = "datasets between lines with -1 in columns 5 and 6"
        raise wrong(file, expected, "none: this is no universal file")
    if rest := content[after:].strip(b" \t\r\n\0\x1a"):
        line = content.count(b"\n", 0, content.find(rest, after)) + 1
        expected = "a dataset: a line with -1 in columns 5 and 6, then one with its number"
        found = rest[:40].partition(b"\n")[0].decode("latin-1").strip()
        raise wrong(file, expected, repr(found), f"line {line}")
    return out


def reals(text: str) -> list[float]:
    """Return numbers as Fortran writes them; raises ValueError for anything else.

    >>> reals(" 1.5D+00-2.50000E+00 1.00000-100")
    [1.5, -2.5, 1e-100]
    """
    # A number may follow on another one without a blank.
    return [fortran(word) for word in re.sub(r"(?<=[0-9.])(?=[+-][0-9]*\.)", " ", text).split()]


def _function(block: Block) -> list[Channel]:
    """Return what a dataset 58 holds; values have the signs of the directions.

    Functions have that of both, others that of the response.
    """
    *lines, body = block.body.split(b"\n", HEADER)
    head = [line.decode("utf-8", "replace") for line in lines]
    columns = (0, 5, 15, 20, 30, 41, 51, 55, 66, 76, 80)
    six = [head[5][a:b].strip() for a, b in pairwise(columns)]
    form, count, even = (int(head[RECORD_7][k : k + 10]) for k in (0, 10, 20))
    first, step = (reals(head[RECORD_7][k : k + 13])[0] for k in (30, 43))
    if even not in (0, 1) or count < 1:
        raise ValueError(f"{count} values, with abscissae of the kind {even}")
    x, data = _values(block, body, (form, count, even))
    x = np.asarray(first + np.arange(count) * step) if even else x
    kind, ordinate = int(six[0]), int(head[8][:10])
    (response, sign), (reference, other) = (_dof(six[k], six[k + 1]) for k in (5, 8))
    sign *= other if kind == FRF else 1
    place = f"{block.place}{f' of {reference} to {response}' * (kind == FRF)}"
    quantity = QUANTITIES.get(ordinate, "")
    if kind == TIME and ordinate in (9, 13):  # reaction and excitation forces
        quantity, reference = FORCE, response
    named = str(block.file), place, reference, response
    return [Channel(*named, x, data if sign > 0 else -data, quantity, kind)]


def _values(block: Block, body: bytes, record: tuple[int, int, int]) -> tuple[Floats, Any]:
    """Return abscissae, none where these are even, and values, of the form, number and spacing."""
    form, count, even = record
    is_complex = form in (5, 6)
    if block.binary is not None:
        order = "<" if block.binary[:1] == ["1"] else ">"
        y = order + {2: "f4", 4: "f8", 5: "c8", 6: "c16"}[form]
        x = order + ("f4" if form in (2, 5) else "f8")
        kinds = [np.dtype([("x", each), ("y", y)][even:]) for each in (x, order + "f4")]
        # There may be the end of a line behind the values.
        lengths = [len(body) - len(end) for end in (b"", b"\n", b"\r\n") if body.endswith(end)]
        kind = next((each for each in kinds if count * each.itemsize in lengths), kinds[0])
        if (length := count * kind.itemsize) not in lengths:
            counted(block.file, block.place, "bytes of values", length, len(body))
        table = np.frombuffer(body, kind, count)
        of_x = np.zeros(0) if even else table["x"].astype(float)
        return of_x, table["y"].astype(complex if is_complex else float)
    if other := body.translate(None, b"0123456789+-.eEdDnNaAiIfFtTyY \t\r\n"):
        raise ValueError(f"the byte {other[:1]!r} among the values")
    try:
        numbers = np.array(body.split(), dtype=float)
    except ValueError:
        numbers = np.array(reals(body.decode("ascii")))
    columns = (1 - even) + (2 if is_complex else 1)
    counted(block.file, block.place, "values", count, numbers.size / columns)
    points = [line.count(b".") for line in body.rstrip().split(b"\n")]
    if sum(points) == numbers.size and max(points[1:], default=0) > min(points[:-1], default=0):
        raise ValueError("a line with fewer values than one behind it")
    rows = numbers.reshape(-1, columns).T
    pairs = np.ascontiguousarray(rows[1 - even :].T)
    return rows[0], (pairs.view(complex) if is_complex else pairs)[:, 0]


def _dof(node: str, direction: str) -> tuple[str, int]:
    """Return the name of a degree of freedom, such as ``1Z``, and the sign of its direction."""
    if bool(node) != bool(direction):
        raise ValueError(f"a node {node!r} with the direction {direction!r}")
    number = int(direction or 0)
    return f"{int(node or 0)}{AXES.get(abs(number), '')}", -1 if number < 0 else 1


def write_uff55(
    path: Path,
    sets: Sequence[str],
    modes: Sequence[Mapping[int, tuple[complex, Complexes]]],
    sensors: Sequence[str],
    pairs: Sequence[tuple[int, int]] = (),
) -> None:
    """Write modes as complex eigenvectors of first order, dataset 55 (analysis type 3).

    ``modes`` holds, for every data set, poles in rad/s and complex shapes at the sensors by the
    numbers of the modes; sensors that are named by node and direction keep both, others have the
    first numbers that are left, in X. ``pairs`` holds numbers of modes of one pole.
    """
    matches = [re.fullmatch(r"([0-9]+)([XYZ])", name) for name in sensors]
    taken = {int(match[1]) for match in matches if match}
    left = (number for number in range(1, 2 * len(sensors) + 1) if number not in taken)
    numbers = [int(match[1]) if match else next(left) for match in matches]
    axes = ["XYZ".index(match[2]) if match else 0 for match in matches]
    nodes = list(dict.fromkeys(numbers))
    rows = [nodes.index(number) for number in numbers]
    written, other = [], {a: b for pair in pairs for a, b in (pair, pair[::-1])}
    for name, listed in zip(sets, modes, strict=True):
        for number, (pole, phi) in listed.items():
            values = np.zeros((len(nodes), 3), complex)
            values[rows, axes] = phi
            frequency = f"mode {number}, {abs(pole) / (2 * np.pi):.9g} Hz"
            if (partner := other.get(number)) in listed:
                frequency += f", pair with mode {partner}"
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


@dataclass(frozen=True, eq=False)
class NodalModes:
    """Modes at the nodes of a test."""

    data: ModalData  # what they have without sensors
    nodes: Ints  # (nodes,) their numbers
    position: Floats  # (nodes, 3) coordinates; NaN where the file has none
    axes: Floats  # (nodes, 3, 3) axes of the components, in rows; NaN where they are not told
    shape: Floats  # (sets, modes, nodes, 6) along X, Y, Z, RX, RY and RZ; NaN if not measured

    def local(self, node: int, direction: Floats) -> Floats:
        """Return a direction (6,) of space along the axes of a node, by position."""
        out = (direction.reshape(2, 3) @ self.axes[node].T).ravel()
        return np.where(np.abs(out) > 1e-6, out, 0.0)  # less is rounding in the file

    def in_space(self, node: int, direction: Floats) -> Floats:
        """Return a direction (6,) along the axes of a node, by position, in space."""
        return (direction.reshape(2, 3) @ self.axes[node]).ravel()

    @property
    def measured(self) -> tuple[str, ...]:
        """Names of the measured degrees of freedom, such as ``12Z``."""
        observed = np.argwhere(np.isfinite(self.shape).any(axis=(0, 1))).tolist()
        return tuple(f"{self.nodes[k]}{NAMES[axis]}" for k, axis in observed)

    def along(self, node: int, direction: Floats) -> Floats:
        """Return components (sets, modes) of a node along a vector (6,), NaN if not measured."""
        used = np.flatnonzero(direction)
        return np.asarray(self.shape[:, :, node, used] @ direction[used])

    def at(self, sensors: Mapping[str, tuple[int, Floats]]) -> ModalData:
        """Return the modal data of sensors, each a position among the nodes and a vector (6,).

        Of a mode that does not move them, there is no shape.
        """
        shape = np.stack([self.along(*place) for place in sensors.values()], axis=-1)
        shape[~np.nan_to_num(shape).any(axis=2)] = np.nan
        std = np.full(shape.shape, np.nan)
        return replace(self.data, sensors=tuple(sensors), shape=shape, shape_std=std)

    def place(self, name: str) -> tuple[int, Floats] | None:
        """Return the node, by position, and direction (6,) of a name, ``-3X``; None for others."""
        matched = re.fullmatch(r"([+-]?)([0-9]{1,9}) ?([+-]?)(R?[XYZ])", name.upper())
        if not matched or int(matched[2]) not in self.nodes:
            return None
        sign = -1.0 if (matched[1] == "-") != (matched[3] == "-") else 1.0
        direction = sign * (np.array(NAMES) == matched[4])
        return int(np.flatnonzero(self.nodes == int(matched[2]))[0]), direction


def is_universal(file: Path | str) -> bool:
    """Return whether a file is taken for a universal file, by its ending or its first line."""
    path = Path(file)
    if path.suffix.lower() in SUFFIXES:
        return True
    with suppress(OSError, ValueError):
        if path.is_file():
            with path.open("rb") as stream:
                return stream.read(64).lstrip(b"\r\n").startswith(b"    -1")
    return False


def read_uff55(path: Path) -> NodalModes:
    """Return the modes of a universal file; raises InputError where it holds none or is broken."""
    what = "a universal file with modes (dataset 55)"
    of_systems = dict.fromkeys((18, 2420), _systems)
    found = _decoded(path, what, 55, {15: _nodes, 2411: _nodes, **of_systems, 55: _mode})
    points: list[Point] = found[15] + found[2411]
    once(path, "nodes", "each node", (node for node, *_ in points))
    return _assembled(path, found[55], points, dict(found[18] + found[2420]))


def _integers(line: str, count: int) -> list[int]:
    """Return the whole numbers of a line; raises ValueError where it has others, or not so many."""
    numbers = [int(word) for word in line.split()]
    if len(numbers) != count:
        raise ValueError(f"{len(numbers)} numbers in {line.strip()!r} instead of {count}")
    return numbers


class _Mode(NamedTuple):
    """One dataset 55."""

    set: str  # data set, empty if not given
    number: int
    frequency: float
    damping: float
    nodes: Ints
    shape: Floats
    place: str  # in the file
    other: int  # number of the other mode of a pair, 0 for none


def _mode(block: Block) -> list[_Mode]:
    """Return the mode of a dataset 55, whose values are as many a node as its header says."""
    file, place, lines = block.file, block.place, block.lines
    _, kind, _, _, data, size = _integers(lines[5], 6)
    integers, real, _, number = (int(word) for word in lines[6].split()[:4])
    counted(file, place, "whole numbers in record 7", integers, len(lines[6].split()) - 2)
    parameters = reals(lines[7])
    counted(file, place, "numbers in record 8", real, len(parameters))
    if kind == 2:  # a normal mode
        frequency, damping = parameters[0], sum(parameters[2:3])
    elif kind in (3, 7):
        eigenvalue = complex(*parameters[:2])
        frequency = abs(eigenvalue) / (2 * np.pi)
        damping = -eigenvalue.real / abs(eigenvalue) if eigenvalue else 0.0
    else:
        expected = "normal modes (analysis type 2) or complex ones (3 or 7)"
        raise wrong(file, expected, f"type {kind}", place)
    if size not in (3, 6) or data not in REAL:
        expected = "3 or 6 values a node, of the type 2 (real) or 5 (complex)"
        raise wrong(file, expected, f"{size} values of the type {data}", place)
    nodes, values = list[int](), list[list[float]]()
    count = size * REAL[data]
    step = 1 + -(-count // 6)
    for k in range(8, len(lines), step):  # behind the head
        nodes += _integers(lines[k], 1)
        values.append(reals(" ".join(lines[k + 1 : k + step])))
        of_node = f"line {block.line + 2 + k}, dataset 55, node {nodes[-1]}"
        counted(file, of_node, "numbers", count, len(values[-1]))
    once(file, place, "each node", nodes)
    phi = np.array(values).reshape(-1, size, REAL[data]).astype(complex)
    shape = np.zeros((len(nodes), 6))
    with np.errstate(all="ignore"):  # numbers that are too great are refused below
        psi = phi @ [1, 1j][: REAL[data]]
        turned = psi * np.exp(-0.5j * np.angle((psi**2).sum()))  # the nearest real one
        shape[:, :size] = turned.real
    checks = [
        (not frequency > 0, "a frequency above 0 Hz", f"{frequency:g}"),
        (not 0 <= damping < 1, "a damping ratio from 0 to below 1", f"{damping:g}"),
        (not (np.abs(shape) <= LARGEST).all(), f"components up to {LARGEST:g}", "others"),
        (not shape.any(), "a mode shape that is not zero at all nodes", "only zeros"),
    ]
    refuse(Fault(str(file), place, *said) for is_wrong, *said in checks if is_wrong)
    text = "\n".join(lines[:5])
    name = re.search(r"^\s*set (\S.*?)\s*$", text, re.MULTILINE)
    other = re.search(r"pair with mode (\d{1,9})\s*$", text, re.MULTILINE)
    known = name[1] if name else "", number, frequency, damping
    return [_Mode(*known, np.array(nodes), shape, place, int(other[1]) if other else 0)]


def _nodes(block: Block) -> list[Point]:
    lines, step, out = block.lines, 1 if block.number == 15 else 2, list[Point]()
    if not lines or len(lines) % step:
        raise ValueError(f"{len(lines)} lines of nodes, {step} each")
    for k in range(0, len(lines), step):
        words = lines[k].split()
        node, of_point, system, _ = _integers(" ".join(words[:4]), 4)
        point = reals(" ".join([*words[4:], *lines[k + 1 : k + step]]))
        counted(block.file, f"{block.place}, node {node}", "coordinates", 3, len(point))
        out.append((node, of_point if block.number == 15 else 0, system, np.array(point)))
    return out


def _systems(block: Block) -> list[tuple[int, System]]:
    """Return the systems of a dataset 18, by three points, or 2420, by axes and origin."""
    by_points, lines, out = block.number == 18, block.lines, list[tuple[int, System]]()
    head, each = (0, 4) if by_points else (2, 6)
    if (len(lines) - head) % each:
        raise ValueError(f"{len(lines)} lines: {head}, and {each} a system")
    for k in range(head, len(lines), each):
        label, kind, reference, *_ = _integers(lines[k], 5 if by_points else 3)
        rows = np.reshape(reals(" ".join(lines[k + 2 : k + each])), (3 if by_points else 4, 3))
        if by_points:  # the origin, one on +x and one in the plane of +x and +z
            origin, x, z = rows[0], rows[1] - rows[0], rows[2] - rows[0]
            rows = np.array([x, np.cross(z, x), np.cross(x, np.cross(z, x)), origin])
            kind = kind if reference == 0 else -1  # in another system, which is not followed
        axes = rows[:3] / np.linalg.norm(rows[:3], axis=1, keepdims=True)
        out.append((label, (kind, axes, rows[3])))
    once(block.file, block.place, "each system", (label for label, _ in out))
    return out


def _axes_at(point: Floats, system: System | None) -> Floats:
    """Return the axes (3, 3) of a coordinate system at a point; NaN where they are not known."""
    if system is None or system[0] not in (0, 1):  # Cartesian and cylindrical ones
        return np.full((3, 3), np.nan)
    kind, axes, origin = system
    if kind == 0:
        return axes
    x, y, _ = axes @ (point - origin)
    radius = float(np.hypot(x, y))
    c, s = (x / radius, y / radius) if radius != 0 else (1.0, 0.0)
    return np.asarray(np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) @ axes)


def _assembled(
    file: Path, rows: Sequence[_Mode], points: Sequence[Point], systems: Mapping[int, System]
) -> NodalModes:
    """Return all modes as arrays; modes of the same number are those of a further data set."""
    placed, nodes_of = dict[tuple[str, int], _Mode](), dict[str, Ints]()
    for position, row in enumerate(rows):
        number = row.number or position + 1
        names = [row.set] if row.set else [str(k) for k in range(1, len(rows) + 1)]
        free = [name for name in names if (name, number) not in placed]
        if not free:
            expected = "each mode of a data set once"
            raise wrong(file, expected, f"mode {number} of {row.set} again", row.place)
        its = (x for x in free if x in nodes_of and not np.setxor1d(nodes_of[x], row.nodes).size)
        placed[name := next(its, free[0]), number] = row
        _check_nodes(file, row, nodes_of.setdefault(name, row.nodes))
    sets = tuple(nodes_of)
    modes = tuple(sorted({number for _, number in placed}))
    nodes = np.unique(np.concatenate([row.nodes for row in rows]))
    frequency, damping = np.full((2, len(sets), len(modes)), np.nan)
    shape = np.full((*frequency.shape, nodes.size, 6), np.nan)
    for (name, number), row in placed.items():
        k, r = sets.index(name), modes.index(number)
        frequency[k, r], damping[k, r] = row.frequency, row.damping or np.nan
        shape[k, r, np.searchsorted(nodes, row.nodes)] = row.shape
    for values in shape:
        values[:, ~(np.nan_to_num(values) != 0).any(axis=0)] = np.nan
    places, axes = np.full((nodes.size, 3), np.nan), np.tile(np.eye(3), (nodes.size, 1, 1))
    known, row_of = [node for node, *_ in points], {n: k for k, n in enumerate(nodes.tolist())}
    for node, of_point, label, given in (each for each in points if each[0] in row_of):
        kind, R, origin = systems.get(of_point, (0, np.eye(3), np.zeros(3)))
        point = places[row_of[node]] = given @ R + origin if kind == 0 else np.nan * given
        if systems and label != 0:  # else, where no dataset 2420 says more, those of the file
            axes[row_of[node]] = _axes_at(point, systems.get(label))
    for row in rows if known else ():
        _check_nodes(file, row, np.intersect1d(row.nodes, known))
    pairs = {(number, row.other) for (_, number), row in placed.items() if number < row.other}
    pairs = {pair for pair in pairs if pair[1] in modes}
    none, of_none = np.full(frequency.shape, np.nan), np.zeros((*frequency.shape, 0))
    known_of = sets, modes, (), frequency, damping, of_none, none, of_none, tuple(sorted(pairs))
    return NodalModes(ModalData(*known_of), nodes, places, axes, shape)


def _check_nodes(file: Path, row: _Mode, nodes: Ints) -> None:
    if (odd := np.setxor1d(row.nodes, nodes)).size:
        expected = "the same nodes in the geometry and in all modes of a data set"
        raise wrong(file, expected, f"node {odd[0]} in one of them, and not in another", row.place)
