r"""More points of a front of two objectives where it is sparse, each branch to its end.

Between neighbours a and b of one branch whose distance, in units of the ranges of the objectives,
exceeds a wanted size, the subproblem of normal-boundary intersection half-way between their
projections is solved from a, or else from b, and so on until no distance is greater. The ends of
the branches at a gap (`modefront.solvers.gaps`) count as neighbours: so each branch is followed to
its end.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from modefront._typing import Bools, Floats
from modefront.solvers.gaps import Gap, branch_numbers
from modefront.solvers.nbi import Projection
from modefront.solvers.payoff import Payoff
from modefront.solvers.problem import Problem
from modefront.solvers.sqp import Solution
from modefront.work.task import IMMEDIATE, Executor, Task

SMALLEST = 1e-4
"""Distance of two projections below which a distance of points is a jump that is left as it is."""


# 7 arguments: the front, and the options of its refinement.
def refine(
    problem: Problem,
    target: Payoff,
    points: Sequence[Solution],
    optimal: Bools,
    gaps: Sequence[Gap],
    size: float,
    work: Executor = IMMEDIATE,
) -> tuple[list[Solution], list[tuple[Solution, Solution]]]:
    """Return the points of a front in their order, with new ones between them.

    ``optimal`` says which of the points (in their order along the front) are Pareto optimal. Also
    returned are the neighbours between which there is none: the front may have a gap there.
    """
    solved: list[Solution] = []
    jumps: list[tuple[Solution, Solution]] = []
    for branch in branches_of(points, optimal, gaps):
        pairs = list(pairwise(branch))[::-1]
        while pairs:
            a, b = pairs.pop()
            if distance(a, b, target.scale) <= size:
                continue
            middle = _between(problem, target, a, b, work)
            if middle:
                solved.append(middle)
                pairs += [(middle, b), (a, middle)]
            else:
                jumps.append((a, b))
    return sorted(
        [*points, *solved], key=lambda solution: -float(target.place(solution.J)[0])
    ), jumps


def branches_of(
    points: Sequence[Solution], optimal: Bools, gaps: Sequence[Gap]
) -> list[list[Solution]]:
    """Return the optimal points of each branch of a front, with its ends at gaps."""
    J = np.array([solution.J for solution in points])
    number = branch_numbers(J, optimal, gaps)
    out = []
    for k in range(len(gaps) + 1):
        start = gaps[k - 1].start if k else None
        end = gaps[k].end if k < len(gaps) else None
        within = (points[i] for i in np.flatnonzero(number == k + 1).tolist())
        out.append([solution for solution in (start, *within, end) if solution is not None])
    return out


def distance(a: Solution, b: Solution, scale: Floats) -> float:
    """Return the distance of two points in units of the ranges of the objectives."""
    return float(np.linalg.norm((a.J - b.J) / scale))


def _between(
    problem: Problem, target: Payoff, a: Solution, b: Solution, work: Executor
) -> Solution | None:
    """Return the point half-way, or None where there is none on this branch."""
    at_a, at_b = target.place(a.J), target.place(b.J)
    if np.abs(at_a - at_b).max() < SMALLEST:
        return None
    beta = (at_a + at_b) / 2
    lower, upper = np.minimum(a.J, b.J), np.maximum(a.J, b.J)
    for side, start in (("a", a), ("b", b)):
        key = ("front", "nbi", "refine", float(beta[1]).hex(), side)
        (solution,) = work.run([Task(key, _solve, (problem, target, beta, start))])
        if solution.converged and (lower <= solution.J).all() and (upper >= solution.J).all():
            return solution
    return None


def _solve(problem: Problem, target: Payoff, beta: Floats, start: Solution) -> Solution:
    return Projection(target).solve(problem, beta, start)
