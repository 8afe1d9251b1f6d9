"""Solids: bricks of 8 nodes with incompatible modes, and quadratic ones.

**Bricks of 8 nodes.** To the trilinear displacements come the modes 1 - xi^2, 1 - eta^2,
1 - zeta^2 in each direction, so that one brick through the thickness bends without parasitic
shear. Their gradients are taken with the Jacobian J0 of the centre times det J0 / det J; they then
have no mean over the element, constant stresses do no work on them, and the patch test holds on any
mesh. Their nine amplitudes are condensed out. Sources: E. L. Wilson et al., 1973; R. L. Taylor,
P. J. Beresford, E. L. Wilson, doi:10.1002/nme.1620100602.

**Tetrahedra of 10, wedges of 15 and bricks of 20 nodes** have quadratic displacements, straight or
curved edges, and constant and linear strains exact where edges are straight and their nodes in the
middle. Source: O. C. Zienkiewicz, R. L. Taylor, "The Finite Element Method", vol. 1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.fem.elements.common import ElementMatrices, condense, solid_mass, solid_stiffness
from modefront.fem.elements.shapes import (
    CUBE_8,
    CUBE_20,
    TETRAHEDRON_10,
    WEDGE_15,
    Cell,
    gauss_box,
    gauss_simplex,
    gauss_tetrahedron_4,
    gauss_wedge,
    gradients,
    jacobian,
)

Rule = tuple[Floats, Floats]
QUADS = ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
"""Faces of a brick."""


@dataclass(frozen=True)
class Solid:
    """Kind of solid: its cell, faces (corners) and quadrature (points, weights).

    The rules are exact for straight edges.
    """

    cell: Cell
    faces: tuple[tuple[int, ...], ...]
    stiffness: Rule
    mass: Rule

    @property
    def corners(self) -> int:
        """Number of corners."""
        return 1 + max(max(face) for face in self.faces)


TRIANGLES = ((0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3))
SIDES = ((0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))
"""Faces of a tetrahedron, and of a wedge."""

SOLIDS = {
    8: Solid(CUBE_8, QUADS, gauss_box(2, 3), gauss_box(3, 3)),
    10: Solid(TETRAHEDRON_10, TRIANGLES, gauss_tetrahedron_4(), gauss_simplex(3, 3)),
    15: Solid(WEDGE_15, SIDES, gauss_wedge(3), gauss_wedge(3)),
    20: Solid(CUBE_20, QUADS, gauss_box(3, 3), gauss_box(3, 3)),
}
"""Kinds of solids by their number of nodes."""


def solid(X: Floats, rho: float, C: Floats) -> ElementMatrices:
    """Matrices of solids X (elements, nodes, 3), DOFs u node by node in global axes.

    C is `modefront.fem.elements.common.elasticity`.
    """
    kind, size = SOLIDS[X.shape[1]], 3 * X.shape[1]
    xi, w = kind.stiffness
    g, det = gradients(X, kind.cell.shape(xi)[1])
    if kind.cell is CUBE_8:
        J0 = jacobian(X, CUBE_8.shape(np.zeros((1, 3)))[1])
        g_modes = np.linalg.inv(J0) @ (-2 * xi[:, :, None] * np.eye(3))
        g = np.concatenate([g, g_modes * (np.linalg.det(J0) / det)[..., None, None]], -1)
    K = solid_stiffness(g, det * w, C)
    xi, w = kind.mass
    N, dN = kind.cell.shape(xi)
    M = rho * solid_mass(N, np.linalg.det(jacobian(X, dN)) * w)
    return ElementMatrices({0: condense(K, size) if len(K[0]) > size else K}, {0: M})
