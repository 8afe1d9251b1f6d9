"""Figures 2 to 7 of the paper, for the studies of the three-story building.

The order and the layout are those of Christodoulou, Ntotsios, Papadimitriou & Panetsos (2008,
doi:10.1016/j.cma.2008.04.010) as far as its text describes them; each study has a colour and a mark
of its own:

======  ============================================================================
figure  what it shows
======  ============================================================================
2       fronts in the space of errors, with the edges, equal and optimal weights
3       Pareto-optimal parameters in the planes of each two of them
4       parameters along the front
5       errors of the frequencies and MAC along the front
6       peaks of the frequency response along the front
7       probabilities of failure along the front
======  ============================================================================
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from modefront._typing import Floats
from modefront.errors import Fault, refuse
from modefront.plots.canvas import COLOURS, COLUMNS, Picture, legend, panels, picture, plain, titled
from modefront.plots.models import branches, front_of
from modefront.predictions.registry import predictions_in

Studies = Sequence[tuple[str, xr.Dataset]]
"""Results with a name each."""

MARKERS = "os^Dv"
"""Marks of the studies, beside their colours."""

EQUAL, OPTIMAL = "P", "*"
"""Marks of the models with equal and with optimal weights."""


def figures(studies: Studies) -> Iterator[tuple[str, Picture]]:
    """Yield name and figure of each that can be drawn.

    Figures 6 and 7 need predictions and are left out without them. Parameters go by their names in
    the first study. Raises InputError for results that are not those of two groups and as many
    parameters.
    """
    count = studies[0][1].sizes["parameter"]
    faults = []
    for name, data in studies:
        if data.sizes["group"] != 2 or not front_of(data).size:
            found = f"{data.sizes['group']} groups, {front_of(data).size} points"
            faults.append(Fault(name, "--figures", "a front of two groups", found))
        if data.sizes["parameter"] != count:
            expected = f"as many parameters as in the first study, {count}"
            faults.append(Fault(name, "--figures", expected, str(data.sizes["parameter"])))
    refuse(faults)
    yield "figure-2", fronts(studies)
    yield "figure-3", planes(studies)
    yield "figure-4", parameters(studies)
    yield "figure-5", modes(studies)
    for number, dimension in ((6, "frf"), (7, "failure")):
        if figure := predictions(studies, dimension):
            yield f"figure-{number}", figure


def fronts(studies: Studies) -> Picture:
    """Return figure 2: the fronts in the space of errors, with numbers at their points."""
    figure = picture(5.6, 4.2)
    axes = figure.add_subplot()
    for k, (name, data) in enumerate(studies):
        error = data["error"].values
        for branch in branches(data):
            axes.plot(*error[branch].T, "-", color=_colour(k), lw=0.8, alpha=0.6)
        _points(axes, data, error, k, name)
        for number, i in enumerate(front_of(data).tolist(), start=1):
            if number == 1 or number % 5 == 0:
                axes.annotate(
                    str(number),
                    (float(error[i, 0]), float(error[i, 1])),
                    xytext=(4, 3),
                    textcoords="offset points",
                    fontsize=6.5,
                    color=_colour(k),
                )
    first, second = (plain(group) for group in studies[0][1]["group"].values)
    axes.set(xlabel=f"error of {first}, $e_1$", ylabel=f"error of {second}, $e_2$")
    for sign, size, name in ((EQUAL, 8, "equal weights"), (OPTIMAL, 12, "optimal weights")):
        axes.plot([], [], sign, color="0.7", mec="k", mew=0.6, ms=size, ls="", label=name)
    legend(figure, axes, "outside lower center", min(len(studies) + 2, 4))
    return figure


def planes(studies: Studies) -> Picture:
    """Return figure 3: the models in the planes of each two parameters."""
    names = [plain(name) for name in studies[0][1]["parameter"].values]
    pairs = list(combinations(range(len(names)), 2)) or [(0, 0)]
    figure, grid = panels(len(pairs))
    for axes, (i, j) in zip(grid, pairs, strict=True):
        for k, (name, data) in enumerate(studies):
            _points(axes, data, data["theta"].values[:, [i, j]], k, name)
        axes.set(xlabel=names[i], ylabel=names[j])
    legend(figure, grid[0], "outside lower center", min(len(studies) + 2, 4))
    return figure


def parameters(studies: Studies) -> Picture:
    """Return figure 4: the parameters along the front, a panel each."""
    names = [plain(name) for name in studies[0][1]["parameter"].values]
    figure, grid = _grid(len(names))
    for j, (axes, name) in enumerate(zip(grid, names, strict=True)):
        for k, (study, data) in enumerate(studies):
            _along(axes, data, data["theta"].values[:, j], k, study)
        titled(axes, name)
    legend(figure, grid[0], "outside lower center", min(len(studies) + 2, 4))
    return figure


def modes(studies: Studies) -> Picture:
    """Return figure 5: errors of the frequencies above, MAC below, a column a mode."""
    numbers = studies[0][1]["mode"].values
    figure = picture(2.5 * len(numbers) + 0.6, 4.6)
    grid = figure.subplots(2, len(numbers), squeeze=False, sharex=True)
    for r, number in enumerate(numbers):
        for k, (name, data) in enumerate(studies):
            if r >= data.sizes["mode"]:
                continue
            error = 100 * (data["frequency"].values / data["measured_frequency"].values - 1)
            _along(grid[0][r], data, error[:, r], k, name)
            _along(grid[1][r], data, data["mac"].values[:, r], k, name)
        grid[0][r].axhline(0, color="k", ls="--", lw=0.8)
        titled(grid[0][r], f"mode {number}")
        grid[1][r].set_xlabel("point of the front")
    grid[0][0].set_ylabel("error of the frequency, %")
    grid[1][0].set_ylabel("MAC")
    legend(figure, grid[0][0], "outside lower center", min(len(studies) + 2, 4))
    return figure


def predictions(studies: Studies, dimension: str) -> Picture | None:
    """Return figure 6 or 7: predictions of one kind along the front; None without any."""
    rows = []
    for k, (study, data) in enumerate(studies):
        for each in predictions_in(data):
            if each.kind.dimension == dimension:
                rows += [(k, study, data, each.kind.ranged[0], i) for i in each.positions]
    places = list(dict.fromkeys(str(data[dimension].values[i]) for _, _, data, _, i in rows))
    if not places:
        return None
    figure, grid = _grid(len(places))
    for k, study, data, variable, i in rows:
        axes = grid[places.index(str(data[dimension].values[i]))]
        values = data[variable.name].values[:, i]
        if variable.logarithmic:
            values = np.where(values > 0, values, np.nan)
            axes.set_yscale("log")
        _along(axes, data, values, k, study)
        titled(axes, data[dimension].values[i])
    grid[0].set_ylabel(rows[0][3].key)
    legend(figure, grid[0], "outside lower center", min(len(studies) + 2, 4))
    return figure


def _grid(count: int) -> tuple[Picture, list[Axes]]:
    """Return a figure with so many panels along the front."""
    figure, grid = panels(count)
    for axes in grid[-COLUMNS:]:
        axes.set_xlabel("point of the front")
    return figure, grid


def _colour(k: int) -> str:
    return COLOURS[k % len(COLOURS)]


def _points(axes: Axes, data: xr.Dataset, values: Floats, k: int, name: str) -> None:
    """Draw pairs of values (points, 2): hollow where dominated, the weighted models larger."""
    front, pareto = front_of(data), data["pareto"].values.astype(bool)
    marker, colour = MARKERS[k % len(MARKERS)], _colour(k)
    best, others = front[pareto[front]], front[~pareto[front]]
    axes.plot(*values[best].T, marker, color=colour, ms=4, ls="", label=plain(name))
    axes.plot(*values[others].T, marker, mfc="w", mec=colour, ms=4, ls="")
    for kind, sign, size in (("equal-weights", EQUAL, 8), ("optimal-weights", OPTIMAL, 12)):
        chosen = data["kind"].values == kind
        axes.plot(*values[chosen].T, sign, color=colour, mec="k", mew=0.6, ms=size, ls="")


def _along(axes: Axes, data: xr.Dataset, values: Floats, k: int, name: str) -> None:
    """Draw values (points,) along the front, hollow where dominated."""
    front, pareto = front_of(data), data["pareto"].values.astype(bool)
    x, y, best = np.arange(1, front.size + 1), values[front], pareto[front]
    marker, colour = MARKERS[k % len(MARKERS)], _colour(k)
    axes.plot(x, np.where(best, y, np.nan), "-", color=colour, lw=0.8, alpha=0.6)
    axes.plot(x[best], y[best], marker, color=colour, ms=3.5, ls="", label=plain(name))
    axes.plot(x[~best], y[~best], marker, mfc="w", mec=colour, ms=3.5, ls="")
    axes.set_xticks([1, *range(5, front.size + 1, 5)])
