r"""The space V in which a reduced model looks for its modes, what they lack, and their errors.

``docs/reduced.md`` has the equations, whose symbols are used here. The basis is orthonormal in the
norm of :math:`A = K(\theta_1) + s M(\theta_1)`, with s = 0 unless K is singular (rigid-body modes),
positive definite also where M is not (massless degrees of freedom). It is that of energy: a mode of
unit energy that lacks a part of length d has an eigenvalue wrong by :math:`d^2`, relative.
Derivatives are taken times half the range of their parameter over the length of their mode.

What a derivative :math:`\varphi'` of the reduced problem lacks solves the equation of what a mode
lacks, with :math:`r = C \varphi' + (K' - \lambda M' - \lambda' M) \varphi, C = K - \lambda M`. Of
several models each profits from the others: where the stiffness of some parts of a structure
changes by factors, most eigenvalues of :math:`A^{-1} C` are 1 or one of these. A step is worth
:math:`r^T A^{-1} r`, the square of the length that was lacking but for the condition of
:math:`A^{-1} C`. Source of the bounds: Parlett 1998, doi:10.1137/1.9781611971163, section 10.5.
"""

import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, TypeAlias

import numpy as np

from modefront._typing import Floats, Ints
from modefront.errors import ModelError
from modefront.linalg.affine import DenseAffine
from modefront.linalg.factorisation import Factorisation, Pencil, SingularMatrixError
from modefront.linalg.products import combine, gram, times
from modefront.models.matrices import MatrixModel
from modefront.modes import dense
from modefront.modes.dense import Decomposition
from modefront.work.task import Costs, spend
from modefront.work.transfer import shared


@shared
@dataclass(frozen=True, eq=False)
class Basis:
    """A basis and the model in it."""

    full: MatrixModel  # the model with sparse matrices
    factor: Factorisation  # of A; lost on the way to other processes
    theta: Floats  # theta, sigma: the parameters and the shift of A = K - sigma M
    sigma: float
    shortest: float  # length of the directions that are too short to matter, in energy
    capacity: int  # columns that it may have
    blocks: tuple[Floats, ...]  # (N, n_i) the columns of V, some after the others
    K: DenseAffine  # K, M: the matrices in the basis
    M: DenseAffine

    def __getstate__(self) -> dict[str, Any]:
        """Return the state without the factor, which cannot be sent."""
        return {**vars(self), "factor": None}

    @property
    def footprint(self) -> float:
        """Bytes that the basis takes, and an eigensolution of the full model."""
        return self.full.footprint + sum(block.nbytes for block in self.blocks)

    @property
    def pencil(self) -> Pencil:
        """The matrices of the full model."""
        return self.full.pencil

    @property
    def columns(self) -> int:
        """Dimension n of the space."""
        return self.K.size

    def combine(self, C: Floats) -> Floats:
        """Return V C for C of shape (n, m)."""
        first, *others = np.split(C, np.cumsum([X.shape[1] for X in self.blocks])[:-1])
        out = combine(self.blocks[0], first)
        for X, part in zip(self.blocks[1:], others, strict=True):
            out += combine(X, part)
        return out

    def lowest(self, theta: Floats, count: int) -> Decomposition:
        """Return all Ritz values and modes, of which the ``count`` lowest are precise."""
        return dense.decompose(self.K.at(theta), self.M.at(theta), count)

    def ritz_values(self, theta: Floats, count: int) -> Floats:
        """Return the same Ritz values; none where the model has no modes."""
        with suppress(ModelError):
            return self.lowest(theta, count).lam
        return np.zeros(0)


def empty(
    full: MatrixModel, factor: Factorisation, theta: Floats, shortest: float, capacity: int
) -> Basis:
    """Return the basis without columns in the norm of the factor's matrix, that at ``theta``."""
    pair = (full.pencil.K, full.pencil.M)
    K, M = (DenseAffine(np.zeros((A.terms.shape[1], 0, 0)), A.coefficients) for A in pair)
    return Basis(full, factor, theta, factor.sigma, shortest, capacity, (), K, M)


