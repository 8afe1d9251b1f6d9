"""Meshes from files: nodes, cells by group name, sets of nodes.

meshio (an optional extra) reads the file. Groups are Gmsh's physical groups (one without a name
goes by its number), the groups of MED (Salome, Code_Aster), of which a cell or node may have
several, and the cell sets of other formats; a file without any is one group, `all`.

Shells of 6, 8 and 9 nodes are made of those of 3 and 4 that divide them at all of their nodes,
so that their curvature and their nodes are used as they are.
"""

from __future__ import annotations

import importlib.util
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from modefront._typing import Floats, Ints
from modefront.errors import InputError, reason
from modefront.fem.section import FemError
from modefront.inputs import MOST_DATA, available_memory, file_size, is_hdf5, refuse_holes
from modefront.isolated import IsolatedError, isolated
from modefront.text import one_line

Kind = Literal["beam", "truss", "shell", "solid"]
CELL_TYPES: Mapping[Kind, tuple[str, ...]] = {
    "beam": ("line",),
    "truss": ("line",),
    "shell": ("triangle", "quad", "triangle6", "quad8", "quad9"),
    "solid": ("hexahedron", "tetra10", "wedge15", "hexahedron20"),
}

DIVISIONS: Mapping[str, list[list[tuple[int, ...]]]] = {
    "triangle6": [[(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)]],
    "quad8": [[(4, 5, 6, 7)], [(0, 4, 7), (4, 1, 5), (5, 2, 6), (7, 6, 3)]],
    "quad9": [[(0, 4, 8, 7), (4, 1, 5, 8), (8, 5, 2, 6), (7, 8, 6, 3)]],
}
"""Quadrilaterals and triangles that shells of more nodes are made of."""

READER = "modefront.fem.mesh_reader:read_with_meshio"

MEMORY, PER_BYTE = 2 * 10**9, 40
"""Memory that reading may take, in bytes, and that for each byte of the file besides."""

REFERRING = (
    *(".xdmf", ".xmf", ".h5m", ".cgns", ".hmf", ".exo", ".e", ".ex2"),
    *(".ele", ".node", ".xml"),
)
"""Endings of formats that are several files, or keep values in HDF5, which may refer to others."""

COMMANDS = (".inp", ".bdf", ".nas", ".fem", ".dat", ".key", ".cdb")
"""Endings of formats of commands, one of which may be to read another file."""

INCLUDES = re.compile(rb"\*.*\binput\s*=|\*?\s*include\b", re.IGNORECASE)
"""A command that reads another file."""


@dataclass(frozen=True)
class CellBlock:
    """Cells of one type in one group.

    Attributes
    ----------
    group : name
    type : as meshio and VTK say: line, triangle, quad, hexahedron, tetra10, vertex, ..
    cells : nodes (cells, k)
    """

    group: str
    type: str
    cells: Ints


@dataclass(frozen=True)
class Mesh:
    """Nodes, blocks of cells and named sets of nodes, as `read_mesh` returns them.

    Attributes
    ----------
    nodes : coordinates (nodes, 3)
    blocks : cells of each type in each group
    node_sets : nodes by the name of the set
    """

    nodes: Floats
    blocks: tuple[CellBlock, ...]
    node_sets: Mapping[str, Ints]

    def cells_of(self, group: str, kind: Kind) -> tuple[Ints, ...]:
        """Cells of a group, an array for each type, for elements of the given kind.

        Shells of more than 4 nodes are divided into triangles and quadrilaterals.

        Raises
        ------
        FemError
            If there is no such group, or it has cells of which no such elements can be made.
        """
        blocks = [b for b in self.blocks if b.group == group]
        if not blocks:
            groups = ", ".join(sorted({b.group for b in self.blocks})) or "none"
            raise FemError(f"mesh: no group of cells named {group!r}; there are: {groups}")
        for block in blocks:
            if block.type not in CELL_TYPES[kind]:
                raise FemError(
                    f"mesh: group {group!r} has cells of the type {block.type}; a {kind} can be"
                    f" made of: {', '.join(CELL_TYPES[kind])}"
                )
        return tuple(cells for block in blocks for cells in _divided(block))

    def nodes_of(self, name: str) -> Ints:
        """Nodes of a set, or of the cells of a group, ascending.

        Raises
        ------
        FemError
            If there is neither.
        """
        blocks = [b.cells.ravel() for b in self.blocks if b.group == name]
        if name in self.node_sets:
            blocks.append(self.node_sets[name])
        if not blocks:
            names = sorted({b.group for b in self.blocks} | set(self.node_sets))
            raise FemError(
                f"mesh: no group or set of nodes named {name!r}; there are:"
                f" {', '.join(names) or 'none'}"
            )
        return np.unique(np.concatenate(blocks))


def _divided(block: CellBlock) -> list[Ints]:
    """Return the cells, those of shells of more than 4 nodes divided, an array for each type."""
    if block.type not in DIVISIONS:
        return [block.cells]
    return [
        np.concatenate([block.cells[:, part] for part in parts]) for parts in DIVISIONS[block.type]
    ]


def read_mesh(path: str | Path) -> Mesh:
    """Read a mesh file in any format that meshio knows.

    The file is read in a process of its own, with limits on time and memory, and what it refers to
    in other files is refused.

    Raises
    ------
    FemError
        If meshio is not installed, or the file is missing or not a mesh that it can read.
    """
    if importlib.util.find_spec("meshio") is None:
        raise FemError("reading meshes needs meshio: install it with `pip install modefront[mesh]`")
    path = Path(path)
    try:
        size = file_size(path, "a mesh", MOST_DATA)
        refuse_holes(path, "a mesh", size)
        if reference := refers_to(path):
            raise FemError(f"{path}: expected a mesh that is one file, found {reference}")
        memory = min(available_memory(), MEMORY + PER_BYTE * size)
        arrays, parts = isolated(READER, path, memory=memory)
    except IsolatedError as error:
        raise FemError(f"{path}: expected a mesh that meshio can read, found {error}") from None
    except InputError as error:
        fault = error.faults[0]
        raise FemError(f"{path}: expected {fault.expected}, found {fault.found}") from None
    except OSError as error:
        raise FemError(f"{path}: expected a mesh, found {reason(error)}") from None
    points = arrays.pop("points")
    if points.ndim != 2 or not 1 <= points.shape[1] <= 3 or len(points) == 0:
        raise FemError(f"{path}: expected nodes in up to 3 dimensions, found {points.shape}")
    return Mesh(
        np.pad(points, ((0, 0), (0, 3 - points.shape[1]))),
        tuple(
            CellBlock(name, kind, arrays[f"cells {k}"])
            for k, (name, kind) in enumerate(parts["blocks"])
        ),
        {name: arrays[f"set {k}"] for k, name in enumerate(parts["sets"])},
    )


def refers_to(path: Path) -> str:
    """Return in words what a mesh file takes from other files; nothing where it takes nothing."""
    suffix = path.suffix.lower()
    if suffix in REFERRING:
        return f"the format {suffix}, which keeps values in other files"
    if suffix in COMMANDS:
        with path.open("rb") as stream:
            for number, line in enumerate(stream, start=1):
                if INCLUDES.match(line):
                    text = one_line(line[:200].decode("utf-8", "replace"), 80)
                    return f"a part from another file, line {number}: {text}"
    if suffix != ".med" and is_hdf5(path):
        return "HDF5, which may refer to other files: convert it to Gmsh, VTK or MED"
    return ""
