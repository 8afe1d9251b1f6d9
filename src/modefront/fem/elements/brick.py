r"""Brick of 8 nodes with incompatible modes.

To the trilinear displacements come the modes 1 - xi^2, 1 - eta^2, 1 - zeta^2 in each
direction, so that one brick through the thickness bends without parasitic shear. Their
gradients are taken with the Jacobian J0 of the centre times det J0 / det J; they then have no
mean over the element, constant stresses do no work on them, and the patch test holds on any
mesh. Their nine amplitudes are condensed out. Sources: E. L. Wilson et al., 1973;
R. L. Taylor, P. J. Beresford, E. L. Wilson, doi:10.1002/nme.1620100602.

========  =====================================================
symbol    meaning
========  =====================================================
X         nodes (elements, 8, 3), VTK order
g         gradients (elements, points, 3, 8 + 3 modes)
========  =====================================================

Tetrahedron of 10 nodes: complete quadratic displacements, straight or curved edges.

The stiffness is integrated by the four-point rule of degree 2, which is exact for
straight edges; the mass, of degree 4, by a rule of degree 5. Constant and linear strains are
exact on straight-edged elements. The 4-node tetrahedron is left out on purpose: it is many
times too stiff in bending. Source: O. C. Zienkiewicz, R. L. Taylor, "The Finite Element
Method", vol. 1.

========  =====================================================
symbol    meaning
========  =====================================================
X         nodes (elements, 10, 3), VTK order: corners, then the
          midpoints of 01, 12, 20, 03, 13, 23
========  =====================================================
"""

from __future__ import annotations

import numpy as np

from modefront._typing import Floats
from modefront.fem.elements.common import (
    ElementMatrices,
    Part,
    condense,
    solid_mass,
    solid_stiffness,
)
from modefront.fem.elements.shapes import (
    TETRAHEDRON_EDGES,
    cube_8,
    gauss_box,
    gauss_simplex,
    gauss_tetrahedron_4,
    gradients,
    jacobian,
    simplex_quadratic,
)
from modefront.fem.section import Material


def tetrahedron(X: Floats, material: Material) -> ElementMatrices:
    """Matrices of tetrahedra X (elements, 10, 3), DOFs u node by node in global axes."""
    xi, w = gauss_tetrahedron_4()
    g, det = gradients(X, simplex_quadratic(xi, TETRAHEDRON_EDGES)[1])
    K = solid_stiffness(g, det * w, material.E, material.nu)
    xi, w = gauss_simplex(3, 3)
    N, dN = simplex_quadratic(xi, TETRAHEDRON_EDGES)
    weight = np.linalg.det(jacobian(X, dN)) * w
    return ElementMatrices((Part(0, K),), (Part(0, material.rho * solid_mass(N, weight)),))


def brick(X: Floats, material: Material) -> ElementMatrices:
    """Matrices of bricks X (elements, 8, 3), DOFs u node by node in global axes."""
    xi, w = gauss_box(2, 3)
    g, det = gradients(X, cube_8(xi)[1])
    J0 = jacobian(X, cube_8(np.zeros((1, 3)))[1])
    g_modes = np.linalg.inv(J0) @ (-2 * xi[:, :, None] * np.eye(3))
    g_modes = g_modes * (np.linalg.det(J0) / det)[..., None, None]
    K = solid_stiffness(np.concatenate([g, g_modes], -1), det * w, material.E, material.nu)
    xi, w = gauss_box(3, 3)
    N, dN = cube_8(xi)
    weight = np.linalg.det(jacobian(X, dN)) * w
    return ElementMatrices(
        (Part(0, condense(K, 24)),), (Part(0, material.rho * solid_mass(N, weight)),)
    )
