r"""L U by SciPy's SuperLU in symmetric mode, with the inertia where the pivots prove it.

With pivots on the diagonal only, :math:`P A P^T = L U` is :math:`L D L^T` with
:math:`D = \operatorname{diag}(U)`, and the signs of D are the inertia of A (Sylvester). SuperLU
leaves the diagonal only for a pivot that is zero; without a choice of pivots, however, the factors
of an indefinite matrix may grow. They are trusted where they solve a known problem.

The ordering (minimum degree on A + A^T) is found once for a pattern: every matrix is permuted
before it is factored, and SuperLU then keeps the order.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

from modefront._typing import Floats, Ints
from modefront.linalg.factorisation.base import LowerPattern, SingularMatrixError

GROWTH = 1e-8
"""Backward error of a solution, by components, above which the pivots' signs are not trusted."""


@dataclass(frozen=True, eq=False)
class SuperluFactorisation:
    """Factors L U of the permuted matrix.

    Attributes
    ----------
    A : the permuted matrix
    lu : its factors, a ``scipy.sparse.linalg.SuperLU``
    order : (N,) the row of the given matrix in each row of the permuted one
    """

    A: scipy.sparse.csc_array
    lu: Any
    order: Ints

    @property
    def negative(self) -> int | None:
        """Number of negative eigenvalues of A; None where pivots left the diagonal or grew."""
        if not np.array_equal(self.lu.perm_r, self.lu.perm_c):
            return None
        known = np.cos(np.arange(self.order.size, dtype=float))
        x = self.lu.solve(known)
        error = np.abs(self.A @ x - known) / (abs(self.A) @ np.abs(x) + np.abs(known))
        return int(np.sum(self.lu.U.diagonal() < 0)) if error.max() < GROWTH else None

    def solve(self, block: Floats) -> Floats:
        """Return the solution X of A X = block, both of shape (N, columns)."""
        out = np.empty_like(block)
        out[self.order] = self.lu.solve(block[self.order])
        return out


@dataclass(frozen=True, eq=False)
class SuperluSymbolic:
    """Ordering of a pattern, and where each entry of the permuted matrix is taken from."""

    order: Ints
    indptr: Ints
    indices: Ints
    source: Ints

    def factor(self, values: Floats) -> SuperluFactorisation:
        """Factor the matrix with these values, in the order of the pattern's entries."""
        parts = values[self.source], self.indices, self.indptr
        A = scipy.sparse.csc_array(parts, shape=(self.order.size, self.order.size))
        try:
            return SuperluFactorisation(A, _splu(A, "NATURAL"), self.order)
        except RuntimeError as error:
            raise SingularMatrixError(str(error)) from error


def analyse(pattern: LowerPattern) -> SuperluSymbolic:
    """Return the analysis of a pattern."""
    n = pattern.size
    columns = np.repeat(np.arange(n), np.diff(pattern.indptr))
    rows, off = pattern.indices, pattern.indices != columns
    source = np.concatenate([np.arange(rows.size), np.flatnonzero(off)])
    i, j = np.concatenate([rows, columns[off]]), np.concatenate([columns, rows[off]])
    dominant = np.where(i == j, float(n), -1.0)
    A = scipy.sparse.csc_array((dominant, (i, j)), shape=(n, n))
    position = _splu(A, "MMD_AT_PLUS_A").perm_c.astype(np.intp)
    i, j = position[i], position[j]
    ranked = np.lexsort((i, j))
    indptr = np.searchsorted(j[ranked], np.arange(n + 1))
    return SuperluSymbolic(
        np.argsort(position), indptr.astype(np.intp), i[ranked].astype(np.intp), source[ranked]
    )


def _splu(A: scipy.sparse.csc_array, ordering: str) -> Any:
    return scipy.sparse.linalg.splu(
        A, permc_spec=ordering, diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )
