"""``[[weighted]]``: models with given weights."""

from __future__ import annotations

from collections.abc import Container, Sequence

from modefront.front.given import Weighted, label_faults
from modefront.options import each_once
from modefront.study.tables.options import note, read_record
from modefront.toml import Table, has_name


def read_weights(
    root: Table, groups: Sequence[str], labels: Container[str]
) -> tuple[Weighted, ...]:
    """Return the weights that a study gives; no name may be one of the labels of other models."""
    tables = root.tables("weighted", required=False)
    out = []
    for table in tables:
        weighted = read_record(table, Weighted)
        if weighted is not None:
            note(table, weighted.faults(groups))
            out.append(weighted)
        if has_name(table):
            note(table, label_faults([table.values["name"]], labels))
    names = [table.values["name"] for table in tables if has_name(table)]
    note(root, each_once("[[weighted]]", names))
    return tuple(out)
