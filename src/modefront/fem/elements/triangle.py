r"""Triangles of shells, from displacements and directors at their corners.

**Bending, shear and mass.** A point at z along the director d moves by u + z v, v = omega x d. In
the plane of a triangle,

    kappa = sym(grad v + grad d . grad u),   gamma = v + d . grad u,

do not see rigid motions, and v bends more than linearly along the sides e, s = e / |e|:

    v = sum N_a v_a + sum_sides 4 N_i N_j c s,   gamma_k = d . (u_j - u_i) / |e| + s . v + 2/3 c

with means of the ends for d and v. Of gamma_0, which is gamma_k without c, c takes the share that
bends and twists rather than shears,

    c = -3/2 gamma_0 / (1 + phi),   phi = 12 (D / |e|^2 + G t^3 / 12 / b^2) / (kappa_s G t),

with the bending stiffness D over the length of the side, the twisting stiffness over the breadth b
across it, the area of an element over the side, and kappa_s = 5/6: without the second, that is the
exact beam. Elements with a side in common have the same c there, which the patch test needs.
gamma_k = gamma_0 phi / (1 + phi) then vanishes in thin shells, where triangles are those of
discrete Kirchhoff constraints, and nothing can lock. Inside, the sides' gamma is interpolated by

    gamma = sum_sides gamma_k |e| (N_i grad N_j - N_j grad N_i) + grad sum_sides q_k 4 N_i N_j,

where deflections q of the sides make the energy of gamma - mean(gamma) least: without them, a
shear that changes across a narrow triangle brings one that changes along it. They are zero where
gamma is constant, as the patch test needs. Where the thickness t is tau times the nominal one, the
share 1 / (1 + phi tau^2) of c is taken as

    (1 + phi (3 - 2 tau)) / (1 + phi)^2,

which has its value and slope at tau = 1 and is between -1/8 and 9/8 up to tau = 2: the rows of
bending and shear are linear in tau, and K = t K_shear + t^3 K_bending has powers of t up to 5.
Sources: J. L. Batoz, K. J. Bathe, L. W. Ho, doi:10.1002/nme.1620151205; I. Katili,
doi:10.1002/nme.1620361107; P. S. Lee, K. J. Bathe, doi:10.1016/j.compstruc.2003.11.005.

The mass has the bows 4 N_i N_j e . (v_j - v_i) / 8 of the sides beside linear deflections. The
error of a frequency then is that of the stiffness; with linear deflections alone it is (k h)^2 / 12
more. Rotary inertia has linear v.

**Membrane**, with curved sides and a drilling rotation at every node. The triangle is that of C. A.
Felippa, doi:10.1016/S0045-7825(03)00253-6, exact in pure bending in its plane for any aspect ratio,
with two free parameters,

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

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import block_diag

from modefront._typing import Floats
from modefront.fem.elements.common import Ply
from modefront.fem.elements.shapes import TRIANGLE_3, TRIANGLE_6, TRIANGLE_EDGES, gauss_simplex

KAPPA = 5 / 6  # shear factor of a plate

MIDDLES = TRIANGLE_6.nodes[3:]  # of sides: with equal weights, a quadrature rule of degree 2

_POINTS, _WEIGHTS = gauss_simplex(3, 2)
_N = np.concatenate([TRIANGLE_3.shape(_POINTS)[0], TRIANGLE_6.shape(_POINTS)[0][:, 3:]], 1)
_MEAN = 2 * (_N * _WEIGHTS[:, None]).T @ _N
TRANSLATION = block_diag(_MEAN[:3, :3], _MEAN[:3, :3], _MEAN)
ROTARY = block_diag(*[_MEAN[:3, :3]] * 3) / 12
"""Means of products of linear functions and bows in u, and in v over 12."""

Rows = tuple[Floats, Floats]  # B (elements, points, rows, n), D (.., rows, rows) of B^T D B


@dataclass(frozen=True)
class Elements:
    """Shells, with rows of what happens at their corners, by n DOFs."""

    x: Floats  # corners (elements, corners, 3), counter-clockwise
    d: Floats  # directors (elements, corners, 3)
    U: Floats  # U, V: displacements, and increments of the directors (elements, corners, 3, n)
    V: Floats
    theta: Floats  # rotations about the local third axis (elements, corners, n)
    narrow: Floats  # 1 / b^2 of each side, from a corner to the next one (elements, corners)
    m: Floats  # axis 1 of the material (elements, 3), not across the shell
    share: float | Floats  # factor on all integrals, one or (elements, 1)
    varied: bool  # whether the thickness is a parameter

    @cached_property
    def J(self) -> Floats:
        """Jacobian (elements, 1, 2, 2) in the plane of the first two axes."""
        return (self.x[:, 1:, :2] - self.x[:, :1, :2])[:, None]

    def integrand(self, B: Floats, D: Floats) -> Rows:
        """Return B (elements, points, rows, n), and D times weights, the same at all points."""
        weight = self.share * np.linalg.det(self.J) / 2 / B.shape[1]
        return B, np.repeat(weight, B.shape[1], axis=1)[..., None, None] * D

    def sides(self) -> Iterator[tuple[int, int, Floats]]:
        """Ends i and j, and e (elements, 1, 3), of each side."""
        for i, j in TRIANGLE_EDGES:
            yield i, j, (self.x[:, j] - self.x[:, i])[:, None]

    def sheared(self, t: float, material: Ply) -> Iterator[tuple[int, int, Floats, Floats, Floats]]:
        """Ends i and j, e, and gamma_0 times its length, as what bends and what shears, of sides.

        Both have columns (elements, n), and n more per tau where the thickness varies.
        """
        for i, j, e in self.sides():
            L2 = (e**2).sum(2)
            d = self.d[:, i] + self.d[:, j]
            m = self.m - ((self.m * d).sum(1) / (d * d).sum(1))[:, None] * d
            c2 = (e[:, 0] * m).sum(1, keepdims=True) ** 2 / L2 / (m * m).sum(1, keepdims=True)
            bend, twist, across = material.along(c2)
            rise = (self.d[:, i] + self.d[:, j])[:, None] / 2 @ (self.U[:, j] - self.U[:, i])
            gamma = (rise + e @ (self.V[:, i] + self.V[:, j]) / 2)[:, 0]
            phi = t**2 / KAPPA / across * (bend / L2 + twist * self.narrow[:, i, None])
            bends, rows = gamma / (1 + phi), gamma
            if self.varied:
                bends = np.concatenate([(1 + 3 * phi) * bends, -2 * phi * bends], 1) / (1 + phi)
                rows = np.pad(gamma, ((0, 0), (0, gamma.shape[1])))
            yield i, j, e, bends, rows - bends


def shear_and_bending(each: Elements, t: float, material: Ply) -> tuple[Rows, Rows]:
    """Return rows of the shear, per thickness, and of the bending, per thickness cubed.

    Where the thickness varies, their columns are those of 1 and of tau.
    """
    count = len(each.x)
    inverse = np.linalg.inv(each.J)
    N, dN = TRIANGLE_3.shape(MIDDLES)
    g = inverse[:, 0] @ dN[0].T
    bows = inverse @ np.swapaxes(TRIANGLE_6.shape(MIDDLES)[1][:, 3:], 1, 2)
    grad_u, grad_v = (
        (g @ rows.reshape(count, 3, -1)).reshape(count, 2, 3, -1) for rows in (each.U, each.V)
    )
    # The gradient of v, and grad d . grad u.
    H = grad_v[:, :, :2] + (g @ each.d)[:, None] @ grad_u
    kappa = np.stack([H[:, 0, 0], H[:, 1, 1], H[:, 0, 1] + H[:, 1, 0]], 1)[:, None]
    if each.varied:
        kappa = np.concatenate([kappa, np.zeros_like(kappa)], -1)
    gamma = np.zeros(())
    for k, (i, j, e, bends, shears) in enumerate(each.sheared(t, material)):
        bulge = np.swapaxes(e, 1, 2)[:, :2] * (-1.5 * bends / (e**2).sum(2))[:, None]
        slope = bows[:, :, :, k, None]
        x, y = slope[:, :, 0] * bulge[:, None, 0], slope[:, :, 1] * bulge[:, None, 1]
        xy = slope[:, :, 0] * bulge[:, None, 1] + slope[:, :, 1] * bulge[:, None, 0]
        kappa = kappa + np.stack([x, y, xy], 2)
        field = N[:, i, None] * g[:, None, :, j] - N[:, j, None] * g[:, None, :, i]
        gamma = gamma + field[..., None] * shears[:, None, None]
    m = each.m[:, :2, None] / np.linalg.norm(each.m[:, :2], axis=1)[:, None, None]
    G = material.G[1] * np.eye(2) + (material.G[0] - material.G[1]) * m @ np.swapaxes(m, 1, 2)
    relief = np.swapaxes(bows - bows.mean(1, keepdims=True), 2, 3) @ G[:, None]
    q = np.linalg.solve((relief @ bows).sum(1), (relief @ gamma).sum(1))
    shear = each.integrand(gamma - bows @ q[:, None], KAPPA * G[:, None])
    return shear, each.integrand(kappa, material.turned(each.m[:, :2])[:, None] / 12)


def mass(each: Elements) -> tuple[Rows, Rows]:
    """Return rows of u per density and thickness, v per density and thickness cubed."""
    bows = [(e @ (each.V[:, j] - each.V[:, i]) / 8)[:, 0] for i, j, e in each.sides()]
    u = np.concatenate([each.U[:, :, 0], each.U[:, :, 1], each.U[:, :, 2], np.stack(bows, 1)], 1)
    v = np.concatenate([each.V[:, :, 0], each.V[:, :, 1], each.V[:, :, 2]], 1)
    return each.integrand(u[:, None], TRANSLATION), each.integrand(v[:, None], ROTARY)


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
