"""Sparse symmetric factorisations A = L D L^T: supernodal Bunch-Kaufman by rslab.

The factors do not depend on the number of threads.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import rslab
from scipy.sparse import csc_array, sparray, tril

from modefront._typing import Floats, Ints
from modefront.errors import ModelError
from modefront.linalg.affine import SparseAffine, expanded, merged
from modefront.linalg.products import threads

MOST = 4  # threads of a factor at most; rslab would take as many, whatever the environment says


class SingularMatrixError(ModelError):
    """A matrix has no factorisation, because it is singular."""


@dataclass(frozen=True, eq=False)
class Factorisation:
    """Factors L D L^T with pivots of order one and two, of A = K - sigma M for a pencil."""

    ldl: rslab.Ldlt
    sigma: float = 0.0

    @property
    def negative(self) -> int | None:
        """Number of negative eigenvalues of A, read off D (Sylvester's law of inertia)."""
        _, negative, zero = self.ldl.inertia
        return negative if zero == 0 else None

    def solve(self, block: Floats) -> Floats:
        """Return the solution X of A X = block, both of shape (N, columns)."""
        return self.ldl.solve_many(block)


def factor(pattern: rslab.LdltSymbolic, values: Floats, sigma: float = 0.0) -> Factorisation:
    """Factor a matrix with these values, in the order of the entries of its analysed pattern.

    Raises SingularMatrixError where the matrix is singular to working precision.
    """
    try:
        return Factorisation(pattern.factor(values, threads=("auto", min(MOST, threads()))), sigma)
    except RuntimeError as error:
        raise SingularMatrixError(str(error)) from error


def analyse(keys: Ints, size: int) -> tuple[rslab.LdltSymbolic, Ints]:
    """Return the analysis of a pattern, and the keys of its entries, ascending.

    ``keys`` are column * N + row of entries of the lower triangle of N x N, in any order, some more
    than once; the diagonal comes to them.
    """
    keys = merged(keys, np.arange(size) * (size + 1))
    starts = np.searchsorted(keys, np.arange(size + 1) * size)
    parts = np.ones(keys.size), (keys % size).astype(np.intp), starts.astype(np.intp)
    return rslab.analyze(csc_array(parts, shape=(size, size)), path="ldlt"), keys


def factorise(A: sparray) -> Factorisation:
    """Return the factors of one symmetric matrix, N x N; SingularMatrixError as of `factor`."""
    lower = tril(A, format="coo")
    own = lower.col.astype(np.int64) * A.shape[0] + lower.row
    analysis, keys = analyse(own, A.shape[0])
    values = np.bincount(np.searchsorted(keys, own), lower.data, keys.size).astype(float)
    return factor(analysis, values)


@dataclass(frozen=True, eq=False)
class Pencil:
    """K(theta), M(theta) and the analysis of the union of their patterns.

    Each matrix keeps its own pattern, since M often has far fewer entries than K.
    """

    K: SparseAffine  # K, M: stiffness and mass matrix, N x N
    M: SparseAffine
    analysis: rslab.LdltSymbolic  # that of the union, which has ``entries`` in its lower triangle
    entries: int
    # stiffness, mass: (take, put) of K and M: their entry ``take[k]`` is entry ``put[k]`` of the
    # lower triangle
    stiffness: tuple[Ints, Ints]
    mass: tuple[Ints, Ints]
    before: Callable[[], None]  # what is called before each factorisation

    @property
    def size(self) -> int:
        """Number of degrees of freedom N."""
        return self.K.size

    def factor(self, K: Floats, M: Floats, sigma: float) -> Factorisation:
        """Factor K - sigma M, given the values of both on their own patterns.

        Raises SingularMatrixError where sigma is an eigenvalue.
        """
        values, (take, put) = np.zeros(self.entries), self.stiffness
        values[put] = K[take]
        if sigma != 0:
            take, put = self.mass
            values[put] -= sigma * M[take]
        self.before()
        return factor(self.analysis, values, sigma)


def pencil(K: SparseAffine, M: SparseAffine, before: Callable[[], None] = lambda: None) -> Pencil:
    """Return the pencil of two matrices; the analysis of its pattern is done here, once."""
    both = _lower(K), _lower(M)
    analysis, keys = analyse(np.concatenate([own for _, own in both]), K.size)
    stiffness, mass = ((take, np.searchsorted(keys, own)) for take, own in both)
    return Pencil(K, M, analysis, keys.size, stiffness, mass, before)


def _lower(A: SparseAffine) -> tuple[Ints, Ints]:
    """Return the entries of the lower triangle and their keys, column * N + row, ascending.

    A is symmetric, and its rows are columns of the lower triangle from their diagonals on.
    """
    row = expanded(A.indptr)
    take = np.flatnonzero(A.indices >= row)
    return take, row[take] * A.size + A.indices[take]
