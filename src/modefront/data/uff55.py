r"""Modes of a test from a universal file: dataset 55, with the geometry of datasets 15 and 2411.

Components are along the axes of the displacement system of their node. Dataset 2420 holds these
systems: three rows of axes and one of the origin; without it, all are those of the file.

Dataset 55 holds one shape at all nodes: of a normal mode (analysis type 2) with its frequency and
damping, or of a complex one (3 and 7) with its eigenvalue :math:`\lambda`,

.. math:: f = |\lambda| / 2 \pi, \quad \zeta = -\operatorname{Re} \lambda / |\lambda| .

A complex shape is turned in the plane until most of it is real, and its real part is taken. A
component that is 0 in all modes of a data set was not measured. Modes that come again with the same
number are those of a further data set; ``set NAME`` in the first line of a dataset says its name,
and ``pair with mode NUMBER`` at the end of one that both shapes are a basis of a plane.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from modefront._typing import Complexes, Floats, Ints
from modefront.data.modal import ModalData
from modefront.data.uff import AXES, Block, datasets, each, reals
from modefront.errors import Fault, refuse
from modefront.inputs import counted, once, wrong
from modefront.rounding import LARGEST

SUFFIXES = (".uff", ".unv", ".uf")
"""Ends of names of universal files."""

CARTESIAN, CYLINDRICAL = 0, 1
"""Types of coordinate systems."""

WHAT = "a universal file with modes (dataset 55)"

REAL, COMPONENTS = {2: 1, 5: 2}, (3, 6)
"""Numbers of a value by the type of data, and values a node: three translations, or all six."""

HEAD = 8
"""Lines of dataset 55 before those of its nodes."""

NAMES = tuple(AXES.values())
"""Directions in the order of the components."""


@dataclass(frozen=True, eq=False)
class NodalModes:
    """Modes at the nodes of a test.

    Attributes
    ----------
    file : where they were read
    sets, modes : names of the data sets, numbers of the modes
    nodes : (nodes,) their numbers
    position : (nodes, 3) coordinates; NaN where the file has none
    axes : (nodes, 3, 3) axes of the components, in rows; NaN where the file does not tell them
    frequency, damping : (sets, modes) in Hz, and ratios; NaN where none
    shape : (sets, modes, nodes, 6) components along X, Y, Z, RX, RY and RZ; NaN if not measured
    pairs : numbers of modes of one frequency
    """

    file: str
    sets: tuple[str, ...]
    modes: tuple[int, ...]
    nodes: Ints
    position: Floats
    axes: Floats
    frequency: Floats
    damping: Floats
    shape: Floats
    pairs: tuple[tuple[int, int], ...] = ()

    def local(self, node: int, direction: Floats) -> Floats:
        """Return a direction (6,) of space along the axes of a node, by position."""
        out = np.concatenate([self.axes[node] @ half for half in (direction[:3], direction[3:])])
        return np.asarray(np.where(np.abs(out) > 1e-6, out, 0.0))  # less is rounding in the file

    def in_space(self, node: int, direction: Floats) -> Floats:
        """Return a direction (6,) along the axes of a node, by position, in space."""
        halves = (direction[:3], direction[3:])
        return np.concatenate([half @ self.axes[node] for half in halves])

    @property
    def measured(self) -> tuple[str, ...]:
        """Names of the measured degrees of freedom, such as ``12Z``."""
        observed = np.asarray(np.isfinite(self.shape).any(axis=(0, 1)))
        return tuple(
            f"{node}{NAMES[axis]}"
            for node, row in zip(self.nodes.tolist(), observed, strict=True)
            for axis in np.flatnonzero(row).tolist()
        )

    def along(self, node: int, direction: Floats) -> Floats:
        """Return the components (sets, modes) of a node, by position, along a vector (6,).

        NaN where a component along it was not measured.
        """
        used = np.flatnonzero(direction)
        return np.asarray(self.shape[:, :, node, used] @ direction[used])

    def at(self, sensors: Mapping[str, tuple[int, Floats]]) -> ModalData:
        """Return the modal data of sensors, each a position among the nodes and a vector (6,)."""
        columns = [self.along(node, direction) for node, direction in sensors.values()]
        shape = np.stack(columns, axis=-1)
        nothing = np.full(shape.shape, np.nan)
        return ModalData(
            *(self.sets, self.modes, tuple(sensors), self.frequency, self.damping, shape),
            *(nothing[..., 0], nothing, self.pairs),
        )

    def place(self, name: str) -> tuple[int, Floats] | None:
        """Return the node, by position, and the direction (6,) of a name such as ``-3X``.

        None for other names and nodes that there are not.
        """
        matched = re.fullmatch(r"([+-]?)([0-9]{1,9}) ?([+-]?)(R?[XYZ])", name.upper())
        if not matched:
            return None
        positions = np.flatnonzero(self.nodes == int(matched[2]))
        if not positions.size:
            return None
        direction = np.zeros(6)
        sign = -1.0 if (matched[1] == "-") != (matched[3] == "-") else 1.0
        direction[NAMES.index(matched[4])] = sign
        return int(positions[0]), direction


def is_universal(name: str) -> bool:
    """Return whether a file is a universal file by its name."""
    return name.lower().endswith(SUFFIXES)


def read_uff55(path: Path) -> NodalModes:
    """Return the modes of a universal file.

    Raises InputError where the file holds none, is cut off or cannot be decoded.
    """
    known = datasets(path, WHAT, 55)
    points = [point for part in each(known, _nodes, 15, 2411) for point in part]
    once(path, "nodes", "each node", (node for node, _, _ in points))
    systems = dict(pair for part in each(known, _systems, 2420) for pair in part)
    return _assembled(path, each(known, _mode, 55), points, systems)


def _lines(block: Block) -> list[str]:
    """Return the lines of a dataset, without blank ones at its end."""
    return block.body.decode("utf-8", "replace").rstrip().splitlines()


def _integers(line: str, count: int) -> list[int]:
    """Return the whole numbers of a line; raises ValueError where it has others, or not so many."""
    numbers = [int(word) for word in line.split()]
    if len(numbers) != count:
        raise ValueError(f"{len(numbers)} numbers in {line.strip()!r} instead of {count}")
    return numbers


@dataclass(frozen=True, eq=False)
class _Mode:
    """One dataset 55: its data set (empty if not given), number, values, and place in the file.

    ``other`` is the number of the other mode of a pair, 0 for none.
    """

    set: str
    number: int
    frequency: float
    damping: float
    nodes: Ints
    shape: Floats
    place: str
    other: int


def _mode(block: Block) -> _Mode:
    """Return the mode of a dataset 55, whose values are as many a node as its header says."""
    file, place, lines = block.file, block.place, _lines(block)
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
    if size not in COMPONENTS or data not in REAL:
        expected = "3 or 6 values a node, of the type 2 (real) or 5 (complex)"
        raise wrong(file, expected, f"{size} values of the type {data}", place)
    nodes, parts = _values(block, lines[HEAD:], size * REAL[data])
    phi = parts[:, 0::2] + 1j * parts[:, 1::2] if REAL[data] == 2 else parts.astype(complex)
    shape = np.zeros((nodes.size, 6))
    shape[:, :size] = real_shape(phi)
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
    return _Mode(*known, nodes, shape, place, int(other[1]) if other else 0)


def _values(block: Block, lines: list[str], size: int) -> tuple[Ints, Floats]:
    nodes: list[int] = []
    values: list[list[float]] = []
    step = 1 + -(-size // 6)
    for k in range(0, len(lines), step):
        nodes += _integers(lines[k], 1)
        values.append(reals(" ".join(lines[k + 1 : k + step])))
        place = f"line {block.line + 2 + HEAD + k}, dataset 55, node {nodes[-1]}"
        counted(block.file, place, "numbers", size, len(values[-1]))
    once(block.file, block.place, "each node", nodes)
    return np.array(nodes, dtype=np.int64), np.array(values).reshape(-1, size)


def real_shape(phi: Complexes) -> Floats:
    """Return the real shape nearest to a complex one, up to its sign.

    >>> real_shape(np.array([[1j], [-2j]])).round(12).tolist()
    [[1.0], [-2.0]]
    """
    turn = np.exp(-0.5j * np.angle((phi**2).sum()))
    return np.asarray((phi * turn).real)


Point = tuple[int, int, Floats]
"""A node: its number, its displacement system, and its coordinates (3,)."""


def _nodes(block: Block) -> list[Point]:
    """Return the nodes of a dataset 15, a line each, or 2411, two lines each."""
    lines = _lines(block)
    step = 1 if block.number == 15 else 2
    if not lines or len(lines) % step:
        raise ValueError(f"{len(lines)} lines of nodes, {step} each")
    out = []
    for k in range(0, len(lines), step):
        words = lines[k].split()
        node, _, system, _ = _integers(" ".join(words[:4]), 4)
        point = reals(" ".join([*words[4:], *lines[k + 1 : k + step]]))
        counted(block.file, f"{block.place}, node {node}", "coordinates", 3, len(point))
        out.append((node, system, np.array(point)))
    return out


def _systems(block: Block) -> list[tuple[int, tuple[int, Floats]]]:
    """Return the systems of a dataset 2420, six lines each behind two: number, type and axes."""
    lines = _lines(block)
    if len(lines) % 6 != 2:
        raise ValueError(f"{len(lines)} lines: two, and six a system")
    out = []
    for k in range(2, len(lines), 6):
        label, kind, _ = _integers(lines[k], 3)
        rows = [reals(line) for line in lines[k + 2 : k + 6]]
        out.append((label, (kind, np.array(rows).reshape(4, 3))))
    once(block.file, block.place, "each system", (label for label, _ in out))
    return out


def _axes_at(point: Floats, system: tuple[int, Floats] | None) -> Floats:
    """Return the axes (3, 3) of a coordinate system at a point; NaN where they are not known."""
    if system is None or system[0] not in (CARTESIAN, CYLINDRICAL):
        return np.full((3, 3), np.nan)
    kind, matrix = system
    axes, origin = matrix[:3], matrix[3]
    axes = axes / np.linalg.norm(axes, axis=1, keepdims=True)
    if kind == CARTESIAN:
        return np.asarray(axes)
    x, y, _ = axes @ (point - origin)
    radius = float(np.hypot(x, y))
    c, s = (x / radius, y / radius) if radius > 0 else (1.0, 0.0)
    return np.asarray(np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) @ axes)


def _assembled(
    file: Path,
    rows: Sequence[_Mode],
    points: Sequence[Point],
    systems: Mapping[int, tuple[int, Floats]],
) -> NodalModes:
    """Return all modes as arrays; modes of the same number are those of a further data set."""
    placed: dict[tuple[str, int], _Mode] = {}
    for position, row in enumerate(rows):
        number = row.number or position + 1
        names = [row.set] if row.set else [str(k) for k in range(1, len(rows) + 1)]
        free = [name for name in names if (name, number) not in placed]
        if not free:
            expected = "each mode of a data set once"
            raise wrong(file, expected, f"mode {number} of {row.set} again", row.place)
        placed[free[0], number] = row
        _check_nodes(file, row, next(x for (name, _), x in placed.items() if name == free[0]).nodes)
    sets = tuple(dict.fromkeys(name for name, _ in placed))
    modes = tuple(sorted({number for _, number in placed}))
    nodes = np.unique(np.concatenate([row.nodes for row in rows]))
    frequency = np.full((len(sets), len(modes)), np.nan)
    damping = frequency.copy()
    shape = np.full((*frequency.shape, nodes.size, 6), np.nan)
    for (name, number), row in placed.items():
        k, r = sets.index(name), modes.index(number)
        frequency[k, r] = row.frequency
        damping[k, r] = row.damping if row.damping > 0 else np.nan
        shape[k, r, np.searchsorted(nodes, row.nodes)] = row.shape
    for values in shape:
        values[:, ~(np.nan_to_num(values) != 0).any(axis=0)] = np.nan
    positions = {node: point for node, _, point in points}
    axes = {  # without a dataset 2420 that says what the systems are, they are those of the file
        node: _axes_at(point, systems.get(label))
        for node, label, point in points
        if systems and label != 0
    }
    if positions:
        for row in rows:
            _check_nodes(file, row, np.intersect1d(row.nodes, list(positions)))
    places = np.array([positions.get(int(node), np.full(3, np.nan)) for node in nodes])
    of_nodes = np.array([axes.get(int(node), np.eye(3)) for node in nodes])
    pairs = {(number, row.other) for (_, number), row in placed.items() if number < row.other}
    return NodalModes(
        *(str(file), sets, modes, nodes, places, of_nodes, frequency, damping, shape),
        tuple(sorted(pair for pair in pairs if pair[1] in modes)),
    )


def _check_nodes(file: Path, row: _Mode, nodes: Ints) -> None:
    """Raise InputError where a mode has other nodes than these, those of the file or its set."""
    odd = np.setxor1d(row.nodes, nodes)
    if odd.size:
        expected = "the same nodes in the geometry and in all modes of a data set"
        found = f"node {odd[0]} in one of them, and not in another"
        raise wrong(file, expected, found, row.place)
