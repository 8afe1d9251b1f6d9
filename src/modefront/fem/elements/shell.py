"""Thin and thick shells of 3 or 4 nodes with six DOFs a node, curved by directors at the nodes.

Matrices are exact sums of monomials of the thickness t,

    K = t (K_membrane + K_shear) + t^3 K_bending,     M = t M_translation + t^3 M_rotary,

and where t varies, K_shear and K_bending are quadratic in it (`modefront.fem.elements.triangle`).

A quadrilateral is the mean of its two divisions into triangles, with weights in inverse proportion
to the fourth powers of their diagonals: it may be warped, and where it is skew, it is soon that of
the better angles.
The director of a node is the mean, by angle, of the normals of the elements there that differ by no
more than `FOLD` from that of the element itself: across folds, elements have directors of their
own, and the drilling rotation of one is the bending rotation of the next. Drilling rotations are
those of the membrane: one that differs from the rotation of the body is resisted.
"""

from collections.abc import Sequence

import numpy as np

from modefront._typing import Floats, Ints
from modefront.fem.elements import common
from modefront.fem.elements.shapes import SQUARE_4, TRIANGLE_3, gauss_box
from modefront.fem.elements.triangle import Elements, Rows, mass, membrane, shear_and_bending
from modefront.fem.section import Material, Orthotropic

FOLD = 20.0  # angle in degrees between elements from which on they meet in a fold
DIVISIONS = {3: ((0, 1, 2),), 4: ((1, 2, 3), (2, 3, 0), (3, 0, 1), (0, 1, 2))}
"""Corners of the triangles that make an element; in quadrilaterals, their third side is inside."""

SURFACES = {  # cells and quadrature of shells by their number of nodes
    3: (TRIANGLE_3, (np.full((1, 2), 1 / 3), np.array([0.5]))),
    4: (SQUARE_4, gauss_box(2, 2)),
}

AT_ONCE = 1000  # elements at a time, so that their rows stay in the cache of a processor


def corner_normals(X: Floats) -> Floats:
    """Products of the sides at each corner (elements, corners, 3): twice the area, the normal."""
    return np.cross(np.roll(X, -1, axis=1) - X, np.roll(X, 1, axis=1) - X)


def directors(X: Floats, cells: Sequence[Ints]) -> list[Floats]:
    """Directors (elements, corners, 3) of each block of shells (elements, corners)."""
    normals, angles = [], []
    for each in cells:
        x = X[each]
        product = corner_normals(x)
        sine = np.linalg.norm(product, axis=-1)
        normals.append((product / sine[..., None]).reshape(-1, 3))
        cosine = ((np.roll(x, -1, axis=1) - x) * (np.roll(x, 1, axis=1) - x)).sum(-1)
        angles.append(np.arctan2(sine, cosine).ravel())
    normal, angle = np.concatenate(normals), np.concatenate(angles)
    node = np.concatenate([each.ravel() for each in cells])
    order = np.argsort(node, kind="stable")
    first = np.searchsorted(node[order], np.arange(len(X) + 1))
    count = np.diff(first)[node]
    d = np.zeros_like(normal)
    for k in range(count.max()):
        other = order[first[node] + np.minimum(k, count - 1)]
        cosine = (normal * normal[other]).sum(-1)
        near = (abs(cosine) > np.cos(np.radians(FOLD))) & (k < count)
        d += (near * np.sign(cosine) * angle[other])[:, None] * normal[other]
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    return _by_block(d, cells)


def areas(X: Floats) -> Floats:
    """Areas (elements,) of X (elements, corners, 3), of warped ones in their mean plane."""
    return np.asarray(np.linalg.norm(np.cross(X, np.roll(X, -1, axis=1)).sum(1), axis=1) / 2)


def narrowness(X: Floats, cells: Sequence[Ints]) -> list[Floats]:
    """1 / b^2 of each side (elements, corners), by block: the mean over the elements there."""
    ends, own = [], []
    for each in cells:
        following = np.roll(each, -1, axis=1)
        length = np.linalg.norm(X[following] - X[each], axis=2)
        ends.append(np.stack([each, following], 2).reshape(-1, 2))
        own.append(((length / areas(X[each])[:, None]) ** 2).ravel())
    pairs = np.sort(np.concatenate(ends), axis=1)
    _, side = np.unique(pairs @ [len(X), 1], return_inverse=True)
    return _by_block((np.bincount(side, np.concatenate(own)) / np.bincount(side))[side], cells)


def _by_block(values: Floats, cells: Sequence[Ints]) -> list[Floats]:
    """Return values (corners of all blocks, ...) as arrays (elements, corners, ...)."""
    parts = np.split(values, np.cumsum([each.size for each in cells])[:-1])
    return [x.reshape(*each.shape, *values.shape[1:]) for x, each in zip(parts, cells, strict=True)]


