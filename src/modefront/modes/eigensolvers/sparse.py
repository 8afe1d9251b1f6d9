"""The lowest modes by block Lanczos iteration with sparse factors (`modefront.modes.sparse`)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.linalg.affine import SparseAffine
from modefront.modes import sparse
from modefront.modes.eigensolvers.base import AffineMatrices, EigensolverKind
from modefront.modes.full import FullModes, without_rounding
from modefront.modes.result import Modes

FACTOR = 40
"""Entries of the two factors of an eigensolution and of what belongs to it, over N^(4/3)."""


@dataclass(frozen=True, eq=False)
class SparseEigensolver:
    """Solves eigenproblems of sparse matrices; their pattern is analysed with the first one.

    Attributes
    ----------
    model : its pencil is that of the eigenproblems
    """

    model: AffineMatrices

    @property
    def footprint(self) -> float:
        """Bytes that an eigensolution takes, estimated; factors of solids fill in the most."""
        return 8.0 * FACTOR * self.model.stiffness.size ** (4 / 3)

    def modes(self, theta: Floats, count: int, *, derivatives: bool) -> Modes:
        """Return the ``count`` lowest modes; see `modefront.modes.eigensolvers.Eigensolver`.

        Raises ModelError too where K and M are singular together, and where it cannot be proved
        that no mode was missed.
        """
        return sparse.modes(self.model.pencil, self.model.selection, theta, count, derivatives)

    def full_modes(self, theta: Floats, count: int, loads: Floats) -> FullModes:
        """Return the ``count`` lowest modes; raises ModelError as `modes`."""
        pencil = self.model.pencil
        spectrum = sparse.lowest(pencil, theta, count)
        lam = without_rounding(spectrum.lam, spectrum.Phi, pencil.K.at(theta).diagonal())
        below = spectrum.factors[0]
        regular = below.sigma == 0 and lam[0] > 0
        static = None
        if regular:  # the factors take one right-hand side at least
            static = below.factor.solve(np.ascontiguousarray(loads)) if loads.size else loads
        return FullModes(lam[:count], spectrum.Phi[:, :count], static)

    def is_singular(self, theta: Floats) -> bool:
        """Return whether K(theta) is singular to working precision."""
        return sparse.is_singular(self.model.pencil, theta)


def _takes(model: AffineMatrices) -> bool:
    return isinstance(model.stiffness, SparseAffine) and isinstance(model.mass, SparseAffine)


SPARSE_SOLVER = EigensolverKind("sparse", _takes, SparseEigensolver)
