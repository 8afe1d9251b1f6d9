"""Predictions of every kind: their ranges beside each other, and each of them at all models."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from modefront._typing import Floats
from modefront.plots.along import Along, key, parallel, titled
from modefront.plots.canvas import Picture, panels, picture
from modefront.plots.models import is_path, reference_of, shown
from modefront.plots.style import COLOURS, COLUMNS, plain, short
from modefront.predictions import PredictionKind, ResultVariable
from modefront.predictions.registry import RecordedPrediction, predictions_in

FEW = 12
"""Values of a prediction up to which each has a panel of its own along the front."""


def draw(data: xr.Dataset) -> Picture:
    """Return the range of each prediction over the Pareto-optimal models, over the reference.

    Ticks are the posterior's standard deviation to either side; the cross is the nominal model.
    """
    best, chosen = reference_of(data), shown(data)
    nominal = np.flatnonzero(data["kind"].values == "nominal")
    rows = []
    for each in predictions_in(data):
        for variable in each.kind.ranged:
            for i, place in zip(each.positions, each.places, strict=True):
                values = data[variable.name].values[:, i]
                label = f"{each.name}, {place}: {variable.key}"
                std = _relative_std(data, each.kind, variable, i, values[best])
                rows.append((label, values, std))
    figure = picture(6.4, 1.0 + 0.24 * max(len(rows), 1))
    axes = figure.add_subplot()
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
    if any(_wide(values[chosen]) for _, values, _ in rows):
        axes.set_xscale("log")
    label = plain(data["label"].values[best])
    axes.set_xlabel(f"over that of {label} (its value in brackets)")
    axes.plot([], [], color=COLOURS[0], lw=5, alpha=0.5, label="Pareto-optimal models")
    axes.plot([], [], "-*", color=COLOURS[1], mec="k", mew=0.5, ms=9, label=f"{label}, ± 1 std")
    if nominal.size:
        axes.plot([], [], "X", color="0.4", ls="", label="nominal")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower left", ncols=3)
    return figure


def _wide(values: Floats) -> bool:
    known = values[np.isfinite(values) & (values > 0)]
    return bool(known.size and known.max() > 10 * known.min())


def _relative_std(
    data: xr.Dataset, kind: PredictionKind, variable: ResultVariable, i: int, value: float
) -> float:
    """Return the factor of one standard deviation of the posterior; NaN for none."""
    if variable.logarithmic:
        std = data.get(f"posterior_{kind.dimension}_log_std")
        return float(np.exp(std.values[i])) if std is not None else np.nan
    std = data.get(f"posterior_{variable.name}_std")
    return 1 + abs(float(std.values[i] / value)) if std is not None and value else np.nan


def pages(data: xr.Dataset) -> Iterator[tuple[str, Picture]]:
    """Yield a name and a picture of each prediction at all models."""
    for each in predictions_in(data):
        yield f"{each.kind.dimension} {each.name}", _Page(data, each).picture()


@dataclass(frozen=True)
class _Page:
    """One prediction at all models.

    Attributes
    ----------
    data : the results
    of : the prediction
    """

    data: xr.Dataset
    of: RecordedPrediction

    @property
    def variable(self) -> ResultVariable:
        """The variable that is drawn: the first one with a range, if there is any."""
        return (*self.of.kind.ranged, *self.of.kind.variables)[0]

    @property
    def values(self) -> Floats:
        """Values (points, positions); NaN where a logarithm has none."""
        values = np.asarray(self.data[self.variable.name].values[:, list(self.of.positions)])
        return np.where(values > 0, values, np.nan) if self.variable.logarithmic else values

    @property
    def title(self) -> str:
        """Name of the prediction with its load case."""
        load = self.data.get(f"{self.of.kind.dimension}_load")
        named = "" if load is None else f" ({load.values[self.of.positions[0]]})"
        return f"{self.of.name}{named}"

    def picture(self) -> Picture:
        """Return the picture, along the front where that is a path."""
        if not is_path(self.data) or len(self.of.positions) > FEW:
            figure = picture(max(5.2, 0.4 * len(self.of.places)), 3.4)
            axes = figure.add_subplot()
            parallel(axes, self.data, self.values, self.of.places)
            key(axes, self.data)
        elif self.variable.logarithmic:
            figure = picture(4.8, 3.3)
            axes = figure.add_subplot()
            self._draw_levels(figure, axes)
        else:
            return self._panels()
        if self.variable.logarithmic and np.isfinite(self.values).any():
            axes.set_yscale("log")
        axes.set_ylabel(self.variable.title)
        figure.suptitle(plain(self.title), x=0.01, ha="left")
        return figure

    def _draw_levels(self, figure: Picture, axes: Axes) -> None:
        """Draw a line a level of probabilities along the front."""
        along, values = Along(self.data), self.values
        axes.set_yscale("log")
        std = self.data.get(f"posterior_{self.of.kind.dimension}_log_std")
        for k, (i, place) in enumerate(zip(self.of.positions, self.of.places, strict=True)):
            colour = COLOURS[k % len(COLOURS)]
            along.draw(axes, values[:, k], colour, short(place))
            if std is not None:
                x, factor = values[along.best, k], float(np.exp(std.values[i]))
                along.bar(axes, along.at_best(x / factor, x * factor), colour)
        along.finish(figure, [axes], 1)

    def _panels(self) -> Picture:
        """Return a panel a value along the front."""
        along, values = Along(self.data), self.values
        figure, grid = panels(len(self.of.places))
        std = self.data.get(f"posterior_{self.variable.name}_std")
        for k, (axes, place) in enumerate(zip(grid, self.of.places, strict=True)):
            along.draw(axes, values[:, k])
            if std is not None:
                x, s = values[along.best, k], float(std.values[self.of.positions[k]])
                along.bar(axes, along.at_best(x - s, x + s))
            titled(axes, place)
            if k % COLUMNS == 0:
                axes.set_ylabel(self.variable.title)
        figure.suptitle(plain(self.title), x=0.01, ha="left")
        along.finish(figure, grid, min(COLUMNS, len(grid)))
        return figure
