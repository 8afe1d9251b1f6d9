r"""How wrong the modes of a reduced model are, from their residuals in the full one.

A mode that lacks :math:`\delta`, see `modefront.models.reduced.corrections`, has an eigenvalue that
is too high by

.. math:: \epsilon = -r^T \delta = r^T C^+ r

to leading order, and each Ritz mode j near r is mixed in as well, by
:math:`r_j^T \delta / (\lambda - \lambda_j)`. The first term of the sum for :math:`\epsilon` is at
least :math:`4 \kappa / (1 + \kappa)^2` of the whole (Kantorovich), with :math:`\kappa` the
condition of :math:`A^{-1} C`; others follow until they are small.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats, Ints
from modefront.models.reduced.corrections import Corrections, Enough, Pairs, solve
from modefront.modes.products import gram, times
from modefront.modes.spectrum import Shifted

SETTLED = Enough(share=1 / 3)
"""When an estimate is within a factor of 2."""

FIRST = Enough(share=1.0)
"""The first term only."""

NEAR = 5.8
"""Condition of K over that of the factor up to which the first term is half of the whole."""


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
class Asked:
    """What is to be judged: some of the pairs of a model, counted from 0, and how exactly."""

    pairs: Pairs
    wanted: Ints
    enough: Enough


def estimates(models: Sequence[Asked], below: Shifted) -> list[Certificate]:
    """Return the certificates of some models.

    ``below`` is the factor of a positive definite K + s M at any parameters. Errors of eigenvalues
    are over lam + s.
    """
    rests = [one.pairs.residuals() for one in models]
    found = [
        Corrections(one.pairs, rest[:, one.wanted], one.pairs.lam[one.wanted], one.enough)
        for one, rest in zip(models, rests, strict=True)
    ]
    solve(found, below)
    return [_certificate(one, rest, below.sigma) for one, rest in zip(found, rests, strict=True)]


def _certificate(found: Corrections, rest: Floats, sigma: float) -> Certificate:
    gap = found.of.lam[:, None] - found.shift
    mixed = np.divide(gram(rest, found.delta), gap, out=np.zeros_like(gap), where=gap != 0)
    square = np.einsum("nc,nc->c", found.delta, times(found.of.M, found.delta))
    shape = np.sqrt(np.maximum(square, 0.0) + (mixed**2).sum(axis=0))
    relative = (found.total + found.left) / (found.shift - sigma)
    return Certificate(
        np.where(found.lost, np.inf, relative),
        np.where(found.lost, 1.0, np.minimum(shape, 1.0)),
    )
