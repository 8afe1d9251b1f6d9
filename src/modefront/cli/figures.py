"""Figures of predictions along the front: points of the front on the abscissa.

One picture a quantity (frequencies and MAC have a panel a mode, peaks a panel a response, failure
probabilities a line a level), after figures 5 to 7 of Christodoulou et al. (2008,
doi:10.1016/j.cma.2008.04.010). Models with weights of their own stand beside the front, the
optimally weighted one with a bar of one standard deviation of its posterior to either side.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from modefront._typing import Bools, Floats
from modefront.errors import Fault, InputError, reason
from modefront.text import NAME, clean, file_name

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLUMNS = 3
WIDTH, HEIGHT = 3.0, 2.4
"""Of a panel, in inches."""

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00")
"""Told apart by the colour-blind (Okabe and Ito)."""

STYLE: Mapping[Any, Any] = {
    "font.size": 8.5,
    "figure.titlesize": 9.0,
    "axes.titlesize": 8.5,
    "axes.labelsize": 8.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "0.9",
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "legend.frameon": False,
    "svg.hashsalt": "modefront",
    "svg.fonttype": "path",
}


def write_figures(data: xr.Dataset, folder: Path) -> list[Path]:
    """Write the pictures into a folder and return their paths.

    Raises InputError where matplotlib is missing or the folder cannot be written to.
    """
    try:
        from matplotlib import rc_context
        from matplotlib.figure import Figure
    except ImportError:
        expected = "matplotlib, which `pip install modefront[figures]` brings"
        fault = Fault("modefront show", "--figures", expected, "no such package")
        raise InputError(fault) from None
    along = _Along.of(data)
    modes = [f"mode {r}" for r in data["mode"].values]
    measured = data["measured_frequency"].values
    pictures = {
        "frequencies": _Picture(
            *("", modes, "frequency, Hz", data["frequency"].values, measured),
            std=_posterior_std(data, "frequency"),
        ),
        "mac": _Picture("", modes, "MAC", data["mac"].values, std=_posterior_std(data, "mac")),
    }
    for name, positions in _parts(data, "frf").items():
        titles = [str(data["frf"].values[i]).removeprefix(f"{name}: ") for i in positions]
        title = f"{name} ({data['frf_load'].values[positions[0]]})"
        quantity = f"peak {data['frf_quantity'].values[positions[0]]}"
        std = _posterior_std(data, "frf_peak")
        pictures[f"frf {name}"] = _Picture(
            *(title, titles, quantity, data["frf_peak"].values[:, positions]),
            std=None if std is None else std[positions],
        )
    written: list[Path] = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with rc_context(dict(STYLE)):
            for name, picture in pictures.items():
                figure = Figure(figsize=picture.size, layout="constrained")
                along.panels(figure, picture)
                _save(figure, folder, name, written)
            for name, positions in _parts(data, "failure").items():
                figure = Figure(figsize=(4.8, 3.3), layout="constrained")
                along.levels(figure, data, name, positions)
                _save(figure, folder, f"failure {name}", written)
    except OSError as error:
        expected = "a folder that can be written to"
        raise InputError(Fault(str(folder), "folder", expected, reason(error))) from None
    return written


@dataclass(frozen=True)
class _Picture:
    """Values (points, panels) with the panels' titles, measured ones and posterior deviations."""

    title: str
    titles: Sequence[str]
    ylabel: str
    values: Floats
    measured: Floats | None = None
    std: Floats | None = None

    @property
    def columns(self) -> int:
        return min(COLUMNS, len(self.titles))

    @property
    def rows(self) -> int:
        return math.ceil(len(self.titles) / self.columns)

    @property
    def size(self) -> tuple[float, float]:
        return max(WIDTH * self.columns, 4.2), HEIGHT * self.rows + 0.35


