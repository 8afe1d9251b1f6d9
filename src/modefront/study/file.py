"""The study file: TOML in, a study out, or everything that is wrong with it."""

from __future__ import annotations

import hashlib
import math
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from modefront.data.csv import read_csv
from modefront.data.modal import ModalData
from modefront.errors import Fault, InputError, ModelError, suggestion
from modefront.models.base import Model
from modefront.pairing.match import Pairing
from modefront.residuals.groups import Group, measured_frequencies, measured_shapes, members
from modefront.residuals.problem import UpdatingProblem
from modefront.solvers.explore import Search
from modefront.study.kinds import KINDS
from modefront.study.reader import Table, describe, is_number, repeated

METHODS = ("nbi",)
"""Methods that ``[pareto] method`` may name."""

POINTS = 20

RESERVED = (
    *("nbi-", "edge-", "minima-", "gap-", "equal-weights", "optimal-weights"),
    *("iterated-weights", "sample"),
)
"""Beginnings of the labels of results and of the names of pieces of work."""


@dataclass(frozen=True)
class Parameter:
    """A parameter of the model: nominal value and bounds."""

    name: str
    nominal: float
    lower: float
    upper: float


@dataclass(frozen=True)
class Weighted:
    """Weights w_i that the user gives; the name labels the model found with them."""

    name: str
    weights: tuple[float, ...]


@dataclass(frozen=True)
class Study:
    """All that a study file says.

    Attributes
    ----------
    file : where it was read
    digest : hash of this file and of all files that it names
    method, points : how the front is found, and with how many points along each edge
    tolerance : share by which an edge may exceed the least value of its group
    weighted : models wanted with given weights, besides equal and optimal ones
    """

    file: Path
    name: str
    seed: int
    digest: str
    parameters: tuple[Parameter, ...]
    problem: UpdatingProblem
    method: str
    points: int
    tolerance: float
    weighted: tuple[Weighted, ...]
    search: Search


def load(path: Path) -> Study:
    """Read a study file and all files that it names.

    Raises InputError with everything that is wrong.
    """
    values, content = _parse(path)
    faults: list[Fault] = []
    root = Table(str(path), "", values, faults)
    header = root.table("study", "a table [study]")
    title, seed = "", 0
    if header:
        title = header.text("name") or ""
        seed = header.integer("seed", 0, 2**63 - 1, default=0)
        header.close()
    parameters = _parameters(root)
    names = [one.name for one in parameters]
    model = _model(root, names, path.parent)
    data, data_file = _data(root, model, path.parent)
    groups = _groups(root, data)
    weights = _weights(root, [group.name for group in groups if group.name])
    method, points, tolerance = _pareto(root)
    pairing, search = _pairing(root), _search(root)
    root.close()
    if faults or model is None or data is None:
        raise InputError(faults)
    problem = UpdatingProblem(
        model,
        data,
        groups,
        np.array([one.lower for one in parameters]),
        np.array([one.upper for one in parameters]),
        np.array([one.nominal for one in parameters]),
        pairing,
    )
    _try_model(root, problem)
    if faults:
        raise InputError(faults)
    digest = _digest(content, path.parent, [data_file, *_model_files(values)])
    return Study(
        path, title, seed, digest, parameters, problem, method, points, tolerance, weights, search
    )


def _parse(path: Path) -> tuple[dict[str, Any], bytes]:
    try:
        content = path.read_bytes()
        return tomllib.loads(content.decode("utf-8-sig")), content
    except FileNotFoundError:
        raise InputError(Fault(str(path), "file", "a study file", "no such file")) from None
    except IsADirectoryError:
        raise InputError(Fault(str(path), "file", "a study file", "a folder")) from None
    except (OSError, ValueError, RecursionError) as error:
        raise InputError(Fault(str(path), "file", "TOML in UTF-8", str(error))) from None


def _parameters(root: Table) -> tuple[Parameter, ...]:
    out = []
    tables = root.tables("parameter", required=True)
    for table in tables:
        name = table.text("name", "the name of the parameter")
        bounds = table.numbers(
            "bounds",
            "[lower, upper], two finite numbers with lower < upper",
            lambda x: len(x) == 2 and x[0] < x[1],
        )
        nominal = table.number("nominal", "a finite number", math.isfinite)
        if bounds is not None and nominal is not None and not bounds[0] <= nominal <= bounds[1]:
            inside = f"a value within its bounds, {bounds[0]:g} to {bounds[1]:g}"
            table.fault("nominal", inside, f"{nominal:g}")
        if name == "base":
            table.fault("name", "another name: 'base' is the constant term", "'base'")
        table.close()
        lower, upper = bounds or (0.0, 1.0)
        out.append(Parameter(name or "", 0.0 if nominal is None else nominal, lower, upper))
    for name in repeated(table.values.get("name") for table in tables if _is_name(table)):
        root.fault("[[parameter]]", "each name once", f"'{name}' twice")
    return tuple(out)


def _is_name(table: Table) -> bool:
    return isinstance(table.values.get("name"), str)


def _model(root: Table, parameters: Sequence[str], folder: Path) -> Model | None:
    table = root.table("model", "a table [model]")
    if table is None:
        return None
    kind = table.choice("kind", tuple(KINDS))
    if kind is None:
        return None
    model = KINDS[kind](table, parameters, folder)
    table.close()
    return model


