"""Sensors in a study file: a degree of freedom, or weighted degrees of freedom."""

from __future__ import annotations

from typing import Any

from modefront.models.matrices import SensorSpec
from modefront.study.reader import Table, describe, is_number


def read_sensors(
    model: Table, size: int | None, default: Any = ...
) -> dict[str, SensorSpec] | None:
    """Return the sensors of a model of ``size`` degrees of freedom (None: not known)."""
    table = model.table("sensors", "a table of sensors, name = degree of freedom", default)
    if table is None:
        return None
    out: dict[str, SensorSpec] = {}
    for name, value in table.values.items():
        pairs = [[value, 1.0]] if _is_dof(value) else value
        if not _is_weighted(pairs):
            expected = "a degree of freedom from 0, or a list [[degree of freedom, weight], ...]"
            table.fault(name, expected, describe(value))
            continue
        beyond = [dof for dof, _ in pairs if size is not None and dof >= size]
        if beyond and size is not None:
            found = ", ".join(map(str, beyond))
            table.fault(name, f"degrees of freedom from 0 to {size - 1}", found)
        elif not any(weight for _, weight in pairs):
            table.fault(name, "a weight that is not zero", "only zeros")
        elif not name.strip():
            table.fault(f"'{name}'", "a name", "nothing")
        else:
            out[name] = [(int(dof), float(weight)) for dof, weight in pairs]
    if not table.values:
        table.fault("", "at least one sensor", "none")
    return out


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
