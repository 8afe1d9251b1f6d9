"""Normal-boundary intersection, weight sweep, SPEA2 and NSGA-II side by side.

python benchmarks/comparators.py [--evaluations N]

On the three-story models M0 and M1 and on chains with 4 and 8 parameters whose data come from
another chain: eigenproblems for the front alone, seconds for all, and hypervolume, IGD+ and
largest gap, all in units of the ranges over the edges. The reference of IGD+ is the front by
normal-boundary intersection refined to 0.005 together with all that any method found. The global
search for the edges is the same for all methods; its eigenproblems are in the first row. Gaps of
the true front count as gaps here, for all methods alike.
"""

from __future__ import annotations

import argparse
import time

import numpy as np
import xarray as xr

import modefront as mf
from front import problem_of
from modefront._typing import Floats
from modefront.front.dominance import nondominated
from modefront.front.indicators import REFERENCE, hypervolume, igd_plus, largest_gap
from modefront.front.point import front_points

FEW = mf.Search(doubt=0.5)
"""Longer chains have very many local minima; the fronts are compared, not the search for edges."""

METHODS = ("nbi", "weights", "spea2", "nsga2")


def chain_problem(stories: int) -> mf.UpdatingProblem:
    """Return a chain with a parameter a story, and data with errors that no stiffness explains."""
    rng = np.random.default_rng(stories)
    names = tuple(f"k{i + 1}" for i in range(stories))
    masses = np.full(stories, 20.0)
    model = mf.chain(names, masses.tolist(), [8e4] * stories, stiffness_parameters=names)
    other = masses * rng.uniform(0.8, 1.2, stories)
    real = mf.chain(names, other.tolist(), [8e4] * stories, stiffness_parameters=names)
    modes = real.modes(rng.uniform(0.7, 1.4, stories), stories)
    shape = modes.phi.T * (1 + 0.05 * rng.normal(size=modes.phi.T.shape))
    data = mf.modal_data(modes.frequency, shape, model.sensors)
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    bounds, nominal = dict.fromkeys(names, (0.2, 5.0)), dict.fromkeys(names, 1.0)
    return mf.updating_problem(model, data, groups, bounds, nominal)


def front(data: xr.Dataset) -> Floats:
    """Return the Pareto-optimal points of the front."""
    J = data["objective"].values[front_points(data)]
    out: Floats = J[nondominated(J)]
    return out


def main() -> None:
    """Run all and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--evaluations", type=int, default=10_000, help="of SPEA2 and NSGA-II")
    evaluations = parser.parse_args().evaluations
    problems = {name: (problem_of(name), mf.Search()) for name in ("M0", "M1")}
    problems |= {f"chain of {n}": (chain_problem(n), FEW) for n in (4, 8)}
    for name, (problem, search) in problems.items():
        dense = mf.solve(problem, refined=0.005, seed=1, search=search).dataset
        runs: dict[str, tuple[xr.Dataset, float]] = {}
        for method in METHODS:
            started = time.perf_counter()
            data = mf.solve(
                problem, method=method, evaluations=evaluations, seed=1, search=search
            ).dataset
            runs[method] = data, time.perf_counter() - started
        data, _ = runs["nbi"]
        before = data.attrs["model_evaluations"] - data.attrs["front_evaluations"]
        edges = data["objective"].values[data["kind"].values == "edge"]
        utopia, scale = edges.min(axis=0), np.ptp(edges, axis=0)
        everything = np.concatenate([front(dense), *(front(data) for data, _ in runs.values())])
        R = (everything[nondominated(everything)] - utopia) / scale
        print(f"{name}: {before} eigenproblems for edges and weighted models")
        print("    method   points  eigenproblems  a point  seconds  hypervolume     IGD+  gap")
        for method, (data, seconds) in runs.items():
            Y = (front(data) - utopia) / scale
            spent = data.attrs["front_evaluations"]
            gap = largest_gap(Y[(Y <= REFERENCE).all(axis=1)])
            print(
                f"    {method:8} {len(Y):6} {spent:14} {spent / len(Y):8.1f} {seconds:8.1f} "
                f"{hypervolume(Y):12.5f} {igd_plus(Y, R):8.1e} {gap:5.3f}",
                flush=True,
            )


if __name__ == "__main__":
    main()
