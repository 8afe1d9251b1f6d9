"""Members of a mesh in a study file: each key is the argument of a class of `modefront.fem`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from modefront import fem
from modefront.fem.mesh import Kind, Mesh
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
from modefront.options import PAIR, Requirement, number, numbers, text
from modefront.study.kinds.sensors import AXES, DIRECTION, DOF, VECTOR, read_axes
from modefront.toml import Table

Finish = Callable[[Any, Table, str, Mesh], Any]
"""Returns what a value of a key of a table becomes on a mesh; None with a fault, which is noted."""


@dataclass(frozen=True)
class Key:
    """Key of a table of members.

    Attributes
    ----------
    requirement : on its value
    required : whether it has to be given
    finish : makes the argument of the class of it
    """

    requirement: Requirement
    required: bool = False
    finish: Finish = lambda value, *_: value


Keys = Mapping[str, Key]


def read_keys(table: Table, keys: Keys, mesh: Mesh) -> dict[str, Any]:
    """Return the values of the keys that are given."""
    out = {}
    for name, key in keys.items():
        value = table.value(name, key.requirement, ... if key.required else None)
        value = None if value is None else key.finish(value, table, name, mesh)
        if value is not None:
            out[name] = value
    return out


def of_keys(keys: Keys, **single: str) -> Schema:
    """Return the schema of a table of keys, of which ``single`` ones have one text as value."""
    known: dict[str, Schema] = {name: {"enum": [value]} for name, value in single.items()}
    known |= {name: key.requirement.described for name, key in keys.items()}
    return closed(known, [*single, *(name for name, key in keys.items() if key.required)])


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


def _nodes(value: Any, table: Table, key: str, mesh: Mesh) -> list[int] | None:
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
    return list(dict.fromkeys(nodes)) if len(table.faults) == before else None


def _node(value: Any, table: Table, key: str, mesh: Mesh) -> int | None:
    nodes = _nodes(value, table, key, mesh)
    if nodes is None or len(nodes) == 1:
        return nodes[0] if nodes else None
    table.fault(key, "one node", f"{len(nodes)} nodes")
    return None


def _axes(_value: Any, table: Table, _key: str, _: Mesh) -> Any:
    axes = read_axes(table)
    return None if axes is None else axes[:2].tolist()


def listed(value: object) -> list[Any]:
    """Return a list as it is, and anything else as a list of itself."""
    return value if isinstance(value, list) else [value]


def _name(what: str) -> Key:
    return Key(text(f"the name of the {what}"), required=True)


def _above_zero(expected: str) -> Key:
    return Key(number(expected, above=0), required=True)


def _one_or(count: int, expected: str, one: Schema) -> Key:
    """Return the key of one number, or of a list of as many, of 0 or more."""
    return Key(Requirement(expected, any_of(one, array(NOT_NEGATIVE, count, count))), required=True)


_PLACE = any_of(DOF, {"type": "string"})
_PLACES = Requirement(
    "a node counted from 0, the name of a group or node set, or a list of these",
    any_of(_PLACE, array(_PLACE, 1)),
)
_NAMES = ", ".join(fem.DIRECTIONS)
_NAMED: Schema = {"enum": [*fem.DIRECTIONS]}

NODES = Key(_PLACES, required=True, finish=_nodes)
NODE = Key(_PLACES, required=True, finish=_node)
SOME_NODES = Key(_PLACES, finish=_nodes)
OF_AXES = Key(AXES, finish=_axes)
OF_VECTOR = Key(numbers("a vector of 3 numbers", VECTOR))
DIRECTIONS = Key(Requirement(f"a list of {_NAMES}", array(_NAMED, 1)))
FORCE = Key(number("an axial force"))

_SHAPES: Mapping[str, tuple[Callable[..., fem.Section], Sequence[str]]] = {
    "rectangle": (fem.rectangle, ("b_y", "b_z")),
    "hollow_rectangle": (fem.hollow_rectangle, ("b_y", "b_z", "wall")),
    "circle": (fem.circle, ("diameter",)),
    "tube": (fem.tube, ("diameter", "wall")),
    "constants": (fem.Section, ("A", "I_y", "I_z", "J")),
}

_OF_CONSTANTS: Keys = {
    "kappa_y": Key(number("a shear factor above 0", above=0)),
    "kappa_z": Key(number("a shear factor above 0", above=0)),
    "shear_centre": Key(numbers("its y and z", PAIR)),
}


def _of_shape(shape: str) -> Keys:
    """Return the keys of a section of a shape."""
    make, names = _SHAPES[shape]
    above = _above_zero("a number above 0")
    return {**dict.fromkeys(names, above), **(_OF_CONSTANTS if make is fem.Section else {})}


def _section(_value: Any, group: Table, key: str, mesh: Mesh) -> fem.Section | None:
    table = group.table(key)
    shape = table.choice("shape", tuple(_SHAPES)) if table else None
    if table is None or shape is None:
        return None
    before = len(table.faults)
    values = read_keys(table, _of_shape(shape), mesh)
    table.close()
    try:
        return _SHAPES[shape][0](**values) if len(table.faults) == before else None
    except fem.FemError as error:
        table.fault("", "a section that is possible", str(error))
        return None


_SECTION = Requirement(
    "a table with shape = " + ", ".join(_SHAPES),
    TABLE,
    entries=chosen("shape", {shape: of_keys(_of_shape(shape), shape=shape) for shape in _SHAPES}),
)
_STRAINS = Requirement("a table, group = free strain", TABLE, entries=table_of(NUMBER))


def _strains(_value: Any, table: Table, key: str, _: Mesh) -> dict[str, float] | None:
    strains = table.table(key)
    return {x: strains.number(x, "a strain") for x in strains.values} if strains else None


ELEMENTS: Mapping[Kind, tuple[Callable[..., Any], Keys]] = {
    "beam": (
        fem.Beams,
        {
            "section": Key(_SECTION, required=True, finish=_section),
            "orientation": OF_VECTOR,
            "offsets": Key(
                Requirement("a vector of 3 numbers for either end", array(VECTOR, 2, 2))
            ),
            "releases": Key(
                Requirement(f"a list for either end, of {_NAMES}", array(array(_NAMED), 2, 2))
            ),
            "force": FORCE,
        },
    ),
    "truss": (
        fem.Trusses,
        {"area": _above_zero("an area above 0"), "force": FORCE},
    ),
    "shell": (
        fem.Shells,
        {
            "thickness": _above_zero("a thickness above 0"),
            "offset": Key(number("a distance")),
            "direction": OF_VECTOR,
        },
    ),
    "solid": (fem.Solids, {"axes": OF_AXES}),
}
"""Kinds of elements of a group, with their keys beside name, elements and material."""

MEMBERS: Mapping[str, tuple[Callable[..., Any], Keys]] = {
    "support": (fem.Support, {"nodes": NODES, "directions": DIRECTIONS, "axes": OF_AXES}),
    "spring": (
        fem.Spring,
        {
            "name": _name("springs"),
            "nodes": NODES,
            "to": SOME_NODES,
            "stiffness": _one_or(6, "a stiffness above 0, or 6 of 0 or more", ABOVE_ZERO),
            "direction": Key(DIRECTION),
            "axes": OF_AXES,
        },
    ),
    "mass": (
        fem.Mass,
        {
            "name": _name("masses"),
            "nodes": NODES,
            "mass": _one_or(3, "a mass of 0 or more, or 3 for x, y and z", NOT_NEGATIVE),
            "inertia": Key(numbers("3 moments of inertia of 0 or more", array(NOT_NEGATIVE, 3, 3))),
            "offset": OF_VECTOR,
        },
    ),
    "link": (fem.Link, {"master": NODE, "slaves": NODES, "directions": DIRECTIONS}),
    "coupling": (
        fem.Coupling,
        {
            "node": NODE,
            "of": NODES,
            "weights": Key(numbers("numbers above 0", array(ABOVE_ZERO, 1))),
            "directions": DIRECTIONS,
        },
    ),
    "load": (
        fem.Load,
        {
            "name": _name("load"),
            "nodes": SOME_NODES,
            "force": Key(
                numbers("3 components, or 6 with moments", any_of(VECTOR, array(NUMBER, 6, 6)))
            ),
            "acceleration": OF_VECTOR,
            "strains": Key(_STRAINS, finish=_strains),
        },
    ),
}
"""Tables of members at nodes, with their keys."""

NAMING_NODES = {"nodes", "to", "master", "slaves", "node", "of"}
"""Keys of members that name nodes."""
