"""Universal files: nodes (dataset 2411), elements (2412) and modes at all nodes (55).

Written as text by the published description of the formats; no package is needed.

Format: Structural Dynamics Research Laboratory, University of Cincinnati, *Universal File
Formats*, datasets 55, 2411 and 2412.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from modefront._typing import Floats, Ints
from modefront.models.dofs import DofTable, motion_of_nodes
from modefront.outputs import output
from modefront.programs.mesh import ProgramMesh


@dataclass(frozen=True, eq=False)
class NodeMotion:
    """Nodes and their motion in several modes.

    Attributes
    ----------
    number : (nodes,) numbers of the nodes
    values : (modes, nodes, 6) displacements x, y, z and rotations; 0 where a node cannot move
    turns : whether any node has rotations
    """

    number: Ints
    values: Floats
    turns: bool


def node_motion(dofs: DofTable, mesh: ProgramMesh | None, shapes: Floats) -> NodeMotion:
    """Return the motion of all nodes of a mesh (those of ``dofs`` without one) in shapes (N, m)."""
    number = np.unique(dofs.node[dofs.node > 0]) if mesh is None else mesh.number
    values = np.asarray(motion_of_nodes(dofs, number) @ shapes).T.reshape(-1, number.size, 6)
    turns = (dofs.direction > 3) & np.isin(dofs.node, number)
    return NodeMotion(number, values, bool(turns.any()))


ELEMENTS = {"line": 11, "triangle": 91, "quad": 94, "tetra": 111, "wedge": 112, "hexahedron": 115}
"""Identifiers of dataset 2412: rod, thin shells, solids; others are left out."""


def write_uff(
    path: Path, mesh: ProgramMesh | None, motion: NodeMotion, frequencies: Floats
) -> None:
    """Write nodes, elements and real, mass-normalised modes in Hz."""
    datasets = [] if mesh is None else [(2411, _nodes(mesh)), (2412, _elements(mesh))]
    datasets += [(55, _mode(motion, k, f)) for k, f in enumerate(frequencies.tolist())]
    with output(path) as stream:
        for number, lines in datasets:
            stream.writelines(line.encode() for line in _dataset(number, lines))


def _dataset(number: int, lines: Iterable[str]) -> Iterator[str]:
    yield f"    -1\n{number:6d}\n"
    yield from lines
    yield "    -1\n"


def _nodes(mesh: ProgramMesh) -> Iterator[str]:
    for number, point in zip(mesh.number.tolist(), mesh.coordinates, strict=True):
        numbers = "".join(f"{x:25.16E}" for x in np.nan_to_num(point).tolist())
        yield f"{number:10d}{1:10d}{1:10d}{11:10d}\n{numbers}\n"


def _elements(mesh: ProgramMesh) -> Iterator[str]:
    number = 0
    for kind, table in mesh.cells.items():
        if kind not in ELEMENTS:
            continue
        for nodes in table.tolist():
            number += 1
            yield "".join(f"{x:10d}" for x in (number, ELEMENTS[kind], 1, 1, 7, len(nodes))) + "\n"
            if kind == "line":
                yield "".join(f"{x:10d}" for x in (0, 0, 0)) + "\n"
            yield "".join(f"{x:10d}" for x in nodes) + "\n"


def _mode(motion: NodeMotion, k: int, frequency: float) -> Iterator[str]:
    """Yield dataset 55: structural, normal mode, 3 or 6 components, displacement, real."""
    components = 6 if motion.turns else 3
    kind = 3 if motion.turns else 2
    yield f"mode {k + 1}\n{frequency:.9g} Hz\nNONE\nNONE\nNONE\n"
    yield "".join(f"{x:10d}" for x in (1, 2, kind, 8, 2, components)) + "\n"
    yield "".join(f"{x:10d}" for x in (2, 4, 1, k + 1)) + "\n"
    yield "".join(f"{x:13.5E}" for x in (frequency, 1.0, 0.0, 0.0)) + "\n"
    for number, values in zip(motion.number.tolist(), motion.values[k].tolist(), strict=True):
        yield f"{number:10d}\n" + "".join(f"{x:13.5E}" for x in values[:components]) + "\n"
