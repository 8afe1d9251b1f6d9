"""Results as tables: an overview, and full lists of models, minima, deviations, predictions."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from modefront._typing import Floats, Ints
from modefront.cli.layout import BLANK, Line, Screen, number, plural
from modefront.findings.selection import reference
from modefront.front.point import INTERNAL, Kind, preferred
from modefront.predictions.registry import RecordedPrediction, predictions_in
from modefront.results.remarks import remarks

FEWEST = 3
"""Parameters and modes that a table keeps, however long it is."""

BOUND = {-1: " min", 1: " max"}


def first_models(data: xr.Dataset) -> list[int]:
    """Return the positions of the nominal model, the reference and the edges."""
    kinds = data["kind"].values
    chosen = [
        *np.flatnonzero(kinds == Kind.NOMINAL.value).tolist(),
        reference(data),
        *np.flatnonzero(kinds == Kind.EDGE.value).tolist(),
    ]
    return list(dict.fromkeys(chosen))


def print_models(screen: Screen, data: xr.Dataset) -> None:
    """Print all parameters, modes and errors of the first models."""
    table = _Table(data, np.arange(data.sizes["parameter"]), np.arange(data.sizes["mode"]))
    screen.show([BLANK, *table.lines(screen, first_models(data))])


def models_in(screen: Screen, data: xr.Dataset, most: int, full: str) -> list[Line]:
    """Return the lines of the first models, ``most`` or fewer where that is possible.

    ``full`` is the command that prints what is left out.
    """
    first, best = first_models(data)[0], reference(data)
    theta, f = data["theta"].values, data["frequency"].values
    change = np.abs(theta[best] - theta[first]) / np.ptp(data["bounds"].values, axis=1)
    error = np.abs(f[best] / data["measured_frequency"].values - 1)
    parameters, modes = (np.argsort(-np.nan_to_num(x), kind="stable") for x in (change, error))
    p, m = parameters.size, modes.size
    while True:
        table = _Table(data, np.sort(parameters[:p]), np.sort(modes[:m]))
        lines = table.that_fit(screen, full)
        if len(lines) <= most or (p <= FEWEST and m <= FEWEST):
            return lines
        # Each row that is left out saves a line at least, and names or blocks save more.
        fewer = max((len(lines) - most) // 6, 1)
        if p > FEWEST and (p >= m or m <= FEWEST):
            p = max(p - fewer, FEWEST)
        else:
            m = max(m - fewer, FEWEST)


@dataclass(frozen=True)
class _Table:
    """A table with some of the parameters and modes."""

    data: xr.Dataset
    parameters: Ints
    modes: Ints

    def that_fit(self, screen: Screen, full: str) -> list[Line]:
        """Return the lines of the models that fit side by side, and what is left out."""
        models = every = first_models(self.data)
        while len(models) > 2 and BLANK in self.lines(screen, models):
            models = models[:-1]
        p = self.data.sizes["parameter"] - self.parameters.size
        m = self.data.sizes["mode"] - self.modes.size
        e = len(every) - len(models)
        left = [
            *([f"{plural(p, 'more parameter')} that change{'s' * (p == 1)} less"] * (p > 0)),
            *([f"{plural(m, 'more mode')} that fit{'s' * (m == 1)} better"] * (m > 0)),
            *([plural(e, "edge")] * (e > 0)),
        ]
        said = screen.sentence(f"and {', '.join(left)}: {full}") if left else []
        return [*self.lines(screen, models), *said]

    def lines(self, screen: Screen, models: list[int]) -> list[Line]:
        """Return the table of some models, and what explains it."""
        columns = ["", *(str(self.data["label"].values[i]) for i in models)]
        out = screen.grid("", columns, list(self._rows(models)))
        std, explained = deviations(self.data)
        notes = [f"±: {explained}"] * bool(np.isfinite(std[self.parameters]).any())
        if self._bound[models][:, self.parameters].any():
            notes.append("min, max: at its lower or upper bound")
        return [*out, *screen.sentence("; ".join(notes))] if notes else out

    @property
    def _bound(self) -> Ints:
        given = self.data.get("at_bound")
        return np.zeros(self.data["theta"].shape, int) if given is None else given.values

    def _rows(self, models: list[int]) -> Iterator[list[str]]:
        """Yield the cells, with headings."""
        data, f = self.data, self.data["frequency"].values
        std, best = deviations(data)[0], reference(data)
        yield ["parameters"]
        for j in self.parameters:
            row = [f"  {data['parameter'].values[j]}"]
            for i in models:
                bound = BOUND.get(int(self._bound[i, j]), "")
                scatter = f" ± {std[j]:.2g}" * (i == best and np.isfinite(std[j]) and not bound)
                value = number(data["theta"].values[i, j], "#.4g").removesuffix(".")
                row.append(f"{value}{scatter}{bound}")
            yield row
        yield ["modes: error of the frequency in %, and MAC"]
        for r in self.modes:
            measured = data["measured_frequency"].values[r]
            row = [f"  {data['mode'].values[r]}"]
            row[0] += f": {measured:.4g} Hz" * bool(np.isfinite(measured))
            for i in models:
                error = 100 * (f[i, r] / measured - 1)
                first = f"{f[i, r]:.4g} Hz" if np.isnan(error) else f"{round(error, 2) + 0.0:+.2f}"
                mac = number(data["mac"].values[i, r], ".3f")
                row.append("none" if np.isnan(f[i, r]) else f"{first}  {mac}")
            yield row
        yield ["errors of the groups, root mean square"]
        for g, group in enumerate(data["group"].values):
            yield [f"  {group}", *(number(data["error"].values[i, g], ".3g") for i in models)]


def deviations(data: xr.Dataset) -> tuple[Floats, str]:
    """Return standard deviations (p,) of the parameters of the reference, and what they are."""
    if "sample_theta" in data:
        std = data["sample_theta"].values.std(axis=0, ddof=1)
        return std, "standard deviation of the posterior"
    if "theta_std" in data:
        return data["theta_std"].values[reference(data)], "standard deviation by errors of the data"
    if "posterior_std" in data:
        return data["posterior_std"].values, "standard deviation of the posterior"
    return np.full(data.sizes["parameter"], np.nan), ""


DRAWN = ("mean", "5 %", "95 %")
"""Statistics of models drawn from the posterior that are shown."""


@dataclass(frozen=True)
class Quantity:
    """One predicted number of each model: a place in the second dimension of a variable.

    ``std`` is the variable with its standard deviation by the posterior, of the logarithm if
    ``logarithmic``; the results have its range if it is ``ranged``.
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


