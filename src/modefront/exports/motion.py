"""Motion of the nodes of a program's model from its degrees of freedom."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats, Ints
from modefront.models.dofs import DofTable, motion_of_nodes
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
    number = np.unique(dofs.node[dofs.node > 0]) if mesh is None else mesh.number
    values = np.asarray(motion_of_nodes(dofs, number) @ shapes).T.reshape(-1, number.size, 6)
    turns = (dofs.direction > 3) & np.isin(dofs.node, number)
    return NodeMotion(number, values, bool(turns.any()))
