r"""Modes and their exact derivatives for small models, with dense matrices.

K or M may be singular (rigid-body modes, massless degrees of freedom): what is solved is
:math:`M x = \mu (K + \sigma M) x` with :math:`\mu = 1 / (\lambda + \sigma)`, which also gives the
lowest modes to the highest relative accuracy. As all x are at hand, orthonormal in
:math:`K + \sigma M`, Nelson's derivative (``docs/methods/derivatives.md``) is a sum,

.. math::
    \varphi_r' = - \sum_{j \ne r} x_j \frac{x_j^T f_r}{1 - (\lambda_r + \sigma) \mu_j}
        - \tfrac12 \varphi_r\, \varphi_r^T M' \varphi_r .

Errors of the x and mu of high modes, which are close in mu, do no harm in it. Of modes close to r,
the denominator is :math:`\mu_j (\lambda_j - \lambda_r)`, the only place that a small gap can spoil;
where it does, the modes are called coincident, and the quotient is left out.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg

from modefront._typing import Bools, Floats, Ints
from modefront.errors import ModelError
from modefront.linalg.affine import DenseAffine, first_axis
from modefront.modes.result import FullModes, ModeDerivatives, Modes, SecondDerivatives, Solved
from modefront.rounding import TINY

CLOSE = 1e-2  # relative gap of eigenvalues below which a quotient is formed with the gap itself
SHIFT = 1e-5  # sigma over trace(K) / trace(M): balances rounding in low and high modes
MIDDLE = 100.0  # factor about the middle of the spectrum within which both ways are joined
RIGID = 1e-4  # eigenvalue over the shift, below which a mode counts as a rigid-body mode
INDEFINITE = 1e-2  # negative eigenvalue over the shift, up to which it is rounding
INDEFINITE_MASS = 1e-10  # negative mu over the greatest one, up to which it is rounding
FINITE = 1e-13  # mu over the greatest one, below which it is rounding of the zeros of a singular M
PRECISE = 1e-8  # mu over the greatest one, below which digits are lost that can be had otherwise
COINCIDENT = 1e-8  # relative error of a quotient, by rounding in its gap, that leaves it out
_ROUNDING = 10 * np.finfo(float).eps  # relative error of a sum of some ten products


def modes(
    K: DenseAffine, M: DenseAffine, sensors: Floats, theta: Floats, count: int, derivatives: bool
) -> Modes:
    """Return the ``count`` lowest modes at the sensors, shape (sensors, N), in ascending order.

    Raises ModelError where K or M is indefinite, or where there are fewer modes with a finite
    frequency than asked for.
    """
    decomposition = decompose(K.at(theta), M.at(theta), count)
    lam, X = decomposition.lam, decomposition.X
    refuse_fewer(lam.size, count)
    phi = sensors @ decomposition.Phi[:, :count]
    if not derivatives:
        return Modes(lam[:count], phi)
    dlam, S, coincident, energy = nelson(K, M, theta, decomposition, count)
    seen = sensors @ X

    def solve(r: Ints, b: Floats, owner: Ints) -> Solved:
        """Return modes r with adjoints; the energy is x_j^T (K - lam_r M) x_j."""
        Z = X @ ((seen.T @ b) / energy[:, r[owner]])
        return decomposition.Phi[:, r], first_axis(X, S[:, r]), Z

    second = SecondDerivatives(K, M, theta, solve, count)
    dphi = first_axis(seen, S[:, :count])
    return Modes(lam[:count], phi, ModeDerivatives(dlam[:count], dphi, coincident[:count], second))


def lowest(K: Floats, M: Floats, count: int) -> tuple[Floats, Floats] | None:
    """Return the lowest eigenvalues (count,) and mass-normalised modes (N, count) alone.

    None where digits need all others, or K is not positive definite; M is semidefinite.
    """
    least = max(len(K) - count, 0)
    try:
        mu, X = scipy.linalg.eigh(M, K, subset_by_index=(least, len(K) - 1), check_finite=False)
    except np.linalg.LinAlgError:
        return None
    K_size, M_size = np.abs(K.diagonal()).sum(), np.abs(M.diagonal()).sum()
    if mu.size < count or mu[0] < PRECISE * mu[-1] or mu[-1] * K_size * SHIFT**2 > M_size:
        return None
    return 1 / mu[::-1], X[:, ::-1] / np.sqrt(mu[::-1])


def full_modes(
    K: DenseAffine, M: DenseAffine, theta: Floats, count: int, loads: Floats
) -> FullModes:
    """Return the ``count`` lowest modes and static responses to loads (N, loads); see `modes`."""
    Kt = K.at(theta)
    known = decompose(Kt, M.at(theta), count)
    refuse_fewer(known.lam.size, count)
    lam, static = without_rounding(Kt.diagonal(), known.lam, known.Phi), None
    if lam[0] > 0:
        try:
            static = scipy.linalg.cho_solve(scipy.linalg.cho_factor(Kt), loads)
        except np.linalg.LinAlgError:
            raise ModelError("the stiffness matrix is singular to working precision") from None
    return FullModes(lam[:count], known.Phi[:, :count], static)


def without_rounding(diagonal: Floats, lam: Floats, Phi: Floats) -> Floats:
    """Return eigenvalues with zeros for those below the rounding that phi^T diag(K) phi leaves."""
    return np.where(lam < FINITE * (diagonal @ Phi**2), 0.0, lam)


def refuse_fewer(known: int, count: int) -> None:
    """Raise ModelError where there are fewer modes than ``count``."""
    if known < count:
        raise ModelError(f"{count} modes asked for, but only {known} have a finite frequency")


@dataclass(frozen=True)
class Decomposition:
    """All solutions of M x = mu (K + sigma M) x."""

    mu: Floats  # (N,) eigenvalues, descending
    X: Floats  # (N, N) eigenvectors, orthonormal in K + sigma M
    sigma: float  # the shift
    lam: Floats  # (modes,) the finite eigenvalues of K and M, ascending; of the leading ones of mu

    @cached_property
    def Phi(self) -> Floats:
        """Mass-normalised modes, shape (N, modes)."""
        finite = self.lam.size
        return self.X[:, :finite] / np.sqrt(self.mu[:finite])


def decompose(K: Floats, M: Floats, count: int = 0) -> Decomposition:
    """Return all modes, the ``count`` lowest of which are to be precise.

    Where the mu of one of these lacks digits, or any mu is lost beside the greatest one, the high
    modes are solved for as those of K phi = lam M phi, if M is positive definite. Raises ModelError
    where K or M is indefinite.
    """
    mass = float(np.abs(M.diagonal()).sum())
    if mass == 0:
        raise ModelError("the mass matrix has no mass on its diagonal")
    scale = float(np.abs(K.diagonal()).sum()) / mass
    mu, X = _inverse_eigensolve(K, M)
    shift = 0.0
    if mu.size == 0 or mu[-1] * scale * SHIFT**2 > 1:
        shift = SHIFT * scale
        mu, X = _inverse_eigensolve(K + shift * M, M)
        greatest = mu.max(initial=0.0)
        elastic = mu[(mu > FINITE * greatest) & (mu < (1 - RIGID) * greatest)]
        if elastic.size:
            # A shift of the size of the lowest elastic mode costs no digits of the others.
            shift = float(1 / elastic[-1] - shift)
            mu, X = _inverse_eigensolve(K + shift * M, M)
        if mu.size == 0:
            raise ModelError("the stiffness matrix is indefinite")
    if mu[0] < -INDEFINITE_MASS * mu[-1]:
        raise ModelError("the mass matrix is indefinite")
    mu, X = mu[::-1], X[:, ::-1]
    known = mu > FINITE * mu[0]
    lowest = mu[min(count, mu.size) - 1] / mu[0] if count else 1.0
    if lowest < PRECISE or mu[-1] < FINITE * mu[0]:
        mu, X, exact = _with_high_modes(K, M, mu, X, shift)
        known |= exact
    lam = 1 / mu[known] - shift
    if not lam.size:
        raise ModelError("no mode has a finite frequency: a stiffness vanishes; check its units")
    if lam[0] < -INDEFINITE * shift:
        raise ModelError("the stiffness matrix is indefinite")
    return Decomposition(mu, X, shift, lam)


def _with_high_modes(
    K: Floats, M: Floats, mu: Floats, X: Floats, shift: float
) -> tuple[Floats, Floats, bool]:
    """Return mu and X with the modes above the middle of the spectrum from K phi = lam M phi.

    They are precise in the highest modes, and joined at the widest relative gap in the middle,
    where both ways have half of all digits. Nothing changes, as is returned, where M is singular;
    it is judged with a diagonal of ones, as units and slender elements have nothing to do with it.
    """
    scale = 1 / np.sqrt(np.maximum(np.diag(M), TINY))
    scaled, positive = np.outer(scale, scale), np.diag(M).min() > 0
    if not positive or scipy.linalg.eigvalsh(M * scaled, check_finite=False)[0] < FINITE:
        return mu, X, False
    lam, Phi = scipy.linalg.eigh(K * scaled, M * scaled, check_finite=False)
    middle = np.sqrt((lam[-1] + shift) / mu[0])
    near = np.flatnonzero((lam[1:] > middle / MIDDLE) & (lam[1:] < middle * MIDDLE)) + 1
    if not near.size:
        near = np.array([np.searchsorted(lam, middle)])
    start = int(near[np.argmax(lam[near] / np.maximum(lam[near - 1], middle / MIDDLE**2))])
    high = lam[start:] + shift
    X = np.hstack([X[:, :start], scale[:, None] * Phi[:, start:] / np.sqrt(high)])
    return np.concatenate([mu[:start], 1 / high]), X, True


def is_singular(K: Floats) -> bool:
    """Return whether a positive semidefinite K is singular to working precision, units apart."""
    scale = 1 / np.sqrt(np.maximum(np.diag(K), np.finfo(float).tiny))
    lam = scipy.linalg.eigvalsh(K * np.outer(scale, scale), check_finite=False)
    return bool(lam[0] <= _ROUNDING * lam.size * lam[-1])


def _inverse_eigensolve(K: Floats, M: Floats) -> tuple[Floats, Floats]:
    """Solve M x = mu K x; empty arrays where K is not positive definite."""
    mu, X, failed = scipy.linalg.lapack.dsygvd(M, K)
    return (np.zeros(0), np.zeros((len(K), 0))) if failed else (mu, X)


def nelson(
    K: DenseAffine, M: DenseAffine, theta: Floats, decomposition: Decomposition, count: int
) -> tuple[Floats, Floats, Bools, Floats]:
    """Return dlam (count, p), S with dPhi = X S, which modes coincide, and the denominators.

    X (N, N) are the eigenvectors, S is (N, count, p), and a denominator (N, count) is infinite
    where modes coincide. Some modes more than asked for may come.
    """
    lam, Phi = decomposition.lam, decomposition.Phi
    magnitude = np.abs(lam) + SHIFT * lam[-1]
    rounding = _ROUNDING * magnitude**2 / magnitude[0]
    while True:  # until no mode beyond coincides with one of these
        gap = lam[:, None] - lam[:count]
        distance = np.abs(gap)
        same = distance * COINCIDENT <= np.maximum(rounding[:count], rounding[:, None])
        if count == lam.size or not same[count].any():
            break
        count += 1
    r, close = np.arange(count), distance <= CLOSE * magnitude[:count]

    Phi = Phi[:, r]
    force = K.derivatives_times(theta, Phi)
    if M.coefficients.varies:
        dM_phi = M.derivatives_times(theta, Phi)
        force = force - lam[r, None] * dM_phi
    S = first_axis(decomposition.X.T, force)  # S[j, r] = x_j^T (K' - lam_r M') phi_r
    dlam = S[r, r] / np.sqrt(decomposition.mu[r, None])
    coincident = np.asarray(same.sum(axis=0) > 1)
    for group in {tuple(np.flatnonzero(same[r, k])) for k in np.flatnonzero(coincident)}:
        block = np.tensordot(Phi[:, group].T, force[:, group], axes=1)
        dlam[list(group)] = np.linalg.eigvalsh(np.moveaxis(block, 2, 0)).T

    denominator = 1 - (lam[r] + decomposition.sigma) * decomposition.mu[:, None]
    finite = denominator[: lam.size]
    np.copyto(finite, decomposition.mu[: lam.size, None] * gap, where=close)
    finite[same] = np.inf
    S /= -denominator[:, :, None]
    if M.coefficients.varies:
        S[r, r] = -0.5 * np.einsum("nr,nri->ri", Phi, dM_phi) / np.sqrt(decomposition.mu[r, None])
    return dlam, S, coincident, denominator
