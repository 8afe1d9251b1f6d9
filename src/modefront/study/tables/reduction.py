"""``reduction`` and ``memory``: whether a model is solved in a reduced basis, and how exactly."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modefront.data.modal import ModalData
from modefront.models.base import Model
from modefront.models.matrices import MatrixModel
from modefront.models.reduced.model import MEMORY, TOLERANCE, ReducedModel
from modefront.pairing.match import Pairing, modes_needed
from modefront.study.tables.parameters import Parameter
from modefront.toml import Table, is_number

AUTO, OFF = "auto", "off"

PAYS = 2000
"""Degrees of freedom from which ``auto`` takes a basis; smaller models are solved in full."""

UNREDUCED = ("chain",)
"""Kinds of models that are too small for it, and have no such key."""

LEAST, MOST = 1e-12, 1e-2
"""Tolerances that a study may ask for."""


def read_reduction(table: Table, kind: str) -> float | str:
    """Return ``auto``, ``off`` or the tolerance of eigenvalues."""
    if kind in UNREDUCED:
        return OFF
    value = table.take(
        "reduction",
        f"'{AUTO}', '{OFF}' or a relative error of eigenvalues from {LEAST:g} to {MOST:g}",
        lambda x: x in (AUTO, OFF) or (is_number(x) and LEAST <= x <= MOST),
        AUTO,
    )
    return float(value) if is_number(value) else str(value)


def read_memory(header: Table) -> float:
    """Return the GiB that a basis may take."""
    value = header.number("memory", "GiB for a reduced basis, above 0", lambda x: x > 0, MEMORY)
    return float(value)


def reduced(
    model: Model,
    reduction: float | str,
    memory: float,
    data: ModalData,
    pairing: Pairing,
    parameters: Sequence[Parameter],
) -> Model:
    """Return the model in a reduced basis, or as it is: by wish, or where nothing can be gained.

    A basis needs matrices that are affine in functions of the parameters, and sparse.
    """
    if reduction == OFF or not isinstance(model, MatrixModel) or not model.is_sparse:
        return model
    if reduction == AUTO and model.size < PAYS:
        return model
    count = modes_needed(pairing, data, model.size)
    return ReducedModel(
        model,
        count,
        np.array([one.nominal for one in parameters]),
        np.array([one.lower for one in parameters]),
        np.array([one.upper for one in parameters]),
        tolerance=TOLERANCE if reduction == AUTO else float(reduction),
        memory=memory,
        spare=count - len(data.modes),
    )


def fallback(model: Model, reduction: float | str) -> str:
    """Return why a model is solved in full though a tolerance was asked for, or nothing."""
    if isinstance(reduction, str) or isinstance(model, ReducedModel):
        return ""
    if isinstance(model, MatrixModel):
        return f"no reduced basis: the model has only {model.size} degrees of freedom"
    return "no reduced basis: the matrices are not known as affine functions of the parameters"
