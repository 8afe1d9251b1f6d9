r"""Reference cells: shape functions, quadrature and the map to the body.

On a reference cell with coordinates xi the position is x = sum_i N_i(xi) x_i, so

    J = dx/dxi,   dN/dx = J^-1 dN/dxi,   integral f dV = sum_g w_g det J(xi_g) f(xi_g).

========  =====================================================================
symbol    meaning
========  =====================================================================
N, dN     shape functions (points, nodes), their derivatives (points, nodes, dim)
xi, w     quadrature points (points, dim) and weights (points,)
J         Jacobian (elements, points, dim, dim), J[..., k, d] = dx_d / dxi_k
========  =====================================================================

Squares and cubes span [-1, 1]; triangles and tetrahedra the unit simplex. Node orders are
those of VTK. Source: O. C. Zienkiewicz, R. L. Taylor, "The Finite Element Method", vol. 1.
"""

from __future__ import annotations

import numpy as np
from scipy.special import roots_jacobi

from modefront._typing import Floats

SQUARE = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], dtype=float)
CUBE = np.array([[x, y, z] for z in (-1, 1) for x, y in SQUARE], dtype=float)
TRIANGLE_EDGES = ((0, 1), (1, 2), (2, 0))
SQUARE_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0))
TETRAHEDRON_EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))


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


def square_4(xi: Floats) -> tuple[Floats, Floats]:
    """Bilinear square: N (points, 4) and dN (points, 4, 2)."""
    f = 1 + xi[:, None, :] * SQUARE
    return f.prod(-1) / 4, SQUARE * f[:, :, ::-1] / 4


def square_8(xi: Floats) -> tuple[Floats, Floats]:
    """Serendipity square: corners, then midpoints of `SQUARE_EDGES`."""
    x, y = xi[:, 0], xi[:, 1]
    mid = (
        np.stack(
            [
                (1 - x**2) * (1 - y),
                (1 + x) * (1 - y**2),
                (1 - x**2) * (1 + y),
                (1 - x) * (1 - y**2),
            ],
            -1,
        )
        / 2
    )
    dx = np.stack([-2 * x * (1 - y), 1 - y**2, -2 * x * (1 + y), -(1 - y**2)], -1) / 2
    dy = np.stack([-(1 - x**2), -2 * y * (1 + x), 1 - x**2, -2 * y * (1 - x)], -1) / 2
    N, dN = square_4(xi)
    dmid = np.stack([dx, dy], -1)
    return (
        np.concatenate([N - (mid + np.roll(mid, 1, 1)) / 2, mid], 1),
        np.concatenate([dN - (dmid + np.roll(dmid, 1, 1)) / 2, dmid], 1),
    )


def cube_8(xi: Floats) -> tuple[Floats, Floats]:
    """Trilinear cube: N (points, 8) and dN (points, 8, 3)."""
    f = 1 + xi[:, None, :] * CUBE
    others = np.stack([f[..., 1] * f[..., 2], f[..., 0] * f[..., 2], f[..., 0] * f[..., 1]], -1)
    return f.prod(-1) / 8, CUBE * others / 8


def simplex_linear(xi: Floats) -> tuple[Floats, Floats]:
    """Barycentric coordinates N (points, dim + 1) and dN (points, dim + 1, dim)."""
    dim = xi.shape[1]
    gradient = np.vstack([np.full((1, dim), -1.0), np.eye(dim)])
    N: Floats = np.concatenate([1 - xi.sum(1, keepdims=True), xi], 1)
    return N, np.tile(gradient, (len(xi), 1, 1))


def simplex_quadratic(xi: Floats, edges: tuple[tuple[int, int], ...]) -> tuple[Floats, Floats]:
    """Quadratic simplex: corners, then midpoints of `edges`."""
    N, dN = simplex_linear(xi)
    i, j = np.array(edges).T
    at_corners = (4 * N - 1)[..., None] * dN
    between = 4 * (N[:, i, None] * dN[:, j] + N[:, j, None] * dN[:, i])
    return (
        np.concatenate([N * (2 * N - 1), 4 * N[:, i] * N[:, j]], 1),
        np.concatenate([at_corners, between], 1),
    )


def jacobian(x: Floats, dN: Floats) -> Floats:
    """J (elements, points, dim, dim) of nodes x (elements, nodes, dim)."""
    return np.asarray(np.swapaxes(dN, -1, -2)[None] @ x[:, None])


def gradients(x: Floats, dN: Floats) -> tuple[Floats, Floats]:
    """dN/dx (elements, points, dim, nodes) and det J (elements, points)."""
    J = jacobian(x, dN)
    det: Floats = np.linalg.det(J)
    return np.asarray(np.linalg.solve(J, np.swapaxes(dN, -1, -2)[None]), dtype=float), det
