"""``[model]``: one of the kinds of models."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from modefront.models.base import Model
from modefront.study.kinds import KINDS
from modefront.study.tables.reduction import read_reduction
from modefront.toml import Table


def read_model(
    root: Table, parameters: Sequence[str], folder: Path
) -> tuple[Model | None, float | str]:
    """Return the model that a study describes, None where it has faults, and its reduction."""
    table = root.table("model", "a table [model]")
    if table is None:
        return None, ""
    kind = table.choice("kind", tuple(KINDS))
    if kind is None:
        return None, ""
    reduction = read_reduction(table, kind)
    model = KINDS[kind](table, parameters, folder)
    table.close()
    return model, reduction
