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
from modefront.fem.check import SAME_PLACE, node_list, unit_vector
from modefront.fem.dofs import Dofs
from modefront.fem.section import Checks, FemError
from modefront.fem.structure import Sensor


@dataclass(frozen=True)
class SensorPlaces:
    """Places and directions of sensors.

    Attributes
    ----------
    nodes : (sensors,) nodes
    directions : (sensors, 6) weights of x, y, z, rx, ry, rz
    """

    nodes: Ints
    directions: Floats


def sensor_places(
    X: Floats, sensors: Sequence[Sensor], used: Ints, checks: Checks
) -> SensorPlaces | None:
    """Return nodes and directions of sensors; coordinates are looked for among the nodes `used`.

    What is wrong with them is noted in ``checks``; None where something is.
    """
    tree = KDTree(X[used]) if used.size else None
    diagonal = float(np.linalg.norm(np.ptp(X[used], axis=0))) if used.size else 0.0
    rows = np.zeros((len(sensors), 6))
    nodes = np.zeros(len(sensors), dtype=np.int64)
    before = len(checks.messages)
    for n, sensor in enumerate(sensors):
        place = f"sensor {sensor.name!r}"
        vector = checks.attempt(unit_vector, sensor.direction, place)
        node = checks.attempt(_node, X, sensor, place, used, tree, diagonal)
        if vector is not None and node is not None:
            rows[n], nodes[n] = vector, node
    return SensorPlaces(nodes, rows) if len(checks.messages) == before else None


def selection_matrix(
    sensors: Sequence[Sensor], places: SensorPlaces, dofs: Dofs
) -> sparse.csr_array:
    """Return L, CSR (sensors, free DOFs).

    Raises
    ------
    FemError
        With all sensors that measure what cannot move.
    """
    selection = pick(places.nodes, places.directions, dofs.T)
    still = [
        f"sensor {sensors[n].name!r}: expected a direction that can move, but at node"
        f" {places.nodes[n]} direction {sensors[n].direction!r} is held or has no stiffness"
        for n in np.flatnonzero(abs(selection).sum(1) == 0).tolist()
    ]
    if still:
        raise FemError(*still)
    return selection


def pick(nodes: Ints, directions: Floats, T: sparse.csr_array) -> sparse.csr_array:
    """Return displacements of nodes along directions (rows, 6) from the free DOFs, CSR."""
    count, columns = len(nodes), 6 * nodes[:, None] + np.arange(6)
    chosen = sparse.csr_array(
        (directions.ravel(), (np.repeat(np.arange(count), 6), columns.ravel())),
        shape=(count, T.shape[0]),
    )
    chosen.eliminate_zeros()
    return (chosen @ T).tocsr()


def _node(
    X: Floats, sensor: Sensor, place: str, used: Ints, tree: KDTree | None, diagonal: float
) -> int:
    if isinstance(sensor.at, int | np.integer):
        return int(node_list(sensor.at, len(X), place)[0])
    point = np.asarray(sensor.at, dtype=float)
    if point.shape != (3,) or not np.isfinite(point).all():
        raise FemError(f"{place}: expected a node or coordinates (3,), found {sensor.at!r}")
    if tree is None:
        raise FemError(f"{place}: expected a node of an element, found none at all")
    distance, nearest = tree.query(point)
    node = int(used[nearest])
    tolerance = SAME_PLACE * diagonal if sensor.tolerance is None else sensor.tolerance
    if distance > tolerance:
        raise FemError(
            f"{place}: no node within {tolerance:.3g} of {tuple(point.tolist())}; the nearest is"
            f" node {node} at {tuple(X[node].tolist())}, {distance:.3g} away"
        )
    return node
