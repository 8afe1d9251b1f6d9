"""Sensors in a study file: degrees of freedom, weighted or not, or a node and a direction."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby
from operator import itemgetter
from typing import Any

from modefront import options as opt
from modefront.data.csv import is_reserved
from modefront.fem.check import axes_of, unit_vector
from modefront.fem.structure import AXES, DIRECTION, DIRECTIONS, NAMED
from modefront.models.base import Model
from modefront.models.dofs import DofTable
from modefront.models.matrices import DOF, WEIGHTED, SensorSpec
from modefront.text import Shown


@dataclass(frozen=True, repr=False)
class ModelKind(Shown):
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
    read: Callable[[opt.Table, Sequence[str]], Model | None]
    is_reducible: bool = True
    table: Callable[..., Any] | None = None


SEVERAL = opt.Requirement(
    "a list of different ones of " + ", ".join(NAMED),
    opt.array({"enum": NAMED}, 1, once=True),
    further=lambda x: len({y.removeprefix("-") for y in x}) == len(x),
)
ORIENTED = {"direction": opt.any_of(DIRECTION.schema, SEVERAL.schema), "axes": AXES.schema}
"""Keys that say along which directions sensors measure at a node."""

NODE = opt.whole(1, 2**62)
BY_NODE = opt.closed({"node": NODE.schema} | ORIENTED, ["node", "direction"])


def from_zero(what: str, count: int, found: int) -> str:
    """Return which numbers are expected of ``what``, which are counted from 0."""
    return f"{what} from 0 to {count - 1}" + " (they are counted from 0)" * (found == count)


def read_directions(place: opt.Table) -> list[tuple[str, Any]]:
    """Return the directions of a sensor in the axes of the model, with what each adds to its name.

    A list of named directions makes as many sensors: NAMEx, NAMEy and so on. With ``axes`` they are
    local.
    """
    given = place.values.get("direction")
    several = isinstance(given, list) and any(isinstance(x, str) for x in given)
    value = place.value("direction", SEVERAL if several else DIRECTION)
    axes, out = place.value("axes", AXES, None), list[tuple[str, Any]]()
    for direction in (value or ()) if several else [value][: value is not None]:
        axis = str(direction).removeprefix("-")
        if axes is not None and isinstance(direction, str) and axis not in DIRECTIONS[:3]:
            place.fault("direction", "x, y or z where axes are given", f"'{direction}'")
        else:
            local = direction if axes is None else unit_vector(direction)[:3] @ axes_of(axes)
            out.append((axis if several else "", opt.plain(local)))
    return out


EXPECTED = {
    "sensors": "a table of sensors, name = degree of freedom",
    "outputs": "a table of outputs, name = degree of freedom",
    "base": "a table, direction = list of the degrees of freedom that move with the base",
}
"""Tables of places."""


# 6 arguments: the table, the model's size and nodes, and what differs between the tables.
def read_places(
    model: opt.Table,
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
        if wrong := not opt.is_name(name) or name != name.strip() or reserved:
            table.fault(place, "a name that a column of the data can have", repr(name))
        return not wrong

    out: dict[str, SensorSpec] = {}
    for name, value in table.values.items():
        if not is_right(name, repr(name)):
            continue
        pairs = [[value, 1.0]] if opt.fits(value, DOF) else value
        if key == "base" and isinstance(value, list) and all(opt.fits(dof, DOF) for dof in value):
            pairs = [[dof, 1.0] for dof in value]
        elif key == "base" and dofs and value in [{"direction": each} for each in DIRECTIONS]:
            pairs = [list(pair) for pair in dofs.of_direction(value["direction"])]
        elif isinstance(value, dict) and {"node", "direction"} & value.keys():
            out |= {x: y for x, y in _by_node(table, name, dofs).items() if is_right(x, name)}
            continue
        if not opt.fits(pairs, WEIGHTED):
            expected = "a degree of freedom from 0, or a list [[degree of freedom, weight], ...]"
            table.fault(name, expected, opt.shown(value))
        elif beyond := [dof for dof, _ in pairs if size is not None and dof >= size]:
            expected = from_zero("degrees of freedom", size or 0, max(beyond))
            table.fault(name, expected, ", ".join(map(str, beyond)))
        elif not any(sum(w for _, w in of) for _, of in groupby(sorted(pairs), itemgetter(0))):
            table.fault(name, "weights that do not cancel", opt.shown(pairs))
        else:
            out[name] = [(int(dof), float(weight)) for dof, weight in pairs]
    return out


def _by_node(table: opt.Table, name: str, dofs: DofTable | None) -> dict[str, SensorSpec]:
    """Return the degrees of freedom of a place given by node and direction; of each direction."""
    if dofs is None or (place := table.table(name)) is None:
        expected = 'a degree of freedom; nodes and directions need dofs = "dofs.csv"'
        table.fault(name, expected, opt.shown(table.values[name]))
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
