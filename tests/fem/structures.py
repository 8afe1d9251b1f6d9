"""Structures with known answers, and the few tools that the tests of elements share."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy import linalg, sparse
from scipy.sparse.linalg import eigsh

from modefront import fem
from modefront._typing import Floats, Ints
from modefront.fem.elements.beam import beam
from modefront.fem.elements.common import ByPower, Matrices, elasticity, frame
from modefront.fem.elements.shapes import CUBE_EDGES, TETRAHEDRON_EDGES, WEDGE_EDGES, Edges
from modefront.fem.elements.shell import directors, narrowness, shell
from modefront.fem.elements.solid import solid

STEEL = fem.Material(E=210e9, nu=0.3, rho=7850.0)


def frequencies(model: fem.StructureMatrices, count: int, shift: float = 0.0) -> Floats:
    """Lowest circular frequencies (count,) at theta = 1."""
    theta = np.ones(len(model.parameters))
    K, M = model.stiffness.at(theta), model.mass.at(theta)
    if K.shape[0] < 200:
        # Massless DOFs are infinite frequencies: solve M phi = mu K phi for the largest mu.
        mu = linalg.eigh(M.toarray(), (K + shift * M).toarray(), eigvals_only=True)[::-1][:count]
        return np.asarray(np.sqrt(np.abs(1 / mu - shift)))
    lam = eigsh(K.tocsc(), count, M.tocsc(), sigma=-shift, return_eigenvectors=False)
    return np.asarray(np.sqrt(np.abs(np.sort(lam))))


def rigid_motions(X: Floats, directions: int) -> Floats:
    """Six rigid motions (nodes x directions, 6) of nodes X (nodes, 3)."""
    motions = np.zeros((len(X), 6, 6))
    for d in range(3):
        motions[:, d, d] = motions[:, 3 + d, 3 + d] = 1
        motions[:, :3, 3 + d] = np.cross(np.eye(3)[d], X)
    return motions[:, :directions].reshape(-1, 6)


def rotation(rng: np.random.Generator) -> Floats:
    """Random proper rotation (3, 3)."""
    Q, R = np.linalg.qr(rng.normal(size=(3, 3)))
    Q = Q * np.sign(np.diag(R))
    return np.asarray(Q * np.linalg.det(Q))


def move_inner(X: Floats, step: Floats, amplitude: float, seed: int) -> Floats:
    """Nodes inside the bounding box moved at random by up to `amplitude` steps."""
    rng = np.random.default_rng(seed)
    low, high = X.min(0), X.max(0)
    wide = high > low
    tolerance = 1e-9 * (high - low).max()
    inner = ((X > low + tolerance) & (X < high - tolerance) | ~wide).all(1)
    moved = X.copy()
    shift = rng.uniform(-1, 1, X.shape) * step * amplitude * wide
    moved[inner] += shift[inner]
    return moved


BOX = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1],
                [0, 1, 1]], dtype=float)  # fmt: skip
SECTION = fem.rectangle(0.1, 0.2)
LEANING = BOX + 0.15 * np.sin(np.arange(24).reshape(8, 3) ** 2)
TETRAHEDRON = np.array([[0, 0, 0], [1.2, 0.1, -0.1], [0.2, 0.9, 0.1], [0.1, 0.3, 1.1]])


def _quadratic(corners: Floats, edges: Edges, curved: float = 0.0) -> Floats:
    nodes = np.concatenate([corners, [(corners[i] + corners[j]) / 2 for i, j in edges]])
    return np.asarray(nodes + curved * np.sin(np.arange(nodes.size).reshape(-1, 3) ** 2))


def _beam(X: Floats, r: Floats) -> Matrices:
    axis = np.diff(X, axis=1)[:, 0]
    side = np.cross(axis, axis[:, [1, 2, 0]] + np.array([0.3, 0, 0]))
    flexible = axis + r[1] - r[0]
    return beam(frame(flexible, side), np.linalg.norm(flexible, axis=1), r, STEEL, SECTION)[0]


def _shell(X: Floats, thickness: float, offset: float) -> Matrices:
    nodes, cells = X.reshape(-1, 3), [np.arange(len(X) * len(X[0])).reshape(len(X), -1)]
    (d,), (narrow,) = directors(nodes, cells), narrowness(nodes, cells)
    return shell(X, d, narrow, X[:, 1] - X[:, 0], STEEL, thickness, offset, varied=False)


# name: (nodes, directions of each node, element)
ELEMENTS: dict[str, tuple[Floats, int, Callable[[Floats], Matrices]]] = {
    "beam": (np.array([[0, 0, 0], [1.0, 0.5, 0.2]]), 6, lambda X: _beam(X, np.zeros((2, 3)))),
    "beam, eccentric": (
        np.array([[0, 0, 0], [1.0, 0.5, 0.2]]),
        6,
        lambda X: _beam(X, np.array([[0.1, 0.2, 0], [-0.2, 0.1, 0.3]])),
    ),
    "triangle": (
        np.array([[0, 0, 0], [1.1, 0.2, 0], [0.3, 0.8, 0]]),
        6,
        lambda X: _shell(X, 0.1, 0.0),
    ),
    "triangle, eccentric": (
        np.array([[0, 0, 0], [1.1, 0.2, 0], [0.3, 0.8, 0]]),
        6,
        lambda X: _shell(X, 0.1, 0.3),
    ),
    "quadrilateral": (
        np.array([[0, 0, 0], [1.1, 0.2, 0], [0.9, 1.2, 0], [-0.2, 0.8, 0]]),
        6,
        lambda X: _shell(X, 0.1, 0.0),
    ),
    "quadrilateral, warped": (
        np.array([[0, 0, 0.2], [1.1, 0.2, -0.1], [0.9, 1.2, 0.1], [-0.2, 0.8, 0]]),
        6,
        lambda X: _shell(X, 0.1, -0.2),
    ),
    **{
        name: (X, 3, lambda X: solid(X, STEEL.rho, elasticity(STEEL, np.eye(3))))
        for name, X in {
            "brick": LEANING,
            "tetrahedron": _quadratic(TETRAHEDRON, TETRAHEDRON_EDGES),
            "tetrahedron, curved": _quadratic(TETRAHEDRON, TETRAHEDRON_EDGES, 0.03),
            "wedge": _quadratic(LEANING[[0, 1, 2, 4, 5, 6]], WEDGE_EDGES, 0.03),
            "brick of 20 nodes": _quadratic(LEANING, CUBE_EDGES, 0.03),
        }.items()
    },
}


def total(parts: ByPower) -> Floats:
    """Sum of the parts of the first element."""
    return np.asarray(sum(matrices[0] for matrices in parts.values()))


def boundary(X: Floats, dims: tuple[int, ...]) -> Ints:
    """Nodes on the faces of the bounding box across the given axes."""
    low, high = X.min(0), X.max(0)
    on = [(np.isclose(X[:, d], low[d]) | np.isclose(X[:, d], high[d])) for d in dims]
    return np.flatnonzero(np.any(on, axis=0))


def solve_inner(model: fem.StructureMatrices, u: Floats, given: Floats) -> Floats:
    """Displacements (nodes, 6) in equilibrium where the DOFs `given` have the values of u."""
    K = model.stiffness.at(np.ones(len(model.parameters)))
    node, direction = model.dofs.free.T
    fixed = given[node, direction]
    q = np.where(fixed, u[node, direction], 0.0)
    free = np.flatnonzero(~fixed)
    rhs = -(K @ q)[free]
    q[free] = sparse.linalg.spsolve(K[free][:, free].tocsc(), rhs)
    result = np.zeros_like(u)
    result[node, direction] = q
    return result


def rate(errors: list[float], refinement: float = 2.0) -> Floats:
    """Orders of convergence between successive refinements."""
    e = np.abs(errors)
    return np.asarray(np.log(e[:-1] / e[1:]) / np.log(refinement))
