"""A point of the results: a model, and why it is reported."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np

from modefront._typing import Ints
from modefront.datasets import Dataset
from modefront.optim.sqp import Solution
from modefront.work.codec import record


@record
class Kind(Enum):
    """Reason why a model is reported."""

    NOMINAL = "nominal"
    FRONT = "front"
    EDGE = "edge"
    GIVEN = "given-weights"
    EQUAL = "equal-weights"
    OPTIMAL = "optimal-weights"
    MOST_PROBABLE = "most-probable"
    IDENTIFIABLE = "identifiable-part"
    IDENTIFIABLE_EDGE = "identifiable-edge"


WEIGHTED = (Kind.GIVEN, Kind.EQUAL, Kind.MOST_PROBABLE)
"""Kinds of models of which the solution has the weights that were used."""

INTERNAL = frozenset((Kind.IDENTIFIABLE.value, Kind.IDENTIFIABLE_EDGE.value))
"""Kinds of points that tables and figures leave out unless all points are asked for."""

REFERENCES = (Kind.MOST_PROBABLE, Kind.OPTIMAL, Kind.EQUAL)
"""Kinds that the data prefer, the first of them that there is."""


@dataclass(frozen=True)
class Point:
    """A model with the reason why it is reported."""

    kind: Kind  # the reason
    solution: Solution  # the model, and how it was found
    # method of a point of the front, group of an edge, name of given weights; else empty
    name: str = ""
    index: int = 0  # number along the front or its identifiable part, from 1; else 0

    @property
    def label(self) -> str:
        """Text by which results show the point."""
        return label(self.kind, self.name, self.index)


def label(kind: Kind, name: str = "", index: int = 0) -> str:
    """Return the text by which results show a point.

    >>> label(Kind.FRONT, "nbi", 3), label(Kind.EDGE, "shapes"), label(Kind.EQUAL)
    ('nbi-3', 'edge-shapes', 'equal-weights')
    """
    texts = {
        Kind.FRONT: f"{name}-{index}",
        Kind.EDGE: f"edge-{name}",
        Kind.GIVEN: name,
        Kind.IDENTIFIABLE: f"identifiable-{index}",
        Kind.IDENTIFIABLE_EDGE: f"identifiable-edge-{name}",
    }
    return texts.get(kind, kind.value)


def of_kind(points: Iterable[Point], *kinds: Kind) -> list[Point]:
    """Return the points of some kinds, in their order."""
    return [point for point in points if point.kind in kinds]


def preferred(attributes: Mapping[Any, Any]) -> str:
    """Return the label of the reference of results, of the most probable model without one."""
    return str(attributes["reference"]) or label(Kind.MOST_PROBABLE)


def front_points(data: Dataset) -> Ints:
    """Return the positions in results of the points of the front, in their order along it."""
    return np.flatnonzero(data["kind"].values == Kind.FRONT.value)


def position(data: Dataset, point: str | int | None = None) -> int:
    """Return the position in results of a point, given by its label or position, or the reference.

    Raises KeyError for an unknown label.
    """
    if not isinstance(point, str | None):
        return point
    labels, name = data["label"].values.tolist(), preferred(data.attrs) if point is None else point
    if name not in labels:
        raise KeyError(f"expected one of {', '.join(labels)}, found {name!r}")
    return labels.index(name)
