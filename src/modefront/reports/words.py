"""Findings of results as sentences beside the pictures of a report."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from modefront.findings.catalogue import Severity
from modefront.front.methods import METHODS
from modefront.predictions.registry import kinds_in
from modefront.results.remarks import findings_of
from modefront.results.selection import front_points

FEW = 8
"""Labels and ranges that a sentence names, at most."""

WIDE = 1.02
"""Ratio of greatest to least prediction from which a spread is worth a sentence."""


@dataclass(frozen=True)
class Topic:
    """Sentences on one question; those of the first answer have no heading."""

    heading: str
    sentences: tuple[str, ...]


def texts(values: Any) -> list[str]:
    """Return the texts of an array."""
    return [str(x) for x in values.tolist()]


def topics(data: xr.Dataset) -> list[Topic]:
    """Return the sentences: the first answer, then those on each question."""
    found = findings_of(data)

    def of(*severities: Severity) -> list[str]:
        return [str(finding) for finding in found if finding.severity in severities]

    failed = of(Severity.FAILURE) or ["all models that were solved for converged"]
    all_topics = (
        Topic("", tuple(str(data.attrs.get("verdict", "")).splitlines())),
        Topic("How well the best models do", sentences(of(Severity.FIT))),
        Topic("What to beware of", sentences([*failed, *of(Severity.CAUTION), *_dominated(data)])),
        Topic("What the data leave open", (*sentences(of(Severity.OPEN)), *_open(data))),
        Topic("What was studied", tuple(_study(data))),
    )
    return [topic for topic in all_topics if topic.sentences]


def sentences(texts: Iterable[str]) -> tuple[str, ...]:
    """Return texts as whole sentences."""
    return tuple(f"{text[:1].upper()}{text[1:]}".rstrip(".") + "." for text in texts)


def _study(data: xr.Dataset) -> Iterator[str]:
    sizes = data.sizes
    groups = texts(data["group"].values)
    method = str(data.attrs["method"])
    title = METHODS[method].title if method in METHODS else method
    yield (
        f"A model with {_count(sizes['parameter'], 'parameter')} is compared with "
        f"{_count(sizes['mode'], 'measured mode')} in {_count(len(groups), 'group')} of measured "
        f"properties: {', '.join(groups)}. The front is found by {title}, and "
        f"{_count(int(data.attrs['model_evaluations']), 'eigenproblem')} were solved in all."
    )
    if data.attrs.get("remark"):
        yield f"{data.attrs['remark']}."


def _dominated(data: xr.Dataset) -> Iterator[str]:
    front = front_points(data)
    labels = data["label"].values[front[~data["pareto"].values[front].astype(bool)]].tolist()
    if labels:
        rest = len(labels) - FEW
        some = ", ".join(labels[:FEW]) + (f" and {rest} more" if rest > 0 else "")
        yield f"dominated by a known model, and drawn hollow: {some}"


def _open(data: xr.Dataset) -> Iterator[str]:
    """Yield the ranges of the front, which are no confidence intervals."""
    best = np.flatnonzero(data["pareto"].values)
    theta, bounds = data["theta"].values[best], data["bounds"].values
    names = texts(data["parameter"].values)
    if best.size > 1:
        low, high = theta.min(axis=0), theta.max(axis=0)
        span = bounds[:, 1] - bounds[:, 0]
        order = np.argsort(-(high - low) / np.where(span > 0, span, 1.0), kind="stable")[:FEW]
        ranges = [f"{names[j]} from {low[j]:.3g} to {high[j]:.3g}" for j in order.tolist()]
        rest = len(names) - len(ranges)
        more = f" ({_count(rest, 'parameter')} more vary less)" if rest else ""
        yield (
            f"Over all {best.size} Pareto-optimal models, that is for all weights of the groups, "
            f"{', '.join(ranges)}{more}."
        )
    yield from _spread(data)


def _spread(data: xr.Dataset) -> Iterator[str]:
    """Yield the spread of predictions, with its meaning."""
    widest: list[tuple[float, str]] = []
    for kind in kinds_in(data):
        for variable in kind.ranged:
            ratio = data[f"{variable.name}_range"].values[2]
            places = texts(data[kind.dimension].values)
            widest += [
                (float(x), f"{variable.key} of {place} {_times(x)}")
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


def _times(ratio: float) -> str:
    """Return a ratio in words.

    >>> _times(1.31), _times(2.34), _times(4512.3), _times(3.2e7)
    ('by 31 %', 'by a factor of 2.3', 'by a factor of 4,500', 'by more than 7 powers of ten')
    """
    if ratio < 2:
        return f"by {100 * (ratio - 1):.2g} %"
    if ratio < 10:
        return f"by a factor of {ratio:.2g}"
    if ratio < 1e6:
        digits = len(str(int(ratio)))
        return f"by a factor of {round(ratio, 2 - digits):,.0f}"
    return f"by more than {int(np.log10(ratio))} powers of ten"


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'s' * (number != 1)}"
