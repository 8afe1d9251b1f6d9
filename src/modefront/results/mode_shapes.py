r"""Mode shapes of all points at the nodes of the model, in a common basis, and at the sensors.

The displacements u_r of the drawn nodes in mode r of a point, with a greatest length of 1, are
:math:`u_r = \sum_b c_{rb} B_b`, with the few columns B that the shapes of all points need up to
`TOLERANCE`, and coefficients c between -1 and 1. Drawn are the nodes of lines and faces, of solids
those of the surface. Q and C are an orthonormal basis, and the coefficients in it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from modefront._typing import Floats, Ints
from modefront.errors import ModelError
from modefront.models.base import geometry_of, shapes_at
from modefront.models.geometry import Cells, Geometry
from modefront.pairing.match import mean_mac, modes_needed
from modefront.residuals.problem import UpdatingProblem
from modefront.results.analysis import Values
from modefront.results.schema import described
from modefront.results.shapes import scaled_shapes
from modefront.rounding import TINY
from modefront.work.codec import record

TOLERANCE = 1e-3
"""Error of a shape in the basis, over its length, at most."""

AXES = ("x", "y", "z")

FACES: Mapping[str, tuple[tuple[int, ...], ...]] = {
    "triangle": ((0, 1, 2),),
    "quad": ((0, 1, 2, 3),),
    "tetra": ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)),
    "wedge": ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    "pyramid": ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
    "hexahedron": (
        *((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4)),
        *((1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
    ),
}
"""Corners of the faces of cells, in the order of VTK; nodes between corners follow them there."""


@record
@dataclass(frozen=True, eq=False)
class ModeShapes:
    """Modes of all points.

    Attributes
    ----------
    frequency : (points, model modes) in Hz; NaN where a point has no modes
    mac : (points, modes, model modes) MAC of each measured with each model mode
    sensed : (points, modes, sensors) paired model modes at the sensors
    basis : (n, drawn nodes, 3) columns of the common basis; None for a model without geometry
    coefficient : (points, modes, n) of the paired model modes; None likewise
    """

    frequency: Floats
    mac: Floats
    sensed: Floats
    basis: Floats | None
    coefficient: Floats | None


@dataclass(frozen=True, eq=False)
class Drawing:
    """Nodes of a geometry that pictures show (ascending), lines (n, 2) and faces (n, 4) of these.

    A triangle has -1 in the last column.
    """

    nodes: Ints
    lines: Ints
    faces: Ints


def drawing(geometry: Geometry) -> Drawing:
    """Return lines and faces of the cells of a geometry, and the nodes that these have."""
    flat = ("line", "triangle", "quad")
    lines = [cells.nodes[:, :2] for cells in geometry.cells if cells.type.startswith("line")]
    shells = [_faces(cells) for cells in geometry.cells if cells.type.startswith(flat[1:])]
    solids = [_faces(cells) for cells in geometry.cells if not cells.type.startswith(flat)]
    none = np.empty((0, 4), dtype=np.int64)
    all_lines = np.vstack([none[:, :2], *lines])
    all_faces = np.vstack([none, *shells, _surface(np.vstack([none, *solids]))])
    # Sensors are drawn as well, at nodes between cells too.
    used = [all_lines.ravel(), all_faces[all_faces >= 0], geometry.sensor_nodes]
    nodes = np.unique(np.concatenate(used)).astype(np.int64)
    number = np.full(len(geometry.nodes) + 1, -1, dtype=np.int64)  # the last one stands for none
    number[nodes] = np.arange(len(nodes))
    return Drawing(nodes, number[all_lines], number[all_faces])


def _faces(cells: Cells) -> Ints:
    """Return the faces of cells of one type, (faces, 4), -1 for no fourth corner."""
    nodes = np.asarray(cells.nodes, dtype=np.int64)
    corners = FACES.get(cells.type.rstrip("0123456789"), ())
    if not corners:
        return np.empty((0, 4), dtype=np.int64)
    rows = [nodes[:, list(face)] for face in corners]
    return np.vstack([np.pad(x, ((0, 0), (0, 4 - x.shape[1])), constant_values=-1) for x in rows])


def _surface(faces: Ints) -> Ints:
    """Return the faces of solids that no other one has the nodes of: those within are shared."""
    if not len(faces):
        return faces
    _, first, count = np.unique(
        np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True
    )
    return faces[np.sort(first[count == 1])]


def mode_shapes(problem: UpdatingProblem, thetas: Floats, paired: Floats) -> ModeShapes:
    """Return the modes of models with parameters (points, p).

    ``paired`` (points, modes) are numbers of the model modes, from 1; NaN where there are none.
    """
    data, model = problem.data, problem.model
    count = modes_needed(problem.pairing, data, model.size)
    geometry = geometry_of(model)
    drawn = drawing(geometry).nodes if geometry else np.empty(0, dtype=np.int64)
    points, modes = paired.shape
    frequency = np.full((points, count), np.nan)
    mac = np.full((points, modes, count), np.nan)
    sensed = np.full((points, modes, len(data.sensors)), np.nan)
    basis = _Basis(3 * len(drawn))
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
        Phi = Phi[:, index] if drawn.size and Phi is not None else None
        sensed[i], u = scaled_shapes(problem, Phi, phi[:, index], drawn)
        rows[i] = basis.coefficients(np.zeros((0, modes)) if u is None else u.reshape(modes, -1).T)
    if geometry is None or not rows:
        return ModeShapes(frequency, mac, sensed, None, None)
    B, C = basis.longest([rows[i] for i in rows])
    coefficient = np.full((points, modes, B.shape[1]), np.nan)
    coefficient[list(rows)] = C
    return ModeShapes(frequency, mac, sensed, B.T.reshape(-1, len(drawn), 3), coefficient)


class _Basis:
    """An orthonormal basis that grows where a shape lacks something in it."""

    def __init__(self, size: int) -> None:
        self.Q = np.empty((size, 0))

    def coefficients(self, U: Floats) -> Floats:
        """Return the coefficients (columns so far, modes) of shapes U (size, modes)."""
        missing = U - self.Q @ (self.Q.T @ U)
        for r in np.flatnonzero(
            np.linalg.norm(missing, axis=0) > TOLERANCE / 10 * np.linalg.norm(U, axis=0)
        ).tolist():
            q = U[:, r]
            for _ in range(2):  # twice is enough for orthogonality to rounding
                q = q - self.Q @ (self.Q.T @ q)
            length = np.linalg.norm(q)
            if length > TOLERANCE / 10 * np.linalg.norm(U[:, r]):
                self.Q = np.column_stack([self.Q, q / length])
        return self.Q.T @ U

    def longest(self, rows: Sequence[Floats]) -> tuple[Floats, Floats]:
        """Return the basis (size, n) of what all shapes need, and coefficients (rows, modes, n)."""
        n, modes = self.Q.shape[1], rows[0].shape[1]
        C = np.hstack([np.pad(row, ((0, n - len(row)), (0, 0))) for row in rows])
        W, sigma, V = np.linalg.svd(C, full_matrices=False)
        lacking = np.cumsum((sigma[:, None] * V)[::-1] ** 2, axis=0)[::-1]
        needed = (lacking > TOLERANCE**2 * np.maximum(lacking[0], TINY)).any(axis=1)
        kept = max(1, int(needed.sum()))
        c = sigma[:kept, None] * V[:kept]
        most = np.maximum(np.abs(c).max(axis=1), TINY)
        B: Floats = (self.Q @ W[:, :kept]) * most
        return B, (c / most[:, None]).T.reshape(len(rows), modes, kept)


def with_mode_shapes(data: xr.Dataset, problem: UpdatingProblem, shapes: ModeShapes) -> xr.Dataset:
    """Return results with the measured modes, and the modes of all points."""
    measured = problem.data
    values: Values = {
        "set_frequency": measured.frequency,
        "set_frequency_std": measured.frequency_std,
        "measured_shape": measured.shape,
        "model_frequency": shapes.frequency,
        "mac_matrix": shapes.mac,
        "shape": shapes.sensed,
    }
    coordinates: dict[str, object] = {"set": list(measured.sets), "sensor": list(measured.sensors)}
    geometry = geometry_of(problem.model)
    if geometry is not None and shapes.basis is not None:
        drawn = drawing(geometry)
        values |= {
            "node": geometry.nodes[drawn.nodes],
            "line_nodes": drawn.lines,
            "face_nodes": drawn.faces,
            "sensor_node": np.searchsorted(drawn.nodes, geometry.sensor_nodes),
            "sensor_direction": geometry.sensor_directions,
            "shape_basis": shapes.basis.astype(np.float32),
            "shape_coefficient": shapes.coefficient,
        }
        coordinates["axis"] = list(AXES)
    out = data.assign(described(values)).assign_coords(coordinates)
    if geometry is not None and "node" in values:
        groups = [cells.group for cells in geometry.cells]
        out.attrs["geometry"] = "chain" if groups == ["chain"] else "mesh"
    return out
