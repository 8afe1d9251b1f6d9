"""Mode shapes as a VTU file for ParaView: vectors at the nodes, measured ones along the sensors."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from modefront._typing import Floats, Ints
from modefront.errors import Fault, InputError, ModelError, writing
from modefront.models.geometry import Cells, Geometry
from modefront.outputs import output_by_name
from modefront.results.shapes import PairedShapes


def write_vtu(path: Path, shapes: PairedShapes) -> None:
    """Write nodes, cells and mode shapes, whole or not at all.

    Raises ModelError for a model without geometry, and what `write_grid` raises.
    """
    geometry, displacement = shapes.geometry, shapes.displacement
    if geometry is None or displacement is None:
        raise ModelError(
            "mode shapes at nodes: expected a model with geometry (a chain or finite elements), "
            "found matrices alone"
        )
    vectors = {
        f"mode {mode} ({frequency:.5g} Hz)": displacement[r]
        for r, (mode, frequency) in enumerate(zip(shapes.modes, shapes.frequency, strict=True))
    }
    for r, mode in enumerate(shapes.modes):
        vectors[f"mode {mode} measured"] = _at_sensors(geometry, shapes.measured[:, r])
    write_grid(path, geometry.nodes, geometry.cells, vectors)


def write_grid(
    path: Path, nodes: Floats, cells: Sequence[Cells], point_data: Mapping[str, Floats | Ints]
) -> None:
    """Write nodes (nodes, 3), cells, and data with a row a node, whole or not at all.

    Raises InputError where meshio is missing or the file cannot be written.
    """
    try:
        import meshio
    except ImportError:
        expected = "meshio, which `pip install modefront[mesh]` brings"
        raise InputError(Fault(str(path), "VTU", expected, "no such package")) from None
    groups = sorted({part.group for part in cells})
    mesh = meshio.Mesh(
        nodes,
        [(part.type, part.nodes) for part in cells],
        point_data=dict(point_data),
        cell_data={"group": [np.full(len(x.nodes), groups.index(x.group)) for x in cells]},
    )
    with (
        writing(path, "file"),
        contextlib.redirect_stdout(io.StringIO()),  # meshio prints warnings of its own
        contextlib.redirect_stderr(io.StringIO()),
        output_by_name(path) as copy,
    ):
        meshio.write(copy, mesh, file_format="vtu")


def _at_sensors(geometry: Geometry, measured: Floats) -> Floats:
    """Return displacements (nodes, 3) of shapes (sets, sensors), the mean over the data sets."""
    known = np.isfinite(measured)
    count = np.maximum(known.sum(axis=0), 1)
    mean = np.where(known, measured, 0.0).sum(axis=0) / count
    out = np.zeros(geometry.nodes.shape)
    np.add.at(out, geometry.sensor_nodes, mean[:, None] * geometry.sensor_directions)
    return out
