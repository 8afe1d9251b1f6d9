"""Figures that notebooks show, panels, colours and settings, and the marks of models in them."""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping
from typing import Any, Literal

import numpy as np
import xarray as xr
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from modefront._typing import Bools, Floats, Ints
from modefront.front.point import REFERENCES, WEIGHTED, Kind, front_points, preferred
from modefront.text import NAME, clean

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00")
"""Told apart by the colour-blind (Okabe and Ito)."""

PANEL, COLUMNS = (2.6, 2.1), 3
"""Width and height of a panel in inches; panels side by side."""

STYLE: Mapping[Any, Any] = {
    "font.size": 8.5,
    "figure.titlesize": 9.0,
    "axes.titlesize": 8.5,
    "axes.labelsize": 8.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "0.9",
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "legend.frameon": False,
    "svg.hashsalt": "modefront",
    "svg.fonttype": "path",
}

Place = Literal[
    "outside lower left", "outside lower center", "outside upper left", "outside upper center"
]
"""Places of legends."""


class Picture(Figure):
    """A figure of matplotlib that a notebook shows as a vector graphic."""

    def _repr_svg_(self) -> str:
        stream = io.StringIO()
        with rc_context(dict(STYLE)):
            self.savefig(stream, format="svg", metadata={"Date": None})
        return stream.getvalue()


def picture(width: float, height: float) -> Picture:
    """Return an empty figure; width and height are in inches."""
    return Picture(figsize=(width, height), layout="constrained")


def single(width: float, height: float) -> tuple[Picture, Axes]:
    """Return a figure with one pair of axes."""
    figure = picture(width, height)
    return figure, figure.add_subplot()


def panels(count: int, columns: int = COLUMNS) -> tuple[Picture, list[Axes]]:
    """Return a figure with so many axes."""
    columns = max(min(columns, count), 1)
    rows = max(-(-count // columns), 1)
    figure = picture(max(PANEL[0] * columns, 4.4), PANEL[1] * rows + 0.5)
    grid = list(figure.subplots(rows, columns, squeeze=False).ravel())
    for axes in grid[count:]:
        axes.remove()
    return figure, grid[:count]


def titled(axes: Axes, title: object) -> None:
    """Put a title above a panel."""
    axes.set_title(plain(title), loc="left")


def legend(figure: Figure, axes: Axes, loc: Place, most: int) -> None:
    """Put the legend of axes beside them, in ``most`` columns or as many as the figure has room."""
    handles, labels = axes.get_legend_handles_labels()
    for columns in range(most, 0, -1):
        shown = figure.legend(handles, labels, loc=loc, ncols=columns)
        if columns == 1 or shown.get_window_extent().width <= figure.bbox.width:
            return
        shown.remove()


def plain(text: object) -> str:
    """Return a text that is not taken for mathematics."""
    return short(text, NAME)


def names_of(data: xr.Dataset, dimension: str, most: int = NAME) -> list[str]:
    """Return the names along a dimension or variable, as they are shown."""
    return [short(name, most) for name in data[dimension].values]


def short(text: object, most: int = 18) -> str:
    """Return a text that fits beside a tick."""
    return clean(text, most).replace("$", r"\$")


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
    nominal = kind == Kind.NOMINAL.value
    rows: tuple[tuple[str, Bools, str, float, dict[str, Any]], ...] = (
        ("dominated", front & ~pareto, "o", 4.5, {"mfc": "w", "mec": blue}),
        ("Pareto optimal", front & pareto, "o", 4.5, {"color": blue}),
        ("edge", kind == Kind.EDGE.value, "s", 8, {"mfc": "none", "mec": "k", "mew": 1.0}),
        ("weights", weighted, "D", 6, {"color": yellow, "mec": "k", "mew": 0.6}),
        ("nominal", nominal, "X", 7, {"color": "0.4"}),
        (best.replace("-", " "), reference, "*", 12, {"color": red, "mec": "k", "mew": 0.6}),
    )
    for name, chosen, marker, size, marks in rows:
        if chosen.any() and name not in without:
            axes.plot(*values[chosen].T, marker, ls="", ms=size, label=name, **marks)


def shown(data: xr.Dataset) -> Bools:
    """Return which points are Pareto optimal; all that are reported where none is."""
    pareto = np.asarray(data["pareto"].values, dtype=np.bool_)
    return pareto if pareto.any() else np.ones(len(pareto), dtype=np.bool_)


def is_path(data: xr.Dataset) -> bool:
    """Return whether neighbours on the front follow each other: it has two objectives."""
    return data.sizes["group"] == 2 and front_points(data).size > 1


def branches(data: xr.Dataset) -> Iterator[Ints]:
    """Yield the Pareto-optimal points of each branch of a front of two objectives, in order."""
    front = front_points(data)
    front = front[data["pareto"].values[front].astype(bool)]
    front = front[np.argsort(data["error"].values[front, 0], kind="stable")]
    number = data["piece"].values[front] if "piece" in data else np.ones(front.size)
    for each in np.unique(number):
        yield front[number == each]
