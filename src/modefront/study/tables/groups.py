"""``[[group]]``: which residuals add up to an objective."""

from __future__ import annotations

from collections.abc import Sequence
from typing import get_args

from modefront.data.modal import ModalData
from modefront.residuals.base import Scale
from modefront.residuals.groups import MODE_NUMBERS, Group, are_mode_numbers, faults
from modefront.residuals.kinds import KINDS
from modefront.toml import Table, has_name, repeated


def read_groups(root: Table, data: ModalData | None) -> tuple[Group, ...]:
    """Return the groups that a study names, those without fault with members that the data have."""
    out = []
    tables = root.tables("group", required=True)
    for table in tables:
        name = table.text("name", "the name of the group") or ""
        before = len(root.faults)
        modes = {
            kind.name: table.take(kind.name, MODE_NUMBERS, are_mode_numbers, []) for kind in KINDS
        }
        are_read = len(root.faults) == before
        group = Group(name, scale=table.choice("scale", get_args(Scale), "measured"), **modes)
        table.close()
        if group.chosen or are_read:
            for fault in faults(group, data):
                table.fault(*fault)
        out.append(group)
    if data is not None:
        count = sum(int(kind.measured(data).sum()) for kind in KINDS)
        if len(tables) > count:
            nouns = " and ".join(kind.plural for kind in KINDS)
            expected = f"at most {count} groups, as many as measured {nouns}"
            root.fault("[[group]]", expected, str(len(tables)))
        _note_equal(root, out, data)
    for name in repeated(table.values.get("name") for table in tables if has_name(table)):
        root.fault("[[group]]", "each name once", f"'{name}' twice")
    return tuple(out)


def _note_equal(root: Table, groups: Sequence[Group], data: ModalData) -> None:
    """Note groups that hold the same: their objectives could not differ."""
    seen: dict[frozenset[tuple[str, int]], str] = {}
    for group in groups:
        if any(faults(group, data)):
            continue
        chosen = group.positions(data)
        held = frozenset((kind.name, r) for kind, positions in chosen for r in positions)
        if held in seen:
            root.fault(
                "[[group]]", f"other members than those of '{seen[held]}'", f"'{group.name}'"
            )
        seen.setdefault(held, group.name)
