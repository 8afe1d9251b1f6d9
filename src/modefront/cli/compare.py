"""A comparison as tables, and as JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from modefront.cli.layout import Screen
from modefront.cli.show import as_plain
from modefront.results.compare import Comparison, Spread, short_names

SHOWN = 6
"""Parameters, and predictions, that are printed unless all are asked for."""

OF_MODES = ("frequency ", "mac ")
"""Prefixes of the predictions of modes, which are listed after those of the studies."""


def print_comparison(comparison: Comparison, *, every: bool = False) -> None:
    """Print a comparison as tables, one column a study, and say which models are meant.

    The first parameters and predictions are printed, or ``every`` one.
    """
    screen = Screen.of_output()
    fronts = comparison.fronts
    columns = ["", *short_names([summary.name for summary in fronts])]
    names = dict(zip((summary.name for summary in fronts), columns[1:], strict=True))
    screen.say("Studies side by side", style="bold")
    screen.say(
        "Errors are root mean squares, which mean the same in all studies. Ranges are those of all "
        "Pareto-optimal models, edges and weighted ones included."
    )
    screen.table("", columns, _fronts(comparison))
    for summary in fronts:
        if summary.reference != fronts[0].reference:
            screen.say(f"the reference of {summary.name} is {summary.reference}")
    most = None if every else SHOWN
    _print_ranges(screen, "parameters", columns, [x.parameters for x in fronts], most)
    _print_ranges(screen, "predictions", columns, [x.predictions for x in fronts], most)
    pairs = [
        [
            f"{names[pair.first]} and {names[pair.second]}",
            _common(pair.common, most),
            *map(_number, (pair.least, pair.greatest, pair.reference)),
        ]
        for pair in comparison.pairs
    ]
    title = (
        "distances in the common parameters, over their bounds in the first: of the two nearest "
        "models, of the farthest one from the other study, and of the reference models"
    )
    screen.table(title, ["studies", "common", "least", "greatest", "references"], pairs)


def _common(names: Sequence[str], most: int | None) -> str:
    """Return the names of common parameters, of many only how many there are."""
    if most is not None and len(names) > most:
        return f"{len(names)} parameters"
    return ", ".join(names) or "none"


def _fronts(comparison: Comparison) -> list[list[str]]:
    """Return the quantities of each front, a row each."""
    fronts = comparison.fronts

    def row(name: str, of: Sequence[object]) -> list[str]:
        return [name, *map(str, of)]

    rows = [
        row("study", [x.study for x in fronts]),
        row("method", [x.method for x in fronts]),
        row("Pareto-optimal points", [x.points for x in fronts]),
        row("eigenproblems", [x.eigenproblems for x in fronts]),
        row("length of the front", [_number(x.length) for x in fronts]),
        row("  over that of the first", [_number(x.length_ratio) for x in fronts]),
    ]
    for i, group in enumerate(comparison.groups):
        rows.append(row(f"range of error, {group}", [_number(x.extent[i]) for x in fronts]))
    rows += [
        row("least distance from origin", [_number(x.distance) for x in fronts]),
        row("reference model", [x.reference for x in fronts]),
        row("  its distance from origin", [_number(x.reference_distance) for x in fronts]),
    ]
    return rows


def _print_ranges(
    screen: Screen,
    title: str,
    columns: Sequence[str],
    rows: Sequence[Sequence[Spread]],
    most: int | None,
) -> None:
    """Print values of the reference models with least and greatest of the Pareto-optimal ones."""
    names = list(dict.fromkeys(spread.name for row in rows for spread in row))
    names.sort(key=lambda name: name.startswith(OF_MODES))
    cells = [[name, *(_range(row, name) for row in rows)] for name in names[:most]]
    screen.table(f"{title}: reference model, and least to greatest", columns, cells)
    rest = len(names) - len(cells)
    if rest:
        screen.say(f"and {rest} more {title}: modefront compare --all")


def comparison_as_json(comparison: Comparison) -> str:
    """Return a comparison as JSON; what is not a number becomes null."""

    def plain(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: plain(item) for key, item in value.items()}
        if isinstance(value, list | tuple):
            return [plain(item) for item in value]
        return as_plain(value)

    return json.dumps(plain(asdict(comparison)), indent=1)


def _range(row: Sequence[Spread], name: str) -> str:
    chosen = [spread for spread in row if spread.name == name]
    if not chosen:
        return ""
    spread = chosen[0]
    ends = f"{_number(spread.least)} to {_number(spread.greatest)}"
    return f"{_number(spread.reference)} ({ends})"


def _number(value: float) -> str:
    return "" if np.isnan(value) else f"{value:.4g}"
