"""Sizes of objectives, and edges within a tolerance."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modefront._typing import Floats
from modefront.optim.lexicographic import EXACT
from modefront.optim.problem import Problem
from modefront.optim.scalarisation import constrained
from modefront.optim.sqp import Solution, solve

SAMPLE = 16
"""Random models of which typical sizes are medians."""

ATTEMPTS = 4
"""Starts from which the end of a flat valley is sought, at most."""


def sample(problem: Problem, *, rng: np.random.Generator) -> Floats:
    """Return the typical size of each objective, of random models; empty without any."""
    span = problem.upper - problem.lower
    thetas = problem.lower + span * rng.uniform(size=(SAMPLE, span.size))
    J = np.array([problem.evaluate(theta, derivatives=False).J for theta in thetas])
    J = J[np.isfinite(J).all(axis=1)]
    return np.maximum(np.median(J, axis=0), np.finfo(float).tiny) if len(J) else np.zeros(0)


def near_best(
    problem: Problem,
    best: Solution,
    objective: int,
    tolerance: float,
    sizes: Floats,
    known: Sequence[Solution],
) -> Solution:
    """Return, of the models within a tolerance of the best in an objective, the best in the others.

    Where an objective hardly changes along a valley, the end of the valley says nothing, and the
    front there is flat; this is the point from which it is not. It is solved from those of the
    ``known`` solutions that are closest in the objective, one after another. An objective that is
    fitted exactly keeps its edge, and so does one for which the programme does not converge.
    """
    least = best.J[objective]
    if least <= EXACT * sizes[objective]:
        return best
    value = (1 + tolerance) * least
    others = np.where(np.arange(sizes.size) != objective, 1 / sizes, 0.0)
    unit = np.eye(sizes.size)[[objective]] / value
    closest = sorted(known, key=lambda solution: abs(np.log(solution.J[objective] / value)))
    for start in closest[:ATTEMPTS]:
        solved = solve(problem, constrained(others, unit, np.ones(1)), start)
        if solved.converged:
            return solved
    return best
