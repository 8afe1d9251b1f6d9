"""``reduction`` and ``memory``: use, tolerance and memory of a reduced basis."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from modefront.models.reduced.options import Reduction
from modefront.options import options
from modefront.study.kinds.sensors import ModelKind
from modefront.study.tables.options import note
from modefront.toml import Table


def read_reduction(model: Table | None, header: Table | None, kind: ModelKind | None) -> Reduction:
    """Return the reduction of the tables ``[model]`` and ``[study]``."""
    out = Reduction()
    if kind is not None and not kind.is_reducible:
        out, model = Reduction("off"), None
    for table, name in ((model, "reduction"), (header, "memory")):
        if table is None:
            continue
        table.requested.append(name)
        if name in table.values:
            out = _with(table, name, out)
    return out


def _with(table: Table, name: str, known: Reduction) -> Reduction:
    value: Any = table.values[name]
    (option,) = (each for each in options(Reduction) if each.name == name)
    fault = option.fault(value)
    note(table, [fault] if fault else [])
    return known if fault else replace(known, **{name: value})
