"""Elements say what they cannot do."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from structures import STEEL

from modefront import fem
from modefront._typing import Floats, Ints
from modefront.fem.limits import limits_of

PLATE, QUADS = fem.grids.plate(1.0, 1.0, 6, 6)
BOX, BRICKS = fem.grids.box((1.0, 1.0, 1.0), (3, 3, 3))


def shells(X: Floats, cells: Ints, thickness: float, frequency: float = 0.0) -> list[str]:
    structure = fem.Structure(X, (fem.Shells("plate", cells, STEEL, thickness),))
    return limits_of(structure, X).warnings(frequency)


def test_thickness_over_span() -> None:
    assert shells(PLATE, QUADS, 0.01) == []
    (text,) = shells(PLATE, QUADS, 0.2)
    assert "shells of group 'plate' are 0.2 of their span thick" in text
    error = 100 * 0.2**2 * np.pi**2 / (5 * (1 - STEEL.nu))
    assert f"stiffness is some {error:.0f} % too great" in text


def test_thickness_over_the_length_of_waves() -> None:
    D = STEEL.E * 0.02**3 / (12 * (1 - STEEL.nu**2))
    k = 2 * np.pi / 0.2  # waves of ten thicknesses
    frequency = k**2 * np.sqrt(D / (STEEL.rho * 0.02)) / (2 * np.pi)
    (text,) = shells(PLATE, QUADS, 0.02, frequency)
    assert "waves are 0.2 long" in text
    assert f"some {100 * (0.02 * k) ** 2 / (5 * (1 - STEEL.nu)):.0f} % too great" in text
    assert shells(PLATE, QUADS, 0.02, frequency / 30) == []


def skew(X: Floats) -> Floats:
    return X + np.outer(X[:, 1], [1.0, 0.0, 0.0])


def roof(X: Floats) -> Floats:
    return np.column_stack([np.sin(X[:, 0]), X[:, 1], np.cos(X[:, 0])])


@pytest.mark.parametrize(
    ("change", "triangles", "says"),
    [
        (skew, False, "quadrilaterals of group 'plate' are skew by up to 45°"),
        (roof, True, "elements of group 'plate' are up to"),
        (roof, False, "elements of group 'plate' are up to"),
    ],
)
def test_shapes_of_shells(change: Callable[[Floats], Floats], triangles: bool, says: str) -> None:
    cells = fem.grids.triangles(QUADS) if triangles else QUADS
    assert shells(PLATE, cells, 0.004) == []
    (text,) = shells(change(PLATE), cells, 0.004)
    assert says in text
    assert "expect" in text


def test_distorted_bricks() -> None:
    def warnings(X: Floats) -> list[str]:
        structure = fem.Structure(X, (fem.Solids("block", BRICKS, STEEL),))
        return limits_of(structure, X).warnings(0.0)

    assert warnings(BOX) == []
    assert warnings(skew(BOX)) == []  # a parallelepiped is none
    moved = BOX.copy()
    inner = int(np.argmin(np.linalg.norm(BOX - 1 / 3, axis=1)))
    moved[inner] += [0.1, 0.1, 0.05]
    (text,) = warnings(moved)
    assert "8 of 27 bricks of group 'block' are distorted" in text
