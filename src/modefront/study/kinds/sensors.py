"""Sensors in a study file: a degree of freedom, or weighted degrees of freedom."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from modefront.data.csv import is_reserved
from modefront.models.matrices import SensorSpec
from modefront.toml import Table, describe, is_name, is_number


def read_sensors(
    model: Table, size: int | None, default: Any = ...
) -> dict[str, SensorSpec] | None:
    """Return the sensors of a model of ``size`` degrees of freedom (None: not known)."""
    table = model.table("sensors", "a table of sensors, name = degree of freedom", default)
    if table is None:
        return None
    out = _read(table, size, lambda name: not is_reserved(name, table.values))
    if not table.values:
        table.fault("", "at least one sensor", "none")
    return out


def read_outputs(
    model: Table, size: int | None, sensors: Iterable[str] | None
) -> dict[str, SensorSpec]:
    """Return the places besides the sensors that predictions may name, given as these are."""
    expected = "a table of outputs, name = degree of freedom"
    table = model.table("outputs", expected, default=None)
    if table is None:
        return {}
    out = _read(table, size, is_name)
    for name in set(sensors or ()).intersection(table.values):
        table.fault(name, "a name that no sensor has", f"'{name}'")
    return out


def read_base(model: Table, size: int | None) -> dict[str, SensorSpec]:
    """Return which degrees of freedom move with the base, for each direction of its motion."""
    expected = "a table, direction = list of the degrees of freedom that move with the base"
    table = model.table("base", expected, default=None)
    if table is None:
        return {}
    for name, value in table.values.items():
        if isinstance(value, list) and all(map(_is_dof, value)):
            table.values[name] = [[dof, 1.0] for dof in value]
    return _read(table, size, is_name)


def _read(table: Table, size: int | None, is_right: Callable[[str], bool]) -> dict[str, SensorSpec]:
    """Return named degrees of freedom, weighted or not; ``is_right`` tells good names."""
    out: dict[str, SensorSpec] = {}
    for name, value in table.values.items():
        if not is_name(name) or name != name.strip() or not is_right(name):
            table.fault(repr(name), "a name that a column of the data can have", repr(name))
            continue
        pairs = [[value, 1.0]] if _is_dof(value) else value
        if not _is_weighted(pairs):
            expected = "a degree of freedom from 0, or a list [[degree of freedom, weight], ...]"
            table.fault(name, expected, describe(value))
            continue
        beyond = [dof for dof, _ in pairs if size is not None and dof >= size]
        if beyond and size is not None:
            found = ", ".join(map(str, beyond))
            one_off = " (they are counted from 0)" if max(beyond) == size else ""
            table.fault(name, f"degrees of freedom from 0 to {size - 1}{one_off}", found)
        elif not _selects(pairs):
            table.fault(name, "weights that do not cancel", describe(pairs))
        else:
            out[name] = [(int(dof), float(weight)) for dof, weight in pairs]
    return out


def _selects(pairs: Iterable[Any]) -> bool:
    """Return whether any degree of freedom has a weight that is not zero."""
    total: dict[int, float] = {}
    for dof, weight in pairs:
        total[dof] = total.get(dof, 0.0) + weight
    return any(total.values())


def _is_dof(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and value >= 0


def _is_weighted(value: object) -> bool:
    return (
        isinstance(value, list)
        and bool(value)
        and all(
            isinstance(pair, list) and len(pair) == 2 and _is_dof(pair[0]) and is_number(pair[1])
            for pair in value
        )
    )
