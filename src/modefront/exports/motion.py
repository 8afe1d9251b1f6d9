"""Motion of the nodes of a program's model from its degrees of freedom."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse

from modefront._typing import Floats, Ints
from modefront.models.dofs import DofTable
from modefront.programs.mesh import ProgramMesh


@dataclass(frozen=True, eq=False)
class NodeMotion:
    """Nodes and their motion in several modes.

    Attributes
    ----------
    number : (nodes,) numbers of the nodes
    values : (modes, nodes, 6) displacements x, y, z and rotations; 0 where a node cannot move
    turns : whether any node has rotations
    """

    number: Ints
    values: Floats
    turns: bool


def node_motion(dofs: DofTable, mesh: ProgramMesh | None, shapes: Floats) -> NodeMotion:
    """Return the motion of all nodes of a mesh (those of ``dofs`` without one) in shapes (N, m)."""
    part = (dofs.node > 0) & (dofs.direction >= 1) & (dofs.direction <= 6)
    number = np.unique(dofs.node[part]) if mesh is None else mesh.number
    part &= np.isin(dofs.node, number)
    chosen = np.flatnonzero(part)
    row = 6 * np.searchsorted(number, dofs.node[chosen]) + dofs.direction[chosen] - 1
    weights = scipy.sparse.csr_array(
        (dofs.weight[chosen], (row, chosen)), shape=(6 * number.size, dofs.size)
    )
    values = np.asarray(weights @ shapes).T.reshape(-1, number.size, 6)
    return NodeMotion(number, values, bool((dofs.direction[chosen] > 3).any()))
