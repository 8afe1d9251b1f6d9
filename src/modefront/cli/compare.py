"""A comparison as tables, and as JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from functools import partial

from modefront.cli.layout import Screen, number
from modefront.cli.show import as_plain
from modefront.cli.terminal import command, say_next
from modefront.results.compare import Comparison, Spread, short_names

SHOWN = 6
"""Parameters, and predictions, that are printed unless all are asked for."""

OF_MODES = ("frequency ", "mac ")
"""Prefixes of the predictions of modes, which are listed after those of the studies."""

_number = partial(number, form=".4g", none="")


def print_comparison(comparison: Comparison, *, every: bool = False) -> None:
    """Print a comparison as tables, one column a study, and say which models are meant.

    The first parameters and predictions are printed, or ``every`` one.
    """
    screen = Screen.of_output()
    fronts, folders = comparison.fronts, [summary.name for summary in comparison.fronts]
    names = dict(zip(folders, short_names(folders), strict=True))
    columns, most = ["", *names.values()], None if every else SHOWN
    screen.say("Studies side by side", style="bold")
    screen.say(
        "Errors are root mean squares, which mean the same in all studies. Ranges are those of all "
        "Pareto-optimal models, edges and weighted ones included."
    )
    rows = {
        name: [_number(x) if isinstance(x, float) else str(x) for x in row]
        for name, row in comparison.rows.items()
    }
    screen.table("", columns, [[name, *row] for name, row in rows.items()])
    for title, ranges in (
        ("parameters", [x.parameters for x in fronts]),
        ("predictions", [x.predictions for x in fronts]),
    ):
        known = [{x.name: _range(x) for x in row} for row in ranges]
        order = list(dict.fromkeys(name for row in known for name in row))
        order.sort(key=lambda name: name.startswith(OF_MODES))
        cells = [[name, *(row.get(name, "") for row in known)] for name in order]
        screen.table(f"{title}: reference model, and least to greatest", columns, cells[:most])
        if cells[SHOWN:] and most:
            screen.say(
                f"and {len(cells) - SHOWN} more {title}: {command('compare', '--all', *folders)}"
            )
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
    say_next("report", *folders)


def _common(names: Sequence[str], most: int | None) -> str:
    """Return the names of common parameters, of many only how many there are."""
    if most is not None and len(names) > most:
        return f"{len(names)} parameters"
    return ", ".join(names) or "none"


def _range(spread: Spread) -> str:
    """Return the value of the reference, with least and greatest."""
    ends = f"{_number(spread.least)} to {_number(spread.greatest)}"
    return f"{_number(spread.reference)} ({ends})"


def comparison_as_json(comparison: Comparison) -> str:
    """Return a comparison as JSON; what is not a number becomes null."""
    return json.dumps(as_plain(asdict(comparison)), indent=1)
