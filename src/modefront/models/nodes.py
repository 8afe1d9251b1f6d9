"""Nodes of a model and what its sensors measure at them."""

from __future__ import annotations

from dataclasses import dataclass

import scipy.sparse

from modefront._typing import Floats, Ints
from modefront.fem.sensors import pick


@dataclass(frozen=True, eq=False)
class SensorNodes:
    """Displacements of all nodes from the degrees of freedom, and where the sensors are.

    Attributes
    ----------
    T : (6 nodes, N) displacement 6 node + direction, in x, y, z, rx, ry, rz
    node : (sensors,) nodes of the sensors, rows of T over 6
    direction : (sensors, 6) unit vectors along which they measure
    position : (sensors, 3) coordinates; None where they are not known
    """

    T: scipy.sparse.csr_array
    node: Ints
    direction: Floats
    position: Floats | None = None

    @property
    def count(self) -> int:
        """Number of nodes."""
        return int(self.T.shape[0]) // 6

    def selection(self, node: Ints, direction: Floats) -> scipy.sparse.csr_array:
        """Return the weights (sensors, N) of sensors at other nodes or along other directions."""
        return pick(node, direction, self.T)