def _data(root: Table, model: Model | None, folder: Path) -> tuple[ModalData | None, str]:
    table = root.table("data", "a table [data]")
    if table is None:
        return None, ""
    name = table.text("file", "the name of a file of modal data")
    table.close()
    if name is None:
        return None, ""
    if not name.lower().endswith(".csv"):
        table.fault("file", "a file that ends in .csv", f"'{name}'")
        return None, ""
    try:
        # Without a model all columns may be sensors: what else is wrong is found nevertheless.
        data = read_csv(folder / name, model.sensors if model else None)
    except InputError as error:
        root.faults.extend(error.faults)
        return None, ""
    if model and len(data.modes) > model.size:
        found = f"{len(data.modes)} in '{name}'"
        root.fault("[data] file", f"at most {model.size} modes, as the model has", found)
    return data, name


def _groups(root: Table, data: ModalData | None) -> tuple[Group, ...]:
    out = []
    tables = root.tables("group", required=True)
    expected = "'all' or a list of measured modes, counted from 1"
    for table in tables:
        before = len(root.faults)
        name = table.text("name", "the name of the group") or ""
        chosen = {}
        for key, measured in (("frequency", measured_frequencies), ("shape", measured_shapes)):
            value = table.take(key, expected, _is_members, [])
            if data is not None:
                try:
                    members(value, data.modes, measured(data))
                except ValueError as error:
                    wanted, _, found = str(error).partition(", found ")
                    table.fault(key, wanted, found)
                    value = []
            chosen[key] = value if value == "all" else tuple(value)
        table.close()
        group = Group(name, chosen["frequency"], chosen["shape"])
        if not (group.frequency or group.shape):
            if len(root.faults) == before:
                table.fault("", "frequency or shape with at least one measured mode", "neither")
        elif data is not None and not (
            members(group.frequency, data.modes, measured_frequencies(data))
            or members(group.shape, data.modes, measured_shapes(data))
        ):
            table.fault("", "at least one measured property", "none in the data")
        out.append(group)
    for name in repeated(table.values.get("name") for table in tables if _is_name(table)):
        root.fault("[[group]]", "each name once", f"'{name}' twice")
    return tuple(out)


def _is_members(value: object) -> bool:
    return value == "all" or (
        isinstance(value, list)
        and all(isinstance(x, int) and not isinstance(x, bool) and x > 0 for x in value)
    )


def _weights(root: Table, groups: Sequence[str]) -> tuple[Weighted, ...]:
    out = []
    tables = root.tables("weighted", required=False)
    for table in tables:
        name = table.text("name", "a label for the model found with these weights") or ""
        weights = table.table("weights", "a table of weights, group = weight above 0")
        table.close()
        if weights is None:
            continue
        for key, value in weights.values.items():
            if key not in groups:
                weights.fault(key, "the name of a group", suggestion(key, groups))
            elif not (is_number(value) and value > 0):
                weights.fault(key, "a weight above 0", describe(value))
        missing = [group for group in groups if group not in weights.values]
        for group in missing:
            weights.fault(group, "a weight above 0", "nothing")
        if not missing and all(is_number(weights.values[group]) for group in groups):
            out.append(Weighted(name, tuple(float(weights.values[g]) for g in groups)))
    names = [str(table.values["name"]) for table in tables if _is_name(table)]
    for label in repeated(names):
        root.fault("[[weighted]]", "each name once", f"'{label}' twice")
    for label in names:
        if label.startswith(RESERVED):
            expected = f"a name that does not begin with one of {', '.join(RESERVED)}"
            root.fault("[[weighted]]", expected, f"'{label}'")
    return tuple(out)


def _pareto(root: Table) -> tuple[str, int, float]:
    table = root.table("pareto", default=None)
    if table is None:
        return METHODS[0], POINTS, 0.0
    method = table.choice("method", METHODS, default=METHODS[0])
    points = table.integer("points", 2, 10_000, default=POINTS)
    tolerance = table.number("tolerance", "a share from 0 to 1", lambda x: 0 <= x <= 1, default=0.0)
    table.close()
    return method, points, tolerance


def _pairing(root: Table) -> Pairing:
    table = root.table("pairing", default=None)
    if table is None:
        return Pairing()
    method = table.choice("method", ("mac", "order"), default="mac")
    window = table.number("window", "a ratio of frequencies above 1", lambda x: x > 1, default=None)
    spare = table.integer("spare", 0, 1000, default=Pairing.spare)
    table.close()
    return Pairing(method, window, spare)


def _search(root: Table) -> Search:
    table = root.table("search", default=None)
    if table is None:
        return Search()
    before = len(root.faults)
    starts = table.integer("starts", 1, 10**6, default=Search.starts)
    limit = table.integer("limit", 1, 10**6, default=max(Search.limit, starts))
    evolutions = table.integer("evolutions", 0, 10**6, default=Search.evolutions)
    if limit < starts and len(root.faults) == before:
        table.fault("limit", f"at least starts, {starts}", str(limit))
    table.close()
    return Search(starts, limit, evolutions)


def _try_model(root: Table, problem: UpdatingProblem) -> None:
    """Note what only an evaluation shows: an indefinite matrix, a parameter without effect."""
    for name in problem.model.unused:
        root.fault(f"[[parameter]] '{name}'", "a parameter that the model uses", "no use of it")
    try:
        problem.modes(problem.start, derivatives=False)
    except ModelError as error:
        root.fault("[model]", "modes at the nominal parameters", str(error))


def _model_files(values: dict[str, Any]) -> list[str]:
    model = values["model"]
    tables = [model.get(key) for key in ("stiffness", "mass")]
    files = [file for table in tables if isinstance(table, dict) for file in table.values()]
    return [*files, model["file"]] if "file" in model else files


def _digest(content: bytes, folder: Path, files: Sequence[str]) -> str:
    """Return a hash of the study file and of all files that it names."""
    total = hashlib.sha256(content)
    for name in files:
        total.update(hashlib.sha256((folder / name).read_bytes()).digest())
    return total.hexdigest()
