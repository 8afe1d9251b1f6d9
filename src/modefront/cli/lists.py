"""The full lists of results: every model, mode, weight, minimum and standard deviation."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import xarray as xr

from modefront.cli.layout import Screen, number
from modefront.cli.overview import print_models
from modefront.cli.predictions import print_predictions
from modefront.front.point import preferred
from modefront.results.remarks import remarks

Columns = Sequence[tuple[str, str, str]]
"""Titles with a place for a name, the variable (rows, names), and the format of its values."""

POINTS: Columns = (
    ("J {}", "objective", ".5g"),
    ("error {}", "error", ".4g"),
    ("{}", "theta", ".5g"),
)
MODES: Columns = (
    ("f{}", "frequency", ".4g"),
    ("error f{} %", "", "+.2f"),
    ("MAC {}", "mac", ".4f"),
)
ERRORS: Columns = (
    ("eigenvalue {}", "eigenvalue_error", ".1e"),
    ("shape {}", "shape_error", ".1e"),
)
MINIMA: Columns = (("J {}", "minimum_objective", ".5g"), ("{}", "minimum_theta", ".5g"))


def print_points(screen: Screen, data: xr.Dataset) -> None:
    """Print objectives, errors, parameters, modes and weights of all models."""
    marks = [
        "*" * int(pareto) + "!" * int(not converged)
        for pareto, converged in zip(data["pareto"].values, data["converged"].values, strict=True)
    ]
    title = "models: * Pareto optimal among these, ! not converged"
    _print(screen, data, title, POINTS, marks)
    measured = data["measured_frequency"].values
    error = 100 * (data["frequency"] / measured - 1)
    known = data.assign({"": np.round(error, 2) + 0.0})
    title = f"frequencies in Hz and MAC; measured: {', '.join(f'{x:.4g}' for x in measured)}"
    _print(screen, known, title, MODES)
    if "certified" in data:
        marks = ["!" * int(not x) for x in data["certified"].values]
        title = "estimated relative errors: ! above the tolerance"
        _print(screen, data, title, ERRORS, marks)
    weighted = data.isel(point=np.flatnonzero(~np.isnan(data["weight"].values).all(axis=1)))
    _print(screen, weighted, "weights", (("{}", "weight", ".5g"),))


def print_minima(screen: Screen, data: xr.Dataset) -> None:
    """Print the minima of each group and of the optimally weighted residuals."""
    title = "minima of the groups and of the weighted residuals"
    _print(screen, data, title, MINIMA, of="minimum_of")


def print_uncertainty(screen: Screen, data: xr.Dataset) -> None:
    """Print how far models and objectives scatter, and the posterior, where they are known."""
    for kind, title in (
        ("", "scatter by errors of the data: standard deviations, linearised"),
        ("bootstrap_", "scatter over data drawn again: standard deviations"),
    ):
        if f"{kind}theta_std" in data:
            columns = [("J {}", f"{kind}objective_std", ".3g"), ("{}", f"{kind}theta_std", ".3g")]
            _print(screen, data, title, columns)
    if "scatter_doubt" in data and (data["scatter_doubt"].values != "").any():
        doubts = data["scatter_doubt"].values
        rows = [[str(x), str(y)] for x, y in zip(data["label"].values, doubts, strict=True) if y]
        screen.table("where linearised standard deviations are approximate", ["model", "why"], rows)
    if "posterior_std" in data:
        modes = data["mode"].values
        titles = [str(x) for x in data["parameter"].values]
        titles += [*(f"f{r} Hz" for r in modes), *(f"MAC {r}" for r in modes)]
        values = [data[f"posterior_{name}std"].values for name in ("", "frequency_", "mac_")]
        cells = [number(x, ".3g", "") for x in np.concatenate(values)]
        title = f"posterior around {preferred(data.attrs)}: standard deviations"
        screen.table(title, ["of", "std"], list(zip(titles, cells, strict=True)))
    elif "theta_std" not in data:
        screen.say("The results hold no uncertainty: the data have no errors that are known.")


def print_findings_of(screen: Screen, data: xr.Dataset) -> None:
    """Print all findings."""
    screen.blank()
    for line in remarks(data):
        screen.say(line, start="- ")


LISTS: Mapping[str, Callable[[Screen, xr.Dataset], None]] = {
    "models": print_models,
    "points": print_points,
    "minima": print_minima,
    "uncertainty": print_uncertainty,
    "predictions": print_predictions,
    "findings": print_findings_of,
}
"""Full lists by the name of their option, in the order in which they are printed."""


# 6 arguments: the table, its rows and its columns.
def _print(
    screen: Screen,
    data: xr.Dataset,
    title: str,
    columns: Columns,
    marks: Sequence[str] = (),
    of: str = "label",
) -> None:
    """Print a table with a row for each of what ``of`` names, and ``marks`` beside these."""
    rows = []
    for i, name in enumerate(data[of].values):
        cells = [number(x, form) for _, values, form in columns for x in data[values].values[i]]
        rows.append([str(name), *marks[i : i + 1], *cells])
    titles = [
        text.format(name)
        for text, values, _ in columns
        for name in data[data[values].dims[1]].values
    ]
    first = ["model" if of == "label" else "of", *[""] * bool(marks)]
    screen.table(title, [*first, *titles], rows, keys=len(first))
