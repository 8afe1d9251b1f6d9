"""Whether reference and ranges of a study depend on the number of points and on the seed.

    python benchmarks/steady.py --seeds 0:40 [--parameters 6] [--quiet]

Seeds below 1000 are for development; seeds from 9000 on are for judgement.

Each seed is a simulated test of ``calibration.py``, every second one of a wrong class; tests of
more parameters than ``--parameters`` are left out. It is solved with 5 points and seed 0, with 12
points, and with another seed, and predicts the greatest receptance and accelerance from the first
sensor to the last one. Compared with the first are the parameters of the reference, over the ranges
of their bounds, and the least and greatest prediction over the front, over the greatest one. A
study fails where one of them differs by more than 1 %, or where another model is advised.
"""

from __future__ import annotations

import argparse
import time

import numpy as np
from calibration import BOUNDS, case

import modefront as mf
from modefront._typing import Floats

SETTINGS = {"12 points": (12, 0), "seed 1": (5, 1)}
FIRST = (5, 0)
SAME = 0.01


def answers(
    problem: mf.UpdatingProblem, noise: mf.NoisePrior, points: int, seed: int
) -> tuple[str, Floats, Floats]:
    """Return label and parameters (p,) of the reference, and ranges (2, 2) of the predictions."""
    ends = problem.data.sensors[-1], problem.data.sensors[0]
    predictions = [
        mf.PeakResponse(quantity, ends[0], force=ends[1], quantity=quantity, damping=0.02)
        for quantity in ("receptance", "accelerance")
    ]
    options = mf.Identifiability(models=0)
    results = mf.solve(
        problem,
        points=points,
        seed=seed,
        noise=noise,
        predictions=predictions,
        identifiability=options,
    )
    ranges = results.dataset["frf_peak_range"].sel(range=["minimum", "maximum"]).values
    label = str(results.dataset.attrs["reference"])
    row = np.flatnonzero(results.dataset["label"].values == label)
    theta = results.theta.values[row[0]] if label else np.zeros(problem.start.size)
    return label, theta, ranges


def main() -> None:
    """Print what differs, and how many studies fail."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", default="0:40")
    parser.add_argument("--parameters", type=int, default=6)
    parser.add_argument("--quiet", action="store_true")
    options = parser.parse_args()
    studies, failed = 0, dict.fromkeys(SETTINGS, 0)
    for seed in range(*map(int, options.seeds.split(":"))):
        problem, noise, truth, classes = case(seed, wrong=seed % 2 == 1)
        if truth.size > options.parameters:
            continue
        began, studies = time.process_time(), studies + 1
        label, theta, ranges = answers(problem, noise, *FIRST)
        for name, setting in SETTINGS.items():
            other, moved, others = answers(problem, noise, *setting)
            far = float(np.abs(moved - theta).max()) / (BOUNDS[1] - BOUNDS[0])
            wide = float((np.abs(others - ranges) / np.abs(ranges).max(axis=0)).max())
            wrong = other != label or max(far, wide) > SAME
            failed[name] += wrong
            if not options.quiet:
                spent = time.process_time() - began
                print(
                    f"{seed} {name}: {'FAILS' if wrong else 'same'}, {label or 'none'} and "
                    f"{other or 'none'}, parameters {far:.1e}, ranges {wide:.1e}, {spent:.0f} s: "
                    + ", ".join(classes[1:]),
                    flush=True,
                )
    for name, count in failed.items():
        print(f"{name}: {count} of {studies} differ")


if __name__ == "__main__":
    main()
