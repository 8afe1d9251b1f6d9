r"""The space V in which a reduced model looks for its modes; ``docs/reduced.md`` says why.

The basis is orthonormal in the norm of :math:`A = K(\theta_1) + s M(\theta_1)`, with s = 0 unless
K is singular (rigid-body modes). A is positive definite also where M is not (massless degrees of
freedom), and its norm is that of energy: a mode of unit energy that lacks a part of length d has
an eigenvalue wrong by :math:`d^2`, relative. Derivatives are taken times half the range of their
parameter over the length of their mode, and directions shorter than d are left out.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Floats
from modefront.linalg.affine import DenseAffine
from modefront.linalg.pencil import Pencil
from modefront.linalg.products import combine, combine_all, gram
from modefront.modes.dense import Decomposition, lowest
from modefront.modes.tridiagonal import LowestModes


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

    def combine(self, C: Floats) -> Floats:
        """Return V C for C of shape (n, m)."""
        return combine_all(self.blocks, C)

    def lowest(self, theta: Floats, count: int) -> LowestModes | Decomposition:
        """Return all Ritz values and the ``count`` lowest modes; see `modefront.modes.dense`."""
        return lowest(self.K.at(theta), self.M.at(theta), count)


def empty(pencil: Pencil, theta: Floats, sigma: float) -> Basis:
    """Return the basis without columns in the norm of K - sigma M at ``theta``."""
    K, M = (
        DenseAffine(np.zeros((A.terms.shape[1], 0, 0)), A.coefficients)
        for A in (pencil.K, pencil.M)
    )
    return Basis((), K, M, theta, sigma)


def extended(
    pencil: Pencil, basis: Basis, vectors: Floats, shortest: float, capacity: int
) -> Basis:
    """Return the basis extended by vectors (N, m), the longest directions first.

    Directions shorter than ``shortest``, and those beyond ``capacity`` columns, are left out. Of
    the projected matrices only the new rows and columns are computed.
    """
    W = vectors
    for least in (shortest, 0.3):  # what rounding leaves of the basis goes the second time
        theta, sigma = np.tile(basis.theta, (W.shape[1], 1)), np.full(W.shape[1], basis.sigma)
        AW = residuals(pencil, theta, sigma, W)
        if basis.columns:
            W = W - basis.combine(np.vstack([gram(block, AW) for block in basis.blocks]))
            AW = residuals(pencil, theta, sigma, W)
        squares, U = np.linalg.eigh(gram(W, AW))
        kept = np.flatnonzero(squares > least**2)[::-1][: capacity - basis.columns]
        if not kept.size:
            return basis
        W = combine(W, U[:, kept] / np.sqrt(squares[kept]))
    blocks = *basis.blocks, W
    K, M = (
        _bordered(reduced, full.project(blocks, W))
        for full, reduced in ((pencil.K, basis.K), (pencil.M, basis.M))
    )
    return replace(basis, blocks=blocks, K=K, M=M)


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
