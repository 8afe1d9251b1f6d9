"""The first screen of results: the nominal model beside the updated ones, in one table."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from modefront._typing import Floats
from modefront.cli.layout import Screen
from modefront.fronts.point import Kind

WORDS = {
    Kind.NOMINAL.value: "nominal",
    Kind.OPTIMAL.value: "optimal weights",
    Kind.BOUNDED.value: "bounded weights",
    Kind.EQUAL.value: "equal weights",
}


def first_models(data: xr.Dataset) -> list[int]:
    """Return the positions of the nominal model, the reference and the edges."""
    kinds, labels = data["kind"].values, data["label"].values
    chosen = [
        *np.flatnonzero(kinds == Kind.NOMINAL.value).tolist(),
        *np.flatnonzero(labels == data.attrs["reference"]).tolist(),
        *np.flatnonzero(kinds == Kind.EDGE.value).tolist(),
    ]
    return list(dict.fromkeys(chosen))


def print_first_models(screen: Screen, data: xr.Dataset) -> None:
    """Print parameters, errors of frequencies, MAC and errors of groups of the first models."""
    models = first_models(data)
    rows: list[list[str]] = [["parameters"]]
    std, explained = standard_deviations(data)
    bound = _bounds(data)
    for j, name in enumerate(data["parameter"].values):
        values = [_value(data["theta"].values[i, j], std[i, j], int(bound[i, j])) for i in models]
        rows.append([f"  {name}", *values])
    rows.append(["modes: error of the frequency in %, and MAC"])
    measured = data["measured_frequency"].values
    for r, mode in enumerate(data["mode"].values):
        f, mac = data["frequency"].values[models, r], data["mac"].values[models, r]
        error = 100 * (f / measured[r] - 1)
        cells = [_mode(*each) for each in zip(error, f, mac, strict=True)]
        name = f"  {mode}: {measured[r]:.4g} Hz" if np.isfinite(measured[r]) else f"  {mode}"
        rows.append([name, *cells])
    rows.append(["errors of the groups, root mean square"])
    for i, group in enumerate(data["group"].values):
        rows.append([f"  {group}", *(_number(x, ".4g") for x in data["error"].values[models, i])])
    labels = [str(data["label"].values[i]) for i in models]
    screen.table("", ["", *(WORDS.get(label, label) for label in labels)], rows)
    for text in explained:
        screen.say(text)
    if bound[models].any():
        screen.say("min, max: the parameter is at this bound")


def standard_deviations(data: xr.Dataset) -> tuple[Floats, list[str]]:
    """Return standard deviations of the parameters (points, p), NaN for none, and what they are."""
    std = np.full(data["theta"].shape, np.nan)
    explained = []
    if "theta_std" in data:
        std = np.array(data["theta_std"].values)
        explained.append("±: one standard deviation by the errors of the data")
    elif "posterior_std" in data:
        (best,) = np.flatnonzero(data["label"].values == data.attrs["reference"])
        std[best] = data["posterior_std"].values
        explained.append(
            f"±: one standard deviation of the posterior around {data.attrs['reference']}"
        )
    if np.isinf(std).any():
        explained.append("± inf: the data do not determine the parameter")
    if not explained:
        explained.append("no standard deviations: the results hold no errors of the data")
    return std, explained


def _bounds(data: xr.Dataset) -> Floats:
    if "at_bound" in data:
        return np.asarray(data["at_bound"].values)
    return np.zeros(data["theta"].shape)


def _value(x: float, std: float, bound: int) -> str:
    shown = _number(x, "#.4g").removesuffix(".")
    if not np.isnan(std):
        shown += f" ± {std:.2g}"
    return shown + {-1: " min", 1: " max"}.get(bound, "")


def _mode(error: float, f: float, mac: float) -> str:
    if np.isnan(f):
        return "none"
    first = f"{f:.4g} Hz" if np.isnan(error) else f"{round(error, 2) + 0.0:+.2f}"
    return f"{first}  {mac:.3f}"


def _number(value: float, form: str) -> str:
    return "none" if np.isnan(value) else format(float(value), form)


def print_first_predictions(
    screen: Screen, rows: Sequence[Sequence[str]], columns: Sequence[str], most: int
) -> None:
    """Print the first predictions, and how many more there are."""
    title = "predictions: least and greatest are those of the Pareto-optimal models"
    screen.table(title, columns, rows[:most])
    rest = len(rows) - most
    if rest > 0:
        screen.say(f"and {rest} more prediction{'s' * (rest > 1)}: modefront show --predictions")
