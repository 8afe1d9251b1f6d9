"""Draws the figures of the documentation: python docs/figures.py."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import modefront as mf
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
    fronts(HERE / "fronts.svg")
    reduced(HERE.parent / "benchmarks" / "reduced.jsonl", HERE / "reduced.svg")
