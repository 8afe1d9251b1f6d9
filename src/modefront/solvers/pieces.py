r"""Where the pieces of a disconnected front of two objectives end.

Between the last point :math:`a` of one piece and the first point :math:`b` of the next one (first
objective rising) the front has a gap. One of its ends is a minimum of an objective within its
piece, the other one is either that too, or where its piece comes to the same level:

* the right piece starts at its own minimum of :math:`J_1`, if that lies to the right of a; the left
  piece then ends at its minimum of :math:`J_2`, or, if that lies farther right, where its
  :math:`J_1` reaches the start of the right piece (an end that itself is dominated);
* otherwise the left piece ends at its minimum of :math:`J_2` and the right one starts at that
  level.

Points that the start of the right piece dominates do not count as the last one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

import numpy as np

from modefront._typing import Bools, Floats, Ints
from modefront.solvers.checkpoint import Checkpoint, compute_always
from modefront.solvers.problem import Problem
from modefront.solvers.scalarisation import level, weighted
from modefront.solvers.sqp import Options, Solution, solve

SAME = 1e-6
"""Difference of an objective, over its range, that the solver may leave."""

_TIGHT = Options(reduction=1e-17)


@dataclass(frozen=True)
class Gap:
    """A gap of the front: the end of the piece before it and the start of the piece behind it."""

    end: Solution
    start: Solution


def gaps(
    problem: Problem,
    points: Sequence[Solution],
    optimal: Bools,
    scale: Floats,
    checkpoint: Checkpoint = compute_always,
    jumps: Sequence[tuple[Solution, Solution]] = (),
) -> list[Gap]:
    """Return the gaps between points in their order along the front, of two objectives.

    ``optimal`` says which points are Pareto optimal among them; a gap is where some are not. At
    ``jumps`` there may be gaps as well; points that the piece behind one dominates do not count.
    """
    kept = np.flatnonzero(optimal).tolist()
    out = []
    for k, (a, b) in enumerate(pairwise(kept)):
        jump = any(points[a] is one and points[b] is other for one, other in jumps)
        if b > a + 1 or jump:
            before = [points[i] for i in kept[: k + 1]]
            ends = checkpoint(
                f"gap-{a + 1}-{b + 1}", partial(_ends, problem, before, points[b], scale)
            )
            if not jump or _apart(ends[0], ends[1], points[b], scale):
                out.append(Gap(*ends))
    return out


def _apart(end: Solution, start: Solution, b: Solution, scale: Floats) -> bool:
    """Return whether a gap that was found lies to the left of the point b behind it."""
    left, right = ((start.at.J - end.at.J) / scale, (b.at.J - start.at.J) / scale)
    before = left[0] >= -SAME and left[1] < -SAME and right[0] >= -SAME
    return bool(end.converged and start.converged and before)


def _ends(
    problem: Problem, before: Sequence[Solution], b: Solution, scale: Floats
) -> list[Solution]:
    def minimum(objective: int, start: Solution) -> Solution:
        return solve(problem, weighted(np.eye(2)[objective] / scale), start, _TIGHT)

    def at_level(objective: int, of: Solution, start: Solution) -> Solution:
        programme = level(1 - objective, objective, of.at.J[objective], scale)
        return solve(problem, programme, start, _TIGHT)

    start, a = minimum(0, b), before[-1]
    if start.converged:
        a = next((one for one in before[::-1] if (one.at.J < start.at.J).any()), a)
    if start.converged and start.at.J[0] >= a.at.J[0] and start.at.J[1] < a.at.J[1]:
        end = minimum(1, a)
        if not (end.converged and end.at.J[0] <= start.at.J[0]):
            end = at_level(0, start, a)
    else:
        end = minimum(1, a)
        start = at_level(1, end, b)
    return [end, start]


def piece_numbers(J: Floats, optimal: Bools, gaps: Sequence[Gap]) -> Ints:
    """Return the piece, from 1, that each row of J (points, 2) lies on; 0 for none.

    A point that no other point dominates lies on no piece if the start of a piece dominates it.
    """
    ends = np.array([gap.end.at.J[0] for gap in gaps])
    starts = np.array([gap.start.at.J for gap in gaps]).reshape(-1, 2)
    piece = 1 + (J[:, :1] > (ends + starts[:, 0]) / 2).sum(axis=1)
    below = np.all(starts <= J[:, None], axis=2) & np.any(starts < J[:, None], axis=2)
    return np.where(optimal & ~np.any(below, axis=1), piece, 0)
