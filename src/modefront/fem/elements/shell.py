r"""Flat shells of 3 or 4 nodes with six DOFs a node.

In the plane of the element membrane (u_x, u_y, r_z) and bending (u_z, r_x, r_y) do not
couple, so the matrices are exact sums of monomials of the thickness t:

    K = t K_membrane + t^3 K_bending,     M = t M_translation + t^3 M_rotary.

The plane of a quadrilateral has the normal d_13 x d_24 and goes through the mean of its
corners, which then lie above and below it by equal distances; each is joined to its
projection rigidly, and so is the plane to the nodes where the shell has an offset.

Transverse shear is left out: a bending frequency of wave number k is too high by about
(k t)^2 / (10 (1 - nu)), 0.03 % for a square of t / a = 1/100 and 2.8 % at 1/10. Thicker parts
are for solids. Triangles on strongly curved, very thin shells need elements of a size that keeps
(size times angle between neighbours) / t small, for the drilling rotation of one is the bending
rotation of the next; quadrilaterals are less sensitive.

========  ==========================================================
symbol    meaning
========  ==========================================================
X         nodes (elements, 3 or 4, 3)
R         local axes, rows; the third is the normal
t         thickness
========  ==========================================================
"""

from __future__ import annotations

import numpy as np

from modefront._typing import Floats
from modefront.fem.elements import membrane, plate
from modefront.fem.elements.common import ElementMatrices, Part, attachment, congruence
from modefront.fem.section import Material

IN_PLANE = (0, 1, 5)
OUT_OF_PLANE = (2, 3, 4)


def axes(X: Floats) -> Floats:
    """Local axes R (elements, 3, 3) of shells X (elements, 3 or 4, 3)."""
    if X.shape[1] == 3:
        along, normal = X[:, 1] - X[:, 0], np.cross(X[:, 1] - X[:, 0], X[:, 2] - X[:, 0])
    else:
        along = X[:, 1] + X[:, 2] - X[:, 0] - X[:, 3]
        normal = np.cross(X[:, 2] - X[:, 0], X[:, 3] - X[:, 1])
    normal = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    along = along - (along * normal).sum(1, keepdims=True) * normal
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    return np.stack([along, np.cross(normal, along), normal], 1)


def project(X: Floats, R: Floats) -> tuple[Floats, Floats]:
    """Corners in the plane (elements, corners, 2) and their heights above it."""
    local = (X - X.mean(1, keepdims=True)) @ np.swapaxes(R, 1, 2)
    return local[..., :2], local[..., 2]


def shell(X: Floats, material: Material, thickness: float, offset: float) -> ElementMatrices:
    """Matrices of flat shells, DOFs (u, r) node by node in global axes.

    Parameters
    ----------
    X : nodes (elements, 3 or 4, 3), counter-clockwise about the normal
    material, thickness : isotropic; thickness in units of length
    offset : distance of the mid-surface from the nodes along the normal
    """
    R = axes(X)
    x, height = project(X, R)
    r = (offset - height)[..., None] * R[:, None, 2]
    A = attachment(R, r)
    count, corners = x.shape[:2]
    t, rho = thickness, material.rho
    stretch = (membrane.triangle if corners == 3 else membrane.quadrilateral)(
        x, material.E, material.nu
    )
    linear = rho * t * plate.linear_mass(x)

    def full(blocks: list[tuple[tuple[int, ...], Floats]]) -> Floats:
        K = np.zeros((count, 6 * corners, 6 * corners))
        for directions, block in blocks:
            dof = (6 * np.arange(corners)[:, None] + np.array(directions)).ravel()
            K[:, dof[:, None], dof] = block
        return congruence(A, K)

    rotary = t**2 / 12 * linear
    return ElementMatrices(
        stiffness=(
            Part(1, full([(IN_PLANE, t * stretch)])),
            Part(3, full([(OUT_OF_PLANE, t**3 * plate.bending(x, material.E, material.nu))])),
        ),
        mass=(
            Part(
                1,
                full(
                    [
                        ((0,), linear),
                        ((1,), linear),
                        (OUT_OF_PLANE, rho * t * plate.translational(x)),
                    ]
                ),
            ),
            Part(3, full([((3,), rotary), ((4,), rotary)])),
        ),
    )
