"""The front in the space of errors, quantities along it, minima, their scatter, and predictions."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import wraps
from typing import Any, Concatenate, ParamSpec

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Ellipse
from matplotlib.ticker import LogLocator, NullFormatter

from modefront._typing import Bools, Floats
from modefront.datasets import Dataset
from modefront.errors import Fault, InputError
from modefront.front.methods import METHODS
from modefront.front.point import front_points, position, preferred
from modefront.plots import canvas, drawing
from modefront.plots.modes import modes
from modefront.predictions.base import RecordedPrediction, predictions_in
from modefront.text import NAME, Shown

FAR = 2.5
"""Error over the greatest of the Pareto-optimal models from which a model is beyond the axes."""

CORNER = 8  # parameters of which all pairs are drawn


def front(data: Dataset, *, log: bool = False) -> canvas.Picture:
    """Return the front in the space of errors; axes are logarithmic if ``log``."""
    error, groups = data["error"].values, data.sizes["group"]
    if log:
        error = np.maximum(error, 1e-4 * np.max(error, where=np.isfinite(error), initial=0.0))
    if groups == 1:
        return _one(data, error)
    figure = _two(data, error) if groups == 2 else _many(data, error)
    if log:
        for axes in figure.axes:
            axes.set(xscale="log", yscale="log")
    elif groups == 2:
        _limits(figure.axes[0], data, error)
    return figure


def _titles(data: Dataset, most: int = NAME) -> list[str]:
    """Return what the axes of errors are called."""
    return [f"error of {group}" for group in canvas.names_of(data, "group", most)]


def _one(data: Dataset, error: Floats) -> canvas.Picture:
    """Draw a line a model."""
    labels = canvas.names_of(data, "label", 24)
    figure, axes = canvas.single(4.6, 0.9 + 0.25 * len(labels))
    canvas.draw_models(axes, data, np.column_stack([error[:, 0], np.arange(len(labels))]))
    axes.set_yticks(range(len(labels)), labels)
    axes.invert_yaxis()
    axes.set_xlabel(_titles(data)[0])
    axes.locator_params(axis="x", nbins=5)
    return figure


def _two(data: Dataset, error: Floats) -> canvas.Picture:
    figure, axes = canvas.single(5.2, 4.0)
    method = METHODS.get(data.attrs["method"])
    if canvas.is_path(data) and method is not None and method.programme is not None:
        for branch in canvas.branches(data):
            axes.plot(*error[branch].T, "-", color=canvas.COLOURS[0], lw=1, alpha=0.5)
    canvas.draw_models(axes, data, error)
    axes.set(**dict(zip(("xlabel", "ylabel"), _titles(data), strict=True)))
    axes.legend()
    return figure


def _limits(axes: Axes, data: Dataset, error: Floats) -> None:
    """Leave far models out that are not Pareto optimal, and note their number."""

    def most(chosen: Bools) -> Floats:
        greatest = np.nanmax(error[chosen], axis=0)
        return np.where(greatest > 0, greatest, 1.0)

    chosen = canvas.shown(data)
    far = ~chosen & (error > FAR * most(chosen)).any(axis=1)
    if not far.any():
        return
    x, y = most(~far)
    axes.set(xlim=(-0.05 * x, 1.1 * x), ylim=(-0.05 * y, 1.1 * y))
    text = f"{far.sum()} models"
    if far.sum() == 1:
        (label,), ((x, y),) = data["label"].values[far], error[far]
        text = f"{canvas.short(label)} ({x:.3g}, {y:.3g})"
    axes.set_title(f"beyond the axes: {text}", loc="right", color="0.35")


def _many(data: Dataset, error: Floats) -> canvas.Picture:
    """Draw all pairs of errors."""
    titles = _titles(data, 18)
    n = len(titles)
    size = 2.1 if n < 6 else 1.5
    figure = canvas.picture(max(size * (n - 1), 5.2), size * (n - 1) + 0.2)
    grid = figure.subplots(n - 1, n - 1, squeeze=False, sharex="col", sharey="row")
    for (i, j), axes in np.ndenumerate(grid):
        if j > i:
            axes.remove()
            continue
        canvas.draw_models(axes, data, error[:, [j, i + 1]])
        if i == n - 2:
            axes.set_xlabel(titles[j])
        if j == 0:
            axes.set_ylabel(titles[i + 1])
    handles, labels = grid[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper right")
    return figure


def parameters(data: Dataset) -> canvas.Picture:
    """Return the parameters of all models, with standard deviations where they are known."""
    theta, bounds, std = data["theta"].values, data["bounds"].values, parameter_std(data)

    def mark(axes: Axes, j: int) -> None:
        low, high = axes.get_ylim()
        for bound in bounds[j]:
            if low - 0.1 * (high - low) <= bound <= high + 0.1 * (high - low):
                axes.axhline(bound, color="k", ls=":", lw=1, label="bound")

    names, bars = data["parameter"].values.tolist(), (theta - std, theta + std)
    return canvas.panels_along(data, theta, names, bars, mark=mark)


def frequencies(data: Dataset) -> canvas.Picture:
    """Return the frequencies of all models beside the measured ones."""
    f, measured = data["frequency"].values, data["measured_frequency"].values

    def mark(axes: Axes, r: int) -> None:
        if np.isfinite(measured[r]):
            axes.axhline(measured[r], color="k", ls="--", lw=1, label="measured")

    bars = canvas.at_reference(data, f, _known(data, "posterior_frequency_std"))
    return canvas.panels_along(data, f, _modes(data), bars, "frequency, Hz", mark)


def mac(data: Dataset) -> canvas.Picture:
    """Return the MAC values of all models."""
    values = data["mac"].values
    low, high = canvas.at_reference(data, values, _known(data, "posterior_mac_std"))
    return canvas.panels_along(data, values, _modes(data), (low, np.minimum(high, 1.0)), "MAC")


def _modes(data: Dataset) -> list[str]:
    return [f"mode {r}" for r in data["mode"].values]


def _known(data: Dataset, name: str) -> Any:
    """Return the values of a variable; NaN where there is none."""
    return data[name].values if name in data else np.nan


def parameter_std(data: Dataset) -> Floats:
    """Return standard deviations (points, p) by errors of the data, or of the posterior; or NaN."""
    out, best = np.full(data["theta"].values.shape, _known(data, "theta_std")), position(data)
    if np.isnan(out[best]).all():
        out[best] = _known(data, "posterior_std")
    return np.where(np.isfinite(out), out, np.nan)


def unit_of(data: Dataset) -> tuple[Floats, str]:
    """Return units (p,) in which parameters are drawn beside each other, and their name."""
    nominal = data["theta"].values[data["kind"].values == "nominal"]
    if len(nominal) and (nominal[0] > 0).all():
        return nominal[0], "parameter over its nominal value"
    return np.ones(data.sizes["parameter"]), "parameter"


def minima(data: Dataset) -> canvas.Picture:
    """Return all minima, and the models that fit equally well, as lines across the parameters."""
    names, (unit, title) = canvas.names_of(data, "parameter", 18), unit_of(data)
    figure, axes = canvas.single(max(5.6, 0.45 * len(names)), 3.6)
    x, of = np.arange(len(names)), list(map(str, data["minimum_of"].values))
    colours = {name: canvas.colour_of(k) for k, name in enumerate(dict.fromkeys(of))}
    if "equal_of" in data:
        for name, theta in zip(data["equal_of"].values, data["equal_theta"].values, strict=True):
            axes.plot(x, theta / unit, "-", color=colours.get(str(name), "0.6"), lw=0.5, alpha=0.35)
    for k, (name, theta) in enumerate(zip(of, data["minimum_theta"].values, strict=True)):
        label = canvas.short(name) if name not in of[:k] else None
        axes.plot(x, theta / unit, "-o", color=colours[name], lw=1.4, ms=4.5, label=label)
    bounds = data["bounds"].values / unit[:, None]
    for ends, label in zip(bounds.T, (None, "bounds"), strict=True):
        axes.plot(x, ends, "_", color="k", ms=10, label=label)
    if (bounds > 0).all():
        axes.set_yscale("log")
        axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.yaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_minor_formatter(NullFormatter())
    axes.set_xticks(x, names, rotation=60 if len(names) > 6 else 0)
    axes.set_ylabel(title)
    canvas.legend(figure, axes, "outside upper left", 4)
    return figure


def uncertainty(data: Dataset) -> canvas.Picture:
    """Return the scatter of parameters and front by errors of the data.

    That are parameters with deviations, their correlation, and the front with its scatter.
    """
    covariance = None  # of the parameters at the reference
    if "posterior_covariance" in data:
        covariance = data["posterior_covariance"].values
    elif "theta_covariance" in data:
        covariance = data["theta_covariance"].values[position(data)]
        covariance = covariance if np.isfinite(covariance).all() else None
    scattered = data.sizes["group"] == 2 and "objective_covariance" in data
    parts = 1 + (covariance is not None) + scattered
    figure = canvas.picture(3.6 * parts, max(3.2, 0.26 * data.sizes["parameter"] + 1.2))
    row = list(figure.subplots(1, parts, squeeze=False)[0])
    _parameters(row[0], data)
    canvas.legend(figure, row.pop(0), "outside lower left", 3)
    if covariance is not None:
        axes = row.pop(0)
        size = np.sqrt(np.maximum(np.diag(covariance), 0))
        scale = np.outer(size, size)
        r = np.divide(covariance, scale, out=np.zeros(covariance.shape), where=scale > 0)
        canvas.draw_matrix(axes, r, canvas.names_of(data, "parameter", 18), -1, "PuOr")
        axes.set_title(f"correlation at {canvas.short(preferred(data.attrs))}", loc="left")
    if scattered:
        _ellipses(row.pop(0), data)
    return figure


def corner(data: Dataset, parameters: Sequence[str] = ()) -> canvas.Picture:
    """Return the draws of the posterior: of each parameter, and of each two; red is the reference.

    Grey is the 90 % interval. Unless named, they are those whose intervals are least beside those
    of the prior. Raises KeyError for an unknown name.
    """
    every = data["parameter"].values.tolist()
    if unknown := [name for name in parameters if name not in every]:
        raise KeyError(f"no parameter {unknown[0]!r}; there are {', '.join(map(repr, every))}")
    ends = data["interval"].values
    share = (ends[:, 2] - ends[:, 0]) / data["prior_width"].values
    chosen = [every.index(name) for name in parameters] or sorted(np.argsort(share)[:CORNER])
    names = [canvas.short(every[j], 18) for j in chosen]
    unit, title = unit_of(data)
    draws = data["sample_theta"].values / unit
    best = data["theta"].values[position(data)] / unit
    n = len(chosen)
    figure = canvas.picture(max(1.5 * n, 3.0), max(1.5 * n, 3.0))
    grid = figure.subplots(n, n, sharex="col", squeeze=False)
    for (row, column), axes in np.ndenumerate(grid):
        i, j = chosen[row], chosen[column]
        if row < column:
            axes.remove()
            continue
        axes.axvline(best[j], color=canvas.COLOURS[1], lw=0.9)
        if row == column:
            axes.axvspan(*ends[j, [0, 2]] / unit[j], color="0.9", lw=0)
            axes.hist(draws[:, j], bins=20, color=canvas.COLOURS[0], histtype="step")
            axes.set_yticks([])
        else:
            axes.axhline(best[i], color=canvas.COLOURS[1], lw=0.9)
            axes.plot(draws[:, j], draws[:, i], ".", color=canvas.COLOURS[0], ms=2, alpha=0.5)
        if column == 0 and row:
            axes.set_ylabel(names[row])
        if column and row != column:
            axes.set_yticklabels([])
        if row == n - 1:
            axes.set_xlabel(names[column])
    left = f", {n} of {len(every)}" * (n < len(every))
    figure.suptitle(f"draws of the posterior: {title}{left}", x=0.01, ha="left")
    return figure


def _parameters(axes: Axes, data: Dataset) -> None:
    unit, title = unit_of(data)
    std, theta = parameter_std(data) / unit, data["theta"].values / unit
    rows = [position(data), *np.flatnonzero(data["kind"].values == "edge").tolist()]
    names = canvas.names_of(data, "parameter", 18)
    y, (blue, red, *more) = np.arange(len(names)), canvas.COLOURS
    others = blue, "0.3", *more
    for k, i in enumerate(rows):
        shift = y + 0.7 * ((k + 0.5) / len(rows) - 0.5)
        colour = others[(k - 1) % len(others)] if k else red
        for width, reach in ((1.0, 2 * std[i]), (2.4, std[i])):
            axes.hlines(shift, theta[i] - reach, theta[i] + reach, colour, lw=width)
        label = canvas.short(data["label"].values[i])
        axes.plot(theta[i], shift, "o", color=colour, ms=4, label=label)
    axes.set_yticks(y, names)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.set_xlabel(title)
    axes.set_title("with 1 and 2 standard deviations", loc="left")


def _ellipses(axes: Axes, data: Dataset) -> None:
    """Draw the front with ellipses of one standard deviation of the errors e = sqrt(J / a)."""
    error, C = data["error"].values, data["objective_covariance"].values
    J = data["objective"].values
    ratio = np.divide(error, 2 * J, out=np.full(J.shape, np.nan), where=J > 0)  # de / dJ
    for i in front_points(data).tolist():
        S = C[i] * np.outer(ratio[i], ratio[i])
        # Where a group is fitted exactly, e has no derivative and no ellipse.
        if not np.isfinite(S).all() or (np.sqrt(np.diag(S)) > error[i]).any():
            continue
        values, vectors = np.linalg.eigh(S)
        width, height = 2 * np.sqrt(np.maximum(values, 0))
        angle = float(np.degrees(np.arctan2(vectors[1, 0], vectors[0, 0])))
        marks: dict[str, Any] = {"fc": canvas.COLOURS[4], "ec": canvas.COLOURS[0], "alpha": 0.25}
        axes.add_patch(Ellipse(error[i].tolist(), width, height, angle=angle, **marks))
    canvas.draw_models(axes, data, error, "nominal")
    axes.set(**dict(zip(("xlabel", "ylabel"), _titles(data), strict=True)))
    axes.set_title("front with its scatter", loc="left")


def predictions(data: Dataset) -> canvas.Picture:
    """Return the range of each prediction over the Pareto-optimal models, over the reference.

    Ticks are the posterior's standard deviation to either side; the cross is the nominal model.
    """
    best, chosen = position(data), canvas.shown(data)
    nominal = np.flatnonzero(data["kind"].values == "nominal")
    rows = [
        (each.name, x)
        for each in predictions_in(data)
        for variable in each.kind.ranged
        for x in each.quantities
        if x.variable == variable
    ]
    figure, axes = canvas.single(6.4, 1.0 + 0.24 * max(len(rows), 1))
    bar: dict[str, Any] = {"color": canvas.COLOURS[0], "lw": 5, "alpha": 0.5}
    star: dict[str, Any] = {"color": canvas.COLOURS[1], "mec": "k", "mew": 0.5, "ms": 9}
    labels, widely = [], False
    for y, (name, of) in enumerate(rows):
        value, known = of.values[best], of.values[chosen & np.isfinite(of.values)]
        positive = known[known > 0]
        widely |= bool(positive.size and positive.max() > 10 * positive.min())
        labels.append(f"{canvas.short(f'{name}, {of.place}: {of.variable.key}', 40)} ({value:.3g})")
        if not known.size or not value or np.isnan(value):
            continue
        std = np.nan if of.std is None else of.std
        sides = np.array([-std, std])
        ticks = np.exp(sides) if of.variable.logarithmic else 1 + sides / value
        axes.plot(of.extent[:2] / value, [y, y], **bar)
        axes.plot(known / value, [y] * known.size, "|", color=canvas.COLOURS[0], ms=5)
        axes.plot(ticks, [y, y], "-|", color=canvas.COLOURS[1], lw=1.2, ms=8)
        axes.plot(1, y, "*", **star)
        axes.plot(of.values[nominal] / value, [y] * nominal.size, "X", color="0.4", ms=6)
    axes.set_yticks(range(len(rows)), labels)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    if widely:
        axes.set_xscale("log")
    label = canvas.short(data["label"].values[best])
    axes.set_xlabel(f"over that of {label} (its value in brackets)")
    axes.plot([], [], **bar, label="Pareto-optimal models")
    axes.plot([], [], "-*", **star, label=f"{label}, ± 1 std")
    if nominal.size:
        axes.plot([], [], "X", color="0.4", ls="", label="nominal")
    canvas.legend(figure, axes, "outside lower left", 3)
    return figure


def _page(data: Dataset, of: RecordedPrediction) -> canvas.Picture:
    """Return one prediction at all models: of its variables the first one with a range, if any.

    Probabilities are lines of one panel, one a level.
    """
    variable = (*of.kind.ranged, *of.kind.variables)[0]
    quantities = [x for x in of.quantities if x.variable == variable]
    values = np.column_stack([x.values for x in quantities])
    std = [np.nan if x.std is None else x.std for x in quantities]
    places = [x.place for x in quantities]
    if variable.logarithmic:
        values = np.where(values > 0, values, np.nan)
        figure, axes = canvas.single(4.8, 3.3)
        axes.set(yscale="log", ylabel=variable.title)
        along = canvas.Along(data)
        bars = canvas.at_reference(data, np.log(values), std)
        for k, place in enumerate(places):
            along.draw(axes, values[:, k], canvas.colour_of(k), canvas.short(place, 18))
            low, high = (np.exp(each[:, k]) for each in bars)
            along.bars(axes, low, high, canvas.colour_of(k))
        along.finish(figure, [axes], 1)
    else:
        bars = canvas.at_reference(data, values, std)
        figure = canvas.panels_along(data, values, places, bars, variable.title)
    figure.suptitle(canvas.short(of.name + f" ({of.load})" * bool(of.load)), x=0.01, ha="left")
    return figure


S = ParamSpec("S")


def _method(
    draw: Callable[Concatenate[Dataset, S], canvas.Picture], what: str = "", *needed: str
) -> "Callable[Concatenate[Plots, S], canvas.Picture]":
    """Return a method that draws in the style of all pictures.

    Results hold ``what`` it shows if they have any of the variables ``needed``.
    """

    @wraps(draw)
    def method(self: "Plots", /, *arguments: S.args, **options: S.kwargs) -> canvas.Picture:
        with drawing():
            if needed and not any(name in self.data for name in needed):
                place = f"plot of {draw.__name__}"
                raise InputError(Fault("", place, f"results with {what}", "none"))
            return draw(self.data, *arguments, **options)

    return method


@dataclass(frozen=True, repr=False)
class Plots(Shown):
    """Pictures of results; each method returns a figure of matplotlib, with ``savefig``.

    All raise InputError without matplotlib, and where the results do not hold what is drawn.
    """

    data: Dataset  # the results

    front = _method(front)
    parameters = _method(parameters)
    frequencies = _method(frequencies)
    mac = _method(mac)
    modes = _method(modes, "mode shapes", "shape")
    predictions = _method(predictions, "predictions", "frequency_range")
    uncertainty = _method(
        uncertainty, "errors of the data or a posterior", "theta_std", "posterior_std"
    )
    corner = _method(corner, "draws of a posterior", "sample_theta")
    minima = _method(minima)


PLOTS = tuple(name for name in vars(Plots) if not name.startswith("_"))
"""Pictures in the order of their files."""


def figures(data: Dataset) -> Iterator[tuple[str, canvas.Picture]]:
    """Yield name and figure of everything that the results hold, each prediction by itself."""
    for name in PLOTS:
        try:
            picture = getattr(Plots(data), name)()
        except InputError:  # the results do not hold what it shows
            continue
        yield name, picture
        for each in predictions_in(data) if name == "predictions" else ():
            yield f"{each.kind.dimension} {each.name}", _page(data, each)
