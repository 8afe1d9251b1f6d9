r"""Errors of the modes of a reduced model, from their residuals in the full one.

The basis is extended by :math:`A^{-1} r` for the residuals r of all models that are asked for, see
`modefront.models.reduced.corrections`. The reduced problem in that space has the modes
:math:`\varphi_j` and eigenvalues :math:`\lambda_j`. A mode x with the Rayleigh quotient
:math:`\lambda`, of the basis alone, is made up of these by

.. math:: c_j = \varphi_j^T M x = \frac{\varphi_j^T r}{\lambda_j - \lambda}, \qquad
    \varepsilon = \lambda - \lambda_s = \sum_{j \ne s} c_j^2 \, (\lambda_j - \lambda_s) ,

without cancellation, s being the mode that x stands for; the error of its shape is the root of the
sum of the other :math:`c_j^2`. Both grow towards the errors in the full model as the space does.
How much of them is found has to be known from elsewhere. Let m eigenvalues of the full model, and
no more, be below :math:`\sigma`, see `modefront.models.reduced.completeness`, and let
:math:`\rho_k` and R be the lowest m Ritz values and residuals in any space.

**With the factor of another model**, :math:`g A \le K + s M \le b A`. What is outside the m Ritz
vectors has Rayleigh quotients above :math:`\sigma` (Schur), so that at most as many eigenvalues are
below :math:`\ell < \sigma` as

.. math:: \mathrm{diag}(\rho_k - \ell)
    - \frac{D R^T A^{-1} R D}{g\,(1 - (\ell + s) / (\sigma + s))}, \qquad
    D_{kk} = \frac{\ell + s}{\rho_k + s}

has negative ones. And to leading order n extensions find all but :math:`1 / T_n(x)^2` of
:math:`\varepsilon`, T being Chebyshev's polynomial, :math:`x = (\kappa + 1) / (\kappa - 1)` and
:math:`\kappa = b / (g (1 - (\lambda + s) / (\sigma + s)))` (conjugate gradients; n = 1 is
Kantorovich's :math:`4 \kappa / (1 + \kappa)^2`). One of the two shows when a third is found, and
extensions go on until then.

**With the factor of** :math:`B = K - \sigma M` **itself**, taken where the first way does not lead
there, the space is that of the Ritz vectors and of :math:`B^{-1} r`, and the matrix is

.. math:: \mathrm{diag}\Big(\frac{\rho_k - \sigma}{\ell - \sigma} (\rho_k - \ell)\Big)
    - R^T B^{-1} R

(Lehmann's bounds). Where that does not show it either, the estimate is infinite.

Sources: Lehmann 1949, doi:10.1002/zamm.19490290507 and Parlett 1998,
doi:10.1137/1.9781611971163, section 10.5 (bounds from residuals).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import scipy.sparse

from modefront._typing import Bools, Floats, Ints
from modefront.errors import ModelError
from modefront.linalg.pencil import Pencil
from modefront.linalg.products import combine, gram, times
from modefront.models.reduced.basis import Basis, residuals
from modefront.models.reduced.corrections import Factor
from modefront.modes import dense
from modefront.modes.derivatives import Shifted
from modefront.modes.sparse import orthonormal
from modefront.modes.tridiagonal import LowestModes

FOUND = 1 / 3
"""Share of the error that an estimate has to have found."""

SHARES = 0.9999, 0.99, 0.8, FOUND
"""Shares of the error that are tested, one after the other, for having been found."""

MISSED = 0.99
"""Share of the error of a mode next to those in question that is left, where none is known."""

TOO_SMALL = 1e-8
"""Error of a shape that is rounding, and needs no proof."""

STEPS = 8
"""Extensions with the factor of another model at most."""

OWN_STEPS = 6
"""Extensions with the factor of the model itself at most."""

SHARE = 1e-3
"""Share of the energies of residuals that compressing them may lose."""

CLOSE = 1e-8
"""Relative gap of eigenvalues below which no quotient is formed with it."""

LARGE = 0.05
"""Relative error of an eigenvalue above which nothing is concluded from leading orders."""

NOTHING = 1e-15
"""Relative error of an eigenvalue that is rounding, and needs no proof."""

ROUNDING = 100.0
"""Error of a projection over the rounding of the full matrices above which it is an error."""


@dataclass(frozen=True)
class Certificate:
    """Estimated errors of modes, and the lowest modes as they are known better.

    Attributes
    ----------
    eigenvalue : (modes,) relative errors of the eigenvalues; infinite where a mode is missing, or
        where it is not known how much of the error was found
    shape : (modes,) errors of the mode shapes in the norm of M, over their length
    lam, phi : (lowest modes,), (sensors, lowest modes) eigenvalues and mass-normalised shapes of
        all modes that were looked at, much nearer to those of the full model; none where the
        errors are infinite
    """

    eigenvalue: Floats
    shape: Floats
    lam: Floats = field(default_factory=lambda: np.zeros(0))
    phi: Floats = field(default_factory=lambda: np.zeros((0, 0)))

    @property
    def known(self) -> bool:
        """Whether the errors are finite."""
        return bool(np.isfinite(self.eigenvalue).all())


def missing(modes: int) -> Certificate:
    """Return the certificate of as many modes, below which others are missing."""
    return Certificate(np.full(modes, np.inf), np.ones(modes))


@dataclass(frozen=True, eq=False)
class CertificateRequest:
    """Modes of one model whose errors are requested.

    Attributes
    ----------
    theta : (p,) parameters of the model
    modes : (modes,) the modes in question, counted from 0
    lam, Y : (lowest,), (n, lowest) the lowest modes in the basis, mass-normalised
    below : how many of them are below ``sigma``; of the full model there are as many
    sigma : a level above the modes in question
    bounds : g and b, between which K + s M is over that of the factor
    proved : whether ``below`` is proved; else the next mode has to be found above ``sigma``
    small : error of a shape, if it is proved to be no greater, of which no share has to be found
    """

    theta: Floats
    modes: Ints
    lam: Floats
    Y: Floats
    below: int
    sigma: float
    bounds: tuple[float, float] = (0.0, np.inf)
    proved: bool = True
    small: float = 0.0


@dataclass(frozen=True, eq=False)
class _ErrorEstimate:
    """Errors as a space knows them, of eigenvalues and shapes; and the modes of that space."""

    eigenvalue: Floats
    shape: Floats
    lam: Floats
    Y: Floats


@dataclass(frozen=True, eq=False)
class _Solutions:
    """Solutions Z (N, m) for the residuals R (N, m) of modes X (N, m); ``parts`` are of a model."""

    X: Floats
    R: Floats
    Z: Floats
    parts: list[slice]


def estimates(
    pencil: Pencil,
    sensors: scipy.sparse.csr_array,
    basis: Basis,
    factor: Factor,
    requests: Sequence[CertificateRequest],
) -> list[Certificate | None]:
    """Return the certificates of some models, with the factor of another one.

    They are None where a factor of their own is needed. Errors of eigenvalues are over lam + s.
    """
    shift, space = factor.below.sigma, basis
    zeros = [np.zeros(request.lam.shape) for request in requests]
    errors = [
        _ErrorEstimate(z, z, request.lam, request.Y)
        for request, z in zip(requests, zeros, strict=True)
    ]
    out: list[Certificate | None] = [None] * len(requests)
    rounding = list(zip(zeros, zeros, strict=True))
    pending = [k for k, request in enumerate(requests) if _steps(request, shift) <= STEPS]
    for step in range(1, STEPS + 1):
        if not pending:
            break
        models = [(requests[k].theta, errors[k]) for k in pending]
        solved = _solutions(pencil, space, factor, models)
        energies = [gram(solved.R[:, part], solved.Z[:, part]) for part in solved.parts]
        if step == 1:
            for k, part in zip(pending, solved.parts, strict=True):
                of, X = requests[k], solved.X[:, part]
                forms = gram(X, solved.R[:, part])
                rounding[k] = _rounding(pencil.K.diagonal(of.theta), X, forms, of.lam)
        space = _with_solutions(pencil, space, factor, solved)
        seen = np.hstack([sensors @ block for block in space.blocks])
        unsettled = []
        for k, energy in zip(pending, energies, strict=True):
            of = requests[k]
            proof = _Proof(of, shift, errors[k].eigenvalue, energy, step)
            try:
                K, M = space.K.at(of.theta), space.M.at(of.theta)
                errors[k] = _judged(K, M, basis.columns, of.lam, of.Y)
            except ModelError:
                continue
            if not proof.is_leading(errors[k].eigenvalue):
                continue
            if proof.holds(errors[k]):
                out[k] = _certificate(proof, errors[k], seen, rounding[k])
            else:
                unsettled.append(k)
        pending = unsettled
    return out


def own_estimate(
    pencil: Pencil,
    sensors: scipy.sparse.csr_array,
    basis: Basis,
    requested: CertificateRequest,
    shifted: Shifted,
) -> Certificate:
    """Return the certificate of a model with its own factor of K - sigma M, sigma being the level.

    Errors of eigenvalues are over lam + s, and contain the rounding of the basis where that is
    greater than the one of the model.
    """
    m, shift = requested.below, basis.sigma
    K, M = pencil.K.at(requested.theta), pencil.M.at(requested.theta)
    X = basis.combine(requested.Y[:, :m])
    try:
        inner, mass = gram(X, times(K, X)), gram(X, times(M, X))
        start = dense.decompose(inner, mass)
        if start.lam.size < m:
            return missing(requested.modes.size)
        lam = requested.lam[:m]
        rounding = _rounding(K.diagonal(), X, inner - mass * lam, lam)
        unit = np.sqrt(start.lam - shift)
        of = replace(requested, lam=start.lam, Y=np.diag(unit))
        S, n = combine(X, start.Phi / unit), m
        errors = _ErrorEstimate(np.zeros(m), np.zeros(m), of.lam, of.Y)
        for step in range(1, OWN_STEPS + 1):
            X = combine(S, errors.Y)
            R = times(K, X) - times(M, X) * errors.lam
            Z = shifted.factor.solve(R)
            proof = _Proof(of, shift, errors.eigenvalue, gram(R, Z), step, shifted.sigma)
            S = np.hstack([S, orthonormal(K, M, shift, S, Z)])
            inner, mass = gram(S, times(K, S)), gram(S, times(M, S))
            Y = np.vstack([of.Y, np.zeros((S.shape[1] - n, m))])[:n]
            errors = _judged(inner, mass, n, of.lam, Y)
            if proof.holds(errors):
                return _certificate(proof, errors, sensors @ S, rounding)
    except ModelError:
        pass
    return missing(requested.modes.size)


@dataclass(frozen=True, eq=False)
class _Proof:
    """Evidence for the share of the errors of the lowest modes that a space has found.

    Attributes
    ----------
    of : the modes
    shift : -s
    known : (lowest,) their errors as the space before the last extension knew them
    energy : R^T Z (lowest, lowest) of the residuals in that space
    step : number of extensions
    exact_shift : the shift of the factor, if it is that of the model itself
    """

    of: CertificateRequest
    shift: float
    known: Floats
    energy: Floats
    step: int
    exact_shift: float | None = None

    def is_leading(self, error: Floats) -> bool:
        """Return whether leading orders tell, and the mode above the level belongs there."""
        of = self.of
        above = of.lam[of.below :] - error[of.below :] / FOUND
        small = error <= LARGE * (of.lam - self.shift)
        return bool(small.all() and (of.proved or (above.size and above[0] > of.sigma)))

    def holds(self, errors: _ErrorEstimate) -> bool:
        """Return whether a third of the errors of all modes in question is found.

        Errors of shapes may be small instead.
        """
        of = self.of
        iterated = (
            (1 - self._missed >= FOUND) if self.exact_shift is None else np.zeros(1, dtype=np.bool_)
        )
        eigenvalues = iterated | self._bounded(errors.eigenvalue, FOUND)
        found = np.maximum(errors.shape[: of.below], TOO_SMALL) / FOUND
        shapes = self.most(errors) <= np.maximum(found, of.small)
        return bool((eigenvalues & shapes)[of.modes].all())

    def most(self, errors: _ErrorEstimate) -> Floats:
        """Return the errors of shapes that what is left of the energy allows, (below,)."""
        of, m, tiny = self.of, self.of.below, np.finfo(float).tiny
        error = errors.eigenvalue[:m]
        left, lam = self._left(error), of.lam[:m] - error
        distance = np.abs(lam[:, None] - lam)
        np.fill_diagonal(distance, np.inf)
        close = (left[:, None] / np.maximum(distance, tiny) ** 2).sum(axis=0) * left
        outside = left / np.maximum(of.sigma - lam, tiny)
        return np.sqrt(errors.shape[:m] ** 2 + outside + close)

    def _left(self, error: Floats) -> Floats:
        """Return bounds of the errors not yet found, of modes below the level, (below,)."""
        missed = np.minimum(self._missed, MISSED) if self.exact_shift is None else MISSED
        ratio = np.full(self.of.below, missed / (1 - missed))
        for share in SHARES:
            bounded = self._bounded(error, share)
            ratio = np.where(bounded, np.minimum(ratio, 1 / share - 1), ratio)
        out: Floats = error[: self.of.below] * ratio
        return out

    @property
    def _missed(self) -> Floats:
        """Share of the errors that the extensions have not found at most, to leading order."""
        return 1 / np.cosh(self.step * _rate(self.of, self.shift)) ** 2

    def _bounded(self, error: Floats, part: float) -> Bools:
        """Return for which modes residuals show that at least a share of the error is found."""
        of, m = self.of, self.of.below
        known, energy = self.known[:m], self.energy[:m, :m]
        rho, level = of.lam[:m] - self.shift, of.sigma - self.shift
        share = error[:m] / np.maximum(rho - error[:m], np.finfo(float).tiny) / part
        allowed = rho * np.maximum(share / (1 + share), NOTHING)
        # One row, or one matrix, a mode whose eigenvalue is bounded.
        ell = (rho - allowed)[:, None]
        above = rho - rho[:, None] + allowed[:, None] - known  # rho_k - ell, without cancellation
        unit = np.ones(above.shape)
        possible = np.ones(m, dtype=np.bool_)
        if self.exact_shift is None:
            g = of.bounds[0] * (1 - ell / level)
            possible = g[:, 0] > 0
            unit = ell / (rho - known) / np.sqrt(np.where(g > 0, g, 1.0))
        else:
            above = above * (level - rho + known) / (level - ell)
        unit = unit / np.sqrt(np.maximum(np.abs(above), np.finfo(float).tiny))
        signs = np.sign(above)[:, None] * np.eye(m)
        values = np.linalg.eigvalsh(signs - energy * unit[:, :, None] * unit[:, None])
        return np.asarray(possible & ((values < 0).sum(axis=1) <= np.arange(m)))


def _rate(of: CertificateRequest, shift: float) -> Floats:
    """Return arcosh of (kappa + 1) / (kappa - 1) for each mode below the level, (below,)."""
    g, b = of.bounds
    gap = 1 - (of.lam[: of.below] - shift) / (of.sigma - shift)
    inverse = np.clip(g * gap / b, 0.0, 0.999) if np.isfinite(b) else np.zeros(of.below)
    return np.arccosh((1 + inverse) / (1 - inverse))


def _steps(of: CertificateRequest, shift: float) -> float:
    """Return after how many extensions enough is found of the errors, to leading order."""
    rate = float(_rate(of, shift)[of.modes].min())
    return np.arccosh(1 / np.sqrt(1 - FOUND)) / rate if rate > 0 else np.inf


def _certificate(
    proof: _Proof, errors: _ErrorEstimate, seen: Floats, rounding: tuple[Floats, Floats]
) -> Certificate:
    """Return the certificate from the errors found; ``seen`` is the space at the sensors."""
    of, m = proof.of, proof.of.below
    error, tiny = errors.eigenvalue[:m], np.finfo(float).tiny
    shape = np.minimum(np.hypot(errors.shape[:m], rounding[1][:m]), 1.0)
    error = error + rounding[0][:m]
    relative = error / np.maximum(of.lam[:m] - proof.shift - error, tiny)
    phi = seen @ errors.Y
    return Certificate(relative[of.modes], shape[of.modes], errors.lam, phi)


def _rounding(diagonal: Floats, X: Floats, forms: Floats, lam: Floats) -> tuple[Floats, Floats]:
    """Return errors of eigenvalues and shapes of the basis beyond the rounding of the full model.

    ``diagonal`` is that of K, and ``forms`` are X^T (K - lam M) X of the modes of the basis (modes,
    modes), which should vanish.
    """
    noise = np.finfo(float).eps * (diagonal @ X**2)
    forms = np.where(np.abs(forms) > ROUNDING * np.sqrt(np.outer(noise, noise)), forms, 0.0)
    eigenvalue = np.abs(np.diag(forms))
    distance = np.abs(lam[:, None] - lam)
    np.fill_diagonal(distance, np.inf)
    turned = forms / np.maximum(distance, np.finfo(float).tiny)
    return eigenvalue, np.sqrt((turned**2).sum(axis=0))


def _solutions(
    pencil: Pencil, space: Basis, factor: Factor, models: Sequence[tuple[Floats, _ErrorEstimate]]
) -> _Solutions:
    """Return the solutions for the residuals of some modes of each model."""
    counts = [request.lam.size for _, request in models]
    thetas = np.repeat([theta for theta, _ in models], counts, axis=0)
    lam = np.concatenate([request.lam for _, request in models])
    X = space.combine(np.hstack([request.Y for _, request in models]))
    R = residuals(pencil, thetas, lam, X)
    parts = [slice(end - count, end) for count, end in zip(counts, np.cumsum(counts), strict=True)]
    return _Solutions(X, R, factor.below.factor.solve(R), parts)


def _with_solutions(pencil: Pencil, space: Basis, factor: Factor, solved: _Solutions) -> Basis:
    """Return the space with the solutions, which are scaled where they are, as are residuals."""
    R, Z = solved.R, solved.Z
    energy = np.maximum(np.einsum("nc,nc->c", R, Z), 0.0)
    unit = np.divide(1.0, np.sqrt(energy), out=np.zeros_like(energy), where=energy > 0)
    R *= unit
    Z *= unit
    return factor.extend(pencil, space, Z, R, np.sqrt(SHARE))


def _judged(K: Floats, M: Floats, n: int, lam: Floats, Y: Floats) -> _ErrorEstimate:
    """Return the errors of the lowest modes of a basis, given the matrices in a space.

    The basis is the first n columns of the space, and the modes have the eigenvalues lam (modes,)
    and coordinates Y (n, modes).
    """
    modes, s = dense.lowest(K, M, lam.size), np.arange(lam.size)
    r = K[n:, :n] @ Y - M[n:, :n] @ Y * lam
    far = np.zeros((2, lam.size))
    if isinstance(modes, LowestModes):
        known = modes.lam[: modes.Phi.shape[1]]
        mu, shift, X = 1 / known[:, None], 0.0, modes.Phi / np.sqrt(known)
        right = modes.transformed(np.vstack([np.zeros((n, lam.size)), r]))
        z = modes.beyond(right[:, :, None], lam)[:, :, 0]  # all other components
        seen = (z * modes.times(z)).sum(axis=0)
        far = np.array([(z**2).sum(axis=0) - modes.lam[s] * seen, seen])
    else:
        mu, shift, X = modes.mu[:, None], modes.sigma, modes.X
    gap = 1 - (lam + shift) * mu  # (lam_j - lam) mu_j
    c = X[n:].T @ r
    close = np.abs(gap) < CLOSE
    c = np.divide(c, gap, out=np.zeros_like(c), where=~close)  # over the root of mu_j
    if close.any():
        c = np.where(close, X.T @ (M[:, :n] @ Y) / np.where(close, mu, 1.0), c)
    lam = modes.lam[s]
    c[s, s] = 0.0
    eigenvalue = (c**2 * (1 - (lam + shift) * mu)).sum(axis=0) + far[0]
    shape = np.sqrt((c**2 * np.maximum(mu, 0.0)).sum(axis=0) + far[1])
    return _ErrorEstimate(np.maximum(eigenvalue, 0.0), shape, lam, modes.Phi[:, s])
