"""``[[weighted]]``: models wanted with given weights."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from modefront.errors import suggestion
from modefront.toml import Table, describe, has_name, is_number, repeated

RESERVED = (
    *("nbi-", "edge-", "minima-", "gap-", "equal-weights", "optimal-weights"),
    *("bounded-weights",),
    *("iterated-weights", "sample", "identifiable-", "manifold-", "second-", "bootstrap-"),
    *("predict-", "weights-", "spea2", "nsga2", "known-", "snapshot", "certificates", "probe"),
)
"""Beginnings of the labels of results and of the names of pieces of work."""


@dataclass(frozen=True)
class Weighted:
    """Weights w_i that the user gives; the name labels the model found with them."""

    name: str
    weights: tuple[float, ...]


def read_weights(root: Table, groups: Sequence[str]) -> tuple[Weighted, ...]:
    """Return the weights that a study gives."""
    out = []
    tables = root.tables("weighted", required=False)
    for table in tables:
        name = table.text("name", "a label for the model found with these weights") or ""
        weights = table.table("weights", "a table of weights, group = weight above 0")
        table.close()
        if weights is None:
            continue
        for key, value in weights.values.items():
            if key not in groups:
                weights.fault(key, "the name of a group", suggestion(key, groups))
            elif not (is_number(value) and value > 0):
                weights.fault(key, "a weight above 0", describe(value))
        missing = [group for group in groups if group not in weights.values]
        for group in missing:
            weights.fault(group, "a weight above 0", "nothing")
        if not missing and all(is_number(weights.values[group]) for group in groups):
            out.append(Weighted(name, tuple(float(weights.values[g]) for g in groups)))
    names = [str(table.values["name"]) for table in tables if has_name(table)]
    for label in repeated(names):
        root.fault("[[weighted]]", "each name once", f"'{label}' twice")
    for label in names:
        if label.startswith(RESERVED):
            expected = f"a name that does not begin with one of {', '.join(RESERVED)}"
            root.fault("[[weighted]]", expected, f"'{label}'")
    return tuple(out)
