"""Figures that notebooks show, panels in them, and the colours and settings that all share."""

from __future__ import annotations

import io
import math
from collections.abc import Mapping
from typing import Any, Literal

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from modefront.text import NAME, clean

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00")
"""Told apart by the colour-blind (Okabe and Ito)."""

MAP = "cividis"
"""Colours of values, told apart by the colour-blind too."""

PANEL = (2.6, 2.1)
"""Width and height of a panel in inches."""

COLUMNS = 3
"""Panels side by side."""

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


def panels(count: int, columns: int = COLUMNS) -> tuple[Picture, list[Axes]]:
    """Return a figure with so many axes."""
    columns = max(min(columns, count), 1)
    rows = max(math.ceil(count / columns), 1)
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


def short(text: object, most: int = 18) -> str:
    """Return a text that fits beside a tick."""
    return clean(text, most).replace("$", r"\$")
