"""``kind = "mesh"``: finite elements on a mesh from a file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, get_args

from modefront import fem
from modefront.data.csv import is_reserved
from modefront.diagnosis.notes import unused_groups
from modefront.errors import suggestion
from modefront.fem.mesh import Kind, Mesh, read_mesh
from modefront.fem.structure import Group, Quantity
from modefront.models.base import Model
from modefront.models.mesh import mesh_model
from modefront.study.kinds.members import (
    ELEMENTS,
    MEMBERS,
    NODES,
    listed,
    read_keys,
    read_members,
)
from modefront.study.kinds.sensors import ModelKind, read_directions
from modefront.toml import Table

AnyMaterial = fem.Material | fem.Orthotropic

KEYS = ("material", "group", *MEMBERS, "sensors", "outputs", "scale")
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
    groups = _groups(table, mesh, _materials(table))
    members = {
        f"{kind}es" if kind == "mass" else f"{kind}s": read_members(table, kind, mesh)
        for kind in MEMBERS
    }
    scales = _scales(table, parameters)
    return fem.Structure(mesh.nodes, groups, **members, sensors=_sensors(table), parameters=scales)


def _named_nodes(model: Table) -> set[str]:
    """Return the groups and node sets that members name."""
    return {
        name
        for kind in MEMBERS
        for table in model.values.get(kind) or ()
        for key in NODES
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
        if isinstance(entry.values.get("E"), list):
            values = [_three(entry, key) for key in ("E", "nu", "G")]
            make: Callable[..., AnyMaterial] = fem.Orthotropic
        else:
            E = entry.number("E", "Young's modulus above 0", lambda x: x > 0)
            nu = entry.number("nu", "Poisson's ratio between -1 and 0.5", lambda x: -1 < x < 0.5)
            values, make = [E, nu], fem.Material
        rho = entry.number("rho", "a density of 0 or more", lambda x: x >= 0)
        entry.close()
        try:
            if len(entry.faults) == before:
                out[name] = make(*values, rho)
        except fem.FemError as error:
            entry.fault("", "a material that is possible", str(error))
    return out


def _three(table: Table, key: str) -> Any:
    """Return the constants of an orthotropic material in its planes or along its axes."""
    return table.numbers(key, f"three values of {key}", lambda x: len(x) == 3)


def _groups(model: Table, mesh: Mesh, materials: dict[str, AnyMaterial]) -> list[Group]:
    """Return the blocks of all groups; one group may have cells of several types."""
    out: list[Group] = []
    for group in model.tables("group", required=True):
        before = len(group.faults)
        name = group.text("name", "the name of a group of cells")
        kind: Kind | None = group.choice("elements", get_args(Kind))
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
