r"""How wrong the modes of a reduced model are, from their residuals in the full one.

The basis is extended by :math:`A^{-1} r` for the residuals r of all models that are asked for, see
`modefront.models.reduced.corrections`. The reduced problem in that space has the modes
:math:`\varphi_j` and eigenvalues :math:`\lambda_j`. A mode x with the Rayleigh quotient
:math:`\lambda`, of the basis alone, is made up of these by

.. math:: c_j = \varphi_j^T M x = \frac{\varphi_j^T r}{\lambda_j - \lambda}, \qquad
    \lambda - \lambda_s = \sum_{j \ne s} c_j^2 \, (\lambda_j - \lambda_s) ,

without cancellation, s being the mode that x stands for; the error of its shape is the root of the
sum of the other :math:`c_j^2`. Both grow towards the errors in the full model as the space does.
The first extension gives at least :math:`4 \kappa / (1 + \kappa)^2` of the error to leading order
(Kantorovich), with :math:`\kappa` the condition of :math:`A^{-1} C`; others follow until they add
little. Where they do not settle, A is that of the model itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats, Ints
from modefront.models.reduced.basis import Basis, residuals
from modefront.models.reduced.corrections import SLOWEST, Factor
from modefront.modes import dense
from modefront.modes.factorisation import SingularMatrixError
from modefront.modes.pencil import Pencil
from modefront.modes.spectrum import Shifted

NEAR = 9.8
"""Condition of K over that of the factor up to which the first extension is enough: a third of the
error at the least, and nearly all of it in most cases."""

SETTLED = 1 / 3
"""What an extension adds to an estimate, over all of it, below which another one is not needed."""

STEPS = 8
"""Extensions at most."""

SHARE = 1e-3
"""Share of the energies of residuals that compressing them may lose."""

CLOSE = 1e-8
"""Relative gap of eigenvalues below which no quotient is formed with it."""


@dataclass(frozen=True)
class Certificate:
    """Estimated errors of modes.

    Attributes
    ----------
    eigenvalue : (modes,) relative errors of the eigenvalues; infinite where a mode is missing, or
        where the estimate does not settle and the matrix is singular
    shape : (modes,) errors of the mode shapes in the norm of M, over their length
    """

    eigenvalue: Floats
    shape: Floats


def missing(modes: int) -> Certificate:
    """Return the certificate of as many modes, below which others are missing."""
    return Certificate(np.full(modes, np.inf), np.ones(modes))


@dataclass(frozen=True, eq=False)
class Asked:
    """What is to be judged.

    Attributes
    ----------
    theta : (p,) parameters of the model
    wanted : (modes,) the modes in question, counted from 0
    lam, Y : (modes,), (n, modes) these modes in the basis, mass-normalised
    near : whether the first extension is enough
    """

    theta: Floats
    wanted: Ints
    lam: Floats
    Y: Floats
    near: bool


@dataclass(frozen=True, eq=False)
class _Judged:
    """Errors as a space knows them, of eigenvalues and shapes; and the modes of that space."""

    eigenvalue: Floats
    shape: Floats
    lam: Floats
    Y: Floats


def estimates(
    pencil: Pencil, basis: Basis, factor: Factor, asked: Sequence[Asked]
) -> list[Certificate]:
    """Return the certificates of some models. Errors of eigenvalues are over lam + s."""
    sigma, space = factor.below.sigma, basis
    nothing = [np.zeros(one.lam.shape) for one in asked]
    first = [_Judged(z, z, one.lam, one.Y) for one, z in zip(asked, nothing, strict=True)]
    found = first[:]
    left, added, pending = nothing[:], nothing[:], list(range(len(asked)))
    for _ in range(STEPS):
        if not pending:
            break
        space = _with_solutions(
            pencil, space, factor, [(asked[k].theta, found[k]) for k in pending]
        )
        unsettled = []
        for k in pending:
            before, found[k] = found[k].eigenvalue, _judged(space, basis.columns, asked[k])
            gain, total = found[k].eigenvalue - before, found[k].eigenvalue
            ratio = np.divide(gain, added[k], out=np.zeros_like(gain), where=added[k] > 0)
            ratio = np.clip(ratio, 0.0, SLOWEST)
            left[k], added[k] = gain * ratio / (1 - ratio), gain
            if not (asked[k].near or (gain <= SETTLED * total).all()):
                unsettled.append(k)
        pending = unsettled
    for k in pending:
        theta = asked[k].theta
        try:
            A = pencil.factor(pencil.K.at(theta).data, pencil.M.at(theta).data, sigma)
        except SingularMatrixError:
            left[k] = np.full(left[k].shape, np.inf)
            continue
        own = Factor(theta, Shifted(sigma, A))
        space = _with_solutions(pencil, basis, own, [(theta, first[k])])
        found[k], left[k] = _judged(space, basis.columns, asked[k]), nothing[k]
    return [
        Certificate((one.eigenvalue + rest) / (of.lam - sigma), np.minimum(one.shape, 1.0))
        for one, rest, of in zip(found, left, asked, strict=True)
    ]


def _with_solutions(
    pencil: Pencil, space: Basis, factor: Factor, models: Sequence[tuple[Floats, _Judged]]
) -> Basis:
    """Return the space with the solutions for the residuals of some modes."""
    thetas = np.repeat([theta for theta, _ in models], [one.lam.size for _, one in models], axis=0)
    lam = np.concatenate([one.lam for _, one in models])
    X = space.combine(np.hstack([one.Y for _, one in models]))
    R = residuals(pencil, thetas, lam, X)
    Z = factor.below.factor.solve(R)
    energy = np.maximum(np.einsum("nc,nc->c", R, Z), 0.0)
    unit = np.divide(1.0, np.sqrt(energy), out=np.zeros_like(energy), where=energy > 0)
    R *= unit
    Z *= unit
    return factor.extend(pencil, space, Z, R, np.sqrt(SHARE))


def _judged(space: Basis, n: int, of: Asked) -> _Judged:
    """Return how wrong modes of a basis are, given a space of which it is the first n columns."""
    K, M = space.K.at(of.theta), space.M.at(of.theta)
    modes, s = dense.decompose(K, M), of.wanted
    r = K[n:, :n] @ of.Y - M[n:, :n] @ of.Y * of.lam
    mu, shift = modes.mu[:, None], modes.sigma
    gap = 1 - (of.lam + shift) * mu  # (lam_j - lam) mu_j
    c = modes.X[n:].T @ r
    close = np.abs(gap) < CLOSE
    c = np.divide(c, gap, out=np.zeros_like(c), where=~close)  # over the root of mu_j
    if close.any():
        c = np.where(close, modes.X.T @ (M[:, :n] @ of.Y) / np.where(close, mu, 1.0), c)
    lam = modes.lam[s]
    c[s, np.arange(s.size)] = 0.0
    eigenvalue = (c**2 * (1 - (lam + shift) * mu)).sum(axis=0)
    shape = np.sqrt((c**2 * np.maximum(mu, 0.0)).sum(axis=0))
    return _Judged(np.maximum(eigenvalue, 0.0), shape, lam, modes.Phi[:, s])
