"""A model of results as files, with the study of the results."""

import json
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import scipy.io
import scipy.sparse

from modefront._typing import Floats, Ints
from modefront.data.uff import dataset_55
from modefront.errors import InputError, ModelError, UnfinishedError, suggestion, writing
from modefront.front.point import preferred
from modefront.inputs import read_text_bytes, wrong
from modefront.models.dofs import DofTable, motion_of_nodes, read_dofs, write_dofs
from modefront.models.geometry import Cells
from modefront.options import read_toml
from modefront.outputs import output as written
from modefront.outputs import write_table, write_text
from modefront.programs.base import ProgramMesh, read_mesh
from modefront.programs.changes import CHANGES, read_changes, write_deck
from modefront.results.files import FILE, read_dataset
from modefront.results.remarks import verdict
from modefront.results.results import ReportedModel, Results
from modefront.results.shapes import write_grid
from modefront.study.definition import Study
from modefront.study.file import load
from modefront.text import Shown, file_name
from modefront.work.store import FOLDER, NOTE

ELEMENTS = {"line": 11, "triangle": 91, "quad": 94, "tetra": 111, "wedge": 112, "hexahedron": 115}
"""Identifiers of dataset 2412: rod, thin shells, solids; others are left out."""


@dataclass(frozen=True, repr=False)
class Exported(Shown):
    """What was written of a model.

    Attributes
    ----------
    label : of the model
    files : that were written
    missing : what was not written, and why
    warning : why the verdict refuses the models of the results; empty where it does not
    """

    label: str
    files: tuple[Path, ...]
    missing: tuple[str, ...]
    warning: str = ""


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
    point = point or preferred(data.attrs)
    if point not in labels:
        nearest = suggestion(point, labels)
        raise wrong(folder / FILE, "the label of a model", nearest, "--point")
    name, digest = (str(data.attrs.get(key, "")) for key in ("study", "inputs"))
    if not digest:
        expected = "results of a study in a file (of others, results.model(label) has the matrices)"
        raise wrong(folder / FILE, expected, f"'{name}', made in Python", "study")
    if study is None:
        loaded = _find_study(folder, name, digest)
    elif (loaded := load(study)).digest != digest:
        expected = f"the study of the results in '{folder}'"
        raise wrong(Path(study), expected, "other inputs: run it again", "study")
    model = Results(data, loaded.problem).model(point)
    warning = "" if data.attrs["reference"] else verdict(data)[0]
    output = Path(output) if output else folder / file_name(f"export-{point}")
    try:
        # As many modes as there are degrees of freedom with mass.
        most = int(np.count_nonzero(model.mass.diagonal()))
        count = min(modes or max(len(model.frequency), 1), most)
        with writing(output):
            output.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryDirectory(dir=output, prefix=".export-") as unfinished:
                missing = _write(model, loaded.file, Path(unfinished), count, warning)
                deck = write_deck(loaded.file.parent, model.parameters, Path(unfinished))
                missing += [deck] if deck else []
                files = sorted(Path(unfinished).iterdir())
                moved = tuple(Path(shutil.move(file, output / file.name)) for file in files)
    except ModelError as error:
        raise UnfinishedError(str(error)) from None
    return Exported(point, moved, tuple(missing), warning)


def _find_study(results: Path, name: str, digest: str) -> Study:
    """Return the study of results: where the run says, beside them, above them or here.

    Raises InputError where there is none of this name with these inputs, with the files that were
    found, or what is wrong with the only one.
    """
    files, absolute = [], results.absolute()
    for note in sorted((results / FOLDER).glob(f"*/{NOTE}")):
        with suppress(InputError, UnicodeDecodeError):
            text = read_text_bytes(note, "the path of a study file", 4096).decode().strip()
            if text.isprintable() and text.endswith(".toml"):
                files.append(Path(os.path.normpath(results / text)))
    for folder in (results, *absolute.parents[:3], Path.cwd()):
        files += sorted(folder.glob("*.toml"))
    files += sorted(absolute.parent.glob("*/*.toml"))
    changed: list[Path] = []
    broken: InputError | None = None
    for file in dict.fromkeys(files):
        try:
            root, _ = read_toml(file, "a study file")
            if root.values["study"]["name"] != name:
                continue
        except (InputError, KeyError, TypeError):
            continue
        try:
            if (study := load(file)).digest == digest:
                return study
            changed.append(file)
        except InputError as error:
            broken = broken or error
    if broken and not changed:
        raise broken
    expected = f"the study '{name}' where it was run, beside the results or in this folder"
    found = "none: pass --study FILE"
    if changed:
        named = " and ".join(f"'{file}'" for file in changed[:3])
        found = f"{named} with other inputs than those of the results: changed since the run"
        expected = f"the study '{name}' as it was run (pass --study FILE, or run it again)"
    raise wrong(results, expected, found, "study")


