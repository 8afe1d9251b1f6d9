"""Sparse symmetric factorisations A = L D L^T: supernodal Bunch-Kaufman by rslab.

The factors do not depend on the number of threads.

========================  ==================================================================
symbol                    meaning
========================  ==================================================================
A                         symmetric, N x N, may be indefinite
`LowerPattern`            where A may differ from zero; one pattern for all values of theta
`Symbolic`                ordering and elimination tree of a pattern, found once
`Factorisation`           the factors of one A
========================  ==================================================================
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import rslab
import scipy.sparse

from modefront._typing import Floats, Ints
from modefront.errors import ModelError
from modefront.linalg.affine import SparseAffine
from modefront.linalg.products import threads

MOST = 4
"""Threads of a factor, and of solutions with it, at most. Without a number, rslab would take as
many on a machine with two processors, whatever the environment says."""


class SingularMatrixError(ModelError):
    """A matrix has no factorisation, because it is singular."""


@dataclass(frozen=True, eq=False)
class LowerPattern:
    """Pattern of the lower triangle of a symmetric matrix, by columns.

    Attributes
    ----------
    indptr : (N + 1,) where each column starts in ``indices``
    indices : (entries,) rows, ascending within each column; the diagonal is always there
    """

    indptr: Ints
    indices: Ints

    @property
    def size(self) -> int:
        """Number of rows and columns N."""
        return self.indptr.size - 1

    @property
    def keys(self) -> Ints:
        """Column * N + row of each entry, ascending."""
        columns = np.repeat(np.arange(self.size), np.diff(self.indptr))
        return columns * self.size + self.indices


def lower_pattern(keys: Ints, size: int) -> LowerPattern:
    """Return the pattern with the given keys, column * N + row, in any order, and the diagonal.

    Ascending runs of keys are merged, which is far quicker than sorting them.
    """
    ranked = np.sort(np.concatenate([keys, np.arange(size) * (size + 1)]), kind="stable")
    unique = ranked[np.append(True, ranked[1:] != ranked[:-1])]
    starts = np.searchsorted(unique, np.arange(size + 1) * size)
    return LowerPattern(starts.astype(np.intp), (unique % size).astype(np.intp))


@dataclass(frozen=True, eq=False)
class Factorisation:
    """Factors L D L^T with pivots of order one and two."""

    ldl: rslab.Ldlt

    @property
    def negative(self) -> int | None:
        """Number of negative eigenvalues of A, read off D (Sylvester's law of inertia)."""
        _, negative, zero = self.ldl.inertia
        return negative if zero == 0 else None

    def solve(self, block: Floats) -> Floats:
        """Return the solution X of A X = block, both of shape (N, columns)."""
        out: Floats = self.ldl.solve_many(block)
        return out


class Symbolic(Protocol):
    """Analysis of a pattern, shared by the factorisations of all matrices that have it."""

    def factor(self, values: Floats) -> Factorisation:
        """Factor the matrix with these values, in the order of the pattern's entries.

        Raises SingularMatrixError where the matrix is singular to working precision.
        """


@dataclass(frozen=True, eq=False)
class _Analysis:
    """Ordering, elimination tree and supernodes of a pattern, for all matrices that have it."""

    symbolic: rslab.LdltSymbolic

    def factor(self, values: Floats) -> Factorisation:
        """Factor the matrix with these values; see `Symbolic`."""
        limit = "auto", min(MOST, threads())
        try:
            return Factorisation(self.symbolic.factor(values, threads=limit))
        except RuntimeError as error:
            raise SingularMatrixError(str(error)) from error


def analyse(pattern: LowerPattern) -> Symbolic:
    """Return the analysis of a pattern."""
    values = np.ones(pattern.indices.size)
    shape = pattern.size, pattern.size
    lower = scipy.sparse.csc_array((values, pattern.indices, pattern.indptr), shape=shape)
    return _Analysis(rslab.analyze(lower, path="ldlt"))


def factorise(A: scipy.sparse.sparray) -> Factorisation:
    """Return the factors of one symmetric matrix, N x N, by itself.

    Raises SingularMatrixError where it is singular to working precision.
    """
    lower = scipy.sparse.tril(A, format="coo")
    keys = lower.col.astype(np.int64) * A.shape[0] + lower.row
    pattern = lower_pattern(keys, A.shape[0])
    places = np.searchsorted(pattern.keys, keys)
    values = np.bincount(places, lower.data, pattern.indices.size).astype(float)
    return analyse(pattern).factor(values)


@dataclass(frozen=True, eq=False)
class Pencil:
    """K(theta), M(theta) and the analysis of the union of their patterns.

    Each matrix keeps its own pattern, since M often has far fewer entries than K.

    Attributes
    ----------
    K, M : stiffness and mass matrix, N x N
    symbolic : analysis of the union, which has ``entries`` in its lower triangle
    stiffness, mass : (take, put) of K and M: their entry ``take[k]`` is entry ``put[k]`` of the
        lower triangle
    """

    K: SparseAffine
    M: SparseAffine
    symbolic: Symbolic
    entries: int
    stiffness: tuple[Ints, Ints]
    mass: tuple[Ints, Ints]

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
        return self.symbolic.factor(values)


def pencil(K: SparseAffine, M: SparseAffine) -> Pencil:
    """Return the pencil of two matrices; the analysis of its pattern is done here, once."""
    (take_K, keys_K), (take_M, keys_M) = _lower(K), _lower(M)
    pattern = lower_pattern(np.concatenate([keys_K, keys_M]), K.size)
    keys = pattern.keys
    stiffness, mass = (
        (take, np.searchsorted(keys, own)) for take, own in ((take_K, keys_K), (take_M, keys_M))
    )
    return Pencil(K, M, analyse(pattern), pattern.indices.size, stiffness, mass)


def _lower(A: SparseAffine) -> tuple[Ints, Ints]:
    """Return the entries of the lower triangle and their keys, column * N + row, ascending.

    A is symmetric, and its rows are columns of the lower triangle from their diagonals on.
    """
    row = np.repeat(np.arange(A.size), np.diff(A.indptr))
    take = np.flatnonzero(A.indices >= row)
    return take, row[take] * A.size + A.indices[take]
