r"""Mode shapes of one model at all its degrees of freedom, beside the measured ones.

Model shapes have a greatest displacement of 1 at the nodes; the measured shape follows by the modal
scale factor :math:`\hat\varphi^T \varphi / (\hat\varphi^T \hat\varphi)` at the sensors (Allemang,
Sound and Vibration 37 (8), 2003).
"""

from __future__ import annotations

import contextlib
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from modefront._typing import Floats, Ints
from modefront.brief import as_html, brief
from modefront.data.modal import ModalData
from modefront.errors import Fault, InputError, ModelError, writing
from modefront.models.base import full_of, geometry_of, shapes_at
from modefront.models.geometry import Cells, Geometry
from modefront.outputs import output_by_name
from modefront.residuals.problem import UpdatingProblem


@dataclass(frozen=True, repr=False)
class PairedShapes:
    """Model modes that are paired with the measured ones, each pair in one scale.

    Attributes
    ----------
    modes : numbers of the measured modes
    frequency : (modes,) of the model, in Hz
    measured_frequency : (modes,) in Hz; NaN where it is not measured
    mac : (modes,) MAC of the pairs
    displacement : (modes, nodes, 3) greatest length 1; None for a model without geometry
    computed : (modes, sensors) in the scale of ``displacement``, or with greatest value 1
    measured : (sets, modes, sensors) scaled to ``computed``; NaN where it is not measured
    sensors : names of the sensors
    geometry : of the model; None where it is not known
    """

    modes: tuple[int, ...]
    frequency: Floats
    measured_frequency: Floats
    mac: Floats
    displacement: Floats | None
    computed: Floats
    measured: Floats
    sensors: tuple[str, ...]
    geometry: Geometry | None

    __repr__ = brief
    _repr_html_ = as_html


def paired_shapes(row: xr.Dataset, problem: UpdatingProblem) -> PairedShapes:
    """Return the mode shapes of the model of one point of the results.

    Raises ModelError for a point whose model has no such modes.
    """
    theta = row["theta"].values
    paired = row["paired_mode"].values
    if not np.isfinite(paired).all():
        raise ModelError(f"{row['label'].values!s} has no modes: its model cannot be solved")
    index = paired.astype(int) - 1
    _, phi, Phi = shapes_at(full_of(problem.model), theta, int(index.max()) + 1)
    Phi = None if Phi is None else Phi[:, index]
    computed, displacement = scaled_shapes(problem, Phi, phi[:, index])
    return PairedShapes(
        problem.data.modes,
        row["frequency"].values,
        problem.data.mean_frequency,
        row["mac"].values,
        displacement,
        computed,
        _fitted(problem.data, computed),
        problem.data.sensors,
        geometry_of(problem.model),
    )


def scaled_shapes(
    problem: UpdatingProblem, Phi: Floats | None, phi: Floats, nodes: Ints | None = None
) -> tuple[Floats, Floats | None]:
    """Return modes at the sensors (modes, sensors) and at nodes (modes, nodes, 3) in one scale.

    ``Phi`` (N, modes) and ``phi`` (sensors, modes) are the modes of the model; there are none at
    nodes of a model without geometry.
    """
    geometry, computed, displacement = geometry_of(problem.model), phi.T, None
    if geometry is not None and Phi is not None:
        displacement = geometry.displacement(Phi)
        displacement = displacement if nodes is None else displacement[:, nodes]
    scale = unit_scale(problem.data, computed, displacement)[:, None]
    return computed * scale, None if displacement is None else displacement * scale[..., None]


def unit_scale(data: ModalData, computed: Floats, displacement: Floats | None) -> Floats:
    """Return factors (modes,) to a greatest length of 1 and the sign of the first measured shape.

    Without displacements (modes, nodes, 3) the greatest component of the ``computed`` shapes
    (modes, sensors) is 1.
    """
    if displacement is None:
        size = np.abs(computed).max(axis=1)
    else:
        size = np.sqrt((displacement**2).sum(axis=2)).max(axis=1)
    product = np.nansum(data.shape * computed, axis=2)
    first = np.argmax(product != 0, axis=0)
    sign = np.where(product[first, np.arange(len(size))] < 0, -1.0, 1.0)
    out: Floats = sign / np.where(size > 0, size, 1.0)
    return out


def _fitted(data: ModalData, computed: Floats) -> Floats:
    """Return measured shapes (sets, modes, sensors) times their modal scale factors."""
    product = np.nansum(data.shape * computed, axis=2)
    square = np.nansum(data.shape**2, axis=2)
    factor = np.divide(product, square, out=np.zeros(square.shape), where=square > 0)
    out: Floats = data.shape * factor[:, :, None]
    return out


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
