"""Predictions of every kind as tables: models, range over the Pareto-optimal ones, posterior."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import xarray as xr

from modefront.cli.layout import Line, Screen, number, plural
from modefront.front.point import INTERNAL, preferred
from modefront.predictions.registry import RecordedPrediction, predictions_in
from modefront.results.selection import reference

DRAWN = ("mean", "5 %", "95 %")
"""Statistics of models drawn from the posterior that are shown."""


@dataclass(frozen=True)
class Quantity:
    """One predicted number of each model.

    Attributes
    ----------
    name : of the prediction, the place and the quantity, in a line of a table
    variable : of the results that holds it
    place : its position in the second dimension of that variable
    std : variable with the standard deviation of the posterior
    logarithmic : whether that is one of the logarithm
    ranged : whether the results have its range
    """

    name: str
    variable: str
    place: int
    std: str
    logarithmic: bool = False
    ranged: bool = True

    def deviation(self, data: xr.Dataset) -> str:
        """Return the standard deviation by the posterior, that of a logarithm as a factor."""
        if self.std not in data or not self.ranged:
            return ""
        std = float(data[self.std].values[self.place])
        shown = f"×÷ {np.exp(std):.3g}" if self.logarithmic else f"± {std:.3g}"
        return "none" if np.isnan(std) else shown

    def row(self, data: xr.Dataset, models: list[int]) -> list[str]:
        """Return its range over the Pareto-optimal models, its posterior, and ``models``."""
        values, form = data[self.variable].values[:, self.place], ".2g"
        known = values[np.isfinite(values)]
        extent = ["", number(known.max() if known.size else np.nan, form), ""]
        drawn = [""] * len(_drawn(data))
        if self.ranged:
            form = ".3e" if self.logarithmic else ".5g"
            *ends, spread = data[f"{self.variable}_range"].values[:, self.place]
            extent = [*(number(x, form) for x in ends), number(spread, ".4g")]
            if f"posterior_{self.variable}" in data:
                posterior = data[f"posterior_{self.variable}"].values[:, self.place]
                drawn = [number(posterior[k], form) for k in _drawn(data)]
        std = [self.deviation(data)] * ("posterior_frequency_std" in data)
        return [self.name, *extent, *std, *drawn, *(number(values[i], form) for i in models)]


def print_predictions(screen: Screen, data: xr.Dataset) -> None:
    """Print all predictions of all models that are no points of the front, and their ranges."""
    if "range" not in data.sizes:
        screen.say("The study asks for no predictions.")
        return
    best, linear = preferred(data.attrs), "posterior_frequency_std" in data
    kinds = data["kind"].values
    models = [i for i, kind in enumerate(kinds) if kind not in {"front", *INTERNAL}]
    columns = ["", "minimum", "maximum", "spread", *["posterior"] * linear]
    columns += [f"drawn {data['statistic'].values[k]}" for k in _drawn(data)]
    columns += [str(data["label"].values[i]) for i in models]
    frequencies = [
        Quantity(f"f{r}, Hz", "frequency", i, "posterior_frequency_std")
        for i, r in enumerate(data["mode"].values)
    ]
    title = "frequencies: range over the Pareto-optimal models; spread is greatest over least"
    screen.table(title, columns, [x.row(data, models) for x in frequencies])
    if linear:
        screen.say(
            f"posterior: standard deviation around {best}; of P as a factor, e to that of ln P"
        )
    if _drawn(data):
        drawn = plural(data.sizes["draw"], "model")
        screen.say(
            f"drawn: over {drawn} drawn from the posterior; the mean of P is the robust "
            "failure probability"
        )
    for each in predictions_in(data):
        screen.table(each.heading, columns, [x.row(data, models) for x in _quantities(each)])
        check = each.kind.check
        if check is not None and check.label.name in data:
            label = data[check.label.name].values[each.positions[0]]
            for x in check.variables:
                values = [number(data[x.name].values[i], ".3f") for i in each.positions]
                screen.say(f"at {label}: {x.meaning}: {', '.join(values)}")


def predictions_in_short(screen: Screen, data: xr.Dataset, most: int, full: str) -> list[Line]:
    """Return the lines of the main quantities of the first predictions, ``most`` of them.

    ``full`` is the command that prints all.
    """
    best, rows = reference(data), []
    for each in predictions_in(data):
        main = next((variable.name for variable in each.kind.ranged), "")
        for x in _quantities(each):
            if x.variable == main:
                least, greatest, _ = data[f"{main}_range"].values[:, x.place]
                value = number(data[main].values[best, x.place], ".3g")
                ends = f"{number(least, '.3g')} to {number(greatest, '.3g')}"
                rows.append([f"{each.name}, {x.name}", f"{value} {x.deviation(data)}", ends])
    columns = ["", preferred(data.attrs), "Pareto-optimal models"]
    out = screen.grid("predictions", columns, rows[:most])
    rest = len(rows) - most
    return out + (screen.sentence(f"and {rest} more: {full}") if rest > 0 else [])


def _drawn(data: xr.Dataset) -> list[int]:
    """Return the positions of the statistics that are shown."""
    statistics = data["statistic"].values.tolist() if "statistic" in data.sizes else []
    return [statistics.index(x) for x in DRAWN if x in statistics]


def _quantities(prediction: RecordedPrediction) -> Iterator[Quantity]:
    kind = prediction.kind
    for i, place in zip(prediction.positions, prediction.places, strict=True):
        for x in kind.variables:
            std = f"posterior_{kind.dimension}_log" if x.logarithmic else f"posterior_{x.name}"
            title = f"{place}: {x.title}"
            yield Quantity(title, x.name, i, f"{std}_std", x.logarithmic, x.ranged)
