"""``kind = "matrices"``: K(theta) = base + sum_j c_j(theta) K_j from files, M(theta) likewise."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np
import scipy.sparse

from modefront import options as opt
from modefront.errors import suggestion
from modefront.fem.structure import DIRECTIONS
from modefront.models.base import Model
from modefront.models.dofs import DofTable, motion_of_nodes, read_dofs
from modefront.models.files import READERS, read_matrix
from modefront.models.geometry import Cells, Geometry
from modefront.models.matrices import DOF, WEIGHTED, common_size, matrices
from modefront.models.parameters import BASE, exponents_of, form_of
from modefront.programs.base import ProgramMesh, read_mesh
from modefront.study.kinds.sensors import BY_NODE, ModelKind, read_places

FILE = opt.text("the name of a file")
Terms = Mapping[str, dict[str, scipy.sparse.coo_array]]

ALONE = "of the matrix in it; empty for the only one"
OF_SEVERAL = (
    opt.Option("file", FILE, required=True),
    opt.Option("name", opt.text("the name of a matrix in the file"), meaning=ALONE),
)
"""Keys of one of the matrices in a file."""

MATRIX = opt.file_name(READERS)
ONE_OF_SEVERAL = opt.closed({"file": MATRIX, "name": OF_SEVERAL[1].schema}, ["file"])
TERMS = opt.entries("a table of files", opt.table_of(opt.any_of(MATRIX, ONE_OF_SEVERAL), 1))
PLACES = opt.entries("a table, name = place", opt.table_of(opt.any_of(WEIGHTED, BY_NODE), 1))
OUTPUTS = opt.entries("a table, name = place", opt.table_of(opt.any_of(WEIGHTED, BY_NODE)))
MOVING = opt.any_of(
    WEIGHTED,
    opt.array(DOF, 1),
    BY_NODE,
    opt.closed({"direction": {"enum": [*DIRECTIONS]}}, ["direction"]),
)


@dataclass(frozen=True)
class Matrices(opt.Checked):
    """Matrices from files: K = base + sum_j c_j K_j, M likewise; c_j is a parameter or a product.

    Attributes
    ----------
    stiffness : file of `base`, and of each parameter or product of powers of parameters, such as
        `"t^3"`, `"1/L"` or `"E*t"`; `{ file, name }` where it holds several matrices
    mass : likewise
    sensors : degrees of freedom, counted from 0, or weights of them, `[[dof, weight], ...]`; with
        `dofs` also `{ node, direction }`, of which the direction is `x`, `y`, `z`, `rx`, `ry`,
        `rz`, with or without a minus sign, a list of these for as many sensors, or a vector
    dofs : CSV `node,direction,weight`, one row a degree of freedom; a node moves with the weighted
        sum of its rows
    mesh : nodes and elements for pictures, as `modefront import` writes them
    floating : whether the structure may move as a rigid body
    outputs : places besides the sensors for predictions, given as these are
    base : for each direction of the base the degrees of freedom that move with it, or
        `[[dof, motion], ...]`; with `dofs` also `{ direction = "x" }`, all of a direction
    """

    stiffness: Annotated[Any, TERMS]
    mass: Annotated[Any, TERMS]
    sensors: Annotated[Any, PLACES]
    dofs: Annotated[str, opt.text("the name of a table of degrees of freedom")] | None = None
    mesh: Annotated[str, opt.text("the name of a file of nodes and elements")] | None = None
    floating: Annotated[bool, opt.TRUE_OR_FALSE] = False
    outputs: Annotated[Any, OUTPUTS] | None = None
    base: Annotated[Any, opt.entries("a table of directions", opt.table_of(MOVING))] | None = None


def read_matrices(table: opt.Table, parameters: Sequence[str]) -> Model | None:
    """Return the model that a ``[model]`` table describes, or None where it has faults."""
    before = len(table.faults)
    read = table.record(Matrices)
    terms = {key: _terms(table, key, parameters) for key in ("stiffness", "mass")}
    size = _size(table, terms, parameters)
    dofs = table.content("dofs", read_dofs)
    if dofs is not None and size not in (None, dofs.size):
        expected = f"{size} rows, one a degree of freedom"
        table.fault("dofs", expected, f"{dofs.size} in '{table.values['dofs']}'")
        dofs = None
    mesh = table.content("mesh", read_mesh)
    sensors = read_places(table, "sensors", size, dofs, default=...)
    outputs = read_places(table, "outputs", size, dofs, taken=sensors or ()) or {}
    base = read_places(table, "base", size, dofs) or {}
    if len(table.faults) > before or read is None or sensors is None:
        return None
    model = matrices(
        parameters, **terms, sensors=sensors, floating=read.floating, outputs=outputs, base=base
    )
    if dofs is None or mesh is None:
        return model
    return replace(model, geometry=_geometry(dofs, mesh, model.selection))


def _terms(
    model: opt.Table, key: str, parameters: Sequence[str]
) -> dict[str, scipy.sparse.coo_array]:
    """Return the matrices of one table that can be read, by their names."""
    expected = f"a table of files, {BASE} = ... and one a parameter"
    table = model.table(key, expected)
    out: dict[str, scipy.sparse.coo_array] = {}
    if table is None:
        return out
    if not table.values:
        table.fault("", "at least one matrix", "none")
    for name, value in table.values.items():
        if exponents_of(name, parameters) is None:
            table.fault(name, form_of(name), suggestion(name, [BASE, *parameters]))
            continue
        inner = table.table(name) if isinstance(value, dict) else None
        known = inner.read(OF_SEVERAL) if inner else {"file": table.value(name, FILE)}
        if known and known["file"]:
            with table.noting(name):  # of files in which there may be several
                out[name] = read_matrix(table.path(known["file"]), known.get("name"))
    return out


def _geometry(dofs: DofTable, mesh: ProgramMesh, selection: scipy.sparse.csr_array) -> Geometry:
    """Return where the degrees of freedom are; a sensor is at the node that weighs most in it."""
    motion = motion_of_nodes(dofs, mesh.number)
    translations = 6 * np.arange(mesh.number.size)[:, None] + np.arange(3)
    nodes = np.zeros(selection.shape[0], np.intp)
    directions = np.zeros((selection.shape[0], 3))
    for k in range(selection.shape[0]):
        row = selection[[k]].tocoo()
        node = dofs.node[row.col[np.argmax(np.abs(row.data))]]
        if node not in mesh.number:
            continue
        nodes[k] = np.searchsorted(mesh.number, node)
        axis = np.where(dofs.node[row.col] == node, dofs.direction[row.col], 0)
        directions[k] = [row.data[axis == direction].sum() for direction in (1, 2, 3)]
        directions[k] /= np.linalg.norm(directions[k]) or 1.0
    cells = tuple(Cells(x, x, np.searchsorted(mesh.number, at)) for x, at in mesh.cells.items())
    moved = motion[translations.ravel()]
    return Geometry(mesh.coordinates, cells, moved, nodes, directions, mesh.number)


def _size(model: opt.Table, terms: Terms, parameters: Sequence[str]) -> int | None:
    """Return N, None without matrices; note where they, or degrees of freedom, are not right."""
    size, faults = common_size(parameters, {name: known for name, known in terms.items() if known})
    model.note(faults)
    if (mass := terms["mass"]) and not any(A.nnz for A in mass.values()):
        model.fault("mass", "a mass matrix that is not zero", "only zeros")
    elif all(terms.values()) and not model.faults:
        rows = [A.row for known in terms.values() for A in known.values()]
        empty = np.setdiff1d(np.arange(size), np.concatenate(rows))
        if empty.size:
            expected = "stiffness or mass at every degree of freedom"
            model.fault("", expected, f"neither at {empty[0]} (from 0)")
    return size or None


MATRICES = ModelKind("matrices", read_matrices, table=Matrices)
