"""Figures that notebooks show, panels, colours and settings, and the marks of models in them.

Values along a front have a panel a quantity, as figures 5 to 7 of Christodoulou et al. (2008,
doi:10.1016/j.cma.2008.04.010); neighbours on a front of two objectives are joined.
"""

import io
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from modefront._typing import Bools, Floats, Ints
from modefront.datasets import Dataset
from modefront.front.point import INTERNAL, WEIGHTED, Kind, front_points, position
from modefront.plots import drawing
from modefront.text import NAME, clean

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00")
"""Told apart by the colour-blind (Okabe and Ito)."""

PANEL, COLUMNS = (2.6, 2.1), 3  # width and height of a panel in inches; panels side by side
LEGIBLE = 12  # rows of a matrix up to which its numbers are written


class Picture(Figure):
    """A figure of matplotlib that a notebook shows as a vector graphic."""

    def _repr_svg_(self) -> str:
        stream = io.StringIO()
        with drawing():
            self.savefig(stream, format="svg", metadata={"Date": None})
        return stream.getvalue()


def picture(width: float, height: float) -> Picture:
    """Return an empty figure; width and height are in inches."""
    return Picture(figsize=(width, height), layout="constrained")


def colour_of(k: int) -> str:
    """Return the colour of what has a number; colours recur."""
    return COLOURS[k % len(COLOURS)]


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


def legend(figure: Figure, axes: Axes, loc: Any, most: int) -> None:
    """Put the legend of axes beside them, in ``most`` columns or as many as the figure has room.

    ``loc`` is what `Figure.legend` takes, such as "outside lower left".
    """
    handles, labels = axes.get_legend_handles_labels()
    for columns in range(most, 0, -1):
        shown = figure.legend(handles, labels, loc=loc, ncols=columns)
        if columns == 1 or shown.get_window_extent().width <= figure.bbox.width:
            return
        shown.remove()


def names_of(data: Dataset, dimension: str, most: int = NAME) -> list[str]:
    """Return the names along a dimension or variable, as they are shown."""
    return [short(name, most) for name in data[dimension].values]


def short(text: object, most: int = NAME) -> str:
    """Return a text of limited length that is not taken for mathematics."""
    return clean(text, most).replace("$", r"\$")


def draw_matrix(axes: Axes, values: Floats, names: Sequence[str], least: float, hues: str) -> Any:
    """Draw numbers from ``least`` to 1 with names on both sides, and return their picture."""
    axes.grid(False)
    axes.set_xticks(range(len(names)), names, rotation=90)
    axes.set_yticks(range(len(names)), names)
    for (i, j), value in np.ndenumerate(values) if len(names) <= LEGIBLE else ():
        shade = "w" if abs(value) > 0.6 else "k"  # legible on the dark ends of the scale
        axes.text(j, i, f"{value:.2f}", ha="center", va="center", fontsize=6.5, color=shade)
    return axes.imshow(values, vmin=least, vmax=1, cmap=hues)


def draw_models(axes: Axes, data: Dataset, values: Floats, *without: str) -> None:
    """Draw values (points, 2) of all models but those of some kinds, with the marks of their kinds.

    What matters most is drawn last.
    """
    kind, pareto, best = data["kind"].values, data["pareto"].values, position(data)
    reference, front = np.arange(kind.size) == best, kind == Kind.FRONT.value
    weighted = np.isin(kind, [each.value for each in WEIGHTED]) & ~reference
    blue, red, *_, yellow = COLOURS
    rows: tuple[tuple[str, Bools, str, float, dict[str, Any]], ...] = (
        ("dominated", front & ~pareto, "o", 4.5, {"mfc": "w", "mec": blue}),
        ("Pareto optimal", front & pareto, "o", 4.5, {"color": blue}),
        ("edge", kind == Kind.EDGE.value, "s", 8, {"mfc": "none", "mec": "k", "mew": 1.0}),
        ("weights", weighted, "D", 6, {"color": yellow, "mec": "k", "mew": 0.6}),
        ("nominal", kind == Kind.NOMINAL.value, "X", 7, {"color": "0.4"}),
        (str(kind[best]), reference, "*", 12, {"color": red, "mec": "k", "mew": 0.6}),
    )
    for name, chosen, marker, size, marks in rows:
        if chosen.any() and name not in without:
            label = name.replace("-", " ")
            axes.plot(*values[chosen].T, marker, ls="", ms=size, label=label, **marks)


def shown(data: Dataset) -> Bools:
    """Return which points are Pareto optimal; all that are reported where none is."""
    pareto: Bools = data["pareto"].values
    return pareto if pareto.any() else ~pareto


