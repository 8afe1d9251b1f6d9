"""Draws the figures of the documentation: python docs/figures.py."""

from __future__ import annotations

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from figures_of_knowledge import identifiability, uncertainty
from matplotlib.axes import Axes

import modefront as mf
from modefront._typing import Bools, Floats
from modefront.study.examples import write_example

HERE = Path(__file__).parent


def fronts(path: Path) -> None:
    """Draw the fronts of M0 and M1 in the space of errors."""
    plt.rcParams["svg.hashsalt"] = "modefront"
    figure, axes = plt.subplots(figsize=(6.4, 3.8))
    for configuration, colour in (("c0", "tab:blue"), ("c1", "tab:orange")):
        with tempfile.TemporaryDirectory() as folder:
            write_example(f"three-story-{configuration}", Path(folder))
            data = mf.run(mf.load(Path(folder) / "study.toml"), Path(folder) / "results")
        error, label = data["error"].values, data["label"].values
        nbi = np.array([name.startswith("nbi-") for name in label])
        optimal = data["pareto"].values
        name = f"M{configuration[1]}"
        axes.plot(*error[nbi & optimal].T, "o", color=colour, label=f"{name}, Pareto optimal")
        if (~optimal[nbi]).any():
            hidden = error[nbi & ~optimal].T
            axes.plot(*hidden, "o", color=colour, mfc="none", label=f"{name}, dominated")
        (best,) = np.flatnonzero(label == "optimal-weights")
        axes.plot(*error[best], "*", color=colour, ms=14, mec="k", label=f"{name}, optimal weights")
    axes.set(xlabel="error of frequencies, $e_1$", ylabel="error of mode shapes, $e_2$")
    axes.legend(frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def predictions(path: Path) -> None:
    """Draw what the models of the building predict along their fronts (some minutes of work)."""
    plt.rcParams["svg.hashsalt"] = "modefront"
    figure, grid = plt.subplots(2, 2, figsize=(7.2, 5.2), sharex=True, sharey="row")
    for column, configuration in enumerate(("c0", "c1")):
        upper, lower = grid[:, column]
        for kind, name, colour in (("", "", "tab:blue"), ("fe-", "_FE", "tab:orange")):
            data = predicted(f"three-story-{kind}{configuration}")
            front = data.isel(point=[x.startswith("nbi-") for x in data["label"].values])
            optimal = front["pareto"].values
            peak = front["frf_peak"].sel(frf="force at floor 3: floor1").values
            along(upper, 1e3 * peak, optimal, colour, "o", f"M{column}{name}")
            for level, marker in (("3e-05", "o"), ("4e-05", "s")):
                P = front["failure_probability"].sel(failure=f"noise at floor 1: {level}").values
                along(lower, P, optimal, colour, marker, "")
        upper.set_title(f"configuration C{column}", loc="left", fontsize=10)
        upper.legend(frameon=False, fontsize=9)
        lower.set(yscale="log", xticks=[1, 5, 10, 15, 20], xlabel="point of the front")
        for axes in (upper, lower):
            axes.spines[["top", "right"]].set_visible(False)
    for marker, b in (("o", "0.03 mm"), ("s", "0.04 mm")):
        grid[1, 0].plot([], [], marker, color="0.4", ms=4.5, label=f"b = {b}")
    grid[1, 0].legend(frameon=False, fontsize=9, loc="lower left")
    grid[0, 0].set_ylabel("peak receptance of floor 1, mm/N")
    grid[1, 0].set_ylabel("probability of failure")
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def along(axes: Axes, y: Floats, optimal: Bools, colour: str, marker: str, label: str) -> None:
    """Draw values along the front, hollow where another point dominates."""
    x = np.arange(1, y.size + 1)
    axes.plot(x, np.where(optimal, y, np.nan), "-", color=colour, lw=1, alpha=0.6)
    axes.plot(x[optimal], y[optimal], marker, color=colour, ms=4.5, label=label or None)
    axes.plot(x[~optimal], y[~optimal], marker, color=colour, ms=4.5, mfc="none")


def predicted(example: str) -> xr.Dataset:
    """Return the results of an example with the predictions of ``predictions.toml``."""
    with tempfile.TemporaryDirectory() as folder:
        write_example(example, Path(folder))
        study = Path(folder) / "study.toml"
        study.write_text(study.read_text() + (HERE / "predictions.toml").read_text())
        return mf.run(mf.load(study), Path(folder) / "results")


if __name__ == "__main__":
    fronts(HERE / "fronts.svg")
    identifiability(HERE / "identifiability.svg")
    uncertainty(HERE / "uncertainty.svg")
    predictions(HERE / "predictions.svg")
