"""Results and findings in the terminal, and as JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from rich.console import Console

from modefront.cli.layout import BLANK, Line, Screen, number
from modefront.cli.lists import LISTS, models_in, predictions_in_short
from modefront.cli.terminal import command, say_next
from modefront.findings.catalogue import Severity
from modefront.findings.record import PAGE
from modefront.findings.selection import verdict
from modefront.results.compare import Comparison, Spread, short_names
from modefront.results.remarks import digest, findings_of, headlines
from modefront.study.estimate import Estimate
from modefront.work.costs import Costs

HEIGHT, TABLE, LEAST, PREDICTIONS = 40, 14, 4, 4
"""Lines of the first screen, about; of it for models and for findings, at least; predictions."""


def say_estimate(expected: Estimate | None, *, err: bool = False) -> None:
    """Print how long a run will probably take, and what would make it shorter."""
    if expected is None:
        return
    screen = Screen(Console(highlight=False, stderr=err))
    screen.say(expected.text)
    if expected.advice:
        screen.say(f"shorter with: {'; '.join(expected.advice)}")


def print_summary(data: xr.Dataset, folder: Path, costs: Costs) -> None:
    """Print what a run has found and what this run of it has cost, in a few lines."""
    screen = Screen.of_output()
    screen.say(f"{data.attrs.get('study', '')}: results in {folder}", style="bold")
    failures = [str(x) for x in findings_of(data) if x.severity is Severity.FAILURE]
    said = verdict(data)
    whole = command("show", folder, "--findings")
    for line in [*said, *failures] if said else digest(headlines(data), whole):
        screen.say(line, start="  ")
    spent = f"this time: {costs.eigenproblems} full eigensolutions in {costs.full_time:.3g} s"
    if costs.corrected:
        spent += f", {costs.corrected} corrected in {costs.corrected_time:.3g} s"
    if costs.reduced:
        spent += f", {costs.reduced} reduced in {costs.reduced_time:.3g} s"
        spent += f", {costs.certificates} certificates in {costs.certificate_time:.3g} s"
    screen.say(spent)
    say_next("show", folder)


def print_results(
    data: xr.Dataset, lists: Sequence[str] = (), folder: Path | str = "DIRECTORY"
) -> None:
    """Print the first screen of the results in a folder, or the full lists of these names."""
    screen, attrs = Screen.of_output(), data.attrs
    title = screen.sentence(attrs.get("study") or "results", style="bold")
    if lists:
        by = f"modefront {attrs['version']}, method {attrs['method']}, seed {attrs['seed']}"
        screen.show([*title, *screen.sentence(by)])
        for name in (name for name in LISTS if name in lists):
            LISTS[name](screen, data)
        screen.blank()
        _say_further(screen, folder)
        return
    show, predicted = command("show", folder), "range" in data.sizes
    said = [line for text in verdict(data) for line in screen.sentence(text)]
    if predicted:
        full = f"{show} --predictions"
        said += [BLANK, *predictions_in_short(screen, data, PREDICTIONS, full)]
    most = max(HEIGHT - len(title) - len(said) - LEAST - 6, TABLE)
    lines = [*title, *said, BLANK, *models_in(screen, data, most, f"{show} --models")]
    room = max(HEIGHT - len(lines) - 5, LEAST)
    screen.show([*lines, BLANK, *_findings(screen, data, room, f"{show} --findings"), BLANK])
    _say_further(screen, folder)


def _say_further(screen: Screen, folder: Path | str) -> None:
    screen.say(f"what a finding means: {PAGE}")
    screen.say(f"all: {command('show', folder, '--all')}")
    screen.say(f"next: {command('report', folder)}")


def _findings(screen: Screen, data: xr.Dataset, most: int, full: str) -> list[Line]:
    """Return the first findings, in ``most`` lines or in those of the first one where more."""
    sentences = headlines(data)
    blocks = [screen.sentence(text, start="- ") for text in sentences]
    if sum(map(len, blocks)) <= most:
        return [line for block in blocks for line in block]
    out: list[Line] = []
    count = 0
    while count < len(blocks) and (count < 1 or len(out) + len(blocks[count]) < most):
        out += blocks[count]
        count += 1
    *_, more = digest(sentences, full, count)
    return [*out, *screen.sentence(more, start="- ")]


def as_json(data: xr.Dataset) -> str:
    """Return the dataset as JSON: attributes, and each variable with dimensions and values."""
    found = findings_of(data, full=True)
    sections = {
        "verdict": verdict(data),
        "attributes": {str(k): as_plain(np.asarray(value)) for k, value in data.attrs.items()},
        "variables": {
            str(name): {"dimensions": list(map(str, x.dims)), "values": as_plain(x.values)}
            for name, x in {**data.coords, **data.data_vars}.items()
        },
        "remarks": [str(finding) for finding in found],
        "findings": [finding.as_plain() for finding in found],
    }
    return json.dumps(sections, indent=1)


def as_plain(values: Any) -> Any:
    """Return what JSON has: arrays as lists, records as objects, null for what is no number."""
    if isinstance(values, dict):
        return {key: as_plain(value) for key, value in values.items()}
    if isinstance(values, np.ndarray):
        values = values.tolist()
    if isinstance(values, list | tuple):
        return [as_plain(value) for value in values]
    return None if isinstance(values, float) and not np.isfinite(values) else values


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
