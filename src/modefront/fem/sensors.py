r"""Sensors: rows of weights that pick measured displacements, y = L q.

A sensor at node n along the unit vector a measures a . u_n = a . (T q)_n, so L is one sparse
product for all sensors, and one on a slave of a rigid link measures what its master moves.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.spatial import KDTree

from modefront._typing import Floats, Ints
from modefront.fem.check import node_list, unit_vector
from modefront.fem.dofs import Dofs
from modefront.fem.errors import FemError
from modefront.fem.structure import Sensor


@dataclass(frozen=True)
class SensorPlaces:
    """Where sensors are and what they measure.

    Attributes
    ----------
    nodes
        (sensors,) nodes.
    directions
        (sensors, 6) weights of x, y, z, rx, ry, rz.
    """

    nodes: Ints
    directions: Floats


def sensor_places(X: Floats, sensors: Sequence[Sensor], used: Ints) -> SensorPlaces:
    """Return nodes and directions of sensors; coordinates are looked for among the nodes `used`.

    Raises
    ------
    FemError
        If a sensor hits no node.
    """
    tree = KDTree(X[used])
    diagonal = float(np.linalg.norm(np.ptp(X[used], axis=0)))
    rows = np.zeros((len(sensors), 6))
    nodes = np.zeros(len(sensors), dtype=np.int64)
    for n, sensor in enumerate(sensors):
        place = f"sensor {sensor.name!r}"
        rows[n] = unit_vector(sensor.direction, place)
        nodes[n] = _node(X, sensor, place, used, tree, diagonal)
    return SensorPlaces(nodes, rows)


def selection_matrix(
    sensors: Sequence[Sensor], places: SensorPlaces, dofs: Dofs
) -> sparse.csr_array:
    """Return L, CSR (sensors, free DOFs).

    Raises
    ------
    FemError
        If a sensor measures what cannot move.
    """
    nodes = places.nodes
    count, columns = len(sensors), 6 * nodes[:, None] + np.arange(6)
    pick = sparse.csr_array(
        (places.directions.ravel(), (np.repeat(np.arange(count), 6), columns.ravel())),
        shape=(count, dofs.T.shape[0]),
    )
    pick.eliminate_zeros()
    selection = (pick @ dofs.T).tocsr()
    for n in np.flatnonzero(abs(selection).sum(1) == 0).tolist():
        raise FemError(
            f"sensor {sensors[n].name!r}: expected a direction that can move, but at node"
            f" {nodes[n]} direction {sensors[n].direction!r} is held or has no stiffness"
        )
    return selection


def _node(X: Floats, sensor: Sensor, place: str, used: Ints, tree: KDTree, diagonal: float) -> int:
    if isinstance(sensor.at, int | np.integer):
        return int(node_list(sensor.at, len(X), place)[0])
    point = np.asarray(sensor.at, dtype=float)
    if point.shape != (3,) or not np.isfinite(point).all():
        raise FemError(f"{place}: expected a node or coordinates (3,), found {sensor.at!r}")
    distance, nearest = tree.query(point)
    node = int(used[nearest])
    tolerance = 1e-6 * diagonal if sensor.tolerance is None else sensor.tolerance
    if distance > tolerance:
        raise FemError(
            f"{place}: no node within {tolerance:.3g} of {tuple(point.tolist())}; the nearest is"
            f" node {node} at {tuple(X[node].tolist())}, {distance:.3g} away"
        )
    return node
