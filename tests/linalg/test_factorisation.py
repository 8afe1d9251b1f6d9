"""Sparse factorisations: solutions, inertia, one analysis for many matrices."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import rslab
import scipy.sparse
from hypothesis import given
from hypothesis import strategies as st

from modefront._typing import Floats
from modefront.linalg.factorisation import SingularMatrixError, analyse, factor, factorise


def symmetric(size: int, seed: int) -> tuple[rslab.LdltSymbolic, Callable[[float], Floats], Floats]:
    """Return an analysis, the values of A - sigma I on it, and A, which is positive definite."""
    rng = np.random.default_rng(seed)
    half = scipy.sparse.random_array((size, size), density=min(1.0, 3 / size), rng=rng).toarray()
    A = half @ half.T + np.diag(rng.uniform(0.1, 2.0, size))
    i, j = np.nonzero(np.tril(A))
    analysis, keys = analyse(j * size + i, size)

    def values(sigma: float) -> Floats:
        out: Floats = (A - sigma * np.eye(size))[keys % size, keys // size]
        return out

    return analysis, values, A


@given(st.integers(1, 40), st.integers(0, 10**6))
def test_solutions_and_inertia(size: int, seed: int) -> None:
    analysis, values, A = symmetric(size, seed)
    eigenvalues = np.linalg.eigvalsh(A)
    between = (eigenvalues[:-1] + eigenvalues[1:]) / 2
    wide = between[np.diff(eigenvalues) > 1e-3 * eigenvalues[-1]]
    for sigma in [0.0, *wide]:
        known = factor(analysis, values(sigma))
        X = np.random.default_rng(seed).standard_normal((size, 3))
        B = A @ X - sigma * X
        assert known.negative in (np.sum(eigenvalues < sigma), None)
        if known.negative is not None:
            assert known.solve(B) == pytest.approx(X, abs=1e-6)
    assert factor(analysis, values(0.0)).negative == 0


@pytest.mark.parametrize(("allowed", "expected"), [("1", 1), ("2", 2), ("99", 4)])
def test_a_factor_takes_no_more_threads_than_the_environment_allows(
    allowed: str, expected: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    line = scipy.sparse.diags_array([2.0, -1.0, -1.0], offsets=[0, 1, -1], shape=(10, 10))
    plane = scipy.sparse.kronsum(line, line)
    monkeypatch.setenv("RAYON_NUM_THREADS", allowed)
    factors = factorise(scipy.sparse.kronsum(plane, line))
    assert factors.ldl.diagnostics()["threads"] == expected


def test_pivots_off_the_diagonal() -> None:
    factors = factorise(scipy.sparse.coo_array(np.array([[0.0, 1.0], [1.0, 0.0]])))
    assert factors.negative in (1, None)
    assert factors.solve(np.array([[2.0], [3.0]])) == pytest.approx(np.array([[3.0], [2.0]]))


def test_a_singular_matrix_is_an_error() -> None:
    with pytest.raises(SingularMatrixError):
        factorise(scipy.sparse.coo_array(np.diag([1.0, 0.0])))


def test_patterns_hold_the_diagonal_and_no_entry_twice() -> None:
    assert analyse(np.array([1, 1]), 3)[1].tolist() == [0, 1, 4, 8]
