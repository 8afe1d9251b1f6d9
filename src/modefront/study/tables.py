"""The tables of a study file, but for its measured modes: a reader each.

A table whose keys are the fields of a record of options is read by `modefront.toml.Table.record`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeVar, get_args

from modefront.data.modal import ModalData
from modefront.errors import Fault, InputError
from modefront.findings.knowledge import enumeration
from modefront.findings.record import found
from modefront.front.given import Weighted, label_faults
from modefront.models.base import Model
from modefront.models.parameters import Parameter
from modefront.models.reduced.options import Reduction
from modefront.options import each_once, one_of, options, text
from modefront.predictions import CLASSES, Prediction
from modefront.predictions.ranges import SLACK
from modefront.residuals.base import Scale
from modefront.residuals.groups import MODE_NUMBERS, Group, faults
from modefront.residuals.kinds import KINDS as RESIDUALS
from modefront.residuals.problem import UpdatingProblem
from modefront.study.definition import NAME, SEED
from modefront.study.kinds import KINDS
from modefront.study.labels import labels_of
from modefront.toml import Table, names_of

T = TypeVar("T")

GROUP_NAME = text("the name of the group")
SCALE = one_of(*get_args(Scale))

Drafts = Sequence[tuple[Table, Prediction]]
"""Predictions as in their tables, without the defaults that follow from the nominal model."""


def read_options(root: Table, key: str, record: type[T]) -> T:
    """Return the record that a table describes, that of defaults without one or with a fault."""
    table = root.table(key, default=None)
    return (table and table.record(record)) or record()


def read_header(header: Table | None) -> tuple[str, int]:
    """Return name and seed of the table ``[study]``; its memory is read elsewhere."""
    if header is None:
        return "", 0
    name = header.value("name", NAME) or ""
    seed: int = header.value("seed", SEED, 0)
    header.close()
    return name, seed


def read_parameters(root: Table) -> tuple[list[str], tuple[Parameter, ...]]:
    """Return the names that tables give to parameters, and the parameters in which all is right."""
    tables = root.tables("parameter", required=True)
    out = []
    for table in tables:
        if table.values.get("name") == "base":
            table.fault("name", "another name: 'base' is the constant term", "'base'")
        out.append(table.record(Parameter))
    names = names_of(tables)
    root.note(each_once("[[parameter]]", names))
    read = tuple(parameter for parameter in out if parameter is not None)
    free = {parameter.name for parameter in read if parameter.free}
    for parameter in read:
        if parameter.tie and parameter.tie not in free:
            expected = "the name of a parameter that is neither fixed nor tied"
            root.fault(f"[[parameter]] '{parameter.name}' tie", expected, f"'{parameter.tie}'")
    if read and not free:
        root.fault("[[parameter]]", "one that is neither fixed nor tied", "none")
    return names, read


def read_model(
    root: Table, header: Table | None, parameters: Sequence[str]
) -> tuple[Model | None, Reduction]:
    """Return the model of a study, None where it has faults, and whether it is reduced.

    ``header`` is the table ``[study]``, which says how much memory a basis may take.
    """
    table = root.table("model", "a table [model]")
    name = table and table.choice("kind", tuple(KINDS))
    kind = KINDS[name] if name else None
    places = {"reduction": table if kind and kind.is_reducible else None, "memory": header}
    reduction = Reduction("off" if kind and not kind.is_reducible else "auto")
    values = {
        each.name: place.value(each.name, each.requirement, getattr(reduction, each.name))
        for each in options(Reduction)
        if (place := places[each.name]) is not None
    }
    if table is None or kind is None:
        return None, reduction
    model = kind.read(table, parameters)
    table.close()
    return model, replace(reduction, **values)


def read_groups(root: Table, data: ModalData | None) -> tuple[Group, ...]:
    """Return the groups that a study names, those without fault with members that the data have."""
    out: list[Group] = []
    tables = root.tables("group", required=True)
    held: dict[frozenset[tuple[str, int]], str] = {}
    equal = []
    for table in tables:
        name = table.value("name", GROUP_NAME) or ""
        before = len(root.faults)
        modes = {name: table.value(name, MODE_NUMBERS, []) for name in RESIDUALS}
        are_read = len(root.faults) == before
        group = Group(name, scale=table.value("scale", SCALE, "measured"), **modes)
        table.close()
        wrong = list(faults(group, data))
        if group.chosen or are_read:
            for fault in wrong:
                table.fault(*fault)
        out.append(group)
        if data is None or wrong:
            continue
        chosen = {kind.name: rs for kind, rs in group.positions(data)}
        single = {data.modes[r] for r in chosen.get("shape", ())}
        root.notes += [
            found("compared-pair", f"{a} and {b}", group=group.name, modes=f"{a}, {b}")
            for a, b in data.pairs
            if single & {a, b}
        ]
        members = frozenset((kind.name, r) for kind, rs in group.positions(data) for r in rs)
        if members in held:  # their objectives could not differ
            expected = f"other members than those of '{held[members]}'"
            equal.append(Fault("", "[[group]]", expected, f"'{name}'"))
        held.setdefault(members, name)
    if data is not None:
        count = sum(int(kind.measured(data).sum()) for kind in RESIDUALS.values())
        if len(tables) > count:
            nouns = " and ".join(kind.plural for kind in RESIDUALS.values())
            expected = f"at most {count} groups, as many as measured {nouns}"
            root.fault("[[group]]", expected, str(len(tables)))
    root.note([*equal, *each_once("[[group]]", names_of(tables))])
    return tuple(out)


def read_weights(root: Table, groups: Sequence[str]) -> tuple[Weighted, ...]:
    """Return the weights that a study gives; no name may be one of the labels of other models."""
    tables = root.tables("weighted", required=False)
    out = []
    for table in tables:
        weighted = table.record(Weighted)
        if weighted is not None:
            table.note(weighted.faults(groups))
            out.append(weighted)
        table.note(label_faults(names_of([table]), labels_of(groups)))
    root.note(each_once("[[weighted]]", names_of(tables)))
    return tuple(out)


def read_predictions(
    root: Table, model: Model | None, data: ModalData | None
) -> tuple[Drafts, float]:
    """Return the predictions that a study asks for, as far as they are right, and their slack."""
    if "predict" not in root.values:
        root.requested.append("predict")
        return [], 0.0
    expected = f"tables {enumeration([f'[[predict.{name}]]' for name in CLASSES])}"
    table = root.table("predict", expected)
    if table is None:
        return [], 0.0
    slack = table.value("slack", SLACK, 0.0)
    out: list[tuple[Table, Prediction]] = []
    names = []
    for key, prediction_class in CLASSES.items():
        for each in table.tables(key, required=False):
            names += names_of([each])
            prediction = each.record(prediction_class)
            if prediction is None:
                continue
            if model is not None and data is not None:
                each.note(prediction.faults(model, data))
            out.append((each, prediction))
    table.close()
    table.note(each_once("", names))
    return out, float(slack or 0.0)


def complete(drafts: Drafts, problem: UpdatingProblem) -> tuple[Prediction, ...]:
    """Return the predictions; what the nominal model cannot predict is noted and left out."""
    out = []
    for table, prediction in drafts:
        try:
            out.append(prediction.complete(problem))
        except InputError as error:
            table.note(error.faults)
    return tuple(out)
