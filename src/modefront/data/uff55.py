r"""Modes of a test from a universal file: dataset 55, with the geometry of datasets 15 and 2411.

Components are along the axes of the displacement system of their node. Dataset 2420 holds these
systems: three rows of axes and one of the origin; without it, all are those of the file.

Dataset 55 holds one shape at all nodes: of a normal mode (analysis type 2) with its frequency and
damping, or of a complex one (3 and 7) with its eigenvalue :math:`\lambda`,

.. math:: f = |\lambda| / 2 \pi, \quad \zeta = -\operatorname{Re} \lambda / |\lambda| .

A complex shape is turned in the plane until most of it is real, and its real part is taken. A
component that is 0 in all modes of a data set was not measured. Modes that come again with the same
number are those of a further data set; ``set NAME`` in the first line of a dataset says its name.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from modefront._typing import Complexes, Floats, Ints
from modefront.data.modal import ModalData
from modefront.data.uff import AXES, LARGEST, Block, blocks, decode
from modefront.errors import Fault, InputError
from modefront.inputs import read_text_bytes

SUFFIXES = (".uff", ".unv", ".uf")
"""Ends of names of universal files."""

GEOMETRY = (15, 2411)

SYSTEMS = 2420
"""Dataset of coordinate systems."""

CARTESIAN, CYLINDRICAL = 0, 1

WHAT = "a universal file with modes (dataset 55)"

NORMAL, COMPLEX = 2, (3, 7)

ALONG = 1e-6
"""Component of a unit vector, below which it is the rounding of the axes in a file."""

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

    def local(self, node: int, direction: Floats) -> Floats:
        """Return a direction (6,) of space along the axes of a node, by position."""
        out = np.concatenate([self.axes[node] @ half for half in (direction[:3], direction[3:])])
        return np.asarray(np.where(np.abs(out) > ALONG, out, 0.0))

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
            *(nothing[..., 0], nothing),
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
    file, content = str(path), read_text_bytes(path, WHAT, LARGEST)
    sections = blocks(content, file)
    shapes = [block for block in sections if block.number == 55]
    if not shapes:
        numbers = ", ".join(str(n) for n in dict.fromkeys(block.number for block in sections))
        raise InputError(Fault(file, "datasets", WHAT, f"datasets {numbers} only"))
    rows = [_mode(decode(content, block, file), block, file) for block in shapes]
    geometry = [decode(content, block, file) for block in sections if block.number in GEOMETRY]
    systems = [decode(content, block, file) for block in sections if block.number == SYSTEMS]
    return _assembled(file, rows, _positions(geometry), _axes(geometry, systems))


@dataclass(frozen=True, eq=False)
class _Mode:
    """One dataset 55: its data set (empty if not given), number, values, and place in the file."""

    set: str
    number: int
    frequency: float
    damping: float
    nodes: Ints
    shape: Floats
    place: str


def _mode(values: Mapping[str, Any], block: Block, file: str) -> _Mode:
    place = f"line {block.line}, dataset 55"
    kind = int(values["analysis_type"])
    if kind == NORMAL:
        frequency, damping = float(values["freq"]), float(values.get("modal_damp_vis") or 0)
    elif kind in COMPLEX:
        eigenvalue = complex(values["eig"])
        frequency = abs(eigenvalue) / (2 * np.pi)
        damping = -eigenvalue.real / abs(eigenvalue) if eigenvalue else 0.0
    else:
        expected = "normal modes (analysis type 2) or complex ones (3 or 7)"
        raise InputError(Fault(file, place, expected, f"type {kind}"))
    nodes = np.asarray(values["node_nums"], dtype=np.int64)
    parts = [np.asarray(values[f"r{i}"]) for i in range(1, 7) if f"r{i}" in values]
    shape = np.zeros((nodes.size, 6))
    shape[:, : len(parts)] = real_shape(np.stack(parts, axis=1).astype(complex))
    wrong = [
        (not frequency > 0, "a frequency above 0 Hz", f"{frequency:g}"),
        (not 0 <= damping < 1, "a damping ratio from 0 to below 1", f"{damping:g}"),
        (not np.isfinite(shape).all(), "finite components", "others"),
        (not shape.any(), "a mode shape that is not zero at all nodes", "only zeros"),
    ]
    faults = [Fault(file, place, expected, text) for is_wrong, expected, text in wrong if is_wrong]
    if faults:
        raise InputError(faults)
    lines = (str(values.get(f"id{i}", "")) for i in range(1, 6))
    named = [m for m in (re.match(r"\s*set (\S.*?)\s*$", line) for line in lines) if m]
    name = named[0][1] if named else ""
    number = int(values.get("mode_n") or 0)
    return _Mode(name, number, frequency, damping, nodes, shape, place)


def real_shape(phi: Complexes) -> Floats:
    """Return the real shape nearest to a complex one, up to its sign.

    >>> real_shape(np.array([[1j], [-2j]])).round(12).tolist()
    [[1.0], [-2.0]]
    """
    turn = np.exp(-0.5j * np.angle((phi**2).sum()))
    return np.asarray((phi * turn).real)


def _positions(geometry: Sequence[Mapping[str, Any]]) -> dict[int, Floats]:
    """Return the coordinates (3,) of nodes by their numbers."""
    out: dict[int, Floats] = {}
    for values in geometry:
        points = np.stack([np.asarray(values[axis], float) for axis in "xyz"], axis=1)
        out.update(zip(np.asarray(values["node_nums"]).astype(int).tolist(), points, strict=True))
    return out


def _axes(
    geometry: Sequence[Mapping[str, Any]], systems: Sequence[Mapping[str, Any]]
) -> dict[int, Floats]:
    """Return the axes (3, 3) of nodes with a displacement system; NaN where it is not known.

    Where no dataset 2420 says what the systems are, they are those of the file.
    """
    known = {
        int(label): (int(kind), np.asarray(matrix, float))
        for values in systems
        for label, kind, matrix in zip(
            *(values[key] for key in ("CS_sys_labels", "CS_types", "CS_matrices")), strict=True
        )
    }
    out: dict[int, Floats] = {}
    for values in geometry if known else ():
        for node, label in zip(values["node_nums"], values["disp_cs"], strict=True):
            if int(label) != 0:
                point = _positions([values])[int(node)]
                out[int(node)] = _axes_at(point, known.get(int(label)))
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
    file: str,
    rows: Sequence[_Mode],
    positions: Mapping[int, Floats],
    axes: Mapping[int, Floats],
) -> NodalModes:
    """Return all modes as arrays; modes of the same number are those of a further data set."""
    placed: dict[tuple[str, int], _Mode] = {}
    for position, row in enumerate(rows):
        number = row.number or position + 1
        names = [row.set] if row.set else [str(k) for k in range(1, len(rows) + 1)]
        free = [name for name in names if (name, number) not in placed]
        if not free:
            expected = "each mode of a data set once"
            raise InputError(Fault(file, row.place, expected, f"mode {number} of {row.set} again"))
        placed[free[0], number] = row
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
    places = np.array([positions.get(int(node), np.full(3, np.nan)) for node in nodes])
    of_nodes = np.array([axes.get(int(node), np.eye(3)) for node in nodes])
    return NodalModes(file, sets, modes, nodes, places, of_nodes, frequency, damping, shape)
