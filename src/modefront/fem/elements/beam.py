r"""Straight Timoshenko beam in space, two nodes, twelve DOFs.

In a principal plane with deflection v and rotation psi of the section,

    EI psi'' + kappa G A (v' - psi) = 0,   kappa G A (v' - psi)' = 0,

has cubic v and quadratic psi as exact solutions; interpolating with them gives nodally exact
static stiffness and, with int rho A v^2 + rho I psi^2, the consistent mass with rotary
inertia. With Phi = 12 EI / (kappa G A L^2),

    k = EI / (L^3 (1 + Phi)) [12, 6L, -12, 6L; ., (4 + Phi) L^2, -6L, (2 - Phi) L^2; ...].

Slender beams converge with h^4 in the frequency; where shear dominates (h below the depth) the
linear part of v leaves rho (w h)^2 / (24 kappa G). Sources: J. S. Przemieniecki, "Theory of
Matrix Structural Analysis", 1968; Z. Friedman, J. B. Kosmatka,
doi:10.1016/0045-7949(93)90243-7.

========  =================================================================
symbol    meaning
========  =================================================================
X         end points (elements, 2, 3)
R         local axes, rows: axis of the beam, local y, local z
Phi       ratio of shear to bending flexibility, 0 where shear is rigid
r         offsets of the ends from the nodes, global (2, 3)
========  =================================================================
"""

from __future__ import annotations

import numpy as np

from modefront._typing import Floats, Ints
from modefront.fem.elements.common import ElementMatrices, Part, attachment, congruence
from modefront.fem.section import Material, Section

AXIAL = np.array([0, 6])
TORSION = np.array([3, 9])
# Local y deflection turns with +r_z, local z deflection with -r_y.
PLANE_Y = (np.array([1, 5, 7, 11]), np.array([1.0, 1, 1, 1]))
PLANE_Z = (np.array([2, 4, 8, 10]), np.array([1.0, -1, 1, -1]))


def axes(X: Floats, orientation: Floats) -> Floats:
    """Local axes R (elements, 3, 3); local y lies in the plane of axis and `orientation`."""
    along = X[:, 1] - X[:, 0]
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    y = orientation - (along * orientation).sum(1, keepdims=True) * along
    y = y / np.linalg.norm(y, axis=1, keepdims=True)
    return np.stack([along, y, np.cross(along, y)], 1)


def bending_stiffness(EI: float, Phi: Floats, L: Floats) -> Floats:
    """Stiffness (elements, 4, 4) in one plane, DOFs (v, psi) at either end."""
    ones = np.ones_like(L)
    a, b, c, d = 12 * ones, 6 * L, (4 + Phi) * L**2, (2 - Phi) * L**2
    rows = [[a, b, -a, b], [b, c, -b, d], [-a, -b, a, -b], [b, d, -b, c]]
    k = np.stack([np.stack(row, -1) for row in rows], -2)
    return np.asarray(k * (EI / (L**3 * (1 + Phi)))[:, None, None])


def bending_mass(rho_A: float, rho_I: float, Phi: Floats, L: Floats) -> Floats:
    """Consistent mass (elements, 4, 4) in one plane, DOFs (v, psi) at either end."""
    points, weights = np.polynomial.legendre.leggauss(4)
    s, w = (1 + points) / 2, weights / 2
    P, h = Phi[:, None], L[:, None]
    v = np.stack(
        [
            1 - 3 * s**2 + 2 * s**3 + P * (1 - s),
            h * (s - 2 * s**2 + s**3 + P / 2 * (s - s**2)),
            3 * s**2 - 2 * s**3 + P * s,
            h * (s**3 - s**2 - P / 2 * (s - s**2)),
        ],
        -1,
    )
    psi = np.stack(
        [
            6 * (s**2 - s) / h,
            1 - 4 * s + 3 * s**2 + P * (1 - s),
            6 * (s - s**2) / h,
            3 * s**2 - 2 * s + P * s,
        ],
        -1,
    )
    m = rho_A * np.einsum("g,egi,egj->eij", w, v, v) + rho_I * np.einsum(
        "g,egi,egj->eij", w, psi, psi
    )
    return np.asarray(m * (L / (1 + Phi) ** 2)[:, None, None])


def insert(K: Floats, dof: Ints, block: Floats) -> None:
    """Add a block (elements, n, n) at the DOFs `dof` of K (elements, 12, 12)."""
    K[:, dof[:, None], dof] += block


def beam(
    X: Floats, material: Material, section: Section, orientation: Floats, r: Floats
) -> ElementMatrices:
    """Matrices of straight beams, DOFs (u, r) node by node in global axes.

    Parameters
    ----------
    X : nodes (elements, 2, 3)
    material, section : the same for all elements
    orientation : vectors (elements, 3), not parallel to the beams; local y is their part across the
        axis
    r : offsets (2, 3) of the flexible part's ends from the nodes, global. Along the axis it is a
        rigid end zone (without mass), across it an eccentricity.
    """
    ends = X + r
    R = axes(ends, orientation)
    L = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    E, G, rho = material.E, material.G, material.rho
    K, M = np.zeros((2, len(L), 12, 12))
    bar = np.array([[1.0, -1], [-1, 1]])
    line = np.array([[2.0, 1], [1, 2]]) / 6
    insert(K, AXIAL, (E * section.A / L)[:, None, None] * bar)
    insert(K, TORSION, (G * section.J / L)[:, None, None] * bar)
    insert(M, AXIAL, (rho * section.A * L)[:, None, None] * line)
    insert(M, TORSION, (rho * (section.I_y + section.I_z) * L)[:, None, None] * line)
    for (dof, sign), inertia, factor in (
        (PLANE_Y, section.I_z, section.kappa_y),
        (PLANE_Z, section.I_y, section.kappa_z),
    ):
        Phi = 12 * E * inertia / (factor * G * section.A * L**2)
        flip = sign[:, None] * sign
        insert(K, dof, flip * bending_stiffness(E * inertia, Phi, L))
        insert(M, dof, flip * bending_mass(rho * section.A, rho * inertia, Phi, L))
    A = attachment(R, np.broadcast_to(r, (len(L), 2, 3)))
    return ElementMatrices((Part(0, congruence(A, K)),), (Part(0, congruence(A, M)),))
