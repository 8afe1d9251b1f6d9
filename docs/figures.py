"""Draws the figures of the documentation: python docs/figures.py."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import scipy.linalg
import xarray as xr
from figures_of_knowledge import identifiability, uncertainty
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import modefront as mf
from modefront._typing import Bools, Floats
from modefront.front.dominance import nondominated
from modefront.front.point import front_points
from modefront.study.examples import write_example

HERE = Path(__file__).parent


def fronts(path: Path) -> None:
    """Draw the fronts of M0 and M1 in the space of errors."""
    figure, axes = plt.subplots(figsize=(6.4, 3.8))
    for configuration, colour in (("c0", "tab:blue"), ("c1", "tab:orange")):
        with tempfile.TemporaryDirectory() as folder:
            write_example(f"three-story-{configuration}", Path(folder))
            data = mf.run(mf.load(Path(folder) / "study.toml"), Path(folder) / "results").dataset
        error, kind = data["error"].values, data["kind"].values
        nbi = kind == "front"
        optimal = data["pareto"].values
        name = f"M{configuration[1]}"
        axes.plot(*error[nbi & optimal].T, "o", color=colour, label=f"{name}, Pareto optimal")
        if (~optimal[nbi]).any():
            hidden = error[nbi & ~optimal].T
            axes.plot(*hidden, "o", color=colour, mfc="none", label=f"{name}, dominated")
        (best,) = np.flatnonzero(kind == "optimal-weights")
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
        for model, name, colour in (("", "", "tab:blue"), ("fe-", "_FE", "tab:orange")):
            data = predicted(f"three-story-{model}{configuration}")
            front = data.isel(point=front_points(data))
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
        return mf.run(mf.load(study), Path(folder) / "results").dataset


def example(configuration: str) -> mf.UpdatingProblem:
    """Return the problem of one of the three-story examples."""
    with tempfile.TemporaryDirectory() as folder:
        write_example(f"three-story-{configuration}", Path(folder))
        return mf.load(Path(folder) / "study.toml").problem


def points(data: xr.Dataset) -> tuple[Floats, Bools]:
    """Return the objectives of the points of the front, and which are Pareto optimal."""
    front = front_points(data)
    return data["objective"].values[front], data["pareto"].values[front]


def draw_front(axes: Axes, dense: xr.Dataset) -> None:
    """Draw each piece of a refined front of two objectives as a line."""
    J, _ = points(dense)
    piece = dense["piece"].values[front_points(dense)]
    for k in range(1, piece.max() + 1):
        axes.plot(*J[piece == k].T, "-", color="0.6", label="front" if k == 1 else None)


def finish(figure: Figure, axes: Axes, path: Path) -> None:
    """Label the axes of two objectives and write the figure."""
    axes.set(xlabel="frequencies, $J_1$", ylabel="mode shapes, $J_2$")
    axes.legend(frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})
    plt.close(figure)


def normals(path: Path, dense: xr.Dataset) -> None:
    """Draw the simplex of M0, the normals and where they meet the boundary."""
    figure, axes = plt.subplots(figsize=(6.4, 3.8))
    J, optimal = points(mf.solve(example("c0"), seed=1).dataset)
    draw_front(axes, dense)
    beta = np.linspace(1, 0, len(J))[:, None]
    simplex = beta * J[0] + (1 - beta) * J[-1]
    axes.plot(*simplex.T, "--", color="k", lw=0.8, label="simplex between the edges")
    for start, end in zip(simplex, J, strict=True):
        axes.plot(*np.array([start, end]).T, color="k", lw=0.4)
    axes.plot(*J[optimal].T, "o", color="tab:blue", label="Pareto optimal")
    axes.plot(*J[~optimal].T, "o", color="tab:blue", mfc="none", label="dominated")
    finish(figure, axes, path)


def beside(path: Path, dense: xr.Dataset, method: str, label: str) -> None:
    """Draw the points of another method on the front of M0."""
    figure, axes = plt.subplots(figsize=(6.4, 3.8))
    draw_front(axes, dense)
    J, optimal = points(mf.solve(example("c0"), method=method, evaluations=2000, seed=1).dataset)
    axes.plot(*J[optimal].T, "o", ms=4, color="tab:red", label=label)
    axes.set(xlim=(-3e-4, 7e-3), ylim=(-0.04, 1.0))
    finish(figure, axes, path)


def three_groups(path: Path) -> None:
    """Draw a front of three groups as seen along the normal of its simplex."""
    base = example("c1")
    groups = (
        mf.Group("frequencies", frequency="all"),
        mf.Group("shape 1", shape=[1]),
        mf.Group("shapes 2 and 3", shape=[2, 3]),
    )
    problem = mf.UpdatingProblem(base.model, base.data, groups, base.lower, base.upper, base.start)
    data = mf.solve(problem, points=12, seed=1).dataset
    J, _ = points(data)
    # One edge is nearly the best in two groups, so the simplex is the one of the ranges.
    single = np.isin(data["minimum_of"].values, data["group"].values)
    minima = data["minimum_objective"].values[single]
    minima = minima[nondominated(minima)]
    utopia, scale = minima.min(axis=0), np.ptp(minima, axis=0)
    across = scipy.linalg.null_space(np.ones((1, 3)))
    corners, seen = across, ((J - utopia) / scale) @ across
    figure, axes = plt.subplots(figsize=(6.4, 4.2))
    axes.fill(*corners.T, facecolor="0.9", edgecolor="k", lw=0.8, label="simplex")
    within = 12 * 13 // 2
    axes.plot(*seen[:within].T, "o", color="tab:blue", label="from the simplex")
    axes.plot(*seen[within:].T, "o", color="tab:orange", ms=4, label="beyond it")
    axes.legend(frameon=False)
    axes.set_aspect("equal")
    axes.set_axis_off()
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})
    plt.close(figure)


def weights(path: Path, dense: xr.Dataset) -> None:
    """Draw the equally and the optimally weighted model on the front of M0."""
    figure, axes = plt.subplots(figsize=(6.4, 3.8))
    draw_front(axes, dense)
    for kind, mark in (("equal-weights", "s"), ("optimal-weights", "*")):
        (J,) = dense["objective"].values[dense["kind"].values == kind]
        name = kind.replace("-", " ")
        axes.plot(*J, mark, ms=10, mec="k", label=f"{name}, J = ({J[0]:.2e}, {J[1]:.2e})")
    finish(figure, axes, path)


def reduced(source: Path, path: Path) -> None:
    """Draw what a whole study costs over one full eigensolution, from lines of the benchmark."""
    rows = [json.loads(line) for line in source.read_text().splitlines()]
    plt.rcParams["svg.hashsalt"] = "modefront"
    figure, axes = plt.subplots(figsize=(6.4, 3.8))
    kinds = sorted({row["kind"] for row in rows})
    for kind, colour in zip(kinds, ("tab:blue", "tab:orange"), strict=False):
        chosen = sorted((row for row in rows if row["kind"] == kind), key=lambda row: row["size"])
        size = [row["size"] for row in chosen]
        ratio = [row["work"] / row["modes"] for row in chosen]
        count = [row["full_eigensolutions"] for row in chosen]
        axes.loglog(size, ratio, "o-", color=colour, label=f"{kind}: time of the whole study")
        axes.loglog(size, count, "s:", color=colour, mfc="none", label=f"{kind}: full solutions")
    axes.set(xlabel="degrees of freedom", ylabel="over one full eigensolution")
    axes.legend(frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


if __name__ == "__main__":
    plt.rcParams["svg.hashsalt"] = "modefront"
    fronts(HERE / "fronts.svg")
    identifiability(HERE / "identifiability.svg")
    uncertainty(HERE / "uncertainty.svg")
    predictions(HERE / "predictions.svg")
    refined = mf.solve(example("c0"), refined=0.01, seed=1).dataset
    pages = HERE / "methods"
    normals(pages / "nbi.svg", refined)
    three_groups(pages / "three-groups.svg")
    weights(pages / "weighted.svg", refined)
    beside(pages / "weight-sweep.svg", refined, "weights", "weight sweep, 20 points")
    beside(pages / "evolutionary.svg", refined, "spea2", "SPEA2, 2,000 evaluations")
    reduced(HERE.parent / "benchmarks" / "reduced.jsonl", HERE / "reduced.svg")
