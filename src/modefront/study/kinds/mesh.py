"""``kind = "mesh"``: finite elements on a mesh from a file."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, get_args

from modefront import fem
from modefront._typing import Ints
from modefront.data.csv import is_reserved
from modefront.diagnosis.places import unused_groups
from modefront.errors import suggestion
from modefront.fem.mesh import Kind, Mesh, read_mesh
from modefront.fem.structure import Group, Quantity
from modefront.models.base import Model
from modefront.models.mesh import mesh_model
from modefront.options import is_number
from modefront.study.kinds.sensors import (
    ModelKind,
    is_dof,
    read_axes,
    read_direction,
    read_directions,
)
from modefront.toml import Table

_SHAPES: Mapping[str, tuple[Callable[..., fem.Section], Sequence[str]]] = {
    "rectangle": (fem.rectangle, ("b_y", "b_z")),
    "hollow_rectangle": (fem.hollow_rectangle, ("b_y", "b_z", "wall")),
    "circle": (fem.circle, ("diameter",)),
    "tube": (fem.tube, ("diameter", "wall")),
    "constants": (fem.Section, ("A", "I_y", "I_z", "J")),
}

NODES = {
    "support": ("nodes",),
    "spring": ("nodes", "to"),
    "mass": ("nodes",),
    "link": ("master", "slaves"),
    "coupling": ("node", "of"),
    "load": ("nodes",),
}
"""Tables at nodes, with the keys that name these."""

KEYS = ("material", "group", *NODES, "sensors", "outputs", "scale")
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
        for kind in ("group", "spring", "mass", "load")
        for entry in table.values.get(kind) or ()
        for name in [entry.get("name")]
        if isinstance(name, str)
    ]
    for parameter in structure.parameters:
        for name in parameter.of:
            if name not in named:
                expected = "the name of a group, spring, mass or load"
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
        _couplings(table, mesh),
        _loads(table, mesh),
        _sensors(table),
        _scales(table, parameters),
    )


def _named_nodes(model: Table) -> set[str]:
    """Return the groups and node sets that supports, springs, masses, links and loads name."""
    named: set[str] = set()
    for kind, keys in NODES.items():
        for table in model.values.get(kind) or ():
            for key in keys:
                named.update(x for x in _listed(table.get(key)) if isinstance(x, str))
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


def _vector(table: Table, key: str, default: Any = (0.0, 0.0, 0.0)) -> Any:
    return table.numbers(key, "a vector of 3 numbers", lambda x: len(x) == 3, default)


def _groups(model: Table, mesh: Mesh, materials: dict[str, fem.Material]) -> list[Group]:
    """Return the blocks of all groups; one group may have cells of several types."""
    out: list[Group] = []
    for group in model.tables("group", required=True):
        name = group.text("name", "the name of a group of cells")
        kind: Kind | None = group.choice("elements", get_args(Kind))
        declared = model.values.get("material")  # those with faults too, which are said there
        names = tuple(declared) if isinstance(declared, dict) else ()
        label = group.choice("material", names) if names else group.text("material")
        before = len(group.faults)
        make = _MEMBERS[kind](group) if kind is not None else None
        group.close()
        if name is None or make is None or kind is None or label not in materials:
            continue
        try:
            blocks = mesh.cells_of(name, kind)
        except fem.FemError as error:
            group.fault("name", "a group of the mesh", str(error))
            continue
        if len(group.faults) == before:
            out += [make(name, cells, materials[label]) for cells in blocks]
    return out


Maker = Callable[[str, Ints, fem.Material], Group]
"""A member of a group: from its name, cells and material."""


def _shells(group: Table) -> Maker:
    thickness = group.number("thickness", "a thickness above 0", lambda x: x > 0)
    offset = group.number("offset", "a distance", math.isfinite, default=0.0)
    return lambda name, cells, material: fem.Shells(name, cells, material, thickness, offset)


def _beams(group: Table) -> Maker:
    section, orientation = _section(group), _vector(group, "orientation", None)
    offsets = group.take("offsets", "a vector of 3 numbers for either end", _is_pair(3), None)
    releases = group.take(
        "releases",
        "a list for either end, of " + ", ".join(fem.DIRECTIONS),
        lambda x: isinstance(x, list) and len(x) == 2 and all(map(_are_directions, x)),
        ([], []),
    )
    force = group.number("force", "an axial force", math.isfinite, default=0.0)
    options = {"releases": tuple(releases), "force": force}
    if offsets is not None:
        options["offsets"] = offsets
    return lambda name, cells, material: fem.Beams(
        name, cells, material, section, orientation, **options
    )


def _trusses(group: Table) -> Maker:
    area = group.number("area", "an area above 0", lambda x: x > 0)
    force = group.number("force", "an axial force", math.isfinite, default=0.0)
    return lambda name, cells, material: fem.Trusses(name, cells, material, area, force)


_MEMBERS: Mapping[Kind, Callable[[Table], Maker]] = {
    "beam": _beams,
    "truss": _trusses,
    "shell": _shells,
    "solid": lambda _: fem.Solids,
}


def _section(group: Table) -> Any:
    table = group.table("section", "a table with shape = " + ", ".join(_SHAPES))
    shape = table.choice("shape", tuple(_SHAPES)) if table else None
    if table is None or shape is None:
        return None
    make, keys = _SHAPES[shape]
    values = [table.number(key, "a number above 0", lambda x: x > 0) for key in keys]
    more: dict[str, Any] = {}
    if make is fem.Section:
        for key in ("kappa_y", "kappa_z"):
            more[key] = table.number(key, "a shear factor above 0", lambda x: x > 0, 5 / 6)
        centre = table.numbers("shear_centre", "its y and z", lambda x: len(x) == 2, [0.0, 0.0])
        more["shear_centre"] = tuple(centre or ())
    table.close()
    if None in values:
        return None
    try:
        section = make(*values, **more)
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


def _are_directions(value: object) -> bool:
    return isinstance(value, list) and all(x in fem.DIRECTIONS for x in value)


def _is_pair(count: int) -> Callable[[object], bool]:
    """Return a test for two lists of as many numbers."""
    return lambda pair: (
        isinstance(pair, list)
        and len(pair) == 2
        and all(isinstance(x, list) and len(x) == count and all(map(is_number, x)) for x in pair)
    )


def _directions(table: Table) -> list[str]:
    value = table.take(
        "directions",
        "a list of " + ", ".join(fem.DIRECTIONS),
        lambda x: bool(x) and _are_directions(x),
        fem.ALL,
    )
    return list(value)


def _numbers(table: Table, key: str, expected: str, count: int, strict: bool = False) -> Any:
    """Return a number, or a list of as many, of 0 or more; a lone one above 0 where `strict`."""
    return table.take(
        key,
        expected,
        lambda x: (
            len(x) == count and all(map(is_number, x)) and min(x) >= 0
            if isinstance(x, list)
            else is_number(x) and (x > 0 if strict else x >= 0)
        ),
        ...,
    )


def _axes(table: Table) -> Any:
    """Return the first two of local axes; None for those of the model."""
    axes = read_axes(table)
    return None if axes is None else (axes[0].tolist(), axes[1].tolist())


def _supports(model: Table, mesh: Mesh) -> list[fem.Support]:
    out = []
    for support in model.tables("support", required=False):
        nodes, directions = _nodes(support, "nodes", mesh), _directions(support)
        axes = _axes(support)
        support.close()
        if nodes is not None:
            out.append(fem.Support(nodes, directions, axes))
    return out


def _springs(model: Table, mesh: Mesh) -> list[fem.Spring]:
    out = []
    for spring in model.tables("spring", required=False):
        name = spring.text("name", "the name of the springs")
        nodes = _nodes(spring, "nodes", mesh)
        to = _nodes(spring, "to", mesh, default=None)
        expected = "a stiffness above 0, or 6 of 0 or more"
        stiffness = _numbers(spring, "stiffness", expected, 6, strict=True)
        direction, axes = read_direction(spring, default=None), _axes(spring)
        spring.close()
        if name is not None and nodes is not None and stiffness is not None:
            out.append(fem.Spring(name, nodes, stiffness, direction, to, axes))
    return out


def _masses(model: Table, mesh: Mesh) -> list[fem.Mass]:
    out = []
    for entry in model.tables("mass", required=False):
        name = entry.text("name", "the name of the masses")
        nodes = _nodes(entry, "nodes", mesh)
        mass = _numbers(entry, "mass", "a mass of 0 or more, or 3 for x, y and z", 3)
        inertia = entry.numbers(
            "inertia",
            "3 moments of inertia of 0 or more",
            lambda x: len(x) == 3 and min(x) >= 0,
            default=[0.0, 0.0, 0.0],
        )
        offset = _vector(entry, "offset")
        entry.close()
        if name is not None and nodes is not None and mass is not None:
            out.append(fem.Mass(name, nodes, mass, inertia or (0, 0, 0), offset))
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


def _couplings(model: Table, mesh: Mesh) -> list[fem.Coupling]:
    out = []
    for entry in model.tables("coupling", required=False):
        node, of = _nodes(entry, "node", mesh), _nodes(entry, "of", mesh)
        directions = _directions(entry)
        weights = entry.numbers("weights", "numbers above 0", lambda x: min(x) > 0, default=None)
        entry.close()
        if node is None or of is None:
            continue
        if len(node) != 1:
            entry.fault("node", "one node", f"{len(node)} nodes")
        elif weights is not None and len(weights) != len(of):
            entry.fault("weights", f"one for each of {len(of)} nodes", f"{len(weights)}")
        else:
            out.append(fem.Coupling(node[0], of, 1.0 if weights is None else weights, directions))
    return out


def _loads(model: Table, mesh: Mesh) -> list[fem.Load]:
    out = []
    for entry in model.tables("load", required=False):
        name = entry.text("name", "the name of the load")
        nodes = _nodes(entry, "nodes", mesh, default=None)
        expected = "3 components, or 6 with moments"
        force = entry.numbers("force", expected, lambda x: len(x) in (3, 6), default=None)
        if (nodes is None) != (force is None):
            entry.fault("", "nodes and force together", "nodes" if force is None else "force")
        acceleration = _vector(entry, "acceleration")
        table = entry.table("strains", "a table, group = free strain", default=None)
        strains = {
            group: table.number(group, "a strain", math.isfinite)
            for group in (table.values if table is not None else ())
            if table is not None
        }
        entry.close()
        if name is not None and acceleration is not None and None not in strains.values():
            out.append(fem.Load(name, nodes or (), force or (0, 0, 0), acceleration, strains))
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
        quantity: Quantity | None = scale.choice("quantity", get_args(Quantity))
        of = scale.take(
            "of",
            "a list of groups, springs, masses or loads",
            lambda x: isinstance(x, list) and bool(x) and all(isinstance(y, str) for y in x),
            ...,
        )
        scale.close()
        if quantity is not None and of is not None:
            out.append(fem.Parameter(name, quantity, of))
    return out


MESH = ModelKind("mesh", read_mesh_model)
