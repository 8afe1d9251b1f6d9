"""Results and comparisons in the terminal, and as JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from rich.console import Console

from modefront.cli.layout import BLANK, Line, Screen, number
from modefront.cli.lists import LISTS, models_in, predictions_in_short
from modefront.cli.terminal import command, say_next
from modefront.findings.catalogue import Severity
from modefront.results.compare import Comparison, Spread, short_names
from modefront.results.remarks import digest, findings_of, headlines, verdict
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
    screen, attrs, show = Screen.of_output(), data.attrs, command("show", folder)
    lines = screen.sentence(attrs.get("study") or "results", style="bold")
    if lists:
        by = f"modefront {attrs['version']}, method {attrs['method']}, seed {attrs['seed']}"
        screen.show([*lines, *screen.sentence(by)])
        for name in (name for name in LISTS if name in lists):
            LISTS[name](screen, data)
        screen.say("")
    else:
        lines += [line for text in verdict(data) for line in screen.sentence(text)]
        if "range" in data.sizes:
            full = f"{show} --predictions"
            lines += [BLANK, *predictions_in_short(screen, data, PREDICTIONS, full)]
        most = max(HEIGHT - len(lines) - LEAST - 6, TABLE)
        lines += [BLANK, *models_in(screen, data, most, f"{show} --models"), BLANK]
        room = max(HEIGHT - len(lines) - 4, LEAST)
        screen.show([*lines, *_findings(screen, data, room, f"{show} --findings"), BLANK])
    if "findings" not in lists:
        screen.say(f"what each finding means: {show} --findings")
    screen.say(f"all: {show} --all")
    screen.say(f"next: {command('report', folder)}")


def _findings(screen: Screen, data: xr.Dataset, most: int, full: str) -> list[Line]:
    """Return the first findings, in ``most`` lines or in those of the first one where more."""
    sentences = headlines(data)
    blocks = [screen.sentence(text, start="- ") for text in sentences]
    ends = np.cumsum([len(block) for block in blocks])
    if ends.size and ends[-1] > most:
        count = max(int(np.searchsorted(ends, most)), 1)
        blocks = blocks[:count]
        blocks.append(screen.sentence(digest(sentences, full, count)[-1], start="- "))
    return [line for block in blocks for line in block]


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


def print_comparison(comparison: Comparison, *, every: bool = False) -> None:
    """Print a comparison as tables, one column a study, and say which models are meant.

    The first parameters and predictions are printed, or ``every`` one.
    """
    screen = Screen.of_output()
    fronts, folders = comparison.fronts, [summary.name for summary in comparison.fronts]
    short = short_names(folders)
    names, columns = dict(zip(folders, short, strict=True)), ["", *short]
    most = None if every else SHOWN
    screen.say("Studies side by side", style="bold")
    screen.say(
        "Errors are root mean squares, which mean the same in all studies. Ranges are those of all "
        "Pareto-optimal models, edges and weighted ones included."
    )
    rows = [[name, *map(_cell, row)] for name, row in comparison.rows.items()]
    screen.table("", columns, rows)
    for title, ranges in (
        ("parameters", [x.parameters for x in fronts]),
        ("predictions", [x.predictions for x in fronts]),
    ):
        known = [{x.name: _cell(x) for x in row} for row in ranges]
        order = list(dict.fromkeys(name for row in known for name in row))
        order.sort(key=lambda name: name.startswith(OF_MODES))
        cells = [[name, *(row.get(name, "") for row in known)] for name in order]
        screen.table(f"{title}: reference model, and least to greatest", columns, cells[:most])
        if cells[SHOWN:] and most:
            whole = command("compare", "--all", *folders)
            screen.say(f"and {len(cells) - SHOWN} more {title}: {whole}")
    pairs = []
    for x in comparison.pairs:
        many = most is not None and len(x.common) > most
        common = f"{len(x.common)} parameters" if many else ", ".join(x.common) or "none"
        distances = map(_cell, (x.least, x.greatest, x.reference))
        pairs.append([f"{names[x.first]} and {names[x.second]}", common, *distances])
    title = (
        "distances in the common parameters, over their bounds in the first: of the two nearest "
        "models, of the farthest one from the other study, and of the reference models"
    )
    screen.table(title, ["studies", "common", "least", "greatest", "references"], pairs)
    say_next("report", *folders)


def _cell(value: object) -> str:
    """Return a value of a comparison: of a range that of the reference, and its ends."""
    if isinstance(value, Spread):
        ends = f"{_cell(value.least)} to {_cell(value.greatest)}"
        return f"{_cell(value.reference)} ({ends})"
    return number(value, ".4g", "") if isinstance(value, float) else str(value)


def comparison_as_json(comparison: Comparison) -> str:
    """Return a comparison as JSON; what is not a number becomes null."""
    return json.dumps(as_plain(asdict(comparison)), indent=1)
