r"""Modes and their exact derivatives for small models, with dense matrices.

.. math:: (K - \lambda_r M) \varphi_r = 0, \qquad \varphi_r^T M \varphi_s = \delta_{rs}

A singular M (massless degrees of freedom) or K (rigid-body modes) is allowed: what is solved is
:math:`M x = \mu (K + \sigma M) x` with :math:`\mu = 1 / (\lambda + \sigma)`, which also gives the
lowest modes to the highest relative accuracy.

Derivatives follow Nelson (1976, doi:10.2514/3.7211). With respect to a parameter,

.. math::
    \lambda_r' &= \varphi_r^T (K' - \lambda_r M') \varphi_r \\
    (K - \lambda_r M) \varphi_r' &= -(K' - \lambda_r' M - \lambda_r M') \varphi_r

The singular system is made regular by adding :math:`s\, M \Phi_c \Phi_c^T M`, where the columns of
:math:`\Phi_c` are the mode and all modes close to it (c); the solution is then the part of
:math:`\varphi_r'` outside their subspace, well conditioned however close they are. Inside it,

.. math::
    \varphi_j^T M \varphi_r' =
        \frac{\varphi_j^T (K' - \lambda_r M') \varphi_r}{\lambda_r - \lambda_j},
    \qquad \varphi_r^T M \varphi_r' = -\tfrac12 \varphi_r^T M' \varphi_r

where the quotient is the only place that a small gap can spoil. Where it does, the modes are
called coincident: the eigenvalues along one parameter then are those of
:math:`\Phi_c^T (K' - \lambda M') \Phi_c`, and the quotient is left out.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg

from modefront._typing import Bools, Floats
from modefront.errors import ModelError
from modefront.models.affine import DenseAffine, first_axis
from modefront.modes.result import Modes

CLOSE = 1e-2
"""Relative gap of eigenvalues below which modes are treated as one cluster."""

COINCIDENT = 1e-8
"""Relative error of a quotient, as caused by rounding in its gap, above which it is left out."""

SHIFT = 1e-5
"""sigma over trace(K) / trace(M), where K is singular: balances rounding in low and high modes."""

RIGID = 1e-4
"""Eigenvalue over the shift, below which a mode counts as a rigid-body mode."""

_ROUNDING = 10 * np.finfo(float).eps


def modes(
    K: DenseAffine, M: DenseAffine, sensors: Floats, theta: Floats, count: int, derivatives: bool
) -> Modes:
    """Return the ``count`` lowest modes at the sensors, shape (sensors, N), in ascending order.

    Raises ModelError where K or M is indefinite, or where there are fewer modes with a finite
    frequency than asked for.
    """
    Kt, Mt = K.at(theta), M.at(theta)
    lam, Phi = eigensolve(Kt, Mt)
    if lam.size < count:
        raise ModelError(f"{count} modes asked for, but only {lam.size} have a finite frequency")
    phi = sensors @ Phi[:, :count]
    if not derivatives:
        empty = np.zeros((count, 0)), np.zeros((phi.shape[0], count, 0))
        return Modes(lam[:count], phi, *empty, coincident=np.zeros(count, dtype=np.bool_))
    dlam, dPhi, coincident = nelson(K, M, theta, lam, Phi, count)
    dphi = first_axis(sensors, dPhi[:, :count])
    return Modes(lam[:count], phi, dlam[:count], dphi, coincident[:count])


def eigensolve(K: Floats, M: Floats) -> tuple[Floats, Floats]:
    """Return all finite eigenvalues in ascending order and the mass-normalised modes (N, modes)."""
    if not np.diag(M).any():
        raise ModelError("the mass matrix has no mass on its diagonal")
    scale = np.abs(np.diag(K)).sum() / np.abs(np.diag(M)).sum()
    mu, X = _inverse_eigensolve(K, M)
    shift = 0.0
    if mu.size == 0 or mu[-1] * scale * SHIFT**2 > 1:
        shift = SHIFT * scale
        mu, X = _inverse_eigensolve(K + shift * M, M)
        if mu.size == 0:
            raise ModelError("the stiffness matrix is indefinite")
        elastic = mu[(mu > 1e-13 * mu[-1]) & (mu < (1 - RIGID) * mu[-1])]
        if elastic.size:
            # A shift of the size of the lowest elastic mode costs no digits of the others.
            shift = float(1 / elastic[-1] - shift)
            mu, X = _inverse_eigensolve(K + shift * M, M)
    if mu[0] < -1e-10 * mu[-1]:
        raise ModelError("the mass matrix is indefinite")
    finite = np.flatnonzero(mu > 1e-13 * mu[-1])[::-1]
    lam = 1 / mu[finite] - shift
    if lam[0] < -1e-2 * shift:
        raise ModelError("the stiffness matrix is indefinite")
    return lam, X[:, finite] / np.sqrt(mu[finite])


def is_singular(K: Floats) -> bool:
    """Return whether a positive semidefinite K is singular to working precision, units apart."""
    scale = 1 / np.sqrt(np.maximum(np.diag(K), np.finfo(float).tiny))
    lam = scipy.linalg.eigvalsh(K * np.outer(scale, scale), check_finite=False)
    return bool(lam[0] <= _ROUNDING * lam.size * lam[-1])


def _inverse_eigensolve(K: Floats, M: Floats) -> tuple[Floats, Floats]:
    """Solve M x = mu K x; empty arrays where K is not positive definite."""
    try:
        mu, X = scipy.linalg.eigh(M, K, check_finite=False)
    except np.linalg.LinAlgError:
        return np.zeros(0), np.zeros((len(K), 0))
    return mu, X


def nelson(
    K: DenseAffine, M: DenseAffine, theta: Floats, lam: Floats, Phi: Floats, count: int
) -> tuple[Floats, Floats, Bools]:
    """Return dlam (count, p), dPhi (N, count, p) and which modes coincide with another one.

    ``lam`` and ``Phi`` hold all finite modes, so that the neighbours of the last one are known.
    """
    magnitude = np.abs(lam) + SHIFT * lam[-1]
    rounding = _ROUNDING * magnitude**2 / magnitude[0]
    distance = np.abs(lam[:, None] - lam)
    same = distance * COINCIDENT <= np.maximum(rounding, rounding[:, None])
    while count < lam.size and same[count, :count].any():
        count += 1
    r = np.arange(count)
    same, close = same[:, r], distance[:, r] <= CLOSE * magnitude[r]

    dK_phi = K.derivatives_times(theta, Phi[:, r])
    dM_phi = M.derivatives_times(theta, Phi[:, r])
    force = dK_phi - lam[r, None] * dM_phi
    S = first_axis(Phi.T, force)  # S[j, r] = phi_j^T (K' - lam_r M') phi_r
    dlam = S[r, r]
    coincident = np.asarray(same.sum(axis=0) > 1)
    for group in {tuple(np.flatnonzero(same[r, k])) for k in np.flatnonzero(coincident)}:
        block = S[np.ix_(group, group)]
        dlam[list(group)] = np.linalg.eigvalsh(np.moveaxis(block, 2, 0)).T

    gap = lam[r] - lam[:, None]
    quotient = np.where(close & ~same, 1 / np.where(same, 1.0, gap), 0.0)
    inside = S * quotient[:, :, None]
    inside[r, r] = -0.5 * np.einsum("nr,nri->ri", Phi[:, r], dM_phi)

    Kt, Mt = K.at(theta), M.at(theta)
    MPhi = Mt @ Phi
    cluster = MPhi * close.T[:, None, :]
    regular = Kt - lam[r, None, None] * Mt
    regular += magnitude[r, None, None] * (cluster @ cluster.transpose(0, 2, 1))
    rhs = first_axis(MPhi, S * close[:, :, None]) - force
    outside = np.linalg.solve(regular, rhs.transpose(1, 0, 2)).transpose(1, 0, 2)
    return dlam, outside + first_axis(Phi, inside), coincident
