r"""What modes and their derivatives lack in a basis, with the factor of another model.

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

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from modefront._typing import Floats, Ints
from modefront.models.reduced.basis import Basis, extended, joined, residuals, trimmed
from modefront.modes import dense
from modefront.modes.pencil import Pencil
from modefront.modes.spectrum import Shifted

SLOWEST = 0.5
"""Ratio of steps at most that what is left is extrapolated with."""

ENTRIES = 2**21
"""Entries of the right-hand sides that are solved together, but for `FEWEST` columns."""

FEWEST = 36
"""Right-hand sides that are solved together however large the model is, if there are as many."""

STEPS = 30
"""Steps, after which a full solution is better."""


@dataclass(frozen=True)
class Wanted:
    """How exactly a basis is to know a model.

    Attributes
    ----------
    share : what is left over all that was lacking
    shortest : length of the directions that are too short to matter, in energy
    capacity : columns that the basis may have
    """

    share: float
    shortest: float
    capacity: int


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
        capacity: int,
    ) -> Basis:
        """Return a space with solutions (N, m) for residuals that are orthogonal to it."""
        if np.array_equal(space.theta, self.theta) and space.sigma == self.below.sigma:
            return joined(pencil, space, solutions, right, shortest, capacity)
        return extended(pencil, space, solutions, shortest, capacity)


class _Sought(Protocol):
    """Modes or derivatives of them, scaled by their energy, each at one of thetas (m, p)."""

    @property
    def thetas(self) -> Floats:
        """Parameters of each, (m, p)."""

    def coordinates(self, space: Basis) -> Floats:
        """Return what is sought as the reduced problem has it (n, m)."""

    def residuals(self, space: Basis, some: Ints) -> Floats:
        """Return residuals r (N, some)."""


@dataclass(frozen=True, eq=False)
class _Modes:
    pencil: Pencil
    models: Sequence[Floats]
    count: int

    @property
    def thetas(self) -> Floats:
        return np.repeat(self.models, self.count, axis=0)

    def coordinates(self, space: Basis) -> Floats:
        return self._reduced(space)[0]

    def residuals(self, space: Basis, some: Ints) -> Floats:
        Y, lam = self._reduced(space)
        return residuals(self.pencil, self.thetas[some], lam[some], space.combine(Y[:, some]))

    def _reduced(self, space: Basis) -> tuple[Floats, Floats]:
        """Return modes (n, m) of unit energy, and their eigenvalues (m,)."""
        found = [dense.decompose(space.K.at(at), space.M.at(at)) for at in self.models]
        lam = np.concatenate([one.lam[: self.count] for one in found])
        Y = np.hstack([one.Phi[:, : self.count] for one in found])
        return Y / np.sqrt(lam - space.sigma), lam


@dataclass(frozen=True, eq=False)
class _Derivatives:
    pencil: Pencil
    theta: Floats
    count: int
    half_range: Floats

    @property
    def thetas(self) -> Floats:
        return np.tile(self.theta, (self.count * self.theta.size, 1))

    def coordinates(self, space: Basis) -> Floats:
        return self._reduced(space)[0]

    def residuals(self, space: Basis, some: Ints) -> Floats:
        dY, Y, lam, dlam, unit = self._reduced(space)
        dY, dlam, lam, unit = dY[:, some], dlam[some], lam[some], unit[some]
        modes, of = np.unique(some // self.theta.size, return_inverse=True)
        pencil, thetas = self.pencil, self.thetas[some]
        R = pencil.M.each(thetas, space.combine(-dY * lam - Y[:, modes[of]] * (unit * dlam)))
        R += pencil.K.each(thetas, space.combine(dY))
        Phi, column = space.combine(Y[:, modes]), of * self.theta.size + some % self.theta.size
        for A, factor in ((pencil.K, unit), (pencil.M, -lam * unit)):
            if A.coefficients.exponents.any():
                forces = A.derivatives_times(self.theta, Phi).reshape(len(Phi), -1)
                R += forces[:, column] * factor
        return R

    def _reduced(self, space: Basis) -> tuple[Floats, Floats, Floats, Floats, Floats]:
        """Return derivatives (n, m) over their units, modes (n, count), lam, dlam, units (m,)."""
        theta, count = self.theta, self.count
        ritz = dense.decompose(space.K.at(theta), space.M.at(theta))
        dlam, dY, _ = dense.nelson(space.K, space.M, theta, ritz, count)
        lam = np.repeat(ritz.lam[:count], theta.size)
        unit = np.tile(self.half_range, count) / np.sqrt(lam - space.sigma)
        dY = dY[:, :count].reshape(space.columns, -1) * unit
        return dY, ritz.Phi[:, :count], lam, dlam[:count].ravel(), unit


def with_modes(
    pencil: Pencil,
    basis: Basis,
    factor: Factor,
    thetas: Sequence[Floats],
    count: int,
    wanted: Wanted,
) -> Basis | None:
    """Return the basis with what the ``count`` lowest modes at some parameters lack in it.

    None where that would take too many steps.
    """
    width = max(1, together(pencil.size) // count)
    for first in range(0, len(thetas), width):
        sought = _Modes(pencil, thetas[first : first + width], count)
        found = _with(pencil, basis, factor, sought, np.arange(len(sought.thetas)), wanted)
        if found is None:
            return None
        basis = found
    return basis


def with_derivatives(
    pencil: Pencil,
    basis: Basis,
    factor: Factor,
    theta: Floats,
    count: int,
    half_range: Floats,
    wanted: Wanted,
) -> Basis:
    """Return the basis with what the derivatives of the ``count`` lowest modes lack in it.

    The modes themselves must be in it. Derivatives are over ``half_range`` (p,). They need not be
    exact to be of use.
    """
    sought = _Derivatives(pencil, theta, count, half_range)
    columns, width = count * theta.size, together(pencil.size)
    for first in range(0, columns, width):
        some = np.arange(first, min(first + width, columns))
        basis = _with(pencil, basis, factor, sought, some, wanted) or basis
    return basis


def _with(
    pencil: Pencil, basis: Basis, factor: Factor, sought: _Sought, columns: Ints, wanted: Wanted
) -> Basis | None:
    """Return the basis with some columns of what is sought, or None where that takes too long."""
    space, active = basis, columns
    total, last = np.zeros((2, len(sought.thetas)))
    for _ in range(STEPS):
        R = sought.residuals(space, active)
        Z = factor.below.factor.solve(R)
        worth = np.einsum("nc,nc->c", R, Z)
        space = factor.extend(pencil, space, Z, R, wanted.shortest, pencil.size)
        total[active] += worth
        ratio = np.full(worth.shape, SLOWEST)
        np.divide(worth, last[active], out=ratio, where=last[active] > 0)
        left = worth * np.minimum(ratio, SLOWEST)
        last[active] = worth
        active = active[left > np.maximum(wanted.share * total[active], wanted.shortest**2)]
        if not active.size:
            Y = sought.coordinates(space)[:, columns]
            return trimmed(basis, space, Y, wanted.shortest, wanted.capacity)
    return None


def together(size: int) -> int:
    """Return how many right-hand sides are solved together."""
    return max(FEWEST, ENTRIES // size)
