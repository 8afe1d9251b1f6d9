"""The study file: TOML in, a study out, or all of its faults; and what it may hold.

The JSON Schema is made from the requirements by which study files are read. What a schema cannot
say, such as names that refer to other tables, is left to ``modefront check``.
"""

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import MISSING, fields, replace
from pathlib import Path
from typing import Any, TypeVar, get_args

from modefront import options as opt
from modefront.data.modal import ModalData
from modefront.data.uff import SUFFIXES
from modefront.errors import Fault, InputError, ModelError, refuse, wrong
from modefront.families import Family
from modefront.findings.knowledge import enumeration
from modefront.findings.record import Finding, found
from modefront.front.methods import METHODS
from modefront.front.options import Weighted
from modefront.models.base import Model, full_of
from modefront.models.matrices import MatrixModel
from modefront.models.parameters import Parameter, wrong_ties
from modefront.models.reduced.model import MEMORY
from modefront.models.reduced.options import REDUCTION, Reduction
from modefront.outputs import write_text
from modefront.pairing.match import Pairing
from modefront.predictions import CLASSES, Prediction
from modefront.predictions.ranges import SLACK
from modefront.residuals.base import Scale
from modefront.residuals.groups import KINDS as RESIDUALS
from modefront.residuals.groups import MODE_NUMBERS, Group, faults
from modefront.residuals.problem import UpdatingProblem, updating_problem
from modefront.study.definition import Origin, Study, label_faults, undrawn
from modefront.study.kinds import KINDS
from modefront.study.measured import DATA, READERS, read_data
from modefront.text import NAME as LENGTH
from modefront.text import clean

GROUP_NAME = opt.text("the name of the group")
SCALE = opt.one_of(*get_args(Scale))

OF_OPTIONS: Mapping[str, Any] = {"pairing": Pairing} | {
    each.name: each.default_factory for each in fields(Study) if each.default_factory is not MISSING
}
"""Tables that are records of options, all of which have defaults."""


def as_study(given: Study | UpdatingProblem | Path | str) -> Study:
    """Return a study: itself, that of a file, or that of a problem with the options as usual."""
    study = load(given) if isinstance(given, Path | str) else given
    return Study(study) if isinstance(study, UpdatingProblem) else study


# Many lines: a line or two for each table of the file.
def load(path: Path | str) -> Study:
    """Return the study that a file describes.

    Parameters
    ----------
    path
        The study file, TOML; the files that it names are relative to it.

    Raises
    ------
    InputError
        With everything that is wrong with the file and the files that it names.
    """
    root, content = opt.read_toml(Path(path), "a study file")
    header = root.table("study", "a table [study]")
    of_study = (header and header.read(of_header())) or {}
    names, parameters = read_parameters(root)
    model, reduced = read_model(root, names)
    data = read_data(root, model)
    groups = read_groups(root, data)
    weighted = read_weights(root, [group.name for group in groups if group.name])
    chosen: dict[str, Any] = {
        key: root.value(key, opt.nested("a table", record), None) or record()
        for key, record in OF_OPTIONS.items()
    }
    uncertainty, pairing = chosen["uncertainty"], chosen.pop("pairing")
    drawn = replace(root, place="[uncertainty]")
    drawn.note(undrawn(uncertainty, bool(root.values.get("predict"))))
    drawn.note(uncertainty.faults(data) if data is not None else ())
    drafts, slack = read_predictions(root, model, data)
    replace(root, place="[pareto]").note(chosen["pareto"].faults(len(groups)))
    root.close()
    if root.faults or model is None or data is None:
        raise InputError(root.faults)
    reduction = Reduction(reduced, of_study.pop("memory", MEMORY))
    problem = updating_problem(
        model, data, groups, pairing=pairing, parameters=parameters, reduction=reduction
    )
    _try_model(root, problem)
    predictions = []
    for table, prediction in drafts if not root.faults else ():
        with table.noting():
            predictions.append(prediction.complete(problem))
    refuse(root.faults)
    made_of = [root.values.get(key) for key in ("data", "model", "parameter", "group", "pairing")]
    origin = Origin(
        Path(path),
        _digest(content, root.files),
        _digest(repr((made_of, reduction)).encode(), root.files),
        problem,
        reduction.fallback(problem.model),
        tuple(note for note in root.notes if isinstance(note, Finding)),
    )
    options = {**of_study, **chosen, "weighted": weighted, "slack": slack}
    return Study(problem, predictions=predictions, origin=origin, **options)


