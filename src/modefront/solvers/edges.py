r"""The edges of the front: of the models that are best in one objective, the best in the others.

The minimiser of one objective need not be unique: several models may fit some measurements
exactly, and mode shapes do not change when all stiffnesses are scaled. An edge is found
lexicographically, as the limit of the minimisers of

.. math:: J_i / c_i + \varepsilon \sum_{j \ne i} J_j / c_j, \qquad \varepsilon \to 0,

(Ehrgott, *Multicriteria Optimization*, 2005, section 5.1), extrapolated from two of them: their
distance from the limit is proportional to :math:`\varepsilon`. c are typical sizes of the
objectives.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Floats
from modefront.solvers.checkpoint import Checkpoint, compute_always
from modefront.solvers.explore import Search, distinct, explore
from modefront.solvers.problem import Problem
from modefront.solvers.scalarisation import Linear, weighted
from modefront.solvers.sqp import Options, Solution, begin, solve

EXPLORE, COARSE, FINE = 1e-5, 1e-6, 1e-7
"""Values of epsilon: while exploring, and the two from which the limit is extrapolated."""

EXACT = 1e-10
"""An objective below this share of its typical size is fitted exactly."""

TIE = 1e-6
"""Minima of an objective that differ by less than this share of it, or of `EXACT`, are equal."""

ATTEMPTS = 4
"""Starts from which the end of a flat valley is looked for, at most."""

_LEARNING = Options(step=1e-8, reduction=1e-24)

_KNOWN = Options(step=1e-8, reduction=1e-24, learn=False, iterations=30)
"""What is learned is not exact enough where an objective does not change at all."""


@dataclass(frozen=True)
class Edge:
    """The edge of one objective, and all other minima of that objective."""

    best: Solution
    minima: Sequence[Solution]


def sample(problem: Problem, rng: np.random.Generator, points: int = 16) -> list[Solution]:
    """Return evaluations at random parameters, as starts that were not solved from."""
    span = problem.upper - problem.lower
    thetas = problem.lower + span * rng.uniform(size=(points, span.size))
    return [begin(problem.evaluate(theta, derivatives=False)) for theta in thetas]


def typical_sizes(points: Sequence[Solution]) -> Floats | None:
    """Return the median of every objective, shape (n,); None where none are defined."""
    J = np.array([one.at.J for one in points if one.at.feasible])
    if len(J) == 0:
        return None
    return np.maximum(np.median(J, axis=0), np.finfo(float).tiny)


def edge(
    problem: Problem,
    objective: int,
    sizes: Floats,
    rng: np.random.Generator,
    search: Search,
    checkpoint: Checkpoint = compute_always,
    starts: Sequence[Solution] = (),
) -> Edge | None:
    """Return the edge of one objective, or None where no minimum was found.

    ``sizes`` are typical sizes of the objectives, shape (n,); ``starts`` are solved from first.
    """
    name = problem.objectives[objective]
    programme = _programme(objective, EXPLORE, sizes)
    found = checkpoint(
        f"minima-{name}", lambda: explore(problem, programme, rng, search, starts=starts)
    )
    refined = checkpoint(
        f"edge-{name}", lambda: [refine(problem, objective, sizes, one) for one in found]
    )
    minima: list[Solution] = []
    for one in refined:
        if distinct(minima, one, problem):
            minima.append(one)
    if not minima:
        return None
    least = min(one.at.J[objective] for one in minima)
    margin = TIE * max(least, EXACT * sizes[objective] / TIE)
    equal = [one for one in minima if one.at.J[objective] <= least + margin]
    others = np.arange(sizes.size) != objective
    best = min(equal, key=lambda one: float((one.at.J / sizes)[others].sum()))
    return Edge(best, [best, *(one for one in minima if one is not best)])


def near_best(
    problem: Problem,
    best: Solution,
    objective: int,
    tolerance: float,
    sizes: Floats,
    known: Sequence[Solution],
) -> list[Solution]:
    """Return, of the models within a tolerance of the best in an objective, the best in the others.

    Where an objective hardly changes along a valley, the end of the valley says nothing, and the
    front there is flat; this is the point from which it is not. It is solved from those of the
    ``known`` solutions that are closest in the objective, one after another. An objective that is
    fitted exactly keeps its edge, and so does one for which the programme does not converge.
    """
    least = best.at.J[objective]
    if least <= EXACT * sizes[objective]:
        return [best]
    value = (1 + tolerance) * least
    others = np.where(np.arange(sizes.size) != objective, 1 / sizes, 0.0)
    unit = np.eye(sizes.size)[[objective]] / value
    closest = sorted(known, key=lambda one: abs(np.log(one.at.J[objective] / value)))
    for start in closest[:ATTEMPTS]:
        found = solve(problem, Linear(others, unit, np.ones(1)), start)
        if found.converged:
            return [found]
    return [best]


def _programme(objective: int, epsilon: float, sizes: Floats) -> Linear:
    w = np.full(sizes.size, epsilon)
    w[objective] = 1.0
    return weighted(w / sizes)


def refine(problem: Problem, objective: int, sizes: Floats, start: Solution) -> Solution:
    """Return the limit of the minimisers for epsilon to 0, by Richardson's extrapolation."""
    coarse = _descend(problem, _programme(objective, COARSE, sizes), start)
    fine = _descend(problem, _programme(objective, FINE, sizes), coarse)
    theta = fine.at.theta + (fine.at.theta - coarse.at.theta) * FINE / (COARSE - FINE)
    limit = problem.evaluate(np.clip(theta, problem.lower, problem.upper))
    better = limit.feasible and limit.J[objective] <= fine.at.J[objective]
    return replace(
        fine,
        at=limit if better else fine.at,
        learned=start.learned,
        evaluations=start.evaluations + coarse.evaluations + fine.evaluations + 1,
    )


def _descend(problem: Problem, programme: Linear, start: Solution) -> Solution:
    """Return the minimum with the known second derivatives if these suffice, else with learned."""
    if start.at.H.any():
        found = solve(problem, programme, start, _KNOWN)
        if found.converged:
            return found
    return solve(problem, programme, start, _LEARNING)
