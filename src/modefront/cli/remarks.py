"""What is particular about results, in sentences."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr

from modefront._typing import Bools, Floats
from modefront.cli.certificates import certificate_remarks
from modefront.fronts.point import Kind
from modefront.results.selection import front_points, not_converged

MOST = 10
"""Findings that are printed, at most, unless all are asked for."""

NAMED = 6
"""Points, or runs of them, that are named one by one in a sentence."""

POOR = 0.5
"""MAC below which a pair is poor."""


def digest(findings: Sequence[str], where: str, most: int | None = MOST) -> list[str]:
    """Return the first of some findings, and how many more there are and where they are to be seen.

    >>> digest(["a", "b", "c"], "see FILE", 2)
    ['a', 'b', 'and 1 more finding: see FILE']
    """
    rest = 0 if most is None else len(findings) - most
    if rest <= 0:
        return list(findings)
    return [*findings[:most], f"and {rest} more finding{'s' * (rest > 1)}: {where}"]


def remarks(data: xr.Dataset, where: str | None = None) -> list[str]:
    """Return in words what is particular about the results.

    Where it is said ``where`` to see all findings, there are ten of them at most.
    """
    out = [*_single(data), *_exact(data), *_iteration(data), *_branches(data), *_spacing(data)]
    out += [*_not_optimal(data), *certificate_remarks(data), *_poor_pairs(data), *_pairs(data)]
    out += [*_at_bounds(data), *_failed(data), *_sampled(data)]
    findings = data["finding"].values.tolist()
    return [*out, *(findings if where is None else digest(findings, where))]


def headlines(data: xr.Dataset, where: str) -> list[str]:
    """Return what a user should know first: what failed, how good models are, what is open.

    Remarks on the numerics of the optimal weights and on the coverage of the front are left to
    `remarks` and `coverage_in_words`.
    """
    out = [*_failed(data), *_quality(data), *_single(data), *_branches(data), *_spacing(data)]
    out += [
        *certificate_remarks(data),
        *_poor_pairs(data),
        *_pairs(data),
        *_at_bounds(data),
        *_sampled(data),
    ]
    return [*out, *digest(data["finding"].values.tolist(), where)]


def coverage_in_words(data: xr.Dataset) -> str:
    """Return how well the front is covered, with the terms explained."""
    attrs = data.attrs
    text = (
        f"hypervolume {attrs['hypervolume']:.5f} up to 1.1 (what the front dominates; more is "
        f"better), IGD+ {attrs['igd_plus']:.2e} (mean distance of all nondominated models that are "
        f"known from it; 0 is best), largest gap {attrs['largest_gap']:.3f} between neighbours, "
        "all in units of the ranges of the objectives over the edges"
    )
    missing = np.isnan(attrs["hypervolume"])
    return text + ("; for the hypervolume: pip install modefront[metrics]" if missing else "")


def places(data: xr.Dataset, chosen: Bools) -> str:
    """Return the labels of chosen points (points,); how many there are where these are many.

    Neighbours on a front of two objectives are named by the first and the last one.
    """
    labels = [str(x) for x in data["label"].values]
    front = front_points(data).tolist()
    along = {i: k for k, i in enumerate(front)} if data.sizes["group"] == 2 else {}
    runs: list[list[int]] = []
    for i in np.flatnonzero(chosen).tolist():
        last = runs[-1][-1] if runs else None
        if last is not None and i in along and last in along and along[i] == along[last] + 1:
            runs[-1].append(i)
        else:
            runs.append([i])
    parts: list[str] = []
    for run in runs:
        if len(run) > 2:
            parts.append(f"{labels[run[0]]} to {labels[run[-1]]}")
        else:
            parts += [labels[i] for i in run]
    if len(parts) > NAMED:
        return f"{int(chosen.sum())} of {len(labels)} models"
    return ", ".join(parts)


def _quality(data: xr.Dataset) -> Iterator[str]:
    """Yield how far the Pareto-optimal models are from the data."""
    chosen = data["pareto"].values
    if not chosen.any():
        return
    error = 100 * np.abs(data["frequency"].values / data["measured_frequency"].values - 1)[chosen]
    mac = data["mac"].values[chosen]
    best = str(data.attrs["reference"])
    rows = data["label"].values == best
    of_best = 100 * np.abs(data["frequency"].values[rows] / data["measured_frequency"].values - 1)
    yield (
        f"all {int(chosen.sum())} Pareto-optimal models have frequencies within "
        f"{_percent(_most(error))} % of the measured ones and MAC values of {_mac(_least(mac))} or "
        f"more; "
        f"{best} has {_percent(_most(of_best))} % and {_mac(_least(data['mac'].values[rows]))}"
    )


def _percent(value: float) -> str:
    """Return an error in % with two digits, rounded up: no model has a greater one.

    >>> _percent(1.04), _percent(0.78), _percent(123.4)
    ('1.1', '0.78', '124')
    """
    if not np.isfinite(value) or value < 0.01:
        return "0.01" if value < 0.01 else f"{value}"
    decimals = max(1 - int(np.floor(np.log10(value))), 0)
    up = np.ceil(10**decimals * value * (1 - 1e-12)) / 10**decimals
    return f"{up:.2g}" if up < 10 else f"{up:.0f}"


def _mac(value: float) -> str:
    """Return a MAC with three digits, rounded down: no model has a smaller one.

    >>> _mac(0.9996), _mac(1.0), _mac(0.812)
    ('0.999', '1.000', '0.812')
    """
    return f"{np.floor(1e3 * value + 1e-9) / 1e3:.3f}"


def _most(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(known.max()) if known.size else float("nan")


def _least(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(known.min()) if known.size else float("nan")


def _single(data: xr.Dataset) -> Iterator[str]:
    if data.attrs["front_is_a_point"]:
        yield "one model is the best in every group: the front is a single point"


def _exact(data: xr.Dataset) -> Iterator[str]:
    """Yield that optimal weights have no minimum where a group can be fitted exactly."""
    exact = data["group"].values[data["exact"].values.astype(bool)].tolist()
    if exact and _has_optimal(data):
        yield (
            f"the model can fit {', '.join(exact)} exactly, where the optimal weights are not "
            "defined: optimal-weights is the regular minimum"
        )


def _has_optimal(data: xr.Dataset) -> bool:
    return bool((data["kind"].values == Kind.OPTIMAL.value).any())


def _iteration(data: xr.Dataset) -> Iterator[str]:
    """Yield where the iteration of the weights arrives."""
    if not _has_optimal(data):
        return
    of = data["minimum_of"].values
    theta = data["minimum_theta"].values
    optimal = data["theta"].values[data["kind"].values == Kind.OPTIMAL.value][0]
    span = np.diff(data["bounds"].values, axis=1)[:, 0]
    if "iterated-weights" not in of:
        yield "the iteration w = a / J runs into the singularity and confirms nothing"
        return
    away = np.abs((theta[of == "iterated-weights"][0] - optimal) / span).max(initial=0.0)
    if away < 1e-5:
        yield "the iteration w = a / J arrives at the same optimally weighted model"
    else:
        yield f"the iteration w = a / J arrives elsewhere, {away:.2g} of the ranges away"


def _branches(data: xr.Dataset) -> Iterator[str]:
    """Yield where the branches of the front end, and which points lie between them."""
    for i in range(0, data.sizes.get("end", 0), 2):
        end, start = data["end_objective"].values[i : i + 2]
        if np.isfinite([end, start]).all():
            yield (
                f"the front has a gap: branch {i // 2 + 1} ends at J = {_vector(end)}, "
                f"branch {i // 2 + 2} starts at J = {_vector(start)}"
            )
    if "piece" in data:
        on_front = np.isin(np.arange(data.sizes["point"]), front_points(data))
        inside = on_front & ~data["pareto"].values & ~data["dominated_among_front"].values
        if inside.any():
            yield (
                f"{places(data, inside)}: dominated by a known model that is no point of the "
                "front, such as the start of a branch"
            )


def _spacing(data: xr.Dataset) -> Iterator[str]:
    """Yield whether neighbours on the front are farther apart than requested."""
    requested = data.attrs.get("refined", np.inf)
    if data.attrs["largest_gap"] > requested:
        yield (
            f"neighbours on the front are up to {data.attrs['largest_gap']:.3g} apart, though "
            f"{requested:g} is requested: no point between them was found"
        )


def _not_optimal(data: xr.Dataset) -> Iterator[str]:
    """Yield which points are no local Pareto optima."""
    negative = (data["stationary_weight"].values < -1e-6).any(axis=1)
    negative &= ~np.isnan(data["stationary_weight"].values).any(axis=1)
    if negative.any():
        yield f"{places(data, negative)}: no local Pareto optimum (a weight is negative)"


def _poor_pairs(data: xr.Dataset) -> Iterator[str]:
    """Yield which measured modes resemble their model modes poorly."""
    for r, column in zip(data["mode"].values, data["mac"].values.T, strict=True):
        poor = column < POOR
        if poor.any():
            yield (
                f"measured mode {r} resembles its model mode poorly (MAC below {POOR}) at "
                f"{places(data, poor)}"
            )


def _pairs(data: xr.Dataset) -> Iterator[str]:
    """Yield which measured modes are paired with different model modes along the front.

    Where they change places is said of a front of two objectives, on which points have neighbours.
    """
    front = front_points(data)
    labels = data["label"].values
    for r, column in zip(data["mode"].values, data["paired_mode"].values[front].T, strict=True):
        known = column[np.isfinite(column)]
        numbers, counts = np.unique(known, return_counts=True)
        changes = np.flatnonzero(np.diff(column)).tolist()
        if numbers.size < 2:
            continue
        if data.sizes["group"] == 2 and len(changes) <= 2:
            for i in changes:
                yield (
                    f"measured mode {r} is paired with model mode {column[i]:.0f} at "
                    f"{labels[front[i]]} and {column[i + 1]:.0f} at {labels[front[i + 1]]}"
                )
            continue
        order = np.argsort(-counts, kind="stable")
        each = [f"{numbers[k]:.0f} at {counts[k]}" for k in order.tolist()]
        yield (
            f"measured mode {r} is paired with different model modes along the front: "
            f"{', '.join(each)} of {front.size} points"
        )


def _at_bounds(data: xr.Dataset) -> Iterator[str]:
    """Yield which parameters are at a bound, and where."""
    theta, bounds = data["theta"].values, data["bounds"].values
    span = bounds[:, 1] - bounds[:, 0]
    at_bound = (np.abs(theta[:, :, None] - bounds) <= 1e-9 * span[:, None]).any(axis=2)
    named = [
        f"{name} ({places(data, column)})"
        for name, column in zip(data["parameter"].values, at_bound.T, strict=True)
        if column.any()
    ]
    if named:
        yield f"parameters at a bound: {'; '.join(named)}"


def _failed(data: xr.Dataset) -> Iterator[str]:
    failed = np.isin(data["label"].values, not_converged(data))
    if failed.any():
        yield f"not converged: {places(data, failed)}"


def _sampled(data: xr.Dataset) -> Iterator[str]:
    if (data["status"].values == "sampled").any():
        yield (
            f"{data.attrs['method']} has no test of convergence: it stopped when its "
            f"{data.attrs['front_evaluations']} evaluations were spent, and its points do not "
            "count as converged"
        )


def _vector(values: Floats) -> str:
    return "(" + ", ".join(f"{x:.5g}" for x in values) + ")"
