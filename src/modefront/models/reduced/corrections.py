r"""What modes and their derivatives lack in a basis, with the factor of another model.

``docs/reduced.md`` has the equation, in which :math:`r = C \varphi, C = K - \lambda M`. What a
derivative :math:`\varphi'` of the reduced problem lacks solves the same one with

.. math:: r = C \varphi' + (K' - \lambda M' - \lambda' M) \varphi .

Of several models each profits from the others: where the stiffness of some parts of a structure
changes by factors, most eigenvalues of :math:`A^{-1} C` are 1 or one of these. What is kept of the
space is the modes or derivatives themselves. A step is worth :math:`r^T A^{-1} r`, the square of
the length that was lacking but for the condition of :math:`A^{-1} C`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from modefront._typing import Floats, Ints
from modefront.linalg.factorisation import Factorisation
from modefront.linalg.pencil import Pencil
from modefront.models.reduced.basis import Basis, extended, residuals
from modefront.modes import dense

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


def _modes(pencil: Pencil, models: Sequence[Floats], count: int) -> _Sought:
    """Return what finds the lowest modes of several models, those of the first one first."""
    thetas = np.repeat(models, count, axis=0)

    def within(space: Basis) -> tuple[Floats, Floats, Callable[[Ints], Floats]]:
        found = [space.lowest(theta, count) for theta in models]
        lam = np.concatenate([modes.lam[:count] for modes in found])
        Y = np.hstack([modes.Phi[:, :count] for modes in found]) / np.sqrt(lam - space.sigma)
        return (
            Y,
            lam,
            lambda some: residuals(pencil, thetas[some], lam[some], space.combine(Y[:, some])),
        )

    return within


def _derivatives(pencil: Pencil, theta: Floats, count: int, half_range: Floats) -> _Sought:
    """Return what finds the derivatives of some modes by each parameter, over half its range."""
    p = theta.size

    def within(space: Basis) -> tuple[Floats, Floats, Callable[[Ints], Floats]]:
        ritz = dense.decompose(space.K.at(theta), space.M.at(theta))
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
                if A.coefficients.exponents.any():
                    forces = A.derivatives_times(theta, X).reshape(len(X), -1)
                    R += forces[:, of * p + some % p] * factor
            return R

        return Y, lam, residuals_of

    return within


def lacking_lengths(
    pencil: Pencil, basis: Basis, factor: Factorisation, thetas: Sequence[Floats], count: int
) -> Floats:
    r"""Return :math:`r^T A^{-1} r` (thetas,) of the worst of the ``count`` lowest modes.

    That is the relative error of its eigenvalue but for the condition of :math:`A^{-1} C`.
    """
    worth = []
    for some in _shares(pencil, thetas, count):
        _, lam, residuals_of = _modes(pencil, some, count)(basis)
        R = residuals_of(np.arange(lam.size))
        worth.append(np.einsum("nc,nc->c", R, factor.solve(R)).reshape(-1, count).max(axis=1))
    return np.concatenate(worth)


def with_modes(
    pencil: Pencil,
    basis: Basis,
    factor: Factorisation,
    thetas: Sequence[Floats],
    count: int,
    request: CorrectionRequest,
) -> tuple[Basis, Floats] | None:
    """Return the basis with what the ``count`` lowest modes at some parameters lack in it.

    Returned as well are the relative errors (thetas,) that the eigenvalues had at the worst, as
    the first step tells. None where exact modes would take too many steps.
    """
    errors = []
    for some in _shares(pencil, thetas, count):
        columns = np.arange(len(some) * count).reshape(-1, count)
        sought = _modes(pencil, some, count)
        basis, before, settled = _with(pencil, basis, factor, sought, columns, request)
        if not (settled or request.share):
            return None
        errors.append(before)
    return basis, np.concatenate(errors)


# 7 arguments: the model, the space and the request.
def with_derivatives(
    pencil: Pencil,
    basis: Basis,
    factor: Factorisation,
    theta: Floats,
    count: int,
    half_range: Floats,
    request: CorrectionRequest,
) -> Basis:
    """Return the basis with what the derivatives of the ``count`` lowest modes lack in it.

    The modes themselves must be in it. Derivatives are over ``half_range`` (p,). They need not be
    exact to be of use.
    """
    sought = _derivatives(pencil, theta, count, half_range)
    columns, width = count * theta.size, _together(pencil)
    for first in range(0, columns, width):
        some = np.arange(first, min(first + width, columns))
        basis, *_ = _with(pencil, basis, factor, sought, some[None], request)
    return basis


def _with(
    pencil: Pencil,
    basis: Basis,
    factor: Factorisation,
    sought: _Sought,
    columns: Ints,
    request: CorrectionRequest,
) -> tuple[Basis, Floats, bool]:
    """Return the basis with some of what is sought; each row of ``columns`` is of one model.

    Further the relative errors of the models' eigenvalues before, and whether all is settled.
    """
    space, active, errors = basis, columns.ravel(), np.zeros(0)
    Y, lam, residuals_of = sought(space)
    total, last = np.zeros((2, lam.size))
    for step in range(STEPS):
        R = residuals_of(active)
        Z = factor.solve(R)
        worth = np.einsum("nc,nc->c", R, Z)
        space = extended(pencil, space, Z, request.shortest, pencil.size)
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
        basis = extended(pencil, basis, space.combine(Y), request.shortest, request.capacity)
    return basis, errors, not active.size


def _shares(pencil: Pencil, thetas: Sequence[Floats], count: int) -> list[Sequence[Floats]]:
    """Return the models in shares whose modes are corrected together."""
    width = max(1, _together(pencil) // count)
    return [thetas[first : first + width] for first in range(0, len(thetas), width)]


def _together(pencil: Pencil) -> int:
    """Return how many right-hand sides are solved together; factors take 32 at a time."""
    return max(64, 2**19 // pencil.size)
