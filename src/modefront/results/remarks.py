"""Remarks on results as sentences, for the terminal and the report.

A sentence begins with a small letter and ends without a full stop.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr

from modefront._typing import Bools, Floats
from modefront.front.point import Kind
from modefront.optim.problem import AT_BOUND
from modefront.results.selection import front_points, not_converged, uncertified
from modefront.rounding import ACCUMULATED

CHANGED = "changed"
"""Attribute of results that were read: how they are not as a run has written them."""

MOST = 10
"""Findings that are printed, at most, unless all are asked for."""

NAMED = 6
"""Points, or runs of them, that are named one by one in a sentence."""

FEW = 2
"""Modes whose pairs change, and parameters at bounds, that a first screen names one by one."""

NEGATIVE = 1e-6
"""Size of a negative weight, the sum of all being 1, that solutions do not leave by rounding: ten
times the tolerance of a step (`modefront.optim.sqp.Options`)."""

ARRIVED = 1e-5
"""Distance of two optimally weighted models, over the ranges, below which they are the same: a
hundred times the tolerance of a step, which minima that are nearly flat miss by as much."""

POOR = 0.5
"""MAC below which a pair is poor."""


def digest(findings: Sequence[str], where: str, most: int | None = MOST) -> list[str]:
    """Return the first of some findings, with the number of others and the option that prints them.

    >>> digest(["a", "b", "c"], "see FILE", 2)
    ['a', 'b', 'and 1 more finding: see FILE']
    """
    rest = 0 if most is None else len(findings) - most
    if rest <= 0:
        return list(findings)
    return [*findings[:most], f"and {rest} more finding{'s' * (rest > 1)}: {where}"]


def remarks(data: xr.Dataset) -> list[str]:
    """Return all remarks on the results."""
    return [
        *_changed(data),
        *misfit(data),
        *single(data),
        *_exact(data),
        *_iteration(data),
        *_branches(data),
        *_spacing(data),
        *_not_optimal(data),
        *_certificates(data),
        *_poor_pairs(data),
        *_pairs(data),
        *_at_bounds(data),
        *_failed(data),
        *_sampled(data),
        *data["finding"].values.tolist(),
    ]


def headlines(data: xr.Dataset) -> list[str]:
    """Return the first remarks: failures, distance of the models from the data, open questions.

    Details of the branches, of the numerics and of the coverage of the front are left to `remarks`
    and `coverage_in_words`.
    """
    return [
        *failures(data),
        *misfit(data),
        *single(data),
        *_gaps(data),
        *_poor_pairs(data, FEW),
        *_changed_pairs(data),
        *_at_bounds(data, FEW),
        *data["finding"].values.tolist(),
    ]


def failures(data: xr.Dataset) -> list[str]:
    """Return which models did not converge, are not accurate, or have no test of convergence.

    Before them, that the results were changed.
    """
    failed = uncertified(data)
    above = np.isin(data["label"].values, failed)
    inaccurate = [f"modes are less accurate than asked for at {places(data, above)}"]
    return [*_changed(data), *_failed(data), *(inaccurate if failed.size else []), *_sampled(data)]


def _changed(data: xr.Dataset) -> list[str]:
    return [str(data.attrs[CHANGED])] if CHANGED in data.attrs else []


def cautions(data: xr.Dataset) -> list[str]:
    """Return the warnings other than failures."""
    return [
        *_branches(data),
        *_spacing(data),
        *_not_optimal(data),
        *_poor_pairs(data, FEW),
        *_changed_pairs(data),
        *_at_bounds(data, FEW),
    ]


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


def misfit(data: xr.Dataset) -> Iterator[str]:
    """Yield how far models are from the data: all Pareto-optimal ones, the reference, the nominal.

    Pareto-optimal are edges and weighted models too: the best models are never left out.
    """
    chosen, labels = data["pareto"].values, data["label"].values
    if not chosen.any():
        return
    best = str(data.attrs["reference"])
    parts = [
        f"all {int(chosen.sum())} Pareto-optimal models have {_fit(data, chosen, whole=True)}",
        f"{best} has {_fit(data, labels == best)}",
    ]
    nominal = data["kind"].values == Kind.NOMINAL.value
    if nominal.any() and np.isfinite(data["frequency"].values[nominal]).any():
        parts.append(f"the nominal model has {_fit(data, nominal)}")
    yield "; ".join(parts)


def _fit(data: xr.Dataset, chosen: Bools, *, whole: bool = False) -> str:
    """Return the worst error of a frequency and the least MAC of models, in a whole sentence."""
    f, measured = data["frequency"].values[chosen], data["measured_frequency"].values
    error = 100 * np.abs(
        np.divide(f, measured, out=np.full(f.shape, np.nan), where=measured > 0) - 1
    )
    mac = data["mac"].values[chosen]
    parts = []
    if np.isfinite(error).any():
        within = f"frequencies within {_percent(_most(error))} % of the measured ones"
        parts.append(within if whole else f"{_percent(_most(error))} %")
    if np.isfinite(mac).any():
        least = _mac(_least(mac))
        parts.append(f"MAC values of {least} or more" if whole else least)
    return " and ".join(parts) or "nothing that is measured"


def _percent(value: float) -> str:
    """Return an error in % with two digits, rounded up: no model has a greater one.

    >>> _percent(1.04), _percent(0.78), _percent(123.4)
    ('1.1', '0.78', '124')
    """
    if not np.isfinite(value) or value < 0.01:
        return "0.01" if value < 0.01 else f"{value}"
    decimals = max(1 - int(np.floor(np.log10(value))), 0)
    up = np.ceil(10**decimals * value * (1 - ACCUMULATED)) / 10**decimals
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


def single(data: xr.Dataset) -> Iterator[str]:
    """Yield that the front is one point, where it is."""
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
        yield "the fixed-point iteration of the weights ends at an exact fit and confirms nothing"
        return
    away = np.abs((theta[of == "iterated-weights"][0] - optimal) / span).max(initial=0.0)
    if away < ARRIVED:
        yield "the fixed-point iteration of the weights finds the same optimally weighted model"
    else:
        yield "the optimal weights are not unique: their fixed-point iteration finds a second set"


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


def _gaps(data: xr.Dataset) -> Iterator[str]:
    """Yield how many branches the front has, where it has several."""
    gaps = data.sizes.get("end", 0) // 2
    if gaps:
        yield f"the front is not connected: it has {gaps + 1} branches"


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
    negative = (data["stationary_weight"].values < -NEGATIVE).any(axis=1)
    negative &= ~np.isnan(data["stationary_weight"].values).any(axis=1)
    if negative.any():
        yield f"{places(data, negative)}: no local Pareto optimum (a weight is negative)"


def _poor_pairs(data: xr.Dataset, most: int | None = None) -> Iterator[str]:
    """Yield which measured modes resemble their model modes poorly; of many, without the places."""
    poor = data["mac"].values < POOR
    modes = data["mode"].values
    if most is not None and poor.any(axis=0).sum() > most:
        some = ", ".join(str(r) for r in modes[poor.any(axis=0)])
        yield f"measured modes {some} resemble their model modes poorly (MAC below {POOR})"
        return
    for r, column in zip(modes, poor.T, strict=True):
        if column.any():
            yield (
                f"measured mode {r} resembles its model mode poorly (MAC below {POOR}) at "
                f"{places(data, column)}"
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


def _changed_pairs(data: xr.Dataset) -> list[str]:
    """Return which measured modes are paired with different model modes, of many in one line."""
    pairs = list(_pairs(data))
    if len(pairs) <= FEW:
        return pairs
    paired = data["paired_mode"].values[front_points(data)]
    changed = [np.unique(column[np.isfinite(column)]).size > 1 for column in paired.T]
    modes = ", ".join(str(r) for r in data["mode"].values[changed])
    return [f"measured modes {modes} are paired with different model modes along the front"]


def _at_bounds(data: xr.Dataset, most: int | None = None) -> Iterator[str]:
    """Yield which parameters are at a bound and where, of more than ``most`` only how many."""
    theta, bounds = data["theta"].values, data["bounds"].values
    span = bounds[:, 1] - bounds[:, 0]
    at_bound = (np.abs(theta[:, :, None] - bounds) <= AT_BOUND * span[:, None]).any(axis=2)
    names = data["parameter"].values[at_bound.any(axis=0)].tolist()
    if most is not None and len(names) > most:
        some = ", ".join(names[:most])
        yield f"{len(names)} parameters are at a bound in some models: {some} and others"
        return
    named = [
        f"{name} ({places(data, column)})"
        for name, column in zip(data["parameter"].values, at_bound.T, strict=True)
        if column.any()
    ]
    if named:
        yield f"parameters at a bound: {'; '.join(named)}"


def _certificates(data: xr.Dataset) -> Iterator[str]:
    """Yield how exact the modes of a reduced basis are, and which models miss the tolerance."""
    attrs = data.attrs
    if attrs.get("remark"):
        yield str(attrs["remark"])
    if "certified" not in data:
        return
    worst = float(data["eigenvalue_error"].max())
    predicted = attrs.get("prediction_eigensolutions", 0)
    yield (
        f"reduced basis from {attrs['full_eigensolutions'] - predicted} full eigensolutions "
        f"and {attrs.get('corrected_eigensolutions', 0)} corrected with their factors: relative "
        f"errors of eigenvalues up to {worst:.1e} (estimated; tolerance "
        f"{attrs['eigenvalue_tolerance']:.0e}), of shapes up to "
        f"{float(data['shape_error'].max()):.1e}"
    )
    if predicted:
        yield f"predictions are not reduced: they took {predicted} full eigensolutions"
    failed = uncertified(data)
    if failed.size:
        yield f"above the tolerance: {', '.join(failed)}"
        held = data["label"].values[data["certified"].values]
        yield f"within the tolerance: {', '.join(held) if held.size else 'none'}"


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
