"""Values along a front, a panel a quantity, as figures 5 to 7 of Christodoulou et al. (2008,
doi:10.1016/j.cma.2008.04.010); neighbours on a front of two objectives are joined.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from modefront._typing import Floats
from modefront.front.point import INTERNAL, Kind, front_points, position
from modefront.plots.canvas import (
    COLOURS,
    COLUMNS,
    Picture,
    is_path,
    panels,
    short,
    titled,
)


class Along:
    """The abscissa: front points by number, then the other models."""

    def __init__(self, data: xr.Dataset) -> None:
        self.data = data
        kinds = data["kind"].values
        self.front = front_points(data)
        edge = Kind.EDGE.value if self.front.size else ""
        self.others = np.flatnonzero(~np.isin(kinds, [Kind.FRONT.value, edge, *INTERNAL]))
        self.best = position(data)
        self.pareto = np.asarray(data["pareto"].values, dtype=np.bool_)
        step = max(1.6, 0.08 * self.front.size)
        self.beside = self.front.size + step * (1 + np.arange(self.others.size))
        self.x = np.full(len(kinds), np.nan)
        self.x[self.front] = np.arange(1, self.front.size + 1)
        self.x[self.others] = self.beside

    def draw(self, axes: Axes, values: Floats, colour: str = COLOURS[0], label: str = "") -> None:
        """Draw values (points,): full where Pareto optimal, hollow where not."""
        x, y = self.x[self.front], values[self.front]
        best = self.pareto[self.front]
        if is_path(self.data):
            axes.plot(x, np.where(best, y, np.nan), "-", color=colour, lw=1, alpha=0.6)
        axes.plot(x[best], y[best], "o", color=colour, ms=4, label=label or "model")
        axes.plot(x[~best], y[~best], "o", mfc="w", mec=colour, ms=4)
        axes.plot(self.beside, values[self.others], "D", color=colour, mec="k", mew=0.6, ms=5)
        others = np.concatenate([y[best], values[self.others]])
        others = others[np.isfinite(others)]
        if not others.size or axes.get_yscale() != "linear":
            return
        # Dominated models that are far from all others are left out.
        low, high = others.min(), others.max()
        far = (y[~best] < 2 * low - high) | (y[~best] > 2 * high - low)
        if high > low and far.any():
            axes.set_ylim(1.15 * low - 0.15 * high, 1.15 * high - 0.15 * low)

    def bars(self, axes: Axes, lower: Floats, upper: Floats, colour: str = COLOURS[0]) -> None:
        """Draw ranges (points,) at the points that have one: others are NaN."""
        known = np.isfinite(lower) & np.isfinite(upper) & np.isfinite(self.x)
        for i in np.flatnonzero(known).tolist():
            axes.plot([self.x[i]] * 2, [lower[i], upper[i]], "-_", color=colour, lw=1.2, ms=6)

    def finish(self, figure: Picture, grid: Sequence[Axes], columns: int) -> None:
        """Put ticks and labels on the abscissae, and one legend below the panels."""
        n = self.front.size
        step = max(1, -(-n // 20) * 5) if n > 6 else 1
        marked = sorted({1, *range(step, n + 1, step)} - {0}) if n else []
        others = self.data["label"].values[self.others]
        names = [short(str(name).removesuffix("-weights")) for name in others]
        for i, axes in enumerate(grid):
            axes.set_xticks([*marked, *self.beside], [*map(str, marked), *names])
            for tick in axes.get_xticklabels()[len(marked) :]:
                tick.set(rotation=60, ha="right", rotation_mode="anchor")
            axes.grid(axis="x", visible=False)
            axes.set_xlim(0.2, (self.beside[-1] if self.beside.size else n) + 0.8)
            # Small numbers with a power of ten beside the axis, and none as a difference.
            if axes.get_yscale() == "linear":
                axes.ticklabel_format(axis="y", style="sci", scilimits=(-3, 4), useOffset=False)
            if n and i + columns >= len(grid):
                offset: dict[str, Any] = {
                    "xytext": (0, -20),
                    "textcoords": "offset points",
                    "va": "top",
                }
                axes.annotate("point of the front", (0, 0), xycoords="axes fraction", **offset)
        handles, labels = grid[0].get_legend_handles_labels()
        if not self.pareto[self.front].all():
            hollow = Line2D([], [], ls="", marker="o", mfc="w", mec="0.3", ms=4)
            handles, labels = [*handles, hollow], [*labels, "dominated"]
        if len(labels) > 1:
            figure.legend(handles, labels, loc="outside lower center", ncols=min(4, len(labels)))


Bars = tuple[Floats, Floats] | None
"""Lower and upper ends (points, quantities), NaN where there is none."""


# 6 arguments: the values with their names, and what is drawn besides.
def panels_along(
    data: xr.Dataset,
    values: Floats,
    names: Sequence[str],
    label: str = "",
    bars: Bars = None,
    mark: Callable[[Axes, int], object] = lambda *_: None,
) -> Picture:
    """Return a figure with a panel for each quantity of ``values`` (points, quantities).

    ``mark`` adds to the panel of a quantity.
    """
    along = Along(data)
    figure, grid = panels(len(names))
    for k, (axes, name) in enumerate(zip(grid, names, strict=True)):
        along.draw(axes, values[:, k])
        if bars is not None:
            along.bars(axes, bars[0][:, k], bars[1][:, k])
        mark(axes, k)
        titled(axes, name)
        if k % COLUMNS == 0:
            axes.set_ylabel(label)
    along.finish(figure, grid, min(COLUMNS, len(grid)))
    return figure


def at_reference(data: xr.Dataset, values: Floats, std: Any) -> Bars:
    """Return one standard deviation (quantities,) to either side of the reference alone, if any."""
    if not len(std):
        return None
    out = np.full(values.shape, np.nan)
    out[position(data)] = std
    return values - out, values + out