Columns = Sequence[tuple[str, str, str]]
"""Titles with a place for a name, the variable (rows, names), and the format of its values."""

POINTS: Columns = (
    ("J {}", "objective", ".5g"),
    ("error {}", "error", ".4g"),
    ("{}", "theta", ".5g"),
)
MODES: Columns = (
    ("f{}", "frequency", ".4g"),
    ("error f{} %", "", "+.2f"),
    ("MAC {}", "mac", ".4f"),
)
ERRORS: Columns = (
    ("eigenvalue {}", "eigenvalue_error", ".1e"),
    ("shape {}", "shape_error", ".1e"),
)
MINIMA: Columns = (("J {}", "minimum_objective", ".5g"), ("{}", "minimum_theta", ".5g"))


def print_points(screen: Screen, data: xr.Dataset) -> None:
    """Print objectives, errors, parameters, modes and weights of all models."""
    marks = [
        "*" * int(pareto) + "!" * int(not converged)
        for pareto, converged in zip(data["pareto"].values, data["converged"].values, strict=True)
    ]
    title = "models: * Pareto optimal among these, ! not converged"
    _print(screen, data, title, POINTS, marks)
    measured = data["measured_frequency"].values
    error = 100 * (data["frequency"] / measured - 1)
    known = data.assign({"": np.round(error, 2) + 0.0})
    title = f"frequencies in Hz and MAC; measured: {', '.join(f'{x:.4g}' for x in measured)}"
    _print(screen, known, title, MODES)
    if "certified" in data:
        marks = ["!" * int(not x) for x in data["certified"].values]
        title = "estimated relative errors: ! above the tolerance"
        _print(screen, data, title, ERRORS, marks)
    weighted = data.isel(point=np.flatnonzero(~np.isnan(data["weight"].values).all(axis=1)))
    _print(screen, weighted, "weights", (("{}", "weight", ".5g"),))


def print_minima(screen: Screen, data: xr.Dataset) -> None:
    """Print the minima of each group and of the optimally weighted residuals."""
    title = "minima of the groups and of the weighted residuals"
    _print(screen, data, title, MINIMA, of="minimum_of")


def print_uncertainty(screen: Screen, data: xr.Dataset) -> None:
    """Print how far models and objectives scatter, and the posterior, where they are known."""
    for kind, title in (
        ("", "scatter by errors of the data: standard deviations, linearised"),
        ("bootstrap_", "scatter over data drawn again: standard deviations"),
    ):
        if f"{kind}theta_std" in data:
            columns = [("J {}", f"{kind}objective_std", ".3g"), ("{}", f"{kind}theta_std", ".3g")]
            _print(screen, data, title, columns)
    if "scatter_doubt" in data and (data["scatter_doubt"].values != "").any():
        doubts = data["scatter_doubt"].values
        rows = [[str(x), str(y)] for x, y in zip(data["label"].values, doubts, strict=True) if y]
        screen.table("where linearised standard deviations are approximate", ["model", "why"], rows)
    if "posterior_std" in data:
        modes = data["mode"].values
        titles = [str(x) for x in data["parameter"].values]
        titles += [*(f"f{r} Hz" for r in modes), *(f"MAC {r}" for r in modes)]
        values = [data[f"posterior_{name}std"].values for name in ("", "frequency_", "mac_")]
        cells = [number(x, ".3g", "") for x in np.concatenate(values)]
        title = f"posterior around {preferred(data.attrs)}: standard deviations"
        screen.table(title, ["of", "std"], list(zip(titles, cells, strict=True)))
    elif "theta_std" not in data:
        screen.say("The results hold no uncertainty: the data have no errors that are known.")


def print_findings_of(screen: Screen, data: xr.Dataset) -> None:
    """Print all findings."""
    screen.blank()
    for line in remarks(data):
        screen.say(line, start="- ")


LISTS: Mapping[str, Callable[[Screen, xr.Dataset], None]] = {
    "models": print_models,
    "points": print_points,
    "minima": print_minima,
    "uncertainty": print_uncertainty,
    "predictions": print_predictions,
    "findings": print_findings_of,
}
"""Full lists by the name of their option, in the order in which they are printed."""


# 6 arguments: the table, its rows and its columns.
def _print(
    screen: Screen,
    data: xr.Dataset,
    title: str,
    columns: Columns,
    marks: Sequence[str] = (),
    of: str = "label",
) -> None:
    """Print a table with a row for each of what ``of`` names, and ``marks`` beside these."""
    rows = []
    for i, name in enumerate(data[of].values):
        cells = [number(x, form) for _, values, form in columns for x in data[values].values[i]]
        rows.append([str(name), *marks[i : i + 1], *cells])
    titles = [
        text.format(name)
        for text, values, _ in columns
        for name in data[data[values].dims[1]].values
    ]
    first = ["model" if of == "label" else "of", *[""] * bool(marks)]
    screen.table(title, [*first, *titles], rows, keys=len(first))
