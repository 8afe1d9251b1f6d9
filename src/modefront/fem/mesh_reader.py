"""Mesh files by meshio as plain arrays: a module for processes that read files."""

from __future__ import annotations

import contextlib
import io
import warnings
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any
from unittest import mock

import h5py
import meshio
import numpy as np

from modefront._typing import Ints
from modefront.fem.section import FemError
from modefront.hdf5 import check_tree
from modefront.inputs import is_hdf5

CORNERS = dict(enumerate((2, 3, 4, 4, 8, 6, 5, 3, 6, 9, 10, 27), start=1)) | {15: 1, 16: 8}
"""Nodes of elements by their type in Gmsh's format 2."""


def read_with_meshio(path: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return nodes, cells and sets as arrays, and the names that belong to them.

    This is called in a process of its own, see `modefront.isolated`.
    """
    if is_hdf5(path):  # MED
        with h5py.File(path, "r") as file:
            check_tree(file)
    output = io.StringIO()
    try:
        # meshio prints what is wrong and then ends the process.
        with (
            contextlib.redirect_stderr(output),
            contextlib.redirect_stdout(output),
            warnings.catch_warnings(),
            mock.patch.object(np, "fromfile", _from_file),
        ):
            warnings.simplefilter("error", DeprecationWarning)  # NumPy's, of a text that is cut
            if path.suffix.lower() == ".msh":
                _check_sections(path)
            raw = meshio.read(path)
    except (Exception, SystemExit) as error:
        raise FemError(" ".join(f"{output.getvalue()} {error}".split())) from error
    if not len(raw.points) or not any(len(block.data) for block in raw.cells):
        raise FemError("expected nodes and cells, found none of one or the other")
    blocks: dict[tuple[str, str], list[Ints]] = {}
    for name, kind, cells in _named_cells(raw):
        blocks.setdefault((str(name), kind), []).append(cells)
    arrays = {f"cells {k}": np.concatenate(cells) for k, cells in enumerate(blocks.values())}
    sets = _node_sets(raw)
    for k, nodes in enumerate(sets.values()):
        arrays[f"set {k}"] = nodes
    arrays["points"] = np.asarray(raw.points, dtype=float)
    return arrays, {"blocks": list(blocks), "sets": list(sets)}


FROM_FILE = np.fromfile
"""NumPy's function, which returns fewer numbers than are asked for where a file ends."""


def _from_file(file: Any, dtype: Any = float, count: int = -1, *others: Any, **named: Any) -> Any:
    """Return numbers of a file as NumPy does; raises ValueError where it ends before the last."""
    out = FROM_FILE(file, dtype, count, *others, **named)
    if 0 <= count != out.size:
        raise ValueError(f"{count} numbers announced, {out.size} there")
    return out


def _check_sections(path: Path) -> None:
    """Raise ValueError where sections of Gmsh's text have no end, or not what they announce."""
    lines = [line.strip() for line in path.read_bytes().split(b"\n")]
    if lines[1:] and lines[1].split()[1:2] == [b"1"]:  # binary
        return
    begin: int | None = None
    for k, line in enumerate(lines):
        if begin is None and line:
            if not line.startswith(b"$") or line.startswith(b"$End"):
                raise ValueError(f"line {k + 1}: {line!r} in place of the beginning of a section")
            begin = k
        elif begin is not None and line.startswith(b"$"):
            section = lines[begin]
            check = CHECKS.get((lines[1][:1], section))
            if line != b"$End" + section[1:] or (check and not check(lines[begin + 1 : k])):
                raise ValueError(f"line {begin + 1}: {section!r}, other lines than said, or no end")
            begin = None
    if begin is not None:
        raise ValueError(f"line {begin + 1}: a section that has no end")


def _is_list(lines: list[bytes]) -> bool:
    """Return whether there are as many lines as the first one says."""
    return int(lines[0]) == len(lines) - 1


def _are_elements(lines: list[bytes]) -> bool:
    """Return whether they are so many, each with its tags and as many nodes as its type has."""
    rows = [[int(word) for word in line.split()] for line in lines[1:]]
    sizes = [CORNERS.get(row[1], len(row) - 3 - row[2]) for row in rows]
    return _is_list(lines) and all(
        len(row) == 3 + row[2] + size for row, size in zip(rows, sizes, strict=True)
    )


def _are_blocks(lines: list[bytes], each: int) -> bool:
    """Return whether there are as many blocks and entries, of some lines each, as is said."""
    blocks, total = (int(word) for word in lines[0].split()[:2])
    position, found = 1, 0
    for _ in range(blocks):
        _, _, _, count = (int(word) for word in lines[position].split())
        position, found = position + 1 + each * count, found + count
    return position == len(lines) and found == total


CHECKS: Mapping[tuple[bytes, bytes], Callable[[list[bytes]], bool]] = {
    (b"2", b"$PhysicalNames"): _is_list,
    (b"2", b"$Nodes"): _is_list,
    (b"2", b"$Elements"): _are_elements,
    (b"4", b"$PhysicalNames"): _is_list,
    (b"4", b"$Nodes"): lambda lines: _are_blocks(lines, 2),
    (b"4", b"$Elements"): lambda lines: _are_blocks(lines, 1),
}
"""What is announced in sections of Gmsh's text, by the first digit of the format."""


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
