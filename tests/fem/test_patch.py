"""Patch tests: on any mesh, constant strains and curvatures are reproduced exactly."""

from __future__ import annotations

import numpy as np
import pytest
from structures import STEEL, boundary, move_inner, solve_inner

from modefront import fem
from modefront._typing import Floats, Ints

GRADIENT = 1e-3 * np.array([[0.7, 0.3, -0.2], [0.1, -0.5, 0.4], [-0.3, 0.2, 0.6]])
QUADRATIC = {
    "tetrahedron": fem.grids.tetrahedra,
    "wedge": fem.grids.wedges,
    "brick of 20 nodes": fem.grids.quadratic_bricks,
}


def _plate(kind: str, seed: int) -> tuple[Floats, Ints]:
    X, cells = fem.grids.plate(2.0, 1.5, 4, 3)
    X = move_inner(X, np.array([0.5, 0.5, 0]), 0.3, seed)
    return X, fem.grids.triangles(cells) if kind == "triangle" else cells


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kind", ["triangle", "quadrilateral"])
def test_shell_membrane(kind: str, seed: int) -> None:
    X, cells = _plate(kind, seed)
    model = fem.assemble(fem.Structure(X, (fem.Shells("s", cells, STEEL, 0.01),)), floating=True)
    u = np.zeros((len(X), 6))
    u[:, :2] = X[:, :2] @ GRADIENT[:2, :2].T
    u[:, 5] = (GRADIENT[1, 0] - GRADIENT[0, 1]) / 2
    given = np.zeros(u.shape, dtype=bool)
    given[boundary(X, (0, 1))] = True
    assert np.abs(solve_inner(model, u, given) - u).max() < 1e-12 * np.abs(u).max() * 10


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kind", ["triangle", "quadrilateral"])
def test_shell_bending(kind: str, seed: int) -> None:
    X, cells = _plate(kind, seed)
    model = fem.assemble(fem.Structure(X, (fem.Shells("s", cells, STEEL, 0.01),)), floating=True)
    x, y = X[:, 0], X[:, 1]
    u = np.zeros((len(X), 6))
    u[:, 2] = 1e-3 * (x**2 - 0.4 * x * y + 0.7 * y**2 + 0.3 * x)
    u[:, 3] = 1e-3 * (-0.4 * x + 1.4 * y)
    u[:, 4] = -1e-3 * (2 * x - 0.4 * y + 0.3)
    given = np.zeros(u.shape, dtype=bool)
    given[boundary(X, (0, 1))] = True
    assert np.abs(solve_inner(model, u, given) - u).max() < 1e-10 * np.abs(u).max()


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kind", ["brick", *QUADRATIC])
def test_solid(kind: str, seed: int) -> None:
    X, cells = fem.grids.box((1.5, 1.2, 0.9), (3, 3, 3))
    X = move_inner(X, np.array([0.5, 0.4, 0.3]), 0.25, seed)
    if kind in QUADRATIC:
        X, cells = QUADRATIC[kind](X, cells)
    model = fem.assemble(fem.Structure(X, (fem.Solids("s", cells, STEEL),)), floating=True)
    u = np.zeros((len(X), 6))
    u[:, :3] = X @ GRADIENT.T
    given = np.zeros(u.shape, dtype=bool)
    given[boundary(X, (0, 1, 2))] = True
    assert np.abs(solve_inner(model, u, given) - u).max() < 1e-11 * np.abs(u).max()
