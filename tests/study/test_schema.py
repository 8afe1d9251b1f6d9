"""The schema of study files and their reader agree on studies that are spoilt by chance."""

from __future__ import annotations

import copy
import json
import math
import random
import re
import tomllib
from collections.abc import Iterator
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from refusals import command

import modefront as mf
from modefront.errors import Fault
from modefront.fem.mesh import read_mesh
from modefront.fem.structure import AXES, DIRECTION
from modefront.models.files import read_matrix
from modefront.models.matrices import DOF, WEIGHTED
from modefront.options import (
    ABOVE_ZERO,
    NAME,
    NOT_NEGATIVE,
    NUMBER,
    TABLE,
    array,
    fits,
    table_of,
)
from modefront.study.examples import names, write_example
from modefront.study.file import FILE_NAME, as_text, study_schema
from modefront.study.kinds import KINDS, matrices, mesh

COUNT = 700

VALUES: list[Any] = [
    *(True, "", " ", "x", 0, 1, -1, 3, 10**20, 0.0, -0.5, 0.5, 2.0, 1e200, math.nan, math.inf),
    *([], {}, [1], [0.5, 0.5], ["x"], [[1, 2]], {"x": 1}, {"x": "y"}, [{}], "all", "auto"),
]
"""What takes the place of a value."""

UNSAID = {
    "names of other tables": "the name of (a|what)|names of parameters|above 0, found nothing",
    "names that repeat": "name once|used once|other members than",
    "files and what is in them": "this column|a quantity|node set of the mesh|nodes from 0",
    "numbers that depend on each other": "as many as|as there are|one a |its bounds|rising|step",
    "numbers in order": "lower <|lowest <",
    "what the model makes of it": "of freedom from|it follows|structure that|the model uses",
    "the rest of the study": "directions of the base|or a parameter|or 'base'",
    "no number": "found nan|nan]",
    "a whole number with a decimal point": r"from .*\.0$|counted from|freedom from 0",
    "names of materials": "material: expected one of",
}
"""Patterns of faults that no schema can say."""


