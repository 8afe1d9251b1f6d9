"""The study file: TOML in, a study out, or everything that is wrong with it."""

from __future__ import annotations

import hashlib
import json
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from modefront.errors import Fault, InputError, ModelError
from modefront.models.matrices import MatrixModel
from modefront.models.reduced.model import MEMORY, ReducedModel
from modefront.predict import Prediction
from modefront.residuals.problem import UpdatingProblem
from modefront.solvers.explore import Search
from modefront.study.tables.data import read_data
from modefront.study.tables.groups import read_groups
from modefront.study.tables.identifiability import Identifiability, read_identifiability
from modefront.study.tables.model import read_model
from modefront.study.tables.parameters import Parameter, read_parameters
from modefront.study.tables.predict import complete, read_predictions
from modefront.study.tables.reduction import fallback, read_memory, reduced
from modefront.study.tables.settings import (
    Pareto,
    check_size,
    read_pairing,
    read_pareto,
    read_search,
)
from modefront.study.tables.uncertainty import Uncertainty, read_uncertainty
from modefront.study.tables.weighted import Weighted, read_weights
from modefront.toml import Table


@dataclass(frozen=True)
class Study:
    """All that a study file says.

    Attributes
    ----------
    file : where it was read
    digest : hash of this file and of all files that it names
    work : the same for what the front depends on: all that it says but for predictions and draws
    pareto : how the front is found
    weighted : models wanted with given weights, besides equal and optimal ones
    identifiability : what is done about what the data do not determine
    uncertainty : what is done about errors of the data
    predictions : what all models that are found are to predict
    remark : why what was asked for is not done
    """

    file: Path
    name: str
    seed: int
    digest: str
    work: str
    parameters: tuple[Parameter, ...]
    problem: UpdatingProblem
    pareto: Pareto
    weighted: tuple[Weighted, ...]
    search: Search
    identifiability: Identifiability
    uncertainty: Uncertainty
    predictions: tuple[Prediction, ...]
    remark: str = ""


def load(path: Path) -> Study:
    """Read a study file and all files that it names.

    Raises InputError with everything that is wrong.
    """
    values, content = _parse(path)
    faults: list[Fault] = []
    root = Table(str(path), "", values, faults)
    header = root.table("study", "a table [study]")
    title, seed, memory = "", 0, MEMORY
    if header:
        title = header.text("name") or ""
        seed = header.integer("seed", 0, 2**63 - 1, default=0)
        memory = read_memory(header)
        header.close()
    parameters = read_parameters(root)
    names = [one.name for one in parameters]
    model, reduction = read_model(root, names, path.parent)
    data, data_file = read_data(root, model, path.parent)
    groups = read_groups(root, data)
    weights = read_weights(root, [group.name for group in groups if group.name])
    pareto, pairing, search = read_pareto(root), read_pairing(root), read_search(root)
    identifiability, uncertainty = read_identifiability(root), read_uncertainty(root, data)
    drafts = read_predictions(root, model, data)
    check_size(root, pareto, len(groups))
    root.close()
    if faults or model is None or data is None:
        raise InputError(faults)
    problem = UpdatingProblem(
        reduced(model, reduction, memory, data, pairing, parameters),
        data,
        groups,
        np.array([one.lower for one in parameters]),
        np.array([one.upper for one in parameters]),
        np.array([one.nominal for one in parameters]),
        pairing,
    )
    _try_model(root, problem)
    predictions = complete(drafts, problem) if not faults else ()
    if faults:
        raise InputError(faults)
    files = [data_file, *_model_files(values)]
    digest = _digest(content, path.parent, files)
    rest = json.dumps(_without_predictions(values), sort_keys=True)
    work = _digest(rest.encode(), path.parent, files)
    remark = fallback(problem.model, reduction)
    return Study(
        *(path, title, seed, digest, work, parameters, problem, pareto, weights, search),
        *(identifiability, uncertainty, predictions, remark),
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


def _try_model(root: Table, problem: UpdatingProblem) -> None:
    """Note what only an evaluation shows: an indefinite matrix, a parameter without effect."""
    for name in problem.model.unused:
        root.fault(f"[[parameter]] '{name}'", "a parameter that the model uses", "no use of it")
    try:
        problem.modes(problem.start, derivatives=False)
    except ModelError as error:
        root.fault("[model]", "modes at the nominal parameters", str(error))
        return
    model = problem.model.full if isinstance(problem.model, ReducedModel) else problem.model
    if isinstance(model, MatrixModel) and not model.floating and model.is_singular(problem.start):
        expected = "a structure that is held, or floating = true for rigid-body modes"
        root.fault("[model]", expected, "a singular stiffness matrix at the nominal parameters")


def _model_files(values: dict[str, Any]) -> list[str]:
    model = values["model"]
    tables = [model.get(key) for key in ("stiffness", "mass")]
    terms = [term for table in tables if isinstance(table, dict) for term in table.values()]
    files = [term["file"] if isinstance(term, dict) else term for term in terms]
    return [*files, model["file"]] if "file" in model else files


def _without_predictions(values: dict[str, Any]) -> dict[str, Any]:
    """Return what a study file says but for what is predicted, and with how many draws."""
    rest = {key: value for key, value in values.items() if key != "predict"}
    uncertainty = dict(rest.pop("uncertainty", {}))
    uncertainty.pop("draws", None)
    return rest | ({"uncertainty": uncertainty} if uncertainty else {})


def _digest(content: bytes, folder: Path, files: Sequence[str]) -> str:
    """Return a hash of what the study file says and of all files that it names."""
    total = hashlib.sha256(content)
    for name in files:
        total.update(hashlib.sha256((folder / name).read_bytes()).digest())
    return total.hexdigest()
