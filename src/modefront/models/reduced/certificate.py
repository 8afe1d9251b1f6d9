r"""Errors of the modes of a reduced model, proved in the full one with one factor.

``docs/reduced.md`` has the bounds, whose symbols are used here, with :math:`X^T M X = I`. For
:math:`\mathrm{diag}(\rho) - P = Y \,\mathrm{diag}(\ell)\, Y^T`, one step of inverse iteration makes
better modes of X,

.. math:: \tilde X = -B^{-1} M X S\,(I + S^{-1} P)\, Y = (X - B^{-1} R)(I + S^{-1} P)\, Y ,

and what they differ from X is the error of the shapes. Of what the mode has of a mode j above the
level, both errors are too much by :math:`(\lambda_j - \lambda_i) / (\lambda_j - \sigma)`.

Sources: Lehmann 1949, doi:10.1002/zamm.19490290507 and Parlett 1998,
doi:10.1137/1.9781611971163, section 10.5 (bounds from residuals).
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from modefront._typing import Floats, Ints
from modefront.errors import ModelError
from modefront.linalg.factorisation import Pencil, SingularMatrixError
from modefront.linalg.products import combine, gram, times
from modefront.models.matrices import MatrixModel
from modefront.models.reduced.basis import Basis
from modefront.modes.derivatives import Shifted
from modefront.work.costs import Costs, spend
from modefront.work.transfer import shared

LATER = 4
"""Gaps above the last mode in question among which the widest is taken."""


@dataclass(frozen=True)
class Certificate:
    """Bounds of the errors of modes, and the lowest modes as they are known better.

    Attributes
    ----------
    eigenvalue : (modes,) relative errors of the eigenvalues at most; infinite where a mode is
        missing, or nothing is proved
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


@shared
@dataclass(frozen=True, eq=False)
class Certifier:
    """Judges the modes of a basis in the full model.

    Attributes
    ----------
    full : the model with sparse matrices
    basis : with the model in it
    """

    full: MatrixModel
    basis: Basis

    @property
    def footprint(self) -> float:
        """Bytes that the basis takes, and an eigensolution of the full model."""
        return self.full.footprint + sum(block.nbytes for block in self.basis.blocks)

    @property
    def parts(self) -> tuple[MatrixModel]:
        """The full model, which is sent to other processes on its own."""
        return (self.full,)

    def certify(
        self, requests: Sequence[tuple[Floats, Ints]], lowest: int = 0
    ) -> list[Certificate]:
        """Return bounds of the errors of modes at some parameters; see `Certificate`.

        ``requests`` are theta (p,) and the modes in question, counted from 0. Their errors are
        infinite where one of the ``lowest`` modes, or a mode below the requested ones, is missing.
        Each takes a factorisation.
        """
        started = time.perf_counter()
        certificates = []
        for theta, modes in requests:
            known = self._bounds(theta, max(lowest, int(modes.max()) + 1))
            error, shape = np.full(modes.size, np.inf), np.ones(modes.size)
            if known is None:
                certificates.append(Certificate(error, shape))
            else:
                eigenvalue, shape = known.eigenvalue[modes], known.shape[modes]
                certificates.append(Certificate(eigenvalue, shape, known.lam, known.phi))
        spend(Costs(certificates=len(requests), certificate_time=time.perf_counter() - started))
        return certificates

    def _bounds(self, theta: Floats, count: int) -> Certificate | None:
        """Return the errors of the ``count`` lowest modes or more; None where nothing is known."""
        basis, pencil = self.basis, self.full.pencil
        try:
            ritz = basis.lowest(theta, count + LATER)
        except ModelError:
            return None
        above = level(pencil, theta, ritz.lam, count, basis.sigma)
        if above is None:
            return None
        m = int(np.searchsorted(ritz.lam, above.sigma))
        rho, X = ritz.lam[:m], basis.combine(ritz.Phi[:, :m])
        K, M = pencil.K.at(theta), pencil.M.at(theta)
        R = times(K, X) - times(M, X) * rho
        Z = above.factor.solve(R)
        room = above.sigma - rho  # the diagonal of S
        E, unit = gram(R, Z), np.sqrt(np.outer(room, room))
        values, U = np.linalg.eigh((E + E.T) / 2 / unit)
        if values[-1] >= 1:  # E < S does not hold
            return None
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
        phi = self.full.selection @ better / np.sqrt(square)
        return Certificate(relative, np.minimum(shape, 1.0), ell, phi)


def level(pencil: Pencil, theta: Floats, lam: Floats, count: int, shift: float) -> Shifted | None:
    """Return a level above the lowest ``count`` Ritz values below which no mode is missing.

    With it comes the factor that proves it. It is in the first wide gap of the Ritz values
    ``lam`` above these, or in the widest of the next ones; gaps are relative to lam - ``shift``.
    None where a mode is missing, or there is no gap.
    """
    gaps = np.diff(lam[count - 1 : count + LATER]) / (lam[count : count + LATER] - shift)
    if not gaps.size or gaps.max() <= 1e-6:
        return None
    wide = gaps > 0.2
    k = count + int(np.argmax(wide) if wide.any() else np.argmax(gaps))
    # A low level is the sharper one for the modes below it, and Ritz values above are less exact.
    sigma = float(lam[k - 1] + 0.25 * (lam[k] - lam[k - 1]))
    try:
        factor = pencil.factor(pencil.K.at(theta).data, pencil.M.at(theta).data, sigma)
    except SingularMatrixError:
        return None
    return Shifted(sigma, factor) if factor.negative == k else None
