r"""Eigensolvers of affine matrices K(theta), M(theta): dense or sparse, as the matrices are.

What the lowest modes leave out of a response is small but for its static part, and

.. math:: K u_s = f

has all of it, that of massless degrees of freedom too. Where K is singular (rigid-body modes)
there is none. An eigenvalue below the rounding that

.. math:: \varphi^T \operatorname{diag}(K)\, \varphi

leaves in it is that of a rigid-body mode, and is zero.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
import scipy.linalg
import scipy.sparse

from modefront._typing import Floats
from modefront.errors import ModelError
from modefront.linalg.affine import DenseAffine, SparseAffine
from modefront.linalg.factorisation import Pencil
from modefront.modes import dense, sparse
from modefront.modes.result import Modes

ARRAYS = 8
"""Matrices N x N that a dense solution holds: K, M, their factors, the modes and workspace."""

FACTOR = 40
"""Entries of the two factors of a sparse solution and of what belongs to it, over N^(4/3)."""


class AffineMatrices(Protocol):
    """A model as eigensolvers see it."""

    @property
    def stiffness(self) -> DenseAffine | SparseAffine:
        """K(theta), N x N."""
        ...

    @property
    def mass(self) -> DenseAffine | SparseAffine:
        """M(theta), N x N."""
        ...

    @property
    def selection(self) -> scipy.sparse.csr_array:
        """Weights (sensors, N) of the degrees of freedom at each sensor."""
        ...

    @property
    def pencil(self) -> Pencil:
        """The sparse pencil with its analysis; raises TypeError for dense matrices."""
        ...


@dataclass(frozen=True)
class FullModes:
    """The lowest modes of a model at one theta, and its static response.

    Attributes
    ----------
    lam : (modes,) eigenvalues omega**2 in (rad/s)**2, ascending; 0 for rigid-body modes
    Phi : (N, modes) mass-normalised modes; the sign is arbitrary
    static : (N, loads) displacement under each load; None with rigid-body modes
    """

    lam: Floats
    Phi: Floats
    static: Floats | None


@dataclass(frozen=True, eq=False)
class Eigensolver:
    """Solves the eigenproblems of one model, by dense or sparse matrices, as its own are.

    The pattern of sparse ones is analysed with the first eigenproblem.

    Attributes
    ----------
    model : its matrices
    """

    model: AffineMatrices

    @cached_property
    def _dense(self) -> tuple[DenseAffine, DenseAffine, Floats] | None:
        """Dense matrices, and weights (sensors, N) of the degrees of freedom at each sensor."""
        K, M = self.model.stiffness, self.model.mass
        if isinstance(K, DenseAffine) and isinstance(M, DenseAffine):
            return K, M, self.model.selection.toarray()
        return None

    @property
    def footprint(self) -> float:
        """Bytes that an eigensolution takes, estimated; factors of solids fill in the most."""
        N = self.model.stiffness.size
        return 8.0 * (ARRAYS * N**2 if self._dense else FACTOR * N ** (4 / 3))

    def modes(self, theta: Floats, count: int, *, derivatives: bool) -> Modes:
        """Return the ``count`` lowest modes at the sensors, shape (sensors, count), ascending.

        Raises ModelError where K or M is indefinite, where there are fewer modes with a finite
        frequency than asked for, and, of sparse matrices, where K and M are singular together or
        where it cannot be proved that no mode was missed.
        """
        if self._dense:
            return dense.modes(*self._dense, theta, count, derivatives)
        return sparse.modes(self.model.pencil, self.model.selection, theta, count, derivatives)

    def full_modes(self, theta: Floats, count: int, loads: Floats) -> FullModes:
        """Return the ``count`` lowest modes and the static response to loads (N, loads).

        Raises ModelError as `modes`.
        """
        K = self.model.stiffness.at(theta)
        if self._dense:
            decomposition = dense.decompose(K, self.model.mass.at(theta), count)
            lam, Phi = decomposition.lam, decomposition.Phi
            dense.refuse_fewer(lam.size, count)
            below = None
        else:
            spectrum = sparse.lowest(self.model.pencil, theta, count)
            lam, Phi, below = spectrum.lam, spectrum.Phi, spectrum.factors[0]
        lam = np.where(lam < sparse.SINGULAR * (K.diagonal() @ Phi**2), 0.0, lam)
        static = None
        if below is not None:
            if below.sigma == 0 and lam[0] > 0:  # factors take one right-hand side at least
                static = below.factor.solve(np.ascontiguousarray(loads)) if loads.size else loads
        elif lam[0] > 0:
            try:
                static = scipy.linalg.cho_solve(scipy.linalg.cho_factor(K), loads)
            except np.linalg.LinAlgError:
                text = "the stiffness matrix is singular to working precision"
                raise ModelError(text) from None
        return FullModes(lam[:count], Phi[:, :count], static)

    def is_singular(self, theta: Floats) -> bool:
        """Return whether K(theta) is singular to working precision."""
        if self._dense:
            return dense.is_singular(self._dense[0].at(theta))
        return sparse.is_singular(self.model.pencil, theta)


def eigensolver(model: AffineMatrices) -> Eigensolver:
    """Return the eigensolver of a model; raises TypeError where none takes its matrices."""
    if isinstance(model.stiffness, DenseAffine) != isinstance(model.mass, DenseAffine):
        raise TypeError("stiffness and mass have to be both dense or both sparse")
    return Eigensolver(model)
