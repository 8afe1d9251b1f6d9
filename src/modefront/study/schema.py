"""What study files may hold: their JSON Schema, and the extensions of the user.

The schema is made from the requirements by which study files are read.
What a schema cannot say is left to ``modefront check``: names that refer to other tables, files,
columns and nodes, numbers that depend on each other, names that repeat, and whether a whole number
was written with a decimal point.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypeVar

from modefront.data.uff import SUFFIXES
from modefront.errors import wrong
from modefront.families import Family
from modefront.front.given import Weighted
from modefront.front.methods import METHODS
from modefront.json_schema import (
    NAME,
    OPEN,
    TABLE,
    Schema,
    array,
    chosen,
    closed,
    file_name,
    table_of,
)
from modefront.models.parameters import Parameter
from modefront.models.reduced.options import Reduction
from modefront.options import Option, of_options, options, schema_of
from modefront.outputs import write_text
from modefront.predictions import CLASSES
from modefront.predictions.ranges import SLACK
from modefront.residuals.groups import KINDS as RESIDUALS
from modefront.study.file import OF_OPTIONS, of_group, of_header
from modefront.study.kinds import KINDS
from modefront.study.kinds.sensors import ModelKind
from modefront.study.measured import COVARIANCE, FILE, PLACE, READERS
from modefront.text import NAME as LENGTH
from modefront.text import clean

T = TypeVar("T")

FILE_NAME = "study.schema.json"
"""File that is written beside a study file: no network is needed to read it."""

DIRECTIVE = f"#:schema {FILE_NAME}\n"
"""First line of a study file, by which editors with Taplo find the schema."""


def study_schema() -> dict[str, Any]:
    """Return the schema, draft 7, with the kinds, methods and predictions that are registered."""
    has_modes = [
        {"required": [kind], "properties": {kind: {"minItems": 1}}, **OPEN} for kind in RESIDUALS
    ]
    meaning = "share by which objectives of models may be greater that count in ranges"
    slack = Option("slack", SLACK, default=0, meaning=meaning).schema
    predict = {key: array(schema_of(each), 1) for key, each in CLASSES.items()}
    tables = {
        "study": of_options(of_header()),
        "data": _data(),
        "model": chosen("kind", {name: _model(kind) for name, kind in KINDS.items()}),
        "parameter": array(schema_of(Parameter), 1),
        "group": array({**of_options(of_group()), "anyOf": has_modes}, 1),
        "weighted": array(schema_of(Weighted), 1),
        **{name: schema_of(record) for name, record in OF_OPTIONS.items()},
        "predict": closed({"slack": slack, **predict}, []),
    }
    required = ["study", "data", "model", "parameter", "group"]
    head = {"$schema": "http://json-schema.org/draft-07/schema#", "title": "modefront study"}
    return {**head, **closed(tables, required), **_drawn_to_predict()}


def as_text() -> str:
    """Return the schema as the text of a file."""
    return json.dumps(study_schema(), indent=1, ensure_ascii=False) + "\n"


def add_schema(studies: Sequence[Path]) -> Path:
    """Write the schema beside studies of one folder, of which the first lines name it then.

    Returns its path; an earlier schema is replaced.
    """
    for study in studies:
        write_text(study, DIRECTIVE + study.read_text("utf-8"))
    path = studies[0].parent / FILE_NAME
    write_text(path, as_text())
    return path


def _data() -> Schema:
    """Return the schema of ``[data]``: only universal files have sensors, only others columns."""
    columns = "name of a column in the file = name of a column of modal data, or of a sensor"
    places = "sensor = node and direction in the file"
    table = closed(
        {
            "file": {**FILE.described, **file_name([".csv", *SUFFIXES, *READERS], any_case=True)},
            "covariance": COVARIANCE.described,
            "sensors": {"description": places, **table_of(PLACE)},
            "columns": {"description": columns, **table_of(NAME)},
        },
        ["file"],
    )
    universal = {"properties": {"file": file_name(SUFFIXES, any_case=True)}, **OPEN}
    without: dict[str, Schema] = {
        "then": {"properties": {"columns": False}, **OPEN},
        "else": {"properties": {"sensors": False}, **OPEN},
    }
    return {**table, "if": universal, **without}


def _model(kind: ModelKind) -> Schema:
    """Return the schema of ``[model]`` of one kind, without the key ``kind``."""
    if kind.table is None:
        return TABLE
    known = [x for x in options(Reduction) if x.name == "reduction" and kind.is_reducible]
    return of_options([*options(kind.table), *known])


def _drawn_to_predict() -> Schema:
    """Return what a schema says in addition of a study: models are drawn for predictions only."""
    draws = {"required": ["draws"], "properties": {"draws": {"minimum": 1}}, **OPEN}
    some = {"anyOf": [{"required": [key]} for key in CLASSES]}
    return {
        "if": {"required": ["uncertainty"], "properties": {"uncertainty": draws}, **OPEN},
        "then": {"required": ["predict"], "properties": {"predict": some}, **OPEN},
    }


FAMILIES: tuple[Family[Any], ...] = (CLASSES, KINDS, RESIDUALS, METHODS, READERS)
"""All families that users extend."""


def register(extension: T) -> T:
    """Make an extension known, and return it.

    Entry points of installed packages do the same: ``modefront.predictions``,
    ``modefront.models``, ``modefront.residuals``, ``modefront.methods`` and ``modefront.readers``.

    Parameters
    ----------
    extension
        A class of predictions with what `Prediction` has, a `ModelKind`, a kind of residual with
        what `modefront.residuals.base.ResidualKind` has, a `Method` of fronts, or a `DataReader`.
        It takes the place of one that was registered before under its name.

    Raises
    ------
    InputError
        Where it is none of these, or its name is that of another one.
    """
    for family in FAMILIES:
        if family.takes(extension):
            family.add(extension)
            return extension
    expected = ", ".join(family.what for family in FAMILIES)
    raise wrong("register", f"one of {expected}", clean(repr(extension), LENGTH))
