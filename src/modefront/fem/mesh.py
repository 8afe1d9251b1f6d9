"""Meshes from files: nodes, cells by group name, sets of nodes.

meshio (an optional extra) reads the file. Groups are Gmsh's physical groups (one without a name
goes by its number), the groups of MED (Salome, Code_Aster), of which a cell or node may have
several, and the cell sets of other formats; a file without any is one group, `all`.
"""

from __future__ import annotations

import contextlib
import importlib.util
import io
import re
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from modefront._typing import Floats, Ints
from modefront.errors import InputError, reason
from modefront.fem.errors import FemError
from modefront.inputs import available_memory, file_size, refuse_holes
from modefront.isolated import IsolatedError, isolated
from modefront.text import one_line

Kind = Literal["beam", "shell", "solid"]
CELL_TYPES: Mapping[Kind, tuple[str, ...]] = {
    "beam": ("line",),
    "shell": ("triangle", "quad"),
    "solid": ("hexahedron", "tetra10"),
}

READER = f"{__name__}:read_with_meshio"

LARGEST = 2 * 10**9
"""Bytes of a mesh file, at most."""

SECONDS, SPEED = 60.0, 10**6
"""Time that reading may take, and bytes that are read a second at least besides."""

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

HDF5 = b"\x89HDF\r\n\x1a\n"


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
        size = file_size(path, "a mesh", LARGEST)
        refuse_holes(path, "a mesh", size)
        if found := refers_to(path):
            raise FemError(f"{path}: expected a mesh that is one file, found {found}")
        memory = min(available_memory(), MEMORY + PER_BYTE * size)
        arrays, parts = isolated(READER, path, SECONDS + size / SPEED, memory)
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
    if not zipfile.is_zipfile(path):
        with path.open("rb") as stream:
            is_hdf5 = stream.read(len(HDF5)) == HDF5
        if is_hdf5 and suffix != ".med":
            return "HDF5, which may refer to other files: convert it to Gmsh, VTK or MED"
        if is_hdf5:
            return elsewhere(path)
    return ""


def elsewhere(path: Path) -> str:
    """Return in words what an HDF5 file keeps in other files; nothing where it keeps nothing."""
    import h5py

    from modefront.hdf5 import ForeignError, check_tree

    try:
        with h5py.File(path, "r") as file:
            check_tree(file)
    except ForeignError as error:
        return str(error)
    except Exception as error:  # h5py raises errors of many kinds for damaged files
        return f"no HDF5 that can be read, {reason(error)}"
    return ""


def read_with_meshio(path: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return nodes, cells and sets as arrays, and the names that belong to them.

    This is called in a process of its own, see `modefront.isolated`.
    """
    import meshio

    said = io.StringIO()
    try:
        # meshio prints what is wrong and then ends the process.
        with contextlib.redirect_stderr(said), contextlib.redirect_stdout(said):
            raw = meshio.read(path)
    except (Exception, SystemExit) as error:
        raise FemError(" ".join(f"{said.getvalue()} {error}".split())) from error
    blocks: dict[tuple[str, str], list[Ints]] = {}
    for name, kind, cells in _named_cells(raw):
        blocks.setdefault((str(name), kind), []).append(cells)
    arrays = {f"cells {k}": np.concatenate(cells) for k, cells in enumerate(blocks.values())}
    sets = _node_sets(raw)
    for k, nodes in enumerate(sets.values()):
        arrays[f"set {k}"] = nodes
    arrays["points"] = np.asarray(raw.points, dtype=float)
    return arrays, {"blocks": list(blocks), "sets": list(sets)}


def _node_sets(raw: Any) -> dict[str, Ints]:
    """Nodes by the name of their set, or of their MED group."""
    out = {str(name): np.asarray(nodes, dtype=np.int64) for name, nodes in raw.point_sets.items()}
    tags = np.asarray(raw.point_data.get("point_tags", []))
    for family, names in getattr(raw, "point_tags", {}).items():
        nodes = np.flatnonzero(tags == family)
        for name in map(str, names):
            out[name] = np.union1d(out.get(name, np.zeros(0, dtype=np.int64)), nodes)
    return out


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
    of_blocks = raw.cell_data.get("cell_tags", [])
    for block, data, of_block in zip(raw.cells, cells, of_blocks, strict=False):
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
