"""Interface of sparse symmetric factorisations."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from modefront._typing import Floats, Ints
from modefront.errors import ModelError


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


class Factorisation(Protocol):
    """The factors of one symmetric matrix A."""

    @property
    def negative(self) -> int | None:
        """Number of negative eigenvalues of A; None where the factors do not tell."""

    def solve(self, block: Floats) -> Floats:
        """Return the solution X of A X = block, both of shape (N, columns)."""


class Symbolic(Protocol):
    """Analysis of a pattern, shared by the factorisations of all matrices that have it."""

    def factor(self, values: Floats) -> Factorisation:
        """Factor the matrix with these values, in the order of the pattern's entries.

        Raises SingularMatrixError where the matrix is singular to working precision.
        """
