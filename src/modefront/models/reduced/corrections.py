r"""What modes and their derivatives lack in a basis, with the factor of another model.

For a Ritz pair :math:`(\lambda, \varphi)`, :math:`\varphi^T M \varphi = 1`, the part
:math:`\delta` that the mode lacks solves, to leading order (Jacobi's correction),

.. math:: C \delta = -r, \qquad r = C \varphi, \qquad C = K - \lambda M

on the M-complement of the low Ritz modes, where C is positive definite unless a mode is missing
there. What a derivative :math:`\varphi'` of the reduced problem lacks solves the same equation with

.. math:: r = C \varphi' + (K' - \lambda M' - \lambda' M) \varphi .

With the factor of an earlier :math:`A = K + s M`, conjugate gradients find :math:`\delta`, and sum
up :math:`-r^T \delta` from below, one solution a term:

.. math:: -r^T \delta = \sum_k t_k, \qquad t_k = \alpha_k \, r_k^T z_k, \qquad z_k = A^{-1} r_k .

What is left is taken for a geometric series with the ratio q of the last terms,
:math:`t_k q / (1 - q)`. Several models share every solution: the factor is read once for all.

Sources: Sleijpen & Van der Vorst 1996, doi:10.1137/S0895479894270427 (correction); Golub & Meurant
2010, doi:10.1515/9781400833887 (quadratic forms by conjugate gradients).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse

from modefront._typing import Floats
from modefront.modes.pencil import Pencil
from modefront.modes.products import combine, gram, times
from modefront.modes.spectrum import Shifted

SLOWEST = 0.5
"""Ratio of terms at most that what is left is extrapolated with."""

ENTRIES = 2**21
"""Entries of the right-hand sides that are solved together, but for `FEWEST` columns."""

FEWEST = 24
"""Right-hand sides that are solved together however large the model is, if there are as many."""


@dataclass(frozen=True, eq=False)
class Pairs:
    """Low Ritz pairs of one model.

    Attributes
    ----------
    K, M : the sparse matrices of the model
    lam : (low,) Ritz values, ascending from the lowest one
    Phi, MPhi : (N, low) their modes, and M times these
    """

    K: scipy.sparse.csr_array
    M: scipy.sparse.csr_array
    lam: Floats
    Phi: Floats
    MPhi: Floats

    def residuals(self) -> Floats:
        """Return (K - lam M) Phi, shape (N, low)."""
        return times(self.K, self.Phi) - self.MPhi * self.lam


def pairs(pencil: Pencil, theta: Floats, lam: Floats, Phi: Floats) -> Pairs:
    """Return Ritz values (low,) and modes (N, low) with the matrices at ``theta``."""
    K, M = pencil.K.at(theta), pencil.M.at(theta)
    return Pairs(K, M, lam, Phi, times(M, Phi))


@dataclass(frozen=True, eq=False)
class Enough:
    """When a sum needs no other term: after ``steps``, or where a term is small.

    Attributes
    ----------
    share : the term over the sum
    floor : the term itself, for every column or for each
    steps : terms at most
    """

    share: float
    floor: Floats | float = 0.0
    steps: int = 8


class Corrections:
    """Conjugate gradients for some residuals r (N, columns) of one model.

    Attributes
    ----------
    shift : (columns,) the eigenvalue in C
    delta : (N, columns) what is lacking, as far as it is known
    total, left : (columns,) the sum, and what is left of it
    settled : (columns,) where no other term is needed
    lost : (columns,) where C is not positive definite
    active : (active,) columns that need another term
    r : (N, active) their residuals
    """

    def __init__(self, of: Pairs, r: Floats, shift: Floats, enough: Enough) -> None:
        self.of, self.shift, self.enough = of, shift, enough
        self.r = r - combine(of.MPhi, gram(of.Phi, r))
        self.p, self.delta = np.zeros((0, 0)), np.zeros_like(self.r)
        columns = shift.size
        self.total, self.left, self.term = np.zeros(columns), np.zeros(columns), np.zeros(columns)
        self.floor = np.broadcast_to(enough.floor, columns)
        self.settled, self.lost = np.zeros(columns, dtype=bool), np.zeros(columns, dtype=bool)
        self.active, self.energy, self.steps = np.arange(columns), np.ones(columns), 0

    def add(self, z: Floats) -> None:
        """Add a term for the active columns, given the solutions for their residuals."""
        of, r, active, before = self.of, self.r, self.active, self.energy
        z = z - combine(of.Phi, gram(of.MPhi, z))
        energy = np.einsum("nc,nc->c", r, z)
        p = z + self.p * (energy / before) if self.steps else z
        Cp = times(of.K, p) - times(of.M, p) * self.shift[active]
        curvature = np.einsum("nc,nc->c", p, Cp)
        self.lost[active] = curvature < 0
        alpha = np.divide(energy, curvature, out=np.zeros_like(energy), where=curvature > 0)
        term, last = alpha * energy, self.term[active]
        self.total[active] += term
        self.term[active] = term
        ratio = np.divide(term, last, out=np.zeros_like(term), where=last > 0)
        ratio = np.minimum(ratio, SLOWEST)
        self.left[active] = term * ratio / (1 - ratio)
        if active.size == self.shift.size:
            self.delta -= alpha * p
        else:
            self.delta[:, active] -= alpha * p
        self.settled[active] = term <= np.maximum(
            self.enough.share * self.total[active], self.floor[active]
        )
        self.steps += 1
        more = ~(self.settled | self.lost)[active] & (self.steps < self.enough.steps)
        self.active, self.energy = active[more], energy[more]
        if more.any():
            r = r - alpha * (Cp - combine(of.MPhi, gram(of.Phi, Cp)))
            self.r, self.p = (r, p) if more.all() else (r[:, more], p[:, more])


def solve(models: Sequence[Corrections], below: Shifted) -> None:
    """Find what is lacking in some models, by one solution with the factor a step.

    ``below`` is the factor of a positive definite K + s M at any parameters.
    """
    while unfinished := [one for one in models if one.active.size]:
        ends = np.cumsum([one.active.size for one in unfinished])
        right = np.hstack([one.r for one in unfinished])
        found = np.hsplit(below.factor.solve(right), ends[:-1])
        for one, z in zip(unfinished, found, strict=True):
            one.add(z)


def together(size: int) -> int:
    """Return how many right-hand sides are solved together."""
    return max(FEWEST, ENTRIES // size)
