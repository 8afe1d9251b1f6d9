"""Supernodal Bunch-Kaufman L D L^T by rslab; the factors do not depend on the number of threads."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import rslab
import scipy.sparse

from modefront._typing import Floats
from modefront.linalg.factorisation.base import LowerPattern, SingularMatrixError
from modefront.linalg.products import threads

MOST = 4
"""Threads of a factor, and of solutions with it, at most. Without a number, rslab would take as
many on a machine with two processors, whatever the environment says."""


@dataclass(frozen=True, eq=False)
class RslabFactorisation:
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


@dataclass(frozen=True, eq=False)
class RslabSymbolic:
    """Ordering, elimination tree and supernodes of a pattern."""

    symbolic: rslab.LdltSymbolic

    def factor(self, values: Floats) -> RslabFactorisation:
        """Factor the matrix with these values, in the order of the pattern's entries."""
        limit = "auto", min(MOST, threads())
        try:
            return RslabFactorisation(self.symbolic.factor(values, threads=limit))
        except RuntimeError as error:
            raise SingularMatrixError(str(error)) from error


def analyse(pattern: LowerPattern) -> RslabSymbolic:
    """Return the analysis of a pattern."""
    values = np.ones(pattern.indices.size)
    shape = pattern.size, pattern.size
    lower = scipy.sparse.csc_array((values, pattern.indices, pattern.indptr), shape=shape)
    return RslabSymbolic(rslab.analyze(lower, path="ldlt"))
