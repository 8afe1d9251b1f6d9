"""Both sparse factorisations: solutions, inertia, one analysis for many matrices, the choice."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
import scipy.sparse
from hypothesis import given
from hypothesis import strategies as st

from modefront._typing import Floats
from modefront.linalg import factorisation
from modefront.linalg.factorisation import (
    LowerPattern,
    SingularMatrixError,
    Symbolic,
    lower_pattern,
    rslab_ldl,
    superlu,
)

ANALYSES = {"rslab": rslab_ldl.analyse, "superlu": superlu.analyse}

analyses = pytest.mark.parametrize("analyse", ANALYSES.values(), ids=ANALYSES)


def symmetric(size: int, seed: int) -> tuple[LowerPattern, Callable[[float], Floats], Floats]:
    """Return a pattern, the values of A - sigma I on it, and A, which is positive definite."""
    rng = np.random.default_rng(seed)
    half = scipy.sparse.random_array((size, size), density=min(1.0, 3 / size), rng=rng).toarray()
    A = half @ half.T + np.diag(rng.uniform(0.1, 2.0, size))
    i, j = np.nonzero(np.tril(A))
    pattern = lower_pattern(j * size + i, size)
    columns = np.repeat(np.arange(size), np.diff(pattern.indptr))

    def values(sigma: float) -> Floats:
        out: Floats = (A - sigma * np.eye(size))[pattern.indices, columns]
        return out

    return pattern, values, A


@analyses
@given(st.integers(1, 40), st.integers(0, 10**6))
def test_solutions_and_inertia(
    analyse: Callable[[LowerPattern], Symbolic], size: int, seed: int
) -> None:
    pattern, values, A = symmetric(size, seed)
    symbolic = analyse(pattern)
    eigenvalues = np.linalg.eigvalsh(A)
    between = (eigenvalues[:-1] + eigenvalues[1:]) / 2
    wide = between[np.diff(eigenvalues) > 1e-3 * eigenvalues[-1]]
    for sigma in [0.0, *wide]:
        factor = symbolic.factor(values(sigma))
        X = np.random.default_rng(seed).standard_normal((size, 3))
        B = A @ X - sigma * X
        assert factor.negative in (np.sum(eigenvalues < sigma), None)
        if factor.negative is not None:
            assert factor.solve(B) == pytest.approx(X, abs=1e-6)
    assert symbolic.factor(values(0.0)).negative == 0


@pytest.mark.parametrize(("allowed", "expected"), [("1", 1), ("2", 2), ("99", 4)])
def test_a_factor_takes_no_more_threads_than_the_environment_allows(
    allowed: str, expected: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    line = scipy.sparse.diags_array([2.0, -1.0, -1.0], offsets=[0, 1, -1], shape=(10, 10))
    plane = scipy.sparse.kronsum(line, line)
    lower = scipy.sparse.tril(scipy.sparse.kronsum(plane, line)).tocsc()
    pattern = LowerPattern(lower.indptr, lower.indices)
    monkeypatch.setenv("RAYON_NUM_THREADS", allowed)
    factor = rslab_ldl.analyse(pattern).factor(lower.data)
    assert factor.ldl.diagnostics()["threads"] == expected


@analyses
def test_pivots_off_the_diagonal(analyse: Callable[[LowerPattern], Symbolic]) -> None:
    pattern = LowerPattern(np.array([0, 2, 3]), np.array([0, 1, 1]))
    factor = analyse(pattern).factor(np.array([0.0, 1.0, 0.0]))
    assert factor.negative in (1, None)
    assert factor.solve(np.array([[2.0], [3.0]])) == pytest.approx(np.array([[3.0], [2.0]]))


@analyses
def test_a_singular_matrix_is_an_error_or_has_no_inertia(
    analyse: Callable[[LowerPattern], Symbolic],
) -> None:
    symbolic = analyse(LowerPattern(np.array([0, 1, 2]), np.array([0, 1])))
    with pytest.raises(SingularMatrixError):
        symbolic.factor(np.array([1.0, 0.0]))


def test_growth_leaves_the_inertia_of_superlu_open() -> None:
    pattern = LowerPattern(np.array([0, 2, 3]), np.array([0, 1, 1]))
    factor = superlu.analyse(pattern).factor(np.array([1e-14, 1.0, 1e-14]))
    assert factor.negative is None


def test_patterns_hold_the_diagonal_and_no_entry_twice() -> None:
    pattern = lower_pattern(np.array([1, 1]), 3)
    assert pattern.keys.tolist() == [0, 1, 4, 8]
    assert pattern.size == 3


def test_rslab_is_taken_where_it_is_there(monkeypatch: pytest.MonkeyPatch) -> None:
    pattern = LowerPattern(np.array([0, 1]), np.array([0]))
    factorisation._best.cache_clear()
    assert isinstance(factorisation.analyse(pattern), rslab_ldl.RslabSymbolic)
    monkeypatch.setitem(sys.modules, "modefront.linalg.factorisation.rslab_ldl", None)
    monkeypatch.delattr(factorisation, "rslab_ldl")
    factorisation._best.cache_clear()
    assert isinstance(factorisation.analyse(pattern), superlu.SuperluSymbolic)
    factorisation._best.cache_clear()


@dataclass(frozen=True)
class Wrong:
    """A factorisation that is off by a factor."""

    factor_of_error: float
    negative: int

    def factor(self, values: Floats) -> Wrong:
        return self

    def solve(self, block: Floats) -> Floats:
        return self.factor_of_error * block


@analyses
def test_sound(analyse: Callable[[LowerPattern], Symbolic]) -> None:
    assert factorisation.is_sound(analyse)


def test_what_is_not_sound_is_not_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not factorisation.is_sound(lambda pattern: Wrong(1.1, 4))
    monkeypatch.setattr(rslab_ldl, "analyse", lambda pattern: Wrong(1.1, 4))
    factorisation._best.cache_clear()
    pattern = LowerPattern(np.array([0, 1]), np.array([0]))
    assert isinstance(factorisation.analyse(pattern), superlu.SuperluSymbolic)
    factorisation._best.cache_clear()
