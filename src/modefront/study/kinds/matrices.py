"""``kind = "matrices"`` and ``kind = "chain"``, and the places that tables of models name.

K(theta) = base + sum_j c_j(theta) K_j comes from files or from lumped masses and springs, M(theta)
likewise. A place is a degree of freedom, weighted or not, or a node and a direction.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from operator import itemgetter
from typing import Annotated, Any

import numpy as np
import scipy.sparse

from modefront.data.csv import is_reserved
from modefront.errors import suggestion
from modefront.fem.check import axes_of, unit_vector
from modefront.fem.structure import AXES, DIRECTION, DIRECTIONS, NAMED
from modefront.models.base import Model
from modefront.models.chain import MASSES, chain
from modefront.models.dofs import DofTable, motion_of_nodes, read_dofs
from modefront.models.files import READERS, read_matrix
from modefront.models.geometry import Cells, Geometry
from modefront.models.matrices import DOF, WEIGHTED, SensorSpec, common_size, matrices
from modefront.models.parameters import BASE, exponents_of, form_of
from modefront.options import (
    TRUE_OR_FALSE,
    Checked,
    Option,
    Requirement,
    Table,
    any_of,
    array,
    closed,
    entries,
    file_name,
    fits,
    is_name,
    options,
    shown,
    table_of,
    text,
    whole,
)
from modefront.programs.base import ProgramMesh, read_mesh


@dataclass(frozen=True)
class ModelKind:
    """A kind of model that a study file can name.

    Attributes
    ----------
    name : value of ``kind`` in the table ``[model]``
    read : returns the model of that table, given the names of the parameters, or None where the
        table has faults; files are opened by `modefront.options.Table.path`, so that they are known
    is_reducible : whether a model may be large enough for a reduced basis
    table : record of options, or function, whose fields or arguments are the keys of that table
        (`modefront.options`), for the schema of study files; None where they are not known
    """

    name: str
    read: Callable[[Table, Sequence[str]], Model | None]
    is_reducible: bool = True
    table: Callable[..., Any] | None = None


SEVERAL = Requirement(
    "a list of different ones of " + ", ".join(NAMED),
    array({"enum": NAMED}, 1, once=True),
    further=lambda x: len({y.removeprefix("-") for y in x}) == len(x),
)
ORIENTED = {"direction": any_of(DIRECTION.schema, SEVERAL.schema), "axes": AXES.schema}
"""Keys that say along which directions sensors measure at a node."""

NODE = whole(1, 2**62)
BY_NODE = closed({"node": NODE.schema} | ORIENTED, ["node", "direction"])


def from_zero(what: str, count: int, found: int) -> str:
    """Return which numbers are expected of ``what``, which are counted from 0."""
    return f"{what} from 0 to {count - 1}" + " (they are counted from 0)" * (found == count)


def read_directions(place: Table) -> list[tuple[str, Any]]:
    """Return the directions of a sensor in the axes of the model, with what each adds to its name.

    A list of named directions makes as many sensors: NAMEx, NAMEy and so on. With ``axes`` they are
    local.
    """
    given = place.values.get("direction")
    several = isinstance(given, list) and any(isinstance(x, str) for x in given)
    value = place.value("direction", SEVERAL if several else DIRECTION)
    axes = place.value("axes", AXES, None)
    out = []
    for direction in (value or ()) if several else [value][: value is not None]:
        axis = str(direction).removeprefix("-")
        if axes is not None and isinstance(direction, str) and axis not in DIRECTIONS[:3]:
            place.fault("direction", "x, y or z where axes are given", f"'{direction}'")
            continue
        if axes is not None:
            local = unit_vector(direction)[:3] @ axes_of(axes)
        known = direction if axes is None else local.tolist()
        out.append((axis if several else "", known))
    return out


EXPECTED = {
    "sensors": "a table of sensors, name = degree of freedom",
    "outputs": "a table of outputs, name = degree of freedom",
    "base": "a table, direction = list of the degrees of freedom that move with the base",
}
"""Tables of places."""


# 6 arguments: the table, the model's size and nodes, and what differs between the tables.
def read_places(
    model: Table,
    key: str,
    size: int | None,
    dofs: DofTable | None = None,
    *,
    taken: Iterable[str] = (),
    default: Any = None,
) -> dict[str, SensorSpec] | None:
    """Return named degrees of freedom of a model, weighted or not; None without the table.

    ``size`` is how many the model has, where that is known. With ``dofs``, they may be given by
    node and direction too, and those of the base by the direction alone.
    """
    table = model.table(key, EXPECTED[key], default)
    if table is None:
        return None
    if key == "sensors" and not table.values:
        table.fault("", "at least one sensor", "none")
    for name in set(taken).intersection(table.values):
        table.fault(name, "a name that no sensor has", f"'{name}'")

    def is_right(name: str, place: str) -> bool:
        reserved = key == "sensors" and is_reserved(name, table.values)
        if wrong := not is_name(name) or name != name.strip() or reserved:
            table.fault(place, "a name that a column of the data can have", repr(name))
        return not wrong

    out: dict[str, SensorSpec] = {}
    for name, value in table.values.items():
        if not is_right(name, repr(name)):
            continue
        pairs = [[value, 1.0]] if fits(value, DOF) else value
        if key == "base" and isinstance(value, list) and all(fits(dof, DOF) for dof in value):
            pairs = [[dof, 1.0] for dof in value]
        elif key == "base" and dofs and value in [{"direction": each} for each in DIRECTIONS]:
            pairs = [list(pair) for pair in dofs.of_direction(value["direction"])]
        elif isinstance(value, dict) and {"node", "direction"} & value.keys():
            out |= {x: y for x, y in _by_node(table, name, dofs).items() if is_right(x, name)}
            continue
        if not fits(pairs, WEIGHTED):
            expected = "a degree of freedom from 0, or a list [[degree of freedom, weight], ...]"
            table.fault(name, expected, shown(value))
        elif beyond := [dof for dof, _ in pairs if size is not None and dof >= size]:
            expected = from_zero("degrees of freedom", size or 0, max(beyond))
            table.fault(name, expected, ", ".join(map(str, beyond)))
        elif not any(sum(w for _, w in of) for _, of in groupby(sorted(pairs), itemgetter(0))):
            table.fault(name, "weights that do not cancel", shown(pairs))
        else:
            out[name] = [(int(dof), float(weight)) for dof, weight in pairs]
    return out


def _by_node(table: Table, name: str, dofs: DofTable | None) -> dict[str, SensorSpec]:
    """Return the degrees of freedom of a place given by node and direction; of each direction."""
    place = table.table(name) if dofs else None
    if dofs is None or place is None:
        expected = 'a degree of freedom; nodes and directions need dofs = "dofs.csv"'
        table.fault(name, expected, shown(table.values[name]))
        return {}
    out: dict[str, SensorSpec] = {}
    node, directions = place.value("node", NODE), read_directions(place)
    place.close()
    for ending, direction in directions if node is not None else ():
        try:
            out[name + ending] = dofs.sensor(node, direction)
        except LookupError as error:
            place.fault("", *error.args)
    return out


FILE = text("the name of a file")
Terms = Mapping[str, dict[str, scipy.sparse.coo_array]]

ALONE = "of the matrix in it; empty for the only one"
OF_SEVERAL = (
    Option("file", FILE, required=True),
    Option("name", text("the name of a matrix in the file"), meaning=ALONE),
)
"""Keys of one of the matrices in a file."""

MATRIX = file_name(READERS)
ONE_OF_SEVERAL = closed({"file": MATRIX, "name": OF_SEVERAL[1].schema}, ["file"])
TERMS = entries("a table of files", table_of(any_of(MATRIX, ONE_OF_SEVERAL), 1))
PLACES = entries("a table, name = place", table_of(any_of(WEIGHTED, BY_NODE), 1))
OUTPUTS = entries("a table, name = place", table_of(any_of(WEIGHTED, BY_NODE)))
MOVING = any_of(
    WEIGHTED, array(DOF, 1), BY_NODE, closed({"direction": {"enum": [*DIRECTIONS]}}, ["direction"])
)


@dataclass(frozen=True)
class Matrices(Checked):
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

    stiffness: Annotated[Mapping[str, Any], TERMS]
    mass: Annotated[Mapping[str, Any], TERMS]
    sensors: Annotated[Mapping[str, Any], PLACES]
    dofs: Annotated[str, text("the name of a table of degrees of freedom")] | None = None
    mesh: Annotated[str, text("the name of a file of nodes and elements")] | None = None
    floating: Annotated[bool, TRUE_OR_FALSE] = False
    outputs: Annotated[Mapping[str, Any], OUTPUTS] | None = None
    base: (
        Annotated[Mapping[str, Any], entries("a table of directions", table_of(MOVING))] | None
    ) = None


def read_matrices(table: Table, parameters: Sequence[str]) -> Model | None:
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


def _terms(model: Table, key: str, parameters: Sequence[str]) -> dict[str, scipy.sparse.coo_array]:
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
        known: dict[str, Any] | None = {}
        if isinstance(value, dict):
            inner = table.table(name)
            known = inner.read(OF_SEVERAL) if inner else None
        elif file := table.value(name, FILE):
            known = {"file": file}
        if known:
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
        for dof, weight in zip(row.col, row.data, strict=True):
            if dofs.node[dof] == node and 1 <= dofs.direction[dof] <= 3:
                directions[k, dofs.direction[dof] - 1] += weight
        directions[k] /= np.linalg.norm(directions[k]) or 1.0
    cells = tuple(
        Cells(kind, kind, np.searchsorted(mesh.number, table)) for kind, table in mesh.cells.items()
    )
    return Geometry(mesh.coordinates, cells, motion[translations.ravel()], nodes, directions)


def _size(model: Table, terms: Terms, parameters: Sequence[str]) -> int | None:
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


def read_chain(table: Table, parameters: Sequence[str]) -> Model | None:
    """Return the chain that a ``[model]`` table describes, or None where it has faults."""
    before = len(table.faults)
    values, masses = table.read(options(chain)), table.values.get("masses")
    n = len(masses) if isinstance(masses, list) and MASSES.holds(masses) else None
    sensors = read_places(table, "sensors", n)
    floors = sensors or [f"floor{i + 1}" for i in range(n or 0)]
    outputs = read_places(table, "outputs", n, taken=floors)
    if values is not None and len(table.faults) == before:
        with table.noting():
            return chain(parameters, **values | {"sensors": sensors, "outputs": outputs})
    return None


CHAIN = ModelKind("chain", read_chain, is_reducible=False, table=chain)
