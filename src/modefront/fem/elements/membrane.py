"""Membrane part of shells: triangles with curved sides and a drilling rotation at every node.

The triangle is that of C. A. Felippa, doi:10.1016/S0045-7825(03)00253-6, exact in pure bending in
its plane for any aspect ratio, with two free parameters,

    K = A B^T D B + 3/4 beta T^T K_theta T,   B = L^T / A,

L with alpha. Any alpha and beta > 0 pass the patch test; alpha = 3/2, beta = (1 - 4 nu^2) / 2 are
optimal in a plane. On curved shells the terms of the drilling rotations resist bending without
stretch, the more the coarser the elements; alpha and T are multiplied by

    f = 1 / (1 + (c / t)^2),   c = max |(d_j - d_i) . e|,   e = x_j - x_i,

which leaves of that a share of the bending stiffness that is small for small and great c / t.

A side that is a chord of the shell stretches where the shell only bends: the side between two
directors is taken as the shallow cubic with the slopes a = -d . s at its ends, s = e / |e|,

    eps = s . (u_j - u_i) / |e| + (a_i (4 da_i - da_j) + a_j (4 da_j - da_i)) / 30,

with da = -(v . s + d . (u_j - u_i)_across / |e|), the change of slope beside that of the chord (K.
Marguerre 1938). The strains of the three sides beyond those of the chords are added to B.
"""

import numpy as np

from modefront._typing import Floats
from modefront.fem.elements.common import Ply
from modefront.fem.elements.plate import Elements, Rows

DISTORTIONS = [np.roll([[1.0, 2, 1], [0, 1, -1], [-1, -1, -2]], (n, n), (0, 1)) for n in range(3)]
"""Natural strains at the corners by hierarchical rotations, with Felippa's optimal parameters."""


def membrane(each: Elements, t: float, material: Ply) -> Rows:
    """Return rows of strains and of drilling rotations, per thickness."""
    D = material.turned(each.m[:, :2])
    rise = [abs(e @ (each.d[:, j] - each.d[:, i])[..., None]) for i, j, e in each.sides()]
    share = 1 / (1 + (np.max(rise, axis=0) / t) ** 2)[:, 0, 0]
    in_plane = np.stack([each.U[:, :, 0], each.U[:, :, 1], each.theta], 2)
    in_plane = in_plane.reshape(len(share), 9, -1)
    # In Felippa's notation x_ij = x_i - x_j; node k of the cyclic triple (i, j, k).
    X, Y = np.moveaxis(each.x[:, :, None, :2] - each.x[:, None, :, :2], -1, 0)
    twice_A = X[:, 1, 0] * Y[:, 2, 0] - X[:, 2, 0] * Y[:, 1, 0]
    B = basic_strain(X, Y, 1.5 * share) / twice_A[:, None, None] @ in_plane + curved_sides(each)
    T, K_theta = higher_stiffness(X, Y, twice_A / 2, D)
    nu2 = material.D[0, 1] ** 2 / material.D[0, 0] / material.D[1, 1]
    beta = 0.75 * max((1 - 4 * nu2) / 2, 0.01)
    weights = np.stack([D, beta * K_theta], 1)
    rotations = share[:, None, None] * (T @ in_plane)
    return each.integrand(np.stack([B, rotations], 1), 2 * weights)


def curved_sides(each: Elements) -> Floats:
    """Return the strains (elements, 3, n) of curved sides beyond those of their chords."""
    strains, natural = [], []
    for i, j, e in each.sides():
        L = np.linalg.norm(e, axis=2, keepdims=True)
        s = e / L
        a, da = [], []
        for n in (i, j):
            d = each.d[:, n, None]
            a.append(-(d * s).sum(2))
            across = (d + a[-1][..., None] * s) / L
            da.append(-(s @ each.V[:, n] + across @ (each.U[:, j] - each.U[:, i]))[:, 0])
        strains.append((a[0] * (4 * da[0] - da[1]) + a[1] * (4 * da[1] - da[0])) / 30)
        x, y = s[:, 0, 0], s[:, 0, 1]
        natural.append(np.stack([x**2, y**2, x * y], 1))
    return np.asarray(np.linalg.solve(np.stack(natural, 1), np.stack(strains, 1)))


def basic_strain(X: Floats, Y: Floats, alpha: Floats) -> Floats:
    """Return 2 A B (elements, 3, 9) with alpha (elements,), DOFs u, v, theta node by node."""
    L = np.zeros((len(X), 3, 3, 3))
    for n in range(3):
        j, k = (n + 1) % 3, (n + 2) % 3
        y_jk, x_kj = Y[:, j, k], X[:, k, j]
        L[:, 0, n, 0] = L[:, 2, n, 1] = y_jk
        L[:, 1, n, 1] = L[:, 2, n, 0] = x_kj
        L[:, 0, n, 2] = alpha / 6 * y_jk * (Y[:, n, k] - Y[:, j, n])
        L[:, 1, n, 2] = alpha / 6 * x_kj * (X[:, k, n] - X[:, n, j])
        L[:, 2, n, 2] = alpha / 3 * (X[:, k, n] * Y[:, n, k] - X[:, n, j] * Y[:, j, n])
    return L.reshape(-1, 3, 9)


def higher_stiffness(X: Floats, Y: Floats, area: Floats, D: Floats) -> tuple[Floats, Floats]:
    """Return T (elements, 3, 9), DOFs u, v, theta node by node, and K_theta (elements, 3, 3)."""
    A = area[:, None, None]
    l2 = np.stack([X[:, i, j] ** 2 + Y[:, i, j] ** 2 for i, j in ((1, 0), (2, 1), (0, 2))], -1)
    T = np.zeros((len(X), 3, 9))
    T_e = np.zeros((len(X), 3, 3))
    for n in range(3):
        j, k = (n + 1) % 3, (n + 2) % 3
        T[:, :, 3 * n] = X[:, k, j, None] / (4 * A[..., 0])
        T[:, :, 3 * n + 1] = Y[:, k, j, None] / (4 * A[..., 0])
        T[:, n, 3 * n + 2] = 1
        # Side n joins n and j; its natural strain in terms of the other two sides.
        T_e[:, 0, n] = Y[:, j, k] * Y[:, n, k] * l2[:, n]
        T_e[:, 1, n] = X[:, j, k] * X[:, n, k] * l2[:, n]
        T_e[:, 2, n] = (Y[:, j, k] * X[:, k, n] + X[:, k, j] * Y[:, n, k]) * l2[:, n]
    T_e /= 4 * A**2
    D_natural = np.swapaxes(T_e, 1, 2) @ D @ T_e
    K_theta = np.zeros((len(X), 3, 3))
    for n in range(3):
        Q = (DISTORTIONS[n] + DISTORTIONS[(n + 1) % 3]) / 3 * A / l2[:, :, None]
        K_theta += np.swapaxes(Q, 1, 2) @ D_natural @ Q
    return T, K_theta
