"""Where the branches of a disconnected front of two objectives end (`docs/methods/nbi.md`).

There is a gap where a point of the lattice has slack, or dominated points lie between two that are
not. The branch before ends at its own least second objective, and the branch behind starts at its
own least first one, unless these lie beyond the other branch. Where only one end is known so, or
one dominates the other, the other branch ends or starts at its level.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from modefront._typing import Bools, Floats, Ints
from modefront.front.dominance import nondominated
from modefront.front.simplex import Payoff
from modefront.front.subproblems import RHO, LatticePoint, active_bounds
from modefront.optim.problem import Problem
from modefront.optim.scalarisation import Scalarisation, below, weighted
from modefront.optim.sqp import TIGHT, Solution, solve
from modefront.work.task import IMMEDIATE, Task


@dataclass(frozen=True)
class Gap:
    """A gap of the front."""

    middle: float  # first objective in the middle of it
    end: Solution | None  # where the branch before it ends; None where that is not known
    start: Solution | None  # where the branch behind it starts; None where that is not known

    @property
    def ends(self) -> list[Solution]:
        """The end and the start, as far as they are known."""
        return [solution for solution in (self.end, self.start) if solution is not None]


def gaps(
    problem: Problem,
    points: Sequence[Solution],
    target: Payoff,
    bounded: bool,
    run: Callable[[Sequence[Task[Any]]], list[Any]] = IMMEDIATE.run,
) -> list[Gap]:
    """Return the gaps between points in their order along the front, of two objectives.

    Of ``bounded`` programmes, a point of the lattice may have slack. ``run`` carries out tasks.
    """
    optimal, scale = nondominated(np.array([x.J for x in points])), target.scale
    slack = np.zeros((len(points), 2), dtype=np.bool_)
    for k, x in enumerate(points):
        if bounded and x.converged and x.beta is not None:
            c = target.r * LatticePoint(x.beta, (), target).order.excess(x.J)
            slack[k] = (c.max() - c > RHO) & ~active_bounds(x.weights * target.unit)
    tasks, sides = [], []
    kept = np.flatnonzero(optimal).tolist()
    for k, (a, b) in enumerate(pairwise(kept)):
        known = bool(slack[a, 0]), bool(slack[b, 1])
        if any(known) or b > a + 1:
            nearest = [points[i] for i in kept[k::-1]], [points[i] for i in kept[k + 1 :]]
            tasks.append(Task(("gap", a + 1, b + 1), _ends, (problem, *nearest, scale)))
            sides.append((points[a], points[b], known))
    out = []
    for (last, first, known), ends in zip(sides, run(tasks), strict=True):
        end, start = ends or (None, None)
        width = (start.J - end.J) / scale if end and start else np.zeros(0)
        if end and start and not (width[0] >= -RHO and width[1] <= RHO and np.ptp(width) > RHO):
            # the start does not lie to the right of the end and below it, apart from it
            own, beyond = (end, first) if known[0] else (start, last)
            if not any(known) or np.abs((own.J - beyond.J) / scale).max() <= RHO:
                continue  # the branch goes on to the other side
            end, start = (end, None) if known[0] else (None, start)
        out.append(Gap(float((end or last).J[0] + (start or first).J[0]) / 2, end, start))
    return out


def _ends(
    problem: Problem, before: Sequence[Solution], behind: Sequence[Solution], scale: Floats
) -> list[Solution | None]:
    """Return where the branch before a gap ends and the one behind starts, points nearest first."""
    unit = np.eye(2) / scale

    def found(of: Solution, programme: Scalarisation) -> Solution | None:
        solution = solve(problem, programme, of, TIGHT)
        return solution if solution.converged else None

    def at_level(i: int, of: Solution, other: Solution | None) -> Solution | None:
        """Return where the branch of a point has as much of an objective as the other end."""
        if other is None:
            return None
        most = float(other.J[i]) / scale[i]
        end = found(of, below(unit[1 - i], unit[i], most))
        return end if end and end.J[i] / scale[i] <= most + RHO else None

    end, start = found(before[0], weighted(unit[1])), found(behind[0], weighted(unit[0]))
    a, b = _first(before, start), _first(behind, end)
    end = end if end and end.J[1] >= b.J[1] else None
    start = start if start and start.J[0] >= a.J[0] else None
    if start and (not end or (start.J <= end.J).all()):
        end = at_level(0, a, start)
    elif not start or (end and (end.J <= start.J).all()):
        start = at_level(1, b, end)
    return [end, start]


def _first(points: Sequence[Solution], other: Solution | None) -> Solution:
    """Return the first point that the other end does not dominate."""
    return next((x for x in points if other and (x.J < other.J).any()), points[0])


def branches_of(
    points: Sequence[Solution], optimal: Bools, gaps: Sequence[Gap]
) -> list[list[Solution]]:
    """Return the optimal points of each branch of a front, with its ends at gaps."""
    J = np.array([solution.J for solution in points])
    number = branch_numbers(J, optimal, gaps)
    ends = [None, *(end for gap in gaps for end in (gap.end, gap.start)), None]
    out = []
    for k, (start, end) in enumerate(zip(ends[::2], ends[1::2], strict=True), 1):
        within = (points[i] for i in np.flatnonzero(number == k).tolist())
        out.append([solution for solution in (start, *within, end) if solution is not None])
    return out


def branch_numbers(J: Floats, optimal: Bools, gaps: Sequence[Gap]) -> Ints:
    """Return the branch, from 1, that each row of J (points, n) lies on; 0 for none.

    A point that no other point dominates lies on no branch if the start of a branch dominates it.
    """
    middles = np.array([gap.middle for gap in gaps])
    starts = np.array([gap.start.J for gap in gaps if gap.start]).reshape(-1, J.shape[1])
    branch = 1 + (J[:, :1] > middles).sum(axis=1)
    below = np.all(starts <= J[:, None], axis=2) & np.any(starts < J[:, None], axis=2)
    return np.where(optimal & ~np.any(below, axis=1), branch, 0)