class _Along:
    """The abscissa: front points by number, then models with weights of their own."""

    def __init__(
        self, front: list[int], others: list[int], labels: list[str], optimal: Bools, best: int
    ):
        self.front, self.others, self.optimal = front, others, optimal
        self.names = [plain(labels[i]).removesuffix("-weights") for i in others]
        self.best = best
        self.beside = len(front) + 1.6 + 1.6 * np.arange(len(others))

    @classmethod
    def of(cls, data: xr.Dataset) -> _Along:
        labels = [str(x) for x in data["label"].values]
        kinds = data["kind"].values.tolist()
        front = [i for i, kind in enumerate(kinds) if kind == "front"]
        along = ("front", "edge") if front else ()
        others = [i for i, kind in enumerate(kinds) if kind not in along]
        best = labels.index(str(data.attrs["reference"]))
        return cls(front, others, labels, np.asarray(data["pareto"].values, dtype=np.bool_), best)

    def panels(self, figure: Figure, picture: _Picture) -> None:
        """Draw a panel for each column of values."""
        grid = figure.subplots(picture.rows, picture.columns, squeeze=False).ravel()
        for axes in grid[len(picture.titles) :]:
            axes.remove()
        grid = grid[: len(picture.titles)]
        for i, (axes, title) in enumerate(zip(grid, picture.titles, strict=True)):
            self.draw(axes, picture.values[:, i], COLOURS[0], "model")
            if picture.std is not None:
                std = picture.std[i]
                self.bar(axes, picture.values[:, i] + np.array([[-std], [std]]), COLOURS[0])
            if picture.measured is not None and np.isfinite(picture.measured[i]):
                axes.axhline(picture.measured[i], color="k", ls="--", lw=1, label="measured")
            axes.set_title(plain(title), loc="left")
            if i % picture.columns == 0:
                axes.set_ylabel(picture.ylabel)
            # Small numbers with a power of ten beside the axis, and none as a difference.
            axes.ticklabel_format(axis="y", style="sci", scilimits=(-3, 4), useOffset=False)
        if picture.title:
            figure.suptitle(plain(picture.title))
        self.finish(figure, list(grid), picture.columns)

    def levels(self, figure: Figure, data: xr.Dataset, name: str, positions: Sequence[int]) -> None:
        """Draw the probabilities of failure of one prediction, a line a level."""
        axes = figure.subplots()
        for k, i in enumerate(positions):
            values = data["failure_probability"].values[:, i]
            label = f"b = {data['failure_level'].values[i]:g}"
            positive = np.where(values > 0, values, np.nan)
            self.draw(axes, positive, COLOURS[k % len(COLOURS)], label)
            std = _posterior_std(data, "failure_log")
            if std is not None:
                factors = np.exp([[-std[i]], [std[i]]])
                self.bar(axes, positive * factors, COLOURS[k % len(COLOURS)])
        axes.set_yscale("log")
        axes.set_ylabel("probability of failure")
        title = f"{name} ({data['failure_load'].values[positions[0]]})"
        axes.set_title(plain(title), loc="left")
        self.finish(figure, [axes], 1)

    def draw(self, axes: Axes, values: Floats, colour: str, label: str) -> None:
        """Draw values (points,): full where Pareto optimal, hollow where not."""
        x, y = np.arange(1, len(self.front) + 1), values[self.front]
        best = self.optimal[self.front]
        axes.plot(x, np.where(best, y, np.nan), "-", color=colour, lw=1, alpha=0.6)
        axes.plot(x[best], y[best], "o", color=colour, ms=4, label=label)
        axes.plot(x[~best], y[~best], "o", mfc="w", mec=colour, ms=4)
        axes.plot(self.beside, values[self.others], "D", color=colour, mec="k", mew=0.6, ms=5)

    def bar(self, axes: Axes, ends: Floats, colour: str) -> None:
        """Draw a bar at the optimally weighted model; ends are (2, points)."""
        x = self.beside[self.others.index(self.best)]
        axes.plot([x, x], ends[:, self.best], "-_", color=colour, lw=1.2, ms=6)

    def finish(self, figure: Figure, grid: Sequence[Axes], columns: int) -> None:
        """Put ticks and labels on the abscissae, and one legend below the panels."""
        from matplotlib.lines import Line2D

        n = len(self.front)
        step = max(1, math.ceil(n / 4 / 5) * 5) if n > 6 else 1
        marked = sorted({1, *range(step, n + 1, step)} - {0}) if n else []
        for i, axes in enumerate(grid):
            axes.set_xticks([*marked, *self.beside], [*map(str, marked), *self.names])
            for tick in axes.get_xticklabels()[len(marked) :]:
                tick.set(rotation=60, ha="right", rotation_mode="anchor")
            axes.grid(axis="x", visible=False)
            axes.set_xlim(0.2, (self.beside[-1] if self.others else n) + 0.8)
            if n and i + columns >= len(grid):
                axes.annotate(
                    "point of the front",
                    (0, 0),
                    xycoords="axes fraction",
                    xytext=(0, -20),
                    textcoords="offset points",
                    va="top",
                )
        handles, labels = grid[0].get_legend_handles_labels()
        hollow = Line2D([], [], ls="", marker="o", mfc="w", mec="0.3", ms=4)
        if not self.optimal[self.front].all():
            handles, labels = [*handles, hollow], [*labels, "dominated"]
        if len(labels) > 1:
            figure.legend(handles, labels, loc="outside lower center", ncols=min(4, len(labels)))


def _parts(data: xr.Dataset, dimension: str) -> dict[str, list[int]]:
    """Return the positions of each prediction along a dimension, by its name."""
    out: dict[str, list[int]] = {}
    for i, name in enumerate(data[f"{dimension}_name"].values if dimension in data.sizes else ()):
        out.setdefault(str(name), []).append(i)
    return out


def _posterior_std(data: xr.Dataset, name: str) -> Floats | None:
    """Return standard deviations of the posterior; None where there are none."""
    std = data.get(f"posterior_{name}_std")
    return None if std is None else np.asarray(std.values)


def plain(text: object) -> str:
    """Return a text that is not taken for mathematics."""
    return clean(text, NAME).replace("$", r"\$")


def _save(figure: Figure, folder: Path, name: str, written: list[Path]) -> None:
    """Write a picture under its name, with a number behind it where the name is taken."""
    path = folder / f"{file_name(name, [each.stem for each in written])}.svg"
    figure.savefig(path, metadata={"Date": None})
    written.append(path)
