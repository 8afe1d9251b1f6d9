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
from typing import Protocol, TypeAlias

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


def without_rounding(lam: Floats, Phi: Floats, diagonal: Floats) -> Floats:
    """Return the eigenvalues, with those that are nothing but rounding set to zero."""
    out: Floats = np.where(lam < sparse.SINGULAR * (diagonal @ Phi**2), 0.0, lam)
    return out


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
        """Return the ``count`` lowest modes at the sensors, shape (sensors, count), ascending.

        Raises ModelError where K or M is indefinite, or where there are fewer modes with a finite
        frequency than asked for.
        """
        return dense.modes(self.K, self.M, self.selection, theta, count, derivatives)

    def full_modes(self, theta: Floats, count: int, loads: Floats) -> FullModes:
        """Return the ``count`` lowest modes and the static response to loads (N, loads).

        Raises ModelError as `modes`.
        """
        Kt = self.K.at(theta)
        decomposition = dense.decompose(Kt, self.M.at(theta), count)
        lam, Phi = decomposition.lam, decomposition.Phi
        dense.refuse_fewer(lam.size, count)
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
        """Return the ``count`` lowest modes at the sensors, as `DenseEigensolver.modes`.

        Raises ModelError too where K and M are singular together, and where it cannot be proved
        that no mode was missed.
        """
        return sparse.modes(self.model.pencil, self.model.selection, theta, count, derivatives)

    def full_modes(self, theta: Floats, count: int, loads: Floats) -> FullModes:
        """Return the ``count`` lowest modes, as `DenseEigensolver.full_modes`."""
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


Eigensolver: TypeAlias = DenseEigensolver | SparseEigensolver
"""Solves the eigenproblems of one model."""


def eigensolver(model: AffineMatrices) -> Eigensolver:
    """Return the eigensolver of a model; raises TypeError where none takes its matrices."""
    K, M = model.stiffness, model.mass
    if isinstance(K, DenseAffine) and isinstance(M, DenseAffine):
        return DenseEigensolver(K, M, model.selection.toarray())
    if isinstance(K, SparseAffine) and isinstance(M, SparseAffine):
        return SparseEigensolver(model)
    raise TypeError("stiffness and mass have to be both dense or both sparse")
