"""VTU: unstructured grids of VTK, for ParaView and others, with a vector for each mode."""

from __future__ import annotations

import base64
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np
import numpy.typing as npt

from modefront._typing import Floats
from modefront.exports.motion import NodeMotion
from modefront.programs.mesh import CORNERS, ProgramMesh

CELL_TYPES = {
    "vertex": 1,
    "line": 3,
    "triangle": 5,
    "quad": 9,
    "tetra": 10,
    "hexahedron": 12,
    "wedge": 13,
    "pyramid": 14,
}
"""Numbers of VTK."""

NAMES = {"float64": "Float64", "int64": "Int64", "uint8": "UInt8"}


def write_vtu(path: Path, mesh: ProgramMesh, motion: NodeMotion, frequencies: Floats) -> None:
    """Write nodes, cells and the displacement of every mode, named with its frequency in Hz."""
    connectivity = [np.searchsorted(mesh.number, table) for table in mesh.cells.values()]
    sizes = np.repeat([CORNERS[kind] for kind in mesh.cells], [len(c) for c in connectivity])
    kinds = np.repeat([CELL_TYPES[kind] for kind in mesh.cells], [len(c) for c in connectivity])
    points = [
        _array(f"mode {k}, {f:.6g} Hz", np.ascontiguousarray(values[:, :3]), 3)
        for k, (f, values) in enumerate(zip(frequencies, motion.values, strict=True), start=1)
    ]
    flat = np.concatenate([c.ravel() for c in connectivity]) if connectivity else np.zeros(0)
    lines = [
        '<?xml version="1.0"?>',
        '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
        'header_type="UInt64">',
        "<UnstructuredGrid>",
        f'<Piece NumberOfPoints="{mesh.number.size}" NumberOfCells="{sizes.size}">',
        "<PointData>",
        *points,
        _array("node", mesh.number.astype(np.int64), 1),
        "</PointData>",
        "<Points>",
        _array("Points", mesh.coordinates.astype(float), 3),
        "</Points>",
        "<Cells>",
        _array("connectivity", flat.astype(np.int64), 1),
        _array("offsets", np.cumsum(sizes).astype(np.int64), 1),
        _array("types", kinds.astype(np.uint8), 1),
        "</Cells>",
        "</Piece>",
        "</UnstructuredGrid>",
        "</VTKFile>",
    ]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _array(name: str, values: npt.NDArray[Any], components: int) -> str:
    data = np.ascontiguousarray(values)
    little = data.astype(data.dtype.newbyteorder("<"))
    content = np.uint64(little.nbytes).astype("<u8").tobytes() + little.tobytes()
    text = base64.b64encode(content).decode("ascii")
    count = f'NumberOfComponents="{components}" ' if components > 1 else ""
    return (
        f'<DataArray type="{NAMES[data.dtype.name]}" Name={quoteattr(name)} '
        f'{count}format="binary">{text}</DataArray>'
    )
