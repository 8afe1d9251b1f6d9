"""Second derivatives of modes against 50-digit arithmetic, and what holds of all of them."""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from modefront._typing import Floats
from modefront.linalg.affine import DenseAffine, Monomials
from modefront.modes.dense import modes
from modefront.modes.result import Modes

SIGMA = mp.mpf(1) / 7


def at(A: DenseAffine, theta: list[mp.mpf]) -> mp.matrix:
    out = mp.zeros(A.size)
    for term, powers in zip(A.terms, A.coefficients.exponents, strict=True):
        c = mp.fprod(x ** mp.mpf(float(e)) for x, e in zip(theta, powers, strict=True) if e)
        out += c * mp.matrix(term.tolist())
    return out


def precise(
    K: DenseAffine,
    M: DenseAffine,
    theta: list[mp.mpf],
    weights: tuple[Floats, Floats],
    found: Modes,
) -> np.ndarray[Any, Any]:
    """Return sum_r w_r lam_r + v_r^T phi_r, (n,), with signs as in the modes found."""
    w, v = weights
    Kt, Mt = at(K, theta), at(M, theta)
    inverse = mp.cholesky(Kt + SIGMA * Mt) ** -1
    mu, Q = mp.eigsy(inverse * Mt * inverse.T)
    X, size, out = inverse.T * Q, K.size, np.array([mp.mpf(0)] * len(w))
    for r in range(w.shape[1]):
        q = size - 1 - r
        phi = [X[k, q] / mp.sqrt(mu[q]) for k in range(size)]
        sign = mp.sign(mp.fsum(x * float(y) for x, y in zip(phi, found.phi[:, r], strict=True)))
        out += w[:, r].astype(object) * (1 / mu[q] - SIGMA)
        out += v[:, :, r].astype(object) @ (sign * np.array(phi))
    return out


def precise_hessian(
    K: DenseAffine, M: DenseAffine, theta: Floats, weights: tuple[Floats, Floats], found: Modes
) -> Floats:
    p, out = theta.size, np.zeros((len(weights[0]), theta.size, theta.size))
    with mp.workdps(50):
        h = mp.mpf(10) ** -12

        def value(*steps: tuple[int, int]) -> np.ndarray[Any, Any]:
            moved = [mp.mpf(float(x)) for x in theta]
            for i, times in steps:
                moved[i] += times * h
            return precise(K, M, moved, weights, found)

        here = value()
        for i in range(p):
            out[:, i, i] = (value((i, 1)) - 2 * here + value((i, -1))) / h**2
            for j in range(i):
                same = value((i, 1), (j, 1)) + value((i, -1), (j, -1))
                other = value((i, 1), (j, -1)) + value((i, -1), (j, 1))
                out[:, i, j] = out[:, j, i] = (same - other) / (4 * h**2)
    return out


