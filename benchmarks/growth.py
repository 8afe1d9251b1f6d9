"""Growth of the time of a study with its model and its data.

    python benchmarks/growth.py [--over dofs parameters ...] [--save benchmarks/growth.jsonl]
    python benchmarks/growth.py --draw benchmarks/growth.jsonl growth.svg

Plates of shells with noise in the "measured" modes; one thing grows, the others stay: 600 degrees
of freedom, 3 parameters, 4 modes, 6 points, 12 sensors, one data set, and at most 12 starts of a
search.
Printed are the processor seconds of the work of a study (edges, weighted models, front), of one
evaluation of it, which is a solution in the basis with what the solver takes, the evaluations, and
the exponent of growth between the last two sizes.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

import numpy as np

import modefront as mf
from modefront import fem
from modefront.identifiability.combinations import Identifiability
from modefront.models.mesh import mesh_model
from modefront.work.task import counted

STEEL = fem.Material(E=210e9, nu=0.3, rho=7850.0)
USUAL = {"dofs": 600, "parameters": 3, "modes": 4, "points": 6, "sensors": 12, "sets": 1}
SIZES = {
    "dofs": (300, 600, 1200, 2400, 4800, 9600),
    "parameters": (2, 4, 8, 16, 32, 50),
    "modes": (2, 4, 8, 16),
    "points": (4, 8, 16, 32, 64),
    "sensors": (6, 12, 24, 48, 96),
    "sets": (1, 2, 4, 8, 16),
}
NAMES = {
    "dofs": "degrees of freedom",
    "parameters": "parameters",
    "modes": "modes",
    "points": "points of the front",
    "sensors": "sensors",
    "sets": "data sets",
}


def problem(dofs: int, parameters: int, modes: int, sensors: int, sets: int) -> mf.UpdatingProblem:
    """Return the problem of fitting modes of a plate whose regions differ in stiffness."""
    n = max(2, round(np.sqrt(dofs / 6 / 6)))
    along = max(6 * n, parameters)
    X, cells = fem.grids.plate(6.0, 1.0, along, n)
    X[:, 2] = 0.1 * X[:, 0] * X[:, 1]
    middle = X[cells].mean(axis=1)[:, 0] / 6.0
    part = np.minimum((middle * parameters).astype(int), parameters - 1)
    names = [f"k{j + 1}" for j in range(parameters)]
    free = np.flatnonzero(X[:, 0] > 0)
    places = free[np.linspace(0, free.size - 1, sensors).astype(int)]
    structure = fem.Structure(
        X,
        [fem.Shells(name, cells[part == j], STEEL, 0.02) for j, name in enumerate(names)],
        [fem.Support(np.flatnonzero(X[:, 0] == 0))],
        sensors=[fem.Sensor(f"s{i + 1}", int(node), "z") for i, node in enumerate(places)],
        parameters=[fem.Parameter(name, "E", (name,)) for name in names],
    )
    model = mesh_model(structure, names)
    rng = np.random.default_rng(0)
    truth = model.modes(rng.uniform(0.8, 1.25, parameters), modes, derivatives=False)
    frequency = truth.frequency * (1 + 0.005 * rng.standard_normal((sets, modes)))
    phi = truth.phi.T * (1 + 0.03 * rng.standard_normal((sets, modes, sensors)))
    data = mf.modal_data(frequency, phi, model.sensors)
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    bounds, nominal = dict.fromkeys(names, (0.5, 2.0)), dict.fromkeys(names, 1.0)
    return mf.updating_problem(model, data, groups, bounds, nominal, reduction=mf.Reduction())


def measured(over: str, size: int) -> dict[str, Any]:
    """Return the time and the evaluations of a study of one size."""
    sizes = USUAL | {over: size}
    points = sizes.pop("points")
    built = problem(**sizes)
    search = mf.Search(doubt=0.5)
    started = time.process_time()
    with counted() as costs:
        mf.solve(
            built, points=points, search=search, identifiability=Identifiability(flat=0, models=0)
        )
    seconds = time.process_time() - started
    size = built.model.size if over == "dofs" else size
    evaluations = costs.model_evaluations
    return {
        "over": over,
        "size": size,
        "seconds": seconds,
        "evaluations": evaluations,
        "each": seconds / evaluations,
    }


def draw(rows: list[dict[str, Any]], file: Path) -> None:
    """Draw the seconds of studies and of evaluations over all sizes, both axes logarithmic."""
    import matplotlib as mpl

    mpl.use("svg")
    mpl.rcParams["svg.hashsalt"] = "modefront"
    from matplotlib import pyplot as plt

    figure, axes = plt.subplots(2, 3, figsize=(10, 6), layout="constrained")
    for ax, (over, name) in zip(axes.flat, NAMES.items(), strict=True):
        chosen = [row for row in rows if row["over"] == over]
        size = np.array([row["size"] for row in chosen])
        for key, label, mark in (("seconds", "study", "o-"), ("each", "evaluation", "s--")):
            value = np.array([row[key] for row in chosen])
            ax.loglog(size, value / value[0], mark, label=label)
        ax.loglog(size, size / size[0], ":", color="grey", label="proportional")
        ax.set(xlabel=name, ylabel="time over that of the first")
        ax.set_xticks(size, [f"{x:,}" for x in size])
        ax.minorticks_off()
    axes.flat[0].legend()
    figure.savefig(file, metadata={"Date": None})


def main() -> None:
    """Print a line a size, or draw the lines that were saved."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--over", nargs="+", choices=SIZES, default=list(SIZES))
    options.add_argument("--save", type=Path, help="append the lines to a file")
    options.add_argument("--draw", type=Path, nargs=2, metavar=("LINES", "FIGURE"))
    given = options.parse_args()
    if given.draw:
        lines, figure = given.draw
        draw([json.loads(line) for line in lines.read_text().splitlines()], figure)
        return
    for over in given.over:
        before: dict[str, Any] = {}
        for size in SIZES[over]:
            row = measured(over, size)
            text = f"{over:10s} {row['size']:6d} {row['seconds']:8.2f} s"
            text += f" {row['evaluations']:6d} evaluations, {1e3 * row['each']:7.2f} ms each"
            if before:
                steps = np.log(row["size"] / before["size"])
                text += f", exponent {np.log(row['seconds'] / before['seconds']) / steps:.2f}"
            print(text, flush=True)
            before = row
            if given.save:
                with given.save.open("a") as stream:
                    stream.write(json.dumps(row) + "\n")


if __name__ == "__main__":
    main()
