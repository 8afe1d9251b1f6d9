"""The sparse pencil K(theta) - sigma M(theta), on one pattern whatever theta and sigma are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats, Ints
from modefront.linalg.affine import SparseAffine
from modefront.linalg.factorisation import Factorisation, Symbolic, analyse, lower_pattern


@dataclass(frozen=True, eq=False)
class Placing:
    """Entry ``take[k]`` of a matrix is entry ``put[k]`` of the lower triangle of the pencil."""

    take: Ints
    put: Ints


@dataclass(frozen=True, eq=False)
class Pencil:
    """K(theta), M(theta) and the analysis of the union of their patterns.

    Each matrix keeps its own pattern, since M often has far fewer entries than K.

    Attributes
    ----------
    K, M : stiffness and mass matrix, N x N
    symbolic : analysis of the union, which has ``entries`` in its lower triangle
    stiffness, mass : where the entries of K and M go
    """

    K: SparseAffine
    M: SparseAffine
    symbolic: Symbolic
    entries: int
    stiffness: Placing
    mass: Placing

    @property
    def size(self) -> int:
        """Number of degrees of freedom N."""
        return self.K.size

    def factor(self, K: Floats, M: Floats, sigma: float) -> Factorisation:
        """Factor K - sigma M, given the values of both on their own patterns.

        Raises SingularMatrixError where sigma is an eigenvalue.
        """
        values = np.zeros(self.entries)
        values[self.stiffness.put] = K[self.stiffness.take]
        if sigma != 0:
            values[self.mass.put] -= sigma * M[self.mass.take]
        return self.symbolic.factor(values)


def pencil(K: SparseAffine, M: SparseAffine) -> Pencil:
    """Return the pencil of two matrices; the analysis of its pattern is done here, once."""
    (take_K, keys_K), (take_M, keys_M) = _lower(K), _lower(M)
    pattern = lower_pattern(np.concatenate([keys_K, keys_M]), K.size)
    keys = pattern.keys
    stiffness = Placing(take_K, np.searchsorted(keys, keys_K))
    mass = Placing(take_M, np.searchsorted(keys, keys_M))
    return Pencil(K, M, analyse(pattern), pattern.indices.size, stiffness, mass)


def _lower(A: SparseAffine) -> tuple[Ints, Ints]:
    """Return the entries of the lower triangle and their keys, column * N + row, ascending.

    A is symmetric, and its rows are columns of the lower triangle from their diagonals on.
    """
    row = np.repeat(np.arange(A.size), np.diff(A.indptr))
    take = np.flatnonzero(A.indices >= row)
    return take, row[take] * A.size + A.indices[take]
