"""Flat parts of a front: where one objective hardly changes while others do.

`docs/identifiability.md` says where the identifiable part ends. Of three and more objectives,
points of the new simplex that come to lie in the flat patch are left out.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats, Ints
from modefront.front.front import Front
from modefront.front.point import Kind, Point, of_kind
from modefront.front.proposers.polish import Polish
from modefront.front.search import Loop, Search
from modefront.front.simplex import Payoff, lattice, payoff
from modefront.front.state import State, distinct_points
from modefront.front.subproblems import Point as LatticePoint
from modefront.front.subproblems import near_best
from modefront.optim.lexicographic import EXACT, TIE
from modefront.optim.problem import Problem
from modefront.optim.sqp import Solution
from modefront.work.task import IMMEDIATE, Executor, Task

SPREAD = 0.2  # share of the range of another objective over which a flat part extends at least


@dataclass(frozen=True)
class Identifiable:
    """The part of a front that is not flat."""

    # (n,) how many points of the whole front lie in the flat part at each edge, besides it
    flat: Ints
    # (n,) likewise, where the end of the flat part was not found, so that it is not cut
    uncut: Ints
    ends: Sequence[Solution]  # where the part ends, one solution an objective
    target: Payoff | None = None  # the simplex between them; None where the part is one point
    points: Sequence[Solution] = ()  # along it; empty where it is one point

    def reported(self, names: Sequence[str]) -> list[Point]:
        """Return its points and those of its ends that are no edges, of objectives with names."""
        along = [Point(Kind.IDENTIFIABLE, x, index=i) for i, x in enumerate(self.points, 1)]
        ends = zip(names, self.ends, self.flat.tolist(), strict=True)
        return along + [Point(Kind.IDENTIFIABLE_EDGE, x, name) for name, x, cut in ends if cut]


def flat_points(J: Floats, least: Floats, tolerance: float, sizes: Floats) -> Ints:
    """Return how many rows of J (points, n) lie in the flat part at each edge, besides the edge.

    ``least`` (n,) are the least values; an objective that is fitted exactly, compared with
    ``sizes`` (n,), has no flat part. Fewer than two points make none, nor do such as spread over
    less than a fifth of the range of every other objective: neighbours of a minimum.

    >>> J = np.array([[1.0, 3.0], [1.001, 2.0], [1.002, 1.0], [1.5, 0.5], [2.0, 0.4]])
    >>> flat_points(J, np.array([1.0, 0.4]), 0.01, np.ones(2)).tolist()
    [2, 0]
    """
    within = (1 + tolerance) * least >= J
    count = within.sum(axis=0) - 1
    scaled = J / np.maximum(np.ptp(J, axis=0), np.finfo(float).tiny)
    spread = [np.ptp(scaled[chosen], axis=0).max() if chosen.any() else 0.0 for chosen in within.T]
    enough = (count >= 2) & (np.array(spread) >= SPREAD) & (least > EXACT * sizes)
    return np.where(enough, count, 0)


def same(solution: Solution, other: Solution) -> bool:
    """Return whether two solutions are of the same parameters."""
    return bool(np.array_equal(solution.theta, other.theta))


def identifiable_part(
    problem: Problem, front: Front, tolerance: float, divisions: int, work: Executor = IMMEDIATE
) -> Identifiable | None:
    """Return the part of a front that is not flat; None where nothing is flat.

    A flat part of which the end is not found is not cut, and counted. ``divisions`` are the steps
    along each edge of the simplex.
    """
    known = [point.solution for point in front.points]
    points, edges = (
        [point.solution for point in of_kind(front.points, kind)]
        for kind in (Kind.FRONT, Kind.EDGE)
    )
    if not points or front.scale is None:
        return None
    least = np.array([solution.J[i] for i, solution in enumerate(edges)])
    J, sizes = np.array([solution.J for solution in points]), front.scale
    flat = flat_points(J, least, tolerance, sizes)
    if not flat.any():
        return None
    ends = list(edges)
    for i in np.flatnonzero(flat).tolist():
        arguments = (problem, edges[i], i, tolerance, sizes, known)
        key = ("identifiable", "edge", problem.objectives[i])
        (ends[i],) = work.run([Task(key, near_best, arguments)])
    moved = [not same(solution, edge) for solution, edge in zip(ends, edges, strict=True)]
    flat, uncut = np.where(moved, flat, 0), np.where(moved, 0, flat)
    target = payoff(ends, sizes) if flat.any() else None
    if target is None:
        return Identifiable(flat, uncut, ends)
    state = State(problem, Search().tolerance, work)
    for solution in [*ends, *known, *points]:
        state.archive.add(solution.J, solution)
    counts = lattice(len(edges), divisions)
    state.add([LatticePoint(row / divisions, tuple(row.tolist()), target) for row in counts])
    Loop(state, Search()).run("identifiable", [Polish()])
    along = distinct_points([place.incumbent for place in state.places], target.scale)
    floor = np.where(flat > 0, (1 - TIE) * target.utopia, 0.0)
    return Identifiable(flat, uncut, ends, target, [x for x in along if (floor <= x.J).all()])
