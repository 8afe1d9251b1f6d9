r"""Whether modes may be missing below a Ritz value, without a factorisation where possible.

Where the terms of K and M are positive semidefinite and their coefficients positive,

.. math:: K(\theta) \ge a K(\theta_s), \quad M(\theta) \le b M(\theta_s), \quad
    a = \min_j c_j(\theta) / c_j(\theta_s), \quad b = \max_j d_j(\theta) / d_j(\theta_s).

The basis contains the modes of the snapshot s below :math:`\sigma_s`, which were proved to be all
of them. What is outside the basis therefore has a Rayleigh quotient of at least
:math:`\sigma_s\, a / b` at :math:`\theta`: a mode of a lower eigenvalue is not missing in it.
Otherwise the negative eigenvalues of :math:`K - \sigma M` are counted by its factor (Sylvester).
"""

from __future__ import annotations

import numpy as np

from modefront._typing import Floats
from modefront.models.affine import DenseAffine

INDEFINITE = 1e-6
"""Negative eigenvalue of a projected term, over the greatest one, that passes for rounding: in
thin shells of many elements, that is a good deal."""

GAP = 1e-3
"""Relative gap of Ritz values in which sigma may lie."""


def semidefinite(A: DenseAffine) -> bool:
    """Return whether no projected term shows that the term is indefinite."""
    values = np.linalg.eigvalsh(A.terms)
    return bool((values[:, 0] >= -INDEFINITE * np.abs(values).max(axis=1)).all())


def lower_bound(K: DenseAffine, M: DenseAffine, at: Floats, snapshot: Floats) -> float:
    """Return a / b, the least ratio of eigenvalues at two parameters; 0 where nothing is known."""
    with np.errstate(divide="ignore", invalid="ignore"):
        c = K.coefficients.values(at) / K.coefficients.values(snapshot)
        d = M.coefficients.values(at) / M.coefficients.values(snapshot)
    positive = np.isfinite(c).all() and np.isfinite(d).all() and (d > 0).all()
    return float(max(c.min(), 0.0) / d.max()) if positive else 0.0


def condition(K: DenseAffine, at: Floats, snapshot: Floats) -> float:
    """Return the greatest ratio of coefficients over the least; infinite where one is negative."""
    with np.errstate(divide="ignore", invalid="ignore"):
        c = K.coefficients.values(at) / K.coefficients.values(snapshot)
        return float(c.max() / c.min()) if (c > 0).all() else np.inf


def condition_within(K: DenseAffine, M: DenseAffine, at: Floats, sigma: float) -> float:
    """Return the condition of K - sigma M in a basis that is orthonormal in A: that of A^-1 K.

    It is infinite where the matrices are indefinite there.
    """
    if np.linalg.eigvalsh(M.at(at))[0] < -INDEFINITE * np.abs(M.at(at)).max():
        return np.inf
    values = np.linalg.eigvalsh(K.at(at) - sigma * M.at(at))
    return float(values[-1] / values[0]) if values[0] > 0 else np.inf


def gap_above(lam: Floats, last: int) -> tuple[int, float]:
    """Return how many Ritz values are below a sigma in a gap above the last one wanted.

    It is the wider one of the next two, if that is no cluster, else the widest of all.
    """
    gap = np.diff(lam[last:]) / np.maximum(np.abs(lam[last + 1 :]), np.finfo(float).tiny)
    near = int(np.argmax(gap[:2]))
    at = last + (near if gap[near] > GAP else int(np.argmax(gap)))
    return at + 1, float(lam[at] + 0.5 * (lam[at + 1] - lam[at]))
