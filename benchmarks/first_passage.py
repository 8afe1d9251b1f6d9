"""Time of first-passage probabilities, and the evaluations that they save.

Run with ``python benchmarks/first_passage.py`` (needs the package ``openturns``). It prints

1. the time for 20 structures of 3 modes under base acceleration: 2,000 samples each, 3,000 steps
   (3,001 times with the start), 3 story drifts, 2 levels;
2. evaluations of the response for a coefficient of variation of 10 % at P of about 3e-5, by the
   methods here and by the subset simulation of OpenTURNS on the same problem in 1,500 dimensions,
   and their ratio. Subset simulation's spread is that of independent repetitions.
"""

import argparse
import time

import numpy as np
import openturns as ot
from scipy.linalg import eigh

from modefront.predictions.reliability import (
    METHODS,
    Convolution,
    FirstPassage,
    estimate,
    gaussian_response,
)
from modefront.predictions.system import ModalSystem

DRIFTS = np.array([[1.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [0.0, -1.0, 1.0]])
LEVEL = 2.1
BLOCK = 100


def chain(theta: np.ndarray) -> ModalSystem:
    """Return a shear building with the story stiffnesses 84764 θ N/m, on a moving base."""
    k1, k2, k3 = 84763.8 * theta
    stiffness = np.array([[k1 + k2, -k2, 0], [-k2, k2 + k3, -k3], [0, -k3, k3]])
    mass = 22.6 * np.diag([1.0, 1.0, 0.76])
    lam, phi = eigh(stiffness, mass)
    load = -phi.T @ mass @ np.ones((3, 1))
    return ModalSystem(np.sqrt(lam), np.full(3, 0.02), load, DRIFTS @ phi)


def many_models(method: str, workers: int) -> None:
    """Print the time for the 20 structures."""
    rng = np.random.default_rng(0)
    noise = 2 * np.pi * 0.001
    problems = [FirstPassage(chain(rng.uniform(0.8, 1.6, 3)), noise, 30.0, 0.01) for _ in range(20)]
    levels = np.array([0.004, 0.005])
    start = time.perf_counter()
    results = [
        estimate(METHODS[method], problem, levels, 2000, np.random.SeedSequence(number), workers)
        for number, problem in enumerate(problems)
    ]
    elapsed = time.perf_counter() - start
    p = np.array([P for P, _ in results])
    ranges = "; ".join(f"P from {column.min():.1e} to {column.max():.1e}" for column in p.T)
    print(f"  {method:12s} {workers} worker(s) {elapsed:6.1f} s    {ranges}")


def subset_simulation(problem: FirstPassage, runs: int) -> tuple[np.ndarray, float]:
    """Return the estimates of repeated subset simulations and their mean evaluations."""
    response = gaussian_response(problem)
    convolution = Convolution(response, BLOCK)
    n = response.load[1]

    evaluations = 0

    def largest(points: object) -> np.ndarray:
        nonlocal evaluations
        z = np.asarray(points)
        evaluations += len(z)
        parts = [z[first : first + BLOCK, None] for first in range(0, len(z), BLOCK)]
        peaks = [next(convolution.magnitudes(part)).max(axis=1) for part in parts]
        return np.concatenate(peaks)[:, None]

    estimates = []
    for run in range(runs):
        ot.RandomGenerator.SetSeed(run)
        function = ot.PythonFunction(n, 1, func_sample=largest)
        normal = ot.RandomVector(ot.JointDistribution([ot.Normal()] * n))
        event = ot.ThresholdEvent(ot.CompositeRandomVector(function, normal), ot.Greater(), LEVEL)
        algorithm = ot.SubsetSampling(event)
        algorithm.setBlockSize(BLOCK)
        algorithm.setMaximumOuterSampling(10)
        algorithm.run()
        estimates.append(algorithm.getResult().getProbabilityEstimate())
    return np.array(estimates), evaluations / runs


def evaluations_needed(runs: int) -> None:
    """Print evaluations for a coefficient of variation of 10 %, and their ratio."""
    system = ModalSystem(np.array([7.85]), np.array([0.02]), np.eye(1), np.eye(1))
    problem = FirstPassage(system, 2 * np.pi, 30.0, 0.02)
    start = time.perf_counter()
    estimates, evaluations = subset_simulation(problem, runs)
    spread = estimates.std(ddof=1) / estimates.mean()
    subset = evaluations * (spread / 0.1) ** 2
    uncertain = spread / np.sqrt(runs)
    print(
        f"  subset simulation (OpenTURNS {ot.__version__}): P = {estimates.mean():.2e} "
        f"± {100 * uncertain:.0f} %, {evaluations:.0f} evaluations a run, c.o.v. of {runs} runs "
        f"{spread:.2f}\n    -> {subset:.0f} evaluations ({time.perf_counter() - start:.0f} s)"
    )
    for method in ("importance", "directional"):
        seed = np.random.SeedSequence(0)
        found = estimate(METHODS[method], problem, np.array([LEVEL]), 20_000, seed)
        (P,), (variation,) = found
        unit = variation * np.sqrt(20_000)
        needed = (unit / 0.1) ** 2
        print(
            f"  {method}: P = {P:.3e} ± {100 * variation:.1f} %, unit c.o.v. {unit:.3f}\n"
            f"    -> {needed:.0f} evaluations: {subset / needed:.0f} times fewer"
        )


def main() -> None:
    """Run both parts."""
    parser = argparse.ArgumentParser(description="Time and economy of first passage.")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--runs", type=int, default=20, help="repetitions of subset simulation")
    arguments = parser.parse_args()
    print("20 models x 2,000 samples x 3,001 times x 3 drifts x 2 levels")
    for method in METHODS:
        many_models(method, arguments.workers)
    print(f"Evaluations of the response for a c.o.v. of 10 %, b = {LEVEL}")
    evaluations_needed(arguments.runs)


if __name__ == "__main__":
    main()
