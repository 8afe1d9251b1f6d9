"""``[[group]]``: which residuals add up to an objective."""

from __future__ import annotations

from collections.abc import Sequence
from typing import get_args

from modefront.data.modal import ModalData
from modefront.residuals.groups import (
    Group,
    Scale,
    measured_frequencies,
    measured_shapes,
    members,
)
from modefront.residuals.problem import check_std
from modefront.study.reader import Table, has_name, repeated


def read_groups(root: Table, data: ModalData | None) -> tuple[Group, ...]:
    """Return the groups that a study names."""
    out = []
    tables = root.tables("group", required=True)
    expected = "'all' or a list of measured modes, counted from 1"
    for table in tables:
        before = len(root.faults)
        name = table.text("name", "the name of the group") or ""
        chosen = {}
        for key, measured in (("frequency", measured_frequencies), ("shape", measured_shapes)):
            value = table.take(key, expected, _is_members, [])
            if data is not None:
                try:
                    members(value, data.modes, measured(data))
                except ValueError as error:
                    wanted, _, found = str(error).partition(", found ")
                    table.fault(key, wanted, found)
                    value = []
            chosen[key] = value if value == "all" else tuple(value)
        scale = table.choice("scale", get_args(Scale), default=Group.scale)
        table.close()
        group = Group(name, chosen["frequency"], chosen["shape"], scale)
        if not (group.frequency or group.shape):
            if len(root.faults) == before:
                table.fault("", "frequency or shape with at least one measured mode", "neither")
        elif data is not None and not (
            members(group.frequency, data.modes, measured_frequencies(data))
            or members(group.shape, data.modes, measured_shapes(data))
        ):
            table.fault("", "at least one measured property", "none in the data")
        elif data is not None and scale == "std":
            _check_std(table, group, data)
        out.append(group)
    if data is not None:
        count = sum(measured_frequencies(data)) + sum(measured_shapes(data))
        if len(tables) > count:
            expected = f"at most {count} groups, as many as measured frequencies and shapes"
            root.fault("[[group]]", expected, str(len(tables)))
        _note_equal(root, out, data)
    for name in repeated(table.values.get("name") for table in tables if has_name(table)):
        root.fault("[[group]]", "each name once", f"'{name}' twice")
    return tuple(out)


def _check_std(table: Table, group: Group, data: ModalData) -> None:
    """Note members of a group whose standard deviations are missing or of no use."""
    for kind, chosen, measured in (
        ("frequency", group.frequency, measured_frequencies(data)),
        ("shape", group.shape, measured_shapes(data)),
    ):
        for r in members(chosen, data.modes, measured):
            try:
                check_std(data, kind, r)
            except ValueError as error:
                found = f"others for the {kind} of mode {data.modes[r]}"
                table.fault("scale", f"'std' with {error}", found)


def _note_equal(root: Table, groups: Sequence[Group], data: ModalData) -> None:
    """Note groups that hold the same: their objectives could not differ."""
    seen: dict[tuple[frozenset[int], frozenset[int]], str] = {}
    for group in groups:
        held = (
            frozenset(members(group.frequency, data.modes, measured_frequencies(data))),
            frozenset(members(group.shape, data.modes, measured_shapes(data))),
        )
        if any(held) and held in seen:
            root.fault(
                "[[group]]", f"other members than those of '{seen[held]}'", f"'{group.name}'"
            )
        seen.setdefault(held, group.name)


def _is_members(value: object) -> bool:
    return value == "all" or (
        isinstance(value, list)
        and all(isinstance(x, int) and not isinstance(x, bool) and x > 0 for x in value)
    )
