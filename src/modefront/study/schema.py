"""JSON Schema of the study file, made from the requirements by which it is read.

What a schema cannot say is left to ``modefront check``: names that refer to other tables, files,
columns and nodes, numbers that depend on each other, names that repeat, and whether a whole number
was written with a decimal point.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from modefront.data.uff55 import SUFFIXES
from modefront.front.given import Weighted
from modefront.front.options import Pareto
from modefront.front.search import Search
from modefront.identifiability.options import Identifiability
from modefront.json_schema import NAME, OPEN, Schema, array, chosen, closed, file_name, table_of
from modefront.models.parameters import Parameter
from modefront.models.reduced.options import Reduction
from modefront.options import Option, of_options, options, schema_of
from modefront.outputs import write_text
from modefront.pairing.match import Pairing
from modefront.predictions import CLASSES
from modefront.predictions.ranges import SLACK
from modefront.residuals.groups import MODE_NUMBERS
from modefront.residuals.kinds import KINDS as RESIDUALS
from modefront.study.definition import Study
from modefront.study.kinds import KINDS
from modefront.study.measured import FILE, PLACE, READERS
from modefront.study.tables import GROUP_NAME, SCALE
from modefront.uncertainty.options import Uncertainty
from modefront.uncertainty.prior import NoisePrior

FILE_NAME = "study.schema.json"
"""File that is written beside a study file: no network is needed to read it."""

DIRECTIVE = f"#:schema {FILE_NAME}\n"
"""First line of a study file, by which editors with Taplo find the schema."""

OF_OPTIONS = {
    "pareto": Pareto,
    "pairing": Pairing,
    "search": Search,
    "identifiability": Identifiability,
    "uncertainty": Uncertainty,
    "noise": NoisePrior,
}
"""Tables that are records of options, all of which have defaults."""


def study_schema() -> dict[str, Any]:
    """Return the schema, draft 7, with the kinds, methods and predictions that are registered."""
    tables = {
        "study": of_options(_header()),
        "data": _data(),
        "model": chosen("kind", {name: _model(name) for name in KINDS}),
        "parameter": array(schema_of(Parameter), 1),
        "group": array({**of_options(_group()), "anyOf": [_has_modes(x) for x in RESIDUALS]}, 1),
        "weighted": array(schema_of(Weighted), 1),
        **{name: schema_of(record) for name, record in OF_OPTIONS.items()},
        "predict": _predict(),
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


def _header() -> Iterator[Option]:
    """Yield the keys of ``[study]``."""
    of_study = {each.name: each for each in options(Study)}
    name = of_study["name"]
    yield Option("name", name.requirement, False, True, None, name.meaning)
    yield of_study["seed"]
    yield from (each for each in options(Reduction) if each.name == "memory")


def _data() -> Schema:
    """Return the schema of ``[data]``: only universal files have sensors, only others columns."""
    columns = "name of a column in the file = name of a column of modal data, or of a sensor"
    places = "sensor = node and direction in the file"
    table = closed(
        {
            "file": {**FILE.described, **file_name([".csv", *SUFFIXES, *READERS], any_case=True)},
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


def _model(name: str) -> Schema:
    """Return the schema of ``[model]`` of one kind."""
    kind, own = KINDS[name], {"enum": [name]}
    if kind.table is None:
        return {"type": "object", "properties": {"kind": own}, "required": ["kind"]}
    known = schema_of(kind.table)
    more = {each.name: each.schema for each in options(Reduction) if each.name == "reduction"}
    keys = {"kind": own, **known["properties"], **(more if kind.is_reducible else {})}
    return closed(keys, ["kind", *known["required"]])


def _group() -> Iterator[Option]:
    """Yield the keys of ``[[group]]``."""
    yield Option("name", GROUP_NAME, False, True, None, "name of the objective in results")
    for name, kind in RESIDUALS.items():
        yield Option(
            name, MODE_NUMBERS, True, False, None, f"measured modes whose {kind.plural} count"
        )
    yield Option("scale", SCALE, False, False, "measured", "unit of the residuals")


def _has_modes(kind: str) -> Schema:
    """Return the schema of groups that have residuals of a kind."""
    return {"required": [kind], "properties": {kind: {"minItems": 1}}, **OPEN}


def _predict() -> Schema:
    slack = Option(
        "slack",
        SLACK,
        False,
        False,
        0,
        "share by which objectives of models may be greater that count in ranges",
    )
    lists = {key: array(schema_of(each), 1) for key, each in CLASSES.items()}
    return closed({"slack": slack.schema, **lists}, [])


def _drawn_to_predict() -> Schema:
    """Return what a schema says in addition of a study: models are drawn for predictions only."""
    draws = {"required": ["draws"], "properties": {"draws": {"minimum": 1}}, **OPEN}
    some = {"anyOf": [{"required": [key]} for key in CLASSES]}
    return {
        "if": {"required": ["uncertainty"], "properties": {"uncertainty": draws}, **OPEN},
        "then": {"required": ["predict"], "properties": {"predict": some}, **OPEN},
    }
