"""Predictions of every kind: their ranges beside each other, and each of them at all models."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from modefront.front.point import position
from modefront.plots.canvas import (
    COLOURS,
    Along,
    Picture,
    at_reference,
    panels_along,
    plain,
    short,
    shown,
    single,
)
from modefront.predictions.base import RecordedPrediction, predictions_in


def predictions(data: xr.Dataset) -> Picture:
    """Return the range of each prediction over the Pareto-optimal models, over the reference.

    Ticks are the posterior's standard deviation to either side; the cross is the nominal model.
    """
    best, chosen = position(data), shown(data)
    nominal = np.flatnonzero(data["kind"].values == "nominal")
    rows = [
        (each.name, x)
        for each in predictions_in(data)
        for variable in each.kind.ranged
        for x in each.quantities
        if x.variable == variable
    ]
    figure, axes = single(6.4, 1.0 + 0.24 * max(len(rows), 1))
    labels, widely = [], False
    for y, (name, of) in enumerate(rows):
        value, known = of.values[best], of.values[chosen & np.isfinite(of.values)]
        positive = known[known > 0]
        widely |= bool(positive.size and positive.max() > 10 * positive.min())
        labels.append(f"{short(f'{name}, {of.place}: {of.variable.key}', 40)} ({value:.3g})")
        if not known.size or not value or np.isnan(value):
            continue
        std = np.nan if of.std is None else of.std
        std = np.exp(std) if of.variable.logarithmic else 1 + abs(std / value)
        ends = np.array([known.min(), known.max()])
        axes.plot(ends / value, [y, y], color=COLOURS[0], lw=5, alpha=0.5)
        axes.plot(known / value, [y] * known.size, "|", color=COLOURS[0], ms=5)
        axes.plot([1 / std, std], [y, y], "-|", color=COLOURS[1], lw=1.2, ms=8)
        axes.plot(1, y, "*", color=COLOURS[1], mec="k", mew=0.5, ms=9)
        axes.plot(of.values[nominal] / value, [y] * nominal.size, "X", color="0.4", ms=6)
    axes.set_yticks(range(len(rows)), labels)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    if widely:
        axes.set_xscale("log")
    label = plain(data["label"].values[best])
    axes.set_xlabel(f"over that of {label} (its value in brackets)")
    axes.plot([], [], color=COLOURS[0], lw=5, alpha=0.5, label="Pareto-optimal models")
    axes.plot([], [], "-*", color=COLOURS[1], mec="k", mew=0.5, ms=9, label=f"{label}, ± 1 std")
    if nominal.size:
        axes.plot([], [], "X", color="0.4", ls="", label="nominal")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower left", ncols=3)
    return figure


def figures(data: xr.Dataset) -> Iterator[tuple[str, Picture]]:
    """Yield a name and a picture of each prediction at all models."""
    for each in predictions_in(data):
        yield f"{each.kind.dimension} {each.name}", _page(data, each)


def _page(data: xr.Dataset, of: RecordedPrediction) -> Picture:
    """Return one prediction at all models: of its variables the first one with a range, if any.

    Probabilities are lines of one panel, one a level.
    """
    variable = (*of.kind.ranged, *of.kind.variables)[0]
    quantities = [x for x in of.quantities if x.variable == variable]
    values = np.column_stack([x.values for x in quantities])
    std = [x.std for x in quantities if x.std is not None]
    places = [x.place for x in quantities]
    if variable.logarithmic:
        values = np.where(values > 0, values, np.nan)
        figure, axes = single(4.8, 3.3)
        axes.set(yscale="log", ylabel=variable.title)
        along = Along(data)
        bars = at_reference(data, np.log(values), std)
        for k, place in enumerate(places):
            colour = COLOURS[k % len(COLOURS)]
            along.draw(axes, values[:, k], colour, short(place))
            if bars is not None:
                along.bars(axes, np.exp(bars[0][:, k]), np.exp(bars[1][:, k]), colour)
        along.finish(figure, [axes], 1)
    else:
        bars = at_reference(data, values, std)
        figure = panels_along(data, values, places, variable.title, bars)
    figure.suptitle(plain(of.name + f" ({of.load})" * bool(of.load)), x=0.01, ha="left")
    return figure
