r"""Whether modes may be missing below a Ritz value, without a factorisation where possible.

Where the terms of K and M are positive semidefinite and their coefficients positive,

.. math:: a K(\theta_s) \le K(\theta) \le b K(\theta_s), \quad
    a = \min_j c_j(\theta) / c_j(\theta_s), \quad b = \max_j c_j(\theta) / c_j(\theta_s),

and M likewise with its own ratios. Of :math:`m_s` modes at :math:`\theta_s` below
:math:`\sigma_s`, proved to be all of them, at most as many are below :math:`\tau = \sigma_s a_K /
b_M` at :math:`\theta`, and what is outside the basis has a Rayleigh quotient of at least
:math:`\tau` there. All modes below some :math:`\sigma \le \tau` are known where the basis has
:math:`m_s` Ritz values below :math:`\tau`, or where the first Ritz value above :math:`\sigma` is
exact enough not to belong below. Otherwise the negative eigenvalues of :math:`K - \sigma M` are
counted by its factor (Sylvester).
"""

from __future__ import annotations

import numpy as np

from modefront._typing import Floats
from modefront.linalg.affine import DenseAffine

INDEFINITE = 1e-6
"""Negative eigenvalue of a projected term, over the greatest one, that passes for rounding: in
thin shells of many elements, that is a good deal."""

GAP = 1e-3
"""Relative gap of Ritz values in which sigma may lie."""

WIDE = 0.2
"""Relative gap at which the search for a wider one ends."""

LATER = 4
"""Gaps above the last mode in question among which the widest is taken."""


def semidefinite(A: DenseAffine) -> bool:
    """Return whether no projected term shows that the term is indefinite."""
    values = np.linalg.eigvalsh(A.terms)
    return bool((values[:, 0] >= -INDEFINITE * np.abs(values).max(axis=1)).all())


def ratios(A: DenseAffine, theta: Floats, snapshot: Floats) -> tuple[float, float]:
    """Return the least and the greatest ratio of coefficients at two parameters.

    They are 0 and infinite where nothing is known, since a coefficient is negative.
    """
    now, then = A.coefficients.values(theta), A.coefficients.values(snapshot)
    nonzero = (now != 0) | (then != 0)
    now, then = now[nonzero], then[nonzero]
    if not (np.isfinite(now).all() and np.isfinite(then).all()) or min(now.min(), then.min()) < 0:
        return 0.0, np.inf
    ratio = np.divide(now, then, out=np.full(now.shape, np.inf), where=then > 0)
    return float(ratio.min()), float(ratio.max())


def lower_bound(K: DenseAffine, M: DenseAffine, theta: Floats, snapshot: Floats) -> float:
    """Return a / b, the least ratio of eigenvalues at two parameters; 0 where nothing is known."""
    return ratios(K, theta, snapshot)[0] / ratios(M, theta, snapshot)[1]


def bounds(
    K: DenseAffine, M: DenseAffine, theta: Floats, snapshot: Floats, sigma: float
) -> tuple[float, float]:
    """Return g and b with g A <= K - sigma M <= b A for A at the snapshot and sigma <= 0."""
    some = [ratios(A, theta, snapshot) for A in ((K,) if sigma == 0 else (K, M))]
    return min(g for g, _ in some), max(b for _, b in some)


def condition_within(K: DenseAffine, M: DenseAffine, theta: Floats, sigma: float) -> float:
    """Return the condition of K - sigma M in a basis that is orthonormal in A: that of A^-1 K.

    It is infinite where the matrices are indefinite there.
    """
    if np.linalg.eigvalsh(M.at(theta))[0] < -INDEFINITE * np.abs(M.at(theta)).max():
        return np.inf
    values = np.linalg.eigvalsh(K.at(theta) - sigma * M.at(theta))
    return float(values[-1] / values[0]) if values[0] > 0 else np.inf


def gap_above(lam: Floats, last: int) -> tuple[int, float]:
    """Return how many Ritz values are below a sigma in a gap above the last one requested.

    It is the wider one of the next two, if that is no cluster, else the widest of all.
    """
    gap = np.diff(lam[last:]) / np.maximum(np.abs(lam[last + 1 :]), np.finfo(float).tiny)
    near = int(np.argmax(gap[:2]))
    k = last + (near if gap[near] > GAP else int(np.argmax(gap)))
    return k + 1, float(lam[k] + 0.5 * (lam[k + 1] - lam[k]))


def level(lam: Floats, count: int, shift: float, most: float) -> tuple[int, float] | None:
    """Return how many Ritz values are below a sigma above the lowest ``count``, and sigma.

    It is in the first wide gap above these, or in the widest of the next ones, and at most
    ``most``; gaps are relative to lam - shift. None where there is none.
    """
    place, widest = None, GAP
    for k in range(count, min(count + LATER, lam.size)):
        sigma = min(most, 0.5 * (lam[k - 1] + lam[k]))
        if sigma <= lam[k - 1]:
            continue
        gap = (sigma - lam[k - 1]) / max(sigma - shift, np.finfo(float).tiny)
        if gap > widest:
            place, widest = (k, float(sigma)), gap
        if widest > WIDE:
            break
    return place
