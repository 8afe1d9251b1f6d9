r"""Modes and derivatives for a basis, with the factor at hand.

Between snapshots, a basis knows the modes of a model and their derivatives but for a small part.
That is found by conjugate gradients with the factor of another model, in a few steps: where the
stiffness of some parts of a structure changes by factors c, most eigenvalues of :math:`A^{-1} C`
are 1 or one of these.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.models.reduced.basis import Basis, extended
from modefront.models.reduced.corrections import (
    Corrections,
    Enough,
    pairs,
    solve,
    together,
)
from modefront.modes import dense
from modefront.modes.pencil import Pencil
from modefront.modes.products import combine, times
from modefront.modes.spectrum import Shifted

TINY = 1e-100
"""Least unit of a column."""


@dataclass(frozen=True)
class Wanted:
    """How exactly a basis is to know a model.

    Attributes
    ----------
    share : last term of a sum of conjugate gradients over the sum, see `Enough`
    shortest : length of the directions that are too short to matter, in energy
    capacity : columns that the basis may have
    steps : terms at most
    """

    share: float
    shortest: float
    capacity: int
    steps: int = 30

    def enough(self, unit: Floats) -> Enough:
        """Return when to stop, for columns that are to be multiplied by a ``unit`` each."""
        return Enough(self.share, (self.shortest / np.maximum(unit, TINY)) ** 2, self.steps)


def with_modes(
    pencil: Pencil,
    basis: Basis,
    below: Shifted,
    thetas: Sequence[Floats],
    count: int,
    spare: int,
    wanted: Wanted,
) -> Basis | None:
    """Return the basis with what the ``count`` lowest modes at some parameters lack in it.

    They are told from ``spare`` modes more. None where conjugate gradients do not get there.
    """
    width, lacking = max(1, together(pencil.size) // count), []
    for first in range(0, len(thetas), width):
        models = []
        for theta in thetas[first : first + width]:
            ritz = dense.decompose(basis.K.at(theta), basis.M.at(theta))
            low = slice(0, count + spare)
            of = pairs(pencil, theta, ritz.lam[low], combine(basis.V, ritz.Phi[:, low]))
            lam = of.lam[:count]
            enough = wanted.enough(1 / np.sqrt(lam - below.sigma))
            models.append(Corrections(of, of.residuals()[:, :count], lam, enough))
        solve(models, below)
        if not all(one.settled.all() for one in models):
            return None
        lacking += [one.delta / np.sqrt(one.shift - below.sigma) for one in models]
    return extended(pencil, basis, np.hstack(lacking), wanted.shortest, wanted.capacity)


def with_derivatives(
    pencil: Pencil,
    basis: Basis,
    below: Shifted,
    theta: Floats,
    count: int,
    spare: int,
    half_range: Floats,
    wanted: Wanted,
) -> Basis:
    """Return the basis with what the derivatives of the ``count`` lowest modes lack in it.

    The modes themselves must be in it. Derivatives are over ``half_range`` (p,), and the modes
    are told from ``spare`` more. They need not be exact to be of use.
    """
    ritz = dense.decompose(basis.K.at(theta), basis.M.at(theta))
    _, dY, _ = dense.nelson(basis.K, basis.M, theta, ritz, count)
    low, p = count + spare, theta.size
    of = pairs(pencil, theta, ritz.lam[:low], combine(basis.V, ritz.Phi[:, :low]))
    lam = np.repeat(of.lam[:count], p)
    unit = np.tile(half_range, count) / np.sqrt(lam - below.sigma)
    Phi, dY = of.Phi[:, :count], dY[:, :count].reshape(basis.columns, -1)
    dK = pencil.K.derivative_rows(theta, Phi)
    dM = pencil.M.derivative_rows(theta, Phi)
    width, lacking = together(pencil.size), []
    for first in range(0, count * p, width):
        some = slice(first, first + width)
        dPhi = combine(basis.V, np.ascontiguousarray(dY[:, some]))
        r = times(of.K, dPhi) + dK[some].toarray().T
        r -= (times(of.M, dPhi) + dM[some].toarray().T) * lam[some]
        model = Corrections(of, r, lam[some], wanted.enough(unit[some]))
        solve([model], below)
        lacking.append(model.delta * unit[some])
    return extended(pencil, basis, np.hstack(lacking), wanted.shortest, wanted.capacity)
