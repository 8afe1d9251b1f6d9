"""Parameters, frequencies and MAC of all models: along the front, or as parallel coordinates.

Likewise all minima that were found, and models that fit equally well.
"""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullFormatter

from modefront._typing import Floats
from modefront.front.point import preferred
from modefront.plots.along import across, at_reference, panels_along
from modefront.plots.canvas import COLOURS, Picture, legend, picture, plain, short
from modefront.plots.models import is_path


def parameters(data: xr.Dataset) -> Picture:
    """Return a panel a parameter with one standard deviation, or lines across parameters.

    Lines are in units of the nominal values, where these are above zero.
    """
    theta, bounds = data["theta"].values, data["bounds"].values
    names = [str(name) for name in data["parameter"].values]
    if not is_path(data):
        unit, title = unit_of(data)
        return across(data, theta / unit, names, title, width=0.45)

    def mark(axes: Axes, j: int) -> None:
        low, high = axes.get_ylim()
        for bound in bounds[j]:
            if low - 0.1 * (high - low) <= bound <= high + 0.1 * (high - low):
                axes.axhline(bound, color="k", ls=":", lw=1, label="bound")

    std = parameter_std(data)
    return panels_along(data, theta, names, bars=(theta - std, theta + std), mark=mark)


def frequencies(data: xr.Dataset) -> Picture:
    """Return a panel a mode with the measured frequency, or errors in % across the modes."""
    f, measured = data["frequency"].values, data["measured_frequency"].values
    if not is_path(data):
        error = 100 * (f / measured - 1)
        return across(data, error, _modes(data), "error of the frequency, %", line=0)

    def mark(axes: Axes, r: int) -> None:
        if np.isfinite(measured[r]):
            axes.axhline(measured[r], color="k", ls="--", lw=1, label="measured")

    bars = at_reference(data, f, data.get("posterior_frequency_std"))
    return panels_along(data, f, _modes(data), "frequency, Hz", bars, mark)


def mac(data: xr.Dataset) -> Picture:
    """Return a panel a mode with MAC values, or lines across the modes."""
    values = data["mac"].values
    if not is_path(data):
        return across(data, values, _modes(data), "MAC", line=1)
    bars = at_reference(data, values, data.get("posterior_mac_std"))
    bars = bars and (bars[0], np.minimum(bars[1], 1.0))
    return panels_along(data, values, _modes(data), "MAC", bars)


def _modes(data: xr.Dataset) -> list[str]:
    return [f"mode {r}" for r in data["mode"].values]


def parameter_std(data: xr.Dataset) -> Floats:
    """Return standard deviations (points, p) by errors of the data, or of the posterior; or NaN."""
    out = np.full(data["theta"].shape, np.nan)
    if "theta_std" in data:
        out = data["theta_std"].values
    elif "posterior_std" in data:
        out[data["label"].values == preferred(data.attrs)] = data["posterior_std"].values
    return np.where(np.isfinite(out), out, np.nan)


def unit_of(data: xr.Dataset) -> tuple[Floats, str]:
    """Return units (p,) in which parameters are drawn beside each other, and their name."""
    nominal = data["theta"].values[data["kind"].values == "nominal"]
    if len(nominal) and (nominal[0] > 0).all():
        return nominal[0], "parameter over its nominal value"
    return np.ones(data.sizes["parameter"]), "parameter"


def minima(data: xr.Dataset) -> Picture:
    """Return a line a minimum across the parameters; thin lines are equivalent models."""
    names = [short(name) for name in data["parameter"].values]
    unit, title = unit_of(data)
    figure = picture(max(5.6, 0.45 * len(names)), 3.6)
    axes = figure.add_subplot()
    x = np.arange(len(names))
    of = [str(each) for each in data["minimum_of"].values]
    colours = {name: COLOURS[k % len(COLOURS)] for k, name in enumerate(dict.fromkeys(of))}
    if "equal_of" in data:
        for name, theta in zip(data["equal_of"].values, data["equal_theta"].values, strict=True):
            axes.plot(x, theta / unit, "-", color=colours.get(str(name), "0.6"), lw=0.5, alpha=0.35)
    known: set[str] = set()
    for name, theta in zip(of, data["minimum_theta"].values, strict=True):
        label = "" if name in known else plain(name)
        known.add(name)
        axes.plot(x, theta / unit, "-o", color=colours[name], lw=1.4, ms=4.5, label=label or None)
    bounds = data["bounds"].values / unit[:, None]
    axes.plot(x, bounds[:, 0], "_", color="k", ms=10)
    axes.plot(x, bounds[:, 1], "_", color="k", ms=10, label="bounds")
    if (bounds > 0).all():
        axes.set_yscale("log")
        axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.yaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_minor_formatter(NullFormatter())
    axes.set_xticks(x, names, rotation=60 if len(names) > 6 else 0)
    axes.set_ylabel(title)
    legend(figure, axes, "outside upper left", 4)
    return figure
