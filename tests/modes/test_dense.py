"""Modes and derivatives against 50-digit arithmetic and closed forms."""

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from modefront._typing import Floats
from modefront.errors import ModelError
from modefront.linalg.affine import DenseAffine, Monomials
from modefront.modes.dense import lowest, modes
from modefront.modes.result import Modes


def random_affine(
    rng: np.random.Generator, size: int, parameters: int, shift: float
) -> DenseAffine:
    """Return base + sum theta_j A_j with positive definite terms."""
    roots = rng.normal(size=(parameters + 1, size, size))
    terms = roots @ roots.transpose(0, 2, 1)
    terms[0] += shift * np.eye(size)
    exponents = np.vstack([np.zeros(parameters), np.eye(parameters)])
    return DenseAffine(terms, Monomials(exponents))


def precise_modes(
    K: DenseAffine, M: DenseAffine, theta: list[mp.mpf]
) -> tuple[list[mp.mpf], mp.matrix]:
    def matrix_at(A: DenseAffine) -> mp.matrix:
        out = mp.matrix(A.terms[0].tolist())
        for value, term in zip(theta, A.terms[1:], strict=True):
            out += value * mp.matrix(term.tolist())
        return out

    inverse = mp.cholesky(matrix_at(M)) ** -1
    lam, Q = mp.eigsy(inverse * matrix_at(K) * inverse.T)
    return list(lam), inverse.T * Q


def precise_derivatives(
    K: DenseAffine, M: DenseAffine, theta: Floats, i: int, reference: Modes
) -> tuple[Floats, Floats]:
    """Return derivatives of lam and phi by parameter i, signs as in the reference."""
    h = mp.mpf(10) ** -18
    ahead = [mp.mpf(x) for x in theta]
    behind = list(ahead)
    ahead[i] += h
    behind[i] -= h
    lam_1, phi_1 = precise_modes(K, M, ahead)
    lam_0, phi_0 = precise_modes(K, M, behind)
    count, size = reference.lam.size, K.size
    dlam = np.array([float((lam_1[r] - lam_0[r]) / (2 * h)) for r in range(count)])
    dphi = np.zeros((size, count))
    for r in range(count):
        sign_1, sign_0 = (
            mp.sign(mp.fsum(phi[k, r] * reference.phi[k, r] for k in range(size)))
            for phi in (phi_1, phi_0)
        )
        for k in range(size):
            dphi[k, r] = float((sign_1 * phi_1[k, r] - sign_0 * phi_0[k, r]) / (2 * h))
    return dlam, dphi


@settings(max_examples=15, deadline=None)
@given(
    st.integers(0, 2**31), st.integers(2, 7), st.integers(1, 3), st.sampled_from([1e-3, 1.0, 1e4])
)
def test_derivatives_agree_with_50_digit_arithmetic(
    seed: int, size: int, parameters: int, scale: float
) -> None:
    rng = np.random.default_rng(seed)
    K, M = random_affine(rng, size, parameters, scale), random_affine(rng, size, parameters, 1.0)
    theta = rng.uniform(0.5, 2.0, parameters)
    count = min(size, 4)
    result = modes(K, M, np.eye(size), theta, count, derivatives=True)
    if result.coincident.any():
        return
    # Where eigenvalues are close, the problem itself amplifies rounding by this factor.
    lam = modes(K, M, np.eye(size), theta, size, derivatives=False).lam
    gap = min(np.diff(lam) / lam[1:]) if size > 1 else 1.0
    tolerance = max(1e-8, 1e-13 / gap)
    with mp.workdps(50):
        for i in range(parameters):
            dlam, dphi = precise_derivatives(K, M, theta, i, result)
            assert np.abs(result.dlam[:, i] - dlam).max() <= 1e-8 * np.abs(dlam).max()
            error = np.linalg.norm(result.dphi[:, :, i] - dphi, axis=0)
            assert (error <= tolerance * np.linalg.norm(dphi, axis=0) + 1e-13).all()


