"""Predictions of every kind as tables: models, range over the Pareto-optimal ones, posterior."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import xarray as xr

from modefront.cli.layout import Screen
from modefront.front.point import INTERNAL, preferred
from modefront.predictions.registry import RecordedPrediction, predictions_in

DRAWN = ("mean", "5 %", "95 %")
"""Statistics of models drawn from the posterior that are shown."""

RANGE = "range over the Pareto-optimal models; spread is greatest over least"


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
    logarithmic: bool
    ranged: bool = True

    @property
    def form(self) -> str:
        """Format of its values."""
        return ".3e" if self.logarithmic else ".5g"


def print_predictions(screen: Screen, data: xr.Dataset) -> None:
    """Print all predictions of all models that are no points of the front, and their ranges."""
    if "range" not in data.sizes:
        screen.say("The study asks for no predictions.")
        return
    posterior = Posterior(data)
    frequencies = [
        Quantity(f"f{r}, Hz", "frequency", i, "posterior_frequency_std", False)
        for i, r in enumerate(data["mode"].values)
    ]
    _print_quantities(screen, data, posterior, f"frequencies: {RANGE}", frequencies)
    for text in posterior.explained:
        screen.say(text)
    for each in predictions_in(data):
        _print_quantities(screen, data, posterior, each.heading, list(_quantities(each)))
        _print_check(screen, data, each)


def first_predictions(data: xr.Dataset) -> tuple[list[str], list[list[str]]]:
    """Return columns and rows of a short table: the main quantity of each prediction."""
    posterior = Posterior(data)
    best = _position(data, preferred(data.attrs))
    rows = []
    for each in predictions_in(data):
        main = next((variable.name for variable in each.kind.ranged), "")
        for quantity in _quantities(each):
            if quantity.variable == main:
                least, greatest, _ = data[f"{main}_range"].values[:, quantity.place]
                rows.append(
                    [
                        f"{each.name}, {quantity.name}",
                        _number(data[main].values[best, quantity.place], ".3g"),
                        *posterior.std(quantity),
                        f"{_number(least, '.3g')} to {_number(greatest, '.3g')}",
                    ]
                )
    columns = [preferred(data.attrs), *posterior.columns[: posterior.known]]
    return ["", *columns, "least to greatest"], rows


class Posterior:
    """Scatter of predictions by the posterior, and models drawn from it, as columns."""

    def __init__(self, data: xr.Dataset) -> None:
        self.data = data
        self.known = "posterior_frequency_std" in data
        statistics = data["statistic"].values.tolist() if "statistic" in data.sizes else []
        self.drawn = [statistics.index(x) for x in DRAWN if x in statistics]

    @property
    def columns(self) -> list[str]:
        """Titles."""
        return ["posterior"] * self.known + [f"drawn {x}" for x in DRAWN[: len(self.drawn)]]

    @property
    def explained(self) -> list[str]:
        """Headings of the columns."""
        out = []
        if self.known:
            out.append(
                f"posterior: standard deviation around {preferred(self.data.attrs)}; of P as a "
                "factor, e to that of ln P"
            )
        if self.drawn:
            out.append(
                f"drawn: over {self.data.sizes['draw']} models drawn from the posterior; the mean "
                "of P is the robust failure probability"
            )
        return out

    def std(self, quantity: Quantity) -> list[str]:
        """Return the standard deviation of a prediction, that of a logarithm as a factor."""
        if not self.known:
            return []
        std = self.data.get(quantity.std)
        if std is None or not quantity.ranged:
            return [""]
        x = float(std.values[quantity.place])
        shown = np.exp(x) if quantity.logarithmic else x
        sign = "×÷" if quantity.logarithmic else "±"
        return ["none" if np.isnan(x) else f"{sign} {shown:.3g}"]

    def row(self, quantity: Quantity) -> list[str]:
        """Return the cells of one prediction."""
        drawn = self.data.get(f"posterior_{quantity.variable}")
        if drawn is None or not quantity.ranged:
            return [*self.std(quantity), *[""] * len(self.drawn)]
        values = drawn.values[self.drawn, quantity.place]
        return [*self.std(quantity), *(_number(x, quantity.form) for x in values)]


def _quantities(prediction: RecordedPrediction) -> Iterator[Quantity]:
    kind = prediction.kind
    for i, place in zip(prediction.positions, prediction.places, strict=True):
        for variable in kind.variables:
            log = variable.logarithmic
            std = f"posterior_{kind.dimension}_log_std" if log else f"posterior_{variable.name}_std"
            title = f"{place}: {variable.title}"
            yield Quantity(title, variable.name, i, std, log, variable.ranged)


def _print_quantities(
    screen: Screen,
    data: xr.Dataset,
    posterior: Posterior,
    heading: str,
    quantities: list[Quantity],
) -> None:
    named = [i for i, kind in enumerate(data["kind"].values) if kind not in {"front", *INTERNAL}]
    rows = []
    for quantity in quantities:
        values = data[quantity.variable].values[:, quantity.place]
        if quantity.ranged:
            least, greatest, spread = data[f"{quantity.variable}_range"].values[:, quantity.place]
            extent = [_number(least, quantity.form), _number(greatest, quantity.form)]
            extent.append(_number(spread, ".4g"))
        else:
            known = values[np.isfinite(values)]
            greatest = known.max() if known.size else np.nan
            extent = ["", _number(float(greatest), ".2g"), ""]
        form = quantity.form if quantity.ranged else ".2g"
        cells = [_number(values[i], form) for i in named]
        rows.append([quantity.name, *extent, *posterior.row(quantity), *cells])
    labels = [str(data["label"].values[i]) for i in named]
    columns = ["", "minimum", "maximum", "spread", *posterior.columns, *labels]
    screen.table(heading, columns, rows)


def _print_check(screen: Screen, data: xr.Dataset, prediction: RecordedPrediction) -> None:
    """Print the comparison with finer numerics, where there is one."""
    check, positions = prediction.kind.check, prediction.positions
    if check is None or check.label.name not in data:
        return
    label = data[check.label.name].values[positions[0]]
    for variable in check.variables:
        values = [_number(data[variable.name].values[i], ".3f") for i in positions]
        screen.say(f"at {label}: {variable.meaning}: {', '.join(values)}")


def _position(data: xr.Dataset, label: str) -> int:
    return [str(x) for x in data["label"].values].index(label)


def _number(value: float, form: str) -> str:
    return "none" if np.isnan(value) else format(float(value), form)
