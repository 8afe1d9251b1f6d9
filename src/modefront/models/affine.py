r"""Matrices that depend on the parameters through products of powers.

.. math:: A(\theta) = \sum_j c_j(\theta) A_j, \qquad c_j(\theta) = \prod_i \theta_i^{e_{ji}}

All terms share one storage (dense, or one sparsity pattern), so that assembly is one
matrix-vector product with the data of the terms.

========  =====================================================
symbol    meaning
========  =====================================================
A_j       terms, N x N, symmetric
e         exponents, terms x parameters; a row of zeros is constant
c(theta)  coefficients of the terms
========  =====================================================
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Bools, Floats


@dataclass(frozen=True)
class Monomials:
    """Coefficients c_j(theta) = prod_i theta_i ** exponents[j, i]."""

    exponents: Floats

    def values(self, theta: Floats) -> Floats:
        """Return c(theta), shape (terms,)."""
        out: Floats = np.prod(theta**self.exponents, axis=1)
        return out

    def jacobian(self, theta: Floats) -> Floats:
        """Return dc/dtheta, shape (terms, parameters)."""
        e = self.exponents
        out = np.zeros(e.shape)
        for i in np.flatnonzero(e.any(axis=0)):
            lowered = e.copy()
            lowered[:, i] = np.where(e[:, i] == 0, 0, e[:, i] - 1)
            out[:, i] = e[:, i] * np.prod(theta**lowered, axis=1)
        return out


@dataclass(frozen=True)
class DenseAffine:
    """A(theta) with dense terms, shape (terms, N, N)."""

    terms: Floats
    coefficients: Monomials

    @property
    def size(self) -> int:
        """Number of degrees of freedom N."""
        return int(self.terms.shape[1])

    @property
    def used(self) -> Bools:
        """Which parameters the matrix depends on, shape (parameters,)."""
        there = self.terms.any(axis=(1, 2))
        return np.asarray(self.coefficients.exponents[there].any(axis=0))

    def at(self, theta: Floats) -> Floats:
        """Return A(theta), shape (N, N)."""
        out: Floats = np.tensordot(self.coefficients.values(theta), self.terms, axes=1)
        return out

    def derivatives_times(self, theta: Floats, vectors: Floats) -> Floats:
        """Return dA/dtheta_i V for vectors V of shape (N, m); the result is (N, m, parameters)."""
        products = self.terms @ vectors
        out: Floats = np.tensordot(products, self.coefficients.jacobian(theta), axes=(0, 0))
        return out
