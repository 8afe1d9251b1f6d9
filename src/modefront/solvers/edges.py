r"""The edges of the front: of the models that are best in one objective, the best in the others.

Many starts are followed to lexicographic minima (`modefront.solvers.lexicographic`); the best of
these is the edge. A model that any other work comes across and that is better in this order, is a
start for another search.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.solvers.explore import Search, distinct, explore
from modefront.solvers.lexicographic import EXACT, Lexicographic
from modefront.solvers.problem import Problem
from modefront.solvers.scalarisation import constrained
from modefront.solvers.sqp import Options, Solution, begin, solve
from modefront.work.task import IMMEDIATE, Executor, Task

ATTEMPTS = 4
"""Starts from which the end of a flat valley is sought, at most."""

_TIGHT = Options(step=1e-8)


def edge_options(search: Search) -> Options:
    """Return the tolerances of edges: those of any point where the search goes on from known ones.

    These are edges of nearly the same problem, in a basis whose eigenvalues have errors themselves.
    Where an objective does not change in some direction, tighter ones would be met by chance only.
    """
    return Options() if search.is_none else _TIGHT


@dataclass(frozen=True)
class Edge:
    """The edge of one objective, and all other minima of that objective."""

    best: Solution
    minima: Sequence[Solution]


def sample(problem: Problem, points: int = 16, *, rng: np.random.Generator) -> list[Solution]:
    """Return evaluations at random parameters, as starts that were not solved from."""
    span = problem.upper - problem.lower
    thetas = problem.lower + span * rng.uniform(size=(points, span.size))
    return [begin(problem.evaluate(theta, derivatives=False)) for theta in thetas]


def typical_sizes(points: Sequence[Solution]) -> Floats | None:
    """Return the median of every objective, shape (n,); None where none are defined."""
    J = np.array([solution.J for solution in points if solution.feasible])
    if len(J) == 0:
        return None
    return np.maximum(np.median(J, axis=0), np.finfo(float).tiny)


def edge_of_each(
    problem: Problem,
    sizes: Floats,
    seeds: Sequence[np.random.SeedSequence],
    search: Search,
    work: Executor = IMMEDIATE,
    starts: Sequence[Sequence[Solution]] = (),
) -> list[Edge | None]:
    """Return the edge of each objective, None where no minimum was found.

    ``sizes`` are typical sizes of the objectives, shape (n,); each has a seed of its own, and
    ``starts`` that are solved from first. The searches are independent of each other.
    """
    objectives = range(len(problem.objectives))
    tasks, options = [], edge_options(search)
    for i in objectives:
        arguments = (problem, Lexicographic(i, sizes), search, starts[i] if starts else (), options)
        name = problem.objectives[i]
        tasks.append(Task(("edge", name), explore, arguments, seeds[i], has_parts=True))
    solved = work.run(tasks)
    return [
        ordered(problem, i, sizes, minima) for i, minima in zip(objectives, solved, strict=True)
    ]


def ordered(
    problem: Problem, objective: int, sizes: Floats, solved: Sequence[Solution]
) -> Edge | None:
    """Return the edge that the best of some minima of one objective is; None where there is none.

    Minima that did not converge count where nothing better did.
    """
    if not solved:
        return None
    order = Lexicographic(objective, sizes)
    least = min(solution.J[objective] for solution in solved)
    equal = [
        solution for solution in solved if solution.J[objective] <= least + order.margin(least)
    ]
    best = min(equal, key=lambda solution: float(order.others @ solution.J))
    minima = [best]
    for solution in sorted(solved, key=lambda solution: float(solution.J[objective])):
        if distinct(minima, solution, problem):
            minima.append(solution)
    return Edge(best, minima)


def refined_from(
    problem: Problem,
    objective: int,
    sizes: Floats,
    starts: Sequence[Solution],
    options: Options,
) -> list[Solution]:
    """Return the lexicographic minimum of one objective below each start."""
    order = Lexicographic(objective, sizes)
    return [order.solve(problem, solution, options) for solution in starts]


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
