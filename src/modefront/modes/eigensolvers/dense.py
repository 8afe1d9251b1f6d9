"""All modes at once, by dense matrices (`modefront.modes.dense`)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from modefront._typing import Floats
from modefront.errors import ModelError
from modefront.linalg.affine import DenseAffine
from modefront.modes import dense
from modefront.modes.eigensolvers.base import AffineMatrices, EigensolverKind
from modefront.modes.full import FullModes, without_rounding
from modefront.modes.result import Modes

ARRAYS = 8
"""Matrices N x N that a solution holds: K, M, their factors, the modes and workspace."""


@dataclass(frozen=True, eq=False)
class DenseEigensolver:
    """Solves eigenproblems of dense matrices.

    Attributes
    ----------
    K, M : affine matrices, N x N
    selection : (sensors, N) weights of the degrees of freedom at each sensor
    """

    K: DenseAffine
    M: DenseAffine
    selection: Floats

    @property
    def footprint(self) -> float:
        """Bytes that an eigensolution takes, estimated."""
        return 8.0 * ARRAYS * self.K.size**2

    def modes(self, theta: Floats, count: int, *, derivatives: bool) -> Modes:
        """Return the ``count`` lowest modes; see `modefront.modes.eigensolvers.Eigensolver`."""
        return dense.modes(self.K, self.M, self.selection, theta, count, derivatives)

    def full_modes(self, theta: Floats, count: int, loads: Floats) -> FullModes:
        """Return the ``count`` lowest modes; see `modefront.modes.eigensolvers.Eigensolver`."""
        Kt = self.K.at(theta)
        decomposition = dense.decompose(Kt, self.M.at(theta), count)
        lam, Phi = decomposition.lam, decomposition.Phi
        if lam.size < count:
            raise ModelError(
                f"{count} modes asked for, but only {lam.size} have a finite frequency"
            )
        lam = without_rounding(lam, Phi, np.diag(Kt))
        static = None
        if lam[0] > 0:
            try:
                static = scipy.linalg.cho_solve(scipy.linalg.cho_factor(Kt), loads)
            except np.linalg.LinAlgError:
                text = "the stiffness matrix is singular to working precision"
                raise ModelError(text) from None
        return FullModes(lam[:count], Phi[:, :count], static)

    def is_singular(self, theta: Floats) -> bool:
        """Return whether K(theta) is singular to working precision."""
        return dense.is_singular(self.K.at(theta))


def _takes(model: AffineMatrices) -> bool:
    return isinstance(model.stiffness, DenseAffine) and isinstance(model.mass, DenseAffine)


def _make(model: AffineMatrices) -> DenseEigensolver:
    K, M = model.stiffness, model.mass
    assert isinstance(K, DenseAffine)
    assert isinstance(M, DenseAffine)
    return DenseEigensolver(K, M, model.selection.toarray())


DENSE_SOLVER = EigensolverKind("dense", _takes, _make)
