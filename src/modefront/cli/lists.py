"""The full lists of results: every model, mode, weight, minimum and standard deviation."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import xarray as xr

from modefront.cli.layout import Screen
from modefront.cli.overview import print_models
from modefront.cli.predictions import print_predictions
from modefront.front.point import preferred
from modefront.results.remarks import remarks


def print_points(screen: Screen, data: xr.Dataset) -> None:
    """Print objectives, errors, parameters, modes and weights of all models."""
    groups, names = _names(data, "group"), _names(data, "parameter")
    rows = []
    for i, label in enumerate(data["label"].values):
        marks = "*" * int(data["pareto"].values[i]) + "!" * int(not data["converged"].values[i])
        rows.append(
            [
                *(str(label), marks),
                *(_number(x, ".5g") for x in data["objective"].values[i]),
                *(_number(x, ".4g") for x in data["error"].values[i]),
                *(_number(x, ".5g") for x in data["theta"].values[i]),
            ]
        )
    columns = [*(f"J {g}" for g in groups), *(f"error {g}" for g in groups), *names]
    title = "models: * Pareto optimal among these, ! not converged"
    screen.table(title, ["model", "", *columns], rows, keys=2)
    _print_modes(screen, data)
    _print_certificates(screen, data)
    _print_weights(screen, data)


def _print_modes(screen: Screen, data: xr.Dataset) -> None:
    modes, measured = data["mode"].values, data["measured_frequency"].values
    rows = [["measured", *(_number(x, ".4g", "") for x in measured), *[""] * (2 * modes.size)]]
    for i, label in enumerate(data["label"].values):
        f = data["frequency"].values[i]
        rows.append(
            [
                str(label),
                *(_number(x, ".4g") for x in f),
                *(_number(x, "+.2f", "") for x in np.round(100 * (f / measured - 1), 2) + 0.0),
                *(_number(x, ".4f") for x in data["mac"].values[i]),
            ]
        )
    columns = [*(f"f{r}" for r in modes), *(f"error f{r} %" for r in modes)]
    title = "frequencies in Hz and MAC"
    screen.table(title, ["model", *columns, *(f"MAC {r}" for r in modes)], rows)


def _print_certificates(screen: Screen, data: xr.Dataset) -> None:
    """Print the estimated errors of a reduced basis, where there is one."""
    if "certified" not in data:
        return
    columns = [f"{what} {r}" for what in ("eigenvalue", "shape") for r in data["mode"].values]
    rows = []
    for i, label in enumerate(data["label"].values):
        errors = [*data["eigenvalue_error"].values[i], *data["shape_error"].values[i]]
        mark = "!" * int(not data["certified"].values[i])
        rows.append([str(label), mark, *(f"{x:.1e}" for x in errors)])
    title = "estimated relative errors: ! above the tolerance"
    screen.table(title, ["model", "", *columns], rows, keys=2)


def _print_weights(screen: Screen, data: xr.Dataset) -> None:
    chosen = np.flatnonzero(~np.isnan(data["weight"].values).all(axis=1)).tolist()
    rows = [
        [str(data["label"].values[i]), *(_number(x, ".5g") for x in data["weight"].values[i])]
        for i in chosen
    ]
    screen.table("weights", ["model", *_names(data, "group")], rows)


def print_minima(screen: Screen, data: xr.Dataset) -> None:
    """Print the minima of each group and of the optimally weighted residuals."""
    rows = [
        [
            str(of),
            *(_number(x, ".5g") for x in data["minimum_objective"].values[i]),
            *(_number(x, ".5g") for x in data["minimum_theta"].values[i]),
        ]
        for i, of in enumerate(data["minimum_of"].values)
    ]
    columns = ["of", *(f"J {g}" for g in _names(data, "group")), *_names(data, "parameter")]
    screen.table("minima of the groups and of the weighted residuals", columns, rows)


def print_uncertainty(screen: Screen, data: xr.Dataset) -> None:
    """Print how far models and objectives scatter, and the posterior, where they are known."""
    names, groups = _names(data, "parameter"), _names(data, "group")
    known = False
    for kind, title in (
        ("", "scatter by errors of the data: standard deviations, linearised"),
        ("bootstrap_", "scatter over data drawn again: standard deviations"),
    ):
        if f"{kind}theta_std" not in data:
            continue
        known = True
        doubts = data.get("scatter_doubt") if kind == "" else None
        J, theta = data[f"{kind}objective_std"].values, data[f"{kind}theta_std"].values
        rows = []
        for i, label in enumerate(data["label"].values):
            more = [] if doubts is None else [str(doubts.values[i])]
            rows.append([str(label), *(_number(x, ".3g", "") for x in [*J[i], *theta[i]]), *more])
        columns = ["model", *(f"J {g}" for g in groups), *names]
        screen.table(title, columns + ["warning"] * (doubts is not None), rows)
    if "posterior_std" in data:
        known = True
        modes = data["mode"].values
        titles = [*names, *(f"f{r} Hz" for r in modes), *(f"MAC {r}" for r in modes)]
        values = [data[f"posterior_{name}std"].values for name in ("", "frequency_", "mac_")]
        title = f"posterior around {preferred(data.attrs)}: standard deviations"
        cells = [_number(x, ".3g", "") for x in np.concatenate(values)]
        screen.table(title, ["of", "std"], list(zip(titles, cells, strict=True)))
    if not known:
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


def print_lists(screen: Screen, data: xr.Dataset, names: Sequence[str]) -> None:
    """Print the lists of these names."""
    for name, print_list in LISTS.items():
        if name in names:
            print_list(screen, data)


def _names(data: xr.Dataset, dimension: str) -> list[str]:
    return [str(name) for name in data[dimension].values]


def _number(value: float, form: str, none: str = "none") -> str:
    return none if np.isnan(value) else format(float(value), form)
