"""Block Lanczos iteration: restarts, repeated eigenvalues, the end of the spectrum."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse

from modefront._typing import Floats
from modefront.errors import ModelError
from modefront.modes.lanczos import Ritz, greatest


def run(lam: Floats, mass: Floats, requested: int, block: int) -> Ritz:
    """Return the Ritz pairs of diagonal matrices, turned by a random rotation."""
    n = len(lam)
    turn = np.linalg.qr(np.random.default_rng(0).standard_normal((n, n)))[0]
    A = turn @ np.diag(lam) @ turn.T
    M = turn @ np.diag(mass) @ turn.T
    start = np.random.default_rng(1).standard_normal((n, block))
    sparse = scipy.sparse.csr_array(A), scipy.sparse.csr_array(M)
    return greatest(lambda B: turn @ ((turn.T @ B) / lam[:, None]), *sparse, start, requested)


def test_many_restarts() -> None:
    lam = np.linspace(1.0, 2.0, 300)
    result = run(lam, np.ones(300), 10, 2)
    assert result.converged >= 10
    assert 1 / result.mu[:10] == pytest.approx(lam[:10], rel=1e-12)


@pytest.mark.parametrize("block", [1, 2, 4])
def test_the_end_of_the_spectrum_is_found_whatever_is_repeated(block: int) -> None:
    lam = np.r_[np.full(7, 1.0), np.full(3, 2.0), np.arange(5.0, 25.0)]
    mass = np.r_[np.ones(10), np.zeros(20)]
    result = run(lam, mass, 12, block)
    assert result.complete
    assert np.sum(result.mu > 1e-10) == 10
    assert np.sort(1 / result.mu[:10]) == pytest.approx(lam[:10])


def test_vectors_are_orthonormal_in_a() -> None:
    lam = np.arange(1.0, 101.0) ** 2
    result = run(lam, np.ones(100), 6, 4)
    assert result.X[:, :6].T @ result.X[:, :6] == pytest.approx(np.diag(1 / lam[:6]), abs=1e-9)


def test_indefinite_mass() -> None:
    with pytest.raises(ModelError, match="mass matrix is indefinite"):
        run(np.arange(1.0, 51.0), np.r_[np.ones(49), -1.0], 6, 4)
