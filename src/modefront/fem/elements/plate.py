r"""Bending, shear and mass of shells: triangles with directors at their corners.

A point at z along the director d moves by u + z v, v = omega x d. In the plane of the triangle,

    kappa = sym(grad v + grad d . grad u),   gamma = v + d . grad u,

do not see rigid motions, and v bends more than linearly along the sides e, s = e / |e|:

    v = sum N_a v_a + sum_sides 4 N_i N_j c s,   gamma_k = d . (u_j - u_i) / |e| + s . v + 2/3 c

with means of the ends for d and v. Equilibrium of moment and shear force along the side gives c,

    c = -3/2 gamma_0 / (1 + phi),   phi = 2 (t / |e|)^2 / (kappa_s (1 - nu)),   kappa_s = 5/6,

gamma_0 being gamma_k without c; gamma_k = gamma_0 phi / (1 + phi) then vanishes in thin shells,
where the triangle is that of discrete Kirchhoff constraints, and nothing can lock. Inside, gamma is
the field with constant components gamma_k along the sides. phi is that of the nominal thickness: at
others, K(t) = t K_shear + t^3 K_bending is the same element with this share of c. Sources: J. L.
Batoz, K. J. Bathe, L. W. Ho, doi:10.1002/nme.1620151205; I. Katili, doi:10.1002/nme.1620361107.

The mass has the bows 4 N_i N_j e . (v_j - v_i) / 8 of the sides beside linear deflections. The
error of a frequency then is that of the stiffness; with linear deflections alone it is (k h)^2 / 12
more. Rotary inertia has linear v.

========  ============================================================
symbol    meaning
========  ============================================================
x         corners in the plane (elements, 3, 2)
U, V      rows of u and v at each corner, by the DOFs
g         gradients of N (elements, 2, 3)
H         gradient of v and grad d . grad u
========  ============================================================
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import block_diag

from modefront._typing import Floats
from modefront.fem.elements.common import plane_stress
from modefront.fem.elements.shapes import TRIANGLE_3, TRIANGLE_6, TRIANGLE_EDGES, gauss_simplex
from modefront.fem.section import Material

KAPPA = 5 / 6
"""Shear factor of a plate."""

MIDDLES = TRIANGLE_6.nodes[3:]
"""Midpoints of the sides: with equal weights, a quadrature rule of degree 2."""


def _means() -> tuple[Floats, Floats]:
    """Return the means of products of linear functions and bows in u, and in v over 12."""
    xi, w = gauss_simplex(3, 2)
    N = np.concatenate([TRIANGLE_3.shape(xi)[0], TRIANGLE_6.shape(xi)[0][:, 3:]], 1)
    mean = 2 * (N * w[:, None]).T @ N
    linear = mean[:3, :3]
    return block_diag(linear, linear, mean), block_diag(linear, linear, linear) / 12


TRANSLATION, ROTARY = _means()


Rows = tuple[Floats, Floats]
"""Rows B (elements, points, rows, n) and weights D (elements, points, rows, rows) of B^T D B."""


@dataclass(frozen=True)
class Triangles:
    """Triangles in local axes with rows of what happens at their corners, by n DOFs.

    Attributes
    ----------
    x : corners in their plane (elements, 3, 2), counter-clockwise
    d : directors (elements, 3, 3)
    U, V : displacements, and increments of the directors (elements, 3 corners, 3, n)
    theta : drilling rotations (elements, 3 corners, n)
    share : factor on all integrals
    """

    x: Floats
    d: Floats
    U: Floats
    V: Floats
    theta: Floats
    share: float

    @cached_property
    def J(self) -> Floats:
        """Jacobian (elements, 1, 2, 2)."""
        return (self.x[:, 1:] - self.x[:, :1])[:, None]

    def integrand(self, B: Floats, D: Floats) -> Rows:
        """Return B (elements, points, rows, n) and D (elements, points, rows, rows) times weight.

        The weights of the points are equal.
        """
        weight = self.share * np.linalg.det(self.J) / 2 / B.shape[1]
        return B, np.repeat(weight, B.shape[1], axis=1)[..., None, None] * D

    def sides(self) -> Iterator[tuple[int, int, Floats]]:
        """Ends i and j, and e (elements, 1, 3), of each side."""
        for i, j in TRIANGLE_EDGES:
            yield i, j, np.pad(self.x[:, j] - self.x[:, i], ((0, 0), (0, 1)))[:, None]


def bending_and_shear(each: Triangles, t: float, material: Material) -> tuple[Rows, Rows]:
    """Return rows of bending, per thickness cubed, and of shear, per thickness."""
    count, nu = len(each.x), material.nu
    D = plane_stress(material.E, nu)
    N, dN = TRIANGLE_3.shape(MIDDLES)
    inverse = np.linalg.inv(each.J)
    g = inverse[:, 0] @ dN[0].T
    grad_u, grad_v = (
        (g @ rows.reshape(count, 3, -1)).reshape(count, 2, 3, -1) for rows in (each.U, each.V)
    )
    H = grad_v[:, :, :2] + (g @ each.d)[:, None] @ grad_u
    kappa = np.stack([H[:, 0, 0], H[:, 1, 1], H[:, 0, 1] + H[:, 1, 0]], 1)[:, None]
    g_mid = inverse @ np.swapaxes(TRIANGLE_6.shape(MIDDLES)[1][:, 3:], 1, 2)
    bulges, shears, bulge_strains, edges = [], [], [], []
    for k, (i, j, e) in enumerate(each.sides()):
        L2 = (e**2).sum(2)
        rise = (each.d[:, i] + each.d[:, j])[:, None] / 2 @ (each.U[:, j] - each.U[:, i])
        gamma = (rise + e @ (each.V[:, i] + each.V[:, j]) / 2)[:, 0]
        phi = 2 / (KAPPA * (1 - nu)) * t**2 / L2
        bulges.append(-1.5 / (1 + phi) / L2 * gamma)
        shears.append(phi / (1 + phi) * gamma)
        (gx, gy), (ex, ey) = np.moveaxis(g_mid[..., k], 2, 0), np.moveaxis(e[..., :2], 2, 0)
        bulge_strains.append(np.stack([gx * ex, gy * ey, gx * ey + gy * ex], -1))
        edges.append(N[:, i, None] * dN[:, j] - N[:, j, None] * dN[:, i])
    kappa = kappa + np.stack(bulge_strains, -1) @ np.stack(bulges, 1)[:, None]
    gamma = inverse @ np.stack(edges, -1) @ np.stack(shears, 1)[:, None]
    return each.integrand(kappa, D / 12), each.integrand(gamma, KAPPA * D[2, 2] * np.eye(2))


def mass(each: Triangles) -> tuple[Rows, Rows]:
    """Return rows of u, per density and thickness, and of v, per density and thickness cubed."""
    bows = [(e @ (each.V[:, j] - each.V[:, i]) / 8)[:, 0] for i, j, e in each.sides()]
    u = np.concatenate([each.U[:, :, 0], each.U[:, :, 1], each.U[:, :, 2], np.stack(bows, 1)], 1)
    v = np.concatenate([each.V[:, :, 0], each.V[:, :, 1], each.V[:, :, 2]], 1)
    return each.integrand(u[:, None], TRANSLATION), each.integrand(v[:, None], ROTARY)
