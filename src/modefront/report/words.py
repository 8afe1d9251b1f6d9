"""What results say, in sentences beside the pictures of a report."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from modefront._typing import Floats, Ints
from modefront.predictions import KINDS
from modefront.results.selection import front_points, not_converged

FEW = 8
"""Labels and ranges that a sentence names, at most."""

WIDE = 1.02
"""Ratio of greatest to least prediction from which a spread is worth a sentence."""


@dataclass(frozen=True)
class Topic:
    """Sentences on one question."""

    heading: str
    sentences: tuple[str, ...]


def texts(values: Any) -> list[str]:
    """Return the texts of an array."""
    return [str(x) for x in values.tolist()]


def topics(data: xr.Dataset) -> list[Topic]:
    """Return what the study was, what was found, and what is left open."""
    all_topics = (
        Topic("What was studied", tuple(_study(data))),
        Topic("How well the best models do", tuple(_quality(data))),
        Topic("What the data leave open", tuple(_open(data))),
        Topic("What to beware of", tuple(_caution(data))),
    )
    return [topic for topic in all_topics if topic.sentences]


def _study(data: xr.Dataset) -> Iterator[str]:
    sizes = data.sizes
    groups = texts(data["group"].values)
    yield (
        f"A model with {_count(sizes['parameter'], 'parameter')} is compared with "
        f"{_count(sizes['mode'], 'measured mode')} in {_count(len(groups), 'group')} of measured "
        f"properties: {', '.join(groups)}."
    )
    front = front_points(data)
    optimal = int(data["pareto"].values[front].sum())
    method = str(data.attrs["method"])
    if data.attrs["front_is_a_point"]:
        yield "One model is the best in every group: the front is a single point."
    elif front.size:
        yield (
            f"The front has {_count(front.size, 'point')}, found by {METHODS.get(method, method)}; "
            f"{optimal} of them are Pareto optimal: no known model is better in one group without "
            "being worse in another."
        )
    yield f"{_count(int(data.attrs['model_evaluations']), 'eigenproblem')} were solved in all."
    if data.attrs.get("remark"):
        yield f"{data.attrs['remark']}."


METHODS = {
    "nbi": "normal-boundary intersection",
    "weights": "a sweep of the weights",
    "spea2": "SPEA2",
    "nsga2": "NSGA-II",
}


def _quality(data: xr.Dataset) -> Iterator[str]:
    labels = texts(data["label"].values)
    reference = labels.index(str(data.attrs["reference"]))
    nominal = [i for i, kind in enumerate(texts(data["kind"].values)) if kind == "nominal"]
    front = _optimal(data)
    chosen = [
        *[("the nominal model", i) for i in nominal[:1]],
        (f"{labels[reference]}, the model that the data prefer,", reference),
    ]
    with np.errstate(divide="ignore", invalid="ignore"):
        error = np.abs(100 * (data["frequency"].values / data["measured_frequency"].values - 1))
    worst, mac = _most(error), -_most(-data["mac"].values)
    for name, i in chosen:
        parts = []
        if np.isfinite(worst[i]):
            parts.append(f"misses measured frequencies by up to {_percent(worst[i])} %")
        if np.isfinite(mac[i]):
            parts.append(f"has a least MAC of {_mac(mac[i])}")
        if parts:
            yield f"{name[0].upper()}{name[1:]} {' and '.join(parts)}."
    if front.size > 1:
        parts = []
        if np.isfinite(worst[front]).any():
            low, high = np.nanmin(worst[front]), np.nanmax(worst[front])
            parts.append(
                f"the worst frequency error goes from {_percent(low)} to {_percent(high)} %"
            )
        if np.isfinite(mac[front]).any():
            low, high = np.nanmin(mac[front]), np.nanmax(mac[front])
            parts.append(f"the least MAC from {_mac(low)} to {_mac(high)}")
        if parts:
            yield f"Over the Pareto-optimal models, {' and '.join(parts)}."


def _open(data: xr.Dataset) -> Iterator[str]:
    front = _optimal(data)
    theta, bounds = data["theta"].values[front], data["bounds"].values
    names = texts(data["parameter"].values)
    if front.size > 1:
        low, high = theta.min(axis=0), theta.max(axis=0)
        span = bounds[:, 1] - bounds[:, 0]
        order = np.argsort(-(high - low) / np.where(span > 0, span, 1.0), kind="stable")[:FEW]
        ranges = [f"{names[j]} from {low[j]:.3g} to {high[j]:.3g}" for j in order.tolist()]
        rest = len(names) - len(ranges)
        more = f" ({_count(rest, 'parameter')} more vary less)" if rest else ""
        yield f"Over the Pareto-optimal models, {', '.join(ranges)}{more}."
    yield from _spread(data)
    yield from (f"{_capital(text)}." for text in texts(data["finding"].values))


def _spread(data: xr.Dataset) -> Iterator[str]:
    """Yield what the spread of predictions is, and what it means."""
    widest: list[tuple[float, str]] = []
    for kind in (each.kind for each in KINDS):
        if kind.dimension not in data.sizes:
            continue
        for variable in kind.ranged:
            ratio = data[f"{variable.name}_range"].values[2]
            places = texts(data[kind.dimension].values)
            widest += [
                (float(x), f"{variable.key} of {place} by a factor of {x:.3g}")
                for x, place in zip(ratio, places, strict=True)
                if np.isfinite(x) and x > WIDE
            ]
    if widest:
        some = [text for _, text in sorted(widest, key=lambda each: -each[0])[:3]]
        yield (
            f"Predictions of the Pareto-optimal models differ: {'; '.join(some)}. This spread is "
            "what the choice of weights leaves open. It is no confidence interval: what errors of "
            "the data leave open is the posterior at the reference."
        )


def _caution(data: xr.Dataset) -> Iterator[str]:
    failed = not_converged(data)
    if failed:
        yield f"Not converged, kept and marked: {_some(failed)}."
    else:
        yield "All models that were solved for converged."
    if (data["status"].values == "sampled").any():
        yield (
            f"{METHODS.get(str(data.attrs['method']), '')} has no test of convergence: its points "
            "do not count as converged."
        )
    front = front_points(data)
    labels = np.array(texts(data["label"].values))
    dominated = labels[front[~data["pareto"].values[front].astype(bool)]].tolist()
    if dominated:
        yield f"Dominated by a known model, and drawn hollow: {_some(dominated)}."
    gaps = data.sizes.get("end", 0) // 2
    if gaps:
        yield (
            f"The front has {_count(gaps, 'gap')}: dotted circles are where a branch ends and the "
            "next one starts."
        )
    poor = [
        str(mode)
        for mode, column in zip(data["mode"].values, data["mac"].values[front].T, strict=True)
        if (column < 0.5).any()
    ]
    if poor:
        yield (
            f"Measured mode {', '.join(poor)} resembles its model mode poorly (MAC below 0.5) at "
            "some points of the front."
        )
    if "at_bound" in data:
        at = (data["at_bound"].values[front] != 0).any(axis=0)
        if at.any():
            names = [
                name
                for name, is_at in zip(texts(data["parameter"].values), at, strict=True)
                if is_at
            ]
            yield f"At a bound somewhere on the front: {_some(names)}."
    if "certified" in data and not data["certified"].values.all():
        unsure = labels[~data["certified"].values.astype(bool)].tolist()
        yield f"Errors of the reduced basis are above the tolerance at {_some(unsure)}."


def _optimal(data: xr.Dataset) -> Ints:
    """Return the positions of the Pareto-optimal points of the front."""
    front = front_points(data)
    out: Ints = front[data["pareto"].values[front].astype(bool)]
    return out


def _most(values: Floats) -> Floats:
    """Return the greatest known value of each row; NaN where none is known."""
    known = np.isfinite(values)
    most = np.where(known, values, -np.inf).max(axis=1)
    return np.where(known.any(axis=1), most, np.nan)


def _percent(value: float) -> str:
    """Return an error in %, as far as anyone wants to know it.

    >>> _percent(2.3e-9), _percent(1.0404), _percent(8.14), _percent(123.4)
    ('0.00', '1.04', '8.14', '123')
    """
    if value < 0.01:
        return "0.00"
    return f"{value:.3g}" if value < 100 else f"{value:.0f}"


def _mac(value: float) -> str:
    """Return a MAC with four digits, never rounded up to 1.

    >>> _mac(0.99999)
    '0.9999'
    """
    return f"{np.floor(1e4 * value) / 1e4:.4f}"


def _count(number: int, thing: str) -> str:
    return f"{number} {thing}{'s' * (number != 1)}"


def _some(names: Sequence[str]) -> str:
    """Return names, a few of many."""
    rest = len(names) - FEW
    return ", ".join(names[:FEW]) + (f" and {rest} more" if rest > 0 else "")


def _capital(text: str) -> str:
    return f"{text[:1].upper()}{text[1:]}".rstrip(".")
