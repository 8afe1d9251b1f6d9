"""Figures that notebooks show, panels, colours and settings, and the marks of models in them.

Values along a front have a panel a quantity, as figures 5 to 7 of Christodoulou et al. (2008,
doi:10.1016/j.cma.2008.04.010); neighbours on a front of two objectives are joined.
"""

import io
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from modefront._typing import Bools, Floats, Ints
from modefront.datasets import Dataset
from modefront.front.point import (
    INTERNAL,
    REFERENCES,
    WEIGHTED,
    Kind,
    front_points,
    position,
    preferred,
)
from modefront.text import NAME, clean

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00")
"""Told apart by the colour-blind (Okabe and Ito)."""

PANEL, COLUMNS = (2.6, 2.1), 3  # width and height of a panel in inches; panels side by side
LEGIBLE = 12  # rows of a matrix up to which its numbers are written

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


def shown(data: Dataset) -> Bools:
    """Return which points are Pareto optimal; all that are reported where none is."""
    pareto = np.asarray(data["pareto"].values, dtype=np.bool_)
    return pareto if pareto.any() else np.ones(len(pareto), dtype=np.bool_)


def is_path(data: Dataset) -> bool:
    """Return whether neighbours on the front follow each other: it has two objectives."""
    return data.sizes["group"] == 2 and front_points(data).size > 1


def branches(data: Dataset) -> Iterator[Ints]:
    """Yield the Pareto-optimal points of each branch of a front of two objectives, in order."""
    front = front_points(data)
    front = front[data["pareto"].values[front].astype(bool)]
    front = front[np.argsort(data["error"].values[front, 0], kind="stable")]
    number = data["piece"].values[front] if "piece" in data else np.ones(front.size)
    for each in np.unique(number):
        yield front[number == each]


class Along:
    """The abscissa: front points by number, then the other models."""

    def __init__(self, data: Dataset) -> None:
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
        names = [short(str(name).removesuffix("-weights"), 18) for name in others]
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
    data: Dataset,
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
        axes.set_title(short(name), loc="left")
        if k % COLUMNS == 0:
            axes.set_ylabel(label)
    along.finish(figure, grid, min(COLUMNS, len(grid)))
    return figure


def at_reference(data: Dataset, values: Floats, std: Any) -> Bars:
    """Return one standard deviation (quantities,) to either side of the reference alone, if any."""
    if not len(std):
        return None
    out = np.full(values.shape, np.nan)
    out[position(data)] = std
    return values - out, values + out
