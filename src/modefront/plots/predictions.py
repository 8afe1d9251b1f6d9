"""Predictions of every kind: their ranges beside each other, and each of them at all models."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from modefront._typing import Floats
from modefront.findings.selection import reference
from modefront.plots.along import Along, at_reference, panels_along
from modefront.plots.canvas import COLOURS, Picture, plain, short, shown, single
from modefront.predictions import PredictionKind, ResultVariable
from modefront.predictions.registry import RecordedPrediction, predictions_in


def predictions(data: xr.Dataset) -> Picture:
    """Return the range of each prediction over the Pareto-optimal models, over the reference.

    Ticks are the posterior's standard deviation to either side; the cross is the nominal model.
    """
    best, chosen = reference(data), shown(data)
    nominal = np.flatnonzero(data["kind"].values == "nominal")
    rows = []
    for each in predictions_in(data):
        for variable in each.kind.ranged:
            for i, place in zip(each.positions, each.places, strict=True):
                values = data[variable.name].values[:, i]
                label = f"{each.name}, {place}: {variable.key}"
                std = _relative_std(data, each.kind, variable, i, values[best])
                rows.append((label, values, std))
    figure, axes = single(6.4, 1.0 + 0.24 * max(len(rows), 1))
    for y, (_, values, std) in enumerate(rows):
        ratio = values / values[best] if values[best] else np.full(values.shape, np.nan)
        known = ratio[chosen & np.isfinite(ratio)]
        if not known.size:
            continue
        axes.plot([known.min(), known.max()], [y, y], color=COLOURS[0], lw=5, alpha=0.5)
        axes.plot(known, [y] * known.size, "|", color=COLOURS[0], ms=5)
        axes.plot([1 / std, std], [y, y], "-|", color=COLOURS[1], lw=1.2, ms=8)
        axes.plot(1, y, "*", color=COLOURS[1], mec="k", mew=0.5, ms=9)
        axes.plot(ratio[nominal], [y] * nominal.size, "X", color="0.4", ms=6)
    labels = [f"{short(name, 40)} ({values[best]:.3g})" for name, values, _ in rows]
    axes.set_yticks(range(len(rows)), labels)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    positive = [x[np.isfinite(x) & (x > 0)] for x in (values[chosen] for _, values, _ in rows)]
    if any(x.size and x.max() > 10 * x.min() for x in positive):
        axes.set_xscale("log")
    label = plain(data["label"].values[best])
    axes.set_xlabel(f"over that of {label} (its value in brackets)")
    axes.plot([], [], color=COLOURS[0], lw=5, alpha=0.5, label="Pareto-optimal models")
    axes.plot([], [], "-*", color=COLOURS[1], mec="k", mew=0.5, ms=9, label=f"{label}, ± 1 std")
    if nominal.size:
        axes.plot([], [], "X", color="0.4", ls="", label="nominal")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower left", ncols=3)
    return figure


def _relative_std(
    data: xr.Dataset, kind: PredictionKind, variable: ResultVariable, i: int, value: float
) -> float:
    """Return the factor of one standard deviation of the posterior; NaN for none."""
    if variable.logarithmic:
        std = data.get(f"posterior_{kind.dimension}_log_std")
        return float(np.exp(std.values[i])) if std is not None else np.nan
    std = data.get(f"posterior_{variable.name}_std")
    return 1 + abs(float(std.values[i] / value)) if std is not None and value else np.nan


def figures(data: xr.Dataset) -> Iterator[tuple[str, Picture]]:
    """Yield a name and a picture of each prediction at all models."""
    for each in predictions_in(data):
        yield f"{each.kind.dimension} {each.name}", _page(data, each)


def _page(data: xr.Dataset, of: RecordedPrediction) -> Picture:
    """Return one prediction at all models: of its variables the first one with a range, if any."""
    variable, positions = (*of.kind.ranged, *of.kind.variables)[0], list(of.positions)
    values, dimension = data[variable.name].values[:, positions], of.kind.dimension
    if variable.logarithmic:
        values = np.where(values > 0, values, np.nan)
    if variable.logarithmic:
        figure = _levels(data, of, variable, values)
    else:
        std = data.get(f"posterior_{variable.name}_std")
        bars = at_reference(data, values, None if std is None else std[positions])
        figure = panels_along(data, values, of.places, variable.title, bars)
    load = data.get(f"{dimension}_load")
    case = "" if load is None else f" ({load.values[positions[0]]})"
    figure.suptitle(plain(f"{of.name}{case}"), x=0.01, ha="left")
    return figure


def _levels(
    data: xr.Dataset, of: RecordedPrediction, variable: ResultVariable, values: Floats
) -> Picture:
    """Return a line a level of probabilities along the front."""
    figure, axes = single(4.8, 3.3)
    axes.set(yscale="log", ylabel=variable.title)
    along, std = Along(data), data.get(f"posterior_{of.kind.dimension}_log_std")
    logarithms = None if std is None else std[list(of.positions)]
    bars = at_reference(data, np.log(values), logarithms)
    for k, place in enumerate(of.places):
        colour = COLOURS[k % len(COLOURS)]
        along.draw(axes, values[:, k], colour, short(place))
        if bars is not None:
            along.bars(axes, np.exp(bars[0][:, k]), np.exp(bars[1][:, k]), colour)
    along.finish(figure, [axes], 1)
    return figure
