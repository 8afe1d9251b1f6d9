"""Internal forces of shells and solids, and the geometric stiffness that they make.

Stresses S = D sym grad u, integrated over the thickness of shells, are taken at the centre of each
element, from the displacements of its mid-surface in the plane of the centre. With the gradients g
of the shape functions there,

    K_G = int S_ab u_,a . u_,b,   (K_G)_(ni)(mi) = sum_points w g_na S_ab g_mb.

Drilling rotations and rotary terms are left out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.fem.elements.common import Ply, attachment, symmetric
from modefront.fem.elements.shapes import SQUARE_4, TRIANGLE_3, Cell, gauss_box, gradients
from modefront.fem.elements.solid import SOLIDS

Rule = tuple[Floats, Floats]
SURFACES = {
    3: (TRIANGLE_3, (np.full((1, 2), 1 / 3), np.array([0.5]))),
    4: (SQUARE_4, gauss_box(2, 2)),
}
"""Cells and quadrature of shells."""


@dataclass(frozen=True)
class Stresses:
    """Stresses of shells and solids.

    Attributes
    ----------
    x : nodes of the mid-surface (elements, nodes, dim) in the axes R
    R, D, P : see the module; P is None where the DOFs are the displacements
    cell, rule : shape functions and quadrature
    """

    x: Floats
    R: Floats
    D: Floats
    P: Floats | None
    cell: Cell
    rule: Rule

    def _centre(self) -> tuple[Floats, Floats]:
        """Return gradients (elements, dim, nodes) at the centre, and volumes (elements,)."""
        xi, w = self.rule
        centre = (w @ xi / w.sum())[None]
        g, _ = gradients(self.x, self.cell.shape(centre)[1])
        _, det = gradients(self.x, self.cell.shape(xi)[1])
        return g[:, 0], det @ w

    def free_forces(self, strain: float) -> Floats:
        """Return forces (elements, n) that make a free strain."""
        g, volume = self._centre()
        S = strain * np.trace(self.D, axis1=3, axis2=4)
        f = volume[:, None, None] * np.swapaxes(g, 1, 2) @ S @ self.R
        if self.P is None:
            return np.asarray(f.reshape(len(f), -1))
        return np.asarray(np.einsum("enj,enjk->ek", f, self.P))

    def stiffness(self, q: Floats, strain: float) -> Floats:
        """Return K_G (elements, n, n) of displacements q (elements, n) and a free strain."""
        count, nodes, dim = self.x.shape
        P = self.P
        u = q.reshape(count, nodes, 3) if P is None else np.einsum("enjk,ek->enj", P, q)
        slopes = self._centre()[0] @ u @ np.swapaxes(self.R, 1, 2) - strain * np.eye(dim)
        S = np.einsum("eabcd,ecd->eab", self.D, slopes)
        xi, w = self.rule
        g, det = gradients(self.x, self.cell.shape(xi)[1])
        K = np.einsum("eg,egan,eab,egbm->enm", det * w, g, S, g, optimize=True)
        if P is None:
            return symmetric(np.einsum("enm,ij->enimj", K, np.eye(3)).reshape(count, 3 * nodes, -1))
        right = (K @ P.reshape(count, nodes, -1)).reshape(count, 3 * nodes, -1)
        return symmetric(np.swapaxes(P.reshape(count, 3 * nodes, -1), 1, 2) @ right)


def shell_stresses(X: Floats, r: Floats, m: Floats, material: Ply, t: float) -> Stresses:
    """Return the stresses of shells of thickness t with nodes X (elements, nodes, 3).

    r are offsets of the mid-surface from them, and m vectors (elements, 3) in the shell along axis
    1 of the material.
    """
    cell, rule = SURFACES[X.shape[1]]
    R = centre_axes(X + r)[:, :2]
    identity = np.broadcast_to(np.eye(3), (len(X), 3, 3))
    P = attachment(identity, r).reshape(*X.shape[:2], 6, -1)[:, :, :3]
    x = (X + r) @ np.swapaxes(R, 1, 2)
    plane = np.array([[0, 2], [2, 1]])
    D = t * material.turned((R @ m[:, :, None])[..., 0])[:, plane[:, :, None, None], plane]
    return Stresses(x, R, D, P, cell, rule)


def centre_axes(x: Floats) -> Floats:
    """Return axes (elements, 3, 3) at the centre of shells x (.., nodes, 3), the third across."""
    cell, (xi, w) = SURFACES[x.shape[1]]
    a = np.swapaxes(cell.shape((w @ xi / w.sum())[None])[1][0], 0, 1) @ x
    normal = np.cross(a[:, 0], a[:, 1])
    R = np.stack([a[:, 0], np.cross(normal, a[:, 0]), normal], 1)
    return np.asarray(R / np.linalg.norm(R, axis=2, keepdims=True))


def solid_stresses(X: Floats, C: Floats) -> Stresses:
    """Return the stresses of solids X (elements, nodes, 3) of the elasticity C."""
    kind = SOLIDS[X.shape[1]]
    return Stresses(X, np.eye(3)[None], C[None], None, kind.cell, kind.stiffness)
