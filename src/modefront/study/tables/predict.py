"""``[[predict.frf]]`` and the like: what the Pareto models are to predict, a table a prediction."""

from __future__ import annotations

from collections.abc import Sequence

from modefront.data.modal import ModalData
from modefront.errors import InputError
from modefront.findings.knowledge import enumeration
from modefront.models.base import Model
from modefront.options import each_once
from modefront.predictions import KINDS, Prediction
from modefront.residuals.problem import UpdatingProblem
from modefront.study.tables.options import note, read_record
from modefront.toml import Table, has_name

Drafts = Sequence[tuple[Table, Prediction]]
"""Predictions as in their tables, without the defaults that follow from the nominal model."""


def read_predictions(root: Table, model: Model | None, data: ModalData | None) -> Drafts:
    """Return the predictions that a study asks for, as far as nothing is wrong with them."""
    expected = f"tables {enumeration([f'[[predict.{kind.kind.table}]]' for kind in KINDS])}"
    table = root.table("predict", expected, None)
    if table is None:
        return []
    out: list[tuple[Table, Prediction]] = []
    names = []
    for kind in KINDS:
        for each in table.tables(kind.kind.table, required=False):
            names += [each.values["name"]] if has_name(each) else []
            prediction = read_record(each, kind)
            if prediction is None:
                continue
            if model is not None and data is not None:
                note(each, prediction.faults(model, data))
            out.append((each, prediction))
    table.close()
    note(table, each_once("", names))
    return out


def complete(drafts: Drafts, problem: UpdatingProblem) -> tuple[Prediction, ...]:
    """Return the predictions; what the nominal model cannot predict is noted and left out."""
    out = []
    for table, prediction in drafts:
        try:
            out.append(prediction.complete(problem))
        except InputError as error:
            note(table, error.faults)
    return tuple(out)
