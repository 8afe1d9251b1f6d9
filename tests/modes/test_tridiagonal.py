"""The lowest modes of dense matrices by a tridiagonal one, against closed forms and all modes."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg

from modefront._typing import Floats
from modefront.linalg.affine import DenseAffine, Monomials, first_axis
from modefront.modes import dense, tridiagonal
from modefront.modes.tridiagonal import lowest_modes

N, COUNT = 150, 6


def spring(i: int) -> Floats:
    """Return the stiffness of the spring below mass i of a chain."""
    out = np.zeros((N, N))
    out[i, i] = 1.0
    if i:
        out[i - 1, i - 1], out[i, i - 1], out[i - 1, i] = 1.0, -1.0, -1.0
    return out


def chain(members: int) -> DenseAffine:
    """Return the stiffness of a chain whose members are parameters."""
    parts = np.array_split(np.arange(N), members)
    terms = np.array([sum(spring(i) for i in part) for part in parts])
    return DenseAffine(terms, Monomials(np.eye(members)))


def masses(members: int) -> DenseAffine:
    """Return unit masses, and a part of them that the first parameter adds."""
    added = np.diag((np.arange(N) < 20).astype(float))
    exponents = np.vstack([np.zeros(members), np.eye(members)[0]])
    return DenseAffine(np.array([np.eye(N), 0.1 * added]), Monomials(exponents))


def test_a_uniform_chain_has_its_closed_form() -> None:
    modes = lowest_modes(chain(1).at(np.ones(1)), np.eye(N), COUNT)
    assert modes is not None
    k = np.arange(1, N + 1)
    exact = 4 * np.sin((2 * k - 1) * np.pi / (2 * (2 * N + 1))) ** 2
    np.testing.assert_allclose(modes.lam, exact, rtol=1e-9)
    np.testing.assert_allclose(modes.lam[:COUNT], exact[:COUNT], rtol=1e-12)
    shape = np.sin(np.outer(np.arange(1, N + 1), (2 * k[:COUNT] - 1) * np.pi / (2 * N + 1)))
    shape /= np.linalg.norm(shape, axis=0)
    cosines = (shape * modes.Phi[:, :COUNT]).sum(axis=0)
    np.testing.assert_allclose(np.abs(cosines), 1.0, rtol=1e-12)


def test_derivatives_are_those_of_the_sum_over_all_modes() -> None:
    K, M, theta = chain(4), masses(4), np.array([1.0, 1.3, 0.7, 2.0])
    sensors = np.eye(N)[[9, 60, 149]]
    few = lowest_modes(K.at(theta), M.at(theta), COUNT)
    assert few is not None
    every = dense.decompose(K.at(theta), M.at(theta))
    dlam, S, *_ = dense.nelson(K, M, theta, every, COUNT)
    dphi = first_axis(sensors @ every.X, S[:, :COUNT])
    signs = np.sign((few.Phi[:, :COUNT] * every.Phi[:, :COUNT]).sum(axis=0))
    result = tridiagonal.derivatives(K, M, sensors, theta, few, COUNT)
    assert not result.coincident.any()
    np.testing.assert_allclose(result.dlam, dlam[:COUNT], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(result.dphi * signs[:, None], dphi, rtol=1e-8, atol=1e-9)


def test_coincident_modes_are_told_by_their_subspace() -> None:
    half = N // 2
    one = np.zeros((2, N, N))
    for j, own in enumerate((slice(0, half), slice(half, N))):
        one[j, own, own] = chain(1).terms[0][:half, :half]
        one[j, own, own][-1, -1] = 1.0
    K = DenseAffine(one, Monomials(np.eye(2)))
    M = DenseAffine(np.eye(N)[None], Monomials(np.zeros((1, 2))))
    theta = np.ones(2)
    few = lowest_modes(K.at(theta), M.at(theta), COUNT)
    assert few is not None
    np.testing.assert_allclose(few.lam[:COUNT:2], few.lam[1:COUNT:2], rtol=1e-10)
    assert np.abs(few.Phi.T @ few.Phi - np.eye(few.Phi.shape[1])).max() < 1e-10
    result = tridiagonal.derivatives(K, M, np.eye(N)[[3, 140]], theta, few, COUNT)
    assert result.coincident.all()
    # The parameter of one chain moves one of two equal eigenvalues in proportion.
    expected = np.stack([np.zeros(3), few.lam[:COUNT:2]], axis=1).ravel()
    np.testing.assert_allclose(result.dlam, np.stack([expected, expected], axis=1), atol=1e-12)


@pytest.mark.parametrize("case", ["small", "many", "free", "indefinite"])
def test_other_matrices_are_solved_for_all_modes(case: str) -> None:
    K, M, count = chain(1).at(np.ones(1)), np.eye(N), COUNT
    if case == "small":
        K, M = K[:40, :40], M[:40, :40]
    elif case == "many":
        count = N // 2
    elif case == "free":
        K = K - spring(0)
    else:
        K = K - 0.1 * np.eye(N)
    assert lowest_modes(K, M, count) is None
    if case == "free":
        lam = dense.lowest(K, M, count).lam
        np.testing.assert_allclose(lam[1:COUNT], scipy.linalg.eigvalsh(K)[1:COUNT], rtol=1e-9)
