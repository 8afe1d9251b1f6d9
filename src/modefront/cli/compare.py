"""A comparison as tables, and as JSON."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

import numpy as np

from modefront.cli.show import as_plain
from modefront.cli.tables import console, safe, table
from modefront.results.compare import Comparison, Spread


def print_comparison(comparison: Comparison) -> None:
    """Print a comparison as tables."""
    screen = console()
    fronts = table(
        "fronts in the space of errors",
        ["results", "study", "method", "points", "length", "ratio"]
        + [f"extent {safe(group)}" for group in comparison.groups]
        + ["nearest", "optimal weights", "eigenproblems"],
    )
    for summary in comparison.fronts:
        fronts.add_row(
            safe(summary.name),
            safe(summary.study),
            summary.method,
            str(summary.points),
            *map(_number, (summary.length, summary.length_ratio, *summary.extent)),
            *map(_number, (summary.distance, summary.optimal_distance)),
            str(summary.eigenproblems),
        )
    screen.print(fronts)
    apart = table(
        "distance in the common parameters, over their bounds in the first",
        ["results", "and", "common", "least", "greatest", "optimal weights"],
    )
    for pair in comparison.pairs:
        numbers = map(_number, (pair.least, pair.greatest, pair.optimal))
        common = safe(", ".join(pair.common)) or "none"
        apart.add_row(safe(pair.first), safe(pair.second), common, *numbers)
    screen.print(apart)
    for title, rows in (
        ("parameters over the front: least to greatest", [x.parameters for x in comparison.fronts]),
        (
            "predictions over the front: least to greatest",
            [x.predictions for x in comparison.fronts],
        ),
    ):
        names = list(dict.fromkeys(spread.name for row in rows for spread in row))
        spreads = table(title, ["", *(safe(summary.name) for summary in comparison.fronts)])
        for name in names:
            spreads.add_row(safe(name), *(_range(row, name) for row in rows))
        screen.print(spreads)


def comparison_as_json(comparison: Comparison) -> str:
    """Return a comparison as JSON; what is not a number becomes null."""

    def plain(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: plain(item) for key, item in value.items()}
        if isinstance(value, list | tuple):
            return [plain(item) for item in value]
        return as_plain(value)

    return json.dumps(plain(asdict(comparison)), indent=1)


def _range(row: tuple[Spread, ...], name: str) -> str:
    chosen = [spread for spread in row if spread.name == name]
    return f"{chosen[0].least:.5g} to {chosen[0].greatest:.5g}" if chosen else ""


def _number(value: float) -> str:
    return "" if np.isnan(value) else f"{value:.4g}"
