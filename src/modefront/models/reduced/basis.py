r"""The space V in which a reduced model looks for its modes; ``docs/reduced.md`` says why.

The basis is orthonormal in the norm of :math:`A = K(\theta_1) + s M(\theta_1)`, with s = 0 unless
K is singular (rigid-body modes). A is positive definite also where M is not (massless degrees of
freedom), and its norm is that of energy: a mode of unit energy that lacks a part of length d has
an eigenvalue wrong by :math:`d^2`, relative. Derivatives are taken times half the range of their
parameter over the length of their mode, and directions shorter than d are left out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np

from modefront._typing import Floats, Ints
from modefront.linalg.affine import DenseAffine
from modefront.linalg.factorisation import Factorisation, Pencil
from modefront.linalg.products import combine, combine_all, gram
from modefront.modes import dense
from modefront.modes.dense import Decomposition, lowest
from modefront.modes.tridiagonal import LowestModes


@dataclass(frozen=True, eq=False)
class Basis:
    """A basis and the model in it.

    Attributes
    ----------
    pencil, factor : the full matrices, and the factor of A; lost on the way to other processes
    theta, sigma : the parameters and the shift of A = K - sigma M
    blocks : (N, n_i) the columns of V, some after the others
    K, M : the matrices in the basis
    """

    pencil: Pencil
    factor: Factorisation
    theta: Floats
    sigma: float
    blocks: tuple[Floats, ...]
    K: DenseAffine
    M: DenseAffine

    def __getstate__(self) -> dict[str, Any]:
        """Return the state without what is large and known to others, or cannot be sent."""
        return {**vars(self), "pencil": None, "factor": None}

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


def empty(pencil: Pencil, factor: Factorisation, theta: Floats, sigma: float) -> Basis:
    """Return the basis without columns in the norm of K - sigma M at ``theta``."""
    K, M = (
        DenseAffine(np.zeros((A.terms.shape[1], 0, 0)), A.coefficients)
        for A in (pencil.K, pencil.M)
    )
    return Basis(pencil, factor, theta, sigma, (), K, M)


def extended(basis: Basis, vectors: Floats, shortest: float, capacity: int) -> Basis:
    """Return the basis extended by vectors (N, m), the longest directions first.

    Directions shorter than ``shortest``, and those beyond ``capacity`` columns, are left out. Of
    the projected matrices only the new rows and columns are computed.
    """
    pencil = basis.pencil
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


STEPS = 30
"""Steps, after which a full solution is better."""

SLOWEST = 0.5
"""Ratio of steps at most that what is left is extrapolated with."""


@dataclass(frozen=True)
class CorrectionRequest:
    """Accuracy and size requested of an extension of the basis.

    Attributes
    ----------
    share : what is left over all that was lacking
    shortest : length of the directions that are too short to matter, in energy
    capacity : columns that the basis may have
    enough : relative error of eigenvalues below which a model is left as it is
    """

    share: float
    shortest: float
    capacity: int
    enough: float = 0.0


_Sought: TypeAlias = Callable[[Basis], tuple[Floats, Floats, Callable[[Ints], Floats]]]
"""Finds modes or derivatives of them in a space, of unit energy, in columns: their coordinates
(n, m), the eigenvalue of the mode of each (m,), and what returns residuals (N, some) of some."""


def _modes(models: Sequence[Floats], count: int) -> _Sought:
    """Return what finds the lowest modes of several models, those of the first one first."""
    thetas = np.repeat(models, count, axis=0)

    def within(space: Basis) -> tuple[Floats, Floats, Callable[[Ints], Floats]]:
        found = [space.lowest(theta, count) for theta in models]
        lam = np.concatenate([modes.lam[:count] for modes in found])
        Y = np.hstack([modes.Phi[:, :count] for modes in found]) / np.sqrt(lam - space.sigma)

        def residuals_of(some: Ints) -> Floats:
            X = space.combine(Y[:, some])
            return residuals(space.pencil, thetas[some], lam[some], X)

        return Y, lam, residuals_of

    return within


def _derivatives(theta: Floats, count: int, half_range: Floats) -> _Sought:
    """Return what finds the derivatives of some modes by each parameter, over half its range."""
    p = theta.size

    def within(space: Basis) -> tuple[Floats, Floats, Callable[[Ints], Floats]]:
        ritz = dense.decompose(space.K.at(theta), space.M.at(theta))
        slopes, S, *_ = dense.nelson(space.K, space.M, theta, ritz, count)
        lam, dlam = np.repeat(ritz.lam[:count], p), slopes[:count].ravel()
        unit = np.tile(half_range, count) / np.sqrt(lam - space.sigma)
        Y = ritz.X @ S[:, :count].reshape(space.columns, -1) * unit

        def residuals_of(some: Ints) -> Floats:
            pencil = space.pencil
            modes, of = np.unique(some // p, return_inverse=True)
            thetas, few, own = np.tile(theta, (some.size, 1)), unit[some], lam[some]
            dX, X = space.combine(Y[:, some]), space.combine(ritz.Phi[:, modes])
            R = pencil.M.each(thetas, -own * dX - few * dlam[some] * X[:, of])
            R += pencil.K.each(thetas, dX)
            for A, factor in ((pencil.K, few), (pencil.M, -own * few)):
                if A.coefficients.exponents.any():
                    forces = A.derivatives_times(theta, X).reshape(len(X), -1)
                    R += forces[:, of * p + some % p] * factor
            return R

        return Y, lam, residuals_of

    return within


def lacking_lengths(basis: Basis, thetas: Sequence[Floats], count: int) -> Floats:
    r"""Return :math:`r^T A^{-1} r` (thetas,) of the worst of the ``count`` lowest modes.

    That is the relative error of its eigenvalue but for the condition of :math:`A^{-1} C`.
    """
    worth = []
    for some in _shares(basis, thetas, count):
        _, lam, residuals_of = _modes(some, count)(basis)
        R = residuals_of(np.arange(lam.size))
        worth.append(np.einsum("nc,nc->c", R, basis.factor.solve(R)).reshape(-1, count).max(axis=1))
    return np.concatenate(worth)


def with_modes(
    basis: Basis, thetas: Sequence[Floats], count: int, request: CorrectionRequest
) -> tuple[Basis, Floats] | None:
    """Return the basis with what the ``count`` lowest modes at some parameters lack in it.

    Returned as well are the relative errors (thetas,) that the eigenvalues had at the worst, as
    the first step tells. None where exact modes would take too many steps.
    """
    errors = []
    for some in _shares(basis, thetas, count):
        columns = np.arange(len(some) * count).reshape(-1, count)
        basis, before, settled = _with(basis, _modes(some, count), columns, request)
        if not (settled or request.share):
            return None
        errors.append(before)
    return basis, np.concatenate(errors)


def with_derivatives(
    basis: Basis, theta: Floats, count: int, half_range: Floats, request: CorrectionRequest
) -> Basis:
    """Return the basis with what the derivatives of the ``count`` lowest modes lack in it.

    The modes themselves must be in it. Derivatives are over ``half_range`` (p,). They need not be
    exact to be of use.
    """
    sought = _derivatives(theta, count, half_range)
    columns, width = count * theta.size, _together(basis)
    for first in range(0, columns, width):
        some = np.arange(first, min(first + width, columns))
        basis, *_ = _with(basis, sought, some[None], request)
    return basis


def _with(
    basis: Basis, sought: _Sought, columns: Ints, request: CorrectionRequest
) -> tuple[Basis, Floats, bool]:
    """Return the basis with some of what is sought; each row of ``columns`` is of one model.

    Further the relative errors of the models' eigenvalues before, and whether all is settled.
    """
    space, active, errors = basis, columns.ravel(), np.zeros(0)
    Y, lam, residuals_of = sought(space)
    total, last = np.zeros((2, lam.size))
    for step in range(STEPS):
        R = residuals_of(active)
        Z = basis.factor.solve(R)
        worth = np.einsum("nc,nc->c", R, Z)
        space = extended(space, Z, request.shortest, space.pencil.size)
        before, (Y, lam, residuals_of) = lam, sought(space)
        if step == 0:
            gain = (before - lam) / (lam - space.sigma)
            errors = np.maximum(gain[columns].max(axis=1), 0.0)
            columns = columns[errors >= request.enough]
        total[active] += worth
        ratio = np.full(worth.shape, SLOWEST)
        np.divide(worth, last[active], out=ratio, where=last[active] > 0)
        left = worth * np.minimum(ratio, SLOWEST)
        last[active] = worth
        active = active[left > np.maximum(request.share * total[active], request.shortest**2)]
        active = active[np.isin(active, columns)]
        if not active.size:
            break
    if (Y := Y[:, columns.ravel()]).size:
        basis = extended(basis, space.combine(Y), request.shortest, request.capacity)
    return basis, errors, not active.size


def _shares(basis: Basis, thetas: Sequence[Floats], count: int) -> list[Sequence[Floats]]:
    width = max(1, _together(basis) // count)
    return [thetas[first : first + width] for first in range(0, len(thetas), width)]


def _together(basis: Basis) -> int:
    return max(64, 2**19 // basis.pencil.size)
