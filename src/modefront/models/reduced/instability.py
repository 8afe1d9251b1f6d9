r"""Directions in which the stiffness of a model is negative.

Where K is indefinite at some parameters, a basis that does not hold a direction x of
:math:`x^T K x < 0` has modes all the same. The lowest eigenvalue of

.. math:: K x = \nu A x

with the positive definite A of a snapshot is found by Davidson's method with the factor of A, from
the basis and from random directions; its eigenvector belongs in the basis, whose K is indefinite
then wherever :math:`x^T K(\theta) x < 0`.
"""

from __future__ import annotations

import numpy as np

from modefront._typing import Floats
from modefront.linalg.pencil import Pencil
from modefront.linalg.products import combine, gram, times
from modefront.models.reduced.basis import Basis
from modefront.models.reduced.corrections import Factor
from modefront.modes.sparse import orthonormal

COLUMNS = 3
"""Eigenvectors that are sought together, and random directions."""

STEPS = 40
"""Steps at most."""

SETTLED = 1e-2
"""Relative change of a negative eigenvalue below which its vector is good enough."""

NEGATIVE = 1e-8
"""Eigenvalue over the greatest one that is no rounding."""


def unstable(pencil: Pencil, basis: Basis, factor: Factor, theta: Floats) -> Floats:
    """Return directions (N, k) in which K(theta) is negative; none where none is found."""
    sigma = factor.below.sigma
    K0, M0 = pencil.K.at(factor.theta), pencil.M.at(factor.theta)
    K = pencil.K.at(theta)
    _, Y = np.linalg.eigh(basis.K.at(theta))
    random = np.random.default_rng(0).standard_normal((pencil.size, COLUMNS))
    start = np.hstack([basis.combine(Y[:, :COLUMNS]), factor.below.factor.solve(random)])
    S = orthonormal(K0, M0, sigma, np.zeros((pencil.size, 0)), start)
    last = np.inf
    for _ in range(STEPS):
        nu, Y = np.linalg.eigh(gram(S, times(K, S)))
        negative = nu[0] < -NEGATIVE * np.abs(nu).max()
        if negative and abs(nu[0] - last) <= SETTLED * abs(nu[0]):
            break
        last = nu[0]
        X = combine(S, Y[:, :COLUMNS])
        R = times(K, X) - (times(K0, X) - sigma * times(M0, X)) * nu[:COLUMNS]
        new = orthonormal(K0, M0, sigma, S, factor.below.factor.solve(R))
        if not new.shape[1]:
            break
        S = np.hstack([S, new])
    below = nu[: Y.shape[1]] < -NEGATIVE * np.abs(nu).max()
    return combine(S[:, : len(Y)], Y[:, below][:, :COLUMNS]) if below.any() else S[:, :0]
