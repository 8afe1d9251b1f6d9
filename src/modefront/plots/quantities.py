"""The front in the space of errors, quantities along it, minima, their scatter, and predictions."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Ellipse
from matplotlib.ticker import LogLocator, NullFormatter

from modefront._typing import Floats
from modefront.datasets import Dataset
from modefront.front.methods import METHODS
from modefront.front.point import front_points, position, preferred
from modefront.plots import canvas
from modefront.predictions.base import RecordedPrediction, predictions_in

FAR = 2.5
"""Error over the greatest of the Pareto-optimal models from which a model is beyond the axes."""


def front(data: Dataset, *, log: bool = False) -> canvas.Picture:
    """Return the front in the space of errors, with logarithmic axes if ``log``."""
    error = data["error"].values
    if log:
        error = np.maximum(error, 1e-4 * np.nanmax(error))
    groups = canvas.names_of(data, "group")
    if len(groups) == 1:
        return _one(data, error, groups[0])
    if len(groups) == 2:
        return _two(data, error, groups, log=log)
    return _many(data, error, groups, log=log)


def _one(data: Dataset, error: Floats, group: str) -> canvas.Picture:
    labels = canvas.names_of(data, "label", 24)
    figure, axes = canvas.single(4.6, 0.9 + 0.25 * len(labels))
    canvas.draw_models(axes, data, np.column_stack([error[:, 0], np.arange(len(labels))]))
    axes.set_yticks(range(len(labels)), labels)
    axes.invert_yaxis()
    axes.set_xlabel(f"error of {group}")
    axes.locator_params(axis="x", nbins=5)
    return figure


def _two(data: Dataset, error: Floats, groups: list[str], *, log: bool) -> canvas.Picture:
    figure, axes = canvas.single(5.2, 4.0)
    method = METHODS.get(data.attrs["method"])
    if canvas.is_path(data) and method is not None and method.programme is not None:
        for branch in canvas.branches(data):
            axes.plot(*error[branch].T, "-", color=canvas.COLOURS[0], lw=1, alpha=0.5)
    canvas.draw_models(axes, data, error)
    axes.set(xlabel=f"error of {groups[0]}", ylabel=f"error of {groups[1]}")
    if log:
        axes.set(xscale="log", yscale="log")
    else:
        _limits(axes, data, error)
    axes.legend()
    return figure


def _limits(axes: Axes, data: Dataset, error: Floats) -> None:
    """Leave far models out that are not Pareto optimal, and note their number."""
    chosen = canvas.shown(data)
    most = np.nanmax(error[chosen], axis=0)
    most = np.where(most > 0, most, 1.0)
    far = ~chosen & (error > FAR * most).any(axis=1)
    if not far.any():
        return
    most = np.nanmax(error[~far], axis=0)
    most = np.where(most > 0, most, 1.0)
    axes.set(xlim=(-0.05 * most[0], 1.1 * most[0]), ylim=(-0.05 * most[1], 1.1 * most[1]))
    count = int(far.sum())
    text = f"{count} models"
    if count == 1:
        (i,) = np.flatnonzero(far)
        text = f"{canvas.short(data['label'].values[i])} ({error[i, 0]:.3g}, {error[i, 1]:.3g})"
    axes.set_title(f"beyond the axes: {text}", loc="right", color="0.35")


def _many(data: Dataset, error: Floats, groups: list[str], *, log: bool) -> canvas.Picture:
    """Draw all pairs of errors."""
    groups, n = canvas.names_of(data, "group", 18), len(groups)
    size = 2.1 if n < 6 else 1.5
    figure = canvas.picture(max(size * (n - 1), 5.2), size * (n - 1) + 0.2)
    grid = figure.subplots(n - 1, n - 1, squeeze=False, sharex="col", sharey="row")
    for i in range(1, n):
        for j in range(n - 1):
            axes = grid[i - 1][j]
            if j >= i:
                axes.remove()
                continue
            canvas.draw_models(axes, data, error[:, [j, i]])
            if log:
                axes.set(xscale="log", yscale="log")
            if i == n - 1:
                axes.set_xlabel(f"error of {groups[j]}")
            if j == 0:
                axes.set_ylabel(f"error of {groups[i]}")
    handles, labels = grid[0][0].get_legend_handles_labels()
    once = dict(zip(labels, handles, strict=True))
    figure.legend(once.values(), once.keys(), loc="upper right")
    return figure


def parameters(data: Dataset) -> canvas.Picture:
    """Return a panel a parameter, with one standard deviation."""
    theta, bounds, std = data["theta"].values, data["bounds"].values, parameter_std(data)

    def mark(axes: Axes, j: int) -> None:
        low, high = axes.get_ylim()
        for bound in bounds[j]:
            if low - 0.1 * (high - low) <= bound <= high + 0.1 * (high - low):
                axes.axhline(bound, color="k", ls=":", lw=1, label="bound")

    names = data["parameter"].values.tolist()
    return canvas.panels_along(data, theta, names, bars=(theta - std, theta + std), mark=mark)


def frequencies(data: Dataset) -> canvas.Picture:
    """Return a panel a mode with the measured frequency."""
    f, measured = data["frequency"].values, data["measured_frequency"].values

    def mark(axes: Axes, r: int) -> None:
        if np.isfinite(measured[r]):
            axes.axhline(measured[r], color="k", ls="--", lw=1, label="measured")

    std = data["posterior_frequency_std"].values if "posterior_frequency_std" in data else ()
    bars = canvas.at_reference(data, f, std)
    names = [f"mode {r}" for r in data["mode"].values]
    return canvas.panels_along(data, f, names, "frequency, Hz", bars, mark)


def mac(data: Dataset) -> canvas.Picture:
    """Return a panel a mode with MAC values."""
    values = data["mac"].values
    std = data["posterior_mac_std"].values if "posterior_mac_std" in data else ()
    bars = canvas.at_reference(data, values, std)
    bars = bars and (bars[0], np.minimum(bars[1], 1.0))
    names = [f"mode {r}" for r in data["mode"].values]
    return canvas.panels_along(data, values, names, "MAC", bars)


def parameter_std(data: Dataset) -> Floats:
    """Return standard deviations (points, p) by errors of the data, or of the posterior; or NaN."""
    out = np.full(data["theta"].values.shape, np.nan)
    if "theta_std" in data:
        out = data["theta_std"].values
    elif "posterior_std" in data:
        out[data["label"].values == preferred(data.attrs)] = data["posterior_std"].values
    return np.where(np.isfinite(out), out, np.nan)


def unit_of(data: Dataset) -> tuple[Floats, str]:
    """Return units (p,) in which parameters are drawn beside each other, and their name."""
    nominal = data["theta"].values[data["kind"].values == "nominal"]
    if len(nominal) and (nominal[0] > 0).all():
        return nominal[0], "parameter over its nominal value"
    return np.ones(data.sizes["parameter"]), "parameter"


def minima(data: Dataset) -> canvas.Picture:
    """Return a line a minimum across the parameters; thin lines are equivalent models."""
    names, (unit, title) = canvas.names_of(data, "parameter", 18), unit_of(data)
    figure, axes = canvas.single(max(5.6, 0.45 * len(names)), 3.6)
    x, of = np.arange(len(names)), list(map(str, data["minimum_of"].values))
    colours = {
        name: canvas.COLOURS[k % len(canvas.COLOURS)] for k, name in enumerate(dict.fromkeys(of))
    }
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
    """Return parameters with deviations, their correlation, and the front with its scatter."""
    covariance = None  # of the parameters at the reference
    if "posterior_covariance" in data:
        covariance = np.asarray(data["posterior_covariance"].values)
    elif "theta_covariance" in data:
        covariance = np.asarray(data["theta_covariance"].values[position(data)])
        covariance = covariance if np.isfinite(covariance).all() else None
    scattered = data.sizes["group"] == 2 and "objective_covariance" in data
    parts = 1 + (covariance is not None) + scattered
    figure = canvas.picture(3.6 * parts, max(3.2, 0.26 * data.sizes["parameter"] + 1.2))
    row = list(figure.subplots(1, parts, squeeze=False)[0])
    _parameters(row[0], data)
    canvas.legend(figure, row.pop(0), "outside lower left", 3)
    if covariance is not None:
        _correlation(row.pop(0), data, covariance)
    if scattered:
        _ellipses(row.pop(0), data)
    return figure


def _parameters(axes: Axes, data: Dataset) -> None:
    unit, title = unit_of(data)
    std, theta = parameter_std(data) / unit, data["theta"].values / unit
    kinds, best = data["kind"].values, position(data)
    rows = [best, *np.flatnonzero(kinds == "edge").tolist()]
    names = canvas.names_of(data, "parameter", 18)
    y = np.arange(len(names))
    for k, i in enumerate(rows):
        shift = y + 0.7 * ((k + 0.5) / len(rows) - 0.5)
        colour = canvas.COLOURS[1] if i == best else canvas.COLOURS[(k - 1) % len(canvas.COLOURS)]
        if i != best and colour == canvas.COLOURS[1]:
            colour = "0.3"
        for width, reach in ((1.0, 2 * std[i]), (2.4, std[i])):
            axes.hlines(shift, theta[i] - reach, theta[i] + reach, colour, lw=width)
        label = canvas.short(data["label"].values[i])
        axes.plot(theta[i], shift, "o", color=colour, ms=4, label=label)
    axes.set_yticks(y, names)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.set_xlabel(title)
    axes.set_title("with 1 and 2 standard deviations", loc="left")


def _correlation(axes: Axes, data: Dataset, covariance: Floats) -> None:
    size = np.sqrt(np.maximum(np.diag(covariance), 0))
    scale = np.outer(size, size)
    r = np.divide(covariance, scale, out=np.zeros(covariance.shape), where=scale > 0)
    canvas.draw_matrix(axes, r, canvas.names_of(data, "parameter", 18), -1, "PuOr")
    axes.set_title(f"correlation at {canvas.short(preferred(data.attrs))}", loc="left")


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
        marks: dict[str, Any] = {
            "angle": angle,
            "fc": canvas.COLOURS[4],
            "ec": canvas.COLOURS[0],
            "alpha": 0.25,
        }
        axes.add_patch(Ellipse(error[i].tolist(), width, height, **marks))
    canvas.draw_models(axes, data, error, "nominal")
    first, second = canvas.names_of(data, "group")
    axes.set(xlabel=f"error of {first}", ylabel=f"error of {second}")
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
    labels, widely = [], False
    for y, (name, of) in enumerate(rows):
        value, known = of.values[best], of.values[chosen & np.isfinite(of.values)]
        positive = known[known > 0]
        widely |= bool(positive.size and positive.max() > 10 * positive.min())
        labels.append(f"{canvas.short(f'{name}, {of.place}: {of.variable.key}', 40)} ({value:.3g})")
        if not known.size or not value or np.isnan(value):
            continue
        std = np.nan if of.std is None else of.std
        std = np.exp(std) if of.variable.logarithmic else 1 + abs(std / value)
        ends = np.array([known.min(), known.max()])
        axes.plot(ends / value, [y, y], color=canvas.COLOURS[0], lw=5, alpha=0.5)
        axes.plot(known / value, [y] * known.size, "|", color=canvas.COLOURS[0], ms=5)
        axes.plot([1 / std, std], [y, y], "-|", color=canvas.COLOURS[1], lw=1.2, ms=8)
        axes.plot(1, y, "*", color=canvas.COLOURS[1], mec="k", mew=0.5, ms=9)
        axes.plot(of.values[nominal] / value, [y] * nominal.size, "X", color="0.4", ms=6)
    axes.set_yticks(range(len(rows)), labels)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    if widely:
        axes.set_xscale("log")
    label = canvas.short(data["label"].values[best])
    axes.set_xlabel(f"over that of {label} (its value in brackets)")
    axes.plot([], [], color=canvas.COLOURS[0], lw=5, alpha=0.5, label="Pareto-optimal models")
    axes.plot(
        [], [], "-*", color=canvas.COLOURS[1], mec="k", mew=0.5, ms=9, label=f"{label}, ± 1 std"
    )
    if nominal.size:
        axes.plot([], [], "X", color="0.4", ls="", label="nominal")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower left", ncols=3)
    return figure


def figures(data: Dataset) -> Iterator[tuple[str, canvas.Picture]]:
    """Yield a name and a picture of each prediction at all models."""
    for each in predictions_in(data):
        yield f"{each.kind.dimension} {each.name}", _page(data, each)


def _page(data: Dataset, of: RecordedPrediction) -> canvas.Picture:
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
        figure, axes = canvas.single(4.8, 3.3)
        axes.set(yscale="log", ylabel=variable.title)
        along = canvas.Along(data)
        bars = canvas.at_reference(data, np.log(values), std)
        for k, place in enumerate(places):
            colour = canvas.COLOURS[k % len(canvas.COLOURS)]
            along.draw(axes, values[:, k], colour, canvas.short(place, 18))
            if bars is not None:
                along.bars(axes, np.exp(bars[0][:, k]), np.exp(bars[1][:, k]), colour)
        along.finish(figure, [axes], 1)
    else:
        bars = canvas.at_reference(data, values, std)
        figure = canvas.panels_along(data, values, places, variable.title, bars)
    figure.suptitle(canvas.short(of.name + f" ({of.load})" * bool(of.load)), x=0.01, ha="left")
    return figure
