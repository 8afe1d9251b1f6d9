"""The study file: TOML in, a study out, or all of its faults."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from modefront.errors import InputError, ModelError
from modefront.findings.record import Finding
from modefront.front.options import Pareto
from modefront.front.search import Search
from modefront.identifiability.options import Identifiability
from modefront.models.base import full_of
from modefront.models.matrices import MatrixModel, of_free
from modefront.pairing.match import Pairing
from modefront.residuals.problem import UpdatingProblem
from modefront.study.definition import Origin, Study, undrawn
from modefront.study.measured import read_data
from modefront.study.tables import (
    complete,
    read_groups,
    read_header,
    read_model,
    read_options,
    read_parameters,
    read_predictions,
    read_weights,
)
from modefront.toml import Table, read_toml
from modefront.uncertainty.options import Uncertainty
from modefront.uncertainty.prior import NoisePrior


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
    root, content = read_toml(Path(path), "a study file")
    faults = root.faults
    header = root.table("study", "a table [study]")
    names, parameters = read_parameters(root)
    model, reduction = read_model(root, header, names)
    if model is not None and not faults:
        model, parameters = of_free(model, parameters)
    title, seed = read_header(header)
    data = read_data(root, model)
    groups = read_groups(root, data)
    pareto = read_options(root, "pareto", Pareto)
    weighted = read_weights(root, [group.name for group in groups if group.name])
    search = read_options(root, "search", Search)
    identifiability = read_options(root, "identifiability", Identifiability)
    uncertainty = read_options(root, "uncertainty", Uncertainty)
    drawn = replace(root, place="[uncertainty]")
    drawn.note(undrawn(uncertainty, bool(root.values.get("predict"))))
    drawn.note(uncertainty.faults(data) if data is not None else ())
    noise = read_options(root, "noise", NoisePrior)
    pairing = read_options(root, "pairing", Pairing)
    drafts, slack = read_predictions(root, model, data)
    replace(root, place="[pareto]").note(pareto.faults(len(groups)))
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
    front = {key: value for key, value in root.values.items() if key != "predict"}
    kept = {key: value for key, value in front.pop("uncertainty", {}).items() if key != "draws"}
    front |= {"uncertainty": kept} if kept else {}
    origin = Origin(
        Path(path),
        _digest(content, root.files),
        _digest(json.dumps(front, sort_keys=True).encode(), root.files),
        problem,
        reduction.fallback(problem.model),
        tuple(note for note in root.notes if isinstance(note, Finding)),
    )
    return Study(
        problem,
        title,
        seed,
        pareto=pareto,
        weighted=weighted,
        search=search,
        identifiability=identifiability,
        uncertainty=uncertainty,
        predictions=predictions,
        noise=noise,
        slack=slack,
        origin=origin,
    )


def _try_model(root: Table, problem: UpdatingProblem) -> None:
    """Note what only an evaluation shows: an indefinite matrix, a parameter without effect."""
    for name in problem.model.unused:
        root.fault(f"[[parameter]] '{name}'", "a parameter that the model uses", "no use of it")
    model = full_of(problem.model)
    above_zero = model.above_zero if isinstance(model, MatrixModel) else ()
    before = len(root.faults)
    for name in above_zero:
        lower = float(problem.lower[problem.model.parameters.index(name)])
        if lower <= 0:
            expected = "a lower bound above 0, as terms of the matrices have quotients or roots"
            root.fault(f"[[parameter]] '{name}' bounds", f"{expected} of it", f"{lower:g}")
    if len(root.faults) > before:
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
    """Return a hash of what the study file says and of all files that were read for it."""
    total = hashlib.sha256(content)
    for path in files:
        with path.open("rb") as stream:
            total.update(hashlib.file_digest(stream, "sha256").digest())
    return total.hexdigest()
