r"""The space in which a reduced model looks for its modes.

At a snapshot :math:`\theta_s` the modes and their exact derivatives span, to first order, all
modes near it. By Rayleigh and Ritz, an eigenvalue from such a space is wrong by the square of what
a mode lacks:

.. math::
    \varphi(\theta) = \varphi + \sum_i (\theta_i - \theta_{si})\,\partial_i \varphi + O(h^2)
    \quad\Longrightarrow\quad \lambda - \lambda^* = O(h^4).

The basis is orthonormal in the norm of :math:`A = K(\theta_1) + s M(\theta_1)`, with s = 0 unless
K is singular (rigid-body modes). A is positive definite also where M is not (massless degrees of
freedom), and its norm is that of energy: a mode of unit energy that lacks a part of length d has
an eigenvalue wrong by :math:`d^2`, relative. Derivatives are taken times half the range of their
parameter over the length of their mode, and directions shorter than d are left out.

========  ======================================================================
symbol    meaning
========  ======================================================================
V         (N, n) basis, :math:`V^T A V = I`
K, M      affine as in the full model, with the terms :math:`V^T K_j V`
========  ======================================================================
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse

from modefront._typing import Floats
from modefront.models.affine import DenseAffine, SparseAffine
from modefront.models.reduced import window
from modefront.modes.pencil import Pencil
from modefront.modes.products import combine, gram, times
from modefront.modes.sparse import lowest
from modefront.modes.spectrum import Shifted


@dataclass(frozen=True, eq=False)
class Snapshot:
    """What one full eigensolution gives.

    Attributes
    ----------
    theta : where it was taken
    beyond : eigenvalues below it were proved to be all among the modes
    modes : (N, modes) of unit energy
    below : the factor of K + s M, which is positive definite
    """

    theta: Floats
    beyond: float
    modes: Floats
    below: Shifted


@dataclass(frozen=True, eq=False)
class Basis:
    """A basis and the model in it."""

    A: scipy.sparse.csr_array
    V: Floats
    K: DenseAffine
    M: DenseAffine

    @property
    def columns(self) -> int:
        """Dimension n of the space."""
        return self.V.shape[1]

    @cached_property
    def semidefinite(self) -> bool:
        """Whether no projected term shows that a term of K or M is indefinite."""
        return window.semidefinite(self.K) and window.semidefinite(self.M)


def snapshot(pencil: Pencil, theta: Floats, count: int) -> Snapshot:
    """Solve the full model for ``count`` modes or more.

    Raises ModelError where the model has no such modes.
    """
    found = lowest(pencil, theta, count)
    below, above = found.factors
    return Snapshot(theta, above.sigma, found.Phi / np.sqrt(found.lam - below.sigma), below)


def empty(pencil: Pencil, first: Snapshot) -> Basis:
    """Return the basis without columns in the norm of the first snapshot."""
    A = pencil.K.at(first.theta) - first.below.sigma * pencil.M.at(first.theta)
    K = DenseAffine(np.zeros((pencil.K.terms.shape[1], 0, 0)), pencil.K.coefficients)
    M = DenseAffine(np.zeros((pencil.M.terms.shape[1], 0, 0)), pencil.M.coefficients)
    return Basis(A, np.zeros((pencil.size, 0)), K, M)


def extended(
    pencil: Pencil, basis: Basis, vectors: Floats, shortest: float, capacity: int
) -> Basis:
    """Return the basis with what vectors (N, m) add to it, by the longest directions first.

    Directions shorter than ``shortest``, and those beyond ``capacity`` columns, are left out. Of
    the projected matrices only the new rows and columns are computed.
    """
    A, V = basis.A, basis.V
    W = vectors - combine(V, gram(V, times(A, vectors)))
    squares, U = np.linalg.eigh(gram(W, times(A, W)))
    there = np.flatnonzero(squares > shortest**2)[::-1][: capacity - V.shape[1]]
    W = combine(W, U[:, there] / np.sqrt(squares[there]))
    AW = times(A, W)
    inside = gram(V, AW)  # what rounding has left of V in directions that are now of unit length
    squares, U = np.linalg.eigh(gram(W, AW) - inside.T @ inside)
    W = combine(W - combine(V, inside), U / np.sqrt(squares))
    V = np.hstack([V, W])
    return Basis(A, V, _grown(pencil.K, basis.K, V, W), _grown(pencil.M, basis.M, V, W))


def _grown(full: SparseAffine, reduced: DenseAffine, V: Floats, W: Floats) -> DenseAffine:
    """Return the projection on V, of which W are the last columns, given that on the first ones."""
    new = full.project(V, W)
    n = V.shape[1] - W.shape[1]
    across, inner = new[:, :n], new[:, n:]
    inner = (inner + inner.transpose(0, 2, 1)) / 2
    top = np.concatenate([reduced.terms, across], axis=2)
    bottom = np.concatenate([across.transpose(0, 2, 1), inner], axis=2)
    return DenseAffine(np.concatenate([top, bottom], axis=1), reduced.coefficients)
