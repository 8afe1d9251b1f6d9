r"""The least-squares complex frequency-domain method, common denominator and poly-reference.

The matrix fraction :math:`H_i = B_i(z)\,A(z)^{-1}` of docs/methods/identification.md is over
:math:`z = e^{c\,(s - s_1)}`, an arc over the band from :math:`s_1 = 2\pi\mathrm{i} f_1` on. Its
coefficients are complex: poles of negative frequency are far away and smooth, so the numerator
takes them. The error :math:`e_i = H_i A - B_i = Y_i \alpha - X \beta_i` is linear, and eliminating
every :math:`\beta_i` from the normal equations leaves

.. math:: M \alpha = 0,\qquad M = \sum_i T_i - S_i^H R_i^{-1} S_i .

R, S and T are (block) Toeplitz: one matrix product yields their entries for all orders. With
:math:`A_0 = I`, poles that belong to noise lie outside of the unit circle and are unstable
(Cauberghe, Guillaume, Verboven et al. 2005). Poles are the eigenvalues of the companion matrix,
:math:`\lambda = s_1 + \ln z / c`, and participation factors L the left null vectors of A there.

===================  =====================================================================
symbol               meaning
===================  =====================================================================
p                    order; p times the number of references is the number of poles
R, S, T              :math:`X^H W X`, :math:`-X^H W Y`, :math:`Y^H W Y` of one response
w                    weights 1/var H, the mean over all functions
===================  =====================================================================

Sources: Peeters, Van der Auweraer, Guillaume & Leuridan, Shock Vib. 11 (2004) 395-409,
doi:10.1155/2004/523692; Cauberghe, Guillaume, Verboven, Vanlanduit & Parloo, Mech. Syst. Signal
Process. 19 (2005) 989-1014, doi:10.1016/j.ymssp.2004.08.003 (the constraint).
"""

import numpy as np
import scipy.linalg as la

from modefront._typing import Complexes, Floats
from modefront.rounding import TINY

ARC = 0.92  # share of the unit circle that the band covers: all of it would join its ends
LEAST_DAMPING = 1e-3  # damping ratio of poles that the decay of an exponential window leaves none
SINGULAR = 1e-13  # relative size of eigenvalues of R that are rounding


Moments = tuple[Complexes, Complexes, Complexes]
"""Sums over the lines for lags m, last, of w z^m, (lags,), of w H z^m, (responses, references,
lags), and over all responses of w conj(H) H z^m, (references, references, lags)."""


def moments(H: Complexes, weight: Floats, z: Complexes, highest: int) -> Moments:
    """Return the sums of which R, S and T are made, for lags from -highest to highest.

    ``H`` is (references, responses, lines) without NaN; ``weight`` (lines,).
    """
    second = np.einsum("jik,lik->jlk", (weight * H).conj(), H, optimize=True)
    parts = weight, (weight * H).transpose(1, 0, 2), second
    powers = z[:, None] ** np.arange(-highest, highest + 1)
    R, S, T = (part @ powers for part in parts)
    return R, S, T


def _reduced(sums: Moments, p: int) -> Complexes:
    """Return M, (powers and references) squared."""
    lag = np.arange(p + 1) - np.arange(p + 1)[:, None] + len(sums[0]) // 2
    R, S, T = (x[..., lag] for x in sums)  # Toeplitz in the last axes, (p + 1, p + 1)
    M = T.transpose(2, 0, 3, 1).reshape((p + 1) * len(T), -1)
    value, vector = la.eigh(R)
    kept = value > SINGULAR * value[-1]
    root = vector[:, kept].conj().T / np.sqrt(value[kept])[:, None]
    half = root @ S.transpose(2, 0, 3, 1).reshape(p + 1, -1)
    half = half.reshape(-1, len(M))  # columns (power, reference)
    return M - half.conj().T @ half


def poles(
    sums: Moments, p: int, shift: float, rate: float, decay: float = 0.0
) -> tuple[Complexes, Complexes]:
    """Return the stable poles of one order and participation factors, (poles, references).

    Near a pole, B A^-1 is a column times its factors, whose greatest is 1: a left null vector of A.
    Poles, in rad/s, are of z = exp(i rate (omega - shift)), of positive frequency, and are those
    without the ``decay`` in 1/s that an exponential window added to them. What decays by less than
    half of that is noise; others that come out unstable get the damping ratio `LEAST_DAMPING`.
    """
    n_in, M = len(sums[2]), _reduced(sums, p)
    M = (M + M.conj().T) / 2
    scale = np.sqrt(np.maximum(M.diagonal().real, TINY))
    rest = slice(n_in, None)
    normal = M[rest, rest] / np.outer(scale[rest], scale[rest])
    right = -M[rest, :n_in] / scale[rest, None]
    alpha = la.lstsq(normal, right, lapack_driver="gelsd")[0] / scale[rest, None]
    # sum_m z^m A_m v = 0 with A_0 = I: a companion matrix in 1/z
    companion = np.zeros((p * n_in, p * n_in), complex)
    companion[n_in:, :-n_in] = np.eye((p - 1) * n_in)
    A = alpha.reshape(p, n_in, n_in)
    companion[:n_in] = -np.hstack(list(A))
    inverse = la.eigvals(companion)
    inverse = inverse[np.abs(inverse) > np.finfo(float).eps]
    middle = np.pi * ARC
    angle = np.angle(np.exp(1j * (-np.angle(inverse) - middle))) + middle
    value = -np.log(np.abs(inverse)) / rate + 1j * (shift + angle / rate)
    good = (value.real < -decay / 2) & (value.imag > 0)
    if decay:
        value.real = np.minimum(value.real + decay, -LEAST_DAMPING * np.abs(value))
    kept = np.flatnonzero(good)[value[good].imag.argsort()]
    powers = (1 / inverse[kept])[:, None] ** np.arange(1, p + 1)
    total = np.eye(n_in) + np.einsum("km,mij->kij", powers, A)
    left = np.linalg.svd(total)[0][:, :, -1].conj()
    greatest = np.take_along_axis(left, np.abs(left).argmax(axis=1)[:, None], axis=1)
    return value[kept], left / greatest
