r"""Springs and lumped masses.

A spring of stiffness k stores 1/2 k (a . (q_1 - q_2))^2 with a unit vector a on the
displacements or on the rotations of its nodes: K = k s s^T, s = (a, -a), or s = (a) to the
ground. A mass m with inertia I about its centre, at offset c from the node, has the energy
1/2 m |u + omega x c|^2 + 1/2 omega^T I omega.
"""

from __future__ import annotations

import numpy as np

from modefront._typing import Floats
from modefront.fem.elements.common import ElementMatrices, Part, cross_matrix, symmetric


def spring(axis: Floats, stiffness: float, ends: int) -> ElementMatrices:
    """Matrices (springs, ends d, ends d) of springs along the unit vectors axis (springs, d).

    Parameters
    ----------
    axis : components of one unit vector a spring in the DOFs that it acts on
    stiffness : force per length, or moment per angle
    ends : 1 to the ground, 2 between nodes
    """
    s = np.concatenate([axis, -axis][:ends], axis=1)
    K = stiffness * (s[:, :, None] * s[:, None, :])
    return ElementMatrices((Part(0, K),), ())


def lumped_mass(
    m: float, inertia: Floats, c: Floats, count: int, directions: int
) -> ElementMatrices:
    """Matrices (count, d, d) of equal masses with inertia (3, 3) about their centres.

    Parameters
    ----------
    m, inertia : mass and inertia about the centre, global axes
    c : offset (3,) of the centre from the node
    count : how many
    directions : d: 3 for the displacements only, 6 with the rotations
    """
    C = cross_matrix(c)
    M = np.zeros((6, 6))
    M[:3, :3] = m * np.eye(3)
    M[:3, 3:] = -m * C
    M[3:, :3] = m * C
    M[3:, 3:] = inertia + m * C.T @ C
    M = symmetric(M)[:directions, :directions]
    return ElementMatrices((), (Part(0, np.tile(M, (count, 1, 1))),))
