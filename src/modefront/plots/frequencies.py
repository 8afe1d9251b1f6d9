"""Frequencies of all models beside the measured ones."""

from __future__ import annotations

import numpy as np
import xarray as xr

from modefront.plots.along import Along, across, titled
from modefront.plots.canvas import Picture, panels
from modefront.plots.models import is_path
from modefront.plots.style import COLUMNS


def draw(data: xr.Dataset) -> Picture:
    """Return a panel a mode with the measured frequency, or errors in % across the modes."""
    f, measured = data["frequency"].values, data["measured_frequency"].values
    names = [f"mode {r}" for r in data["mode"].values]
    if not is_path(data):
        error = 100 * (f / measured - 1)
        return across(data, error, names, "error of the frequency, %", line=0)
    along = Along(data)
    std = data.get("posterior_frequency_std")
    figure, grid = panels(len(names))
    for r, (axes, name) in enumerate(zip(grid, names, strict=True)):
        along.draw(axes, f[:, r])
        if std is not None:
            x, s = f[along.best, r], float(std.values[r])
            along.bar(axes, along.at_best(x - s, x + s))
        if np.isfinite(measured[r]):
            axes.axhline(measured[r], color="k", ls="--", lw=1, label="measured")
        titled(axes, name)
        if r % COLUMNS == 0:
            axes.set_ylabel("frequency, Hz")
    along.finish(figure, grid, min(COLUMNS, len(grid)))
    return figure
