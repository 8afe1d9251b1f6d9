"""Interface of eigensolvers: modes of affine matrices K(theta), M(theta) at any theta."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import scipy.sparse

from modefront._typing import Floats
from modefront.linalg.affine import DenseAffine, SparseAffine
from modefront.linalg.pencil import Pencil
from modefront.modes.full import FullModes
from modefront.modes.result import Modes


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


class Eigensolver(Protocol):
    """Solves the eigenproblems of one model."""

    @property
    def footprint(self) -> float:
        """Bytes that an eigensolution takes, estimated."""
        ...

    def modes(self, theta: Floats, count: int, *, derivatives: bool) -> Modes:
        """Return the ``count`` lowest modes at the sensors, shape (sensors, count), ascending.

        Raises ModelError where K or M is indefinite, or where there are fewer modes with a finite
        frequency than asked for.
        """
        ...

    def full_modes(self, theta: Floats, count: int, loads: Floats) -> FullModes:
        """Return the ``count`` lowest modes and the static response to loads (N, loads).

        Raises ModelError as `modes`.
        """
        ...

    def is_singular(self, theta: Floats) -> bool:
        """Return whether K(theta) is singular to working precision."""
        ...


@dataclass(frozen=True)
class EigensolverKind:
    """A member of the family.

    Attributes
    ----------
    name : of the solver
    takes : whether it solves the eigenproblems of a model, by the storage and size of its matrices
    make : returns the solver of a model
    """

    name: str
    takes: Callable[[AffineMatrices], bool]
    make: Callable[[AffineMatrices], Eigensolver]
