"""Sparse affine matrices say the same as dense ones, and as complex steps."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse
from hypothesis import given
from hypothesis import strategies as st

from modefront.linalg.affine import (
    DenseAffine,
    Monomials,
    SparseAffine,
    sparse_affine,
    sparse_rows,
)


def pair(size: int, terms: int, parameters: int, seed: int) -> tuple[SparseAffine, DenseAffine]:
    """Return the same random matrix in both forms; some terms may be zero."""
    rng = np.random.default_rng(seed)
    result = []
    for _ in range(terms):
        half = scipy.sparse.random_array((size, size), density=2 / size**2, rng=rng)
        result.append(scipy.sparse.coo_array(half + half.T))
    coefficients = Monomials(rng.integers(-1, 4, (terms, parameters)).astype(float))
    full = np.array([A.toarray() for A in result]).reshape(terms, size, size)
    return sparse_affine(result, coefficients, size), DenseAffine(full, coefficients)


sizes = st.tuples(st.integers(2, 12), st.integers(1, 5), st.integers(1, 4), st.integers(0, 10**6))


@given(sizes)
def test_same_as_dense(case: tuple[int, int, int, int]) -> None:
    sparse, dense = pair(*case)
    rng = np.random.default_rng(case[3])
    theta, V = rng.uniform(0.5, 2.0, case[2]), rng.standard_normal((case[0], 3))
    assert sparse.size == dense.size
    assert sparse.used.tolist() == dense.used.tolist()
    assert sparse.at(theta).toarray() == pytest.approx(dense.at(theta), abs=1e-12)
    assert sparse.diagonals @ sparse.coefficients.values(theta) == pytest.approx(
        np.diag(dense.at(theta)), abs=1e-12
    )
    assert sparse.dense().terms == pytest.approx(dense.terms, abs=0)
    expected = dense.derivatives_times(theta, V)
    assert sparse.derivatives_times(theta, V) == pytest.approx(expected, abs=1e-12)
    rows = sparse.derivative_rows(theta, V).toarray().reshape(3, case[2], case[0])
    assert rows == pytest.approx(expected.transpose(1, 2, 0), abs=1e-12)
    given = theta, V, rng.standard_normal((case[0], 2, 4)), np.array([1, 0, 1])
    forms = [X.derivative_forms(*given) for X in (sparse, dense)]
    assert forms[0] == pytest.approx(forms[1], abs=1e-12)
    thetas = rng.uniform(0.5, 2.0, (3, case[2]))
    each = [dense.at(position) @ v for position, v in zip(thetas, V.T, strict=True)]
    assert sparse.each(thetas, V) == pytest.approx(np.transpose(each), abs=1e-12)
    projected = np.concatenate([V[:, :2].T, V[:, 2:].T]) @ (dense.terms @ V)
    assert sparse.project([V[:, :2], V[:, 2:]], V) == pytest.approx(projected, abs=1e-12)


@pytest.mark.parametrize("stride", [1, 2, 5])
def test_terms_that_touch_scattered_rows(stride: int) -> None:
    """Rows next to each other are a range, others are copied, or filled up where they are near."""
    size, rng = 4000, np.random.default_rng(stride)
    other = np.arange(0, size - 1, stride)
    values = np.concatenate([rng.standard_normal((2, other.size)).ravel(), np.ones(other.size)])
    row, column = np.tile(other, 3), np.concatenate([other, other + 1, other])
    half = scipy.sparse.coo_array((values, (row, column)), shape=(size, size))
    A = sparse_affine([scipy.sparse.coo_array(half + half.T)], Monomials(np.eye(1)), size)
    X, theta = rng.standard_normal((size, 3)), np.array([0.7])
    full = A.at(np.ones(1))
    assert A.each(np.tile(theta, (3, 1)), X) == pytest.approx(0.7 * (full @ X), abs=1e-12)
    assert A.project([X], X)[0] == pytest.approx(X.T @ (full @ X), abs=1e-9)
    assert A.derivatives_times(theta, X)[:, :, 0] == pytest.approx(full @ X, abs=1e-12)


@given(sizes)
def test_derivatives_against_complex_step(case: tuple[int, int, int, int]) -> None:
    sparse, _ = pair(*case)
    rng = np.random.default_rng(case[3])
    theta, V = rng.uniform(0.5, 2.0, case[2]), rng.standard_normal((case[0], 2))
    result = sparse.derivatives_times(theta, V)
    for i in range(case[2]):
        step = theta + 1e-30j * np.eye(case[2])[i]
        values = sparse.terms @ np.prod(step**sparse.coefficients.exponents, axis=1)
        parts = values.imag / 1e-30, sparse.indices, sparse.indptr
        slope = scipy.sparse.csr_array(parts, shape=(case[0], case[0]))
        assert result[:, :, i] == pytest.approx(slope @ V, abs=1e-10)


def test_pattern_is_the_union_and_does_not_depend_on_theta() -> None:
    spring = scipy.sparse.coo_array(np.array([[1.0, -1.0], [-1.0, 1.0]]))
    ground = scipy.sparse.coo_array(np.array([[1.0, 0.0], [0.0, 0.0]]))
    A = sparse_affine([ground, spring], Monomials(np.eye(2)), 2)
    assert A.at(np.array([1.0, 0.0])).nnz == A.at(np.array([1.0, 1.0])).nnz == 4
    assert A.indptr.dtype == A.indices.dtype == np.int32


def test_only_the_rows_a_term_touches_are_computed() -> None:
    size = 1000
    local = scipy.sparse.coo_array(([2.0], ([7], [7])), shape=(size, size))
    A = sparse_affine([local], Monomials(np.eye(1)), size)
    assert A.derivative_rows(np.ones(1), np.ones((size, 3))).nnz == 3


def test_rows_are_placed_without_their_zeros_and_what_is_given_stays() -> None:
    values, columns = np.array([[0.0, 2.0], [3.0, 0.0]]), np.array([[2, 0], [1, 2]])
    rows = sparse_rows(values, columns, 3)
    assert rows.toarray().tolist() == [[2, 0, 0], [0, 3, 0]]
    assert rows.nnz == 2
    assert values.tolist() == [[0, 2], [3, 0]]
    assert columns.tolist() == [[2, 0], [1, 2]]
