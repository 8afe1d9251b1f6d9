r"""How wrong the modes of a reduced model are, from their residuals in the full one.

For a Ritz pair :math:`(\lambda, \varphi)` with :math:`\varphi^T M \varphi = 1` and the residual
:math:`r = (K - \lambda M) \varphi`, the mode lacks :math:`\delta` and the eigenvalue is too high by
:math:`\epsilon`, to leading order (Jacobi's correction),

.. math::
    C \delta = -r, \qquad \epsilon = r^T C^+ r = -r^T \delta, \qquad C = K - \lambda M

on the M-complement of the low Ritz modes, where C is positive definite unless a mode is missing
there. Each Ritz mode j near r is mixed in as well, by :math:`r_j^T \delta / (\lambda - \lambda_j)`.
Conjugate gradients with the factor of an earlier :math:`A = K + s M` give both: they sum up
:math:`\epsilon` from below, one solution with the factor a term,

.. math:: \epsilon = \sum_k t_k, \qquad t_k = \alpha_k \, r_k^T z_k, \qquad z_k = A^{-1} r_k .

The first term alone is at least :math:`4 \kappa / (1 + \kappa)^2` of the whole (Kantorovich), with
:math:`\kappa` the condition of :math:`A^{-1} C`; others follow until they are small. What is left
then is taken for a geometric series with the ratio q of the last terms, :math:`t_k q / (1 - q)`.

Several models share every solution: the factor is read once for all of them.

Sources: Sleijpen & Van der Vorst 1996, doi:10.1137/S0895479894270427 (correction); Golub & Meurant
2010, doi:10.1515/9781400833887 (quadratic forms by conjugate gradients).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats, Ints
from modefront.modes.pencil import Pencil
from modefront.modes.products import combine, gram
from modefront.modes.spectrum import Shifted

SETTLED = 1 / 3
"""Share of the sum in the last term, below which no other one is added."""

SLOWEST = 0.5
"""Ratio of terms at most that what is left is extrapolated with."""

NEAR = 3.0
"""Condition of K over that of the factor up to which the first term is enough: 3/4 of the whole."""

STEPS = 8
"""Terms at most."""


@dataclass(frozen=True)
class Certificate:
    """Estimated errors of modes.

    Attributes
    ----------
    eigenvalue : (modes,) relative errors of the eigenvalues; infinite where a mode is missing
    shape : (modes,) errors of the mode shapes in the norm of M, over their length
    """

    eigenvalue: Floats
    shape: Floats


def missing(modes: int) -> Certificate:
    """Return the certificate of as many modes, below which others are missing."""
    return Certificate(np.full(modes, np.inf), np.ones(modes))


@dataclass(frozen=True, eq=False)
class Pairs:
    """Low Ritz pairs of one model.

    Attributes
    ----------
    theta : (p,) parameters
    lam, Phi : (low,) all Ritz values up to beyond the wanted ones, ascending, and (N, low) modes
    wanted : (modes,) which of them are to be judged, counted from 0
    steps : terms at most
    """

    theta: Floats
    lam: Floats
    Phi: Floats
    wanted: Ints
    steps: int = STEPS


def estimates(pencil: Pencil, models: Sequence[Pairs], below: Shifted) -> list[Certificate]:
    """Return the certificates of some models, by one solution with the factor a step.

    ``below`` is the factor of a positive definite K + s M at any parameters. Errors of eigenvalues
    are over lam + s.
    """
    sums = [_Sum(pencil, one) for one in models]
    while unfinished := [one for one in sums if one.active.any()]:
        ends = np.cumsum([np.count_nonzero(one.active) for one in unfinished])
        right = np.hstack([one.r[:, one.active] for one in unfinished])
        found = np.hsplit(below.factor.solve(right), ends[:-1])
        for one, z in zip(unfinished, found, strict=True):
            one.add(z)
    return [one.certificate(below.sigma) for one in sums]


class _Sum:
    """Conjugate gradients for the wanted modes of one model, and what they have summed up."""

    def __init__(self, pencil: Pencil, of: Pairs) -> None:
        self.pencil, self.of = pencil, of
        K, self.M = pencil.K.at(of.theta), pencil.M.at(of.theta)
        self.MPhi = self.M @ of.Phi
        self.rest = K @ of.Phi - self.MPhi * of.lam
        self.shift = of.lam[of.wanted]
        self.r = np.ascontiguousarray(self.rest[:, of.wanted])
        self.r -= combine(self.MPhi, gram(of.Phi, self.r))
        self.delta, self.P = np.zeros_like(self.r), np.zeros_like(self.r)
        modes = of.wanted.size
        self.square = np.zeros(modes)  # delta^T M delta
        self.total, self.left, self.term = np.zeros(modes), np.zeros(modes), np.zeros(modes)
        self.energy = np.ones(modes)
        self.active, self.lost = np.ones(modes, dtype=bool), np.zeros(modes, dtype=bool)
        self.steps = 0

    def add(self, z: Floats) -> None:
        """Add a term for the active modes, given the solutions for their residuals."""
        active, Phi = self.active.copy(), self.of.Phi
        z = z - combine(Phi, gram(self.MPhi, z))
        r = self.r[:, active]
        energy = np.einsum("nc,nc->c", r, z)
        before = np.maximum(self.energy[active], np.finfo(float).tiny)
        p = z + self.P[:, active] * (energy / before if self.steps else 0.0)
        Mp = self.M @ p
        Cp = self.pencil.K.at(self.of.theta) @ p - Mp * self.shift[active]
        curvature = np.einsum("nc,nc->c", p, Cp)
        self.lost[active] |= curvature <= 0
        alpha = np.divide(energy, curvature, out=np.zeros_like(energy), where=curvature > 0)
        term, last = alpha * energy, self.term[active]
        self.total[active] += term
        ratio = np.divide(term, last, out=np.zeros_like(term), where=last > 0)
        ratio = np.minimum(ratio, SLOWEST)
        self.left[active] = term * ratio / (1 - ratio)
        step = alpha * p - 2 * self.delta[:, active]
        self.square[active] += alpha * np.einsum("nc,nc->c", step, Mp)
        self.delta[:, active] -= alpha * p
        self.r[:, active] = r - alpha * (Cp - combine(self.MPhi, gram(Phi, Cp)))
        self.P[:, active], self.energy[active], self.term[active] = p, energy, term
        self.steps += 1
        more = self.steps < self.of.steps
        self.active[active] = more & (term > SETTLED * self.total[active]) & ~self.lost[active]

    def certificate(self, sigma: float) -> Certificate:
        """Return what was found, with what is left of the sums."""
        gap = self.of.lam[:, None] - self.shift
        mixed = np.divide(gram(self.rest, self.delta), gap, out=np.zeros_like(gap), where=gap != 0)
        shape = np.sqrt(np.maximum(self.square, 0.0) + (mixed**2).sum(axis=0))
        relative = (self.total + self.left) / (self.shift - sigma)
        return Certificate(
            np.where(self.lost, np.inf, relative),
            np.where(self.lost, 1.0, np.minimum(shape, 1.0)),
        )
