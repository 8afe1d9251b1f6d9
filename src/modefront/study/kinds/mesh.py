"""``kind = "mesh"``: finite elements on a mesh from a file."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any

from modefront import fem
from modefront import options as opt
from modefront.data.csv import is_reserved
from modefront.errors import suggestion
from modefront.fem.mesh import Kind, Mesh, read_mesh
from modefront.fem.structure import NODES, VECTOR, Group
from modefront.findings.record import Finding, found
from modefront.models.base import Model
from modefront.models.mesh import mesh_model
from modefront.study.kinds.sensors import ORIENTED, ModelKind, from_zero, read_directions

SHAPES: Mapping[str, Callable[..., fem.Section]] = {
    "rectangle": fem.rectangle,
    "hollow_rectangle": fem.hollow_rectangle,
    "circle": fem.circle,
    "tube": fem.tube,
    "constants": fem.Section,
}
"""What makes a section of each shape."""


def _section(group: opt.Table, key: str) -> fem.Section | None:
    table = group.table(key, SECTION.expected)
    shape = table and table.value("shape", opt.one_of(*SHAPES))
    return table.record(SHAPES[shape]) if table and shape else None


SECTION = opt.Requirement(
    "a table with shape = " + ", ".join(SHAPES),
    opt.TABLE,
    entries=opt.chosen("shape", {shape: opt.schema_of(make) for shape, make in SHAPES.items()}),
    read=_section,
)

ELEMENTS: Mapping[Kind, Callable[..., Group]] = {
    "beam": fem.Beams,
    "truss": fem.Trusses,
    "shell": fem.Shells,
    "solid": fem.Solids,
}
"""Classes of groups by their kinds of elements."""

MEMBERS: Mapping[str, Callable[..., Any]] = {
    each.__name__.lower(): each
    for each in (fem.Support, fem.Spring, fem.Mass, fem.Link, fem.Coupling, fem.Load)
}
"""Classes of members at nodes by their tables."""

SINGLE = ("master", "node")  # keys of members that name one node

PLACED = {
    "node": opt.whole(0, 10**9),
    "at": opt.numbers("3 coordinates", VECTOR),
    "tolerance": opt.number("a distance above 0", above=0),
}
"""Keys of a sensor besides its direction; one of the first two says where it is."""

MATERIAL = opt.text("a material")


def _of_group(kind: Kind | None, material: opt.Requirement = MATERIAL) -> list[opt.Option]:
    known = {"name": opt.text("the name of a group of cells"), "material": material}
    known |= {"section": SECTION} if kind == "beam" else {}
    return [*opt.keys([*known], **known), *(opt.options(ELEMENTS[kind]) if kind else ())]


def _tables(kind: str) -> opt.Requirement:
    return opt.entries(f"tables [[model.{kind}]]", opt.array(opt.schema_of(MEMBERS[kind]), 1))


MATERIALS = opt.entries(
    "a table of materials, name = { E, nu, rho }",
    opt.table_of(opt.any_of(opt.schema_of(fem.Material), opt.schema_of(fem.Orthotropic)), 1),
)
GROUPS = opt.array(
    opt.chosen("elements", {kind: opt.of_options(_of_group(kind)) for kind in ELEMENTS}), 1
)
PLACES = {
    **opt.closed({key: each.described for key, each in PLACED.items()} | ORIENTED, ["direction"]),
    "oneOf": [{"required": ["node"]}, {"required": ["at"]}],
}
SCALES = opt.entries(
    "a table, parameter = { quantity, of }", opt.table_of(opt.schema_of(fem.Parameter), 1)
)


# 13 fields: the tables of a structure.
@dataclass(frozen=True)
class MeshModel(opt.Checked):
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

    file: Annotated[str, opt.text("the name of a mesh file")]
    material: Annotated[Any, MATERIALS]
    group: Annotated[Any, opt.entries("tables [[model.group]]", GROUPS)]
    sensors: Annotated[Any, opt.entries("a table of sensors", opt.table_of(PLACES, 1))]
    scale: Annotated[Any, SCALES]
    floating: Annotated[bool, opt.TRUE_OR_FALSE] = False
    support: Annotated[Sequence[Any], _tables("support")] = ()
    spring: Annotated[Sequence[Any], _tables("spring")] = ()
    mass: Annotated[Sequence[Any], _tables("mass")] = ()
    link: Annotated[Sequence[Any], _tables("link")] = ()
    coupling: Annotated[Sequence[Any], _tables("coupling")] = ()
    load: Annotated[Sequence[Any], _tables("load")] = ()
    outputs: Annotated[Any, opt.entries("a table of outputs", opt.table_of(PLACES))] | None = None


def listed(value: object) -> list[Any]:
    """Return a list as it is, and anything else as a list of itself."""
    return value if isinstance(value, list) else [value]


def read_mesh_model(table: opt.Table, parameters: Sequence[str]) -> Model | None:
    """Return the model that a ``[model]`` table describes, or None where it has faults."""
    before = len(table.faults)
    read, mesh = table.record(MeshModel), table.content("file", read_mesh)
    if mesh is None:  # what the tables say cannot be judged without it
        return None
    count, used = len(mesh.nodes), set[str]()

    def nodes(member: opt.Table, key: str) -> list[int] | int:
        """Return one node, or those of a list of nodes, groups and node sets, once but for `to`."""
        out, before = list[int](), len(table.faults)
        given = member.value(key, NODES)
        for place in [] if given is None else listed(given):
            if isinstance(place, str):
                used.add(place)
                with member.noting(key):
                    out += mesh.nodes_of(place).tolist()
            elif place >= count:
                member.fault(key, from_zero("nodes", count, place), str(place))
            else:
                out.append(place)
        out = out if key == "to" else [*dict.fromkeys(out)]
        if key in SINGLE and len(out) != 1 and len(table.faults) == before:
            member.fault(key, "one node", f"{len(out)} nodes")
        return [*out, 0][0] if key in SINGLE else out

    on_mesh = replace(NODES, read=nodes)
    members: dict[str, list[Any]] = {}
    for kind, make in MEMBERS.items():
        known = [
            replace(x, requirement=on_mesh) if x.requirement is NODES else x
            for x in opt.options(make)
        ]
        found = [member.read(known) for member in table.tables(kind, required=False)]
        with table.noting(kind):
            members[f"{kind}es" if kind == "mass" else f"{kind}s"] = [make(**x) for x in found if x]
    structure = fem.Structure(
        mesh.nodes,
        _groups(table, mesh),
        **members,
        sensors=_places(table, "sensors"),
        parameters=_scales(table, parameters),
    )
    outputs = _places(table, "outputs")
    table.notes += unused_groups(mesh, (g.name for g in structure.groups), used)
    if read is not None and len(table.faults) == before:
        with table.noting():
            return mesh_model(structure, parameters, floating=read.floating, outputs=outputs)
        return None
    # What else would be wrong with the structure; names count in tables with faults as well.
    for sensor in structure.sensors:
        if isinstance(sensor.at, int) and sensor.at >= count:
            table.fault(f"sensors {sensor.name}", from_zero("nodes", count, -1), str(sensor.at))
    tables = [x for k in ("group", "spring", "mass", "load") for x in listed(table.values.get(k))]
    names = [x["name"] for x in tables if isinstance(x, dict) and isinstance(x.get("name"), str)]
    expected = "the name of a group, spring, mass or load"
    for parameter in structure.parameters:
        for name in {*parameter.of}.difference(names):
            table.fault(f"scale {parameter.name} of", expected, suggestion(name, names))
    return None


def _groups(model: opt.Table, mesh: Mesh) -> list[Group]:
    """Return the blocks of all groups; one group may have cells of several types."""
    out: list[Group] = []
    materials: dict[str, Any] = {}
    for key, entry in model.entries("material", "a table E, nu, rho"):
        is_isotropic = not isinstance(entry.values.get("E"), list)
        materials[key] = entry.record(fem.Material if is_isotropic else fem.Orthotropic)
    declared = model.values.get("material")  # those with faults too, which are said there
    known = opt.one_of(*declared) if isinstance(declared, dict) and declared else MATERIAL
    for group in model.tables("group", required=True):
        kind: Kind | None = group.value("elements", opt.one_of(*ELEMENTS))
        values, name = group.read(_of_group(kind, known)), group.values.get("name")
        if kind is None or not opt.is_name(name):
            continue
        with group.noting("name"):
            blocks = mesh.cells_of(str(name), kind)
            if values and (material := materials.get(values["material"])):
                values["material"] = material
                out += [ELEMENTS[kind](cells=cells, **values) for cells in blocks]
    return out


def _places(model: opt.Table, key: str) -> list[fem.Sensor]:
    """Return sensors; one with a list of directions becomes as many, NAMEx, NAMEy and so on."""
    out: list[fem.Sensor] = []
    required = key == "sensors"
    expected = "a table node or at, and direction"
    for name, place in model.entries(key, expected, required=required):
        node, at, tolerance = (place.value(each, PLACED[each], None) for each in PLACED)
        directions = read_directions(place)
        place.close()
        if (node is None) == (at is None):
            place.fault("", "either node or at", "neither" if at is None else "both")
        else:
            spot = at if node is None else node
            out += [fem.Sensor(name + end, spot, each, tolerance) for end, each in directions]
    given = model.values.get(key)
    names = {*(given if isinstance(given, dict) else ()), *(sensor.name for sensor in out)}
    for name in sorted(names) if required else ():
        if is_reserved(name, names):
            expected = "a name that a column of the data can have"
            model.fault(f"{key} {name!r}", expected, repr(name))
    return out


def _scales(model: opt.Table, parameters: Sequence[str]) -> list[fem.Parameter]:
    out: list[fem.Parameter] = []
    for name, scale in model.entries("scale", "a table { quantity = ..., of = [...] }"):
        if name not in parameters:
            nearest = suggestion(name, parameters)
            model.fault(f"scale {name}", "the name of a parameter", nearest)
        elif values := scale.read(opt.options(fem.Parameter)):
            out.append(fem.Parameter(name, **values))
    return out


MESH = ModelKind("mesh", read_mesh_model, table=MeshModel)


def unused_groups(mesh: Mesh, elements: Iterable[str], nodes: Iterable[str]) -> list[Finding]:
    """Return the groups that the model uses neither for ``elements`` nor for ``nodes``.

    A group that shares all of its cells with those that have elements is another name for them.
    """
    used, cells = {*elements}, [{tuple(sorted(x)) for x in b.nodes.tolist()} for b in mesh.blocks]
    made = set().union(*(x for b, x in zip(mesh.blocks, cells, strict=True) if b.group in used))
    out: dict[str, Finding] = {}
    known = used.union(nodes)
    for block, own in zip(mesh.blocks, cells, strict=True):
        if block.group not in known and not own <= made:
            unused = found("unused-group", block.group, type=block.type, cells=len(block.nodes))
            out.setdefault(block.group, unused)
    return list(out.values())
