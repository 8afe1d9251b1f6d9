"""Sparse symmetric factorisations A = L D L^T behind one interface; one file a member.

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

from collections.abc import Callable
from functools import cache

import numpy as np

from modefront.linalg.factorisation import superlu
from modefront.linalg.factorisation.base import (
    Factorisation,
    LowerPattern,
    SingularMatrixError,
    Symbolic,
    lower_pattern,
)

__all__ = [
    "Factorisation",
    "LowerPattern",
    "SingularMatrixError",
    "Symbolic",
    "analyse",
    "lower_pattern",
]


def analyse(pattern: LowerPattern) -> Symbolic:
    """Return the analysis of a pattern by the best factorisation that works on this machine."""
    return _best()(pattern)


@cache
def _best() -> Callable[[LowerPattern], Symbolic]:
    """Return rslab's analysis where rslab is there and solves a known problem, else SuperLU's."""
    try:
        from modefront.linalg.factorisation import rslab_ldl
    except ImportError:
        return superlu.analyse
    return rslab_ldl.analyse if is_sound(rslab_ldl.analyse) else superlu.analyse


def is_sound(analysis: Callable[[LowerPattern], Symbolic]) -> bool:
    """Return whether a factorisation solves a known problem and counts its eigenvalues.

    The problem is a chain of 40 springs, A = tridiag(-1, 2 - sigma, -1) with the eigenvalues
    2 - 2 cos(k pi / 41) - sigma; sigma = 0.1 leaves four of them negative.
    """
    n, sigma = 40, 0.1
    indptr = np.append(np.arange(0, 2 * n - 1, 2), 2 * n - 1)
    indices = np.repeat(np.arange(n), 2)[1:]
    values = np.where(np.arange(2 * n - 1) % 2 == 0, 2 - sigma, -1.0)
    A = np.diag(np.full(n, 2 - sigma)) - np.eye(n, k=1) - np.eye(n, k=-1)
    X = np.cos(np.outer(np.arange(n), np.arange(3)))
    try:
        factor = analysis(LowerPattern(indptr, indices)).factor(values)
        error = np.abs(factor.solve(A @ X) - X).max()
    except (SingularMatrixError, TypeError, AttributeError, ValueError):
        return False
    return bool(error < 1e-10) and factor.negative == 4