def assert_exact(
    K: DenseAffine, M: DenseAffine, theta: Floats, count: int, tolerance: float = 1e-8
) -> None:
    """Compare Hessians of eigenvalues, of shapes and of sums of both with precise ones.

    Some are zero: beside the relative tolerance there is one of the rounding of what is summed up.
    """
    rng = np.random.default_rng(7)
    found = modes(K, M, np.eye(K.size), theta, count, derivatives=True)
    w, v = rng.normal(size=(3, count)), rng.normal(size=(3, K.size, count))
    w[1], v[0], v[2, :, : count // 2] = 0, 0, 0
    result = found.second_derivatives(w, v)
    assert result is not None
    for k, expected in enumerate(precise_hessian(K, M, theta, (w, v), found)):
        size = np.abs(w[k] * found.lam).sum() + np.abs(v[k] * found.phi).sum()
        most = tolerance * np.abs(expected).max() + 1e-13 * size
        assert np.abs(result[k] - expected).max() <= most, k


def spring(size: int, i: int, j: int | None = None) -> Floats:
    """Return the stiffness of a unit spring between two masses, or to the ground."""
    out = np.zeros((size, size))
    out[i, i] = 1.0
    if j is not None:
        out[j, j], out[i, j], out[j, i] = 1.0, -1.0, -1.0
    return out


def linear(terms: list[Floats], parameters: int) -> DenseAffine:
    """Return terms of which the last ones belong to the parameters."""
    constant = np.zeros((len(terms) - parameters, parameters))
    return DenseAffine(np.array(terms), Monomials(np.vstack([constant, np.eye(parameters)])))


def constant(matrix: Floats, parameters: int) -> DenseAffine:
    return affine(matrix[None], np.zeros((1, parameters)))


def affine(terms: Floats, exponents: Floats) -> DenseAffine:
    return DenseAffine(terms, Monomials(exponents))


def test_chains_are_exact() -> None:
    springs = [spring(3, 0), *(spring(3, i, i - 1) for i in (1, 2))]
    mass = [np.diag([1.0, 1, 2]), *(np.diag(row) for row in 0.3 * np.eye(3))]
    theta = np.array([1.0, 1.3, 0.8])
    assert_exact(linear(springs, 3), constant(mass[0], 3), theta, 3)
    assert_exact(linear(springs, 3), linear(mass, 3), theta, 2)


def beam(size: int) -> tuple[Floats, Floats, Floats]:
    """Return bending and axial stiffness and mass of clamped beam elements, for L = 1."""
    bending = np.array([[12.0, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]])
    mass = np.array([[156.0, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]])
    B, A, M = (np.zeros((2 * size + 2, 2 * size + 2)) for _ in range(3))
    for e in range(size):
        own = slice(2 * e, 2 * e + 4)
        B[own, own] += bending
        M[own, own] += mass / 420
        A[own, own] += np.diag([1.0, 0, 1, 0])
    return B[2:, 2:], A[2:, 2:], M[2:, 2:]


def test_products_of_powers_are_exact() -> None:
    # E t^3 / L^3 and E sqrt(t) in K, t L and 1/L in M: parameters E, t, L.
    B, A, mass = beam(2)
    K = affine(np.array([B, 0.3 * A]), np.array([[1.0, 3, -3], [1, 0.5, 0]]))
    M = affine(np.array([mass, 0.2 * A, 0.1 * A]), np.array([[0.0, 1, 1], [0, 0, -1], [0, 0, 0]]))
    assert_exact(K, M, np.array([1.2, 0.9, 1.1]), 4)


def test_massless_degrees_of_freedom_are_exact() -> None:
    springs = [spring(5, 0), *(spring(5, i, i - 1) for i in (1, 2, 3, 4))]
    K = linear([springs[3] + springs[4], *springs[:3]], 3)
    masses = np.diag([0.0, 1, 0, 2, 1]), np.diag([0.0, 0, 0, 0, 1])
    M = affine(np.array(masses), np.array([[0.0, 0, 0], [0, 1, 2]]))
    assert_exact(K, M, np.array([1.0, 1.4, 0.7]), 3)


def test_free_structures_are_exact() -> None:
    springs = [spring(5, i, i - 1) for i in (1, 2, 3, 4)]
    K = linear([springs[3], *springs[:3]], 3)
    M = affine(np.array([np.eye(5), np.diag([1.0, 2, 0, 0, 1])]), np.eye(3)[[1, 2]] * [[0], [1]])
    theta = np.array([1.0, 1.4, 0.7])
    found = modes(K, M, np.eye(5), theta, 4, derivatives=True)
    rng = np.random.default_rng(0)
    w, v = rng.normal(size=4), rng.normal(size=(5, 4))
    w[0], v[:, 0] = 0.0, 0.0  # the rigid-body mode
    result = found.second_derivatives(w[None], v[None])
    assert result is not None
    expected = precise_hessian(K, M, theta, (w[None], v[None]), found)
    assert np.abs(result - expected).max() <= 1e-8 * np.abs(expected).max()


@pytest.mark.parametrize("gap", [1e-2, 1e-4, 1e-6])
def test_close_modes_are_exact(gap: float) -> None:
    C = np.array([[0.3, 0.7, -0.2], [0.7, -0.4, 0.5], [-0.2, 0.5, 0.1]])
    D = np.array([[0.1, -0.3, 0.4], [-0.3, 0.2, 0.6], [0.4, 0.6, -0.5]])
    K = affine(np.array([np.diag([1.0, 1.0 + gap, 4.0]), C, D]), np.eye(3, 2, -1))
    M = affine(np.array([np.eye(3), 0.1 * np.abs(D) + np.eye(3)]), np.array([[0.0, 0], [0, 2]]))
    assert_exact(K, M, np.zeros(2), 2)


@settings(max_examples=6, deadline=None)
@given(st.integers(0, 2**31), st.integers(2, 6), st.integers(1, 3))
def test_random_matrices_are_exact(seed: int, size: int, p: int) -> None:
    rng = np.random.default_rng(seed)
    roots = rng.normal(size=(2, p + 1, size, size))
    terms = roots @ roots.transpose(0, 1, 3, 2) + 0.5 * np.eye(size)
    exponents = rng.integers(-2, 4, size=(2, p + 1, p)).astype(float)
    K, M = (affine(*each) for each in zip(terms, exponents, strict=True))
    theta, count = rng.uniform(0.7, 1.4, p), min(size, 3)
    lam = modes(K, M, np.eye(size), theta, size, derivatives=False).lam
    assume((np.diff(lam) > 1e-3 * lam[1:]).all())
    assert_exact(K, M, theta, count)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**31), st.floats(-6, 6))
