"""Parallel coordinates: a line a model across quantities, for fronts of any number of groups."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes

from modefront._typing import Floats
from modefront.front.point import Kind
from modefront.plots.models import reference_of, shown
from modefront.plots.style import COLOURS, MAP, short


def parallel(axes: Axes, data: xr.Dataset, values: Floats, names: Sequence[str]) -> None:
    """Draw values (points, quantities); thin lines are Pareto-optimal models.

    Their colour is their error of the first group. The reference is red, the nominal model dashed.
    """
    x = np.arange(len(names))
    chosen = np.flatnonzero(shown(data))
    error = data["error"].values[chosen, 0]
    span = np.ptp(error) or 1.0
    colours = colormaps[MAP]((error - error.min()) / span)
    best = reference_of(data)
    marker = "o" if len(names) < 2 else ""
    for i, colour in zip(chosen.tolist(), colours, strict=True):
        axes.plot(x, values[i], "-", color=colour, lw=0.8, alpha=0.8, marker=marker, ms=3)
    nominal = np.flatnonzero(data["kind"].values == Kind.NOMINAL.value)
    for i in nominal.tolist():
        axes.plot(x, values[i], "--X", color="0.4", lw=1, ms=5, label="nominal")
    label = str(data["label"].values[best]).replace("-", " ")
    axes.plot(
        x, values[best], "-*", color=COLOURS[1], mec="k", mew=0.5, ms=8, lw=1.6, label=short(label)
    )
    axes.plot([], [], "-", color=colormaps[MAP](0.5), lw=0.8, label="Pareto-optimal models")
    turned = len(names) > 6 or max(map(len, names), default=0) > 8
    axes.set_xticks(
        x,
        [short(name) for name in names],
        rotation=60 if turned else 0,
        ha="right" if turned else "center",
        rotation_mode="anchor",
    )
    axes.set_xlim(-0.3, max(len(names) - 0.7, 0.3))


def key(axes: Axes, data: xr.Dataset) -> None:
    """Draw the colours of the lines beside the axes, and a legend above."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    error = data["error"].values[shown(data), 0]
    figure = axes.get_figure()
    if figure is not None and np.ptp(error) > 0:
        scale = ScalarMappable(Normalize(error.min(), error.max()), MAP)
        bar = figure.colorbar(scale, ax=axes, pad=0.01, fraction=0.04)
        bar.set_label(f"error of {short(data['group'].values[0])}")
    handles, labels = axes.get_legend_handles_labels()
    if figure is not None:
        figure.legend(handles, labels, loc="outside upper left", ncols=3)
