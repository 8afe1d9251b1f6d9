"""The most probable model: the greatest maximum of the posterior that the known models lead to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modefront._typing import Floats
from modefront.front.state import DISTINCT
from modefront.optim.sqp import Options, Solution, begin, solve
from modefront.residuals.problem import UpdatingProblem
from modefront.uncertainty.prior import NoiseModel
from modefront.work.task import Executor, Task

STARTS = 12
"""Searches at most, from the most probable of the known models."""

APART = 0.02
"""Distance of two starts, over the ranges of the parameters, below which one is enough."""

_TIGHT = Options(reduction=1e-17)
"""Steps end at the tolerance of the parameters, whatever f: a sum of logarithms has any size."""


def most_probable(
    problem: UpdatingProblem, noise: NoiseModel, known: Sequence[Floats], work: Executor
) -> list[Solution]:
    """Return the maxima of the posterior below known models theta (p,), the greatest first.

    They are solutions of the problem, with the weights at which they are stationary in it.
    """
    thetas = np.unique(np.array([problem.start, *known]), axis=0)
    (values,) = work.run([Task(("most-probable", "known"), log_values, (noise, thetas))])
    span = problem.upper - problem.lower
    starts: list[Floats] = []
    for k in np.argsort(values, kind="stable").tolist():
        apart = [np.abs((thetas[k] - x) / span).max() > APART for x in starts]
        if np.isfinite(values[k]) and all(apart) and len(starts) < STARTS:
            starts.append(thetas[k])
    tasks = [
        Task(("most-probable", k + 1), maximum, (noise, theta)) for k, theta in enumerate(starts)
    ]
    found = sorted(work.run(tasks), key=lambda x: noise.programme.value(x.J))
    out: list[Solution] = []
    for x in found:
        if all(np.abs((x.theta - y.theta) / span).max() > DISTINCT for y in out):
            out.append(x)
    return work.run(
        [
            Task(("most-probable", "model", k + 1), _in_problem, (problem, noise, x))
            for k, x in enumerate(out)
        ]
    )


def log_values(noise: NoiseModel, thetas: Floats) -> Floats:
    """Return -2 ln p of models (models, p), infinite where they are not defined."""
    target, programme = noise.target, noise.programme
    found = [target.evaluate(theta, derivatives=False) for theta in thetas]
    return np.array([programme.value(x.J) if x.feasible else np.inf for x in found])


def maximum(noise: NoiseModel, start: Floats) -> Solution:
    """Return the maximum of the posterior to which a start (p,) leads, in the units of J'."""
    target = noise.target
    return solve(target, noise.programme, begin(target.evaluate(start, second=True)), _TIGHT)


def _in_problem(problem: UpdatingProblem, noise: NoiseModel, found: Solution) -> Solution:
    """Return a maximum as a solution of the problem, which has other units.

    Parameters without any effect are nominal.
    """
    effects = np.vstack([each.dr for each in found.evaluation.residuals[:-1]])
    theta = np.where(effects.any(axis=0), found.theta, problem.start)
    evaluation = problem.evaluate(theta, second=True)
    J = found.J[:-1]
    unit = np.divide(J, evaluation.J, out=np.ones(J.size), where=evaluation.J > 0)
    w = noise.programme.gradient(found.J)[:-1] * unit
    return replace(found, evaluation=evaluation, weights=w)
