"""Mesh files by meshio as plain arrays: a module for processes that read files."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import h5py
import meshio
import numpy as np

from modefront._typing import Ints
from modefront.fem.errors import FemError
from modefront.hdf5 import check_tree
from modefront.inputs import is_hdf5


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
        with contextlib.redirect_stderr(output), contextlib.redirect_stdout(output):
            raw = meshio.read(path)
    except (Exception, SystemExit) as error:
        raise FemError(" ".join(f"{output.getvalue()} {error}".split())) from error
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
