"""Fronts in a reduced basis beside those in full, of structures with a local mode.

    python benchmarks/local_modes.py [--seeds 0:8] [--points 11]

A chain of 150 floors in three regions of stiffness carries a mass on two springs, at a random
floor. The mode of the mass is far above the measured ones, unless both springs are softer by
far: so it is at the truth, where it is one of four measured modes, and nowhere at the nominal
model or at those with one parameter at a bound. All frequencies are one group, all shapes another,
with errors of 0.5 % of a frequency and 2 % of a shape.

Printed are, for every seed, both edges J of the two runs, the models of the reduced run solved in
full; how many are Pareto optimal, and by how much the worst of these is behind one of the other
run in all objectives, over the ranges (runs with more points fill gaps, which is no lead); the
greatest difference of an objective of a reported model from that of the full solution, over its
range; and the evaluations.
"""

from __future__ import annotations

import argparse
from typing import Literal

import numpy as np
import scipy.linalg
import xarray as xr

import modefront as mf
from modefront._typing import Floats
from modefront.front.dominance import nondominated
from modefront.identifiability.combinations import Identifiability

FLOORS, MODES, SENSORS = 150, 4, 8
NAMES = ["p1", "p2", "k1", "k2", "k3"]
LOWER, UPPER = np.array([0.05, 0.05, 0.5, 0.5, 0.5]), np.full(5, 2.0)


def matrices(rng: np.random.Generator) -> tuple[Floats, Floats]:
    """Return the terms (5, N, N) of the stiffness and the mass (N, N)."""
    n = FLOORS
    k = rng.uniform(0.8, 1.2, n) * 1e3
    K = np.zeros((5, n + 1, n + 1))
    for i in range(n):
        term = K[2 + 3 * i // n]
        term[i, i] += k[i]
        if i:
            term[i - 1, i - 1] += k[i]
            term[[i, i - 1], [i - 1, i]] -= k[i]
    mass = 10.0
    M = np.diag(np.append(rng.uniform(0.8, 1.2, n), mass))
    omega = np.sqrt(scipy.linalg.eigh(K.sum(axis=0)[:n, :n], M[:n, :n], subset_by_index=[3, 3])[0])
    floor = int(rng.integers(n // 3, n))
    # Both springs at 0.1 give 0.5 to 0.8 of the fourth frequency of the chain, one alone at its
    # lower bound 1.15 at least: the root of 1.05 over 0.2, times 0.5.
    spring = mass * (rng.uniform(0.5, 0.8) * omega[0]) ** 2 / 0.2
    place = np.ix_([floor, n], [floor, n])
    for j in range(2):
        K[j][place] += spring * np.array([[1, -1], [-1, 1]])
    return K, M


def problem(seed: int, reduction: Literal["auto", "off"]) -> mf.UpdatingProblem:
    """Return the problem of a seed, in a basis or in full."""
    rng = np.random.default_rng([7, seed])
    K, M = matrices(rng)
    true = np.append(rng.uniform(0.08, 0.14, 2), rng.uniform(0.8, 1.25, 3))
    lam, Phi = scipy.linalg.eigh(np.tensordot(true, K, 1), M, subset_by_index=[0, MODES - 1])
    dofs = [*np.linspace(FLOORS // SENSORS, FLOORS - 1, SENSORS).astype(int).tolist(), FLOORS]
    f, shape = np.sqrt(lam) / (2 * np.pi), Phi[dofs].T
    f = f * (1 + 0.005 * rng.standard_normal(f.size))
    shape = shape + 0.02 * np.sqrt((shape**2).mean(axis=1, keepdims=True)) * rng.standard_normal(
        shape.shape
    )
    order = np.argsort(f)
    sensors = {f"s{i + 1}": [(dof, 1.0)] for i, dof in enumerate(dofs)}
    return mf.updating_problem(
        mf.matrices(NAMES, dict(zip(NAMES, K, strict=True)), {"base": M}, sensors),
        mf.modal_data(f[order], shape[order], tuple(sensors)),
        [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")],
        dict(zip(NAMES, zip(LOWER, UPPER, strict=True), strict=True)),
        dict.fromkeys(NAMES, 1.0),
        reduction=mf.Reduction(reduction),
    )


def solved(seed: int, reduction: Literal["auto", "off"], points: int) -> xr.Dataset:
    """Return the results of a run."""
    return mf.solve(
        problem(seed, reduction),
        points=points,
        seed=1,
        identifiability=Identifiability(flat=0.0, models=0),
    ).dataset


def line(seed: int, points: int) -> str:
    """Return what is printed of a seed."""
    full, out = problem(seed, "off"), [f"seed {seed}"]
    runs = {}
    for reduction in ("auto", "off"):
        data = solved(seed, reduction, points)
        runs[reduction] = data, np.array([full.evaluate(theta).J for theta in data["theta"].values])
    everything = np.concatenate([J for _, J in runs.values()])
    optimal = everything[nondominated(everything)]
    span = np.ptp(optimal, axis=0)
    optima = {name: J[data["pareto"].values] / span for name, (data, J) in runs.items()}
    for reduction, other in (("auto", "off"), ("off", "auto")):
        data, J = runs[reduction]
        edges = [f"({x:.3g} {y:.3g})" for x, y in J[data["kind"].values == "edge"]]
        behind = max((x - optima[other]).min(axis=1).max() for x in optima[reduction])
        error = np.abs((J - data["objective"].values) / span).max()
        out.append(
            f"{reduction}: edges {' '.join(edges)} optimal {len(optima[reduction])} behind "
            f"{behind:.0e} error {error:.0e} evaluations {int(data.attrs['model_evaluations'])}"
        )
    return "; ".join(out)


def main() -> None:
    """Print a line a seed."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--seeds", default="0:8")
    options.add_argument("--points", type=int, default=11)
    given = options.parse_args()
    for seed in range(*map(int, given.seeds.split(":"))):
        print(line(seed, given.points), flush=True)


if __name__ == "__main__":
    main()
