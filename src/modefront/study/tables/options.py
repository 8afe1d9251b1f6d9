"""Tables whose keys are the fields of a record of options."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any, TypeVar

from modefront.errors import Fault, InputError
from modefront.options import options
from modefront.toml import Table

T = TypeVar("T")


def read_options(root: Table, key: str, record: type[T]) -> T:
    """Return the record that a table of a study describes.

    It is the record of defaults where there is no such table, or where something in it is wrong.
    """
    table = root.table(key, default=None)
    read = record() if table is None else read_record(table, record)
    return record() if read is None else read


def read_record(table: Table, record: type[T], *, without: Iterable[str] = ()) -> T | None:
    """Return the record that a table describes, None where something in it is wrong.

    Keys are the fields, but for those ``without``. Everything that is wrong is noted: single
    values first, and where these are right, what contradicts another.
    """
    chosen = [option for option in options(record) if option.name not in without]
    table.requested.extend(option.name for option in chosen)
    before = len(table.faults)
    values: dict[str, Any] = {}
    for option in chosen:
        name, requirement = option.name, option.requirement
        if name not in table.values:
            if option.required:
                table.fault(name, requirement.expected, "nothing")
        elif requirement.record and isinstance(table.values[name], dict):
            place, inner = f"{table.place} {name}", table.values[name]
            within = replace(table, place=place, values=inner, requested=[])
            values[name] = read_record(within, requirement.record)
        elif fault := option.fault(table.values[name]):
            note(table, [fault])
        else:
            values[name] = table.values[name]
    table.close()
    if len(table.faults) > before:
        return None
    try:
        return record(**values)
    except InputError as error:
        note(table, error.faults)
        return None


def note(table: Table, faults: Iterable[Fault]) -> None:
    """Note faults of a record at the place of its table."""
    for fault in faults:
        table.fault(fault.place, fault.expected, fault.found)
