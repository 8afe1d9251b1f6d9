r"""Models given by their matrices: :math:`K(\theta) = K_0 + \sum_j \theta_j K_j`, M likewise."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np
import scipy.sparse

from modefront._typing import Floats
from modefront.models.affine import DenseAffine, Monomials, SparseAffine, sparse_affine
from modefront.models.base import Counts
from modefront.modes import dense, sparse
from modefront.modes.factorisation import Factorisation, Symbolic
from modefront.modes.pencil import Pencil, pencil
from modefront.modes.result import Modes

BASE = "base"
"""Name of the term that does not depend on the parameters."""

DENSE = 180
"""Degrees of freedom up to which dense matrices are faster."""

SensorSpec = int | Sequence[tuple[int, float]]
"""A sensor: a degree of freedom, counted from 0, or weighted degrees of freedom."""

Matrix: TypeAlias = Floats | scipy.sparse.sparray


@dataclass(frozen=True)
class _Counted:
    """An analysis that counts its factorisations."""

    symbolic: Symbolic
    counts: Counts

    def factor(self, values: Floats) -> Factorisation:
        self.counts.factorisations += 1
        return self.symbolic.factor(values)


@dataclass(frozen=True, eq=False)
class MatrixModel:
    """A model with affine stiffness and mass matrices, both dense or both sparse.

    Attributes
    ----------
    parameters : names of the parameters
    sensors : names of the sensors
    selection : (sensors, N) weights of the degrees of freedom at each sensor
    stiffness, mass : K(theta), M(theta), N x N
    counts : what the evaluations have cost so far
    """

    parameters: tuple[str, ...]
    sensors: tuple[str, ...]
    selection: scipy.sparse.csr_array
    stiffness: DenseAffine | SparseAffine
    mass: DenseAffine | SparseAffine
    counts: Counts = field(default_factory=Counts)

    @property
    def size(self) -> int:
        """Number of degrees of freedom N."""
        return self.stiffness.size

    @property
    def is_sparse(self) -> bool:
        """Whether the matrices are sparse; those of small models are dense."""
        return isinstance(self.stiffness, SparseAffine) and isinstance(self.mass, SparseAffine)

    @property
    def unused(self) -> tuple[str, ...]:
        """Names of parameters on which neither matrix depends."""
        used = self.stiffness.used | self.mass.used
        return tuple(name for name, one in zip(self.parameters, used, strict=True) if not one)

    def modes(self, theta: Floats, count: int, *, derivatives: bool = True) -> Modes:
        """Return the ``count`` lowest modes at ``theta``; see `modefront.models.base.Model`."""
        self.counts.eigenproblems += 1
        started = time.perf_counter()
        try:
            if isinstance(self.stiffness, DenseAffine) and isinstance(self.mass, DenseAffine):
                selection = self.selection.toarray()
                return dense.modes(self.stiffness, self.mass, selection, theta, count, derivatives)
            return sparse.modes(self.pencil, self.selection, theta, count, derivatives)
        finally:
            self.counts.full_time += time.perf_counter() - started

    @cached_property
    def pencil(self) -> Pencil:
        """The sparse pencil; its pattern is analysed at the first evaluation, and only then."""
        if isinstance(self.stiffness, DenseAffine) or isinstance(self.mass, DenseAffine):
            raise TypeError("stiffness and mass have to be both dense or both sparse")
        found = pencil(self.stiffness, self.mass)
        return replace(found, symbolic=_Counted(found.symbolic, self.counts))


def matrices(
    parameters: Sequence[str],
    stiffness: Mapping[str, Matrix],
    mass: Mapping[str, Matrix],
    sensors: Mapping[str, SensorSpec],
) -> MatrixModel:
    """Return the model with K(theta) = base + sum_j theta_j K_j and M(theta) likewise.

    ``stiffness`` and ``mass`` map ``"base"`` and names of parameters to symmetric matrices N x N,
    dense or sparse. Raises ValueError for a term that is no parameter.
    """
    size = next(iter(mass.values())).shape[0]
    return affine_model(
        parameters,
        tuple(sensors),
        select(sensors, size),
        affine(parameters, stiffness, size),
        affine(parameters, mass, size),
    )


def affine_model(
    parameters: Sequence[str],
    sensors: Sequence[str],
    selection: scipy.sparse.csr_array,
    stiffness: SparseAffine,
    mass: SparseAffine,
) -> MatrixModel:
    """Return the model of sparse affine matrices, made dense where that is faster."""
    small = stiffness.size <= DENSE
    return MatrixModel(
        tuple(parameters),
        tuple(sensors),
        selection,
        stiffness.dense() if small else stiffness,
        mass.dense() if small else mass,
    )


def affine(parameters: Sequence[str], terms: Mapping[str, Matrix], size: int) -> SparseAffine:
    """Return base + sum_j theta_j A_j for terms named ``"base"`` or as a parameter."""
    exponents = np.zeros((len(terms), len(parameters)))
    for row, name in enumerate(terms):
        if name != BASE:
            exponents[row, list(parameters).index(name)] = 1
    found = [scipy.sparse.coo_array(A) for A in terms.values()]
    return sparse_affine(found, Monomials(exponents), size)


def select(sensors: Mapping[str, SensorSpec], size: int) -> scipy.sparse.csr_array:
    """Return the weights of the degrees of freedom at each sensor, shape (sensors, N)."""
    selection = scipy.sparse.lil_array((len(sensors), size))
    for row, spec in enumerate(sensors.values()):
        for dof, weight in [(spec, 1.0)] if isinstance(spec, int) else spec:
            selection[row, dof] += weight
    return selection.tocsr()
