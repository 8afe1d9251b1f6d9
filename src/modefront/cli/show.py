"""Results and findings in the terminal, and as JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from modefront.cli.certificates import cost_lines
from modefront.cli.layout import Screen
from modefront.cli.lists import print_lists
from modefront.cli.overview import print_first_models, print_first_predictions
from modefront.cli.predictions import first_predictions
from modefront.cli.remarks import headlines, remarks
from modefront.results.selection import front_points
from modefront.work.costs import Costs

FIRST = 8
"""Predictions on the first screen."""


def print_summary(data: xr.Dataset, folder: Path, costs: Costs) -> None:
    """Print what a run has found and what this run of it has cost, in a few lines."""
    screen = Screen.of_output()
    screen.say(f"{data.attrs.get('study', '')}: results in {folder}")
    screen.say(_front(data), start="  ")
    for line in [*headlines(data, f"modefront show --findings {folder}"), *cost_lines(costs)]:
        screen.say(line, start="  ")
    screen.say(f"next: modefront show {folder}")


def _front(data: xr.Dataset) -> str:
    """Return how many points the front has, and what they have cost."""
    front = front_points(data)
    total = f"{data.attrs['model_evaluations']} eigenproblems in all"
    if not front.size:
        return total
    optimal = int(data["pareto"].values[front].sum())
    cost = data.attrs["front_evaluations"] / front.size
    return (
        f"{optimal} of {front.size} points of the front are Pareto optimal among these; {total}, "
        f"{cost:.1f} a point"
    )


def print_results(data: xr.Dataset, lists: Sequence[str] = ()) -> None:
    """Print the first screen of results, or the full lists of these names (`LISTS`)."""
    screen = Screen.of_output()
    attrs = data.attrs
    screen.say(attrs.get("study") or "results", style="bold")
    screen.say(f"modefront {attrs['version']}, method {attrs['method']}, seed {attrs['seed']}")
    if lists:
        print_lists(screen, data, lists)
        return
    print_first_models(screen, data)
    if "range" in data.sizes:
        columns, rows = first_predictions(data)
        print_first_predictions(screen, rows, columns, FIRST)
    screen.blank()
    screen.say(_front(data), start="- ")
    for line in headlines(data, "modefront show --findings"):
        screen.say(line, start="- ")
    screen.blank()
    screen.say("Full lists: --points, --minima, --uncertainty, --predictions, --findings, --all")


def as_json(data: xr.Dataset) -> str:
    """Return the dataset as JSON: attributes, and each variable with dimensions and values."""
    variables: dict[str, Any] = {
        str(name): {"dimensions": list(map(str, value.dims)), "values": as_plain(value.values)}
        for name, value in {**data.coords, **data.data_vars}.items()
    }
    attributes = {str(key): as_plain(np.asarray(value)) for key, value in data.attrs.items()}
    remarked = remarks(data)
    return json.dumps(
        {"attributes": attributes, "variables": variables, "remarks": remarked}, indent=1
    )


def as_plain(values: Any) -> Any:
    """Return arrays as lists; what is not a number becomes null, as JSON has no NaN."""
    if isinstance(values, np.ndarray):
        values = values.tolist()
    if isinstance(values, list):
        return [as_plain(value) for value in values]
    if isinstance(values, float) and not np.isfinite(values):
        return None
    return values
