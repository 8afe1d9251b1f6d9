"""``[[predict.frf]]`` and the like: what the Pareto models are to predict, a table a prediction."""

from __future__ import annotations

from collections.abc import Sequence

from modefront.data.modal import ModalData
from modefront.errors import InputError
from modefront.findings.knowledge import enumeration
from modefront.models.base import Model
from modefront.options import each_once
from modefront.predictions import Prediction, known
from modefront.predictions.ranges import SLACK
from modefront.residuals.problem import UpdatingProblem
from modefront.study.tables.options import note, read_record
from modefront.toml import Table, has_name

Drafts = Sequence[tuple[Table, Prediction]]
"""Predictions as in their tables, without the defaults that follow from the nominal model."""


def read_predictions(
    root: Table, model: Model | None, data: ModalData | None
) -> tuple[Drafts, float]:
    """Return the predictions that a study asks for, as far as they are right, and their slack."""
    if "predict" not in root.values:
        root.requested.append("predict")
        return [], 0.0
    classes = known()
    expected = f"tables {enumeration([f'[[predict.{each.kind.table}]]' for each in classes])}"
    table = root.table("predict", expected)
    if table is None:
        return [], 0.0
    slack = table.take("slack", SLACK.expected, SLACK.holds, 0.0)
    out: list[tuple[Table, Prediction]] = []
    names = []
    for prediction_class in classes:
        for each in table.tables(prediction_class.kind.table, required=False):
            names += [each.values["name"]] if has_name(each) else []
            prediction = read_record(each, prediction_class)
            if prediction is None:
                continue
            if model is not None and data is not None:
                note(each, prediction.faults(model, data))
            out.append((each, prediction))
    table.close()
    note(table, each_once("", names))
    return out, float(slack or 0.0)


def complete(drafts: Drafts, problem: UpdatingProblem) -> tuple[Prediction, ...]:
    """Return the predictions; what the nominal model cannot predict is noted and left out."""
    out = []
    for table, prediction in drafts:
        try:
            out.append(prediction.complete(problem))
        except InputError as error:
            note(table, error.faults)
    return tuple(out)
