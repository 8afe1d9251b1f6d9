"""Structured meshes of plates and boxes: nodes and cells for quick models."""

import numpy as np

from modefront._typing import Floats, Ints
from modefront.fem.elements.shapes import CUBE_EDGES, TETRAHEDRON_EDGES, WEDGE_EDGES, Edges

# Kuhn's division of the cube along one diagonal; it matches from cube to cube.
KUHN = ((0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6))
HALVES = ((0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7))


def line(start: Floats, end: Floats, count: int) -> tuple[Floats, Ints]:
    """Return nodes (count + 1, 3) and cells (count, 2) of a straight line."""
    s = np.linspace(0, 1, count + 1)[:, None]
    n = np.arange(count)
    return (1 - s) * np.asarray(start) + s * np.asarray(end), np.stack([n, n + 1], 1)


def plate(a: float, b: float, n_x: int, n_y: int) -> tuple[Floats, Ints]:
    """Return nodes (nodes, 3) and quadrilaterals (n_x n_y, 4) of a rectangle at z = 0.

    It is [0, a] x [0, b], with n_x and n_y divisions; y runs fastest.
    """
    X = _lattice(np.linspace(0, a, n_x + 1), np.linspace(0, b, n_y + 1), np.zeros(1))
    i, j = (g.ravel() for g in np.meshgrid(np.arange(n_x), np.arange(n_y), indexing="ij"))
    q = i * (n_y + 1) + j
    return X, np.stack([q, q + n_y + 1, q + n_y + 2, q + 1], 1)


def triangles(quadrilaterals: Ints) -> Ints:
    """Return two triangles for each quadrilateral (cells, 4), shape (2 cells, 3)."""
    return np.concatenate([quadrilaterals[:, [0, 1, 2]], quadrilaterals[:, [0, 2, 3]]])


def box(size: tuple[float, float, float], counts: tuple[int, int, int]) -> tuple[Floats, Ints]:
    """Return nodes (nodes, 3) and bricks (cells, 8) of a box at the origin; z runs fastest."""
    X = _lattice(*(np.linspace(0, s, n + 1) for s, n in zip(size, counts, strict=True)))
    i, j, k = (g.ravel() for g in np.meshgrid(*(np.arange(n) for n in counts), indexing="ij"))
    n_y, n_z = counts[1] + 1, counts[2] + 1
    base = (i * n_y + j) * n_z + k
    dx, dy = n_y * n_z, n_z
    bottom = np.stack([base, base + dx, base + dx + dy, base + dy], 1)
    return X, np.concatenate([bottom, bottom + 1], 1)


def tetrahedra(X: Floats, bricks: Ints) -> tuple[Floats, Ints]:
    """Return nodes and six tetrahedra of 10 nodes for each brick (cells, 8).

    Nodes at the middle of edges are added to the nodes X (nodes, 3).
    """
    return _quadratic(X, bricks[:, KUHN].reshape(-1, 4), TETRAHEDRON_EDGES)


def wedges(X: Floats, bricks: Ints) -> tuple[Floats, Ints]:
    """Return nodes and two wedges of 15 nodes for each brick (cells, 8), likewise."""
    return _quadratic(X, bricks[:, HALVES].reshape(-1, 6), WEDGE_EDGES)


def quadratic_bricks(X: Floats, bricks: Ints) -> tuple[Floats, Ints]:
    """Return nodes and a brick of 20 nodes for each brick (cells, 8), likewise."""
    return _quadratic(X, bricks, CUBE_EDGES)


def _quadratic(X: Floats, corners: Ints, edges: Edges) -> tuple[Floats, Ints]:
    ends = np.sort(corners[:, np.array(edges)], axis=-1)
    pairs, edge = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
    middle = len(X) + edge.reshape(len(corners), -1)
    return np.concatenate([X, X[pairs].mean(1)]), np.concatenate([corners, middle], 1)


def _lattice(x: Floats, y: Floats, z: Floats) -> Floats:
    return np.stack(np.meshgrid(x, y, z, indexing="ij"), -1).reshape(-1, 3)
