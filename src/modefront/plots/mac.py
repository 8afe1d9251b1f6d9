"""MAC values of all models with the measured modes."""

from __future__ import annotations

import xarray as xr

from modefront.plots.along import Along, across, titled
from modefront.plots.canvas import Picture, panels
from modefront.plots.models import is_path
from modefront.plots.style import COLUMNS


def draw(data: xr.Dataset) -> Picture:
    """Return a panel a mode, or lines across the modes."""
    mac = data["mac"].values
    names = [f"mode {r}" for r in data["mode"].values]
    if not is_path(data):
        return across(data, mac, names, "MAC", line=1)
    along = Along(data)
    std = data.get("posterior_mac_std")
    figure, grid = panels(len(names))
    for r, (axes, name) in enumerate(zip(grid, names, strict=True)):
        along.draw(axes, mac[:, r])
        if std is not None:
            x, s = mac[along.best, r], float(std.values[r])
            along.bar(axes, along.at_best(x - s, min(x + s, 1.0)))
        titled(axes, name)
        if r % COLUMNS == 0:
            axes.set_ylabel("MAC")
    along.finish(figure, grid, min(COLUMNS, len(grid)))
    return figure
