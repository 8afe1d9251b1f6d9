"""Members of a mesh in a study file: each key is the argument of a class of `modefront.fem`."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from modefront import fem
from modefront.fem.mesh import Kind, Mesh
from modefront.options import is_number
from modefront.study.kinds.sensors import is_dof, read_axes, read_direction
from modefront.toml import Table

Reader = Callable[[Table, str, Mesh], Any]
"""Reads a key of a table; None where it is not given, or has a fault, which is noted."""

Keys = Mapping[str, Reader]


def read_keys(table: Table, keys: Keys, mesh: Mesh) -> dict[str, Any]:
    """Return the values of the keys that are given."""
    values = {key: read(table, key, mesh) for key, read in keys.items()}
    return {key: value for key, value in values.items() if value is not None}


def read_members(model: Table, kind: str, mesh: Mesh) -> list[Any]:
    """Return the members of all tables ``[[model.kind]]`` without faults."""
    make, keys = MEMBERS[kind]
    out = []
    for table in model.tables(kind, required=False):
        before = len(table.faults)
        values = read_keys(table, keys, mesh)
        table.close()
        if len(table.faults) == before:
            out.append(make(**values))
    return out


def _name(what: str) -> Reader:
    return lambda table, key, _: table.text(key, f"the name of the {what}")


def _number(
    expected: str, test: Callable[[float], bool] = math.isfinite, default: Any = None
) -> Reader:
    return lambda table, key, _: table.number(key, expected, test, default)


def _value(expected: str, test: Callable[[Any], bool]) -> Reader:
    return lambda table, key, _: table.take(key, expected, test, None)


def _numbers(expected: str, test: Callable[[list[float]], bool]) -> Reader:
    return lambda table, key, _: table.numbers(key, expected, test, default=None)


def _one_or(count: int, expected: str, test: Callable[[float], bool]) -> Reader:
    """Return a reader of a number that passes a test, or of a list of as many, of 0 or more."""

    def is_right(value: Any) -> bool:
        if isinstance(value, list):
            return len(value) == count and all(map(is_number, value)) and min(value) >= 0
        return is_number(value) and test(value)

    return lambda table, key, _: table.take(key, expected, is_right, ...)


_vector = _numbers("a vector of 3 numbers", lambda x: len(x) == 3)


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
    return list(dict.fromkeys(nodes)) if len(table.faults) == before else None


def _some_nodes(table: Table, key: str, mesh: Mesh) -> list[int] | None:
    return _nodes(table, key, mesh, None)


def _node(table: Table, key: str, mesh: Mesh) -> int | None:
    nodes = _nodes(table, key, mesh)
    if nodes is None or len(nodes) == 1:
        return nodes[0] if nodes else None
    table.fault(key, "one node", f"{len(nodes)} nodes")
    return None


def listed(value: object) -> list[Any]:
    """Return a list as it is, and anything else as a list of itself."""
    return value if isinstance(value, list) else [value]


def _is_place(value: object) -> bool:
    return isinstance(value, str) or is_dof(value)


def _are_directions(value: Any) -> bool:
    return isinstance(value, list) and all(x in fem.DIRECTIONS for x in value)


def _is_vector(value: Any) -> bool:
    return isinstance(value, list) and len(value) == 3 and all(map(is_number, value))


def _of_both(test: Callable[[Any], bool]) -> Callable[[Any], bool]:
    return lambda ends: isinstance(ends, list) and len(ends) == 2 and all(map(test, ends))


_NAMES = ", ".join(fem.DIRECTIONS)
_directions = _value(f"a list of {_NAMES}", lambda x: bool(x) and _are_directions(x))
_releases = _value(f"a list for either end, of {_NAMES}", _of_both(_are_directions))
_offsets = _value("a vector of 3 numbers for either end", _of_both(_is_vector))


def _axes(table: Table, _key: str, _: Mesh) -> Any:
    axes = read_axes(table)
    return None if axes is None else axes[:2].tolist()


def _strains(table: Table, key: str, _: Mesh) -> dict[str, float] | None:
    strains = table.table(key, "a table, group = free strain", default=None)
    if strains is None:
        return None
    return {name: strains.number(name, "a strain", math.isfinite) for name in strains.values}


_SHAPES: Mapping[str, tuple[Callable[..., fem.Section], Sequence[str]]] = {
    "rectangle": (fem.rectangle, ("b_y", "b_z")),
    "hollow_rectangle": (fem.hollow_rectangle, ("b_y", "b_z", "wall")),
    "circle": (fem.circle, ("diameter",)),
    "tube": (fem.tube, ("diameter", "wall")),
    "constants": (fem.Section, ("A", "I_y", "I_z", "J")),
}

_OF_CONSTANTS: Keys = {
    "kappa_y": _number("a shear factor above 0", lambda x: x > 0),
    "kappa_z": _number("a shear factor above 0", lambda x: x > 0),
    "shear_centre": _numbers("its y and z", lambda x: len(x) == 2),
}


def _section(group: Table, key: str, mesh: Mesh) -> fem.Section | None:
    table = group.table(key, "a table with shape = " + ", ".join(_SHAPES))
    shape = table.choice("shape", tuple(_SHAPES)) if table else None
    if table is None or shape is None:
        return None
    make, names = _SHAPES[shape]
    before = len(table.faults)
    above = _number("a number above 0", lambda x: x > 0, ...)
    keys = {**dict.fromkeys(names, above), **(_OF_CONSTANTS if make is fem.Section else {})}
    values = read_keys(table, keys, mesh)
    table.close()
    try:
        return make(**values) if len(table.faults) == before else None
    except fem.FemError as error:
        table.fault("", "a section that is possible", str(error))
        return None


_FORCE = _number("an axial force")

ELEMENTS: Mapping[Kind, tuple[Callable[..., Any], Keys]] = {
    "beam": (
        fem.Beams,
        {
            "section": _section,
            "orientation": _vector,
            "offsets": _offsets,
            "releases": _releases,
            "force": _FORCE,
        },
    ),
    "truss": (
        fem.Trusses,
        {"area": _number("an area above 0", lambda x: x > 0, ...), "force": _FORCE},
    ),
    "shell": (
        fem.Shells,
        {
            "thickness": _number("a thickness above 0", lambda x: x > 0, ...),
            "offset": _number("a distance"),
            "direction": _vector,
        },
    ),
    "solid": (fem.Solids, {"axes": _axes}),
}
"""Kinds of elements of a group, with their keys beside name, elements and material."""

MEMBERS: Mapping[str, tuple[Callable[..., Any], Keys]] = {
    "support": (fem.Support, {"nodes": _nodes, "directions": _directions, "axes": _axes}),
    "spring": (
        fem.Spring,
        {
            "name": _name("springs"),
            "nodes": _nodes,
            "to": _some_nodes,
            "stiffness": _one_or(6, "a stiffness above 0, or 6 of 0 or more", lambda x: x > 0),
            "direction": lambda table, _key, _: read_direction(table, default=None),
            "axes": _axes,
        },
    ),
    "mass": (
        fem.Mass,
        {
            "name": _name("masses"),
            "nodes": _nodes,
            "mass": _one_or(3, "a mass of 0 or more, or 3 for x, y and z", lambda x: x >= 0),
            "inertia": _numbers(
                "3 moments of inertia of 0 or more", lambda x: len(x) == 3 and min(x) >= 0
            ),
            "offset": _vector,
        },
    ),
    "link": (fem.Link, {"master": _node, "slaves": _nodes, "directions": _directions}),
    "coupling": (
        fem.Coupling,
        {
            "node": _node,
            "of": _nodes,
            "weights": _numbers("numbers above 0", lambda x: bool(x) and min(x) > 0),
            "directions": _directions,
        },
    ),
    "load": (
        fem.Load,
        {
            "name": _name("load"),
            "nodes": _some_nodes,
            "force": _numbers("3 components, or 6 with moments", lambda x: len(x) in (3, 6)),
            "acceleration": _vector,
            "strains": _strains,
        },
    ),
}
"""Tables of members at nodes, with their keys."""

NODES = {"nodes", "to", "master", "slaves", "node", "of"}
"""Keys of members that name nodes."""
