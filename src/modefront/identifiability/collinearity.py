r"""Parameters that the data cannot tell from one another.

With the columns of the weighted Jacobian scaled to length one, :math:`\tilde g_j`, the collinearity
index of a set of parameters is (Brun, Reichert & Künsch 2001, doi:10.1029/2000WR900350, eq. 2)

.. math:: \gamma = 1 / \min_{\|b\| = 1} \|\tilde G b\|
    = 1 / \sqrt{\lambda_{\min}(\tilde G^T \tilde G)} :

a change of one parameter can be made up for by the others but for a share :math:`1/\gamma`. For a
pair with cosine c, :math:`\gamma = 1/\sqrt{1 - |c|}`. They call 10 to 20 critical.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modefront._typing import Floats

CRITICAL = 10.0
"""Collinearity index from which parameters count as not told apart."""

_LARGEST = 1e8
"""Greatest collinearity index; columns beyond it are parallel but for rounding."""


def cosines(gram: Floats) -> Floats:
    """Return cosines between the columns of G, (p, p), from G^T G; 0 for columns that vanish."""
    length = np.sqrt(np.diag(gram))
    product = np.outer(length, length)
    out = np.divide(gram, product, out=np.zeros_like(gram), where=product > 0)
    return np.clip(out, -1.0, 1.0)


def index(gram: Floats, members: Sequence[int] | None = None) -> float:
    """Return the collinearity index of some parameters, or of all; infinite for parallel ones.

    >>> round(index(np.array([[1.0, 0.6], [0.6, 1.0]])), 4)
    1.5811
    """
    c = cosines(gram)
    if members is not None:
        c = c[np.ix_(members, members)]
    least = float(np.linalg.eigvalsh(c)[0])
    return float(1 / np.sqrt(least)) if least > _LARGEST**-2 else np.inf


def pairs(gram: Floats) -> list[tuple[int, int, float]]:
    """Return the pairs of parameters with a critical index, most alike first."""
    # The index of two is 1 / sqrt(1 - |cosine|), which rules most of them out at once.
    alike = np.abs(np.tril(cosines(gram), -1)) > 1 - 1.01 / CRITICAL**2
    indices = [(i, j, index(gram, (i, j))) for i, j in np.argwhere(alike).tolist()]
    chosen = [(j, i, value) for i, j, value in indices if value >= CRITICAL]
    return sorted(chosen, key=lambda pair: -pair[2])
