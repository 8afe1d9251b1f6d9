"""Where a model's degrees of freedom are in space: nodes, cells between them, sensors.

Geometry is for pictures and for other programs; no result depends on it.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from modefront._typing import Floats, Ints
from modefront.fem.structure import DIRECTIONS
from modefront.fem.structure import Cells as Cells
from modefront.linalg.affine import sparse_rows
from modefront.text import Shown

ALONG = 0.99  # component of a direction from which on it is one along an axis


@dataclass(frozen=True, eq=False, repr=False)
class Geometry(Shown):
    """Nodes, cells and sensors of a model, and how its degrees of freedom move the nodes.

    Attributes
    ----------
    nodes : (nodes, 3) coordinates
    cells : what is between the nodes
    motion : (3 nodes, N) displacement x, y, z of node after node from the degrees of freedom
    sensor_nodes : (sensors,) node of each sensor
    sensor_directions : (sensors, 3) unit vector that each sensor measures; zero for a rotation
    numbers : (nodes,) of a program that study files go by; None where they go by coordinates
    """

    nodes: Floats
    cells: tuple[Cells, ...]
    motion: csr_array
    sensor_nodes: Ints
    sensor_directions: Floats
    numbers: Ints | None = None

    def weights(self, nodes: Ints, directions: Floats) -> csr_array:
        """Return weights (sensors, N) of sensors at nodes along ``directions`` (sensors, 3)."""
        columns = 3 * nodes[:, None] + np.arange(3)
        return (sparse_rows(directions, columns, self.motion.shape[0]) @ self.motion).tocsr()

    @property
    def axes(self) -> tuple[int, ...]:
        """The axes, 0 to 2, along which nodes can move."""
        moved = np.diff(self.motion.indptr).reshape(-1, 3).any(axis=0)
        return tuple(np.flatnonzero(moved).tolist())

    def displacement(self, shapes: Floats) -> Floats:
        """Return the displacement of all nodes, (modes, nodes, 3), in mode shapes (N, modes)."""
        return np.asarray(self.motion @ shapes).T.reshape(-1, len(self.nodes), 3)


def chain_geometry(masses: int, sensors: csr_array) -> Geometry:
    """Return the geometry of a chain: masses above each other, which move along x.

    The ground is the node at height 0, mass i is at height i. A sensor of several masses is drawn
    at the one with the greatest weight; ``sensors`` are weights (sensors, masses).
    """
    nodes, lower = np.zeros((masses + 1, 3)), np.arange(masses)
    nodes[1:, 2] = lower + 1
    lines = np.column_stack([lower, lower + 1])
    motion = csr_array((np.ones(masses), (3 * lower + 3, lower)), shape=(3 * masses + 3, masses))
    weights = sensors.toarray()
    greatest = np.abs(weights).argmax(axis=1)
    directions = np.zeros((len(weights), 3))
    directions[:, 0] = np.sign(weights[np.arange(len(weights)), greatest])
    return Geometry(nodes, (Cells("chain", "line", lines),), motion, greatest + 1, directions)


def axis_name(direction: Floats) -> str:
    """Return a direction, (3,) or (6,), in words: an axis with its sign, or a vector."""
    greatest = int(np.argmax(np.abs(direction)))
    if abs(direction[greatest]) > ALONG:
        return ("-" if direction[greatest] < 0 else "") + DIRECTIONS[greatest]
    return "(" + ", ".join(f"{x:.2g}" for x in direction[:3]) + ")"