@pytest.mark.parametrize("gap", [1e-2, 1e-4, 1e-6])
def test_close_modes_have_exact_derivatives(gap: float) -> None:
    # K = diag(1, 1 + gap, 4) + theta C: perturbation theory gives d phi_1 = c_12 / -gap phi_2 + ...
    C = np.array([[0.3, 0.7, -0.2], [0.7, -0.4, 0.5], [-0.2, 0.5, 0.1]])
    lam = np.array([1.0, 1.0 + gap, 4.0])
    K = DenseAffine(np.array([np.diag(lam), C]), Monomials(np.array([[0.0], [1.0]])))
    M = DenseAffine(np.eye(3)[None], Monomials(np.zeros((1, 1))))
    result = modes(K, M, np.eye(3), np.zeros(1), 2, derivatives=True)
    for r in range(2):
        expected = sum(
            C[j, r] / (lam[r] - lam[j]) * np.eye(3)[j] for j in range(3) if j != r
        ) * np.sign(result.phi[r, r])
        assert result.dlam[r, 0] == pytest.approx(C[r, r], rel=1e-8)
        assert np.abs(result.dphi[:, r, 0] - expected).max() <= 1e-8 / gap
    assert not result.coincident.any()


@pytest.mark.parametrize("gap", [1, 5])
def test_modes_far_apart_are_exact_at_both_ends_of_the_spectrum(gap: int) -> None:
    """Eigenvalues of nine decades, with a wide gap among the low ones or among the high ones."""
    rng, size = np.random.default_rng(5), 8
    A = rng.normal(size=(2, size, size))
    powers = np.linspace(0, 3, size) + np.where(np.arange(size) >= gap, 1.8, 0)
    powers[3:5] = powers[3:5].mean() + np.array([-0.05, 0.05])
    scale = 10.0**powers
    terms = [np.outer(scale, scale) * (0.02 * a @ a.T + np.eye(size)) for a in A]
    K = DenseAffine(np.array(terms), Monomials(np.array([[0.0], [1.0]])))
    masses = [np.diag(x) for x in rng.uniform(0.5, 2, (2, size))]
    M, theta = DenseAffine(np.array(masses), K.coefficients), np.array([0.7])
    result = modes(K, M, np.eye(size), theta, size, derivatives=True)
    with mp.workdps(60):
        lam, _ = precise_modes(K, M, [mp.mpf(0.7)])
        dlam, dphi = precise_derivatives(K, M, theta, 0, result)
    assert result.lam == pytest.approx([float(x) for x in lam], rel=1e-9)
    assert result.dlam[:, 0] == pytest.approx(dlam, rel=1e-8)
    error = np.linalg.norm((result.dphi[:, :, 0] - dphi), axis=0)
    assert (error <= 1e-8 * np.linalg.norm(dphi, axis=0)).all()


def test_coincident_modes_say_so_and_keep_what_is_defined() -> None:
    # Two equal masses on equal springs, joined by theta_3: at theta_3 = 0 the modes coincide.
    terms = np.array([np.diag([1.0, 0, 0]), np.diag([0, 1.0, 0]), np.zeros((3, 3))])
    terms[2, :2, :2] = [[1, -1], [-1, 1]]
    terms[0, 2, 2] = 5.0
    terms[0, 0, 2] = terms[0, 2, 0] = 0.0
    K = DenseAffine(terms, Monomials(np.eye(3)))
    M = DenseAffine(np.eye(3)[None], Monomials(np.zeros((1, 3))))
    theta = np.array([1.0, 1.0, 0.0])
    result = modes(K, M, np.eye(3), theta, 3, derivatives=True)
    assert result.coincident.tolist() == [True, True, False]
    # Along each parameter alone, the eigenvalues leave at these rates, in ascending order.
    assert result.dlam[:2] == pytest.approx(np.array([[0, 0, 0], [1, 1, 2]]), abs=1e-12)
    # The subspace does not turn: nothing of the derivative leaves it.
    assert result.dphi[2, :2] == pytest.approx(0, abs=1e-12)


def test_the_derivative_of_a_coincident_subspace_is_exact() -> None:
    rng = np.random.default_rng(3)
    Q = np.linalg.qr(rng.normal(size=(5, 5)))[0]
    C = rng.normal(size=(5, 5))
    C = C + C.T
    lam = np.array([2.0, 2.0, 3.0, 5.0, 7.0])
    K = DenseAffine(np.array([Q @ np.diag(lam) @ Q.T, C]), Monomials(np.array([[0.0], [1.0]])))
    M = DenseAffine(np.eye(5)[None], Monomials(np.zeros((1, 1))))
    result = modes(K, M, np.eye(5), np.zeros(1), 1, derivatives=True)
    assert result.coincident.all()
    # The derivative of the projector applied to the mode: the sum over the modes outside.
    phi = result.phi[:, 0]
    outside = Q[:, 2:]
    expected = outside @ ((outside.T @ C @ phi) / (2.0 - lam[2:]))
    assert result.dphi[:, 0, 0] == pytest.approx(expected, rel=1e-10, abs=1e-12)


