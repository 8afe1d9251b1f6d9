r"""Corrections of modes and their derivatives in a basis, with the factor of another model.

For a Ritz pair :math:`(\lambda, \varphi)`, :math:`\varphi^T M \varphi = 1`, the part
:math:`\delta` that the mode lacks solves, to leading order (Jacobi's correction),

.. math:: C \delta = -r, \qquad r = C \varphi, \qquad C = K - \lambda M

on the M-complement of the low Ritz modes. What a derivative :math:`\varphi'` of the reduced
problem lacks solves the same equation with

.. math:: r = C \varphi' + (K' - \lambda M' - \lambda' M) \varphi .

With the factor of an earlier :math:`A = K + s M`, the space is extended by :math:`A^{-1} r`, the
modes or derivatives are those of the reduced problem in the new space, and so on (Davidson's
method). It contains what conjugate gradients would find for each of them, and of several models
each profits from the others: where the stiffness of some parts of a structure changes by factors,
most eigenvalues of :math:`A^{-1} C` are 1 or one of these. What is kept of the space is the modes
or derivatives themselves.

Residuals are orthogonal to the basis, so their solutions are orthogonal to it in A: no product
with A is needed to extend it. A step is worth :math:`r^T A^{-1} r`, the square of the length that
was lacking but for the condition of :math:`A^{-1} C`.

Sources: Sleijpen & Van der Vorst 1996, doi:10.1137/S0895479894270427 (correction); Morgan & Scott
1986, doi:10.1137/0907054 (Davidson's method with other preconditioners).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Protocol

import numpy as np

from modefront._typing import Floats, Ints
from modefront.linalg.pencil import Pencil
from modefront.models.reduced.basis import Basis, extended, joined, residuals, trimmed
from modefront.modes import dense
from modefront.modes.derivatives import Shifted

SLOWEST = 0.5
"""Ratio of steps at most that what is left is extrapolated with."""

ENTRIES = 2**19
"""Entries of the right-hand sides that are solved together, but for `FEWEST` columns."""

FEWEST = 64
"""Right-hand sides that are solved together however large the model is, if there are as many: the
factors take 32 at a time, and the part of these that is left takes as long as all."""

STEPS = 30
"""Steps, after which a full solution is better."""


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


@dataclass(frozen=True, eq=False)
class Factor:
    """The factor of a positive definite A = K(theta) - sigma M(theta)."""

    theta: Floats
    below: Shifted

    def extend(
        self,
        pencil: Pencil,
        space: Basis,
        solutions: Floats,
        right: Floats,
        shortest: float,
    ) -> Basis:
        """Return a space with solutions (N, m) for residuals that are orthogonal to it.

        Rounding may leave its columns a little less than orthonormal.
        """
        if np.array_equal(space.theta, self.theta) and space.sigma == self.below.sigma:
            return joined(pencil, space, solutions, right, shortest)
        return extended(pencil, space, solutions, shortest, pencil.size)


class _KnownColumns(Protocol):
    """Modes or derivatives of them as a space has them, of unit energy, in columns."""

    @property
    def Y(self) -> Floats:
        """Their coordinates, (n, m)."""

    @property
    def lam(self) -> Floats:
        """The eigenvalue of the mode of each, (m,)."""

    def residuals(self, some: Ints) -> Floats:
        """Return residuals r (N, some)."""


@dataclass(frozen=True, eq=False)
class _Modes:
    """The lowest modes of several models, those of the first one first."""

    pencil: Pencil
    space: Basis
    thetas: Floats
    Y: Floats
    lam: Floats

    def residuals(self, some: Ints) -> Floats:
        X = self.space.combine(self.Y[:, some])
        return residuals(self.pencil, self.thetas[some], self.lam[some], X)


def _modes(pencil: Pencil, models: Sequence[Floats], count: int, space: Basis) -> _Modes:
    decompositions = [dense.lowest(space.K.at(theta), space.M.at(theta), count) for theta in models]
    lam = np.concatenate([modes.lam[:count] for modes in decompositions])
    Y = np.hstack([modes.Phi[:, :count] for modes in decompositions]) / np.sqrt(lam - space.sigma)
    return _Modes(pencil, space, np.repeat(models, count, axis=0), Y, lam)


@dataclass(frozen=True, eq=False)
class _Derivatives:
    """Derivatives of some modes by each parameter, over ``unit``, those of the first mode first."""

    pencil: Pencil
    space: Basis
    theta: Floats
    modes: Floats
    Y: Floats
    lam: Floats
    dlam: Floats
    unit: Floats

    def residuals(self, some: Ints) -> Floats:
        lam, dlam, unit, p = self.lam[some], self.dlam[some], self.unit[some], self.theta.size
        modes, of = np.unique(some // p, return_inverse=True)
        pencil, thetas = self.pencil, np.tile(self.theta, (some.size, 1))
        dX, X = self.space.combine(self.Y[:, some]), self.space.combine(self.modes[:, modes])
        R = pencil.M.each(thetas, -lam * dX - unit * dlam * X[:, of])
        R += pencil.K.each(thetas, dX)
        for A, factor in ((pencil.K, unit), (pencil.M, -lam * unit)):
            if A.coefficients.exponents.any():
                forces = A.derivatives_times(self.theta, X).reshape(len(X), -1)
                R += forces[:, of * p + some % p] * factor
        return R


def _derivatives(
    pencil: Pencil, theta: Floats, count: int, half_range: Floats, space: Basis
) -> _Derivatives:
    ritz = dense.decompose(space.K.at(theta), space.M.at(theta))
    dlam, S, *_ = dense.nelson(space.K, space.M, theta, ritz, count)
    lam = np.repeat(ritz.lam[:count], theta.size)
    unit = np.tile(half_range, count) / np.sqrt(lam - space.sigma)
    dY = ritz.X @ S[:, :count].reshape(space.columns, -1) * unit
    modes, dlam = ritz.Phi[:, :count], dlam[:count].ravel()
    return _Derivatives(pencil, space, theta, modes, dY, lam, dlam, unit)


def with_modes(
    pencil: Pencil,
    basis: Basis,
    factor: Factor,
    thetas: Sequence[Floats],
    count: int,
    request: CorrectionRequest,
) -> tuple[Basis, Floats] | None:
    """Return the basis with what the ``count`` lowest modes at some parameters lack in it.

    Returned as well are the relative errors (thetas,) that the eigenvalues had at the worst, as
    the first step tells. None where exact modes would take too many steps.
    """
    width = max(1, together(pencil.size) // count)
    errors = []
    for first in range(0, len(thetas), width):
        some = thetas[first : first + width]
        columns = np.arange(len(some) * count).reshape(-1, count)
        sought = partial(_modes, pencil, some, count)
        corrected = _with(pencil, basis, factor, sought, columns, request)
        if not (corrected.settled or request.share):
            return None
        basis = corrected.basis
        errors.append(corrected.errors)
    return basis, np.concatenate(errors)


# 7 arguments: the model, the space and the request.
def with_derivatives(
    pencil: Pencil,
    basis: Basis,
    factor: Factor,
    theta: Floats,
    count: int,
    half_range: Floats,
    request: CorrectionRequest,
) -> Basis:
    """Return the basis with what the derivatives of the ``count`` lowest modes lack in it.

    The modes themselves must be in it. Derivatives are over ``half_range`` (p,). They need not be
    exact to be of use.
    """
    sought = partial(_derivatives, pencil, theta, count, half_range)
    columns, width = count * theta.size, together(pencil.size)
    for first in range(0, columns, width):
        some = np.arange(first, min(first + width, columns))
        basis = _with(pencil, basis, factor, sought, some[None], request).basis
    return basis


@dataclass(frozen=True, eq=False)
class _Known:
    """A basis that knows more of some models.

    Attributes
    ----------
    basis : the basis
    errors : (models,) relative errors of their eigenvalues before
    settled : whether nothing is left that matters
    """

    basis: Basis
    errors: Floats
    settled: bool


def _with(
    pencil: Pencil,
    basis: Basis,
    factor: Factor,
    sought: Callable[[Basis], _KnownColumns],
    columns: Ints,
    request: CorrectionRequest,
) -> _Known:
    """Return the basis with some of what is sought.

    Each row of ``columns`` (models, some) is of one model.
    """
    space, active, errors = basis, columns.ravel(), np.zeros(0)
    current = sought(space)
    total, last = np.zeros((2, current.lam.size))
    for step in range(STEPS):
        R = current.residuals(active)
        Z = factor.below.factor.solve(R)
        worth = np.einsum("nc,nc->c", R, Z)
        space = factor.extend(pencil, space, Z, R, request.shortest)
        before, current = current, sought(space)
        if step == 0:
            gain = (before.lam - current.lam) / (current.lam - space.sigma)
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
    Y = current.Y[:, columns.ravel()]
    kept = trimmed(basis, space, Y, request.shortest, request.capacity)
    return _Known(kept, errors, not active.size)


def together(size: int) -> int:
    """Return how many right-hand sides are solved together."""
    return max(FEWEST, ENTRIES // size)