def extended(basis: Basis, vectors: Floats) -> Basis:
    """Return the basis extended by vectors (N, m), the longest directions first.

    Of the projected matrices only the new rows and columns are computed.
    """
    pencil, W = basis.pencil, vectors
    for least in (basis.shortest, 0.3):  # what rounding leaves of the basis goes the second time
        theta, sigma = np.tile(basis.theta, (W.shape[1], 1)), np.full(W.shape[1], basis.sigma)
        AW = residuals(pencil, theta, sigma, W)
        if basis.columns:
            W = W - basis.combine(np.vstack([gram(block, AW) for block in basis.blocks]))
            AW = residuals(pencil, theta, sigma, W)
        squares, U = np.linalg.eigh(gram(W, AW))
        kept = np.flatnonzero(squares > least**2)[::-1][: basis.capacity - basis.columns]
        if not kept.size:
            return basis
        W = combine(W, U[:, kept] / np.sqrt(squares[kept]))
    blocks = *basis.blocks, W
    n, matrices = basis.columns, []
    for full, known in ((pencil.K, basis.K), (pencil.M, basis.M)):
        new = full.project(blocks, W)  # columns, (terms, rows, m), the last of which are new rows
        across, inner = new[:, :n], (new[:, n:] + new[:, n:].transpose(0, 2, 1)) / 2
        terms = np.block([[known.terms, across], [across.transpose(0, 2, 1), inner]])
        matrices.append(DenseAffine(terms, known.coefficients))
    return replace(basis, blocks=blocks, K=matrices[0], M=matrices[1])


def residuals(pencil: Pencil, thetas: Floats, lam: Floats, X: Floats) -> Floats:
    """Return (K(theta_k) - lam_k M(theta_k)) x_k for thetas (m, p), lam (m,) and X (N, m)."""
    out = pencil.M.each(thetas, X)
    out *= -lam
    out += pencil.K.each(thetas, X)
    return out


STEPS = 30  # steps, after which a full solution is better
SLOWEST = 0.5  # ratio of steps at most that what is left is extrapolated with


_Found: TypeAlias = tuple[Floats, Floats, Callable[[Ints], Floats]]
"""Modes or derivatives of them in a space, of unit energy, in columns: their coordinates (n, m),
the eigenvalue of the mode of each (m,), and what returns residuals (N, some) of some."""


def _modes(models: Sequence[Floats], count: int, space: Basis) -> _Found:
    """Return the lowest modes of several models, those of the first one first."""
    found = [space.lowest(theta, count) for theta in models]
    lam = np.concatenate([modes.lam[:count] for modes in found])
    Y = np.hstack([modes.Phi[:, :count] for modes in found]) / np.sqrt(lam - space.sigma)
    thetas = np.repeat(models, count, axis=0)

    def residuals_of(some: Ints) -> Floats:
        return residuals(space.pencil, thetas[some], lam[some], space.combine(Y[:, some]))

    return Y, lam, residuals_of


