"""Tools of several elements: elasticity, condensation, rigid attachment.

A point at offset r from a node that moves rigidly with it has u_p = u + omega x r = u - [r]x omega
and omega_p = omega, exact for small motions. Warped quadrilaterals, eccentric shells and beams,
rigid end zones and eccentric masses are all this one transformation.
"""

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.fem.elements.shapes import Cell, Rule, gradients
from modefront.fem.section import Material, Orthotropic

ByPower = dict[int, Floats]
"""Element matrices (elements, dof, dof), symmetric, in global axes, DOFs node by node, by the power
of the thickness with which they grow; 0 where there is none, or it does not vary."""

Matrices = tuple[ByPower, ByPower]  # stiffness, linear in E, and mass, linear in density
VOIGT = np.array([[0, 5, 4], [5, 1, 3], [4, 3, 2]])  # places of ij in 11, 22, 33, 23, 13, 12


def symmetric(K: Floats) -> Floats:
    """Symmetric part: rounding must not make assembled matrices unsymmetric."""
    return np.asarray((K + np.swapaxes(K, -1, -2)) / 2)


def products(B: Floats, D: Floats) -> Floats:
    """Return the sum over points of B^T D B (elements, n, n), D matrices or their diagonals."""
    rows = B.reshape(len(B), -1, B.shape[-1])
    weighted = D @ B if D.ndim == B.ndim else D[..., None] * B
    return symmetric(np.swapaxes(rows, 1, 2) @ weighted.reshape(rows.shape))


@dataclass(frozen=True)
class Ply:
    """Plane stress and transverse shear of a material along its axes 1 and 2."""

    D: Floats  # (3, 3), stresses of strains (11, 22, engineering 12)
    G: tuple[float, float]  # G_13 and G_23

    def turned(self, m: Floats) -> Floats:
        """Return D (elements, 3, 3) in axes in which axis 1 is along m (elements, 2)."""
        c, s = (m / np.linalg.norm(m, axis=1, keepdims=True)).T
        rows = [[c**2, s**2, c * s], [s**2, c**2, -c * s], [-2 * c * s, 2 * c * s, c**2 - s**2]]
        T = np.stack([np.stack(row, -1) for row in rows], -2)
        return np.asarray(np.swapaxes(T, 1, 2) @ self.D @ T)

    def along(self, c2: Floats) -> tuple[Floats, Floats, Floats]:
        """Return moduli of bending, twist and transverse shear at squared cosines c2 to axis 1."""
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


def cross_matrix(r: Floats) -> Floats:
    """[r]x of shape (..., 3, 3), with [r]x a = r x a."""
    return np.asarray(np.cross(np.eye(3), r[..., None, :]))


def frame(x: Floats, other: Floats) -> Floats:
    """Axes (..., 3, 3) in rows: along x, in its plane with another vector, and across that."""
    z = np.cross(x, other)
    R = np.stack([x, np.cross(z, x), z], -2)
    return np.asarray(R / np.linalg.norm(R, axis=-1, keepdims=True))


def attachment(r: Floats, R: Floats | None = None) -> Floats:
    """A (elements, nodes, 6, 6 nodes) from node DOFs (global) to element DOFs (local axes).

    r (elements, nodes, 3) has the offsets of the element's points from its nodes, global, and
    R (elements, 3, 3) or (3, 3) local axes in rows, the global ones unless given.
    """
    count, nodes = r.shape[:2]
    A = np.zeros((count, nodes, 6, nodes, 6))
    axes = np.broadcast_to(np.eye(3) if R is None else R, (count, 3, 3))
    lever = -axes[:, None] @ cross_matrix(r)
    for n in range(nodes):
        A[:, n, :3, n, :3] = A[:, n, 3:, n, 3:] = axes
        A[:, n, :3, n, 3:] = lever[:, n]
    return A.reshape(count, nodes, 6, 6 * nodes)


def elasticity(material: Material | Orthotropic, R: Floats) -> Floats:
    """Return C (3, 3, 3, 3), stresses ij of gradients kl; R has the material's axes in rows."""
    C = np.linalg.inv(material.compliance())[VOIGT[:, :, None, None], VOIGT]
    return np.asarray(np.einsum("abcd,ai,bj,ck,dl->ijkl", C, R, R, R, R, optimize=True))


@dataclass(frozen=True)
class Stresses:
    """Stresses of shells and solids, and the geometric stiffness that they make.

    Stresses S = D sym grad u, integrated over the thickness of shells, are taken at the centre of
    each element, from the displacements of its mid-surface in the plane of the centre. With the
    gradients g of the shape functions there,

        K_G = int S_ab u_,a . u_,b,   (K_G)_(ni)(mi) = sum_points w g_na S_ab g_mb.

    Drilling rotations and rotary terms are left out.
    """

    x: Floats  # nodes of the mid-surface (elements, nodes, dim) in the axes R
    R: Floats  # axes (elements, dim, 3)
    D: Floats  # stresses of gradients (elements, dim, dim, dim, dim)
    P: Floats  # displacements of nodes by the DOFs (elements, nodes, 3, n), or the same for all
    cell: Cell  # cell, rule: shape functions and quadrature
    rule: Rule

    def _centre(self) -> tuple[Floats, Floats]:
        """Return gradients (elements, dim, nodes) at the centre, and volumes (elements,)."""
        xi, w = self.rule
        g, _ = gradients(self.x, self.cell.shape((w @ xi / w.sum())[None])[1])
        _, det = gradients(self.x, self.cell.shape(xi)[1])
        return g[:, 0], det @ w

    def free_forces(self, strain: float) -> Floats:
        """Return forces (elements, n) that make a free strain."""
        g, volume = self._centre()
        S = strain * np.trace(self.D, axis1=3, axis2=4)
        f = volume[:, None, None] * np.swapaxes(g, 1, 2) @ S @ self.R
        return np.asarray(np.einsum("enj,enjk->ek", f, self.P))

    def stiffness(self, q: Floats, strain: float) -> Floats:
        """Return K_G (elements, n, n) of displacements q (elements, n) and a free strain."""
        count, nodes, dim = self.x.shape
        u = np.einsum("enjk,ek->enj", self.P, q)
        slopes = self._centre()[0] @ u @ np.swapaxes(self.R, 1, 2) - strain * np.eye(dim)
        S = np.einsum("eabcd,ecd->eab", self.D, slopes)
        xi, w = self.rule
        g, det = gradients(self.x, self.cell.shape(xi)[1])
        K = np.einsum("eg,egan,eab,egbm->enm", det * w, g, S, g, optimize=True)
        right = (K @ self.P.reshape(len(self.P), nodes, -1)).reshape(count, 3 * nodes, -1)
        return symmetric(np.swapaxes(self.P.reshape(len(self.P), 3 * nodes, -1), 1, 2) @ right)
