"""Subspaces that are orthonormal in the norm of a pencil."""

from __future__ import annotations

import numpy as np
import scipy.sparse

from modefront._typing import Floats
from modefront.linalg.products import combine, gram, times

LOST = 1e-10
"""Square of what a normalised direction adds to a space below which it is left out."""


def orthonormal(
    K: scipy.sparse.csr_array, M: scipy.sparse.csr_array, sigma: float, S: Floats, Z: Floats
) -> Floats:
    """Return the part of columns Z (N, m) outside S, orthonormal like S in K - sigma M."""

    def product(X: Floats) -> Floats:
        return times(K, X) - times(M, X) * sigma

    for _ in range(2):
        square = np.einsum("nc,nc->c", Z, product(Z))
        Z = Z * np.divide(1.0, np.sqrt(np.maximum(square, 0)), out=0 * square, where=square > 0)
        if S.shape[1]:
            Z = Z - combine(S, gram(S, product(Z)))
    squares, U = np.linalg.eigh(gram(Z, product(Z)))
    new = squares > LOST
    return combine(Z, U[:, new] / np.sqrt(squares[new])) if new.any() else Z[:, :0]
