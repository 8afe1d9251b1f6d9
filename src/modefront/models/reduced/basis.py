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

import numpy as np
import scipy.sparse

from modefront._typing import Floats
from modefront.models.affine import DenseAffine, SparseAffine
from modefront.modes import derivatives as exact
from modefront.modes.pencil import Pencil
from modefront.modes.products import combine, gram
from modefront.modes.sparse import lowest, lowest_near
from modefront.modes.spectrum import Shifted

DERIVATIVES = 1e-2
"""Residual of the derivatives in the basis, which need not be exact to be of use there."""

NEARLY = 1e-4
"""Residual of the modes of a snapshot near to which a space is known, over their eigenvalues."""


@dataclass(frozen=True, eq=False)
class Snapshot:
    """What one full eigensolution gives.

    Attributes
    ----------
    theta : where it was taken
    beyond : eigenvalues below it were proved to be all among the modes; below all of them if none
    vectors : (N, columns) modes of unit energy and their derivatives
    below : the factor of K + s M, which is positive definite
    """

    theta: Floats
    beyond: float
    vectors: Floats
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


def snapshot(
    pencil: Pencil,
    theta: Floats,
    count: int,
    derived: int,
    half_range: Floats,
    space: Floats | None = None,
) -> Snapshot:
    """Solve the full model for ``count`` modes or more, the first ``derived`` with derivatives.

    ``half_range`` (p,) is how far the parameters go from a middle; ``space`` (N, columns) is near
    the modes, if such a space is known.

    Raises ModelError where the model has no such modes.
    """
    if space is None:
        found = lowest(pencil, theta, count)
    else:
        found = lowest_near(pencil, theta, count, space, NEARLY)
    everywhere = scipy.sparse.eye_array(pencil.size, format="csr")
    _, dphi, _ = exact.at_sensors(pencil, everywhere, theta, found, derived, DERIVATIVES)
    below, above = found.factors
    energy = np.sqrt(found.lam - below.sigma)
    dphi *= half_range / energy[:derived, None]
    vectors = np.hstack([found.Phi / energy, dphi.reshape(pencil.size, -1)])
    beyond = above.sigma if above is not below else below.sigma
    return Snapshot(theta, beyond, vectors, below)


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
    W = vectors
    for least in (shortest, 0.5):  # what is left after the first pass has the length 1
        W = W - combine(V, gram(V, A @ W))
        squares, U = np.linalg.eigh(gram(W, A @ W))
        there = np.flatnonzero(squares > least**2)[::-1][: capacity - V.shape[1]]
        W = combine(W, U[:, there] / np.sqrt(squares[there]))
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
