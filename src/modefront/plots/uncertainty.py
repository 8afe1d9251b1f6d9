"""Scatter of the models by errors of the data: parameters, their correlation, the front."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.patches import Ellipse

from modefront._typing import Floats
from modefront.front.point import preferred
from modefront.plots.canvas import COLOURS, Picture, legend, picture, plain, short
from modefront.plots.models import draw_models, front_of, reference_of
from modefront.plots.quantities import parameter_std, unit_of

HOW_MANY = 20
"""Parameters up to which the correlations are written as numbers."""


def uncertainty(data: xr.Dataset) -> Picture:
    """Return parameters with deviations, their correlation, and the front with its scatter."""
    covariance = None  # of the parameters at the reference
    if "posterior_covariance" in data:
        covariance = np.asarray(data["posterior_covariance"].values)
    elif "theta_covariance" in data:
        covariance = np.asarray(data["theta_covariance"].values[reference_of(data)])
        covariance = covariance if np.isfinite(covariance).all() else None
    scattered = data.sizes["group"] == 2 and "objective_covariance" in data
    parts = 1 + (covariance is not None) + scattered
    figure = picture(3.6 * parts, max(3.2, 0.26 * data.sizes["parameter"] + 1.2))
    row = list(figure.subplots(1, parts, squeeze=False)[0])
    _parameters(row[0], data)
    legend(figure, row.pop(0), "outside lower left", 3)
    if covariance is not None:
        _correlation(row.pop(0), data, covariance)
    if scattered:
        _ellipses(row.pop(0), data)
    return figure


def _parameters(axes: Axes, data: xr.Dataset) -> None:
    unit, title = unit_of(data)
    std, theta = parameter_std(data) / unit, data["theta"].values / unit
    kinds, best = data["kind"].values, reference_of(data)
    rows = [best, *np.flatnonzero(kinds == "edge").tolist()]
    names = [short(name) for name in data["parameter"].values]
    y = np.arange(len(names))
    for k, i in enumerate(rows):
        shift = y + 0.7 * ((k + 0.5) / len(rows) - 0.5)
        colour = COLOURS[1] if i == best else COLOURS[(k - 1) % len(COLOURS)]
        if i != best and colour == COLOURS[1]:
            colour = "0.3"
        for width, factor in ((1.0, 2), (2.4, 1)):
            axes.hlines(
                shift, theta[i] - factor * std[i], theta[i] + factor * std[i], colour, lw=width
            )
        label = plain(data["label"].values[i])
        axes.plot(theta[i], shift, "o", color=colour, ms=4, label=label)
    axes.set_yticks(y, names)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.set_xlabel(title)
    axes.set_title("with 1 and 2 standard deviations", loc="left")


def _correlation(axes: Axes, data: xr.Dataset, covariance: Floats) -> None:
    size = np.sqrt(np.maximum(np.diag(covariance), 0))
    scale = np.outer(size, size)
    r = np.divide(covariance, scale, out=np.zeros(covariance.shape), where=scale > 0)
    names = [short(name) for name in data["parameter"].values]
    axes.imshow(r, vmin=-1, vmax=1, cmap="PuOr")
    axes.grid(False)
    axes.set_xticks(range(len(names)), names, rotation=90)
    axes.set_yticks(range(len(names)), names)
    if len(names) <= HOW_MANY // 2:
        for (i, j), value in np.ndenumerate(r):
            shade = "w" if abs(value) > 0.6 else "k"
            axes.text(j, i, f"{value:.2f}", ha="center", va="center", fontsize=6.5, color=shade)
    axes.set_title(f"correlation at {plain(preferred(data.attrs))}", loc="left")


def _ellipses(axes: Axes, data: xr.Dataset) -> None:
    """Draw the front with ellipses of one standard deviation of the errors e = sqrt(J / a)."""
    error, C = data["error"].values, data["objective_covariance"].values
    J = data["objective"].values
    ratio = np.divide(error, 2 * J, out=np.full(J.shape, np.nan), where=J > 0)  # de / dJ
    for i in front_of(data).tolist():
        S = C[i] * np.outer(ratio[i], ratio[i])
        # Where a group is fitted exactly, e has no derivative and no ellipse.
        if not np.isfinite(S).all() or (np.sqrt(np.diag(S)) > error[i]).any():
            continue
        values, vectors = np.linalg.eigh(S)
        width, height = 2 * np.sqrt(np.maximum(values, 0))
        angle = float(np.degrees(np.arctan2(vectors[1, 0], vectors[0, 0])))
        centre = (float(error[i, 0]), float(error[i, 1]))
        axes.add_patch(
            Ellipse(centre, width, height, angle=angle, fc=COLOURS[4], ec=COLOURS[0], alpha=0.25)
        )
    draw_models(axes, data, error, "nominal")
    first, second = (plain(name) for name in data["group"].values)
    axes.set(xlabel=f"error of {first}", ylabel=f"error of {second}")
    axes.set_title("front with its scatter", loc="left")
