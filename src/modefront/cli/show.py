"""Results and findings in the terminal, and as JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from rich.console import Console

from modefront.cli.certificates import cost_lines
from modefront.cli.layout import Screen
from modefront.cli.lists import print_lists
from modefront.cli.overview import print_first_models, print_first_predictions
from modefront.cli.predictions import first_predictions
from modefront.cli.remarks import MOST, digest, headlines, remarks
from modefront.cli.tables import console, safe, table
from modefront.results.selection import front_points
from modefront.study.check import Findings
from modefront.study.definition import Study
from modefront.study.estimate import Estimate
from modefront.text import clean
from modefront.work.costs import Costs

FIRST = 8
"""Predictions on the first screen."""


def _print(screen: Console, text: str) -> None:
    screen.print(clean(text), markup=False, soft_wrap=True)


def print_findings(study: Study, findings: Findings, *, every: bool = False) -> None:
    """Print what a check found, with the ten first findings or ``every`` one."""
    screen = console()
    problem = study.problem
    _print(screen, f"{study.file}: {study.name}")
    _print(
        screen,
        f"  {problem.model.size} degrees of freedom, {len(study.parameters)} parameters, "
        f"{len(problem.data.modes)} measured modes at {len(problem.data.sensors)} sensors "
        f"in {len(problem.data.sets)} data set{'s' * (len(problem.data.sets) > 1)}",
    )
    evaluation = problem.evaluate(problem.start)
    modes = table("nominal model", ["mode", "measured Hz", "model Hz", "MAC", "model mode"])
    for row in zip(
        problem.data.modes,
        problem.data.mean_frequency,
        evaluation.quantities["frequency"],
        evaluation.quantities["mac"],
        evaluation.quantities["paired_mode"],
        strict=True,
    ):
        modes.add_row(
            str(row[0]), _number(row[1]), _number(row[2]), f"{row[3]:.4f}", f"{row[4]:.0f}"
        )
    screen.print(modes)
    groups = table("groups", ["group", "a", "J nominal", "error nominal"])
    for name, a, J in zip(problem.objectives, problem.properties, evaluation.J, strict=True):
        groups.add_row(safe(name), f"{a:g}", f"{J:.5g}", f"{np.sqrt(J / a):.4g}")
    screen.print(groups)
    verdict = "agree with" if findings.sound else "DIFFER FROM"
    _print(
        screen,
        f"derivatives {verdict} finite differences (relative {findings.derivative_error:.1e})",
    )
    sentences = [*findings.determined[-1:], *(f"warning: {text}" for text in findings.warnings)]
    sentences += findings.determined[:-1]
    for line in digest(sentences, f"modefront check --all {study.file}", None if every else MOST):
        _print(screen, line)
    if not findings.warnings:
        _print(screen, "no warnings")


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


def _number(value: float) -> str:
    return "" if np.isnan(value) else f"{value:.4g}"
