"""The points of a front with what each of them solves, so that they can be solved again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from modefront._typing import Floats
from modefront.solvers.edges import near_best
from modefront.solvers.payoff import payoff
from modefront.solvers.problem import Problem
from modefront.solvers.scalarisation import LogSum, Scalarisation, weighted
from modefront.solvers.sqp import Solution, begin, solve

Kind = Literal["edge", "level", "boundary", "weights", "optimal"]

SMALL = 1e-4
"""Weight of the other objectives, over that of an edge's own, that keeps an edge regular.

A linearisation needs second derivatives that are not singular, while an edge in a flat valley is
a limit. At this weight its scatter differs from that of the limit by about as much.
"""


@dataclass(frozen=True)
class Role:
    """What a point solves.

    Attributes
    ----------
    kind : an edge; the best of the others at a level of an objective; a point of NBI; weights
        that are given or optimal
    ends : labels of the ends between which a point of NBI lies, one an objective
    objective : of an edge or a level
    tolerance : share by which a level exceeds the least value of its objective
    """

    kind: Kind
    ends: tuple[str, ...] = ()
    objective: int = -1
    tolerance: float = 0.0


@dataclass(frozen=True)
class Point:
    """A labelled solution and what it solves."""

    label: str
    solution: Solution
    role: Role


def edge_weights(objective: int, sizes: Floats) -> Floats:
    """Return the weights (n,) of an edge that is kept regular."""
    w = np.full(sizes.size, SMALL)
    w[objective] = 1.0
    return w / sizes


def shifted(J: Floats, E: Floats) -> Floats:
    """Return beta - t e of a point of NBI, from its objectives and those of the ends (columns)."""
    utopia = np.diag(E)
    return np.asarray(np.linalg.solve(E - utopia[:, None], J - utopia), dtype=float)


def solve_again(
    problem: Problem, points: Sequence[Point], a: Floats, sizes: Floats
) -> list[Solution]:
    """Return the points of a problem with other data, each solved from where it was.

    ``a`` (n,) counts the measured properties and ``sizes`` (n,) are typical sizes of the
    objectives. A point of which the ends do not span a simplex any more is infeasible.
    """
    solved: dict[str, Solution] = {}
    known = {point.label: point for point in points}
    for point in sorted(points, key=lambda one: one.role.kind == "boundary"):
        solved[point.label] = _again(problem, point, known, solved, a, sizes)
    return [solved[point.label] for point in points]


def _again(
    problem: Problem,
    point: Point,
    known: Mapping[str, Point],
    solved: Mapping[str, Solution],
    a: Floats,
    sizes: Floats,
) -> Solution:
    role = point.role
    start = begin(problem.evaluate(point.solution.at.theta))
    programme: Scalarisation
    if role.kind == "optimal":
        programme = LogSum(a)
    elif role.kind == "weights":
        programme = weighted(point.solution.weights)
    elif role.kind in ("edge", "level"):
        best = solve(problem, weighted(edge_weights(role.objective, sizes)), start)
        if role.kind == "edge" or not best.at.feasible:
            return best
        own = np.arange(sizes.size) == role.objective
        sizes = np.where(own, sizes, 1 / point.solution.weights)  # as it was solved with
        return near_best(problem, best, role.objective, role.tolerance, sizes, [start])[0]
    else:
        target = payoff([solved[label] for label in role.ends], sizes)
        if target is None:
            return start
        E = np.array([known[label].solution.at.J for label in role.ends]).T
        gamma = shifted(point.solution.at.J, E)
        programme = target.subproblem(gamma + (1 - gamma.sum()) / gamma.size)
    return solve(problem, programme, start)
