"""Meshes from files: nodes, cells by group name, sets of nodes.

meshio (an optional extra) reads the file. Groups are Gmsh's physical groups (one without a name
goes by its number), the groups of MED (Salome, Code_Aster), of which a cell or node may have
several, and the cell sets of other formats; a file without any is one group, `all`.

Shells of 6, 8 and 9 nodes are made of those of 3 and 4 that divide them at all of their nodes,
so that their curvature and their nodes are used as they are.
"""

import contextlib
import importlib.util
import io
import re
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any, Literal

import h5py
import numpy as np

from modefront import errors
from modefront._typing import Floats, Ints
from modefront.errors import suggestion
from modefront.fem.structure import Cells
from modefront.hdf5 import check_tree
from modefront.inputs import MOST_DATA, available_memory, file_size, wrong
from modefront.text import one_line
from modefront.work.isolated import isolated

Kind = Literal["beam", "truss", "shell", "solid"]
CELL_TYPES: Mapping[Kind, tuple[str, ...]] = {
    "beam": ("line",),
    "truss": ("line",),
    "shell": ("triangle", "quad", "triangle6", "quad8", "quad9"),
    "solid": ("hexahedron", "tetra10", "wedge15", "hexahedron20"),
}

DIVISIONS: Mapping[str, list[list[Sequence[int]]]] = {  # that shells of more nodes are made of
    "triangle6": [[(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)]],
    "quad8": [[(4, 5, 6, 7)], [(0, 4, 7), (4, 1, 5), (5, 2, 6), (7, 6, 3)]],
    "quad9": [[(0, 4, 8, 7), (4, 1, 5, 8), (8, 5, 2, 6), (7, 8, 6, 3)]],
}

CORNERS = dict(enumerate((2, 3, 4, 4, 8, 6, 5, 3, 6, 9, 10, 27), start=1)) | {15: 1, 16: 8}
"""Nodes of elements by their type in Gmsh's format 2."""

MEMORY, PER_BYTE = 2 * 10**9, 40  # bytes that reading may take, and for each of the file besides

READABLE = "a mesh that meshio can read"

LINKING = (".xdmf", ".xmf", ".h5m", ".cgns", ".hmf", ".exo", ".e", ".ex2", ".ele", ".node", ".xml")
"""Endings of formats that are several files, or keep values in HDF5, which may refer to others."""

COMMANDS = (".inp", ".bdf", ".nas", ".fem", ".dat", ".key", ".cdb")  # one may read another file

INCLUDES = re.compile(rb"\*.*\binput\s*=|\*?\s*include\b", re.IGNORECASE)  # of another file
SECTION = re.compile(rb"^\$(\w+)\s*\n(.*?)^\$End\1\s*$", re.DOTALL | re.MULTILINE)  # of Gmsh
FROM_FILE = np.fromfile  # returns fewer numbers than are asked for where a file ends


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
    blocks: tuple[Cells, ...]
    node_sets: Mapping[str, Ints]

    def cells_of(self, group: str, kind: Kind) -> tuple[Ints, ...]:
        """Cells of a group, an array for each type, for elements of the given kind.

        Shells of more than 4 nodes are divided into triangles and quadrilaterals. Raises InputError
        if there is no such group, or it has cells of which no such elements can be made.
        """
        blocks = [b for b in self.blocks if b.group == group]
        if not blocks:
            groups = sorted({b.group for b in self.blocks})
            expected = f"a group of the mesh ({', '.join(groups) or 'there is none'})"
            raise errors.wrong("", expected, suggestion(group, groups))
        for block in blocks:
            if block.type not in CELL_TYPES[kind]:
                expected = f"a group of the mesh with {' or '.join(CELL_TYPES[kind])}, for a {kind}"
                raise errors.wrong("", expected, f"{group!r} with cells of type {block.type}")
        return tuple(
            np.concatenate([block.nodes[:, part] for part in parts])
            for block in blocks
            for parts in DIVISIONS.get(block.type, [[range(block.nodes.shape[1])]])
        )

    def nodes_of(self, name: str) -> Ints:
        """Nodes of a set or cells of a group, ascending; raises InputError if there is neither."""
        blocks = [b.nodes.ravel() for b in self.blocks if b.group == name]
        if name in self.node_sets:
            blocks.append(self.node_sets[name])
        if not blocks:
            names = sorted({b.group for b in self.blocks} | set(self.node_sets))
            expected = f"a group or node set of the mesh ({', '.join(names) or 'there is none'})"
            raise errors.wrong("", expected, suggestion(name, names))
        return np.unique(np.concatenate(blocks))


def read_mesh(path: str | Path) -> Mesh:
    """Read a mesh file in any format that meshio knows.

    The file is read in a process of its own, with limits on time and memory, and what it refers to
    in other files is refused.

    Raises InputError if meshio is not installed, or the file is missing or not a mesh that it can
    read.
    """
    path = Path(path)
    if importlib.util.find_spec("meshio") is None:
        raise wrong(path, "meshio for meshes (`pip install modefront[mesh]`)", "no such package")
    memory = min(available_memory(), MEMORY + PER_BYTE * file_size(path, "a mesh", MOST_DATA))
    points, blocks, sets = isolated(f"{__name__}:read_with_meshio", path, READABLE, memory=memory)
    if points.ndim != 2 or not 1 <= points.shape[1] <= 3:
        raise wrong(path, "nodes in up to 3 dimensions", str(points.shape))
    cells = tuple(Cells(*block) for block in blocks)
    return Mesh(np.pad(points, ((0, 0), (0, 3 - points.shape[1]))), cells, sets)


