r"""Chains of lumped masses and springs, such as shear buildings.

Spring i joins mass i-1 and mass i; the first one joins the ground and mass 1. A spring more than
there are masses joins the last mass and the ground. Each spring and each mass may be scaled by a
parameter, :math:`k_i = \theta_j k_{0i}`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from modefront._typing import Floats
from modefront.models.matrices import BASE, MatrixModel, SensorSpec, matrices

BASE_DIRECTION = "x"
"""The one direction in which the masses, and the ground, can move."""


def chain(
    parameters: Sequence[str],
    masses: Sequence[float],
    stiffnesses: Sequence[float],
    *,
    added_masses: Sequence[float] | None = None,
    stiffness_parameters: Sequence[str | None] | None = None,
    mass_parameters: Sequence[str | None] | None = None,
    sensors: Mapping[str, SensorSpec] | None = None,
    outputs: Mapping[str, SensorSpec] | None = None,
) -> MatrixModel:
    """Return a chain of masses (kg) and springs (N/m), or in any other consistent units.

    ``added_masses`` are attached to the masses and are never scaled; ``stiffness_parameters`` and
    ``mass_parameters`` name the parameter that scales each spring and each mass (None: fixed).
    Sensors default to every mass, named ``floor1``, ``floor2``, ...; ``outputs`` are other places
    that predictions may name. The ground can move in the direction of the chain, ``"x"``.
    """
    n = len(masses)
    stiffness_scales = stiffness_parameters or [None] * len(stiffnesses)
    mass_scales = mass_parameters or [None] * n
    K = {BASE: np.zeros((n, n))}
    M = {BASE: np.diag(np.array(added_masses if added_masses is not None else np.zeros(n), float))}
    for i, (k, name) in enumerate(zip(stiffnesses, stiffness_scales, strict=True)):
        K.setdefault(name or BASE, np.zeros((n, n)))
        K[name or BASE] += k * _spring(n, i)
    for i, (m, name) in enumerate(zip(masses, mass_scales, strict=True)):
        M.setdefault(name or BASE, np.zeros((n, n)))
        M[name or BASE][i, i] += m
    if sensors is None:
        sensors = {f"floor{i + 1}": i for i in range(n)}
    base = {BASE_DIRECTION: [(i, 1.0) for i in range(n)]}
    return matrices(parameters, K, M, sensors, outputs=outputs, base=base)


def _spring(n: int, i: int) -> Floats:
    """Return the stiffness matrix of a unit spring between mass i-1 and mass i."""
    ends = np.zeros(n + 2)
    ends[i], ends[i + 1] = -1.0, 1.0
    out: Floats = np.outer(ends[1:-1], ends[1:-1])
    return out
