"""A model of the results as files: parameters, matrices, mode shapes, lines of the deck."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import scipy.io
import scipy.sparse

from modefront._typing import Floats, Ints
from modefront.data.uff import dataset_55
from modefront.models.dofs import DofTable, motion_of_nodes, write_dofs
from modefront.models.geometry import Cells
from modefront.outputs import output, write_table, write_text
from modefront.programs.changes import Change
from modefront.programs.mesh import ProgramMesh
from modefront.results.results import ReportedModel
from modefront.results.vtu import write_grid


@dataclass(frozen=True, eq=False)
class NodeMotion:
    """Nodes and their motion in several modes.

    Attributes
    ----------
    number : (nodes,) numbers of the nodes
    values : (modes, nodes, 6) displacements x, y, z and rotations; 0 where a node cannot move
    turns : whether any node has rotations
    """

    number: Ints
    values: Floats
    turns: bool


def node_motion(dofs: DofTable, mesh: ProgramMesh | None, shapes: Floats) -> NodeMotion:
    """Return the motion of all nodes of a mesh (those of ``dofs`` without one) in shapes (N, m)."""
    number = np.unique(dofs.node[dofs.node > 0]) if mesh is None else mesh.number
    values = np.asarray(motion_of_nodes(dofs, number) @ shapes).T.reshape(-1, number.size, 6)
    turns = (dofs.direction > 3) & np.isin(dofs.node, number)
    return NodeMotion(number, values, bool(turns.any()))


ELEMENTS = {"line": 11, "triangle": 91, "quad": 94, "tetra": 111, "wedge": 112, "hexahedron": 115}
"""Identifiers of dataset 2412: rod, thin shells, solids; others are left out."""


def write_uff(
    path: Path, mesh: ProgramMesh | None, motion: NodeMotion, frequencies: Floats
) -> None:
    """Write nodes, elements and real, mass-normalised modes in Hz."""
    datasets: list[tuple[int, Iterable[str]]] = []
    if mesh is not None:
        datasets += [(2411, _nodes(mesh)), (2412, _elements(mesh))]
    datasets += [(55, [_mode(motion, k, f)]) for k, f in enumerate(frequencies.tolist())]
    with output(path) as stream:
        for number, lines in datasets:
            stream.writelines(line.encode() for line in _dataset(number, lines))


def _dataset(number: int, lines: Iterable[str]) -> Iterator[str]:
    yield f"    -1\n{number:6d}\n"
    yield from lines
    yield "    -1\n"


def _nodes(mesh: ProgramMesh) -> Iterator[str]:
    for number, point in zip(mesh.number.tolist(), mesh.coordinates, strict=True):
        numbers = "".join(f"{x:25.16E}" for x in np.nan_to_num(point).tolist())
        yield f"{number:10d}{1:10d}{1:10d}{11:10d}\n{numbers}\n"


def _elements(mesh: ProgramMesh) -> Iterator[str]:
    number = 0
    for kind, table in mesh.cells.items():
        if kind not in ELEMENTS:
            continue
        for nodes in table.tolist():
            number += 1
            yield "".join(f"{x:10d}" for x in (number, ELEMENTS[kind], 1, 1, 7, len(nodes))) + "\n"
            if kind == "line":
                yield "".join(f"{x:10d}" for x in (0, 0, 0)) + "\n"
            yield "".join(f"{x:10d}" for x in nodes) + "\n"


def _mode(motion: NodeMotion, k: int, frequency: float) -> str:
    """Return the dataset 55 of a real, mass-normalised mode."""
    texts = f"mode {k + 1}", f"{frequency:.9g} Hz"
    values = motion.values[k][:, : 6 if motion.turns else 3]
    return dataset_55(texts, k + 1, (frequency, 1.0, 0.0, 0.0), motion.number.tolist(), values)


@dataclass(frozen=True, eq=False)
class Origin:
    """Mesh, labels and changed lines of the program that an imported study keeps.

    Attributes
    ----------
    dofs : nodes and directions; None for a model that was not imported
    mesh : nodes and elements, where there was a deck
    changes : lines of the deck that parameters multiply
    """

    dofs: DofTable | None
    mesh: ProgramMesh | None
    changes: Sequence[Change]


def write_model(model: ReportedModel, origin: Origin, folder: Path, modes: int) -> list[str]:
    """Write all files of a model into a folder that is there; return what could not be written.

    Raises ModelError where the model has no matrices or no such modes.
    """
    _parameters(model, folder)
    _matrices(model, folder)
    missing = []
    if origin.dofs is None:
        missing.append("dofs.csv, modes.vtu and modes.uff: the study names no nodes (dofs)")
    else:
        write_dofs(folder / "dofs.csv", origin.dofs)
        shapes = model.modes(modes)
        motion = node_motion(origin.dofs, origin.mesh, shapes.shape)
        write_uff(folder / "modes.uff", origin.mesh, motion, shapes.frequency)
        if origin.mesh is None:
            missing.append("modes.vtu: the study names no mesh")
        elif find_spec("meshio") is None:
            missing.append("modes.vtu: meshio is not installed: pip install modefront[mesh]")
        else:
            _write_vtu(folder / "modes.vtu", origin.mesh, motion, shapes.frequency)
    write_text(folder / "deck.txt", _snippet(model, origin.changes))
    return missing


def _write_vtu(path: Path, mesh: ProgramMesh, motion: NodeMotion, frequencies: Floats) -> None:
    """Write nodes, cells and the displacement of every mode, named with its frequency in Hz."""
    data = {
        f"mode {k}, {f:.6g} Hz": values[:, :3]
        for k, (f, values) in enumerate(zip(frequencies, motion.values, strict=True), start=1)
    }
    cells = [Cells(x, x, np.searchsorted(mesh.number, rows)) for x, rows in mesh.cells.items()]
    write_grid(path, mesh.coordinates, cells, {**data, "node": mesh.number})


def _parameters(model: ReportedModel, folder: Path) -> None:
    values = {name: float(value) for name, value in model.theta.items()}
    rows = [(name, repr(value)) for name, value in values.items()]
    write_table(folder / "parameters.csv", [("parameter", "value"), *rows])
    content = {"label": model.label, "kind": model.kind, "parameters": values}
    text = json.dumps(content, indent=2, ensure_ascii=False)
    write_text(folder / "parameters.json", text + "\n")


def _matrices(model: ReportedModel, folder: Path) -> None:
    for name, A in (("K", model.stiffness), ("M", model.mass)):
        matrix = scipy.sparse.coo_array(A)
        matrix.eliminate_zeros()
        with output(folder / f"{name}.npz") as stream:
            scipy.sparse.save_npz(stream, matrix.tocsr())
        with output(folder / f"{name}.mtx") as stream:
            scipy.io.mmwrite(stream, matrix, symmetry="symmetric", precision=17)


def _snippet(model: ReportedModel, changes: Sequence[Change]) -> str:
    """Return the updated values: lines of the deck where they are known, factors elsewhere."""
    lines = [f"updated values, model '{model.label}'"]
    for name, value in model.theta.items():
        lines += ["", f"{name} = {value:.9g}"]
        of_parameter = [change for change in changes if change.parameter == name]
        for change in of_parameter:
            lines += [f"  {change.file}, line {change.line}:", f"  {change.updated(value).strip()}"]
        if not of_parameter:
            lines.append("  a factor of what was changed for this parameter")
    return "\n".join(lines) + "\n"


def matrix_size(model: ReportedModel) -> int:
    """Return the number of degrees of freedom that have mass, as many modes as there are."""
    return int(np.count_nonzero(model.mass.diagonal()))