# 8 arguments: what elements have, and what they share with others.
def shell(
    X: Floats,
    d: Floats,
    narrow: Floats,
    m: Floats,
    material: Material | Orthotropic,
    thickness: float,
    offset: float,
    varied: bool,
) -> common.Matrices:
    """Matrices of shells, DOFs (u, r) node by node in global axes.

    Nodes X (elements, 3 or 4, 3) are counter-clockwise about the normal; d and narrow are their
    `directors` and `narrowness`, along the former the mid-surface is at the offset; m (elements, 3)
    are vectors in the shell along axis 1 of the material.
    """
    if len(X) > AT_ONCE:
        some = (slice(k, k + AT_ONCE) for k in range(0, len(X), AT_ONCE))
        same = material, thickness, offset, varied
        pieces = [shell(X[x], d[x], narrow[x], m[x], *same) for x in some]
        K, M = (
            {k: np.concatenate([x[k] for x in each]) for k in each[0]}
            for each in zip(*pieces, strict=True)
        )
        return K, M
    t, r = thickness, offset * d
    x = X + r
    A = common.attachment(r)
    U, omega = A[:, :, :3], A[:, :, 3:]
    V = -common.cross_matrix(d) @ omega
    quadrilateral = X.shape[1] == 4
    squares = ((x[:, 2:] - x[:, :-2]) ** 2).sum(2)
    across = squares / areas(x)[:, None] ** 2
    shares = squares**2 / (squares**2).sum(1, keepdims=True)
    parts, own = list[tuple[Rows, ...]](), common.ply(material)
    for chosen in DIVISIONS[X.shape[1]]:
        corners, odd = list(chosen), chosen[1] % 2
        R = centre_axes(x[:, corners])
        local = np.swapaxes(R, 1, 2)
        third = across[:, 1 - odd] if quadrilateral else narrow[:, 2]
        each = Elements(
            x=(x[:, corners] - x[:, corners[:1]]) @ local,
            d=d[:, corners] @ local,
            U=R[:, None] @ U[:, corners],
            V=R[:, None] @ V[:, corners],
            theta=(R[:, None] @ omega[:, corners])[:, :, 2],
            narrow=np.stack([narrow[:, corners[0]], narrow[:, corners[1]], third], 1),
            m=(R @ m[:, :, None])[..., 0],
            share=shares[:, [odd]] if quadrilateral else 1.0,
            varied=varied,
        )
        parts.append((membrane(each, t, own), *shear_and_bending(each, t, own), *mass(each)))
    stretched, sheared, bent, moved, turned = (
        common.products(*(np.concatenate(x, 1) for x in zip(*part, strict=True)))
        for part in zip(*parts, strict=True)
    )
    K_1, K_3 = t * sheared, t**3 * bent
    M_1, M_3 = material.rho * t * moved, material.rho * t**3 * turned
    if not varied:
        return {0: t * stretched + K_1 + K_3}, {0: M_1 + M_3}
    n = A.shape[-1]
    (K1, K2, K3), (more, K4, K5) = _by_order(K_1, n), _by_order(K_3, n)
    return {1: t * stretched + K1, 2: K2, 3: K3 + more, 4: K4, 5: K5}, {1: M_1, 3: M_3}


def _by_order(K: Floats, n: int) -> tuple[Floats, Floats, Floats]:
    """Return (elements, n, n) by 1, tau and tau^2, of K whose rows and columns are by 1 and tau."""
    return K[:, :n, :n], K[:, :n, n:] + K[:, n:, :n], K[:, n:, n:]


def centre_axes(x: Floats) -> Floats:
    """Return axes (elements, 3, 3) at the centre of shells x (.., nodes, 3), the third across."""
    cell, (xi, w) = SURFACES[x.shape[1]]
    a = np.swapaxes(cell.shape((w @ xi / w.sum())[None])[1][0], 0, 1) @ x
    return common.frame(a[:, 0], a[:, 1])


def shell_stresses(X: Floats, r: Floats, m: Floats, ply: common.Ply, t: float) -> common.Stresses:
    """Return the stresses of shells of thickness t with nodes X (elements, nodes, 3).

    r are offsets of the mid-surface from them, and m vectors (elements, 3) in the shell along axis
    1 of the material.
    """
    cell, rule = SURFACES[X.shape[1]]
    R = centre_axes(X + r)[:, :2]
    x = (X + r) @ np.swapaxes(R, 1, 2)
    plane = np.array([[0, 2], [2, 1]])
    D = t * ply.turned((R @ m[:, :, None])[..., 0])[:, plane[:, :, None, None], plane]
    return common.Stresses(x, R, D, common.attachment(r)[:, :, :3], cell, rule)
