"""Costs of a front: normal-boundary intersection beside evolutionary methods, in one run.

python benchmarks/front.py [--limit EVALUATIONS]

Prints, for the chain models M0 and M1, the eigenproblems solved by modefront for 20 points and in
all, and the evaluations and the time that pymoo's NSGA-II and SPEA2 (population 100) need for the
same hypervolume, if they get there. Needs the packages of the group ``benchmark``.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass
from typing import Any

import moocore
import numpy as np
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.algorithms.moo.spea2 import SPEA2
from pymoo.core.callback import Callback
from pymoo.core.problem import ElementwiseProblem
from pymoo.optimize import minimize

import modefront as mf
from modefront._typing import Floats

FREQUENCY = {"M0": [4.646, 13.81, 19.48], "M1": [3.908, 11.57, 16.31]}
SHAPE = {
    "M0": [[0.4561, 0.8069, 1.0], [1.0, 0.3009, -0.9026], [-0.7801, 1.0, -0.6448]],
    "M1": [[0.4408, 0.8219, 1.0], [1.0, 0.3528, -0.8709], [-0.7892, 1.0, -0.5708]],
}
NAMES = ("k1", "k2", "k3")


def problem_of(model: str) -> mf.UpdatingProblem:
    """Return the updating problem of M0 or M1."""
    chain = mf.chain(
        NAMES,
        [22.6, 22.6, 17.176],
        [84763.8] * 3,
        added_masses=[9.5 if model == "M1" else 0.0] * 3,
        stiffness_parameters=NAMES,
    )
    data = mf.modal_data(np.array(FREQUENCY[model]), np.array(SHAPE[model]), chain.sensors)
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    return mf.updating_problem(
        chain, data, groups, dict.fromkeys(NAMES, (0.2, 5.0)), dict.fromkeys(NAMES, 1.0)
    )


class Same(ElementwiseProblem):
    """The same objectives for pymoo, without derivatives."""

    def __init__(self, problem: mf.UpdatingProblem) -> None:
        self.problem = problem
        super().__init__(n_var=3, n_obj=2, xl=problem.lower, xu=problem.upper)

    def _evaluate(self, x: Floats, out: dict[str, Floats], *_: object, **__: object) -> None:
        out["F"] = self.problem.evaluate(x, derivatives=False).J


@dataclass
class Race(Callback):
    """Notes when a share of the target hypervolume is reached."""

    target: float
    scale: Floats
    shares: tuple[float, ...] = (0.99, 0.999, 1.0)

    def __post_init__(self) -> None:
        super().__init__()
        self.started = time.perf_counter()
        self.reached: dict[float, tuple[int, float]] = {}
        self.best = 0.0

    def notify(self, algorithm: Any) -> None:
        """Measure the present population."""
        result = volume(algorithm.opt.get("F"), self.scale)
        self.best = max(self.best, result / self.target)
        for share in self.shares:
            if share not in self.reached and result >= share * self.target:
                n = algorithm.evaluator.n_eval
                self.reached[share] = n, time.perf_counter() - self.started
        if len(self.reached) == len(self.shares):
            algorithm.termination.force_termination = True


def volume(J: Floats, scale: Floats) -> float:
    """Return the hypervolume within 1.1 times the ranges of the front."""
    return float(moocore.hypervolume(J / scale, ref=np.full(2, 1.1)))


def main() -> None:
    """Run the race and print it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--limit", type=int, default=40_000, help="evaluations at most")
    limit = parser.parse_args().limit
    for model in ("M0", "M1"):
        started = time.perf_counter()
        data = mf.solve(problem_of(model), points=20, seed=1).dataset
        seconds = time.perf_counter() - started
        J = data["objective"].values[:20]
        scale = J.max(axis=0)
        target = volume(J, scale)
        total, along = data.attrs["model_evaluations"], data.attrs["front_evaluations"]
        print(f"{model}: NBI {along} eigenproblems for 20 points, {along / 20:.1f} a point;")
        print(f"    with global edges and weighted models {total} in {seconds:.2f} s")
        for name, method in (("NSGA-II", NSGA2), ("SPEA2", SPEA2)):
            race = Race(target, scale)
            minimize(
                Same(problem_of(model)),
                method(pop_size=100),
                ("n_eval", limit),
                seed=1,
                callback=race,
                verbose=False,
            )
            print(f"    {name}: best {race.best:.5f} of the hypervolume")
            for share in race.shares:
                if share in race.reached:
                    n, t = race.reached[share]
                    print(
                        f"        {share:.3f}: {n} evaluations, {n / total:.1f} times as many; "
                        f"{t:.1f} s, {t / seconds:.1f} times as long"
                    )
                else:
                    print(f"        {share:.3f}: not within {limit} evaluations")


if __name__ == "__main__":
    main()
