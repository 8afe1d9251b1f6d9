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

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.fem.elements import common, shapes


@dataclass(frozen=True)
class Solid:
    """Kind of solid: cell, its corners, and quadratures that are exact for straight edges."""

    cell: shapes.Cell
    corners: int  # the first of its nodes
    stiffness: shapes.Rule
    mass: shapes.Rule


SOLIDS = {  # by their number of nodes
    8: Solid(shapes.CUBE_8, 8, shapes.gauss_box(2, 3), shapes.gauss_box(3, 3)),
    10: Solid(shapes.TETRAHEDRON_10, 4, shapes.gauss_tetrahedron_4(), shapes.gauss_simplex(3, 3)),
    15: Solid(shapes.WEDGE_15, 6, shapes.gauss_wedge(3), shapes.gauss_wedge(3)),
    20: Solid(shapes.CUBE_20, 8, shapes.gauss_box(3, 3), shapes.gauss_box(3, 3)),
}


def solid(X: Floats, rho: float, C: Floats) -> common.Matrices:
    """Matrices of solids X (elements, nodes, 3), DOFs u node by node in global axes.

    C is `modefront.fem.elements.common.elasticity`. From the energy C_ijkl u_i,j u_k,l / 2 with
    gradients g of the shape functions,

        K_(ai)(bk) = C_ijkl int g_aj g_bl dV.
    """
    kind, size = SOLIDS[X.shape[1]], 3 * X.shape[1]
    xi, w = kind.stiffness
    g, det = shapes.gradients(X, kind.cell.shape(xi)[1])
    if kind.cell is shapes.CUBE_8:
        J0 = shapes.jacobian(X, shapes.CUBE_8.shape(np.zeros((1, 3)))[1])
        g_modes = np.linalg.inv(J0) @ (-2 * xi[:, :, None] * np.eye(3))
        g = np.concatenate([g, g_modes * (np.linalg.det(J0) / det)[..., None, None]], -1)
    count, points, _, n = g.shape
    flat = np.swapaxes(g, 2, 3).reshape(count, points, 3 * n)
    P = np.swapaxes(flat, 1, 2) @ (flat * (det * w)[..., None])
    P = P.reshape(count, n, 3, n, 3).transpose(0, 1, 3, 2, 4).reshape(-1, 9)
    K = (P @ C.transpose(1, 3, 0, 2).reshape(9, 9)).reshape(count, n, n, 3, 3)
    K = common.symmetric(K.transpose(0, 1, 3, 2, 4).reshape(count, 3 * n, 3 * n))
    if 3 * n > size:  # the amplitudes of the modes are condensed out
        within = K[:, :size, size:] @ np.linalg.solve(K[:, size:, size:], K[:, size:, :size])
        K = common.symmetric(K[:, :size, :size] - within)
    xi, w = kind.mass
    N, dN = kind.cell.shape(xi)
    weight = np.linalg.det(shapes.jacobian(X, dN)) * w
    products = (N[:, :, None] * N[:, None, :]).reshape(len(N), -1)
    m = common.symmetric((weight @ products).reshape(count, X.shape[1], -1))
    M = rho * np.einsum("enm,ij->enimj", m, np.eye(3)).reshape(count, size, size)
    return {0: K}, {0: M}


def solid_stresses(X: Floats, C: Floats) -> common.Stresses:
    """Return the stresses of solids X (elements, nodes, 3) of the elasticity C."""
    kind, nodes = SOLIDS[X.shape[1]], X.shape[1]
    P = np.eye(3 * nodes).reshape(1, nodes, 3, -1)
    return common.Stresses(X, np.eye(3)[None], C[None], P, kind.cell, kind.stiffness)