def test_massless_degrees_of_freedom_are_condensed() -> None:
    # Mass on two springs in series, the joint without mass: lam = k1 k2 / (k1 + k2) / m.
    terms = np.array([[[1.0, 0], [0, 0]], [[1, -1], [-1, 1]]])
    K = DenseAffine(terms, Monomials(np.eye(2)))
    M = DenseAffine(np.diag([0.0, 2.0])[None], Monomials(np.zeros((1, 2))))
    k1, k2 = theta = np.array([3.0, 5.0])
    result = modes(K, M, np.eye(2), theta, 1, derivatives=True)
    assert result.lam[0] == pytest.approx(k1 * k2 / (k1 + k2) / 2, rel=1e-13)
    expected = np.array([k2**2, k1**2]) / (k1 + k2) ** 2 / 2
    assert result.dlam[0] == pytest.approx(expected, rel=1e-12)
    assert result.phi[0, 0] / result.phi[1, 0] == pytest.approx(k2 / (k1 + k2), rel=1e-12)
    with pytest.raises(ModelError, match="only 1 have a finite frequency"):
        modes(K, M, np.eye(2), theta, 2, derivatives=True)


def test_rigid_body_modes_have_zero_frequency() -> None:
    spring = np.array([[1.0, -1, 0], [-1, 2, -1], [0, -1, 1]])
    K = DenseAffine(1e6 * spring[None], Monomials(np.ones((1, 1))))
    M = DenseAffine(np.eye(3)[None], Monomials(np.zeros((1, 1))))
    result = modes(K, M, np.eye(3), np.ones(1), 3, derivatives=True)
    assert result.lam == pytest.approx([0, 1e6, 3e6], rel=1e-9, abs=1e-3)
    assert result.dlam[:, 0] == pytest.approx([0, 1e6, 3e6], rel=1e-9, abs=1e-3)
    assert result.frequency[0] == pytest.approx(0, abs=1e-2)
    assert np.isfinite(result.dfrequency).all()


@pytest.mark.parametrize(
    ("K", "M", "message"),
    [
        ([1.0, -1.0], [1.0, 1.0], "stiffness matrix is indefinite"),
        ([-1e-6, 5e-7, 1.0], [1.0, 1.0, 1.0], "stiffness matrix is indefinite"),
        ([1.0, 2.0], [1.0, -1.0], "mass matrix is indefinite"),
        ([1.0, 2.0], [0.0, 0.0], "no mass on its diagonal"),
        ([3000.0, 1.4e-312], [2.5, 1.0], "a stiffness vanishes"),
    ],
)
def test_indefinite_matrices_are_refused(K: list[float], M: list[float], message: str) -> None:
    constant = Monomials(np.zeros((1, 1)))
    stiffness, mass = (DenseAffine(np.diag(x)[None], constant) for x in (K, M))
    with pytest.raises(ModelError, match=message):
        modes(stiffness, mass, np.eye(2), np.ones(1), 1, derivatives=True)


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 2**31))
def test_monomials_have_exact_derivatives(seed: int) -> None:
    rng = np.random.default_rng(seed)
    coefficients = Monomials(rng.integers(0, 4, size=(4, 3)).astype(float))
    theta = rng.uniform(-2, 2, 3)
    h = 1e-20
    for i in range(3):
        step = theta.astype(complex)
        step[i] += 1j * h
        expected = np.prod(step**coefficients.exponents, axis=1).imag / h
        assert coefficients.jacobian(theta)[:, i] == pytest.approx(expected, rel=1e-8, abs=1e-12)


def test_the_lowest_modes_alone_are_those_of_all() -> None:
    """They are left to the others where K is singular or indefinite, and where digits are lost."""
    rng = np.random.default_rng(4)
    A, B = rng.normal(size=(2, 12, 12))
    K, M = A @ A.T + np.eye(12), B @ B.T + np.eye(12)
    one = Monomials(np.zeros((1, 0)))
    whole = modes(
        DenseAffine(K[None], one), DenseAffine(M[None], one), np.eye(12), np.zeros(0), 4, False
    )
    found = lowest(K, M, 4)
    assert found
    assert found[0] == pytest.approx(whole.lam, rel=1e-12)
    assert np.abs(found[1]) == pytest.approx(np.abs(whole.phi), rel=1e-9)
    scale = np.logspace(0, 7, 12)
    far = np.diag(scale), np.diag(1 / scale)
    for stiffness, mass in ((K - K, M), (K - 9 * np.eye(12), M), far):
        assert lowest(stiffness, mass, 8) is None
    assert lowest(K, M, 13) is None
