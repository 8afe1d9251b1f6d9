"""The study file: TOML in, a study out, or all of its faults."""

from __future__ import annotations

import hashlib
import json
import tomllib
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from modefront.data.modal import ModalData
from modefront.diagnosis.notes import DataDirection, UnusedGroup
from modefront.errors import Fault, InputError, ModelError, reason
from modefront.front.options import Pareto
from modefront.front.search import Search
from modefront.identifiability.options import Identifiability
from modefront.inputs import MOST_TABLES, read_text_bytes
from modefront.models.base import full_of
from modefront.models.matrices import MatrixModel, of_free
from modefront.pairing.match import Pairing
from modefront.residuals.problem import UpdatingProblem
from modefront.study.definition import Origin, Study, undrawn
from modefront.study.labels import labels_of
from modefront.study.tables.data import read_data
from modefront.study.tables.groups import read_groups
from modefront.study.tables.model import read_model
from modefront.study.tables.options import note, read_options
from modefront.study.tables.parameters import read_parameters
from modefront.study.tables.predict import complete, read_predictions
from modefront.study.tables.weighted import read_weights
from modefront.toml import Table
from modefront.uncertainty.options import Uncertainty
from modefront.uncertainty.prior import NoisePrior


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
    path = Path(path)
    values, content = _parse(path)
    faults: list[Fault] = []
    root = Table(str(path), "", values, faults)
    header = root.table("study", "a table [study]")
    names, parameters = read_parameters(root)
    model, reduction = read_model(root, header, names)
    if model is not None and not faults:
        model, parameters = of_free(model, parameters)
    title, seed = _read_header(header)
    data = read_data(root, model)
    groups = read_groups(root, data)
    objectives = [group.name for group in groups if group.name]
    pareto = read_options(root, "pareto", Pareto)
    weighted = read_weights(root, objectives, labels_of(objectives))
    search = read_options(root, "search", Search)
    identifiability = read_options(root, "identifiability", Identifiability)
    uncertainty = _read_uncertainty(root, data)
    noise = read_options(root, "noise", NoisePrior)
    pairing = read_options(root, "pairing", Pairing)
    drafts = read_predictions(root, model, data)
    note(_place(root, "[pareto]"), pareto.faults(len(groups)))
    root.close()
    if faults or model is None or data is None:
        raise InputError(faults)
    problem = UpdatingProblem(
        reduction.of(model, data, pairing, parameters),
        data,
        groups,
        np.array([each.lower for each in parameters]),
        np.array([each.upper for each in parameters]),
        np.array([each.nominal for each in parameters]),
        pairing,
        priors=tuple(each.prior for each in parameters),
    )
    _try_model(root, problem)
    predictions = complete(drafts, problem) if not faults else ()
    if faults:
        raise InputError(faults)
    front = json.dumps(_without_predictions(values), sort_keys=True)
    origin = Origin(
        path,
        _digest(content, root.files),
        _digest(front.encode(), root.files),
        problem,
        reduction.fallback(problem.model),
        tuple(note for note in root.notes if isinstance(note, UnusedGroup | DataDirection)),
    )
    return Study(
        *(problem, title, seed, pareto, weighted, search, identifiability, uncertainty),
        *(predictions, noise, origin),
    )


def _read_header(header: Table | None) -> tuple[str, int]:
    """Return name and seed of the table ``[study]``; its memory is read elsewhere."""
    if header is None:
        return "", 0
    name = header.text("name", "a text of printable characters") or ""
    seed: int = header.integer("seed", 0, 2**63 - 1, default=0)
    header.close()
    return name, seed


def _read_uncertainty(root: Table, data: ModalData | None) -> Uncertainty:
    """Return how errors of the data are carried; these have to be known."""
    uncertainty = read_options(root, "uncertainty", Uncertainty)
    place = _place(root, "[uncertainty]")
    note(place, undrawn(uncertainty, len(root.values.get("predict") or ())))
    if data is not None:
        note(place, uncertainty.faults(data))
    return uncertainty


def _place(root: Table, place: str) -> Table:
    """Return where faults of a table are noted that is read already."""
    return replace(root, place=place)


def _parse(path: Path) -> tuple[dict[str, Any], bytes]:
    content = read_text_bytes(path, "a study file", MOST_TABLES)
    try:
        return tomllib.loads(content.decode("utf-8-sig")), content
    except (ValueError, RecursionError) as error:
        raise InputError(Fault(str(path), "file", "TOML in UTF-8", reason(error))) from None


def _try_model(root: Table, problem: UpdatingProblem) -> None:
    """Note what only an evaluation shows: an indefinite matrix, a parameter without effect."""
    for name in problem.model.unused:
        root.fault(f"[[parameter]] '{name}'", "a parameter that the model uses", "no use of it")
    if _refuses_zero(root, problem):
        return
    try:
        problem.modes(problem.start, derivatives=False)
    except ModelError as error:
        root.fault("[model]", "modes at the nominal parameters", str(error))
        return
    model = full_of(problem.model)
    if isinstance(model, MatrixModel) and not model.floating and model.is_singular(problem.start):
        expected = "a structure that is held, or floating = true for rigid-body modes"
        root.fault("[model]", expected, "a singular stiffness matrix at the nominal parameters")


def _refuses_zero(root: Table, problem: UpdatingProblem) -> bool:
    """Note bounds of 0 or less of parameters with roots or quotients; return whether any are."""
    model = full_of(problem.model)
    names = model.above_zero if isinstance(model, MatrixModel) else ()
    before = len(root.faults)
    for name in names:
        lower = float(problem.lower[problem.model.parameters.index(name)])
        if lower <= 0:
            expected = (
                "a lower bound above 0, as terms of the matrices have quotients or roots of it"
            )
            root.fault(f"[[parameter]] '{name}' bounds", expected, f"{lower:g}")
    return len(root.faults) > before


def _without_predictions(values: dict[str, Any]) -> dict[str, Any]:
    """Return the contents of a study file without the predictions and their number of draws."""
    rest = {key: value for key, value in values.items() if key != "predict"}
    uncertainty = dict(rest.pop("uncertainty", {}))
    uncertainty.pop("draws", None)
    return rest | ({"uncertainty": uncertainty} if uncertainty else {})


def _digest(content: bytes, files: Sequence[Path]) -> str:
    """Return a hash of what the study file says and of all files that were read for it."""
    total = hashlib.sha256(content)
    for path in files:
        with path.open("rb") as stream:
            total.update(hashlib.file_digest(stream, "sha256").digest())
    return total.hexdigest()