def _try_model(root: opt.Table, problem: UpdatingProblem) -> None:
    """Note what only an evaluation shows: an indefinite matrix, a parameter without effect."""
    for name in problem.model.unused:
        root.fault(f"[[parameter]] '{name}'", "a parameter that the model uses", "no use of it")
    model = full_of(problem.model)
    lower = dict(zip(model.parameters, problem.lower.tolist(), strict=True))
    above_zero = model.above_zero if isinstance(model, MatrixModel) else ()
    wrong = [name for name in above_zero if lower[name] <= 0]
    for name in wrong:
        expected = "a lower bound above 0, as terms of the matrices have quotients or roots of it"
        root.fault(f"[[parameter]] '{name}' bounds", expected, f"{lower[name]:g}")
    if wrong:
        return
    try:
        problem.modes(problem.start, derivatives=False)
    except ModelError as error:
        root.fault("[model]", "modes at the nominal parameters", str(error))
        return
    if isinstance(model, MatrixModel) and not model.floating and model.is_singular(problem.start):
        expected = "a structure that is held, or floating = true for rigid-body modes"
        root.fault("[model]", expected, "a singular stiffness matrix at the nominal parameters")


def _digest(content: bytes, files: Sequence[Path]) -> str:
    total = hashlib.sha256(content)
    for path in files:
        with path.open("rb") as stream:
            total.update(hashlib.file_digest(stream, "sha256").digest())
    return total.hexdigest()


def of_header() -> tuple[opt.Option, ...]:
    """Return the keys of ``[study]``."""
    known = {each.name: each for each in (*opt.options(Study), *opt.options(Reduction))}
    return replace(known["name"], required=True, default=None), known["seed"], known["memory"]


def read_parameters(root: opt.Table) -> tuple[list[str], tuple[Parameter, ...]]:
    """Return the names that tables give to parameters, and the parameters in which all is right."""
    tables = root.tables("parameter", required=True)
    read = tuple(parameter for table in tables if (parameter := table.record(Parameter)))
    names = opt.names_of(tables)
    for table in (table for table in tables if table.values.get("name") == "base"):
        table.fault("name", "another name: 'base' is the constant term", "'base'")
    root.note(opt.each_once("[[parameter]]", names))
    root.note(wrong_ties("[[parameter]]", read))
    return names, read


def read_model(root: opt.Table, parameters: Sequence[str]) -> tuple[Model | None, Any]:
    """Return the model of a study, None where it has faults, and how far it is reduced."""
    table = root.table("model", "a table [model]")
    name = table and table.value("kind", opt.one_of(*KINDS))
    if table is None or not name:
        return None, "auto"
    kind = KINDS[name]
    reduction = table.value("reduction", REDUCTION, "auto") if kind.is_reducible else "off"
    model = kind.read(table, parameters)
    table.close()
    return model, reduction


def of_group() -> Iterator[opt.Option]:
    """Yield the keys of ``[[group]]``."""
    meaning = "name of the objective in results"
    yield opt.Option("name", GROUP_NAME, required=True, meaning=meaning)
    for name, kind in RESIDUALS.items():
        meaning = f"measured modes whose {kind.plural} count"
        yield opt.Option(name, MODE_NUMBERS, optional=True, meaning=meaning)
    yield opt.Option("scale", SCALE, default="measured", meaning="unit of the residuals")


def read_groups(root: opt.Table, data: ModalData | None) -> tuple[Group, ...]:
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
        out.append(group)
        wrong = list(faults(group, data))
        for fault in wrong if group.chosen or are_read else ():
            table.fault(*fault)
        if data is None or wrong:
            continue
        members = frozenset((kind.name, r) for kind, rs in group.positions(data) for r in rs)
        single = {data.modes[r] for kind, r in members if kind == "shape"}
        root.notes += [
            found("compared-pair", f"{a} and {b}", group=group.name, modes=f"{a}, {b}")
            for a, b in data.pairs
            if single & {a, b}
        ]
        if (first := held.setdefault(members, name)) != name:  # objectives could not differ
            expected = f"other members than those of '{first}'"
            equal.append(Fault("", "[[group]]", expected, f"'{name}'"))
    count = sum(int(kind.measured(data).sum()) for kind in RESIDUALS.values()) if data else 0
    if data and len(tables) > count:
        nouns = " and ".join(kind.plural for kind in RESIDUALS.values())
        expected = f"at most {count} groups, as many as measured {nouns}"
        root.fault("[[group]]", expected, str(len(tables)))
    root.note([*equal, *opt.each_once("[[group]]", opt.names_of(tables))])
    return tuple(out)


def read_weights(root: opt.Table, groups: Sequence[str]) -> tuple[Weighted, ...]:
    """Return the weights that a study gives; no name may be one of the labels of other models."""
    tables = root.tables("weighted", required=False)
    out = [(table, table.record(Weighted)) for table in tables]
    for table, weighted in out:
        table.note(weighted.faults(groups) if weighted else ())
        for name in opt.names_of([table]):
            table.note(label_faults(name, groups))
    root.note(opt.each_once("[[weighted]]", opt.names_of(tables)))
    return tuple(weighted for _, weighted in out if weighted)


