"""Figures of what data determine and how far their errors reach; drawn by figures.py."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

import modefront as mf
from modefront.study.examples import write_example

Floats = npt.NDArray[np.float64]

STD = 0.005, 0.02
"""Assumed standard deviations: of frequencies, relative; of shapes, over their greatest part."""


def identifiability(path: Path) -> None:
    """Draw models that fit the shapes equally well, and a front with its flat part cut off."""
    _, (left, right) = plt.subplots(1, 2, figsize=(8.6, 3.8))
    chain = example("three-story-c0")
    data = mf.solve(chain, points=20, seed=1).dataset
    equal = data["equal_of"].values == "shapes"
    theta = data["equal_theta"].values[equal]
    left.plot(theta[:, 0], theta[:, 1], ".-", color="tab:orange", label="equally good in shapes")
    exact = data["equal_of"].values == "frequencies"
    theta = data["equal_theta"].values[exact]
    left.plot(theta[:, 0], theta[:, 1], "s", color="tab:green", label="exact in frequencies")
    front = data["theta"].values[data["front_part"].values == "whole"]
    left.plot(front[:, 0], front[:, 1], "o", ms=4, color="tab:blue", label="front of M0")
    left.set(xlabel=r"$\theta_1$", ylabel=r"$\theta_2$", xlim=(0, 5), ylim=(0, 5))
    left.legend(frameon=False)

    plates = mf.solve(example("three-story-fe-c0"), points=20, seed=1).dataset
    for part, style in (("whole", {"mfc": "none"}), ("identifiable", {})):
        error = plates["error"].values[plates["front_part"].values == part]
        right.plot(*error.T, "o", ms=5, color="tab:blue", label=f"M0_FE, {part} front", **style)
    right.set(xlabel="error of frequencies, $e_1$", ylabel="error of mode shapes, $e_2$")
    right.legend(frameon=False)
    finish(path, left, right)


def uncertainty(path: Path) -> None:
    """Draw the scatter of a front, linearised and drawn, and a posterior beside its integral."""
    _, (left, right) = plt.subplots(1, 2, figsize=(8.6, 3.8))
    problem = example("three-story-c0")
    known = replace(
        problem.data,
        frequency_std=STD[0] * problem.data.frequency,
        shape_std=STD[1] * np.abs(problem.data.shape).max(axis=2, keepdims=True)
        + 0 * problem.data.shape,
    )
    problem = replace(problem, data=known)
    data = mf.solve(
        problem, points=20, seed=1, uncertainty=mf.Uncertainty("std", bootstrap=60)
    ).dataset
    whole = np.flatnonzero((data["front_part"].values == "whole") & data["pareto"].values)
    drawn = data["bootstrap_theta"].values[:, whole]
    left.plot(*drawn.reshape(-1, 3)[:, :2].T, ".", ms=2, color="0.7", label="data drawn again")
    theta = data["theta"].values[whole]
    for i, point in zip(whole, theta, strict=True):
        C = data["theta_covariance"].values[i, :2, :2]
        left.plot(*ellipse(point[:2], C), color="tab:blue", lw=0.8)
    left.plot(*theta[:, :2].T, "o", ms=4, color="tab:blue", label="front of M0, linearised")
    left.set(xlabel=r"$\theta_1$", ylabel=r"$\theta_2$", xlim=(0.85, 1.4), ylim=(0.6, 1.35))
    left.legend(frameon=False)

    (best,) = data["theta"].values[data["kind"].values == "optimal-weights"]
    C = data["posterior_covariance"].values
    axis, density = marginal(problem, best, C)
    levels = density.max() * np.exp([-2.0, -0.5])  # what the two ellipses are of a Gaussian
    right.contour(*axis, density.T, levels=levels, colors="0.6")
    for size in (1, 2):
        name = "Laplace" if size == 1 else None
        right.plot(*ellipse(best[:2], size**2 * C[:2, :2]), color="tab:blue", label=name)
    right.plot([], [], color="0.6", label="integrated")
    right.plot(*best[:2], "*", ms=12, color="tab:blue", mec="k", label="optimal weights")
    right.set(xlabel=r"$\theta_1$", ylabel=r"$\theta_2$")
    right.legend(frameon=False)
    finish(path, left, right)


def marginal(
    problem: mf.UpdatingProblem, best: Floats, C: Floats, points: int = 25
) -> tuple[tuple[Floats, Floats], Floats]:
    """Return the posterior of two of three parameters on a grid, integrated over the third."""
    std = np.sqrt(np.diag(C))
    axes = [np.linspace(x - 3.5 * s, x + 3.5 * s, points) for x, s in zip(best, std, strict=True)]
    inner = np.linspace(-4, 4, points)
    given = C[2, :2] @ np.linalg.inv(C[:2, :2])
    width = np.sqrt(C[2, 2] - given @ C[:2, 2])
    least = float(problem.properties @ np.log(problem.evaluate(best).J)) / 2
    out = np.zeros((points, points))
    for i, x in enumerate(axes[0]):
        for j, y in enumerate(axes[1]):
            centre = best[2] + given @ (np.array([x, y]) - best[:2])
            for z in centre + width * inner:
                J = problem.evaluate(np.array([x, y, z]), derivatives=False).J
                out[i, j] += np.exp(least - float(problem.properties @ np.log(J)) / 2)
    return (axes[0], axes[1]), out


def ellipse(centre: Floats, C: Floats) -> Floats:
    """Return the line of one standard deviation around a point, (2, points)."""
    lam, V = np.linalg.eigh(C)
    t = np.linspace(0, 2 * np.pi, 100)
    circle = np.vstack([np.cos(t), np.sin(t)])
    line: Floats = centre[:, None] + V * np.sqrt(np.maximum(lam, 0)) @ circle
    return line


def example(name: str) -> mf.UpdatingProblem:
    """Return the problem of an example."""
    with tempfile.TemporaryDirectory() as folder:
        write_example(name, Path(folder))
        return mf.load(Path(folder) / "study.toml").problem


def finish(path: Path, *axes: Axes) -> None:
    """Write a figure that is the same at every build."""
    for axis in axes:
        axis.spines[["top", "right"]].set_visible(False)
    plt.rcParams["svg.hashsalt"] = "modefront"
    plt.gcf().tight_layout()
    plt.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else None, dpi=110)
    plt.close()
