"""Elements say what they cannot do."""

from __future__ import annotations

import numpy as np
import pytest
from structures import STEEL

from modefront import fem
from modefront._typing import Floats, Ints
from modefront.fem.check import limits_of

PLATE, QUADS = fem.grids.plate(1.0, 1.0, 6, 6)
BOX, BRICKS = fem.grids.box((1.0, 1.0, 1.0), (3, 3, 3))


def shells(X: Floats, cells: Ints, thickness: float, *scaled: str) -> tuple[str, ...]:
    groups = (fem.Shells("plate", cells, STEEL, thickness),)
    parameters = tuple(fem.Parameter(name, "thickness", ("plate",)) for name in scaled)
    return tuple(limits_of(fem.Structure(X, groups, parameters=parameters), X))


def roof(X: Floats) -> Floats:
    return np.column_stack([np.sin(X[:, 0]), X[:, 1], np.cos(X[:, 0])])


@pytest.mark.parametrize("triangles", [False, True])
def test_coarse_curved_shells(triangles: bool) -> None:
    cells = fem.grids.triangles(QUADS) if triangles else QUADS
    assert shells(PLATE, cells, 0.001) == ()
    assert shells(roof(PLATE), cells, 0.01) == ()
    (text,) = shells(roof(PLATE), cells, 0.001)
    assert "elements of group 'plate' are up to" in text
    assert "expect" in text


def test_triangles_along_the_longer_diagonals() -> None:
    leaning = np.column_stack([PLATE[:, 0] + PLATE[:, 1], PLATE[:, 1], PLATE[:, 2]])
    assert shells(leaning, fem.grids.triangles(np.roll(QUADS, 1, axis=1)), 0.001) == ()
    (text,) = shells(leaning, fem.grids.triangles(QUADS), 0.001)
    assert "half of the triangles of group 'plate' have angles of 135° and more" in text


def test_thickness_that_is_a_parameter() -> None:
    assert shells(PLATE, QUADS, 0.1) == ()
    assert shells(PLATE, QUADS, 0.01, "t") == ()
    (text,) = shells(PLATE, QUADS, 0.1, "t")
    assert "shells of group 'plate' are as small as 1.7 of their thickness" in text


def test_distorted_bricks() -> None:
    def warnings(X: Floats) -> tuple[str, ...]:
        structure = fem.Structure(X, (fem.Solids("block", BRICKS, STEEL),))
        return tuple(limits_of(structure, X))

    assert warnings(BOX) == ()
    assert warnings(BOX + np.outer(BOX[:, 1], [1.0, 0.0, 0.0])) == ()  # a parallelepiped is none
    moved = BOX.copy()
    inner = int(np.argmin(np.linalg.norm(BOX - 1 / 3, axis=1)))
    moved[inner] += [0.1, 0.1, 0.05]
    (text,) = warnings(moved)
    assert "8 of 27 bricks of group 'block' are distorted" in text
