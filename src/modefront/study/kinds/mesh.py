"""``kind = "mesh"``: finite elements on a mesh from a file.

Each key of a table of members is the argument of a class of `modefront.fem`.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, get_args

from modefront import fem
from modefront.data.csv import is_reserved
from modefront.diagnosis.notes import unused_groups
from modefront.errors import suggestion
from modefront.fem.mesh import Kind, Mesh, read_mesh
from modefront.fem.structure import Group, Quantity
from modefront.json_schema import (
    ABOVE_ZERO,
    NOT_NEGATIVE,
    NUMBER,
    TABLE,
    Schema,
    any_of,
    array,
    chosen,
    closed,
    table_of,
)
from modefront.models.base import Model
from modefront.models.mesh import mesh_model
from modefront.options import (
    PAIR,
    TRUE_OR_FALSE,
    Option,
    Requirement,
    Table,
    check_fields,
    entries,
    is_name,
    keys,
    number,
    numbers,
    of_options,
    one_of,
    text,
    whole,
)
from modefront.study.kinds.sensors import (
    AXES,
    DIRECTION,
    DOF,
    ORIENTED,
    VECTOR,
    ModelKind,
    read_directions,
)

KINDS: tuple[Kind, ...] = get_args(Kind)
OF_VECTOR = numbers("a vector of 3 numbers", VECTOR)
NAMES = ", ".join(fem.DIRECTIONS)
NAMED: Schema = {"enum": [*fem.DIRECTIONS]}
DIRECTIONS = Requirement(f"a list of {NAMES}", array(NAMED, 1))
FORCE = number("an axial force")
AREA, LENGTH = (number(f"{x} above 0", above=0) for x in ("an area", "a number"))
PLACE = any_of(DOF, {"type": "string"})
NODES = Requirement(
    "a node counted from 0, the name of a group or node set, or a list of these",
    any_of(PLACE, array(PLACE, 1)),
)

Members = tuple[Callable[..., Any], Sequence[Option]]
"""A class of `modefront.fem`, and the keys of a table that are its arguments."""


def _members(make: Callable[..., Any], **known: Requirement) -> Members:
    """Return a class with the keys of its tables; required are its fields without default."""
    fields = inspect.signature(make).parameters.values()
    needed = {each.name for each in fields if each.default is each.empty}
    return make, keys([name for name in known if name in needed], **known)


SHAPES: Mapping[str, Members] = {
    "rectangle": _members(fem.rectangle, b_y=LENGTH, b_z=LENGTH),
    "hollow_rectangle": _members(fem.hollow_rectangle, b_y=LENGTH, b_z=LENGTH, wall=LENGTH),
    "circle": _members(fem.circle, diameter=LENGTH),
    "tube": _members(fem.tube, diameter=LENGTH, wall=LENGTH),
    "constants": _members(
        fem.Section,
        **dict.fromkeys(("A", "I_y", "I_z", "J"), LENGTH),
        **dict.fromkeys(("kappa_y", "kappa_z"), number("a shear factor above 0", above=0)),
        shear_centre=numbers("its y and z", PAIR),
    ),
}
"""Shapes of sections."""

STRAIN = number("a strain")


def _section(group: Table, key: str) -> fem.Section | None:
    table = group.table(key)
    shape = table.choice("shape", tuple(SHAPES)) if table else None
    if table is None or shape is None:
        return None
    try:
        make, known = SHAPES[shape]
        values = table.read(known)
        return make(**values) if values else None
    except fem.FemError as error:
        table.fault("", "a section that is possible", str(error))
        return None


def _strains(load: Table, key: str) -> dict[str, float] | None:
    table = load.table(key)
    return {name: table.value(name, STRAIN) for name in table.values} if table else None


def _of(known: Sequence[Option], **single: str) -> Schema:
    """Return the schema of a table of keys, of which ``single`` ones have one text as value."""
    texts: dict[str, Schema] = {key: {"enum": [value]} for key, value in single.items()}
    required = [*single, *(each.name for each in known if each.required)]
    return closed(texts | {each.name: each.schema for each in known}, required)


SECTION = Requirement(
    "a table with shape = " + ", ".join(SHAPES),
    TABLE,
    entries=chosen(
        "shape", {shape: _of(known, shape=shape) for shape, (_, known) in SHAPES.items()}
    ),
    read=_section,
)
STRAINS = Requirement(
    "a table, group = free strain", TABLE, entries=table_of(NUMBER), read=_strains
)

ELEMENTS: Mapping[Kind, Members] = {
    "beam": _members(
        fem.Beams,
        section=SECTION,
        orientation=OF_VECTOR,
        offsets=Requirement("a vector of 3 numbers for either end", array(VECTOR, 2, 2)),
        releases=Requirement(f"a list for either end, of {NAMES}", array(array(NAMED), 2, 2)),
        force=FORCE,
    ),
    "truss": _members(fem.Trusses, area=AREA, force=FORCE),
    "shell": _members(
        fem.Shells,
        thickness=number("a thickness above 0", above=0),
        offset=number("a distance"),
        direction=OF_VECTOR,
    ),
    "solid": _members(fem.Solids, axes=AXES),
}
"""Kinds of elements of a group, with their keys beside name, elements and material."""


def _one_or(count: int, expected: str, one: Schema) -> Requirement:
    """Return the requirement of one number, or of a list of as many, of 0 or more."""
    return Requirement(expected, any_of(one, array(NOT_NEGATIVE, count, count)))


MEMBERS: Mapping[str, Members] = {
    "support": _members(fem.Support, nodes=NODES, directions=DIRECTIONS, axes=AXES),
    "spring": _members(
        fem.Spring,
        name=text("the name of the springs"),
        nodes=NODES,
        to=NODES,
        stiffness=_one_or(6, "a stiffness above 0, or 6 of 0 or more", ABOVE_ZERO),
        direction=DIRECTION,
        axes=AXES,
    ),
    "mass": _members(
        fem.Mass,
        name=text("the name of the masses"),
        nodes=NODES,
        mass=_one_or(3, "a mass of 0 or more, or 3 for x, y and z", NOT_NEGATIVE),
        inertia=numbers("3 moments of inertia of 0 or more", array(NOT_NEGATIVE, 3, 3)),
        offset=OF_VECTOR,
    ),
    "link": _members(fem.Link, master=NODES, slaves=NODES, directions=DIRECTIONS),
    "coupling": _members(
        fem.Coupling,
        node=NODES,
        of=NODES,
        weights=numbers("numbers above 0", array(ABOVE_ZERO, 1)),
        directions=DIRECTIONS,
    ),
    "load": _members(
        fem.Load,
        name=text("the name of the load"),
        nodes=NODES,
        force=numbers("3 components, or 6 with moments", any_of(VECTOR, array(NUMBER, 6, 6))),
        acceleration=OF_VECTOR,
        strains=STRAINS,
    ),
}
"""Tables of members at nodes, with their keys."""

SINGLE = ("master", "node")
"""Keys of members that name one node."""

DENSITY = number("a density of 0 or more", least=0)
_, ISOTROPIC = _members(
    fem.Material,
    E=number("Young's modulus above 0", above=0),
    nu=number("Poisson's ratio between -1 and 0.5", above=-1, below=0.5),
    rho=DENSITY,
)
_, ORTHOTROPIC = _members(
    fem.Orthotropic,
    **{key: numbers(f"three values of {key}", VECTOR) for key in ("E", "nu", "G")},
    rho=DENSITY,
)
TOLERANCE = number("a distance above 0", above=0)
PLACED = {"node": whole(0, 10**9), "at": numbers("3 coordinates", VECTOR)}
"""Keys of which one says where a sensor is."""

NAME = keys(["name"], name=text("the name of a group of cells"))
MATERIAL = keys(["material"], material=text("a material"))
SCALE = keys(
    ["quantity", "of"],
    quantity=one_of(*get_args(Quantity)),
    of=Requirement("a list of groups, springs, masses or loads", array({"type": "string"}, 1)),
)


def _tables(kind: str) -> Requirement:
    """Return the requirement of the tables of a kind of members."""
    return entries(f"tables [[model.{kind}]]", array(of_options(MEMBERS[kind][1]), 1))


MATERIALS = entries(
    "a table of materials, name = { E, nu, rho }",
    table_of(any_of(of_options(ISOTROPIC), of_options(ORTHOTROPIC)), 1),
)
GROUPS = entries(
    "tables [[model.group]]",
    array(
        chosen(
            "elements",
            {
                kind: _of([*NAME, *MATERIAL, *known], elements=kind)
                for kind, (_, known) in ELEMENTS.items()
            },
        ),
        1,
    ),
)
PLACES = any_of(
    *(
        closed(
            {key: place.described, "tolerance": TOLERANCE.described} | ORIENTED, [key, "direction"]
        )
        for key, place in PLACED.items()
    )
)
SCALES = entries("a table, parameter = { quantity, of }", table_of(of_options(SCALE)))


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
    scale: Annotated[Mapping[str, Any], SCALES]
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
    structure, outputs = _structure(table, parameters, mesh), _places(table, "outputs")
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
    materials = {}
    for name, entry in table.entries("material", "a table E, nu, rho", "material"):
        is_isotropic = not isinstance(entry.values.get("E"), list)
        values = entry.read(ISOTROPIC if is_isotropic else ORTHOTROPIC)
        try:
            if values is not None:
                materials[name] = (fem.Material if is_isotropic else fem.Orthotropic)(**values)
        except fem.FemError as error:
            entry.fault("", "a material that is possible", str(error))
    return fem.Structure(
        mesh.nodes,
        _groups(table, mesh, materials),
        **{
            f"{kind}es" if kind == "mass" else f"{kind}s": [
                make(**values)
                for member in table.tables(kind, required=False)
                if (values := _arguments(member, known, mesh)) is not None
            ]
            for kind, (make, known) in MEMBERS.items()
        },
        sensors=_places(table, "sensors"),
        parameters=_scales(table, parameters),
    )


def _arguments(table: Table, known: Sequence[Option], mesh: Mesh) -> dict[str, Any] | None:
    """Return the arguments of a class that a table gives, None where something is wrong."""
    before = len(table.faults)
    out = table.read(known) or {}
    for option in known:
        name, given = option.name, table.values.get(option.name)
        if option.requirement is NODES and NODES.holds(given):
            out[name] = _nodes(given, table, name, mesh)
        elif option.requirement is AXES and name in out:
            out[name] = out[name][:2].tolist()
    return out if len(table.faults) == before else None


def _nodes(value: Any, table: Table, key: str, mesh: Mesh) -> list[int] | int:
    """Return nodes: one, or those of a list of nodes and of groups or node sets of the mesh."""
    nodes: list[int] = []
    before = len(table.faults)
    for place in listed(value):
        if isinstance(place, str):
            try:
                nodes += [int(node) for node in mesh.nodes_of(place)]
            except fem.FemError as error:
                table.fault(key, "a group or node set of the mesh", str(error))
        elif place >= len(mesh.nodes):
            one_off = " (they are counted from 0)" if place == len(mesh.nodes) else ""
            table.fault(key, f"nodes from 0 to {len(mesh.nodes) - 1}{one_off}", str(place))
        else:
            nodes.append(place)
    nodes = list(dict.fromkeys(nodes))
    if key not in SINGLE:
        return nodes
    if len(nodes) != 1 and len(table.faults) == before:
        table.fault(key, "one node", f"{len(nodes)} nodes")
    return nodes[0] if nodes else 0


def listed(value: object) -> list[Any]:
    """Return a list as it is, and anything else as a list of itself."""
    return value if isinstance(value, list) else [value]


def _given(model: Table, kind: str) -> list[dict[str, Any]]:
    """Return the tables of a kind as they are given, faulty or not; what is none is left out."""
    return [each for each in listed(model.values.get(kind)) if isinstance(each, dict)]


def _named_nodes(model: Table) -> set[str]:
    """Return the groups and node sets that members name."""
    return {
        name
        for kind, (_, known) in MEMBERS.items()
        for table in _given(model, kind)
        for option in known
        if option.requirement is NODES
        for name in listed(table.get(option.name))
        if isinstance(name, str)
    }


def _groups(
    model: Table, mesh: Mesh, materials: Mapping[str, fem.Material | fem.Orthotropic]
) -> list[Group]:
    """Return the blocks of all groups; one group may have cells of several types."""
    out: list[Group] = []
    declared = model.values.get("material")  # those with faults too, which are said there
    names = tuple(declared) if isinstance(declared, dict) else ()
    material = keys(["material"], material=one_of(*names)) if names else MATERIAL
    for group in model.tables("group", required=True):
        kind: Kind | None = group.choice("elements", KINDS)
        make, known = ELEMENTS[kind] if kind is not None else (None, ())
        values = _arguments(group, [*NAME, *material, *known], mesh)
        name = group.values.get("name")
        if kind is None or make is None or not is_name(name):
            continue
        try:
            blocks = mesh.cells_of(str(name), kind)
        except fem.FemError as error:
            group.fault("name", "a group of the mesh", str(error))
            continue
        if values is not None and values["material"] in materials:
            values["material"] = materials[values["material"]]
            out += [make(cells=cells, **values) for cells in blocks]
    return out


def _places(model: Table, key: str) -> list[fem.Sensor]:
    """Return sensors; one with a list of directions becomes as many, NAMEx, NAMEy and so on."""
    out: list[fem.Sensor] = []
    required = key == "sensors"
    for name, place in model.entries(
        key, "a table node or at, and direction", "sensor" if required else "", required=required
    ):
        found = {each: place.value(each, PLACED[each], None) for each in PLACED}
        places = [each for each in found.values() if each is not None]
        directions = read_directions(place)
        tolerance = place.value("tolerance", TOLERANCE, None)
        place.close()
        if len(places) != 1:
            place.fault("", "either node or at", "both" if places else "neither")
            continue
        for ending, direction in directions:
            out.append(fem.Sensor(name + ending, places[0], direction, tolerance))
    given = model.values.get(key)
    names = {*(given if isinstance(given, dict) else ()), *(sensor.name for sensor in out)}
    for name in sorted(names) if required else ():
        if is_reserved(name, names):
            expected = "a name that a column of the data can have"
            model.fault(f"{key} {name!r}", expected, repr(name))
    return out


def _scales(model: Table, parameters: Sequence[str]) -> list[fem.Parameter]:
    """Return what each parameter scales: one quantity of named members."""
    out: list[fem.Parameter] = []
    for name, scale in model.entries("scale", "a table { quantity = ..., of = [...] }"):
        if name not in parameters:
            expected, found = "the name of a parameter", suggestion(name, parameters)
            model.fault(f"scale {name}", expected, found)
        elif values := scale.read(SCALE):
            out.append(fem.Parameter(name, **values))
    return out


MESH = ModelKind("mesh", read_mesh_model, table=MeshModel)
