"""``kind = "mesh"``: finite elements on a mesh from a file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, get_args

from modefront import fem
from modefront.data.csv import is_reserved
from modefront.diagnosis.notes import unused_groups
from modefront.errors import suggestion
from modefront.fem.mesh import Kind, Mesh, read_mesh
from modefront.fem.structure import Group, Quantity
from modefront.json_schema import Schema, any_of, array, chosen, closed, table_of
from modefront.models.base import Model
from modefront.models.mesh import mesh_model
from modefront.options import (
    TRUE_OR_FALSE,
    Requirement,
    check_fields,
    entries,
    is_name,
    number,
    numbers,
    one_of,
    text,
    whole,
)
from modefront.study.kinds.members import (
    ELEMENTS,
    MEMBERS,
    NAMING_NODES,
    Key,
    listed,
    of_keys,
    read_keys,
    read_members,
)
from modefront.study.kinds.sensors import ORIENTED, VECTOR, ModelKind, read_directions
from modefront.toml import Table

AnyMaterial = fem.Material | fem.Orthotropic

KINDS: tuple[Kind, ...] = get_args(Kind)
NAME = text("the name of a group of cells")
QUANTITY = one_of(*get_args(Quantity))
OF = Requirement("a list of groups, springs, masses or loads", array({"type": "string"}, 1))
NODE = whole(0, 10**9)
AT = numbers("3 coordinates", VECTOR)
TOLERANCE = number("a distance above 0", above=0)

DENSITY = Key(number("a density of 0 or more", least=0), required=True)
ISOTROPIC = {
    "E": Key(number("Young's modulus above 0", above=0), required=True),
    "nu": Key(number("Poisson's ratio between -1 and 0.5", above=-1, below=0.5), required=True),
    "rho": DENSITY,
}
ORTHOTROPIC = {
    key: Key(numbers(f"three values of {key}", VECTOR), required=True) for key in ("E", "nu", "G")
} | {"rho": DENSITY}


def _placed(key: str, requirement: Requirement) -> Schema:
    """Return the schema of a sensor whose place one key says."""
    keys = {key: requirement.described, "tolerance": TOLERANCE.described}
    return closed(keys | ORIENTED, [key, "direction"])


def _group_schema(kind: Kind) -> Schema:
    """Return the schema of a group of one kind of elements."""
    own = {"name": Key(NAME, required=True), "material": Key(text("a material"), required=True)}
    return of_keys({**own, **ELEMENTS[kind][1]}, elements=kind)


def _tables(kind: str) -> Requirement:
    """Return the requirement of the tables of a kind of members."""
    return entries(f"tables [[model.{kind}]]", array(of_keys(MEMBERS[kind][1]), 1))


MATERIALS = entries(
    "a table of materials, name = { E, nu, rho }",
    table_of(any_of(of_keys(ISOTROPIC), of_keys(ORTHOTROPIC)), 1),
)
GROUPS = entries(
    "tables [[model.group]]",
    array(chosen("elements", {kind: _group_schema(kind) for kind in KINDS}), 1),
)
PLACES = any_of(_placed("node", NODE), _placed("at", AT))
SCALED = closed({"quantity": QUANTITY.described, "of": OF.described}, ["quantity", "of"])


# 13 fields: the tables of a structure.
@dataclass(frozen=True)
class MeshModel:
    """Finite elements on a mesh from a file that meshio reads.

    Attributes
    ----------
    file : the mesh
    floating : whether the structure may move as a rigid body
    material : isotropic `{ E, nu, rho }`; orthotropic for shells and solids, `E = [E_1, E_2, E_3]`,
        `nu = [nu_12, nu_13, nu_23]`, `G = [G_12, G_13, G_23]`, `rho`
    group : a group of cells of the mesh, with their elements and material
    support : nodes that are held
    spring : springs from nodes to the ground, or to their partners
    mass : lumped masses
    link : rigid links (RBE2)
    coupling : interpolating couplings (RBE3): a node has the mean motion of others
    load : prestress
    sensors : name = `{ node or at, direction, axes, tolerance }`
    outputs : likewise, places besides the sensors for predictions
    scale : parameter = `{ quantity, of }`: what each parameter scales
    """

    file: Annotated[str, text("the name of a mesh file")]
    material: Annotated[Mapping[str, Any], MATERIALS]
    group: Annotated[Sequence[Any], GROUPS]
    sensors: Annotated[Mapping[str, Any], entries("a table of sensors", table_of(PLACES, 1))]
    scale: Annotated[
        Mapping[str, Any],
        entries("a table, parameter = { quantity, of }", table_of(SCALED)),
    ]
    floating: Annotated[bool, TRUE_OR_FALSE] = False
    support: Annotated[Sequence[Any], _tables("support")] = ()
    spring: Annotated[Sequence[Any], _tables("spring")] = ()
    mass: Annotated[Sequence[Any], _tables("mass")] = ()
    link: Annotated[Sequence[Any], _tables("link")] = ()
    coupling: Annotated[Sequence[Any], _tables("coupling")] = ()
    load: Annotated[Sequence[Any], _tables("load")] = ()
    outputs: (
        Annotated[Mapping[str, Any], entries("a table of outputs", table_of(PLACES))] | None
    ) = None

    def __post_init__(self) -> None:
        check_fields(self)


def read_mesh_model(table: Table, parameters: Sequence[str]) -> Model | None:
    """Return the model that a ``[model]`` table describes, or None where it has faults."""
    before = len(table.faults)
    read, name = table.record(MeshModel), table.values.get("file")
    if not is_name(name):
        return None
    try:
        mesh = read_mesh(table.path(str(name)))
    except fem.FemError as error:  # what the tables say cannot be judged without the mesh
        table.fault("file", "a mesh that can be read", str(error))
        return None
    structure, outputs = _structure(table, parameters, mesh), _outputs(table)
    table.notes += unused_groups(mesh, (g.name for g in structure.groups), _named_nodes(table))
    if len(table.faults) > before or read is None:
        _look_further(table, structure, mesh)
        return None
    try:
        return mesh_model(structure, parameters, floating=read.floating, outputs=outputs)
    except fem.FemError as error:
        for message in error.messages:
            table.fault("", "a structure that can be assembled", message)
        return None


def _look_further(table: Table, structure: fem.Structure, mesh: Mesh) -> None:
    """Note what is wrong with sensors and scales, where faults keep the structure from being made.

    Names that other tables give count, faulty or not: of these, the faults are said.
    """
    count = len(mesh.nodes)
    for sensor in structure.sensors:
        if isinstance(sensor.at, int) and sensor.at >= count:
            table.fault(f"sensors {sensor.name}", f"nodes from 0 to {count - 1}", str(sensor.at))
    named = [
        name
        for kind in ("group", "spring", "mass", "load")
        for entry in _given(table, kind)
        for name in [entry.get("name")]
        if isinstance(name, str)
    ]
    for parameter in structure.parameters:
        for name in parameter.of:
            if name not in named:
                expected = "the name of a group, spring, mass or load"
                table.fault(f"scale {parameter.name} of", expected, suggestion(name, named))


def _structure(table: Table, parameters: Sequence[str], mesh: Mesh) -> fem.Structure:
    groups = _groups(table, mesh, _materials(table))
    members = {
        f"{kind}es" if kind == "mass" else f"{kind}s": read_members(table, kind, mesh)
        for kind in MEMBERS
    }
    scales = _scales(table, parameters)
    return fem.Structure(mesh.nodes, groups, **members, sensors=_sensors(table), parameters=scales)


def _given(model: Table, kind: str) -> list[dict[str, Any]]:
    """Return the tables of a kind as they are given, faulty or not; what is none is left out."""
    tables = model.values.get(kind)
    return [each for each in listed(tables) if isinstance(each, dict)]


def _named_nodes(model: Table) -> set[str]:
    """Return the groups and node sets that members name."""
    return {
        name
        for kind in MEMBERS
        for table in _given(model, kind)
        for key in NAMING_NODES
        for name in listed(table.get(key))
        if isinstance(name, str)
    }


def _materials(model: Table) -> dict[str, AnyMaterial]:
    out: dict[str, AnyMaterial] = {}
    table = model.table("material", "a table of materials")
    if table is not None and not table.values:
        table.fault("", "at least one material", "none")
    for name in table.values if table else ():
        entry = table.table(name, "a table E, nu, rho") if table else None
        if entry is None:
            continue
        before = len(entry.faults)
        is_isotropic = not isinstance(entry.values.get("E"), list)
        keys = ISOTROPIC if is_isotropic else ORTHOTROPIC
        values = [entry.value(key, each.requirement) for key, each in keys.items()]
        entry.close()
        try:
            if len(entry.faults) == before:
                out[name] = (fem.Material if is_isotropic else fem.Orthotropic)(*values)
        except fem.FemError as error:
            entry.fault("", "a material that is possible", str(error))
    return out


def _groups(model: Table, mesh: Mesh, materials: dict[str, AnyMaterial]) -> list[Group]:
    """Return the blocks of all groups; one group may have cells of several types."""
    out: list[Group] = []
    for group in model.tables("group", required=True):
        before = len(group.faults)
        name = group.value("name", NAME)
        kind: Kind | None = group.choice("elements", KINDS)
        declared = model.values.get("material")  # those with faults too, which are said there
        names = tuple(declared) if isinstance(declared, dict) else ()
        label = group.choice("material", names) if names else group.text("material")
        make, keys = ELEMENTS[kind] if kind is not None else (None, {})
        values = read_keys(group, keys, mesh)
        group.close()
        if name is None or kind is None or make is None:
            continue
        try:
            blocks = mesh.cells_of(name, kind)
        except fem.FemError as error:
            group.fault("name", "a group of the mesh", str(error))
            continue
        if len(group.faults) == before and label in materials:
            out += [make(name, cells, materials[label], **values) for cells in blocks]
    return out


def _sensors(model: Table) -> list[fem.Sensor]:
    table = model.table("sensors", "a table of sensors")
    if table is None:
        return []
    if not table.values:
        table.fault("", "at least one sensor", "none")
    sensors = _places(table)
    names = {*table.values, *(sensor.name for sensor in sensors)}
    for name in sorted(names):
        if is_reserved(name, names):
            table.fault(repr(name), "a name that a column of the data can have", repr(name))
    return sensors


def _outputs(model: Table) -> list[fem.Sensor]:
    """Return the places besides the sensors that predictions may name."""
    table = model.table("outputs", "a table of outputs", default=None)
    return _places(table) if table is not None else []


def _places(table: Table) -> list[fem.Sensor]:
    """Return sensors; one with a list of directions becomes as many, NAMEx, NAMEy and so on."""
    out: list[fem.Sensor] = []
    for name in table.values:
        place = table.table(name, "a table node or at, and direction")
        if place is None:
            continue
        node = place.value("node", NODE, None)
        coordinates = place.value("at", AT, None)
        directions = read_directions(place)
        tolerance = place.value("tolerance", TOLERANCE, None)
        place.close()
        if (node is None) == (coordinates is None):
            place.fault("", "either node or at", "both" if node is not None else "neither")
            continue
        position = node if coordinates is None else coordinates
        for ending, direction in directions:
            out.append(fem.Sensor(name + ending, position, direction, tolerance))
    return out


def _scales(model: Table, parameters: Sequence[str]) -> list[fem.Parameter]:
    """Return what each parameter scales: one quantity of named members."""
    out: list[fem.Parameter] = []
    table = model.table("scale", "a table, parameter = { quantity, of }")
    for name in table.values if table else ():
        if table is None or name not in parameters:
            if table is not None:
                table.requested.append(name)
                table.fault(name, "the name of a parameter", suggestion(name, parameters))
            continue
        scale = table.table(name, "a table { quantity = ..., of = [...] }")
        if scale is None:
            continue
        quantity: Quantity | None = scale.value("quantity", QUANTITY)
        of = scale.value("of", OF)
        scale.close()
        if quantity is not None and of is not None:
            out.append(fem.Parameter(name, quantity, of))
    return out


MESH = ModelKind("mesh", read_mesh_model, table=MeshModel)
