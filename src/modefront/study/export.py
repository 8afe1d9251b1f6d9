"""A model of results as files, with the study of the results."""

from __future__ import annotations

import shutil
import tempfile
import tomllib
from dataclasses import dataclass
from pathlib import Path

from modefront.brief import as_html, brief
from modefront.errors import Fault, InputError, ModelError, UnfinishedError, reason, suggestion
from modefront.exports.model import Origin, matrix_size, write_model
from modefront.models.dofs import read_dofs
from modefront.programs.changes import read_changes, write_deck
from modefront.programs.mesh import read_mesh
from modefront.results.files import FILE, read_dataset
from modefront.results.results import Results
from modefront.study.whereabouts import find_study, given_study
from modefront.text import file_name


@dataclass(frozen=True, repr=False)
class Exported:
    """What was written of a model.

    Attributes
    ----------
    label : of the model
    files : that were written
    missing : what was not written, and why
    """

    label: str
    files: tuple[Path, ...]
    missing: tuple[str, ...]

    __repr__ = brief
    _repr_html_ = as_html


def export(
    folder: Path | str,
    output: Path | str | None = None,
    *,
    point: str | None = None,
    study: Path | str | None = None,
    modes: int | None = None,
) -> Exported:
    """Write a model of results: parameters, matrices, mode shapes, the deck with its values.

    Parameters
    ----------
    folder
        Folder of the results.
    output
        Folder for the files; ``export-LABEL`` among the results unless given.
    point
        Label of the model; the one that the data prefer unless given.
    study
        File of the study of the results; found where it was run unless given.
    modes
        Number of mode shapes; as many as were measured unless given.

    Raises
    ------
    InputError
        For a label that there is not, without the study, and for a folder that cannot be written.
    UnfinishedError
        For a model without matrices or modes.
    """
    folder = Path(folder)
    data = read_dataset(folder)
    labels = [str(label) for label in data["label"].values]
    point = point or str(data.attrs["reference"])
    if point not in labels:
        nearest = suggestion(point, labels)
        raise InputError(Fault(str(folder / FILE), "--point", "the label of a model", nearest))
    name, digest = (str(data.attrs.get(key, "")) for key in ("study", "inputs"))
    loaded = given_study(folder, Path(study), digest) if study else find_study(folder, name, digest)
    model = Results(data, loaded.problem).model(point)
    output = Path(output) if output else folder / file_name(f"export-{point}")
    try:
        count = min(modes or max(len(model.frequency), 1), matrix_size(model))
        output.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=output, prefix=".export-") as unfinished:
            missing = write_model(model, _origin(loaded.file), Path(unfinished), count)
            write_deck(loaded.file.parent, model.theta, Path(unfinished))
            files = sorted(Path(unfinished).iterdir())
            moved = tuple(Path(shutil.move(file, output / file.name)) for file in files)
    except ModelError as error:
        raise UnfinishedError(str(error)) from None
    except OSError as error:
        expected = "a folder that can be written to"
        raise InputError(Fault(str(output), "folder", expected, reason(error))) from None
    return Exported(point, moved, tuple(missing))


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
