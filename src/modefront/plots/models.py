"""Models of a picture, and the marks of their kinds."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from modefront._typing import Bools, Floats, Ints
from modefront.front.point import REFERENCES, WEIGHTED, Kind, preferred
from modefront.plots.canvas import COLOURS


def draw_models(axes: Axes, data: xr.Dataset, values: Floats, *without: str) -> None:
    """Draw values (points, 2) of all models but those of some kinds, with the marks of their kinds.

    What matters most is drawn last.
    """
    kind, pareto = data["kind"].values, data["pareto"].values.astype(bool)
    reference = data["label"].values == preferred(data.attrs)
    front = kind == Kind.FRONT.value
    weighted = np.isin(kind, [each.value for each in WEIGHTED]) & ~reference
    best = next(
        (each.value for each in REFERENCES if (kind[reference] == each.value).any()), "reference"
    )
    blue, red, *_, yellow = COLOURS
    rows: tuple[tuple[str, Bools, dict[str, Any]], ...] = (
        ("dominated", front & ~pareto, {"marker": "o", "mfc": "w", "mec": blue, "ms": 4.5}),
        ("Pareto optimal", front & pareto, {"marker": "o", "color": blue, "ms": 4.5}),
        (
            "edge",
            kind == Kind.EDGE.value,
            {"marker": "s", "mfc": "none", "mec": "k", "mew": 1.0, "ms": 8},
        ),
        ("weights", weighted, {"marker": "D", "color": yellow, "mec": "k", "mew": 0.6, "ms": 6}),
        ("nominal", kind == Kind.NOMINAL.value, {"marker": "X", "color": "0.4", "ms": 7}),
        (
            best.replace("-", " "),
            reference,
            {"marker": "*", "color": red, "mec": "k", "mew": 0.6, "ms": 12},
        ),
    )
    for name, chosen, marks in rows:
        if chosen.any() and name not in without:
            axes.plot(*values[chosen].T, ls="", label=name, **marks)


def shown(data: xr.Dataset) -> Bools:
    """Return which points are Pareto optimal; all that are reported where none is."""
    pareto = np.asarray(data["pareto"].values, dtype=np.bool_)
    return pareto if pareto.any() else np.ones(len(pareto), dtype=np.bool_)


def front_of(data: xr.Dataset) -> Ints:
    """Return the positions of the points of the front, in their order."""
    return np.flatnonzero(data["kind"].values == Kind.FRONT.value)


def is_path(data: xr.Dataset) -> bool:
    """Return whether neighbours on the front follow each other: it has two objectives."""
    return data.sizes["group"] == 2 and front_of(data).size > 1


def position(data: xr.Dataset, point: str | int) -> int:
    """Return the position of a point from its label or position; raises KeyError without one."""
    if not isinstance(point, str):
        return point
    labels = [str(x) for x in data["label"].values]
    if point not in labels:
        raise KeyError(f"expected one of {', '.join(labels)}, found {point!r}")
    return labels.index(point)


def reference_of(data: xr.Dataset) -> int:
    """Return the position of the model that the data prefer."""
    return position(data, preferred(data.attrs))


def branches(data: xr.Dataset) -> Iterator[Ints]:
    """Yield the Pareto-optimal points of each branch of a front of two objectives, in order."""
    front = front_of(data)
    front = front[data["pareto"].values[front].astype(bool)]
    front = front[np.argsort(data["error"].values[front, 0], kind="stable")]
    number = data["piece"].values[front] if "piece" in data else np.ones(front.size)
    for each in np.unique(number):
        yield front[number == each]
