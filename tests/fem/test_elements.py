"""Properties of every element alone: rigid motions, mass, invariance, symmetry."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from structures import BOX, ELEMENTS, SECTION, STEEL, rigid_motions, rotation, total

from modefront._typing import Floats
from modefront.fem.elements.shapes import (
    CUBE_8,
    CUBE_20,
    SQUARE_4,
    TETRAHEDRON_10,
    TRIANGLE_3,
    WEDGE_15,
    Cell,
    gauss_box,
    gauss_simplex,
)

NAMES = list(ELEMENTS)
seeds = st.integers(0, 2**32 - 1)


def _placed(name: str, seed: int) -> tuple[Floats, int]:
    """Nodes of an element somewhere in space, and its directions."""
    X, directions, _ = ELEMENTS[name]
    rng = np.random.default_rng(seed)
    return X @ rotation(rng).T + rng.normal(size=3), directions


@pytest.mark.parametrize("name", NAMES)
@settings(max_examples=10, deadline=None)
@given(seed=seeds)
def test_exactly_six_motions_without_energy(name: str, seed: int) -> None:
    X, directions = _placed(name, seed)
    K = total(ELEMENTS[name][2](X[None])[0])
    values = np.linalg.eigvalsh(K)
    assert np.abs(K @ rigid_motions(X, directions)).max() < 1e-9 * values[-1]
    assert np.all(np.abs(values[:6]) < 1e-9 * values[-1])
    assert values[6] > 1e-6 * values[-1]


# Orientation and offsets of a beam are global vectors: they do not turn with its nodes.
@pytest.mark.parametrize("name", [name for name in NAMES if not name.startswith("beam")])
def test_turning_the_element_turns_its_matrices(name: str) -> None:
    X, directions, element = ELEMENTS[name]
    Q = rotation(np.random.default_rng(3))
    B = np.kron(np.eye(len(X) * directions // 3), Q)
    for before, after in zip(element(X[None]), element((X @ Q.T)[None]), strict=True):
        for power in before:
            K = B @ before[power][0] @ B.T
            assert np.abs(after[power][0] - K).max() < 1e-12 * np.abs(K).max()


@pytest.mark.parametrize("name", NAMES)
def test_matrices_are_symmetric_to_the_last_digit_and_mass_not_negative(name: str) -> None:
    X, _, element = ELEMENTS[name]
    stiffness, mass = element(X[None])
    for each in (*stiffness.values(), *mass.values()):
        assert np.array_equal(each, np.swapaxes(each, 1, 2))
    values = np.linalg.eigvalsh(total(mass))
    assert values[0] > -1e-12 * values[-1]


MEASURES = {
    "beam": np.linalg.norm([1.0, 0.5, 0.2]) * SECTION.A,
    "beam, eccentric": np.linalg.norm([0.7, 0.4, 0.5]) * SECTION.A,
    "triangle": 0.1 * (1.1 * 0.8 - 0.3 * 0.2) / 2,
    "triangle, eccentric": 0.1 * (1.1 * 0.8 - 0.3 * 0.2) / 2,
    "quadrilateral": 0.1 * abs(np.cross([0.9, 1.2, 0], [-1.3, 0.6, 0])[2]) / 2,
    "tetrahedron": abs(np.linalg.det([[1.2, 0.1, -0.1], [0.2, 0.9, 0.1], [0.1, 0.3, 1.1]])) / 6,
}


@pytest.mark.parametrize("name", list(MEASURES))
def test_total_mass_is_exact(name: str) -> None:
    X, directions, element = ELEMENTS[name]
    M = total(element(X[None])[1])
    motions = rigid_motions(X, directions)
    result = np.diag(motions.T @ M @ motions)[:3]
    assert result == pytest.approx(STEEL.rho * MEASURES[name], rel=1e-13)


def test_rigid_inertia_of_a_box_and_a_plate() -> None:
    sides = np.array([2.0, 0.5, 0.3])
    box = (BOX - 0.5) * sides
    M = total(ELEMENTS["brick"][2](box[None])[1])
    m = STEEL.rho * sides.prod()
    motions = rigid_motions(box, 3)
    expected = m / 12 * ((sides**2).sum() - sides**2)
    assert np.diag(motions.T @ M @ motions)[3:] == pytest.approx(expected, rel=1e-13)

    flat = box[:4] * np.array([1, 1, 0])
    M = total(ELEMENTS["quadrilateral"][2](flat[None])[1])
    motions = rigid_motions(flat, 6)
    a, b, t = 2.0, 0.5, 0.1
    m = STEEL.rho * a * b * t
    # About its own normal a flat shell has the inertia of its points alone.
    expected = m / 12 * np.array([b**2 + t**2, a**2 + t**2, a**2 + b**2])
    assert np.diag(motions.T @ M @ motions)[3:] == pytest.approx(expected, rel=1e-13)


def test_quadrature_integrates_the_degree_it_promises() -> None:
    from math import factorial

    xi, w = gauss_simplex(3, 3)
    for p, q, r in [(5, 0, 0), (2, 2, 1), (0, 1, 4), (1, 1, 3)]:
        exact = factorial(p) * factorial(q) * factorial(r) / factorial(p + q + r + 3)
        result = (w * xi[:, 0] ** p * xi[:, 1] ** q * xi[:, 2] ** r).sum()
        assert result == pytest.approx(exact, rel=1e-13)
    xi, w = gauss_box(2, 2)
    assert (w * xi[:, 0] ** 2 * xi[:, 1] ** 2).sum() == pytest.approx(4 / 9)


@pytest.mark.parametrize("cell", [SQUARE_4, TRIANGLE_3, CUBE_8, TETRAHEDRON_10, WEDGE_15, CUBE_20])
def test_shape_functions_are_one_at_their_node_and_agree_with_their_derivatives(cell: Cell) -> None:
    dim = cell.nodes.shape[1]
    assert np.abs(cell.shape(cell.nodes)[0] - np.eye(len(cell.nodes))).max() < 1e-14
    xi, step = np.random.default_rng(0).uniform(-1, 1, (5, dim)), 1e-6
    _, dN = cell.shape(xi)
    assert np.abs(dN.sum(1)).max() < 1e-13
    for d in range(dim):
        e = step * np.eye(dim)[d]
        numeric = (cell.shape(xi + e)[0] - cell.shape(xi - e)[0]) / (2 * step)
        assert np.abs(numeric - dN[..., d]).max() < 1e-8
