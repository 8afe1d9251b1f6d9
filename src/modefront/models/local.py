"""The matrices and the mode shapes of a model of any kind, near one theta."""

from __future__ import annotations

from modefront._typing import Floats
from modefront.models.base import Model, full_of
from modefront.models.function import FunctionModel
from modefront.models.geometry import Geometry
from modefront.models.matrices import MatrixModel
from modefront.models.reduced.model import ReducedModel


def matrices_at(model: Model, theta: Floats) -> MatrixModel | None:
    """Return the model with the matrices, and their derivatives, that a model has at ``theta``.

    A reduced model has those of the full one; None for a model that has no matrices.
    """
    full = full_of(model)
    if isinstance(full, FunctionModel):
        return full.at(theta)
    return full if isinstance(full, MatrixModel) else None


def geometry_of(model: Model) -> Geometry | None:
    """Return where the degrees of freedom of a model are; None where that is not known."""
    full = full_of(model)
    return full.geometry if isinstance(full, MatrixModel) else None


def shapes_at(model: Model, theta: Floats, count: int) -> tuple[Floats, Floats, Floats | None]:
    """Return the ``count`` lowest modes at ``theta``, those of a reduced model in its basis.

    They are eigenvalues omega**2 in (rad/s)**2, (modes,), and mode shapes of arbitrary sign at the
    sensors, (sensors, modes), and at all degrees of freedom, (N, modes), None for a model without
    matrices. Raises ModelError where the model has no such modes.
    """
    known = model.at(theta, derivatives=False) if isinstance(model, FunctionModel) else model
    if isinstance(known, MatrixModel | ReducedModel):
        lowest = known.full_modes(theta, count)
        full = known.full if isinstance(known, ReducedModel) else known
        return lowest.lam, full.selection @ lowest.Phi, lowest.Phi
    modes = model.modes(theta, count, derivatives=False)
    return modes.lam, modes.phi, None
