"""The pay-off matrix: the simplex between the edges, in units of the range of each objective."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.solvers.dominance import nondominated
from modefront.solvers.scalarisation import Linear, boundary
from modefront.solvers.sqp import Solution

POINT = 1e-10
"""Range of an objective over the edges, over its typical size, below which it is no range."""

FLAT = 1e-2
"""Least singular value of Phi, over the greatest one, below which the simplex is flat."""


@dataclass(frozen=True)
class Payoff:
    """Utopia point, range of the objectives and the scaled pay-off matrix, one column an edge."""

    utopia: Floats
    scale: Floats
    Phi: Floats

    def place(self, J: Floats) -> Floats:
        """Return the coordinates (n,) of the point of the plane that is projected onto J."""
        gamma = np.linalg.solve(self.Phi, (J - self.utopia) / self.scale)
        return gamma - (gamma.sum() - 1) / gamma.size

    def subproblem(self, beta: Floats) -> Linear:
        """Return the programme of one point of the simplex."""
        return boundary(self.Phi @ beta, -self.Phi.sum(axis=1), self.utopia, self.scale)


def payoff(
    edges: Sequence[Solution], sizes: Floats, minima: Sequence[Solution] = ()
) -> Payoff | None:
    """Return the pay-off of the edges; None where an objective does not vary over them.

    ``sizes`` are typical sizes of the objectives. Where nothing varies, one model is the best in
    everything and the front is one point.

    Of three and more objectives, one model may be best in several, and the simplex between the
    edges then is flat. Its place takes the simplex between the points that are worst in one
    objective and best in all others, with the ranges over all ``minima``, which need not be
    attained.
    """
    J = np.array([edge.at.J for edge in edges]).T
    utopia = np.diag(J).copy()
    scale = np.asarray((J - utopia[:, None]).max(axis=1))
    n = len(edges)
    if n > 2 and not _solid((J - utopia[:, None]) / np.maximum(scale, POINT * sizes)[:, None]):
        known = np.array([*J.T, *(one.at.J for one in minima)])
        scale = (known[nondominated(known)] - utopia).max(axis=0)
        J = utopia[:, None] + np.diag(scale)
    if (scale <= POINT * sizes).any():
        return None
    return Payoff(utopia, scale, (J - utopia[:, None]) / scale[:, None])


def _solid(Phi: Floats) -> bool:
    """Return whether a simplex has a volume, compared with the lengths of its edges."""
    sigma = np.linalg.svd(Phi, compute_uv=False)
    return bool(sigma[-1] > FLAT * sigma[0])
