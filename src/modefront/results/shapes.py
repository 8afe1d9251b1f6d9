r"""Mode shapes of models: at nodes and at sensors, beside the measured ones, and for ParaView.

Model shapes have a greatest displacement of 1 at the nodes; the measured shape follows by the modal
scale factor :math:`\hat\varphi^T \varphi / (\hat\varphi^T \hat\varphi)` at the sensors (Allemang,
Sound and Vibration 37 (8), 2003).

Results hold those of all points in a common basis B of the few columns that these need up to
`TOLERANCE`, with coefficients c between -1 and 1. Q and C are an orthonormal basis, and the
coefficients in it.
"""

import contextlib
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from modefront._typing import Arrays, Floats, Ints
from modefront.datasets import ArrayDataset, Dataset
from modefront.errors import Fault, InputError, ModelError, writing
from modefront.fem.structure import FACES
from modefront.models.base import full_of, geometry_of, shapes_at
from modefront.models.geometry import Cells, Geometry
from modefront.outputs import output_by_name
from modefront.pairing.match import mean_mac, modes_needed
from modefront.residuals.problem import UpdatingProblem
from modefront.results.schema import Values, described
from modefront.rounding import TINY
from modefront.text import Shown

TOLERANCE = 1e-3  # error of a shape in the basis, over its length, at most


@dataclass(frozen=True, repr=False)
class PairedShapes(Shown):
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


def paired_shapes(row: Dataset, problem: UpdatingProblem) -> PairedShapes:
    """Return the mode shapes of the model of one point of the results.

    Raises ModelError for a point whose model has no such modes.
    """
    paired, data = row["paired_mode"].values, problem.data
    if not np.isfinite(paired).all():
        raise ModelError(f"{row['label'].values!s} has no modes: its model cannot be solved")
    index = paired.astype(int) - 1
    _, phi, Phi = shapes_at(full_of(problem.model), row["theta"].values, int(index.max()) + 1)
    computed, displacement = _scaled(problem, Phi, phi, index)
    product = np.nansum(data.shape * computed, axis=2)
    square = np.nansum(data.shape**2, axis=2)
    factor = np.divide(product, square, out=np.zeros(square.shape), where=square > 0)
    measured, geometry = data.shape * factor[:, :, None], geometry_of(problem.model)
    known = data.modes, row["frequency"].values, data.mean_frequency, row["mac"].values
    return PairedShapes(*known, displacement, computed, measured, data.sensors, geometry)


def _scaled(
    problem: UpdatingProblem, Phi: Floats | None, phi: Floats, index: Ints, nodes: Any = slice(None)
) -> tuple[Floats, Floats | None]:
    """Return modes at the sensors (modes, sensors) and at nodes (modes, nodes, 3) in one scale.

    ``index`` (modes,) are positions in ``Phi`` (N, all) and ``phi`` (sensors, all), the modes of
    the model. The greatest length at the nodes is 1, with the sign of the first measured shape. A
    model without geometry has nothing at nodes, and a greatest component of 1.
    """
    geometry, measured = geometry_of(problem.model), problem.data.shape
    computed, displacement = phi[:, index].T, None
    size = np.abs(computed).max(axis=1)
    if geometry is not None and Phi is not None:
        displacement = geometry.displacement(Phi[:, index])[:, nodes]
        size = np.sqrt((displacement**2).sum(axis=2)).max(axis=1)
    product = np.nansum(measured * computed, axis=2)
    first = product[np.argmax(product != 0, axis=0), np.arange(len(size))]
    scale = np.where(first < 0, -1.0, 1.0) / np.where(size > 0, size, 1.0)
    moved = None if displacement is None else displacement * scale[:, None, None]
    return computed * scale[:, None], moved


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
    named = [f"mode {r} ({f:.5g} Hz)" for r, f in zip(shapes.modes, shapes.frequency, strict=True)]
    vectors = dict(zip(named, displacement, strict=True))
    total, count = np.nansum(shapes.measured, axis=0), np.isfinite(shapes.measured).sum(axis=0)
    for mode, mean in zip(shapes.modes, total / np.maximum(count, 1), strict=True):
        vectors[f"mode {mode} measured"] = at_nodes = np.zeros(geometry.nodes.shape)
        np.add.at(at_nodes, geometry.sensor_nodes, mean[:, None] * geometry.sensor_directions)
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
    numbers = [np.full(len(part.nodes), groups.index(part.group)) for part in cells]
    blocks = [(part.type, part.nodes) for part in cells]
    mesh = meshio.Mesh(nodes, blocks, dict(point_data), {"group": numbers})
    with (
        writing(path, "file"),
        contextlib.redirect_stdout(io.StringIO()),  # meshio prints warnings of its own
        contextlib.redirect_stderr(io.StringIO()),
        output_by_name(path) as copy,
    ):
        meshio.write(copy, mesh, file_format="vtu")


