r"""How wrong the modes of a reduced model are, from their residuals in the full one.

For a Ritz pair :math:`(\lambda, \varphi)` with :math:`\varphi^T M \varphi = 1` and the residual
:math:`r = (K - \lambda M) \varphi`, the mode lacks :math:`\delta` and the eigenvalue is too high by
:math:`\epsilon`, to leading order (Jacobi's correction),

.. math::
    C \delta = -r, \qquad \epsilon = r^T C^+ r = -r^T \delta, \qquad C = K - \lambda M

on the M-complement of the low Ritz modes, where C is positive definite unless a mode is missing
there. Each Ritz mode j near r is mixed in as well, by :math:`r_j^T \delta / (\lambda - \lambda_j)`.
Conjugate gradients with the factor of an earlier :math:`A = K + s M` give both: they sum up
:math:`\epsilon` from below, one solution with the factor a term,

.. math:: \epsilon = \sum_k \alpha_k \, r_k^T z_k, \qquad z_k = A^{-1} r_k .

The first term alone is at least :math:`4 \kappa / (1 + \kappa)^2` of the whole (Kantorovich), with
:math:`\kappa` the condition of :math:`A^{-1} C`; others follow until they are small.

Sources: Sleijpen & Van der Vorst 1996, doi:10.1137/S0895479894270427 (correction); Golub & Meurant
2010, doi:10.1515/9781400833887 (quadratic forms by conjugate gradients).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse

from modefront._typing import Floats, Ints
from modefront.modes.products import combine, gram
from modefront.modes.spectrum import Shifted

SETTLED = 0.2
"""Share of the sum in the last term, below which no other one is added."""

NEAR = 3.0
"""Condition of K over that of the factor up to which the first term is enough: 3/4 of the whole."""

STEPS = 8
"""Terms at most."""


@dataclass(frozen=True)
class Certificate:
    """Estimated errors of modes.

    Attributes
    ----------
    eigenvalue : (modes,) relative errors of the eigenvalues; infinite where a mode is missing
    shape : (modes,) errors of the mode shapes in the norm of M, over their length
    """

    eigenvalue: Floats
    shape: Floats


def estimate(
    K: scipy.sparse.csr_array,
    M: scipy.sparse.csr_array,
    lam: Floats,
    Phi: Floats,
    wanted: Ints,
    below: Shifted,
    steps: int = STEPS,
) -> Certificate:
    """Return the certificate of the ``wanted`` ones of low Ritz pairs, Phi (N, modes).

    ``lam`` (modes,) ascends and holds all Ritz values up to beyond the wanted ones; ``below`` is
    the factor of a positive definite K + s M at any parameters. Errors of eigenvalues are over
    lam + s.
    """
    MPhi = M @ Phi
    rest = K @ Phi - MPhi * lam
    r, shift = np.ascontiguousarray(rest[:, wanted]), lam[wanted]
    r -= combine(MPhi, gram(Phi, r))
    delta, P = np.zeros_like(r), np.zeros_like(r)
    square = np.zeros(wanted.size)  # delta^T M delta
    total, energy = np.zeros(wanted.size), np.ones(wanted.size)
    active, lost = np.ones(wanted.size, dtype=bool), np.zeros(wanted.size, dtype=bool)
    for step in range(steps):
        z = below.factor.solve(np.ascontiguousarray(r[:, active]))
        z -= combine(Phi, gram(MPhi, z))
        before, now = energy[active], np.einsum("nc,nc->c", r[:, active], z)
        p = z + P[:, active] * (now / np.maximum(before, np.finfo(float).tiny) if step else 0.0)
        Mp = M @ p
        Cp = K @ p - Mp * shift[active]
        curvature = np.einsum("nc,nc->c", p, Cp)
        lost[active] |= curvature <= 0
        alpha = np.divide(now, curvature, out=np.zeros_like(now), where=curvature > 0)
        term = alpha * now
        total[active] += term
        square[active] += alpha * np.einsum("nc,nc->c", alpha * p - 2 * delta[:, active], Mp)
        delta[:, active] -= alpha * p
        r[:, active] -= alpha * (Cp - combine(MPhi, gram(Phi, Cp)))
        P[:, active], energy[active] = p, now
        active[active] = (term > SETTLED * total[active]) & ~lost[active]
        if not active.any():
            break
    gap = lam[:, None] - shift
    mixed = np.divide(gram(rest, delta), gap, out=np.zeros_like(gap), where=gap != 0)
    shape = np.sqrt(np.maximum(square, 0.0) + (mixed**2).sum(axis=0))
    relative = total / (shift - below.sigma)
    return Certificate(np.where(lost, np.inf, relative), np.where(lost, 1.0, np.minimum(shape, 1)))
