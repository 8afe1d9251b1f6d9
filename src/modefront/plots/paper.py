"""Figures 2 to 7 of Christodoulou et al. (2008, doi:10.1016/j.cma.2008.04.010)."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import combinations

import numpy as np
from matplotlib.axes import Axes

from modefront._typing import Floats
from modefront.datasets import Dataset
from modefront.errors import Fault, refuse
from modefront.front.point import front_points
from modefront.plots import canvas
from modefront.predictions.base import ResultVariable, kinds_in, predictions_in

Studies = Sequence[tuple[str, Dataset]]  # results with a name each
Curves = Iterable[tuple[str, Floats]]  # titles of panels, and values (points,) of a study
MARKERS = "os^Dv"  # marks of the studies, beside their colours

WEIGHTED = ("equal-weights", "P", 8), ("optimal-weights", "*", 12)
"""Kinds of weighted models with their marks and the sizes of these."""


def figures(studies: Studies) -> Iterator[tuple[str, canvas.Picture]]:
    """Yield name and figure of each that can be drawn.

    Figures 6 and 7 need predictions and are left out without them. Parameters go by their names in
    the first study. Raises InputError for results that are not those of two groups and as many
    parameters.
    """
    first = studies[0][1]
    names, modes = first["parameter"].values, first["mode"].values.tolist()
    faults = []
    for name, data in studies:
        if data.sizes["group"] != 2 or not front_points(data).size:
            found = f"{data.sizes['group']} groups, {front_points(data).size} points"
            faults.append(Fault(name, "--figures", "a front of two groups", found))
        if data.sizes["parameter"] != len(names):
            expected = f"as many parameters as in the first study, {len(names)}"
            faults.append(Fault(name, "--figures", expected, str(data.sizes["parameter"])))
    refuse(faults)
    yield "figure-2", _fronts(studies)
    yield "figure-3", _planes(studies)
    yield "figure-4", _along(studies, lambda data: zip(names, data["theta"].values.T, strict=True))

    def fits(data: Dataset) -> Curves:
        error = 100 * (data["frequency"].values / data["measured_frequency"].values - 1)
        for title, values in (("mode", error), ("MAC", data["mac"].values)):
            of = dict(zip(data["mode"].values.tolist(), values.T, strict=True))
            yield from ((f"{title} {r}", of[r]) for r in modes if r in of)

    figure = _along(studies, fits, len(modes))
    for above, below in zip(figure.axes[: len(modes)], figure.axes[len(modes) :], strict=True):
        above.axhline(0, color="k", ls="--", lw=0.8)
        below.set_title("", loc="left")
    figure.axes[0].set_ylabel("error of the frequency, %")
    figure.axes[len(modes)].set_ylabel("MAC")
    yield "figure-5", figure
    for number, dimension in ((6, "frf"), (7, "failure")):
        kinds = [x for _, data in studies for x in kinds_in(data) if x.dimension == dimension]
        if kinds:
            variable = kinds[0].ranged[0]
            scale = "log" if variable.logarithmic else "linear"
            figure = _along(studies, partial(_predicted, variable=variable), scale=scale)
            figure.axes[0].set_ylabel(variable.key)
            yield f"figure-{number}", figure


def _predicted(data: Dataset, variable: ResultVariable) -> Curves:
    """Yield places and values of a variable of predictions; NaN for no logarithm."""
    least = 0.0 if variable.logarithmic else -np.inf
    for x in (x for each in predictions_in(data) for x in each.quantities):
        if x.variable == variable:
            yield x.place, np.where(x.values > least, x.values, np.nan)


def _fronts(studies: Studies) -> canvas.Picture:
    """Return figure 2: the fronts in the space of errors, with numbers at their points."""
    figure, axes = canvas.single(5.6, 4.2)
    for k, (name, data) in enumerate(studies):
        error = data["error"].values
        for branch in canvas.branches(data):
            axes.plot(*error[branch].T, "-", color=canvas.colour_of(k), lw=0.8, alpha=0.6)
        _points(axes, data, error, k, name)
        for number, i in enumerate(front_points(data).tolist(), start=1):
            if number == 1 or number % 5 == 0:
                at = error[i].tolist(), (4, 3), "data", "offset points"
                axes.annotate(str(number), *at, fontsize=6.5, color=canvas.colour_of(k))
    first, second = canvas.names_of(studies[0][1], "group")
    axes.set(xlabel=f"error of {first}, $e_1$", ylabel=f"error of {second}, $e_2$")
    for kind, sign, size in WEIGHTED:
        label = kind.replace("-", " ")
        axes.plot([], [], sign, color="0.7", mec="k", mew=0.6, ms=size, ls="", label=label)
    canvas.legend(figure, axes, "outside lower center", min(len(studies) + 2, 4))
    return figure


def _planes(studies: Studies) -> canvas.Picture:
    """Return figure 3: the models in the planes of each two parameters."""
    names = canvas.names_of(studies[0][1], "parameter")
    pairs = list(combinations(range(len(names)), 2)) or [(0, 0)]
    figure, grid = canvas.panels(len(pairs))
    for axes, (i, j) in zip(grid, pairs, strict=True):
        for k, (name, data) in enumerate(studies):
            _points(axes, data, data["theta"].values[:, [i, j]], k, name)
        axes.set(xlabel=names[i], ylabel=names[j])
    canvas.legend(figure, grid[0], "outside lower center", min(len(studies) + 2, 4))
    return figure


def _along(
    studies: Studies,
    curves: Callable[[Dataset], Curves],
    columns: int = canvas.COLUMNS,
    scale: str = "linear",
) -> canvas.Picture:
    """Return a figure with a panel for each title, of values along the front of some studies."""
    known = [list(curves(data)) for _, data in studies]
    titles = dict.fromkeys(title for some in known for title, _ in some)
    figure, grid = canvas.panels(len(titles), columns)
    panels = dict(zip(titles, grid, strict=True))
    for axes in grid:
        axes.set_yscale(scale)  # before the legend is placed: axes that stay empty have limits then
    for k, (name, data) in enumerate(studies):
        front, pareto = front_points(data), data["pareto"].values
        x = np.full(pareto.size, np.nan)
        x[front] = np.arange(1, front.size + 1)
        for title, values in known[k]:
            axes, y = panels[title], np.where(pareto, values, np.nan)[front]
            axes.set_title(canvas.short(title), loc="left")
            axes.plot(x[front], y, "-", color=canvas.colour_of(k), lw=0.8, alpha=0.6)
            _front(axes, data, np.column_stack([x, values]), k, name, 3.5)
            axes.set_xticks([1, *range(5, front.size + 1, 5)])
    for axes in grid[-columns:]:
        axes.set_xlabel("point of the front")
    canvas.legend(figure, grid[0], "outside lower center", min(len(studies) + 2, 4))
    return figure


def _points(axes: Axes, data: Dataset, values: Floats, k: int, name: str) -> None:
    """Draw pairs of values (points, 2) of the front, and larger those of weighted models."""
    _front(axes, data, values, k, name, 4)
    for kind, sign, size in WEIGHTED:
        chosen = values[data["kind"].values == kind]
        axes.plot(*chosen.T, sign, color=canvas.colour_of(k), mec="k", mew=0.6, ms=size, ls="")


# 6 arguments: the values, and how they are marked.
def _front(axes: Axes, data: Dataset, values: Floats, k: int, name: str, size: float) -> None:
    """Draw pairs of values (points, 2) of the front, hollow where dominated."""
    front, pareto = front_points(data), data["pareto"].values
    marker, colour = MARKERS[k % len(MARKERS)], canvas.colour_of(k)
    best, others = values[front[pareto[front]]], values[front[~pareto[front]]]
    axes.plot(*best.T, marker, color=colour, ms=size, ls="", label=canvas.short(name))
    axes.plot(*others.T, marker, mfc="w", mec=colour, ms=size, ls="")
