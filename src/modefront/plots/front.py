"""The front in the space of errors: two axes, or all pairs."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from modefront._typing import Floats
from modefront.front.methods import METHODS
from modefront.plots.canvas import (
    COLOURS,
    Picture,
    branches,
    draw_models,
    is_path,
    names_of,
    picture,
    plain,
    short,
    shown,
    single,
)

FAR = 2.5
"""Error over the greatest of the Pareto-optimal models from which a model is beyond the axes."""


def front(data: xr.Dataset, *, log: bool = False) -> Picture:
    """Return the front in the space of errors, with logarithmic axes if ``log``."""
    error = data["error"].values
    if log:
        error = np.maximum(error, 1e-4 * np.nanmax(error))
    groups = names_of(data, "group")
    if len(groups) == 1:
        return _one(data, error, groups[0])
    if len(groups) == 2:
        return _two(data, error, groups, log=log)
    return _many(data, error, groups, log=log)


def _one(data: xr.Dataset, error: Floats, group: str) -> Picture:
    labels = names_of(data, "label", 24)
    figure, axes = single(4.6, 0.9 + 0.25 * len(labels))
    draw_models(axes, data, np.column_stack([error[:, 0], np.arange(len(labels))]))
    axes.set_yticks(range(len(labels)), labels)
    axes.invert_yaxis()
    axes.set_xlabel(f"error of {group}")
    axes.locator_params(axis="x", nbins=5)
    return figure


def _two(data: xr.Dataset, error: Floats, groups: list[str], *, log: bool) -> Picture:
    figure, axes = single(5.2, 4.0)
    method = METHODS.get(data.attrs["method"])
    if is_path(data) and method is not None and method.programme is not None:
        for branch in branches(data):
            axes.plot(*error[branch].T, "-", color=COLOURS[0], lw=1, alpha=0.5)
    draw_models(axes, data, error)
    axes.set(xlabel=f"error of {groups[0]}", ylabel=f"error of {groups[1]}")
    if log:
        axes.set(xscale="log", yscale="log")
    else:
        _limits(axes, data, error)
    axes.legend()
    return figure


def _limits(axes: Axes, data: xr.Dataset, error: Floats) -> None:
    """Leave far models out that are not Pareto optimal, and note their number."""
    chosen = shown(data)
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
        text = f"{plain(data['label'].values[i])} ({error[i, 0]:.3g}, {error[i, 1]:.3g})"
    axes.set_title(f"beyond the axes: {text}", loc="right", color="0.35")


def _many(data: xr.Dataset, error: Floats, groups: list[str], *, log: bool) -> Picture:
    """Draw all pairs of errors."""
    n = len(groups)
    size = 2.1 if n < 6 else 1.5
    figure = picture(max(size * (n - 1), 5.2), size * (n - 1) + 0.2)
    grid = figure.subplots(n - 1, n - 1, squeeze=False, sharex="col", sharey="row")
    for i in range(1, n):
        for j in range(n - 1):
            axes = grid[i - 1][j]
            if j >= i:
                axes.remove()
                continue
            draw_models(axes, data, error[:, [j, i]])
            if log:
                axes.set(xscale="log", yscale="log")
            if i == n - 1:
                axes.set_xlabel(f"error of {short(groups[j])}")
            if j == 0:
                axes.set_ylabel(f"error of {short(groups[i])}")
    handles, labels = grid[0][0].get_legend_handles_labels()
    once = dict(zip(labels, handles, strict=True))
    figure.legend(once.values(), once.keys(), loc="upper right")
    return figure
