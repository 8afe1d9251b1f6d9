r"""Membrane parts of flat shells, with a drilling rotation at every node.

Quadrilateral: bilinear displacements u, four incompatible modes and a bilinear rotation
theta that follows the rotation of the body,

    Pi = 1/2 int eps^T D eps dA + 1/2 G int (theta - omega(u))^2 dA,
    omega = (v,x - u,y) / 2.

Both integrals see the incompatible modes 1 - xi^2 and 1 - eta^2 (so a rectangle in pure
bending is exact and its rotation free of a penalty); their gradients are taken with the
Jacobian J0 of the centre, scaled by det J0 / det J, and so have no mean: the patch test holds
on any mesh. The modes are condensed out. Sources: R. L. Taylor, P. J. Beresford,
E. L. Wilson, doi:10.1002/nme.1620100602; T. J. R. Hughes, F. Brezzi,
doi:10.1016/0045-7825(89)90124-2.

Triangle: the optimal triangle of the ANDES family, which is exact in pure bending for any
aspect ratio: K = L D L^T / A + 3/4 beta0 T^T K_theta T with the free parameters of
C. A. Felippa, doi:10.1016/S0045-7825(03)00253-6 (the "OPT" instance).

========  ===================================================
symbol    meaning
========  ===================================================
x         corners in the plane, (elements, 3 or 4, 2)
D         plane stress (3, 3)
K         per unit thickness; DOFs u, v, theta node by node
========  ===================================================
"""

from __future__ import annotations

import numpy as np

from modefront._typing import Floats
from modefront.fem.elements.common import condense, plane_stress, symmetric
from modefront.fem.elements.shapes import SQUARE_4, gauss_box, gradients, jacobian


def quadrilateral(x: Floats, E: float, nu: float) -> Floats:
    """Stiffness (elements, 12, 12) per unit thickness of quadrilaterals x (elements, 4, 2)."""
    xi, w = gauss_box(2, 2)
    N, dN = SQUARE_4.shape(xi)
    g, det = gradients(x, dN)
    J0 = jacobian(x, SQUARE_4.shape(np.zeros((1, 2)))[1])
    bubbles = np.zeros((len(xi), 2, 2))
    bubbles[:, [0, 1], [0, 1]] = -2 * xi
    g_modes = np.linalg.solve(J0, np.swapaxes(bubbles, 1, 2)[None])
    g_modes = g_modes * (np.linalg.det(J0) / det)[..., None, None]

    S = np.zeros((*det.shape, 4, 16))
    for u, gradient in ((S[..., 0:12:3], g), (S[..., 12:16:2], g_modes)):
        u[..., 0, :], u[..., 2, :], u[..., 3, :] = (
            gradient[..., 0, :],
            gradient[..., 1, :],
            gradient[..., 1, :] / 2,
        )
    for v, gradient in ((S[..., 1:12:3], g), (S[..., 13:16:2], g_modes)):
        v[..., 1, :], v[..., 2, :], v[..., 3, :] = (
            gradient[..., 1, :],
            gradient[..., 0, :],
            -gradient[..., 0, :] / 2,
        )
    S[..., 3, 2:12:3] = N
    D = np.zeros((4, 4))
    D[:3, :3] = plane_stress(E, nu)
    D[3, 3] = E / (2 * (1 + nu))
    DS = (D @ S) * (det * w)[..., None, None]
    count = len(x)
    return condense(np.swapaxes(S.reshape(count, -1, 16), 1, 2) @ DS.reshape(count, -1, 16), 12)


def triangle(x: Floats, E: float, nu: float) -> Floats:
    """Stiffness (elements, 9, 9) per unit thickness of triangles x (elements, 3, 2)."""
    D = plane_stress(E, nu)
    count = len(x)
    # In Felippa's notation x_ij = x_i - x_j; node k of the cyclic triple (i, j, k).
    d = x[:, :, None] - x[:, None]
    X, Y = d[..., 0], d[..., 1]
    A = (X[:, 1, 0] * Y[:, 2, 0] - X[:, 2, 0] * Y[:, 1, 0]) / 2
    l2 = np.stack([(d[:, i, j] ** 2).sum(-1) for i, j in ((1, 0), (2, 1), (0, 2))], -1)

    alpha = 1.5
    L = np.zeros((count, 3, 3, 3))
    for n in range(3):
        j, k = (n + 1) % 3, (n + 2) % 3
        y_jk, x_kj = Y[:, j, k], X[:, k, j]
        L[:, n, 0, 0] = L[:, n, 1, 2] = y_jk
        L[:, n, 1, 1] = L[:, n, 0, 2] = x_kj
        L[:, n, 2, 0] = alpha / 6 * y_jk * (Y[:, n, k] - Y[:, j, n])
        L[:, n, 2, 1] = alpha / 6 * x_kj * (X[:, k, n] - X[:, n, j])
        L[:, n, 2, 2] = alpha / 3 * (X[:, k, n] * Y[:, n, k] - X[:, n, j] * Y[:, j, n])
    L = L.reshape(count, 9, 3) / 2
    K_basic = L @ D @ np.swapaxes(L, 1, 2) / A[:, None, None]

    T = np.zeros((count, 3, 9))
    for n in range(3):
        j, k = (n + 1) % 3, (n + 2) % 3
        T[:, :, 3 * n] = (X[:, k, j] / (4 * A))[:, None]
        T[:, :, 3 * n + 1] = (Y[:, k, j] / (4 * A))[:, None]
        T[:, n, 3 * n + 2] = 1
    T_e = np.zeros((count, 3, 3))
    for m, (i, j, k) in enumerate(((0, 1, 2), (1, 2, 0), (2, 0, 1))):
        # Side m joins i and j; its natural strain in terms of the other two sides.
        T_e[:, 0, m] = Y[:, j, k] * Y[:, i, k] * l2[:, m]
        T_e[:, 1, m] = X[:, j, k] * X[:, i, k] * l2[:, m]
        T_e[:, 2, m] = (Y[:, j, k] * X[:, k, i] + X[:, k, j] * Y[:, i, k]) * l2[:, m]
    T_e /= (4 * A**2)[:, None, None]
    D_natural = np.swapaxes(T_e, 1, 2) @ D @ T_e
    b = np.array([[1.0, 2, 1], [0, 1, -1], [-1, -1, -2]])
    corner = [np.roll(b, (n, n), (0, 1)) for n in range(3)]
    K_theta = np.zeros((count, 3, 3))
    for n in range(3):
        Q = (corner[n] + corner[(n + 1) % 3]) / 2 * (2 * A[:, None, None] / 3) / l2[:, :, None]
        K_theta += np.swapaxes(Q, 1, 2) @ D_natural @ Q
    K_theta *= A[:, None, None]
    beta0 = max((1 - 4 * nu**2) / 2, 0.01)
    return symmetric(K_basic + 0.75 * beta0 * np.swapaxes(T, 1, 2) @ K_theta @ T)
