"""Products with tall matrices, in blocks of rows."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from modefront.modes import products


@given(st.integers(1, 3000), st.integers(1, 40), st.integers(1, 40))
def test_blocks_cover_all_rows(rows: int, a: int, b: int) -> None:
    rng = np.random.default_rng(rows)
    X, Y = rng.standard_normal((rows, a)), rng.standard_normal((rows, b))
    C = rng.standard_normal((a, b))
    assert products.gram(X, Y) == pytest.approx(X.T @ Y, abs=1e-10)
    assert products.combine(X, C) == pytest.approx(X @ C, abs=1e-10)


def test_part_of_a_wider_array() -> None:
    V = np.random.default_rng(0).standard_normal((5000, 60))
    X, Y = V[:, :17], V[:, 20:24]
    assert products.gram(X, Y) == pytest.approx(X.T @ Y, abs=1e-10)
    assert products.combine(X, Y[:17]) == pytest.approx(X @ Y[:17], abs=1e-10)


def test_nothing_with_more_rows_than_a_block() -> None:
    tall = np.ones((3 * products.WORK, 1))
    assert products.gram(tall[:, :0], tall).shape == (0, 1)
    assert products.combine(tall[:, :0], np.zeros((0, 2))).tolist() == [[0, 0]] * len(tall)
