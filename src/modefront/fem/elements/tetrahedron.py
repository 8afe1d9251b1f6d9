r"""Tetrahedron of 10 nodes: complete quadratic displacements, straight or curved edges.

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
    solid_mass,
    solid_stiffness,
)
from modefront.fem.elements.shapes import (
    TETRAHEDRON_EDGES,
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
