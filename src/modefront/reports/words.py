"""Findings of results as sentences beside the pictures of a report."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import xarray as xr

from modefront.findings.catalogue import Severity
from modefront.front.methods import METHODS
from modefront.results.remarks import findings_of
from modefront.results.selection import verdict


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

    def of(*severities: Severity) -> tuple[str, ...]:
        return tuple(
            f"{text[:1].upper()}{text[1:]}".rstrip(".") + "."
            for text in (str(x) for x in found if x.severity in severities)
        )

    failed = of(Severity.FAILURE) or ("All models that were solved for converged.",)
    all_topics = (
        Topic("", tuple(verdict(data))),
        Topic("How well the best models do", of(Severity.FIT)),
        Topic("What to beware of", (*failed, *of(Severity.CAUTION))),
        Topic("What the data leave open", of(Severity.OPEN)),
        Topic("What was studied", (_study(data),)),
    )
    return [topic for topic in all_topics if topic.sentences]


def _study(data: xr.Dataset) -> str:
    groups, method = texts(data["group"].values), str(data.attrs["method"])
    title = METHODS[method].title if method in METHODS else method
    counts = [
        _count(data.sizes["parameter"], "parameter"),
        _count(data.sizes["mode"], "measured mode"),
        _count(len(groups), "group"),
        _count(int(data.attrs["model_evaluations"]), "eigenproblem"),
    ]
    remark = f" {data.attrs['remark']}." if data.attrs.get("remark") else ""
    return (
        f"A model with {counts[0]} is compared with {counts[1]} in {counts[2]} of measured "
        f"properties: {', '.join(groups)}. The front is found by {title}, and {counts[3]} were "
        f"solved in all.{remark}"
    )


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'s' * (number != 1)}"
