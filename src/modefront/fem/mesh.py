"""Meshes from files: nodes, cells by group name, sets of nodes.

meshio (an optional extra) reads the file. Groups are Gmsh's physical groups (one without a name
goes by its number), the groups of MED (Salome, Code_Aster), of which a cell or node may have
several, and the cell sets of other formats; a file without any is one group, `all`.
"""

from __future__ import annotations

import contextlib
import io
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from modefront._typing import Floats, Ints
from modefront.fem.errors import FemError

Kind = Literal["beam", "shell", "solid"]
CELL_TYPES: Mapping[Kind, tuple[str, ...]] = {
    "beam": ("line",),
    "shell": ("triangle", "quad"),
    "solid": ("hexahedron", "tetra10"),
}


@dataclass(frozen=True)
class CellBlock:
    """Cells of one type in one group.

    Attributes
    ----------
    group
        Name.
    type
        As meshio and VTK say: line, triangle, quad, hexahedron, tetra10, vertex, ...
    cells
        Nodes (cells, k).
    """

    group: str
    type: str
    cells: Ints


@dataclass(frozen=True)
class Mesh:
    """Nodes, blocks of cells and named sets of nodes, as `read_mesh` returns them.

    Attributes
    ----------
    nodes
        Coordinates (nodes, 3).
    blocks
        Cells of each type in each group.
    node_sets
        Nodes by the name of the set.
    """

    nodes: Floats
    blocks: tuple[CellBlock, ...]
    node_sets: Mapping[str, Ints]

    def cells_of(self, group: str, kind: Kind) -> tuple[Ints, ...]:
        """Cells of a group, an array for each type, for elements of the given kind.

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
        return tuple(b.cells for b in blocks)

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


def read_mesh(path: str | Path) -> Mesh:
    """Read a mesh file in any format that meshio knows.

    Raises
    ------
    FemError
        If meshio is not installed, or the file is missing or not a mesh that it can read.
    """
    try:
        import meshio
    except ImportError as error:
        raise FemError(
            "reading meshes needs meshio: install it with `pip install modefront[mesh]`"
        ) from error
    if not Path(path).is_file():
        raise FemError(f"{path}: no such file")
    said = io.StringIO()
    try:
        # meshio prints what is wrong and then ends the process.
        with contextlib.redirect_stderr(said), contextlib.redirect_stdout(said):
            raw = meshio.read(path)
    except (Exception, SystemExit) as error:
        words = " ".join(f"{said.getvalue()} {error}".split())
        raise FemError(f"{path}: expected a mesh that meshio can read ({words})") from error
    points = np.asarray(raw.points, dtype=float)
    if points.ndim != 2 or not 1 <= points.shape[1] <= 3 or len(points) == 0:
        raise FemError(f"{path}: expected nodes in up to 3 dimensions, found {points.shape}")
    blocks: dict[tuple[str, str], list[Ints]] = {}
    for name, kind, cells in _named_cells(raw):
        blocks.setdefault((name, kind), []).append(cells)
    return Mesh(
        np.pad(points, ((0, 0), (0, 3 - points.shape[1]))),
        tuple(CellBlock(*key, np.concatenate(cells)) for key, cells in blocks.items()),
        _node_sets(raw),
    )


def _node_sets(raw: Any) -> dict[str, Ints]:
    """Nodes by the name of their set, or of their MED group."""
    out = {name: np.asarray(nodes, dtype=np.int64) for name, nodes in raw.point_sets.items()}
    tags = np.asarray(raw.point_data.get("point_tags", []))
    for family, names in getattr(raw, "point_tags", {}).items():
        nodes = np.flatnonzero(tags == family)
        for name in names:
            known = out.get(name, np.zeros(0, dtype=np.int64))
            out[name] = np.union1d(known, nodes)
    return {name: nodes for name, nodes in out.items() if nodes.size}


def _named_cells(raw: Any) -> Iterator[tuple[str, str, Ints]]:
    """Group, type and cells of every part of a meshio mesh that has a name."""
    cells = [np.asarray(block.data, dtype=np.int64) for block in raw.cells]
    sets = {name: s for name, s in raw.cell_sets.items() if not name.startswith("gmsh:")}
    tags = raw.cell_data.get("gmsh:physical", [])
    for name, members in sets.items():
        for block, data, chosen in zip(raw.cells, cells, members, strict=True):
            if chosen is not None and len(chosen):
                yield name, block.type, data[np.asarray(chosen, dtype=np.int64)]
    families = getattr(raw, "cell_tags", {})
    for block, data, of_block in zip(
        raw.cells, cells, raw.cell_data.get("cell_tags", []), strict=False
    ):
        for family in np.unique(of_block).tolist():
            for name in families.get(family, ()):
                yield name, block.type, data[np.asarray(of_block) == family]
    names = {(int(tag), int(dim)): name for name, (tag, dim) in raw.field_data.items()}
    for block, data, block_tags in zip(raw.cells, cells, tags, strict=False):
        for tag in np.unique(block_tags):
            name = names.get((int(tag), block.dim), str(tag) if tag else "all")
            if name not in sets:
                yield name, block.type, data[np.asarray(block_tags) == tag]
    if not sets and not tags and not families:
        for block, data in zip(raw.cells, cells, strict=True):
            yield "all", block.type, data
