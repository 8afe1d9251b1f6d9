r"""Springs and lumped masses.

Springs of stiffness k store 1/2 k (s q)^2, K = sum k s^T s: with a unit vector a on the
displacements or on the rotations of the nodes, s = (a, -a), or s = (a) to the ground. A mass m with
inertia I about its centre, at offset c from the node, has the energy
1/2 m |u + omega x c|^2 + 1/2 omega^T I omega, with an m for each direction where they differ.
"""

from __future__ import annotations

import numpy as np

from modefront._typing import Floats
from modefront.fem.elements.common import ElementMatrices, Part, cross_matrix, symmetric


def spring(rows: Floats, stiffness: Floats) -> ElementMatrices:
    """Matrices of springs that resist rows (springs, k, n) of displacements, with k stiffnesses."""
    K = np.swapaxes(rows, 1, 2) @ (stiffness[:, None] * rows)
    return ElementMatrices((Part(0, symmetric(K)),), ())


def lumped_mass(m: Floats, inertia: Floats, c: Floats, count: int) -> ElementMatrices:
    """Matrices (count, 6, 6) of equal masses.

    Parameters
    ----------
    m, inertia : masses (3,) along x, y and z, and inertia (3, 3) about the centre, global axes
    c : offset (3,) of the centre from the node
    count : how many
    """
    centre = np.concatenate([np.eye(3), -cross_matrix(c)], 1)
    M = centre.T @ (m[:, None] * centre)
    M[3:, 3:] += inertia
    return ElementMatrices((), (Part(0, np.tile(symmetric(M), (count, 1, 1))),))
