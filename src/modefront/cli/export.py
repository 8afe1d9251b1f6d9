"""``modefront export``: finds the study of results, and writes one of its models."""

from __future__ import annotations

import shutil
import tempfile
import tomllib
from pathlib import Path

from modefront.cli.terminal import say
from modefront.errors import Fault, InputError, ModelError, UnfinishedError, reason, suggestion
from modefront.exports.model import Origin, matrix_size, write_model
from modefront.models.dofs import read_dofs
from modefront.programs.changes import read_changes
from modefront.programs.mesh import read_mesh
from modefront.results.files import FILE, read_dataset
from modefront.results.results import Results
from modefront.study.whereabouts import find_study, given_study
from modefront.text import file_name


def run_export(
    directory: Path, point: str | None, study: Path | None, output: Path | None, modes: int | None
) -> None:
    """Write a model of the results in a folder into another folder."""
    data = read_dataset(directory)
    labels = [str(label) for label in data["label"].values]
    point = point or str(data.attrs["reference"])
    if point not in labels:
        nearest = suggestion(point, labels)
        raise InputError(Fault(str(directory / FILE), "--point", "the label of a model", nearest))
    name, digest = (str(data.attrs.get(key, "")) for key in ("study", "inputs"))
    loaded = given_study(directory, study, digest) if study else find_study(directory, name, digest)
    results = Results(data, loaded.problem)
    model = results.model(point)
    output = output or directory / file_name(f"export-{point}")
    try:
        count = min(modes or max(len(model.frequency), 1), matrix_size(model))
        output.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=output, prefix=".export-") as name:
            missing = write_model(model, _origin(loaded.file), Path(name), count)
            files = sorted(Path(name).iterdir())
            for file in files:
                shutil.move(file, output / file.name)
                say(f"wrote {output / file.name}")
    except ModelError as error:
        raise UnfinishedError(str(error)) from None
    except OSError as error:
        expected = "a folder that can be written to"
        raise InputError(Fault(str(output), "folder", expected, reason(error))) from None
    for what in missing:
        say(f"not written: {what}")


def _origin(file: Path) -> Origin:
    """Return the mesh, labels and changed lines that an imported study keeps of its program."""
    table = tomllib.loads(file.read_text("utf-8-sig")).get("model", {})
    if table.get("kind") != "matrices":
        return Origin(None, None, ())
    dofs, mesh = (table.get(key) for key in ("dofs", "mesh"))
    changes = file.parent / "changes.json"
    return Origin(
        read_dofs(file.parent / dofs) if dofs else None,
        read_mesh(file.parent / mesh) if mesh else None,
        read_changes(changes) if changes.is_file() else (),
    )
