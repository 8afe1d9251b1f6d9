"""The matrices of a model of any kind, near one theta."""

from __future__ import annotations

from modefront._typing import Floats
from modefront.models.base import Model
from modefront.models.function import FunctionModel
from modefront.models.matrices import MatrixModel
from modefront.models.reduced.model import ReducedModel


def matrices_at(model: Model, theta: Floats) -> MatrixModel | None:
    """Return the model with the matrices, and their derivatives, that a model has at ``theta``.

    A reduced model has those of the full one; None for a model that has no matrices.
    """
    full = model.full if isinstance(model, ReducedModel) else model
    if isinstance(full, FunctionModel):
        return full.at(theta)
    return full if isinstance(full, MatrixModel) else None
