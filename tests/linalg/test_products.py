"""Products with tall matrices, in blocks of rows."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
import scipy.sparse
from hypothesis import given
from hypothesis import strategies as st

from modefront._typing import Floats
from modefront.linalg import products


def close(result: Floats, expected: Floats) -> None:
    np.testing.assert_allclose(result, expected, rtol=0, atol=1e-10)


@given(st.integers(1, 3000), st.integers(1, 40), st.integers(1, 40))
def test_blocks_cover_all_rows(rows: int, a: int, b: int) -> None:
    rng = np.random.default_rng(rows)
    X, Y = rng.standard_normal((rows, a)), rng.standard_normal((rows, b))
    C = rng.standard_normal((a, b))
    close(products.gram(X, Y), X.T @ Y)
    close(products.combine(X, C), X @ C)


def test_part_of_a_wider_array() -> None:
    V = np.random.default_rng(0).standard_normal((5000, 60))
    X, Y = V[:, :17], V[:, 20:24]
    close(products.gram(X, Y), X.T @ Y)
    close(products.combine(X, Y[:17]), X @ Y[:17])


@pytest.mark.parametrize(("a", "b"), [(300, 9), (9, 300), (130, 70), (65, 64)])
def test_wide_matrices_are_products_of_tiles(a: int, b: int) -> None:
    rng = np.random.default_rng(a)
    X, Y = rng.standard_normal((501, a)), rng.standard_normal((501, b))
    close(products.gram(X, Y), X.T @ Y)


def test_nothing_with_more_rows_than_a_block() -> None:
    tall = np.ones((3 * products.WORK, 1))
    assert products.gram(tall[:, :0], tall).shape == (0, 1)
    nothing = products.combine(tall[:, :0], np.zeros((0, 2)))
    assert nothing.shape == (len(tall), 2)
    assert not nothing.any()


@pytest.mark.parametrize("columns", [1, 2, 30, 200])
def test_sharing_among_threads_changes_no_digit(
    columns: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = np.random.default_rng(columns)
    A = scipy.sparse.random_array((5001, 5001), density=2e-3, format="csr", rng=rng)
    X, Y = rng.standard_normal((5001, columns)), rng.standard_normal((5001, 25))
    C = rng.standard_normal((columns, 40))

    def products_of() -> list[Floats]:
        return [products.gram(X, Y), products.combine(X, C), products.times(A, X)]

    whole = products_of()
    monkeypatch.setattr(products, "SHARED", 0)
    for threads in (1, 2, 3):
        with ThreadPoolExecutor(threads) as pool:
            monkeypatch.setattr(products, "shared_pool", lambda pool=pool, n=threads: (pool, n))
            for expected, shared in zip(whole, products_of(), strict=True):
                assert np.array_equal(expected, shared)
    close(whole[2], A @ X)


@pytest.mark.parametrize(("given", "expected"), [("3", 3), ("0", None), ("all", None), ("", None)])
def test_the_number_of_threads_is_that_of_the_environment(
    given: str, expected: int | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv(products.THREADS, raising=False)
    _, usual = products.shared_pool.__wrapped__()
    monkeypatch.setenv(products.THREADS, given)
    _, threads = products.shared_pool.__wrapped__()
    assert threads == (expected or usual)
