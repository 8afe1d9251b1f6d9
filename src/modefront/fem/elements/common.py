"""Tools of several elements: elasticity, condensation, rigid attachment.

A point at offset r from a node that moves rigidly with it has u_p = u + omega x r = u - [r]x omega
and omega_p = omega, exact for small motions. Warped quadrilaterals, eccentric shells and beams,
rigid end zones and eccentric masses are all this one transformation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.fem.section import Material, Orthotropic

ByPower = dict[int, Floats]
"""Element matrices (elements, dof, dof), symmetric, in global axes, DOFs node by node, by the power
of the thickness with which they grow; 0 where there is none, or it does not vary."""


@dataclass(frozen=True)
class ElementMatrices:
    """Stiffness, linear in Young's modulus, and mass, linear in density."""

    stiffness: ByPower
    mass: ByPower


def symmetric(K: Floats) -> Floats:
    """Symmetric part: rounding must not make assembled matrices unsymmetric."""
    return np.asarray((K + np.swapaxes(K, -1, -2)) / 2)


@dataclass(frozen=True)
class Ply:
    """Plane stress and transverse shear of a material along its axes 1 and 2.

    Attributes
    ----------
    D : (3, 3), stresses of strains (11, 22, engineering 12)
    G : G_13 and G_23
    """

    D: Floats
    G: tuple[float, float]

    def turned(self, m: Floats) -> Floats:
        """Return D (elements, 3, 3) in axes in which axis 1 is along m (elements, 2)."""
        c, s = (m / np.linalg.norm(m, axis=1, keepdims=True)).T
        rows = [[c**2, s**2, c * s], [s**2, c**2, -c * s], [-2 * c * s, 2 * c * s, c**2 - s**2]]
        T = np.stack([np.stack(row, -1) for row in rows], -2)
        return np.asarray(np.swapaxes(T, 1, 2) @ self.D @ T)

    def along(self, c2: Floats) -> tuple[Floats, Floats, Floats]:
        """Return the moduli of bending and twist, and of transverse shear, along a line.

        ``c2`` is the squared cosine of the line and axis 1.
        """
        D, s2 = self.D, 1 - c2
        mixed = D[0, 1] + 2 * D[2, 2]
        bend = D[0, 0] * c2**2 + 2 * mixed * c2 * s2 + D[1, 1] * s2**2
        twist = D[2, 2] + (D[0, 0] + D[1, 1] - 2 * mixed) * c2 * s2
        return bend, twist, self.G[0] * c2 + self.G[1] * s2


def ply(material: Material | Orthotropic) -> Ply:
    """Return the plane stress and transverse shear of a material."""
    S = material.compliance()
    used = [0, 1, 5]
    D = np.asarray(np.linalg.inv(S[np.ix_(used, used)]), dtype=float)
    return Ply(D, (1 / S[4, 4], 1 / S[3, 3]))


def condense(K: Floats, kept: int) -> Floats:
    """Static condensation of the last DOFs: K_kk - K_ki K_ii^-1 K_ik."""
    K_ki = K[:, :kept, kept:]
    return symmetric(
        K[:, :kept, :kept] - K_ki @ np.linalg.solve(K[:, kept:, kept:], K[:, kept:, :kept])
    )


def cross_matrix(r: Floats) -> Floats:
    """[r]x of shape (..., 3, 3), with [r]x a = r x a."""
    zero = np.zeros(r.shape[:-1])
    x, y, z = r[..., 0], r[..., 1], r[..., 2]
    rows = [[zero, -z, y], [z, zero, -x], [-y, x, zero]]
    return np.stack([np.stack(row, -1) for row in rows], -2)


def attachment(R: Floats, r: Floats) -> Floats:
    """A (elements, 6 nodes, 6 nodes) from node DOFs (global) to element DOFs (local axes).

    R (elements, 3, 3) has local axes in rows, and r (elements, nodes, 3) the offsets of the
    element's points from its nodes, global.
    """
    count, nodes = r.shape[:2]
    A = np.zeros((count, nodes, 6, nodes, 6))
    lever = -R[:, None] @ cross_matrix(r)
    for n in range(nodes):
        A[:, n, :3, n, :3] = A[:, n, 3:, n, 3:] = R
        A[:, n, :3, n, 3:] = lever[:, n]
    return A.reshape(count, 6 * nodes, 6 * nodes)


def congruence(A: Floats, K: Floats) -> Floats:
    """A^T K A, symmetric to the last digit."""
    return symmetric(np.swapaxes(A, -1, -2) @ (K @ A))


VOIGT = np.array([[0, 5, 4], [5, 1, 3], [4, 3, 2]])
"""Numbers of the components ij of stress and strain in the order 11, 22, 33, 23, 13, 12."""


def elasticity(material: Material | Orthotropic, R: Floats) -> Floats:
    """Return C (3, 3, 3, 3), stresses ij of gradients kl; R has the material's axes in rows."""
    C = np.linalg.inv(material.compliance())[VOIGT[:, :, None, None], VOIGT]
    return np.asarray(np.einsum("abcd,ai,bj,ck,dl->ijkl", C, R, R, R, R, optimize=True))


def solid_stiffness(g: Floats, weight: Floats, C: Floats) -> Floats:
    """Stiffness (elements, 3 nodes, 3 nodes) of a solid.

    From the energy C_ijkl u_i,j u_k,l / 2 with gradients g of the shape functions,

        K_(ai)(bk) = C_ijkl int g_aj g_bl dV.

    g are gradients of the shape functions (elements, points, 3, nodes), ``weight`` is w det J, and
    C `elasticity`.
    """
    count, points, _, nodes = g.shape
    flat = np.swapaxes(g, 2, 3).reshape(count, points, 3 * nodes)
    P = np.swapaxes(flat, 1, 2) @ (flat * weight[..., None])
    P = P.reshape(count, nodes, 3, nodes, 3).transpose(0, 1, 3, 2, 4).reshape(-1, 9)
    K = (P @ C.transpose(1, 3, 0, 2).reshape(9, 9)).reshape(count, nodes, nodes, 3, 3)
    return symmetric(K.transpose(0, 1, 3, 2, 4).reshape(count, 3 * nodes, 3 * nodes))


def solid_mass(N: Floats, weight: Floats) -> Floats:
    """Consistent mass (elements, 3 nodes, 3 nodes) per density of a solid.

    N are shape functions (points, nodes), and ``weight`` is w det J (elements, points).
    """
    count, nodes = len(weight), N.shape[1]
    products = (N[:, :, None] * N[:, None, :]).reshape(len(N), -1)
    m = symmetric((weight @ products).reshape(count, nodes, nodes))
    return np.einsum("enm,ij->enimj", m, np.eye(3)).reshape(count, 3 * nodes, 3 * nodes)