def _write(model: ReportedModel, study: Path, folder: Path, modes: int, warning: str) -> list[str]:
    """Write all files of a model into a folder that is there; return what could not be written.

    Raises ModelError where the model has no matrices or no such modes.
    """
    values = {name: float(value) for name, value in model.parameters.items()}
    rows = [(name, repr(value)) for name, value in values.items()]
    write_table(folder / "parameters.csv", [("parameter", "value"), *rows])
    content = {"label": model.label, "kind": model.kind, "parameters": values}
    content |= {"warning": warning} if warning else {}
    write_text(folder / "parameters.json", json.dumps(content, indent=2, ensure_ascii=False) + "\n")
    for name, A in (("K", model.stiffness), ("M", model.mass)):
        matrix = scipy.sparse.coo_array(A)
        matrix.eliminate_zeros()
        with written(folder / f"{name}.npz") as stream:
            scipy.sparse.save_npz(stream, matrix.tocsr())
        with written(folder / f"{name}.mtx") as stream:
            scipy.io.mmwrite(stream, matrix, symmetry="symmetric", precision=17)
    # What an imported study keeps of its program.
    table = read_toml(study, "a study file")[0].values["model"]
    of_program = table if table.get("kind") == "matrices" else {}
    if "dofs" not in of_program:
        return ["dofs.csv, modes.vtu and modes.uff: the study names no nodes (dofs)"]
    dofs = read_dofs(study.parent / of_program["dofs"])
    write_dofs(folder / "dofs.csv", dofs)
    mesh = read_mesh(study.parent / of_program["mesh"]) if "mesh" in of_program else None
    shapes = model.modes(modes)
    number, motion = node_motion(dofs, mesh, shapes.shape)
    turns = bool(((dofs.direction > 3) & np.isin(dofs.node, number)).any())
    moved, missing = motion if turns else motion[:, :, :3], []
    with written(folder / "modes.uff") as stream:
        stream.write("".join(_uff(mesh, number, moved, shapes.frequency)).encode())
    if mesh is None:
        missing.append("modes.vtu: the study names no mesh")
    elif find_spec("meshio") is None:
        missing.append("modes.vtu: meshio is not installed: pip install modefront[mesh]")
    else:
        named = enumerate(zip(shapes.frequency, motion, strict=True), start=1)
        data = {f"mode {k}, {f:.6g} Hz": values[:, :3] for k, (f, values) in named}
        cells = [Cells(x, x, np.searchsorted(number, at)) for x, at in mesh.cells.items()]
        write_grid(folder / "modes.vtu", mesh.coordinates, cells, {**data, "node": number})
    known = study.parent / CHANGES
    changes = read_changes(known) if known.is_file() else []
    lines = [f"updated values, model '{model.label}'", *[warning] * bool(warning)]
    for name, value in values.items():
        own = [x for x in changes if x.parameter == name]
        said = [f"  {x.file}, line {x.line}:\n  {x.updated(value).strip()}" for x in own]
        said = said or ["  a factor of what was changed for this parameter"]
        lines += ["", f"{name} = {value:.9g}", *said]
    write_text(folder / "deck.txt", "\n".join(lines) + "\n")
    return missing


def node_motion(dofs: DofTable, mesh: ProgramMesh | None, shapes: Floats) -> tuple[Ints, Floats]:
    """Return the numbers of nodes and their motion in shapes (N, modes).

    The nodes are those of a mesh, or of ``dofs`` without one. Motion (modes, nodes, 6) are
    displacements x, y, z and rotations; 0 where a node cannot move.
    """
    number = np.unique(dofs.node[dofs.node > 0]) if mesh is None else mesh.number
    motion = np.asarray(motion_of_nodes(dofs, number) @ shapes)
    return number, motion.T.reshape(-1, number.size, 6)


def _uff(
    mesh: ProgramMesh | None, number: Ints, motion: Floats, frequencies: Floats
) -> Iterator[str]:
    """Yield nodes, elements and real, mass-normalised modes in Hz as datasets of a UFF file."""
    ending = "    -1\n"
    if mesh is not None:
        yield f"{ending}{2411:6d}\n"
        for node, point in zip(number.tolist(), mesh.coordinates, strict=True):
            coordinates = "".join(f"{x:25.16E}" for x in np.nan_to_num(point).tolist())
            yield f"{node:10d}{1:10d}{1:10d}{11:10d}\n{coordinates}\n"
        yield f"{ending}{ending}{2412:6d}\n"
        cells = ((x, row) for x in mesh.cells if x in ELEMENTS for row in mesh.cells[x].tolist())
        for k, (kind, nodes) in enumerate(cells, start=1):
            records = [(k, ELEMENTS[kind], 1, 1, 7, len(nodes)), nodes]
            records[1:1] = [(0, 0, 0)] if kind == "line" else []
            yield from ("".join(f"{x:10d}" for x in record) + "\n" for record in records)
        yield ending
    for k, (f, values) in enumerate(zip(frequencies.tolist(), motion, strict=True), start=1):
        texts = f"mode {k}", f"{f:.9g} Hz"
        mode = dataset_55(texts, k, (f, 1.0, 0.0, 0.0), number.tolist(), values)
        yield f"{ending}{55:6d}\n{mode}{ending}"
