"""Results and findings as tables, and as JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from rich.console import Console
from rich.table import Table

from modefront.cli.certificates import certificate_remarks, cost_lines
from modefront.cli.predictions import prediction_tables
from modefront.cli.show_knowledge import print_knowledge
from modefront.cli.tables import console, safe, table
from modefront.results.selection import front_points, not_converged
from modefront.work.costs import Costs


def _print(screen: Console, text: str) -> None:
    screen.print(text, markup=False, soft_wrap=True)


MOST = 10
"""Findings that are printed, at most, unless all are asked for."""


def digest(findings: Sequence[str], where: str, most: int | None = MOST) -> list[str]:
    """Return the first of some findings, and how many more there are and where they are to be seen.

    >>> digest(["a", "b", "c"], "see FILE", 2)
    ['a', 'b', 'and 1 more finding: see FILE']
    """
    rest = 0 if most is None else len(findings) - most
    if rest <= 0:
        return list(findings)
    return [*findings[:most], f"and {rest} more finding{'s' * (rest > 1)}: {where}"]


def print_summary(data: xr.Dataset, folder: Path, costs: Costs) -> None:
    """Print what a run has found and what this run of it has cost, in a few lines."""
    screen = console()
    front = front_points(data)
    optimal = int(data["pareto"].values[front].sum())
    _print(screen, f"{data.attrs.get('study', '')}: results in {folder}")
    if front.size:
        cost = data.attrs["front_evaluations"] / front.size
        _print(
            screen,
            f"  {optimal} of {front.size} points of the front are Pareto optimal among these; "
            f"{data.attrs['model_evaluations']} eigenproblems in all, {cost:.1f} a point",
        )
        _print(screen, f"  {in_numbers(data)}")
    for line in [*remarks(data, f"modefront show --all {folder}"), *cost_lines(costs)]:
        _print(screen, f"  {line}")
    _print(screen, f"next: modefront show {folder}")


def remarks(data: xr.Dataset, where: str | None = None) -> list[str]:
    """Return in words what is particular about the results.

    Where it is said ``where`` to see all findings, there are ten of them at most.
    """
    out = []
    is_optimal = "optimal-weights" in data["kind"].values
    groups = data["group"].values.tolist()
    if data.attrs["front_is_a_point"]:
        out.append("one model is the best in every group: the front is a single point")
    exact = [name for name, value in zip(groups, data["exact"].values, strict=True) if value]
    if exact and is_optimal:
        out.append(
            f"the model can fit {', '.join(exact)} exactly, where the optimal weights are not "
            "defined: optimal-weights is the regular minimum"
        )
    if is_optimal:
        out.append(_iteration(data))
    out += _branches(data)
    out += _spacing(data)
    out += _not_optimal(data)
    out += certificate_remarks(data)
    out += _poor_pairs(data)
    bounded = _at_bounds(data)
    if bounded:
        out.append(f"parameters at a bound: {bounded}")
    failed = not_converged(data)
    if failed:
        out.append(f"not converged: {', '.join(failed)}")
    if (data["status"].values == "sampled").any():
        out.append(
            f"{data.attrs['method']} has no test of convergence: it stopped when its "
            f"{data.attrs['front_evaluations']} evaluations were spent, and its points do not "
            "count as converged"
        )
    findings = data["finding"].values.tolist()
    return [*out, *(findings if where is None else digest(findings, where))]


def _branches(data: xr.Dataset) -> list[str]:
    """Return where the branches of the front end, and which points lie between them."""
    out = []
    for i in range(0, data.sizes.get("end", 0), 2):
        end, start = data["end_objective"].values[i : i + 2]
        if np.isfinite([end, start]).all():
            out.append(
                f"the front has a gap: branch {i // 2 + 1} ends at J = {_vector(end)}, "
                f"branch {i // 2 + 2} starts at J = {_vector(start)}"
            )
    if "piece" in data:
        on_front = np.isin(np.arange(data.sizes["point"]), front_points(data))
        dominated = ~data["pareto"].values & ~data["dominated_among_front"].values
        inside = on_front & dominated
        if inside.any():
            out.append(
                f"{', '.join(data['label'].values[inside])}: dominated by a known model that is "
                "no point of the front, such as the start of a branch"
            )
    return out


def _spacing(data: xr.Dataset) -> list[str]:
    """Return whether neighbours on the front are farther apart than requested."""
    requested = data.attrs.get("refined", np.inf)
    if data.attrs["largest_gap"] <= requested or np.isnan(data.attrs["largest_gap"]):
        return []
    return [
        f"neighbours on the front are up to {data.attrs['largest_gap']:.3g} apart, though "
        f"{requested:g} is requested: no point between them was found"
    ]


def _not_optimal(data: xr.Dataset) -> list[str]:
    """Return which points are no local Pareto optima."""
    negative = (data["stationary_weight"].values < -1e-6).any(axis=1)
    negative &= ~np.isnan(data["stationary_weight"].values).any(axis=1)
    if not negative.any():
        return []
    return [
        f"{', '.join(data['label'].values[negative])}: no local Pareto optimum "
        "(a weight is negative)"
    ]


def in_numbers(data: xr.Dataset) -> str:
    """Return how well the front is covered."""
    attrs = data.attrs
    text = (
        f"hypervolume {attrs['hypervolume']:.5f} up to 1.1, IGD+ {attrs['igd_plus']:.2e} to all "
        f"nondominated models, largest gap {attrs['largest_gap']:.3f}, in units of the ranges over "
        "the edges"
    )
    missing = np.isnan(attrs["hypervolume"])
    return text + (" (hypervolume: pip install modefront[metrics])" if missing else "")


def _iteration(data: xr.Dataset) -> str:
    of = data["minimum_of"].values
    theta = data["minimum_theta"].values
    optimal = data["theta"].values[data["kind"].values == "optimal-weights"][0]
    span = np.diff(data["bounds"].values, axis=1)[:, 0]
    if "iterated-weights" not in of:
        return "the iteration w = a / J runs into the singularity and confirms nothing"
    away = np.abs((theta[of == "iterated-weights"][0] - optimal) / span).max()
    if away < 1e-5:
        return "the iteration w = a / J arrives at the same optimally weighted model"
    return f"the iteration w = a / J arrives elsewhere, {away:.2g} of the ranges away"


def _poor_pairs(data: xr.Dataset) -> list[str]:
    out = []
    poor = data["mac"].values < 0.5
    for r, column in zip(data["mode"].values, poor.T, strict=True):
        if column.any():
            out.append(
                f"measured mode {r} resembles its model mode poorly (MAC below 0.5) at "
                f"{', '.join(data['label'].values[column])}"
            )
    front = front_points(data)
    pairs = data["paired_mode"].values[front]
    for r, column in zip(data["mode"].values, pairs.T, strict=True):
        for i in np.flatnonzero(np.diff(column)).tolist():
            out.append(
                f"measured mode {r} is paired with model mode {column[i]:.0f} at "
                f"{data['label'].values[front[i]]} and {column[i + 1]:.0f} at "
                f"{data['label'].values[front[i + 1]]}"
            )
    return out


def _at_bounds(data: xr.Dataset) -> str:
    theta, bounds = data["theta"].values, data["bounds"].values
    span = bounds[:, 1] - bounds[:, 0]
    at_bound = (np.abs(theta[:, :, None] - bounds) <= 1e-9 * span[:, None]).any(axis=2)
    return "; ".join(
        f"{name} ({', '.join(data['label'].values[column])})"
        for name, column in zip(data["parameter"].values, at_bound.T, strict=True)
        if column.any()
    )


def print_results(data: xr.Dataset, *, every: bool = False) -> None:
    """Print all results as tables, with the ten first findings or ``every`` one."""
    screen = console()
    attrs = data.attrs
    _print(
        screen, f"{attrs.get('study', '')}  (modefront {attrs['version']}, seed {attrs['seed']})"
    )
    screen.print(_models(data))
    screen.print(_modes(data))
    if "certified" in data:
        screen.print(_errors(data))
    screen.print(_weights(data))
    screen.print(_minima(data))
    print_knowledge(screen, data)
    for title, columns, rows, notes in prediction_tables(data):
        _print(screen, title)
        predicted = table("", [safe(column) for column in columns])
        for row in rows:
            predicted.add_row(*map(safe, row))
        screen.print(predicted)
        for line in notes:
            _print(screen, line)
    for line in remarks(data, None if every else "modefront show --all"):
        _print(screen, line)
    if front_points(data).size:
        _print(screen, in_numbers(data))
    _print(
        screen,
        f"{attrs['model_evaluations']} eigenproblems in all, "
        f"{attrs['front_evaluations']} of them for the points of the front",
    )


def _models(data: xr.Dataset) -> Table:
    """Return objectives, errors and parameters of all models."""
    names = [safe(name) for name in data["parameter"].values]
    groups = [safe(name) for name in data["group"].values]
    points = table(
        "models: * Pareto optimal among these, ! not converged",
        ["model", "", *(f"J {g}" for g in groups), *(f"error {g}" for g in groups), *names],
    )
    for i, label in enumerate(data["label"].values):
        marks = "*" * int(data["pareto"].values[i]) + "!" * int(not data["converged"].values[i])
        points.add_row(
            safe(label),
            marks,
            *(f"{x:.5g}" for x in data["objective"].values[i]),
            *(f"{x:.4g}" for x in data["error"].values[i]),
            *(f"{x:.5g}" for x in data["theta"].values[i]),
        )
    return points


def _modes(data: xr.Dataset) -> Table:
    """Return frequencies and MAC values of all models."""
    modes = data["mode"].values
    modal = table(
        "frequencies in Hz and MAC",
        ["model", *(f"f{r}" for r in modes), *(f"error f{r} %" for r in modes)]
        + [f"MAC {r}" for r in modes],
    )
    measured = data["measured_frequency"].values
    modal.add_row("measured", *map(_number, measured), *[""] * (2 * modes.size))
    for i, label in enumerate(data["label"].values):
        f = data["frequency"].values[i]
        modal.add_row(
            safe(label),
            *map(_number, f),
            *(f"{x:+.2f}" for x in 100 * (f / measured - 1)),
            *(f"{x:.4f}" for x in data["mac"].values[i]),
        )
    return modal


def _weights(data: xr.Dataset) -> Table:
    """Return the weights of all models that have some."""
    groups = [safe(name) for name in data["group"].values]
    weights = table("weights", ["model", *groups])
    for i in np.flatnonzero(~np.isnan(data["weight"].values).all(axis=1)).tolist():
        weights.add_row(
            safe(data["label"].values[i]), *(f"{x:.5g}" for x in data["weight"].values[i])
        )
    return weights


def _minima(data: xr.Dataset) -> Table:
    """Return the minima of each group and of the optimally weighted residuals."""
    names = [safe(name) for name in data["parameter"].values]
    groups = [safe(name) for name in data["group"].values]
    minima = table("minima", ["of", *(f"J {g}" for g in groups), *names])
    for i, of in enumerate(data["minimum_of"].values):
        minima.add_row(
            safe(of),
            *(f"{x:.5g}" for x in data["minimum_objective"].values[i]),
            *(f"{x:.5g}" for x in data["minimum_theta"].values[i]),
        )
    return minima


def _errors(data: xr.Dataset) -> Table:
    """Return the estimated errors of a reduced basis."""
    columns = [f"{what} {r}" for what in ("eigenvalue", "shape") for r in data["mode"].values]
    out = table("estimated relative errors: ! above the tolerance", ["model", "", *columns])
    for i, label in enumerate(data["label"].values):
        errors = [*data["eigenvalue_error"].values[i], *data["shape_error"].values[i]]
        mark = "!" * int(not data["certified"].values[i])
        out.add_row(safe(label), mark, *(f"{x:.1e}" for x in errors))
    return out


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


def _vector(values: np.ndarray[Any, Any]) -> str:
    return "(" + ", ".join(f"{x:.5g}" for x in values) + ")"


def _number(value: float) -> str:
    return "" if np.isnan(value) else f"{value:.4g}"
