"""Figures that notebooks show, and panels in them."""

from __future__ import annotations

import io
import math
from typing import Literal

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from modefront.plots.style import COLUMNS, PANEL, STYLE

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


def legend(figure: Figure, axes: Axes, loc: Place, most: int) -> None:
    """Put the legend of axes beside them, in ``most`` columns or as many as the figure has room."""
    handles, labels = axes.get_legend_handles_labels()
    for columns in range(most, 0, -1):
        shown = figure.legend(handles, labels, loc=loc, ncols=columns)
        if columns == 1 or shown.get_window_extent().width <= figure.bbox.width:
            return
        shown.remove()


def panels(count: int, columns: int = COLUMNS) -> tuple[Picture, list[Axes]]:
    """Return a figure with so many axes."""
    columns = max(min(columns, count), 1)
    rows = max(math.ceil(count / columns), 1)
    figure = picture(max(PANEL[0] * columns, 4.4), PANEL[1] * rows + 0.5)
    grid = list(figure.subplots(rows, columns, squeeze=False).ravel())
    for axes in grid[count:]:
        axes.remove()
    return figure, grid[:count]
