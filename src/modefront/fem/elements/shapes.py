"""Reference cells: shape functions, quadrature and the map to the body.

The shape functions N_i span the monomials xi^p of the cell and are one at their node. Squares and
cubes span [-1, 1]; triangles and tetrahedra the unit simplex, wedges its product with [-1, 1]. Node
orders are those of VTK. Source: O. C. Zienkiewicz, R. L. Taylor, "The Finite Element Method",
vol. 1.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from scipy.special import roots_jacobi

from modefront._typing import Floats, Ints

TETRAHEDRON_EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
CUBE_EDGES = (
    *((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)),
    *((0, 4), (1, 5), (2, 6), (3, 7)),
)
WEDGE_EDGES = ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5))
TRIANGLE_EDGES = TETRAHEDRON_EDGES[:3]

Edges = Sequence[tuple[int, int]]
Rule = tuple[Floats, Floats]  # points (points, dim) and weights of a quadrature


@dataclass(frozen=True)
class Cell:
    """Reference cell with as many monomials as nodes."""

    nodes: Floats  # (nodes, dim), corners first, then midpoints of edges
    powers: Ints  # exponents of the monomials (nodes, dim)

    @cached_property
    def _coefficients(self) -> Floats:
        return np.asarray(np.linalg.inv(_monomials(self.nodes, self.powers)), dtype=float)

    def shape(self, xi: Floats) -> tuple[Floats, Floats]:
        """Return N (points, nodes) and dN (points, nodes, dim) at the points xi (points, dim)."""
        C, p = self._coefficients, self.powers
        steps = np.eye(p.shape[1], dtype=int)
        slopes = [_monomials(xi, p - step) * (p @ step) @ C for step in steps]
        return _monomials(xi, p) @ C, np.stack(slopes, -1)


def _monomials(xi: Floats, powers: Ints) -> Floats:
    return np.asarray((xi[:, None] ** powers.clip(0)).prod(-1), dtype=float)


def _cell(corners: Floats, powers: Iterable[Sequence[int]], edges: Edges = ()) -> Cell:
    middle = [corners[[i, j]].mean(0) for i, j in edges]
    return Cell(np.array([*corners, *middle], dtype=float), np.array(list(powers)))


def _box(dim: int, edges: Edges = ()) -> Cell:
    """Return the (bi-, tri-) linear or, with edges, the serendipity cell."""
    square = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
    corners = square if dim == 2 else [[x, y, z] for z in (-1, 1) for x, y in square]
    powers = product(range(3 if edges else 2), repeat=dim)
    return _cell(np.array(corners), (p for p in powers if p.count(2) < 2), edges)


def _simplex(dim: int, edges: Edges = ()) -> Cell:
    degree = 2 if edges else 1
    powers = (p for p in product(range(degree + 1), repeat=dim) if sum(p) <= degree)
    return _cell(np.vstack([np.zeros(dim), np.eye(dim)]), powers, edges)


SQUARE_4, CUBE_8, CUBE_20 = _box(2), _box(3), _box(3, CUBE_EDGES)
TRIANGLE_3, TRIANGLE_6 = _simplex(2), _simplex(2, TRIANGLE_EDGES)
TETRAHEDRON_10 = _simplex(3, TETRAHEDRON_EDGES)
WEDGE_15 = _cell(
    np.array([[x, y, z] for z in (-1, 1) for x, y in ((0, 0), (1, 0), (0, 1))]),
    (p for p in product(range(3), repeat=3) if p[0] + p[1] <= (2 if p[2] < 2 else 1)),
    WEDGE_EDGES,
)


def gauss_box(count: int, dim: int) -> tuple[Floats, Floats]:
    """Gauss-Legendre rule on [-1, 1]^dim, exact to degree 2 count - 1 in each coordinate."""
    points, weights = np.polynomial.legendre.leggauss(count)
    grids = np.meshgrid(*[points] * dim, indexing="ij")
    products = np.meshgrid(*[weights] * dim, indexing="ij")
    return np.stack(grids, -1).reshape(-1, dim), np.prod(products, axis=0).ravel()


def gauss_simplex(count: int, dim: int) -> tuple[Floats, Floats]:
    """Conical product rule on the unit simplex, exact to total degree 2 count - 1.

    Collapsing the cube onto the simplex leaves the factor (1 - u_k)^(dim - 1 - k), which a
    Gauss-Jacobi rule takes in exactly (A. H. Stroud, "Approximate Calculation of Multiple
    Integrals", 1971, sec. 2.4).
    """
    rules = [roots_jacobi(count, dim - 1 - k, 0) for k in range(dim)]
    u = np.stack(np.meshgrid(*[(1 + r[0]) / 2 for r in rules], indexing="ij"), -1)
    w = np.meshgrid(*[r[1] / 2 ** (dim - k) for k, r in enumerate(rules)], indexing="ij")
    u = u.reshape(-1, dim)
    remaining = np.cumprod(1 - u, axis=1)
    xi = u.copy()
    xi[:, 1:] *= remaining[:, :-1]
    return xi, np.prod(w, axis=0).ravel()


def gauss_tetrahedron_4() -> tuple[Floats, Floats]:
    """Symmetric four-point rule of degree 2 on the unit tetrahedron (Stroud, T3: 2-1)."""
    a = (5 - np.sqrt(5)) / 20
    points = np.full((4, 3), a)
    points[np.arange(1, 4), np.arange(3)] = 1 - 3 * a
    return points, np.full(4, 1 / 24)


def gauss_wedge(count: int) -> tuple[Floats, Floats]:
    """Product of the rules of triangle and line, exact to degree 2 count - 1 in each."""
    (xi, w), (z, v) = gauss_simplex(count, 2), gauss_box(count, 1)
    points = np.concatenate([np.repeat(xi, count, 0), np.tile(z, (len(xi), 1))], 1)
    return points, np.outer(w, v).ravel()


def jacobian(x: Floats, dN: Floats) -> Floats:
    """J (elements, points, dim, dim) of nodes x (elements, nodes, dim)."""
    return np.asarray(np.swapaxes(dN, -1, -2)[None] @ x[:, None])


def gradients(x: Floats, dN: Floats) -> tuple[Floats, Floats]:
    """dN/dx (elements, points, dim, nodes) and det J (elements, points)."""
    J = jacobian(x, dN)
    det: Floats = np.linalg.det(J)
    return np.asarray(np.linalg.solve(J, np.swapaxes(dN, -1, -2)[None]), dtype=float), det
