"""A comparison as tables, and as JSON."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

import numpy as np

from modefront.cli.show import as_plain
from modefront.cli.tables import console, safe, table
from modefront.results.compare import Comparison, Spread


def print_comparison(found: Comparison) -> None:
    """Print a comparison as tables."""
    screen = console()
    fronts = table(
        "fronts in the space of errors",
        ["results", "study", "method", "points", "length", "ratio"]
        + [f"extent {safe(group)}" for group in found.groups]
        + ["nearest", "optimal weights", "eigenproblems"],
    )
    for one in found.fronts:
        fronts.add_row(
            safe(one.name),
            safe(one.study),
            one.method,
            str(one.points),
            *map(_number, (one.length, one.length_ratio, *one.extent)),
            *map(_number, (one.distance, one.optimal_distance)),
            str(one.eigenproblems),
        )
    screen.print(fronts)
    apart = table(
        "distance in the common parameters, over their bounds in the first",
        ["results", "and", "common", "least", "greatest", "optimal weights"],
    )
    for pair in found.pairs:
        numbers = map(_number, (pair.least, pair.greatest, pair.optimal))
        common = safe(", ".join(pair.common)) or "none"
        apart.add_row(safe(pair.first), safe(pair.second), common, *numbers)
    screen.print(apart)
    for title, rows in (
        ("parameters over the front: least to greatest", [x.parameters for x in found.fronts]),
        ("predictions over the front: least to greatest", [x.predictions for x in found.fronts]),
    ):
        names = list(dict.fromkeys(spread.name for row in rows for spread in row))
        spreads = table(title, ["", *(safe(one.name) for one in found.fronts)])
        for name in names:
            spreads.add_row(safe(name), *(_range(row, name) for row in rows))
        screen.print(spreads)


def comparison_as_json(found: Comparison) -> str:
    """Return a comparison as JSON; what is not a number becomes null."""

    def plain(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: plain(item) for key, item in value.items()}
        if isinstance(value, list | tuple):
            return [plain(item) for item in value]
        return as_plain(value)

    return json.dumps(plain(asdict(found)), indent=1)


def _range(row: tuple[Spread, ...], name: str) -> str:
    chosen = [one for one in row if one.name == name]
    return f"{chosen[0].least:.5g} to {chosen[0].greatest:.5g}" if chosen else ""


def _number(value: float) -> str:
    return "" if np.isnan(value) else f"{value:.4g}"
