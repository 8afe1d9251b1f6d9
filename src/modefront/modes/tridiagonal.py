r"""The lowest modes of dense matrices, and their derivatives, without all the other modes.

With :math:`K = L L^T`, :math:`L^{-1} M L^{-T} = Q T Q^T` and T tridiagonal,

.. math:: T s = \mu s, \qquad x = L^{-T} Q s, \qquad \mu = 1 / \lambda, \qquad x^T K x = 1 .

All :math:`\mu` cost next to nothing, and so does an eigenvector of T (inverse iteration). The sum
over the other modes in Nelson's derivative, see `modefront.modes.dense`, is the solution of a
tridiagonal system. With :math:`g_r = Q^T L^{-1} f_r` and the known modes j < k

.. math:: \sum_{j \ge k} x_j \frac{x_j^T f_r}{1 - \lambda_r \mu_j} = L^{-T} Q P z_r, \qquad
    (I - \lambda_r T) z_r = P g_r, \qquad P = I - S S^T,

S (N, k) being the known eigenvectors. The matrix is singular but for rounding, in a direction that
P removes from both sides.

Source: LAPACK Users' Guide, 1999, sections 2.4.4 and 2.4.5 (dsygst, dsytrd, dsterf, dstein).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
import scipy.linalg

from modefront._typing import Floats, Ints
from modefront.linalg.affine import DenseAffine, first_axis
from modefront.modes.result import ModeDerivatives
from modefront.modes.second_derivatives import SecondDerivatives, Solved

MANY = 100
"""Degrees of freedom from which on this is faster than all modes, if few are wanted."""

FEW = 0.25
"""Share of the modes that are few."""

SPARE = 2
"""Modes that are known beyond those wanted, at least."""

GAP = 1e-2
"""Relative gap of eigenvalues above the known modes."""

FINITE = 1e-13
"""mu over the greatest one, above which a mode has a finite frequency: below is rounding of the
zeros of a singular M."""

PRECISE = 1e-8
"""mu over the greatest one, below which digits of it are lost that can be had otherwise."""

INDEFINITE = 1e-10
"""Negative mu over the greatest one, beyond which M is indefinite, and not by rounding."""

SINGULAR = 1e-10
"""Eigenvalue over trace(K) / trace(M) below which K counts as singular: rounding in it would spoil
the others."""

COINCIDENT = 1e-8
"""Relative error of a quotient, as caused by rounding in its gap, above which it is left out."""

_ROUNDING = 10 * np.finfo(float).eps
_BLOCK = 64  # columns that LAPACK treats together

_lapack = scipy.linalg.lapack


@dataclass(frozen=True, eq=False)
class LowestModes:
    """The lowest modes, and T.

    Attributes
    ----------
    lam : (modes,) all finite eigenvalues, ascending
    S : (N, k) eigenvectors of T of the modes that are known
    L, Q, tau : the factor of K, and Q as LAPACK stores its reflectors
    diagonal, beside : (N,) and (N - 1,) of T
    """

    lam: Floats
    S: Floats
    L: Floats
    Q: Floats
    tau: Floats
    diagonal: Floats
    beside: Floats

    @cached_property
    def Phi(self) -> Floats:
        """Mass-normalised modes that are known, shape (N, k)."""
        return self.transformed_back(self.S) * np.sqrt(self.lam[: self.S.shape[1]])

    def transformed(self, vectors: Floats) -> Floats:
        """Return Q^T L^-1 times some vectors (N, m)."""
        out = _lapack.dtrtrs(self.L, vectors, lower=1)[0]
        out[1:] = _turned(self.Q, self.tau, "T", out[1:])
        return out

    def transformed_back(self, vectors: Floats) -> Floats:
        """Return L^-T Q times some vectors (N, m)."""
        out = vectors.copy()
        out[1:] = _turned(self.Q, self.tau, "N", vectors[1:])
        return np.asarray(_lapack.dtrtrs(self.L, out, lower=1, trans=1)[0])

    def times(self, vectors: Floats) -> Floats:
        """Return T times some vectors (N, m)."""
        out = self.diagonal[:, None] * vectors
        out[:-1] += self.beside[:, None] * vectors[1:]
        out[1:] += self.beside[:, None] * vectors[:-1]
        return out

    def beyond(self, right: Floats, lam: Floats) -> Floats:
        """Return P z_r for g_r (N, m, p) and eigenvalues (m,) among the known ones, (N, m, p)."""
        N, modes, p = right.shape
        if not right.size:
            return right
        S, flat = self.S, right.reshape(N, -1)
        g = (flat - S @ (S.T @ flat)).reshape(right.shape).transpose(1, 0, 2).reshape(-1, p)
        lam = lam[:, None]
        beside = np.zeros((modes, N))
        beside[:, :-1] = -lam * self.beside
        off = beside.ravel()[:-1]
        *_, z, info = _lapack.dgtsv(off, (1 - lam * self.diagonal).ravel(), off, g)
        if info:  # exactly singular
            *_, z, _ = _lapack.dgtsv(off, (1 + _ROUNDING - lam * self.diagonal).ravel(), off, g)
        flat = z.reshape(modes, N, p).transpose(1, 0, 2).reshape(N, -1)
        return (flat - S @ (S.T @ flat)).reshape(right.shape)


def lowest_modes(K: Floats, M: Floats, count: int) -> LowestModes | None:
    """Return the ``count`` lowest modes or more; None where all modes have to be solved for.

    That is so for small or singular matrices, for many modes, and where one wanted lacks digits.
    """
    N = len(K)
    if N < MANY or count + SPARE > FEW * N:
        return None
    L, failed = _lapack.dpotrf(K.T, lower=1)
    if failed:
        return None
    C, _ = _lapack.dsygst(M.T, L, lower=1)
    C, diagonal, beside, tau, _ = _lapack.dsytrd(C, lower=1, lwork=_BLOCK * N, overwrite_a=1)
    mu, failed = _lapack.dsterf(diagonal, beside)
    if failed or not mu[-1] > 0 or mu[0] < -INDEFINITE * mu[-1]:
        return None
    if mu[-count] < PRECISE * mu[-1]:
        return None
    if mu[-1] * np.trace(K) * SINGULAR > np.trace(M):
        return None
    lam = 1 / mu[::-1][: np.sum(mu > FINITE * mu[-1])]
    wide = np.flatnonzero(np.diff(lam[count + SPARE - 1 :]) > GAP * lam[count + SPARE :])
    if not wide.size:
        return None
    known = count + SPARE + int(wide[0])
    ones = np.ones(N, dtype=np.int32)
    S, failed = _lapack.dstein(diagonal, beside, mu[-known:], ones, N * ones)
    if failed:
        return None
    S, Q = S[:, ::-1], np.asfortranarray(C[1:, :-1])
    return LowestModes(lam, S, L, Q, tau, diagonal, beside)


# 9 arguments: the modes, and those of `modefront.modes.second_derivatives.Solve`.
def _with_few(
    modes: LowestModes,
    phi: Floats,
    seen: Floats,
    gap: Floats,
    inside: Floats,
    beyond: Floats,
    r: Ints,
    b: Floats,
    owner: Ints,
) -> Solved:
    """Return modes r with adjoints; further arguments are those of the same names below."""
    Phi, shape = modes.Phi, beyond[:, r].shape
    outside = modes.beyond((seen @ b)[:, :, None], modes.lam[r[owner]])
    rest = np.hstack([beyond[:, r].reshape(len(Phi), -1), outside[:, :, 0]])
    dPhi, Z = np.split(modes.transformed_back(rest), [shape[1] * shape[2]], axis=1)
    return Solved(
        Phi[:, r],
        first_axis(Phi, inside[:, r]) - dPhi.reshape(shape),
        Z - Phi @ ((phi.T @ b) / gap[:, r[owner]]),
    )


def derivatives(
    K: DenseAffine, M: DenseAffine, sensors: Floats, theta: Floats, modes: LowestModes, count: int
) -> ModeDerivatives:
    """Return the derivatives of the ``count`` lowest modes.

    The arguments are those of `modefront.modes.dense.modes`, and the modes.
    """
    Phi, known, p = modes.Phi, modes.Phi.shape[1], theta.size
    lam = modes.lam[:known]
    rounding = _ROUNDING * lam**2 / lam[0]
    same = np.abs(lam[:, None] - lam) * COINCIDENT <= np.maximum(rounding, rounding[:, None])
    c = count
    while c < known and same[c, :c].any():
        c += 1
    r = np.arange(c)
    force = K.derivatives_times(theta, Phi[:, :c])
    if M.varies:
        dM_phi = M.derivatives_times(theta, Phi[:, :c])
        force = force - lam[r, None] * dM_phi
    G = (Phi.T @ force.reshape(len(Phi), -1)).reshape(known, c, p)
    dlam, coincident = G[r, r], np.asarray(same[:, :c].sum(axis=0) > 1)
    for group in {tuple(np.flatnonzero(same[:, k])) for k in np.flatnonzero(coincident)}:
        block = G[np.ix_(group, group)]
        dlam[list(group)] = np.linalg.eigvalsh(np.moveaxis(block, 2, 0)).T

    r = r[:count]
    gap = np.where(same, np.inf, lam - lam[:, None])[:, r]
    inside = G[:, r] / gap[:, :, None]
    if M.varies:
        inside[r, r] = -0.5 * np.einsum("nr,nri->ri", Phi[:, r], dM_phi[:, r])
    both = np.hstack([force[:, r].reshape(len(Phi), -1), sensors.T])
    right, seen = np.split(modes.transformed(both), [count * p], axis=1)
    beyond = modes.beyond(right.reshape(len(Phi), count, p), lam[r])
    phi, dlam = sensors @ Phi, dlam[:count]
    dphi = phi @ inside.reshape(known, -1) - seen.T @ beyond.reshape(len(Phi), -1)
    solve = partial(_with_few, modes, phi, seen, gap, inside, beyond)
    second = SecondDerivatives(K, M, theta, lam[:count], phi[:, :count], dlam, solve, count)
    return ModeDerivatives(dlam, dphi.reshape(-1, count, p), coincident[:count], second)


def _turned(Q: Floats, tau: Floats, trans: str, vectors: Floats) -> Floats:
    """Return Q or, with ``trans`` "T", its transpose times vectors (N - 1, m)."""
    return np.asarray(
        _lapack.dormqr("L", trans, Q, tau, vectors, _BLOCK * max(1, vectors.shape[1]))[0]
    )