def read_predictions(
    root: opt.Table, model: Model | None, data: ModalData | None
) -> tuple[list[tuple[opt.Table, Prediction]], float]:
    """Return the predictions that a study asks for, as far as they are right, and their slack.

    They are as in their tables, without the defaults that follow from the nominal model.
    """
    expected = f"tables {enumeration([f'[[predict.{name}]]' for name in CLASSES])}"
    table = root.table("predict", expected, None)
    if table is None:
        return [], 0.0
    slack, names = table.value("slack", SLACK, 0.0), []
    out: list[tuple[opt.Table, Prediction]] = []
    for key, prediction_class in CLASSES.items():
        for each in table.tables(key, required=False):
            names += opt.names_of([each])
            prediction = each.record(prediction_class)
            if prediction is not None and model is not None and data is not None:
                each.note(prediction.faults(model, data))
            out += [] if prediction is None else [(each, prediction)]
    table.close()
    table.note(opt.each_once("", names))
    return out, float(slack or 0.0)


T = TypeVar("T")

FILE_NAME = "study.schema.json"
"""File that is written beside a study file: no network is needed to read it."""


def study_schema() -> dict[str, Any]:
    """Return the schema, draft 7, with the kinds, methods and predictions that are registered."""
    has_modes = [
        {"required": [kind], "properties": {kind: {"minItems": 1}}, **opt.OPEN}
        for kind in RESIDUALS
    ]
    meaning = "share by which objectives of models may be greater that count in ranges"
    slack = opt.Option("slack", SLACK, default=0, meaning=meaning).schema
    predict = {key: opt.array(opt.schema_of(each), 1) for key, each in CLASSES.items()}
    reduction = [each for each in opt.options(Reduction) if each.name == "reduction"]
    models = {
        name: opt.of_options([*opt.options(kind.table), *reduction * kind.is_reducible])
        if kind.table
        else opt.TABLE
        for name, kind in KINDS.items()
    }
    # Only universal files have sensors, only others columns.
    data = {each.name: each.schema for each in DATA}
    endings = [".csv", *SUFFIXES, *READERS]
    data["file"] = {**data["file"], **opt.file_name(endings, any_case=True)}
    universal = {"properties": {"file": opt.file_name(SUFFIXES, any_case=True)}, **opt.OPEN}
    tables = {
        "study": opt.of_options(of_header()),
        "data": {
            **opt.closed(data, ["file"]),
            "if": universal,
            "then": {"properties": {"columns": False}, **opt.OPEN},
            "else": {"properties": {"sensors": False}, **opt.OPEN},
        },
        "model": opt.chosen("kind", models),
        "parameter": opt.array(opt.schema_of(Parameter), 1),
        "group": opt.array({**opt.of_options(of_group()), "anyOf": has_modes}, 1),
        "weighted": opt.array(opt.schema_of(Weighted), 1),
        **{name: opt.schema_of(record) for name, record in OF_OPTIONS.items()},
        "predict": opt.closed({"slack": slack, **predict}, []),
    }
    required = ["study", "data", "model", "parameter", "group"]
    head = {"$schema": "http://json-schema.org/draft-07/schema#", "title": "modefront study"}
    # Models are drawn for predictions only.
    draws = {"required": ["draws"], "properties": {"draws": {"minimum": 1}}, **opt.OPEN}
    some = {"anyOf": [{"required": [key]} for key in CLASSES]}
    drawn = {
        "if": {"required": ["uncertainty"], "properties": {"uncertainty": draws}, **opt.OPEN},
        "then": {"required": ["predict"], "properties": {"predict": some}, **opt.OPEN},
    }
    return {**head, **opt.closed(tables, required), **drawn}


def as_text() -> str:
    """Return the schema as the text of a file."""
    return json.dumps(study_schema(), indent=1, ensure_ascii=False) + "\n"


def add_schema(studies: Sequence[Path]) -> Path:
    """Write the schema beside studies of one folder, of which the first lines name it then.

    Returns its path; an earlier schema is replaced.
    """
    for study in studies:
        # By this line editors with Taplo find the schema.
        write_text(study, f"#:schema {FILE_NAME}\n" + study.read_text("utf-8"))
    path = studies[0].parent / FILE_NAME
    write_text(path, as_text())
    return path


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
        if isinstance(extension, family.member):
            family.add(extension)
            return extension
    expected = ", ".join(family.what for family in FAMILIES)
    raise wrong("register", f"one of {expected}", clean(repr(extension), LENGTH))
