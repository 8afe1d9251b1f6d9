r"""Models given by their matrices: :math:`K(\theta) = K_0 + \sum_j \theta_j K_j`, M likewise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from modefront._typing import Floats
from modefront.models.affine import DenseAffine, Monomials
from modefront.models.base import Counts
from modefront.modes import dense
from modefront.modes.result import Modes

BASE = "base"
"""Name of the term that does not depend on the parameters."""

SensorSpec = int | Sequence[tuple[int, float]]
"""A sensor: a degree of freedom, counted from 0, or weighted degrees of freedom."""


@dataclass(frozen=True)
class MatrixModel:
    """A model with affine stiffness and mass matrices.

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
    selection: Floats
    stiffness: DenseAffine
    mass: DenseAffine
    counts: Counts = field(default_factory=Counts, compare=False)

    @property
    def size(self) -> int:
        """Number of degrees of freedom N."""
        return self.stiffness.size

    @property
    def unused(self) -> tuple[str, ...]:
        """Names of parameters on which neither matrix depends."""
        used = self.stiffness.used | self.mass.used
        return tuple(name for name, one in zip(self.parameters, used, strict=True) if not one)

    def modes(self, theta: Floats, count: int, *, derivatives: bool = True) -> Modes:
        """Return the ``count`` lowest modes at ``theta``; see `modefront.models.base.Model`."""
        self.counts.eigenproblems += 1
        return dense.modes(self.stiffness, self.mass, self.selection, theta, count, derivatives)


def matrices(
    parameters: Sequence[str],
    stiffness: Mapping[str, Floats],
    mass: Mapping[str, Floats],
    sensors: Mapping[str, SensorSpec],
) -> MatrixModel:
    """Return the model with K(theta) = base + sum_j theta_j K_j and M(theta) likewise.

    ``stiffness`` and ``mass`` map ``"base"`` and names of parameters to symmetric matrices N x N.
    Raises ValueError for a term that is no parameter.
    """
    size = len(next(iter(mass.values())))
    return MatrixModel(
        tuple(parameters),
        tuple(sensors),
        select(sensors, size),
        affine(parameters, stiffness, size),
        affine(parameters, mass, size),
    )


def affine(parameters: Sequence[str], terms: Mapping[str, Floats], size: int) -> DenseAffine:
    """Return base + sum_j theta_j A_j for terms named ``"base"`` or as a parameter."""
    exponents = np.zeros((len(terms), len(parameters)))
    for row, name in enumerate(terms):
        if name != BASE:
            exponents[row, list(parameters).index(name)] = 1
    data = np.array([np.asarray(A, dtype=float) for A in terms.values()])
    return DenseAffine(data.reshape(-1, size, size), Monomials(exponents))


def select(sensors: Mapping[str, SensorSpec], size: int) -> Floats:
    """Return the weights of the degrees of freedom at each sensor, shape (sensors, N)."""
    selection = np.zeros((len(sensors), size))
    for row, spec in zip(selection, sensors.values(), strict=True):
        for dof, weight in [(spec, 1.0)] if isinstance(spec, int) else spec:
            row[dof] += weight
    return selection