def refers_to(path: Path) -> str:
    """Return in words what a mesh file takes from other files; nothing where it takes nothing."""
    suffix = path.suffix.lower()
    if suffix in LINKING:
        return f"the format {suffix}, which keeps values in other files"
    if suffix in COMMANDS:
        with path.open("rb") as stream:
            for number, line in enumerate(stream, start=1):
                if INCLUDES.match(line):
                    text = one_line(line[:200].decode("utf-8", "replace"), 80)
                    return f"a part from another file, line {number}: {text}"
    if suffix != ".med" and h5py.is_hdf5(path):
        return "HDF5, which may refer to other files: convert it to Gmsh, VTK or MED"
    return ""


def read_with_meshio(path: Path) -> tuple[Any, ...]:
    """Return nodes, cells with their groups and types, and sets; see `modefront.work.isolated`."""
    from unittest import mock

    import meshio

    if reference := refers_to(path):
        raise wrong(path, "a mesh that is one file", reference)
    if h5py.is_hdf5(path):  # MED
        with h5py.File(path, "r") as file:
            check_tree(file)
    output = io.StringIO()
    try:
        # meshio prints what is wrong and then ends the process.
        with (
            contextlib.redirect_stderr(output),
            contextlib.redirect_stdout(output),
            warnings.catch_warnings(action="error", category=DeprecationWarning),  # of a cut text
            mock.patch.object(np, "fromfile", _from_file),
        ):
            if path.suffix.lower() == ".msh":
                _check_sections(path.read_bytes())
            raw = meshio.read(path)
    except MemoryError:
        raise
    except (Exception, SystemExit) as error:
        raise wrong(path, READABLE, one_line(f"{output.getvalue()} {error}", 400)) from error
    if not len(raw.points) or not any(len(block.data) for block in raw.cells):
        raise wrong(path, "nodes and cells", "none of one or the other")
    blocks: dict[tuple[str, str], list[Ints]] = {}
    for name, kind, cells in _named_cells(raw):
        blocks.setdefault((str(name), kind), []).append(cells)
    named = [(*block, np.concatenate(cells)) for block, cells in blocks.items()]
    # Nodes by the name of their set, or of their MED group.
    sets = {str(name): np.asarray(nodes, dtype=np.int64) for name, nodes in raw.point_sets.items()}
    tags = np.asarray(raw.point_data.get("point_tags", []))
    for family, names in getattr(raw, "point_tags", {}).items():
        for name in map(str, names):
            sets[name] = np.union1d(sets.get(name, []), np.flatnonzero(tags == family))
    sets = {name: nodes.astype(np.int64) for name, nodes in sets.items()}
    return np.asarray(raw.points, dtype=float), named, sets


def _from_file(file: Any, dtype: Any = float, count: int = -1, *others: Any, **named: Any) -> Any:
    """Return numbers of a file as NumPy does; raises ValueError where it ends before the last."""
    out = FROM_FILE(file, dtype, count, *others, **named)
    if 0 <= count != out.size:
        raise ValueError(f"{count} numbers announced, {out.size} there")
    return out


def _check_sections(content: bytes) -> None:
    """Raise ValueError where sections of Gmsh's text have no end, or not what they announce."""
    sections = {name: body.split(b"\n")[:-1] for name, body in SECTION.findall(content)}
    version, binary, *_ = sections.get(b"MeshFormat", [b"? 0"])[0].split()
    if binary == b"1":
        return
    if outside := SECTION.sub(b"", content).strip():
        raise ValueError(f"{outside[:60]!r} outside of sections, or in one without an end")
    for name, each in ((b"PhysicalNames", 0), (b"Nodes", 2), (b"Elements", 1)):
        (head, *lines), found = sections.get(name, [b"0 0"]), 0
        if each and version[:1] == b"4":  # blocks of entries of ``each`` lines
            rows = iter(lines)
            for _, _, _, count in (map(int, row.split()) for row in rows):
                found += count if len(list(islice(rows, each * count))) == each * count else -1
        else:
            found = len(lines)
        if version[:1] in b"24" and found != int(head.split()[each > 0 and version[:1] == b"4"]):
            raise ValueError(f"{found} entries of {name.decode()}, not those announced")
    elements = sections.get(b"Elements", []) if version[:1] == b"2" else []
    for _, kind, tags, *others in (map(int, line.split()) for line in elements[1:]):
        if len(others) - tags != CORNERS.get(kind, len(others) - tags):
            raise ValueError(f"{len(others) - tags} nodes of an element of type {kind}")


def _named_cells(raw: Any) -> Iterator[tuple[str, str, Ints]]:
    """Group, type and cells of every part of a meshio mesh that has a name."""
    sets = {name: s for name, s in raw.cell_sets.items() if not name.startswith("gmsh:")}
    names = {(int(tag), int(dim)): name for name, (tag, dim) in raw.field_data.items()}
    families = getattr(raw, "cell_tags", {})
    of_families, tags = (raw.cell_data.get(x, []) for x in ("cell_tags", "gmsh:physical"))
    for k, block in enumerate(raw.cells):
        cells = np.asarray(block.data, dtype=np.int64)
        for name, members in sets.items():
            if members[k] is not None and len(members[k]):
                yield name, block.type, cells[np.asarray(members[k], dtype=np.int64)]
        for family in np.unique(of_families[k]).tolist() if of_families else ():
            for name in families.get(family, ()):
                yield name, block.type, cells[np.asarray(of_families[k]) == family]
        for tag in np.unique(tags[k]) if tags else ():
            name = names.get((int(tag), block.dim), str(tag) if tag else "all")
            if name not in sets:
                yield name, block.type, cells[np.asarray(tags[k]) == tag]
        if not sets and not tags and not families:
            yield "all", block.type, cells
