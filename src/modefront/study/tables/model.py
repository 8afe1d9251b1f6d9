"""``[model]``: one of the kinds of models."""

from __future__ import annotations

from collections.abc import Sequence

from modefront.models.base import Model
from modefront.models.reduced.options import Reduction
from modefront.study.kinds import KINDS
from modefront.study.tables.reduction import read_reduction
from modefront.toml import Table


def read_model(
    root: Table, header: Table | None, parameters: Sequence[str]
) -> tuple[Model | None, Reduction]:
    """Return the model that a study describes, None where it has faults, and its reduction.

    ``header`` is the table ``[study]``, which says how much memory a basis may take.
    """
    table = root.table("model", "a table [model]")
    name = None if table is None else table.choice("kind", tuple(KINDS))
    kind = KINDS[name] if name else None
    reduction = read_reduction(table if kind else None, header, kind)
    if table is None or kind is None:
        return None, reduction
    model = kind.read(table, parameters)
    table.close()
    return model, reduction
