"""Figures 2 to 7 of Christodoulou et al. (2008, doi:10.1016/j.cma.2008.04.010)."""

from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from modefront._typing import Floats
from modefront.datasets import Dataset
from modefront.errors import Fault, refuse
from modefront.front.point import front_points
from modefront.plots import canvas
from modefront.predictions.base import predictions_in

Studies = Sequence[tuple[str, Dataset]]  # results with a name each
Curves = list[tuple[int, Floats]]  # values (points,) of some studies, by their numbers
MARKERS = "os^Dv"  # marks of the studies, beside their colours

WEIGHTED = ("equal-weights", "P", 8), ("optimal-weights", "*", 12)
"""Kinds of weighted models with their marks and the sizes of these."""


def figures(studies: Studies) -> Iterator[tuple[str, canvas.Picture]]:
    """Yield name and figure of each that can be drawn.

    Figures 6 and 7 need predictions and are left out without them. Parameters go by their names in
    the first study. Raises InputError for results that are not those of two groups and as many
    parameters.
    """
    count = studies[0][1].sizes["parameter"]
    faults = []
    for name, data in studies:
        if data.sizes["group"] != 2 or not front_points(data).size:
            found = f"{data.sizes['group']} groups, {front_points(data).size} points"
            faults.append(Fault(name, "--figures", "a front of two groups", found))
        if data.sizes["parameter"] != count:
            expected = f"as many parameters as in the first study, {count}"
            faults.append(Fault(name, "--figures", expected, str(data.sizes["parameter"])))
    refuse(faults)
    yield "figure-2", _fronts(studies)
    yield "figure-3", _planes(studies)
    names = studies[0][1]["parameter"].values.tolist()
    curves = [
        [(k, x["theta"].values[:, j]) for k, (_, x) in enumerate(studies)] for j in range(count)
    ]
    yield "figure-4", _along(studies, names, curves)
    numbers = studies[0][1]["mode"].values

    def error(data: Dataset) -> Floats:
        return 100 * (data["frequency"].values / data["measured_frequency"].values - 1)

    curves = [
        [(k, of(x)[:, r]) for k, (_, x) in enumerate(studies) if r < x.sizes["mode"]]
        for of in (error, lambda data: data["mac"].values)
        for r in range(len(numbers))
    ]
    titles = [*(f"mode {number}" for number in numbers), *([""] * len(numbers))]
    figure = _along(studies, titles, curves, len(numbers))
    for axes in figure.axes[: len(numbers)]:
        axes.axhline(0, color="k", ls="--", lw=0.8)
    figure.axes[0].set_ylabel("error of the frequency, %")
    figure.axes[len(numbers)].set_ylabel("MAC")
    yield "figure-5", figure
    for number, dimension in ((6, "frf"), (7, "failure")):
        of_places: dict[str, Curves] = {}
        for k, (_, data) in enumerate(studies):
            for each in predictions_in(data):
                if each.kind.dimension != dimension:
                    continue
                variable = each.kind.ranged[0]
                for x in each.quantities:
                    if x.variable == variable:
                        is_drawn = (x.values > 0) | (not variable.logarithmic)
                        shown = np.where(is_drawn, x.values, np.nan)
                        of_places.setdefault(x.place, []).append((k, shown))
        if of_places:
            figure = _along(studies, list(of_places), list(of_places.values()))
            for axes in figure.axes:
                axes.set_yscale("log" if variable.logarithmic else "linear")
            figure.axes[0].set_ylabel(variable.key)
            yield f"figure-{number}", figure


def _fronts(studies: Studies) -> canvas.Picture:
    """Return figure 2: the fronts in the space of errors, with numbers at their points."""
    figure, axes = canvas.single(5.6, 4.2)
    for k, (name, data) in enumerate(studies):
        error = data["error"].values
        for branch in canvas.branches(data):
            axes.plot(*error[branch].T, "-", color=_colour(k), lw=0.8, alpha=0.6)
        _points(axes, data, error, k, name)
        for number, i in enumerate(front_points(data).tolist(), start=1):
            if number == 1 or number % 5 == 0:
                marks: dict[str, Any] = {"color": _colour(k), "textcoords": "offset points"}
                axes.annotate(str(number), error[i].tolist(), (4, 3), fontsize=6.5, **marks)
    first, second = canvas.names_of(studies[0][1], "group")
    axes.set(xlabel=f"error of {first}, $e_1$", ylabel=f"error of {second}, $e_2$")
    for kind, sign, size in WEIGHTED:
        marks = {"color": "0.7", "mec": "k", "mew": 0.6, "label": kind.replace("-", " ")}
        axes.plot([], [], sign, ms=size, ls="", **marks)
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
    studies: Studies, titles: Sequence[str], curves: Sequence[Curves], columns: int = canvas.COLUMNS
) -> canvas.Picture:
    """Return a figure with a panel for each title, of values along the front of some studies."""
    figure, grid = canvas.panels(len(titles), columns)
    for axes, title, chosen in zip(grid, titles, curves, strict=True):
        axes.set_title(canvas.short(title), loc="left")
        for k, values in chosen:
            name, data = studies[k]
            front, pareto = front_points(data), data["pareto"].values.astype(bool)
            x, y = np.full(values.shape, np.nan), np.where(pareto, values, np.nan)[front]
            x[front] = np.arange(1, front.size + 1)
            axes.plot(x[front], y, "-", color=_colour(k), lw=0.8, alpha=0.6)
            _front(axes, data, np.column_stack([x, values]), k, name, 3.5)
            axes.set_xticks([1, *range(5, front.size + 1, 5)])
    for axes in grid[-columns:]:
        axes.set_xlabel("point of the front")
    canvas.legend(figure, grid[0], "outside lower center", min(len(studies) + 2, 4))
    return figure


def _colour(k: int) -> str:
    return canvas.COLOURS[k % len(canvas.COLOURS)]


def _points(axes: Axes, data: Dataset, values: Floats, k: int, name: str) -> None:
    """Draw pairs of values (points, 2) of the front, and larger those of weighted models."""
    _front(axes, data, values, k, name, 4)
    for kind, sign, size in WEIGHTED:
        chosen = values[data["kind"].values == kind]
        axes.plot(*chosen.T, sign, color=_colour(k), mec="k", mew=0.6, ms=size, ls="")


# 6 arguments: the values, and how they are marked.
def _front(axes: Axes, data: Dataset, values: Floats, k: int, name: str, size: float) -> None:
    """Draw pairs of values (points, 2) of the front, hollow where dominated."""
    front, pareto = front_points(data), data["pareto"].values.astype(bool)
    marker, colour = MARKERS[k % len(MARKERS)], _colour(k)
    best, others = values[front[pareto[front]]], values[front[~pareto[front]]]
    axes.plot(*best.T, marker, color=colour, ms=size, ls="", label=canvas.short(name))
    axes.plot(*others.T, marker, mfc="w", mec=colour, ms=size, ls="")