def test_hessians_are_symmetric_and_scale_with_the_matrices(seed: int, power: float) -> None:
    # K and M times s: eigenvalues are the same, and mass-normalised modes are over sqrt(s).
    rng = np.random.default_rng(seed)
    roots = rng.normal(size=(2, 3, 6, 6))
    terms = roots @ roots.transpose(0, 1, 3, 2)
    exponents = np.array([[[0.0, 0], [1, 0], [0, 3]], [[0, 0], [0, 1], [-1, 0]]])
    s, theta = 10.0**power, np.array([1.1, 0.8])
    w, v = rng.normal(size=(2, 3)), rng.normal(size=(2, 6, 3))
    found = []
    for factor in (1.0, s):
        K, M = (affine(factor * A, e) for A, e in zip(terms, exponents, strict=True))
        here = modes(K, M, np.eye(6), theta, 3, derivatives=True)
        assume(not here.coincident.any())
        sign = np.sign(here.phi[0])
        hessian = here.second_derivatives(w, np.sqrt(factor) * sign * v)
        assert hessian is not None
        assert np.abs(hessian - hessian.transpose(0, 2, 1)).max() <= 1e-13 * np.abs(hessian).max()
        found.append(hessian)
    assert np.abs(found[1] - found[0]).max() <= 1e-7 * np.abs(found[0]).max()


def test_coincident_modes_have_no_second_derivatives() -> None:
    terms = np.array([np.diag([1.0, 0, 0]), np.diag([0, 1.0, 0]), np.diag([0, 0, 5.0])])
    K, M = linear(list(terms), 3), constant(np.eye(3), 3)
    found = modes(K, M, np.eye(3), np.array([1.0, 1.0, 1.0]), 3, derivatives=True)
    w, none = np.eye(3), np.zeros((1, 3, 3))
    assert found.coincident.tolist() == [True, True, False]
    assert found.second_derivatives(w[:1], none) is None
    assert found.second_derivatives(w[2:], none) is not None
    assert found.second_derivatives(np.ones((1, 3)), none) is None
    assert found.second_derivatives(0 * w[:1], np.ones((1, 3, 3))) is None
    without = modes(K, M, np.eye(3), np.ones(3), 3, derivatives=False)
    with pytest.raises(ValueError, match="expected modes with derivatives"):
        without.second_derivatives(w[:1], none)


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**31))
def test_monomials_have_exact_second_derivatives(seed: int) -> None:
    rng = np.random.default_rng(seed)
    coefficients = Monomials(rng.integers(-2, 4, size=(4, 3)).astype(float))
    theta, forms = rng.uniform(0.5, 2, 3), rng.normal(size=(2, 4))
    result = coefficients.second_derivatives(theta, forms)
    for i in range(3):
        h = 1e-4 * np.eye(3)[i]
        slopes = {k: coefficients.jacobian(theta + k * h) for k in (-2, -1, 1, 2)}
        rate = (8 * (slopes[1] - slopes[-1]) - (slopes[2] - slopes[-2])) / 12e-4
        np.testing.assert_allclose(result[:, :, i], forms @ rate, rtol=1e-8, atol=1e-8)
    linear_one = Monomials(np.array([[0.0, 1], [0, 0]]))
    assert not linear_one.curved
    assert not linear_one.second_derivatives(np.zeros(2), np.ones((1, 2))).any()


def test_sums_of_eigenvalues_alone_have_second_derivatives() -> None:
    size, theta, h = 120, np.array([1.2]), 1e-5
    line = [spring(size, i, i + 1) for i in range(size - 1)]
    K = linear([spring(size, 0) + sum(line[60:]), sum(line[:60], np.zeros((size, size)))], 1)
    M, weights = constant(np.eye(size), 1), np.ones((1, 3))
    found = modes(K, M, np.eye(size), theta, 3, derivatives=True)
    result = found.second_derivatives(weights, np.zeros((1, size, 3)))
    ahead, behind = (modes(K, M, np.eye(size), theta + s, 3, True).dlam.sum() for s in (h, -h))
    assert result == pytest.approx((ahead - behind) / (2 * h), rel=1e-6)