def is_path(data: Dataset) -> bool:
    """Return whether neighbours on the front follow each other: it has two objectives."""
    return data.sizes["group"] == 2 and front_points(data).size > 1


def branches(data: Dataset) -> Iterator[Ints]:
    """Yield the Pareto-optimal points of each branch of a front of two objectives, in order."""
    front = front_points(data)
    front = front[data["pareto"].values[front]]
    front = front[np.argsort(data["error"].values[front, 0], kind="stable")]
    number = data["piece"].values[front] if "piece" in data else np.ones(front.size)
    for each in np.unique(number):
        yield front[number == each]


class Along:
    """The abscissa: front points by number, then the other models."""

    def __init__(self, data: Dataset) -> None:
        self.data, self.front, kinds = data, front_points(data), data["kind"].values
        edge = Kind.EDGE.value if self.front.size else ""
        self.others = np.flatnonzero(~np.isin(kinds, [Kind.FRONT.value, edge, *INTERNAL]))
        self.is_best: Bools = data["pareto"].values[self.front]
        step = max(1.6, 0.08 * self.front.size)
        self.x = np.full(len(kinds), np.nan)
        self.x[self.front] = np.arange(1, self.front.size + 1)
        self.x[self.others] = self.front.size + step * (1 + np.arange(self.others.size))

    def draw(self, axes: Axes, values: Floats, colour: str = COLOURS[0], label: str = "") -> None:
        """Draw values (points,): full where Pareto optimal, hollow where not."""
        x, y, best, at = self.x[self.front], values[self.front], self.is_best, self.others
        if is_path(self.data):
            axes.plot(x, np.where(best, y, np.nan), "-", color=colour, lw=1, alpha=0.6)
        axes.plot(x[best], y[best], "o", color=colour, ms=4, label=label or "model")
        axes.plot(x[~best], y[~best], "o", mfc="w", mec=colour, ms=4)
        axes.plot(self.x[at], values[at], "D", color=colour, mec="k", mew=0.6, ms=5)
        others = np.concatenate([y[best], values[at]])
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
        step = -(-n // 20) * 5 if n > 6 else 1
        marked = sorted({1, *range(step, n + 1, step)}) if n else []
        others = self.data["label"].values[self.others]
        names = [short(str(name).removesuffix("-weights"), 18) for name in others]
        for i, axes in enumerate(grid):
            axes.set_xticks([*marked, *self.x[self.others]], [*map(str, marked), *names])
            for tick in axes.get_xticklabels()[len(marked) :]:
                tick.set(rotation=60, ha="right", rotation_mode="anchor")
            axes.grid(axis="x", visible=False)
            axes.set_xlim(0.2, np.nanmax(self.x) + 0.8)
            # Small numbers with a power of ten beside the axis, and none as a difference.
            if axes.get_yscale() == "linear":
                axes.ticklabel_format(axis="y", style="sci", scilimits=(-3, 4), useOffset=False)
            if n and i + columns >= len(grid):
                below = (0, -20), "axes fraction", "offset points"
                axes.annotate("point of the front", (0, 0), *below, va="top")
        handles, labels = grid[0].get_legend_handles_labels()
        if not self.is_best.all():
            hollow = Line2D([], [], ls="", marker="o", mfc="w", mec="0.3", ms=4)
            handles, labels = [*handles, hollow], [*labels, "dominated"]
        if len(labels) > 1:
            figure.legend(handles, labels, loc="outside lower center", ncols=min(4, len(labels)))


Bars = tuple[Floats, Floats]
"""Lower and upper ends (points, quantities), NaN where there is none."""


# 6 arguments: the values with their names, and what is drawn besides.
def panels_along(
    data: Dataset,
    values: Floats,
    names: Sequence[str],
    bars: Bars,
    label: str = "",
    mark: Callable[[Axes, int], object] = lambda *_: None,
) -> Picture:
    """Return a figure with a panel for each quantity of ``values`` (points, quantities).

    ``mark`` adds to the panel of a quantity.
    """
    along = Along(data)
    figure, grid = panels(len(names))
    for k, (axes, name) in enumerate(zip(grid, names, strict=True)):
        along.draw(axes, values[:, k])
        along.bars(axes, bars[0][:, k], bars[1][:, k])
        mark(axes, k)
        axes.set_title(short(name), loc="left")
        if k % COLUMNS == 0:
            axes.set_ylabel(label)
    along.finish(figure, grid, min(COLUMNS, len(grid)))
    return figure


def at_reference(data: Dataset, values: Floats, std: Any) -> Bars:
    """Return one standard deviation (quantities,) to either side of the reference alone.

    NaN stands for one that is not known.
    """
    out = np.full(values.shape, np.nan)
    out[position(data)] = std
    return values - out, values + out