def _derivatives(theta: Floats, count: int, half_range: Floats, space: Basis) -> _Found:
    """Return the derivatives of some modes by each parameter, over half its range."""
    p, pencil = theta.size, space.pencil
    ritz = space.lowest(theta, 0)
    slopes, S, *_ = dense.nelson(space.K, space.M, theta, ritz, count)
    lam, dlam = np.repeat(ritz.lam[:count], p), slopes[:count].ravel()
    unit = np.tile(half_range, count) / np.sqrt(lam - space.sigma)
    Y = ritz.X @ S[:, :count].reshape(space.columns, -1) * unit

    def residuals_of(some: Ints) -> Floats:
        modes, of = np.unique(some // p, return_inverse=True)
        thetas, few, own = np.tile(theta, (some.size, 1)), unit[some], lam[some]
        dX, X = space.combine(Y[:, some]), space.combine(ritz.Phi[:, modes])
        R = pencil.M.each(thetas, -own * dX - few * dlam[some] * X[:, of])
        R += pencil.K.each(thetas, dX)
        for A, factor in ((pencil.K, few), (pencil.M, -own * few)):
            if A.coefficients.varies:
                forces = A.derivatives_times(theta, X).reshape(len(X), -1)
                R += forces[:, of * p + some % p] * factor
        return R

    return Y, lam, residuals_of


def lacking_lengths(basis: Basis, thetas: Sequence[Floats], count: int) -> Floats:
    r"""Return :math:`r^T A^{-1} r` (thetas,) of the worst of the ``count`` lowest modes.

    That is the relative error of its eigenvalue but for the condition of :math:`A^{-1} C`.
    """
    worth = []
    for part in _batches(basis, len(thetas), count):
        _, lam, residuals_of = _modes(thetas[part], count, basis)
        R = residuals_of(np.arange(lam.size))
        worth.append(np.einsum("nc,nc->c", R, basis.factor.solve(R)).reshape(-1, count).max(axis=1))
    return np.concatenate(worth)


def with_modes(
    basis: Basis, thetas: Sequence[Floats], count: int, share: float, enough: float = 0.0
) -> tuple[Basis, Floats]:
    """Return the basis with what the ``count`` lowest modes at some parameters lack in it.

    All of it but a ``share`` of its square; models are left as they are where errors of eigenvalues
    are below ``enough``. Returned as well are the relative errors (thetas,) that these had at the
    worst, as the first step tells. Raises ModelError where exact modes would take too many steps,
    and where a larger space sees that a matrix is indefinite.
    """
    errors = []
    for part in _batches(basis, len(thetas), count):
        some = thetas[part]
        columns = np.arange(len(some) * count).reshape(-1, count)
        basis, before, settled = _with(basis, partial(_modes, some, count), columns, share, enough)
        if not (settled or share):
            raise ModelError("exact modes would take too many steps")
        errors.append(before)
    return basis, np.concatenate(errors)


def with_derivatives(
    basis: Basis, theta: Floats, count: int, half_range: Floats, share: float
) -> Basis:
    """Return the basis with what the derivatives of the ``count`` lowest modes lack in it.

    The modes themselves must be in it. Derivatives are over ``half_range`` (p,). They need not be
    exact to be of use.
    """
    count = min(count, basis.columns - 1)
    sought = partial(_derivatives, theta, count, half_range)
    columns = np.arange(count * theta.size)
    for part in _batches(basis, columns.size):
        basis, *_ = _with(basis, sought, columns[None, part], share, 0.0)
    return basis


def _with(
    basis: Basis, sought: Callable[[Basis], _Found], columns: Ints, share: float, enough: float
) -> tuple[Basis, Floats, bool]:
    """Return the basis with some of what is sought; each row of ``columns`` is of one model.

    Further the relative errors of the models' eigenvalues before, and whether all is settled.
    """
    space, active = replace(basis, capacity=basis.pencil.size), columns.ravel()
    errors = np.zeros(0)
    Y, lam, residuals_of = sought(space)
    total, last = np.zeros((2, lam.size))
    for step in range(STEPS):
        R = residuals_of(active)
        Z = basis.factor.solve(R)
        worth = np.einsum("nc,nc->c", R, Z)
        space = extended(space, Z)
        before, (Y, lam, residuals_of) = lam, sought(space)
        if step == 0:
            gain = (before - lam) / (lam - space.sigma)
            errors = np.maximum(gain[columns].max(axis=1), 0.0)
            columns = columns[errors >= enough]
        total[active] += worth
        ratio = np.full(worth.shape, SLOWEST)
        np.divide(worth, last[active], out=ratio, where=last[active] > 0)
        left = worth * np.minimum(ratio, SLOWEST)
        last[active] = worth
        active = active[left > np.maximum(share * total[active], basis.shortest**2)]
        active = active[np.isin(active, columns)]
        if not active.size:
            break
    if (Y := Y[:, columns.ravel()]).size:
        basis = extended(basis, space.combine(Y))
    return basis, errors, not active.size


def _batches(basis: Basis, count: int, columns: int = 1) -> list[slice]:
    """Return which of ``count`` things, of so many columns each, are solved for together."""
    width = max(1, max(64, 2**19 // basis.pencil.size) // columns)
    return [slice(first, first + width) for first in range(0, count, width)]


LATER = 4  # gaps above the last mode in question among which the widest is taken


@dataclass(frozen=True)
class Certificate:
    """Bounds of the errors of modes, and the lowest modes as they are known better."""

    # (modes,) relative errors of the eigenvalues at most; infinite where a mode is missing, or
    # nothing is proved
    eigenvalue: Floats
    shape: Floats  # (modes,) errors of the mode shapes in the norm of M, over their length
    # lam, phi: (lowest modes,), (sensors, lowest modes) eigenvalues and mass-normalised shapes of
    # all modes that were looked at, much nearer to the full model's; none where nothing is proved
    lam: Floats = field(default_factory=lambda: np.zeros(0))
    phi: Floats = field(default_factory=lambda: np.zeros((0, 0)))


def certificate_of(basis: Basis, theta: Floats, modes: Ints, lowest: int = 0) -> Certificate:
    """Return bounds of the errors of modes, counted from 0, at theta (p,).

    They are infinite where one of the ``lowest`` modes, or a mode below the requested ones, is
    missing. It takes a factorisation.
    """
    started = time.perf_counter()
    known = _bounds(basis, theta, max(lowest, int(modes.max()) + 1))
    spend(Costs(certificates=1, certificate_time=time.perf_counter() - started))
    return replace(known, eigenvalue=known.eigenvalue[modes], shape=known.shape[modes])


def _bounds(basis: Basis, theta: Floats, count: int) -> Certificate:
    """Return the errors of the ``count`` lowest modes or more.

    One step of inverse iteration makes better modes of X: (X - B^-1 R) (I + S^-1 P) Y, with
    the eigenvectors Y of diag(rho) - P; what they differ from X is the error of the shapes.
    """
    pencil, unknown = basis.pencil, Certificate(np.full(count, np.inf), np.ones(count))
    try:
        ritz = basis.lowest(theta, count + LATER)
    except ModelError:
        return unknown
    above = level(basis, theta, ritz.lam, count)
    if above is None:
        return unknown
    m = int(np.searchsorted(ritz.lam, above.sigma))
    rho, X = ritz.lam[:m], basis.combine(ritz.Phi[:, :m])
    K, M = pencil.K.at(theta), pencil.M.at(theta)
    R = times(K, X) - times(M, X) * rho
    Z = above.solve(R)
    room = above.sigma - rho  # the diagonal of S
    E, unit = gram(R, Z), np.sqrt(np.outer(room, room))
    values, U = np.linalg.eigh((E + E.T) / 2 / unit)
    if values[-1] >= 1:  # E < S does not hold
        return unknown
    values = np.maximum(values, 0.0)  # but for rounding
    P = (U * (values / (1 - values))) @ U.T * unit
    noise = np.finfo(float).eps * (K.diagonal() @ X**2)
    forms = gram(X, R)  # should vanish; what is beyond rounding is an error of the projection
    forms[np.abs(forms) <= 100 * np.sqrt(np.outer(noise, noise))] = 0.0
    ell, Y = np.linalg.eigh(np.diag(rho) + (forms + forms.T) / 2 - P)
    Y *= np.where(np.diag(Y) < 0, -1.0, 1.0)
    error = np.maximum(np.abs(rho - ell), np.diag(P))  # without cancellation, where P is small
    left = rho - basis.sigma - error
    relative = np.divide(error, left, out=np.full(m, np.inf), where=left > 0)
    turn = Y + P @ Y / room[:, None]
    change = combine(X, turn - np.eye(m)) - combine(Z, turn)
    better = X + change
    MX = times(M, better)
    square = np.einsum("nr,nr->r", better, MX)
    off = change - better * (np.einsum("nr,nr->r", change, MX) / square)
    shape = np.sqrt(np.maximum(np.einsum("nr,nr->r", off, times(M, off)), 0.0))
    phi = basis.full.selection @ better / np.sqrt(square)
    return Certificate(relative, np.minimum(shape, 1.0), ell, phi)


def level(basis: Basis, theta: Floats, lam: Floats, count: int) -> Factorisation | None:
    """Return a level above the lowest ``count`` Ritz values below which no mode is missing.

    With it comes the factor that proves it. It is in the first wide gap of the Ritz values
    ``lam`` above these, or in the widest of the next ones; gaps are relative to lam - sigma. None
    where a mode is missing, or there is no gap.
    """
    pencil = basis.pencil
    gaps = np.diff(lam[count - 1 : count + LATER]) / (lam[count : count + LATER] - basis.sigma)
    if not gaps.size or gaps.max() <= 1e-6:
        return None
    wide = gaps > 0.2
    k = count + int(np.argmax(wide) if wide.any() else np.argmax(gaps))
    # A low level is the sharper one for the modes below it, and Ritz values above are less exact.
    sigma = float(lam[k - 1] + 0.25 * (lam[k] - lam[k - 1]))
    with suppress(SingularMatrixError):
        factor = pencil.factor(pencil.K.at(theta).data, pencil.M.at(theta).data, sigma)
        return factor if factor.negative == k else None
    return None
