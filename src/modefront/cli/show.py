"""Results and findings in the terminal, and as JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from rich.console import Console

from modefront.cli.layout import BLANK, Line, Screen
from modefront.cli.lists import LISTS, print_lists
from modefront.cli.overview import models_in, predictions_in
from modefront.cli.predictions import first_predictions
from modefront.findings.record import PAGE
from modefront.results.remarks import digest, findings_of, headlines
from modefront.study.estimate import Estimate
from modefront.work.costs import Costs

HEIGHT = 48
"""Lines of the first screen, about."""

LONGER, SHORTER = 32, 25
"""Lines for the table of models, without and with predictions."""

PREDICTIONS = 4
"""Predictions on the first screen."""

LEAST = 8
"""Lines of the first screen for findings, at least."""


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
    screen.say(f"{data.attrs.get('study', '')}: results in {folder}")
    for line in _verdict(data):
        screen.say(line)
    findings = digest(headlines(data), f"modefront show --findings {folder}")
    for line in [*findings, *_costs(costs)]:
        screen.say(line, start="  ")
    screen.say(f"next: modefront show {folder}")


def _costs(costs: Costs) -> list[str]:
    """Return how many models this run has solved, and the time that took."""
    out = [f"this time: {costs.eigenproblems} full eigensolutions in {costs.full_time:.3g} s"]
    if costs.corrected:
        out.append(
            f"{costs.corrected} corrected with their factors, and derivatives, "
            f"in {costs.corrected_time:.3g} s"
        )
    if costs.reduced:
        out.append(
            f"{costs.reduced} reduced solutions in {costs.reduced_time:.3g} s, "
            f"{costs.certificates} certificates in {costs.certificate_time:.3g} s"
        )
    return out


def _verdict(data: xr.Dataset) -> list[str]:
    """Return the sentences of the first answer."""
    return str(data.attrs.get("verdict", "")).splitlines()


def print_results(data: xr.Dataset, lists: Sequence[str] = ()) -> None:
    """Print the first screen of results, or the full lists of these names (`LISTS`)."""
    screen = Screen.of_output()
    attrs = data.attrs
    title = screen.sentence(attrs.get("study") or "results", style="bold")
    title += screen.sentence(
        f"modefront {attrs['version']}, method {attrs['method']}, seed {attrs['seed']}"
    )
    if lists:
        screen.show(title)
        print_lists(screen, data, lists)
        return
    predicted = "range" in data.sizes
    said = [line for text in _verdict(data) for line in screen.sentence(text)]
    lines = [*title, *said, BLANK, *models_in(screen, data, SHORTER if predicted else LONGER)]
    if predicted:
        lines += [BLANK, *predictions_in(screen, *first_predictions(data), PREDICTIONS)]
    options = [f"--{name}" for name in LISTS if name != "predictions" or predicted]
    last = screen.sentence(f"full lists: modefront show {' '.join(options)}, or --all")
    last += screen.sentence(f"what each finding means, and what to do: {PAGE}")
    lines.append(BLANK)
    lines += _findings(screen, data, max(HEIGHT - len(lines) - len(last) - 1, LEAST))
    screen.show([*lines, BLANK, *last])


def _findings(screen: Screen, data: xr.Dataset, most: int) -> list[Line]:
    """Return the first findings, in ``most`` lines or in those of the first two where more."""
    sentences = headlines(data)
    blocks = [screen.sentence(text, start="- ") for text in sentences]
    if sum(map(len, blocks)) <= most:
        return [line for block in blocks for line in block]
    out: list[Line] = []
    count = 0
    while count < len(blocks) and (count < 2 or len(out) + len(blocks[count]) < most):
        out += blocks[count]
        count += 1
    *_, more = digest(sentences, "modefront show --findings", count)
    return [*out, *screen.sentence(more, start="- ")]


def as_json(data: xr.Dataset) -> str:
    """Return the dataset as JSON: attributes, and each variable with dimensions and values."""
    variables: dict[str, Any] = {
        str(name): {"dimensions": list(map(str, value.dims)), "values": as_plain(value.values)}
        for name, value in {**data.coords, **data.data_vars}.items()
    }
    attributes = {str(key): as_plain(np.asarray(value)) for key, value in data.attrs.items()}
    found = findings_of(data, full=True)
    sections = {
        "verdict": _verdict(data),
        "attributes": attributes,
        "variables": variables,
        "remarks": [str(finding) for finding in found],
        "findings": [finding.as_plain() for finding in found],
    }
    return json.dumps(sections, indent=1)


def as_plain(values: Any) -> Any:
    """Return arrays as lists; what is not a number becomes null, as JSON has no NaN."""
    if isinstance(values, np.ndarray):
        values = values.tolist()
    if isinstance(values, list):
        return [as_plain(value) for value in values]
    if isinstance(values, float) and not np.isfinite(values):
        return None
    return values
