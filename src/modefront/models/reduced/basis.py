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

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from modefront._typing import Floats
from modefront.linalg.affine import DenseAffine
from modefront.linalg.pencil import Pencil
from modefront.linalg.products import combine, combine_all, gram
from modefront.models.reduced import completeness
from modefront.modes.derivatives import Shifted
from modefront.modes.sparse import lowest

UNSOUND = 0.1
"""Energy of a direction that should have the energy 1, below which it is rounding."""


@dataclass(frozen=True, eq=False)
class Snapshot:
    """Modes, and the factor, of one full eigensolution.

    Attributes
    ----------
    theta : where it was taken
    beyond : eigenvalues below it were proved to be all among the modes
    proved : how many there are
    modes : (N, modes) of unit energy
    below : the factor of K + s M, which is positive definite
    """

    theta: Floats
    beyond: float
    proved: int
    modes: Floats
    below: Shifted


@dataclass(frozen=True, eq=False)
class Basis:
    """A basis and the model in it.

    Attributes
    ----------
    blocks : (N, n_i) the columns of V, some after the others
    K, M : the matrices in the basis
    theta, sigma : the parameters and the shift of A = K - sigma M
    """

    blocks: tuple[Floats, ...]
    K: DenseAffine
    M: DenseAffine
    theta: Floats
    sigma: float

    @property
    def columns(self) -> int:
        """Dimension n of the space."""
        return self.K.size

    @cached_property
    def semidefinite(self) -> bool:
        """Whether no projected term shows that a term of K or M is indefinite."""
        return completeness.semidefinite(self.K) and completeness.semidefinite(self.M)

    @property
    def A(self) -> Floats:
        """The identity but for rounding, as the projected matrices give it."""
        return self.K.at(self.theta) - self.sigma * self.M.at(self.theta)

    def combine(self, C: Floats) -> Floats:
        """Return V C for C of shape (n, m)."""
        return combine_all(self.blocks, C)


def snapshot(pencil: Pencil, theta: Floats, count: int) -> Snapshot:
    """Solve the full model for ``count`` modes or more.

    Raises ModelError where the model has no such modes.
    """
    spectrum = lowest(pencil, theta, count)
    below, above = spectrum.factors
    modes = spectrum.Phi / np.sqrt(spectrum.lam - below.sigma)
    return Snapshot(theta, above.sigma, spectrum.proved, modes, below)


def empty(pencil: Pencil, first: Snapshot) -> Basis:
    """Return the basis without columns in the norm of the first snapshot."""
    K, M = (
        DenseAffine(np.zeros((A.terms.shape[1], 0, 0)), A.coefficients)
        for A in (pencil.K, pencil.M)
    )
    return Basis((), K, M, first.theta, first.below.sigma)


def extended(
    pencil: Pencil, basis: Basis, vectors: Floats, shortest: float, capacity: int
) -> Basis:
    """Return the basis extended by vectors (N, m), the longest directions first.

    Directions shorter than ``shortest``, and those beyond ``capacity`` columns, are left out.
    """

    def A(X: Floats) -> Floats:
        theta = np.tile(basis.theta, (X.shape[1], 1))
        return residuals(pencil, theta, np.full(X.shape[1], basis.sigma), X)

    AX = A(vectors)
    W = vectors
    if basis.columns:
        W = vectors - basis.combine(np.vstack([gram(block, AX) for block in basis.blocks]))
        AX = A(W)
    space = joined(pencil, basis, W, AX, shortest, capacity)
    n, m = basis.columns, space.columns - basis.columns
    return _kept(basis, space, np.vstack([np.zeros((n, m)), np.eye(m)])) if m else basis


def joined(
    pencil: Pencil,
    basis: Basis,
    W: Floats,
    AW: Floats,
    shortest: float,
    capacity: int | None = None,
) -> Basis:
    """Return a space of the basis and some vectors W (N, m), given A W, that are orthogonal to it.

    What is added is orthonormal but for rounding in W, and otherwise as in `extended`. Of the
    projected matrices only the new rows and columns are computed.
    """
    room = W.shape[1] if capacity is None else capacity - basis.columns
    squares, U = np.linalg.eigh(gram(W, AW))
    kept = np.flatnonzero(squares > shortest**2)[::-1][:room]
    if not kept.size:
        return basis
    W = combine(W, U[:, kept] / np.sqrt(squares[kept]))
    blocks = *basis.blocks, W
    K, M = (
        _bordered(reduced, full.project(blocks, W))
        for full, reduced in ((pencil.K, basis.K), (pencil.M, basis.M))
    )
    return replace(basis, blocks=blocks, K=K, M=M)


def trimmed(basis: Basis, space: Basis, vectors: Floats, shortest: float, capacity: int) -> Basis:
    """Return the basis with what some vectors add to it, given in a space that contains it.

    ``vectors`` (columns of the space, m) are left out in part as in `extended`.
    """
    n = basis.columns
    U, lengths, _ = np.linalg.svd(vectors[n:], full_matrices=False)
    U = U[:, lengths > shortest][:, : capacity - n]
    return _kept(basis, space, np.vstack([np.zeros((n, U.shape[1])), U])) if U.size else basis


def _kept(basis: Basis, space: Basis, turn: Floats) -> Basis:
    """Return the basis with ``turn`` (columns, m) of a space whose first columns it is.

    What is added is orthonormal in spite of rounding.
    """
    n, A = basis.columns, space.A
    turn[:n] -= A[:n] @ turn
    squares, U = np.linalg.eigh(turn.T @ A @ turn)
    kept = squares > UNSOUND
    if not kept.any():
        return basis
    turn = turn @ (U[:, kept] / np.sqrt(squares[kept]))
    K, M = (_turned(form, n, turn) for form in (space.K, space.M))
    return replace(basis, blocks=(*basis.blocks, space.combine(turn)), K=K, M=M)


def residuals(pencil: Pencil, thetas: Floats, lam: Floats, X: Floats) -> Floats:
    """Return (K(theta_k) - lam_k M(theta_k)) x_k for thetas (m, p), lam (m,) and X (N, m)."""
    out = pencil.M.each(thetas, X)
    out *= -lam
    out += pencil.K.each(thetas, X)
    return out


def _bordered(reduced: DenseAffine, new: Floats) -> DenseAffine:
    """Return projected terms with new columns (terms, rows, m), the last of which are new rows."""
    n = reduced.size
    across, inner = new[:, :n], new[:, n:]
    inner = (inner + inner.transpose(0, 2, 1)) / 2
    top = np.concatenate([reduced.terms, across], axis=2)
    bottom = np.concatenate([across.transpose(0, 2, 1), inner], axis=2)
    return DenseAffine(np.concatenate([top, bottom], axis=1), reduced.coefficients)


def _turned(A: DenseAffine, n: int, turn: Floats) -> DenseAffine:
    """Return A on its first n columns and on ``turn`` (columns of A, m) of all."""
    right = A.terms @ turn
    new = np.concatenate([right[:, :n], turn.T @ right], axis=1)
    return _bordered(DenseAffine(A.terms[:, :n, :n], A.coefficients), new)
