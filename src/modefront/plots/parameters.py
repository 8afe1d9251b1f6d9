"""Parameters of all models: along the front, or as parallel coordinates."""

from __future__ import annotations

import numpy as np
import xarray as xr

from modefront._typing import Floats
from modefront.front.point import preferred
from modefront.plots.along import Along, Bar, across, titled
from modefront.plots.canvas import Picture, panels
from modefront.plots.models import is_path
from modefront.plots.style import COLUMNS


def draw(data: xr.Dataset) -> Picture:
    """Return a panel a parameter with one standard deviation, or lines across parameters.

    Lines are in units of the nominal values, where these are above zero.
    """
    theta, std = data["theta"].values, parameter_std(data)
    names = [str(name) for name in data["parameter"].values]
    if not is_path(data):
        unit, title = unit_of(data)
        return across(data, theta / unit, names, title, width=0.45)
    along = Along(data)
    figure, grid = panels(len(names))
    bounds = data["bounds"].values
    for j, (axes, name) in enumerate(zip(grid, names, strict=True)):
        along.draw(axes, theta[:, j])
        along.bar(axes, Bar(theta[:, j] - std[:, j], theta[:, j] + std[:, j]))
        low, high = axes.get_ylim()
        for bound in bounds[j]:
            if low - 0.1 * (high - low) <= bound <= high + 0.1 * (high - low):
                axes.axhline(bound, color="k", ls=":", lw=1, label="bound")
        titled(axes, name)
    along.finish(figure, grid, min(COLUMNS, len(grid)))
    return figure


def parameter_std(data: xr.Dataset) -> Floats:
    """Return standard deviations (points, p) by errors of the data, or of the posterior; or NaN."""
    if "theta_std" in data:
        return np.where(np.isfinite(data["theta_std"].values), data["theta_std"].values, np.nan)
    out = np.full(data["theta"].shape, np.nan)
    if "posterior_std" in data:
        best = data["label"].values == preferred(data.attrs)
        std = data["posterior_std"].values
        out[best] = np.where(np.isfinite(std), std, np.nan)
    return out


def unit_of(data: xr.Dataset) -> tuple[Floats, str]:
    """Return units (p,) in which parameters are drawn beside each other, and their name."""
    nominal = data["theta"].values[data["kind"].values == "nominal"]
    if len(nominal) and (nominal[0] > 0).all():
        return nominal[0], "parameter over its nominal value"
    return np.ones(data.sizes["parameter"]), "parameter"