def inline(value: Any) -> str:
    """Return a value as TOML."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)} = {inline(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(inline, value)) + "]"
    return json.dumps(value)


def written(study: dict[str, Any]) -> str:
    """Return a study as TOML."""
    text = "\n".join(f"{key} = {inline(value)}" for key, value in study.items())
    return text.replace("= NaN", "= nan").replace("Infinity", "inf").replace("NaN", "nan")


def places(value: Any) -> Iterator[tuple[Any, Any]]:
    """Yield every table or list within a value, with each of its keys."""
    if isinstance(value, dict | list):
        keys = list(value) if isinstance(value, dict) else list(range(len(value)))
        for key in keys:
            yield value, key
            yield from places(value[key])


def spoilt(study: dict[str, Any], chance: random.Random) -> dict[str, Any]:
    """Return a study with one or two changes: a key more or less, another value."""
    out = copy.deepcopy(study)
    for _ in range(chance.choice([1, 1, 2])):
        table, key = chance.choice(list(places(out)))
        change = chance.choice(["value", "value", "value", "less", "more"])
        if change == "value":
            table[key] = copy.deepcopy(chance.choice(VALUES))
        elif change == "less":
            del table[key]
        elif isinstance(table, dict):
            table[chance.choice(["x", "pointss", f"{key}s"])] = table[key]
        else:
            table.append(copy.deepcopy(table[key]))
    return out


@pytest.fixture
def studies(folder: Path, monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """Return studies of each kind of models in which nothing is wrong."""
    monkeypatch.setattr(mesh, "read_mesh", cache(read_mesh))
    monkeypatch.setattr(matrices, "read_matrix", cache(read_matrix))
    write_example("three-story-fe-c1", folder / "fe")
    return [folder / "chain.toml", folder / "matrices.toml", folder / "fe" / "study.toml"]


@pytest.mark.slow(10)
def test_schema_and_reader_agree_on_studies_that_are_spoilt(studies: list[Path]) -> None:
    validator = jsonschema.Draft7Validator(study_schema())
    chance = random.Random(1)
    right = {file: tomllib.loads(file.read_text()) for file in studies}
    counts = {"accepted": 0, "refused by both": 0, "refused by the reader alone": 0}
    for _ in range(COUNT):
        file = studies[chance.choice([0, 0, 0, 1, 1, 1, 2])]
        study = spoilt(right[file], chance)
        wrong = file.with_name("wrong.toml")
        wrong.write_text(written(study))
        faults: tuple[Fault, ...] = ()
        try:
            mf.load(wrong)
        except mf.InputError as error:
            faults = error.faults
        errors = [f"{error.json_path} {error.message}" for error in validator.iter_errors(study)]
        if not faults:
            assert not errors, wrong.read_text()
            counts["accepted"] += 1
        elif errors:
            counts["refused by both"] += 1
        else:
            counts["refused by the reader alone"] += 1
            for text in map(str, faults):
                assert any(re.search(pattern, text) for pattern in UNSAID.values()), text
    assert counts["refused by both"] > 0.85 * (COUNT - counts["accepted"]), counts


def test_the_schema_is_one_and_takes_all_examples() -> None:
    schema = study_schema()
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    folder = resources.files("modefront.study.examples")
    for name in names():
        study = tomllib.loads(folder.joinpath(name, "study.toml").read_text())
        assert not list(validator.iter_errors(study)), name


def test_every_part_that_names_keys_says_whether_there_may_be_others() -> None:
    """Editors with Tombi take keys for unknown where a part of a schema does not say so."""
    parts = [table for table, key in places(study_schema()) if key == "properties"]
    unsaid = [each for each in parts if "additionalProperties" not in each]
    assert len(parts) > len(unsaid) > 0
    assert all(each["type"] == "object" and "allOf" in each for each in unsaid)


def test_a_key_has_its_meaning_requirement_and_default() -> None:
    points = study_schema()["properties"]["pareto"]["properties"]["points"]
    assert (points["type"], points["minimum"], points["maximum"]) == ("integer", 2, 10_000)
    assert points["description"].split("\n") == [
        "number of points along each edge of the simplex of objectives, 2 at least",
        "a whole number from 2 to 10000",
        "Without it: 20, or as many as make 300 points in all",
    ]
    assert study_schema()["properties"]["search"]["properties"]["doubt"]["default"] == 0.05


@pytest.mark.parametrize("name", ["modes.uff", "MODES.UNV", "a.b/c.UfF"])
def test_only_universal_files_have_sensors_and_only_others_columns(name: str) -> None:
    validator = jsonschema.Draft7Validator(study_schema()["properties"]["data"])
    sensors, columns = {"sensors": {"top": "12Z"}}, {"columns": {"acc": "top"}}
    assert validator.is_valid({"file": name} | sensors)
    assert not validator.is_valid({"file": name} | columns)
    assert validator.is_valid({"file": f"{name}.csv"} | columns)
    assert not validator.is_valid({"file": f"{name}.csv"} | sensors)


def test_models_are_drawn_for_predictions_only(studies: list[Path]) -> None:
    validator = jsonschema.Draft7Validator(study_schema())
    study = tomllib.loads(studies[0].read_text()) | {"uncertainty": {"draws": 5}}
    assert "frf" in study["predict"]
    assert validator.is_valid(study)
    assert not validator.is_valid(study | {"predict": {"slack": 0.1}})
    del study["predict"]
    assert not validator.is_valid(study)
    assert validator.is_valid(study | {"uncertainty": {"draws": 0}})


def test_a_modulation_has_a_factor_that_is_not_zero() -> None:
    passages = study_schema()["properties"]["predict"]["properties"]["first_passage"]
    validator = jsonschema.Draft7Validator(passages["items"]["properties"]["modulation"])
    assert validator.is_valid([[0, 0], [1, 0.5]])
    assert not validator.is_valid([[0, 0], [1, 0.0]])


def test_what_is_registered_is_in_the_schema(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(KINDS.added, "mine", mf.ModelKind("mine", lambda _table, _names: None))
    model = study_schema()["properties"]["model"]
    assert model["properties"]["kind"]["enum"][-1] == "mine"
    validator = jsonschema.Draft7Validator(model)
    assert validator.is_valid({"kind": "mine", "anything": 1})
    assert not validator.is_valid({"kind": "chain", "anything": 1})


def test_the_command_prints_the_schema_and_init_writes_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert command("schema") == 0
    assert capsys.readouterr().out == as_text()
    assert command("init", tmp_path / "new", "--example", "hammer-test") == 0
    for name in ("study.toml", "study-m1.toml"):
        assert (tmp_path / "new" / name).read_text().startswith(f"#:schema {FILE_NAME}\n")
    assert (tmp_path / "new" / FILE_NAME).read_text(encoding="utf-8") == as_text()


@pytest.mark.parametrize("value", [*VALUES, True, [True], [[0.5]], {"a": [1]}, [1, 1], "Auto"])
def test_values_are_tested_as_another_program_does(value: Any) -> None:
    schemas = [
        *(NUMBER, ABOVE_ZERO, NOT_NEGATIVE, NAME, TABLE, DOF, WEIGHTED, DIRECTION.schema),
        *(AXES.schema, array(NUMBER, 1, 2, once=True), table_of(NUMBER, 1)),
    ]
    if value != value or (isinstance(value, float) and value.is_integer()):
        return  # no number, and a whole number with a decimal point: see `UNSAID`
    for schema in schemas:
        assert fits(value, schema) == jsonschema.Draft7Validator(schema).is_valid(value), schema
