"""All minima that were found, and models that fit equally well."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.ticker import LogLocator, NullFormatter

from modefront.plots.canvas import COLOURS, Picture, legend, picture, plain, short
from modefront.plots.quantities import unit_of


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
