"""Straight Timoshenko beam in space, two nodes, twelve DOFs, and bars with axial forces only.

In a principal plane with deflection v and rotation psi of the section,

    EI psi'' + kappa G A (v' - psi) = 0,   kappa G A (v' - psi)' = 0,

has cubic v and quadratic psi as exact solutions. With these, linear axial displacement u and twist
theta, and Phi = 12 EI / (kappa G A L^2), the nodally exact static stiffness, the consistent mass
with rotary inertia, and the geometric stiffness of an axial force N (tension positive) are

    K = int EA u'^2 + GJ theta'^2 + sum_planes EI psi'^2 + kappa G A (v' - psi)^2,
    M = int rho A (u^2 + v_c^2 + w_c^2) + rho (I_y + I_z) theta^2 + sum_planes rho I psi^2,
    K_G = N int v_c'^2 + w_c'^2 + (I_y + I_z) / A theta'^2.

Bending and twist are about the shear centre (y_s, z_s), axial force and mass at the centroid, with
v_c = v + z_s theta, w_c = w - y_s theta. To M comes rho h^2 / 12 int A u'^2 + (I_y + I_z) theta'^2
+ A sum_planes (v' - psi)^2 of what is linear in elements of length h, the mean of consistent and
lumped mass: axial motion and twist then converge with h^4 in the frequency, as slender beams do.
Released DOFs r of an end have no force: with G = [1; -K_rr^-1 K_rk] all matrices are G^T A G, the
static condensation of K and the mass and geometric stiffness of the same shapes. Sources: J. S.
Przemieniecki, "Theory of Matrix Structural Analysis", 1968; Z. Friedman, J. B. Kosmatka,
doi:10.1016/0045-7949(93)90243-7.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.errors import wrong
from modefront.fem.elements.common import Matrices, attachment, products, symmetric
from modefront.fem.section import Material, Section
from modefront.rounding import COMPUTED

U, V, W, TWIST, PSI_Y, PSI_Z = range(6)  # of an end in local axes; PSI: rotations about y and z


@dataclass(frozen=True)
class Axial:
    """Axial forces N of bars and beams, and the geometric stiffness that they make."""

    rows: Floats  # elongation (elements, n) of displacements
    length: Floats  # (elements,)
    rigidity: float  # EA, N of a strain that is hindered
    unit: Floats  # geometric stiffness (elements, n, n) of N = 1

    def free_forces(self, strain: float) -> Floats:
        """Return forces (elements, n) that make the free strain."""
        return self.rigidity * strain * self.rows

    def stiffness(self, q: Floats, strain: float) -> Floats:
        """Return K_G (elements, n, n) of displacements q (elements, n) and a free strain."""
        N = self.rigidity * ((self.rows * q).sum(1) / self.length - strain)
        return N[:, None, None] * self.unit


def plane(Phi: Floats, L: Floats, s: Floats) -> tuple[Floats, Floats, Floats]:
    """Return v and psi, their derivatives, and (v' - psi) / Phi, in one plane.

    Each has rows (.., elements, points, 4) by the DOFs (v, psi) at either end, s = x / L.
    """
    P, h, one = Phi[:, None], L[:, None], np.ones((len(L), len(s)))
    v = [
        1 - 3 * s**2 + 2 * s**3 + P * (1 - s),
        h * (s - 2 * s**2 + s**3 + P / 2 * (s - s**2)),
        3 * s**2 - 2 * s**3 + P * s,
        h * (s**3 - s**2 - P / 2 * (s - s**2)),
    ]
    psi = [
        6 * (s**2 - s) / h,
        1 - 4 * s + 3 * s**2 + P * (1 - s),
        6 * (s - s**2) / h,
        3 * s**2 - 2 * s + P * s,
    ]
    dv = [
        (6 * (s**2 - s) - P) / h,
        1 - 4 * s + 3 * s**2 + P / 2 * (1 - 2 * s),
        (6 * (s - s**2) + P) / h,
        3 * s**2 - 2 * s - P / 2 * (1 - 2 * s),
    ]
    dpsi = [(12 * s - 6) / h**2, (6 * s - 4 - P) / h, (6 - 12 * s) / h**2, (6 * s - 2 + P) / h]
    gamma = [-one / h, -one / 2, one / h, -one / 2]
    f, df, g = (
        np.stack([np.stack(each, -1) for each in rows]) / (1 + P)[..., None]
        for rows in ((v, psi), (dv, dpsi), (gamma,))
    )
    return f, df, g[0]


def release(K: Floats, directions: Sequence[int]) -> Floats:
    """Return G (elements, 12, 12), motions of all DOFs from those that are not released."""
    r = list(directions)
    K_rr = K[:, r][:, :, r]
    size = np.sqrt(np.diagonal(K_rr, axis1=1, axis2=2))
    if np.linalg.eigvalsh(K_rr / size[:, :, None] / size[:, None]).min() < COMPUTED:
        raise wrong("releases", "those that leave the beam no free motion", "one")
    G = np.tile(np.eye(12), (len(K), 1, 1))
    G[:, r] = -np.linalg.solve(K_rr, K[:, r])
    G[:, :, r] = 0
    return G


def beam(
    R: Floats,
    L: Floats,
    r: Floats,
    material: Material,
    section: Section,
    released: Sequence[int] = (),
) -> tuple[Matrices, Axial]:
    """Matrices of straight beams, DOFs (u, r) node by node in global axes.

    Axes R (elements, 3, 3) and lengths L (elements,) are those of the flexible part; r (2, 3) are
    offsets of its ends from the nodes, global: along the axis a rigid end zone (without mass),
    across it an eccentricity. Of the ends' 12 local DOFs, those released are without force.
    """
    E, G, A = material.E, material.G, section.A
    polar = section.I_y + section.I_z
    points, weights = np.polynomial.legendre.leggauss(4)
    s, w = (1 + points) / 2, L[:, None, None] * (weights / 2)[:, None]
    f, df = np.zeros((2, len(L), len(s), 6, 12))
    for direction in (U, TWIST):
        f[:, :, direction, [direction, 6 + direction]] = np.stack([1 - s, s], -1)
        df[:, :, direction, [direction, 6 + direction]] = np.array([-1.0, 1]) / L[:, None, None]
    gamma = np.zeros((len(L), len(s), 2, 12))
    shear, sheared = np.zeros((2, len(L), 1, 2))
    # Local y deflection turns with +r_z, local z deflection with -r_y.
    for n, (v, psi, sign, inertia, kappa) in enumerate(
        ((V, PSI_Z, 1, section.I_z, section.kappa_y), (W, PSI_Y, -1, section.I_y, section.kappa_z))
    ):
        Phi = 12 * E * inertia / (kappa * G * A * L**2)
        shear[:, 0, n], sheared[:, 0, n] = 12 * E * inertia * Phi / L**2, A * Phi**2
        dof, flip = [v, psi, 6 + v, 6 + psi], np.array([1, sign, 1, sign])
        (f_v, f_psi), (df_v, df_psi), g = plane(Phi, L, s)
        f[:, :, v, dof], f[:, :, psi, dof] = f_v * flip, f_psi * flip
        df[:, :, v, dof], df[:, :, psi, dof] = df_v * flip, df_psi * flip
        gamma[:, :, n, dof] = g * flip
    centre = np.eye(12)
    for direction, arm in ((V, -section.shear_centre[1]), (W, section.shear_centre[0])):
        centre[[direction, 6 + direction], [TWIST, 6 + TWIST]] = arm
        for rows in (f, df):
            rows[:, :, direction] -= arm * rows[:, :, TWIST]
    EI_y, EI_z = E * section.I_y, E * section.I_z
    K = products(df, w * [E * A, 0, 0, G * section.J, EI_y, EI_z]) + products(gamma, w * shear)
    M = products(f, material.rho * w * [A, A, A, polar, section.I_y, section.I_z])
    bows = material.rho * w * L[:, None, None] ** 2 / 12
    M += products(df, bows * [A, 0, 0, polar, 0, 0]) + products(gamma, bows * sheared)
    K_G = products(df, w * [0, 1, 1, polar / A, 0, 0])
    a = centre @ attachment(np.broadcast_to(r, (len(L), 2, 3)), R).reshape(-1, 12, 12)
    if released:
        a = release(K, released) @ a
    elongation = L[:, None] * (df[:, :1, U] @ a)[:, 0]
    K, M, K_G = (symmetric(np.swapaxes(a, 1, 2) @ (each @ a)) for each in (K, M, K_G))
    return ({0: K}, {0: M}), Axial(elongation, L, E * A, K_G)


def truss(axis: Floats, length: Floats, material: Material, area: float) -> tuple[Matrices, Axial]:
    """Matrices of straight bars along unit vectors (elements, 3), DOFs u node by node, global."""
    L, row = length[:, None, None], np.concatenate([-axis, axis], 1)
    along = row[:, :, None] * row[:, None, :]
    EA, mass = material.E * area, material.rho * area
    M = mass * L * np.kron(np.array([[2.0, 1], [1, 2]]) / 6, np.eye(3)) + mass * L / 12 * along
    across = np.kron(np.array([[1.0, -1], [-1, 1]]), np.eye(3)) - along
    return ({0: symmetric(EA / L * along)}, {0: M}), Axial(row, length, EA, symmetric(across / L))
