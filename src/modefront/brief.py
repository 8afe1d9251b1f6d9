"""Short representations of records: a line a field, arrays by their sizes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import Any

LINE, MOST = 96, 18
"""Characters of a line, and lines of fields."""


def brief(record: Any) -> str:
    """Return the class of a record and a line for each field, as its ``__repr__``."""
    shown = [field.name for field in fields(record) if field.repr]
    width = max(map(len, shown), default=0)
    lines = [f"  {name:{width}}  {_short(getattr(record, name))}"[:LINE] for name in shown]
    more = [f"  and {len(lines) - MOST} more"] * (len(lines) > MOST)
    return "\n".join([type(record).__name__, *lines[:MOST], *more])


def brief_model(model: Any) -> str:
    """Return the class of a model and its sizes, as its ``__repr__``."""
    p, k = len(model.parameters), len(model.sensors)
    return (
        f"{type(model).__name__}({p} parameter{'s' * (p != 1)}, {model.size} degrees of freedom, "
        f"{k} sensor{'s' * (k != 1)})"
    )


def _short(value: Any) -> str:
    """Return a value in a line: numbers and texts, or how many and of what."""
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, str | bytes | int | type(None)):
        return repr(value)
    shape = getattr(value, "shape", None)
    if shape is not None:
        if getattr(value, "ndim", 2) == 1 and shape[0] <= 6:
            return " ".join(f"{x:.5g}" for x in value)
        return f"{' x '.join(map(str, shape))} numbers"
    if isinstance(value, Mapping):
        return ", ".join(f"{key} {_short(item)}" for key, item in value.items())
    if isinstance(value, Sequence):
        if all(isinstance(item, str | int | float) for item in value):
            return ", ".join(map(str, value))
        return f"{len(value)} of {type(value[0]).__name__}"
    return repr(value).splitlines()[0]
