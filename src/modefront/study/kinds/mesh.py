"""``kind = "mesh"``: finite elements on a mesh from a file."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, get_args

from modefront import fem
from modefront.data.csv import is_reserved
from modefront.diagnosis.notes import unused_groups
from modefront.errors import suggestion
from modefront.fem.mesh import Kind, Mesh, read_mesh
from modefront.fem.structure import Quantity
from modefront.models.base import Model
from modefront.models.mesh import mesh_model
from modefront.study.kinds.sensors import ModelKind, is_dof, read_direction, read_directions
from modefront.toml import Table

_SHAPES: Mapping[str, tuple[Callable[..., fem.Section], Sequence[str]]] = {
    "rectangle": (fem.rectangle, ("b_y", "b_z")),
    "hollow_rectangle": (fem.hollow_rectangle, ("b_y", "b_z", "wall")),
    "circle": (fem.circle, ("diameter",)),
    "tube": (fem.tube, ("diameter", "wall")),
    "constants": (fem.Section, ("A", "I_y", "I_z", "J")),
}

KEYS = ("material", "group", "support", "spring", "mass", "link", "sensors", "outputs", "scale")
"""Tables that describe what the mesh is made of."""


def read_mesh_model(table: Table, parameters: Sequence[str]) -> Model | None:
    """Return the model that a ``[model]`` table describes, or None where it has faults."""
    before = len(table.faults)
    name = table.text("file", "the name of a mesh file")
    mesh: Mesh | None = None
    if name is not None:
        try:
            mesh = read_mesh(table.path(name))
        except fem.FemError as error:
            table.fault("file", "a mesh that can be read", str(error))
    floating = table.take("floating", "true or false", lambda x: isinstance(x, bool), False)
    if mesh is None:
        table.requested += KEYS  # what they say cannot be judged without the mesh
        return None
    structure, outputs = _structure(table, parameters, mesh), _outputs(table)
    table.notes += unused_groups(mesh, (g.name for g in structure.groups), _named_nodes(table))
    if len(table.faults) > before:
        _look_further(table, structure, mesh)
        return None
    try:
        return mesh_model(structure, parameters, floating=floating, outputs=outputs)
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
        for kind in ("group", "spring", "mass")
        for entry in table.values.get(kind) or ()
        for name in [entry.get("name")]
        if isinstance(name, str)
    ]
    for parameter in structure.parameters:
        for name in parameter.of:
            if name not in named:
                expected = "the name of a group, spring or mass"
                table.fault(f"scale {parameter.name} of", expected, suggestion(name, named))


def _structure(table: Table, parameters: Sequence[str], mesh: Mesh) -> fem.Structure:
    materials = _materials(table)
    return fem.Structure(
        mesh.nodes,
        _groups(table, mesh, materials),
        _supports(table, mesh),
        _springs(table, mesh),
        _masses(table, mesh),
        _links(table, mesh),
        _sensors(table),
        _scales(table, parameters),
    )


def _named_nodes(model: Table) -> set[str]:
    """Return the groups and node sets that supports, springs, masses and links name."""
    named: set[str] = set()
    for kind in ("support", "spring", "mass", "link"):
        for table in model.values.get(kind) or ():
            for key in ("nodes", "to", "master", "slaves"):
                value = table.get(key)
                named.update(x for x in _listed(value) if isinstance(x, str))
    return named


def _listed(value: object) -> list[Any]:
    return value if isinstance(value, list) else [value]


def _materials(model: Table) -> dict[str, fem.Material]:
    out: dict[str, fem.Material] = {}
    table = model.table("material", "a table of materials")
    if table is not None and not table.values:
        table.fault("", "at least one material", "none")
    for name in table.values if table else ():
        entry = table.table(name, "a table E, nu, rho") if table else None
        if entry is None:
            continue
        E = entry.number("E", "Young's modulus above 0", lambda x: x > 0)
        nu = entry.number("nu", "Poisson's ratio between -1 and 0.5", lambda x: -1 < x < 0.5)
        rho = entry.number("rho", "a density of 0 or more", lambda x: x >= 0)
        entry.close()
        if None not in (E, nu, rho):
            out[name] = fem.Material(E, nu, rho)
    return out


def _groups(
    model: Table, mesh: Mesh, materials: dict[str, fem.Material]
) -> list[fem.Beams | fem.Shells | fem.Solids]:
    """Return the blocks of all groups; one group may have cells of several types."""
    out: list[fem.Beams | fem.Shells | fem.Solids] = []
    for group in model.tables("group", required=True):
        name = group.text("name", "the name of a group of cells")
        kind: Kind | None = group.choice("elements", get_args(Kind))
        declared = model.values.get("material")  # those with faults too, which are said there
        names = tuple(declared) if isinstance(declared, dict) else ()
        label = group.choice("material", names) if names else group.text("material")
        thickness = offset = section = orientation = None
        if kind == "shell":
            thickness = group.number("thickness", "a thickness above 0", lambda x: x > 0)
            offset = group.number("offset", "a distance", math.isfinite, default=0.0)
        if kind == "beam":
            section = _section(group)
            orientation = group.numbers(
                "orientation", "a vector of 3 numbers", lambda x: len(x) == 3, default=None
            )
        group.close()
        if name is None or kind is None or label not in materials:
            continue
        try:
            blocks = mesh.cells_of(name, kind)
        except fem.FemError as error:
            group.fault("name", "a group of the mesh", str(error))
            continue
        for cells in blocks:
            if kind == "beam" and section is not None:
                out.append(fem.Beams(name, cells, materials[label], section, orientation))
            elif kind == "shell" and thickness is not None:
                out.append(fem.Shells(name, cells, materials[label], thickness, offset or 0.0))
            elif kind == "solid":
                out.append(fem.Solids(name, cells, materials[label]))
    return out


def _section(group: Table) -> fem.Section | None:
    table = group.table("section", "a table with shape = " + ", ".join(_SHAPES))
    shape = table.choice("shape", tuple(_SHAPES)) if table else None
    if table is None or shape is None:
        return None
    make, keys = _SHAPES[shape]
    values = [table.number(key, "a number above 0", lambda x: x > 0) for key in keys]
    table.close()
    if None in values:
        return None
    try:
        section = make(*values)
    except fem.FemError as error:
        table.fault("", "a section that is possible", str(error))
        return None
    return section


def _nodes(table: Table, key: str, mesh: Mesh, default: Any = ...) -> list[int] | None:
    """Return nodes: one, or a list of nodes and of groups or node sets of the mesh."""
    value = table.take(
        key,
        "a node counted from 0, the name of a group or node set, or a list of these",
        lambda x: _is_place(x) or (isinstance(x, list) and bool(x) and all(map(_is_place, x))),
        default,
    )
    if value is None:
        return None
    nodes: list[int] = []
    before = len(table.faults)
    for place in _listed(value):
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
    return list(dict.fromkeys(nodes)) if len(table.faults) == before else None


def _is_place(value: object) -> bool:
    return isinstance(value, str) or is_dof(value)


def _directions(table: Table) -> list[str]:
    known = list(fem.DIRECTIONS)
    value = table.take(
        "directions",
        "a list of " + ", ".join(known),
        lambda x: isinstance(x, list) and bool(x) and all(y in known for y in x),
        known,
    )
    return list(value)


def _supports(model: Table, mesh: Mesh) -> list[fem.Support]:
    out = []
    for support in model.tables("support", required=False):
        nodes, directions = _nodes(support, "nodes", mesh), _directions(support)
        support.close()
        if nodes is not None:
            out.append(fem.Support(nodes, directions))
    return out


def _springs(model: Table, mesh: Mesh) -> list[fem.Spring]:
    out = []
    for spring in model.tables("spring", required=False):
        name = spring.text("name", "the name of the springs")
        nodes = _nodes(spring, "nodes", mesh)
        to = _nodes(spring, "to", mesh, default=None)
        stiffness = spring.number("stiffness", "a stiffness above 0", lambda x: x > 0)
        direction = read_direction(spring, default=None)
        spring.close()
        if name is not None and nodes is not None and stiffness is not None:
            out.append(fem.Spring(name, nodes, stiffness, direction, to))
    return out


def _masses(model: Table, mesh: Mesh) -> list[fem.Mass]:
    out = []
    for entry in model.tables("mass", required=False):
        name = entry.text("name", "the name of the masses")
        nodes = _nodes(entry, "nodes", mesh)
        mass = entry.number("mass", "a mass of 0 or more", lambda x: x >= 0)
        inertia = entry.numbers(
            "inertia",
            "3 moments of inertia of 0 or more",
            lambda x: len(x) == 3 and min(x) >= 0,
            default=[0.0, 0.0, 0.0],
        )
        offset = entry.numbers(
            "offset", "a vector of 3 numbers", lambda x: len(x) == 3, default=[0.0, 0.0, 0.0]
        )
        entry.close()
        if name is not None and nodes is not None and mass is not None:
            out.append(fem.Mass(name, nodes, mass, inertia or (0, 0, 0), offset or (0, 0, 0)))
    return out


def _links(model: Table, mesh: Mesh) -> list[fem.Link]:
    out = []
    for link in model.tables("link", required=False):
        master = _nodes(link, "master", mesh)
        slaves = _nodes(link, "slaves", mesh)
        directions = _directions(link)
        link.close()
        if master is not None and len(master) != 1:
            link.fault("master", "one node", f"{len(master)} nodes")
        elif master is not None and slaves is not None:
            out.append(fem.Link(master[0], [n for n in slaves if n != master[0]], directions))
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
        node = place.integer("node", 0, 10**9, default=None)
        coordinates = place.numbers("at", "3 coordinates", lambda x: len(x) == 3, default=None)
        directions = read_directions(place)
        tolerance = place.number("tolerance", "a distance above 0", lambda x: x > 0, default=None)
        place.close()
        if (node is None) == (coordinates is None):
            place.fault("", "either node or at", "both" if node is not None else "neither")
            continue
        position = node if coordinates is None else coordinates
        for ending, direction in directions:
            out.append(fem.Sensor(name + ending, position, direction, tolerance))
    return out


def _scales(model: Table, parameters: Sequence[str]) -> list[fem.Parameter]:
    """Return what each parameter scales: one quantity of named groups, springs or masses."""
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
        quantity: Quantity | None = scale.choice("quantity", get_args(Quantity))
        of = scale.take(
            "of",
            "a list of groups, springs or masses",
            lambda x: isinstance(x, list) and bool(x) and all(isinstance(y, str) for y in x),
            ...,
        )
        scale.close()
        if quantity is not None and of is not None:
            out.append(fem.Parameter(name, quantity, of))
    return out


MESH = ModelKind("mesh", read_mesh_model)
