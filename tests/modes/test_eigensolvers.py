"""Eigensolvers: dense and sparse matrices of a model give the same."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from modefront.models.chain import chain

N = 40
THETA = np.array([2.0])
CHAIN = chain(["k"], [1.0] * N, [3.0] * N, stiffness_parameters=["k"] * N)
MODELS = (CHAIN, CHAIN.sparse())


def test_dense_and_sparse_matrices_solve_a_chain() -> None:
    r = np.arange(1, 4)
    expected = 4 * 3.0 * THETA[0] * np.sin((2 * r - 1) * np.pi / (4 * N + 2)) ** 2
    for model in MODELS:
        modes = model.modes(THETA, 3, derivatives=True)
        assert modes.lam == pytest.approx(expected, rel=1e-10)
        assert modes.dlam[:, 0] == pytest.approx(expected / THETA[0], rel=1e-9)
        full = model.full_modes(THETA, 3, np.eye(N, 1))
        assert full.lam == pytest.approx(expected, rel=1e-10)
        assert full.static == pytest.approx(np.full((N, 1), 1 / (3.0 * THETA[0])))
        assert not model.is_singular(THETA)


def test_dense_and_sparse_matrices_do_not_mix() -> None:
    mixed = replace(CHAIN, mass=CHAIN.sparse().mass)
    with pytest.raises(TypeError, match="both dense or both sparse"):
        mixed.modes(THETA, 1)
