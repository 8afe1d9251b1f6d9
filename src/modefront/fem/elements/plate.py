r"""Bending parts of flat shells: discrete Kirchhoff triangle and quadrilateral.

The slopes beta = -grad w are quadratic on the element. Their corner values are the nodal
rotations, beta = (r_y, -r_x); at the midpoint of the side e = x_j - x_i the normal slope is
the mean of the ends and the tangential one that of a cubic w:

    beta_mid = b - 3/2 e / |e|^2 (e . b + w_j - w_i),    b = (beta_i + beta_j) / 2.

Transverse shear is zero by construction, so nothing can lock, and beta is continuous, so a
constant curvature is exact on any mesh. K = t^3 int kappa^T D/12 kappa dA. Sources:
J. L. Batoz, K. J. Bathe, L. W. Ho, doi:10.1002/nme.1620151205; J. L. Batoz, M. Ben Tahar,
doi:10.1002/nme.1620181106.

The mass of w needs w inside. Each side carries its cubic, blended into the element,

    w = sum N_i w_i + sum_sides f (A + B s),   A = (a_i - a_j) / 4,
    B = (w_j - w_i - a_i - a_j) / 4,   a = grad w . e / 2,

with s from -1 to 1 along the side and f = 1 - s^2 there, zero on the other sides. The error
of a frequency then is that of the stiffness; with bilinear w alone it is (k h)^2 / 12 more in
each direction. Rotary inertia takes the slopes as linear between the nodes.

========  ==========================================================
symbol    meaning
========  ==========================================================
x         corners in the plane, (elements, 3 or 4, 2)
kappa     (beta_x,x, beta_y,y, beta_x,y + beta_y,x)
K, M      DOFs w, r_x, r_y node by node
========  ==========================================================
"""

from __future__ import annotations

import numpy as np

from modefront._typing import Floats
from modefront.fem.elements.common import plane_stress, symmetric
from modefront.fem.elements.shapes import (
    SQUARE_4,
    SQUARE_8,
    SQUARE_EDGES,
    TRIANGLE_3,
    TRIANGLE_6,
    TRIANGLE_EDGES,
    gauss_box,
    gauss_simplex,
    gradients,
    jacobian,
)


def slopes(x: Floats) -> Floats:
    """Map (elements, 2 corners, 2, 3 corners) from DOFs to beta at corners and midpoints."""
    count, corners = x.shape[:2]
    H = np.zeros((count, 2 * corners, 2, 3 * corners))
    n = np.arange(corners)
    H[:, n, 0, 3 * n + 2] = 1
    H[:, n, 1, 3 * n + 1] = -1
    for i in range(corners):
        j = (i + 1) % corners
        e = x[:, j] - x[:, i]
        mean = (H[:, i] + H[:, j]) / 2
        gap = np.einsum("ed,edk->ek", e, mean)
        gap[:, 3 * j] += 1
        gap[:, 3 * i] -= 1
        scale = 1.5 * e / (e**2).sum(-1, keepdims=True)
        H[:, corners + i] = mean - scale[:, :, None] * gap[:, None, :]
    return H


def bending(x: Floats, E: float, nu: float) -> Floats:
    """Stiffness (elements, 3 corners, 3 corners) per thickness cubed."""
    count, corners = x.shape[:2]
    if corners == 3:
        xi, w = gauss_simplex(2, 2)
        dN, dN_slopes = TRIANGLE_3.shape(xi)[1], TRIANGLE_6.shape(xi)[1]
    else:
        xi, w = gauss_box(2, 2)
        dN, dN_slopes = SQUARE_4.shape(xi)[1], SQUARE_8.shape(xi)[1]
    J = jacobian(x, dN)
    weight = w * np.linalg.det(J)
    g = np.linalg.solve(J, np.swapaxes(dN_slopes, 1, 2)[None])
    H = slopes(x)
    flat = H.reshape(count, 2 * corners, -1)
    d = (g.reshape(count, -1, 2 * corners) @ flat).reshape(count, len(w), 2, 2, 3 * corners)
    kappa = np.stack([d[:, :, 0, 0], d[:, :, 1, 1], d[:, :, 1, 0] + d[:, :, 0, 1]], 2)
    moment = (plane_stress(E, nu) / 12 @ kappa) * weight[..., None, None]
    kappa = kappa.reshape(count, -1, 3 * corners)
    return symmetric(np.swapaxes(kappa, 1, 2) @ moment.reshape(kappa.shape))


def deflection(x: Floats, xi: Floats) -> Floats:
    """Interpolation of w (elements, points, 3 corners) at the reference points xi."""
    count, corners = x.shape[:2]
    if corners == 3:
        N = TRIANGLE_3.shape(xi)[0]
        sides = [(4 * N[:, i] * N[:, j], N[:, j] - N[:, i]) for i, j in TRIANGLE_EDGES]
    else:
        N = SQUARE_4.shape(xi)[0]
        u, v = xi.T
        sides = [
            ((1 - u**2) * (1 - v) / 2, u),
            ((1 - v**2) * (1 + u) / 2, v),
            ((1 - u**2) * (1 + v) / 2, -u),
            ((1 - v**2) * (1 - u) / 2, -v),
        ]
    W = np.zeros((count, len(xi), 3 * corners))
    W[:, :, ::3] = N
    for (f, s), (i, j) in zip(sides, TRIANGLE_EDGES if corners == 3 else SQUARE_EDGES, strict=True):
        e = x[:, None, j] - x[:, None, i]
        for node, sign, w_sign in ((i, 1, -1), (j, -1, 1)):
            # grad w = (-r_y, r_x) at the node; a = grad w . e / 2.
            factor = f * (sign - s) / 8
            W[:, :, 3 * node] += w_sign * f * s / 4
            W[:, :, 3 * node + 1] += factor * e[..., 1]
            W[:, :, 3 * node + 2] -= factor * e[..., 0]
    return W


def translational(x: Floats) -> Floats:
    """Mass (elements, 3 corners, 3 corners) of w per density and thickness."""
    xi, w = gauss_simplex(4, 2) if x.shape[1] == 3 else gauss_box(4, 2)
    dN = (TRIANGLE_3 if x.shape[1] == 3 else SQUARE_4).shape(xi)[1]
    weight = w * np.linalg.det(jacobian(x, dN))
    W = deflection(x, xi)
    return symmetric(np.swapaxes(W, 1, 2) @ (W * weight[..., None]))


def linear_mass(x: Floats) -> Floats:
    """Integrals of N_i N_j (elements, corners, corners) for the linear shape functions."""
    xi, w = gauss_simplex(2, 2) if x.shape[1] == 3 else gauss_box(3, 2)
    N, dN = (TRIANGLE_3 if x.shape[1] == 3 else SQUARE_4).shape(xi)
    weight = w * gradients(x, dN)[1]
    return np.asarray(np.einsum("eg,gi,gj->eij", weight, N, N, optimize=True))
