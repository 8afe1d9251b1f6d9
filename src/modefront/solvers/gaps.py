r"""Where the branches of a disconnected front of two objectives end.

Between the last point :math:`a` of one branch and the first point :math:`b` of the next one (first
objective rising) the front has a gap. One of its ends is a minimum of an objective within its
branch, the other one is either that too, or where its branch comes to the same level:

* the right branch starts at its own minimum of :math:`J_1`, if that lies to the right of a; the
  left branch then ends at its minimum of :math:`J_2`, or, if that lies farther right, where its
  :math:`J_1` reaches the start of the right branch (an end that itself is dominated);
* otherwise the left branch ends at its minimum of :math:`J_2` and the right one starts at that
  level.

Points that the start of the right branch dominates do not count as the last one. An end is sought
from the point next to it, then from the points behind that one, and, where a level is too far away,
by way of levels between. What did not converge, lies on the wrong side of its neighbour or is
dominated by a known model is no end: it counts as unknown.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from modefront._typing import Bools, Floats, Ints
from modefront.solvers.dominance import SAME
from modefront.solvers.problem import Problem
from modefront.solvers.scalarisation import level, weighted
from modefront.solvers.sqp import Options, Solution, Status, solve
from modefront.work.task import IMMEDIATE, Executor, Task

_TIGHT = Options(reduction=1e-17)


STARTS = 3
"""Points of a branch from which its end is sought, at most."""

LEVELS = (1, 2, 4)
"""Numbers of steps in which a level is approached, one after another."""


@dataclass(frozen=True)
class Gap:
    """A gap of the front.

    Attributes
    ----------
    last, first : the points of the front before the gap and behind it
    end : where the branch before it ends; None where that is not known
    start : where the branch behind it starts; None where that is not known
    """

    last: Solution
    first: Solution
    end: Solution | None
    start: Solution | None

    @property
    def ends(self) -> list[Solution]:
        """The end and the start, as far as they are known."""
        return [solution for solution in (self.end, self.start) if solution is not None]

    @property
    def middle(self) -> float:
        """The first objective in the middle of the gap."""
        return float((self.end or self.last).J[0] + (self.start or self.first).J[0]) / 2


# 7 arguments: the front, and the known models beside it.
def gaps(
    problem: Problem,
    points: Sequence[Solution],
    optimal: Bools,
    scale: Floats,
    work: Executor = IMMEDIATE,
    jumps: Sequence[tuple[Solution, Solution]] = (),
    known: Floats | None = None,
) -> list[Gap]:
    """Return the gaps between points in their order along the front, of two objectives.

    ``optimal`` says which points are Pareto optimal among them; a gap is where some are not. At
    ``jumps`` there may be gaps as well; points that the branch behind one dominates do not count.
    ``known`` (models, 2) are objectives of other models, none of which may dominate an end.
    """
    kept = np.flatnonzero(optimal).tolist()
    others = np.zeros((0, 2)) if known is None else known
    tasks, sides = [], []
    for k, (a, b) in enumerate(pairwise(kept)):
        jump = any(points[a] is solution and points[b] is other for solution, other in jumps)
        if b > a + 1 or jump:
            before = [points[i] for i in kept[: k + 1]]
            behind = [points[i] for i in kept[k + 1 :]]
            arguments = (problem, before, behind, scale, others)
            tasks.append(Task(("gap", a + 1, b + 1), _ends, arguments))
            sides.append((points[a], points[b], jump))
    out = []
    for (last, first, jump), ends in zip(sides, work.run(tasks), strict=True):
        end, start = (solution if solution.converged else None for solution in ends)
        if not jump or _apart(end, start, first, scale):
            out.append(Gap(last, first, end, start))
    return out


def _apart(end: Solution | None, start: Solution | None, b: Solution, scale: Floats) -> bool:
    """Return whether a gap that was found lies to the left of the point b behind it."""
    if end is None or start is None:
        return False
    left, right = ((start.J - end.J) / scale, (b.J - start.J) / scale)
    return bool(left[0] >= -SAME and left[1] < -SAME and right[0] >= -SAME)


def _ends(
    problem: Problem,
    before: Sequence[Solution],
    behind: Sequence[Solution],
    scale: Floats,
    known: Floats,
) -> list[Solution]:
    """Return the end and the start; one that is not known has a status other than converged."""
    b = behind[0]

    def minimum(objective: int, of: Solution) -> Solution:
        return solve(problem, weighted(np.eye(2)[objective] / scale), of, _TIGHT)

    def at_level(objective: int, value: float, of: Solution) -> Solution:
        solved = of
        for steps in LEVELS:
            solved = of
            for share in np.arange(1, steps + 1) / steps:
                goal = (1 - share) * of.J[objective] + share * value
                solved = solve(
                    problem, level(1 - objective, objective, float(goal), scale), solved, _TIGHT
                )
            if solved.converged:
                break
        return solved

    def first_of(solutions: Iterable[Solution], next_to: Solution, objective: int) -> Solution:
        """Return the first that can be the end, in an objective, of the branch of a point."""
        last = replace(next_to, status=Status.STALLED)
        for solution in solutions:
            ahead = (next_to.J - solution.J)[objective] >= -SAME * scale[objective]
            dominated = ((known - solution.J) / scale < -SAME).all(axis=1).any()
            if solution.converged and ahead and not dominated:
                return solution
            last = replace(solution, status=Status.STALLED)
        return last

    start, a = first_of((minimum(0, solution) for solution in behind[:STARTS]), b, 0), before[-1]
    if start.converged:
        a = next((solution for solution in before[::-1] if (solution.J < start.J).any()), a)
    last = next(k for k, solution in enumerate(before) if solution is a)
    near = before[last::-1][:STARTS]
    left_end = first_of((minimum(1, solution) for solution in near), a, 1)
    if start.converged and start.J[0] >= a.J[0] and start.J[1] < a.J[1]:
        if left_end.converged and left_end.J[0] <= start.J[0]:
            return [left_end, start]
        goal = float(start.J[0])
        return [first_of((at_level(0, goal, solution) for solution in near), a, 1), start]
    if not left_end.converged:
        return [left_end, start]
    goal = float(left_end.J[1])
    return [left_end, first_of((at_level(1, goal, solution) for solution in behind[:STARTS]), b, 0)]


def branch_numbers(J: Floats, optimal: Bools, gaps: Sequence[Gap]) -> Ints:
    """Return the branch, from 1, that each row of J (points, 2) lies on; 0 for none.

    A point that no other point dominates lies on no branch if the start of a branch dominates it.
    """
    middles = np.array([gap.middle for gap in gaps])
    starts = np.array([gap.start.J for gap in gaps if gap.start]).reshape(-1, 2)
    branch = 1 + (J[:, :1] > middles).sum(axis=1)
    below = np.all(starts <= J[:, None], axis=2) & np.any(starts < J[:, None], axis=2)
    return np.where(optimal & ~np.any(below, axis=1), branch, 0)