def drawing(geometry: Geometry) -> tuple[Ints, Ints, Ints]:
    """Return the nodes of a geometry that pictures show, lines (n, 2) and faces (n, 4) of these.

    The nodes ascend; a triangle has -1 in the last column.
    """
    none = np.empty((0, 4), dtype=np.int64)
    lines, shells, solids = [none[:, :2]], [none], [none]
    for cells in geometry.cells:
        nodes, kind = np.asarray(cells.nodes, dtype=np.int64), cells.type.rstrip("0123456789")
        if kind == "line":
            lines.append(nodes[:, :2])
        for face in FACES.get(kind, ()):
            corners = np.pad(nodes[:, list(face)], ((0, 0), (0, 4 - len(face))), constant_values=-1)
            (shells if kind in ("triangle", "quad") else solids).append(corners)
    faces = np.vstack(solids)
    # Of solids those that no other one has the nodes of: those within are shared.
    _, first, count = np.unique(
        np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True
    )
    all_lines = np.vstack(lines)
    all_faces = np.vstack([*shells, faces[np.sort(first[count == 1])]])
    # Sensors are drawn as well, at nodes between cells too.
    used = [all_lines.ravel(), all_faces[all_faces >= 0], geometry.sensor_nodes]
    nodes = np.unique(np.concatenate(used)).astype(np.int64)
    number = np.full(len(geometry.nodes) + 1, -1, dtype=np.int64)  # the last one stands for none
    number[nodes] = np.arange(len(nodes))
    return nodes, number[all_lines], number[all_faces]


def mode_shapes(problem: UpdatingProblem, thetas: Floats, paired: Floats) -> dict[str, Floats]:
    """Return the modes of models with parameters (points, p), as variables of results.

    ``paired`` (points, modes) are numbers of the model modes, from 1; NaN where there are none.
    """
    data, model = problem.data, problem.model
    count = modes_needed(problem.pairing, data, model.size)
    geometry = geometry_of(model)
    drawn = drawing(geometry)[0] if geometry else np.empty(0, dtype=np.int64)
    points, modes = paired.shape
    frequency = np.full((points, count), np.nan)
    mac = np.full((points, modes, count), np.nan)
    sensed = np.full((points, modes, len(data.sensors)), np.nan)
    Q = np.empty((3 * len(drawn), 0))
    rows: dict[int, Floats] = {}
    for i, theta in enumerate(thetas):
        if not np.isfinite(paired[i]).all():
            continue
        index = paired[i].astype(int) - 1
        try:
            lam, phi, Phi = shapes_at(model, theta, max(count, int(index.max()) + 1))
        except ModelError:
            continue
        frequency[i] = np.sqrt(np.maximum(lam[:count], 0)) / (2 * np.pi)
        mac[i] = mean_mac(data, phi[:, :count])
        sensed[i], u = _scaled(problem, Phi, phi, index, drawn)
        U = np.zeros((0, modes)) if u is None else u.reshape(modes, -1).T
        Q = _extended(Q, U)
        rows[i] = Q.T @ U
    out = {"model_frequency": frequency, "mac_matrix": mac, "shape": sensed}
    if geometry is None or not rows:
        return out
    n = Q.shape[1]
    C = np.hstack([np.pad(row, ((0, n - len(row)), (0, 0))) for row in rows.values()])
    W, sigma, V = np.linalg.svd(C, full_matrices=False)
    lacking = np.cumsum((sigma[:, None] * V)[::-1] ** 2, axis=0)[::-1]
    needed = (lacking > TOLERANCE**2 * np.maximum(lacking[0], TINY)).any(axis=1)
    kept = max(1, int(needed.sum()))
    c = sigma[:kept, None] * V[:kept]
    most = np.maximum(np.abs(c).max(axis=1), TINY)
    B = (Q @ W[:, :kept]) * most
    coefficient = np.full((points, modes, kept), np.nan)
    coefficient[list(rows)] = (c / most[:, None]).T.reshape(len(rows), modes, kept)
    basis = B.T.reshape(-1, len(drawn), 3)
    return out | {"shape_basis": basis, "shape_coefficient": coefficient}


def _extended(Q: Floats, U: Floats) -> Floats:
    """Return an orthonormal basis (size, n), with further columns where shapes U need them."""
    length = np.linalg.norm(U, axis=0)
    missing = np.linalg.norm(U - Q @ (Q.T @ U), axis=0)
    for r in np.flatnonzero(missing > TOLERANCE / 10 * length).tolist():
        q = U[:, r]
        for _ in range(2):  # twice is enough for orthogonality to rounding
            q = q - Q @ (Q.T @ q)
        if np.linalg.norm(q) > TOLERANCE / 10 * length[r]:
            Q = np.column_stack([Q, q / np.linalg.norm(q)])
    return Q


def with_mode_shapes(data: ArrayDataset, problem: UpdatingProblem, shapes: Arrays) -> ArrayDataset:
    """Return results with the measured modes, and ``shapes``, the modes of all points."""
    measured = problem.data
    values: Values = {
        "set_frequency": measured.frequency,
        "set_frequency_std": measured.frequency_std,
        "measured_shape": measured.shape,
        **shapes,
    }
    coordinates: dict[str, object] = {"set": measured.sets, "sensor": measured.sensors}
    geometry, attributes = geometry_of(problem.model), {}
    if geometry is not None and "shape_basis" in shapes:
        nodes, lines, faces = drawing(geometry)
        values |= {
            "node": geometry.nodes[nodes],
            "line_nodes": lines,
            "face_nodes": faces,
            "sensor_node": np.searchsorted(nodes, geometry.sensor_nodes),
            "sensor_direction": geometry.sensor_directions,
            "shape_basis": shapes["shape_basis"].astype(np.float32),
        }
        coordinates["axis"] = list("xyz")
        is_chain = [cells.group for cells in geometry.cells] == ["chain"]
        attributes["geometry"] = "chain" if is_chain else "mesh"
    out = data.assign(described(values)).assign_coords(coordinates)
    return out.assign_attrs(attributes)
