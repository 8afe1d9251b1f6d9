r"""Points of a front of three and more objectives, solved again from the points beside them.

Where branches of the front meet, or the front folds, the lattice leads along one branch as far as
it goes, and another one may be better. So each point of the front is compared with the points
beside it. On one smooth branch both are near in the parameters, and each lies above the tangent
plane of the front at the other one by nearly the same height,

.. math:: h_{kj} = w_j^T (y_k - y_j) \approx \tfrac12 (y_k - y_j)^T \kappa\, (y_k - y_j)
    \approx h_{jk} ,

up to the third order of their distance. Where that does not hold, the programme through the point,

.. math:: \min_\theta\; \max_i \frac{y_i(\theta) - y_{k,i}}{r_i} ,

which is negative as soon as a model dominates the point, is solved from the other one
(`modefront.solvers.attainment`).

========  ========  ==========================================================
symbol    shape     meaning
========  ========  ==========================================================
y         (n,)      objectives over their ranges
w_j       (n,)      weights of the objectives at point j, of sum 1
h_kj      ()        height of point k above the tangent plane at point j
kappa     (n, n)    curvature of the front
r         (n,)      the normal, towards greater objectives
========  ========  ==========================================================
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Bools, Floats, Ints
from modefront.solvers.attainment import SAME, Attainment
from modefront.solvers.continuation import JUMP, Simplex
from modefront.solvers.flat import same
from modefront.solvers.payoff import Payoff
from modefront.solvers.problem import Problem
from modefront.solvers.sqp import Options, Solution, solve
from modefront.work.task import IMMEDIATE, Executor, Key, Task

ROUNDS = 4
"""Times at most that all points are compared: what one has gained may lead others on."""

BESIDE = 1.5
"""Distance of points that are compared, in steps of the ranges."""

NEAREST, MANY = 3, 6
"""Points that each point is compared with however far they are, since the front may have gaps; and
as soon as some point has gained. On a frame with many minima (`benchmarks/edges.py`, frame-4), 3, 6
and 10 improve 3, 37 and 53 of 236 points with 8,000, 17,000 and 32,000 evaluations."""

BRANCHES, LOWER = 4, 2
"""Starts at most that are far in the parameters from the point and from one another, and at most
from whose tangent planes the point lies high."""

HEIGHT = 3e-4
"""Height above a tangent plane, over twice the height in return, from which on points are of two
branches. Most points that a neighbour led to a better model had 1e-3 to 1e-2."""

UNEQUAL, LEVEL = 2.0, 1e-5
"""Ratio of the heights of two points of one smooth branch at most, and what is no height."""

COARSE = 10
"""Steps along an edge below which parameters may change by more from a point to its neighbour on
the same branch, and the ratio of their heights may be greater, in proportion."""

BEHIND, ARRIVED = 1e-2, 1e-3
"""Excess of a half-finished search over a point, in units of the ranges, that is not followed, and
distance in the parameters, over their ranges, below which it comes to the point."""

FINISHES = 2
"""Searches at most from a model that dominates a point: beside exact fits one does not suffice."""

_ROUGH = Options(step=1e-4, iterations=20)


def from_points_beside(
    problem: Problem,
    target: Payoff,
    lattice: Simplex,
    points: Sequence[Solution],
    work: Executor = IMMEDIATE,
    before: Sequence[Solution] = (),
) -> list[Solution]:
    """Return the points, each solved again from those beside it on what may be another branch.

    A point keeps its place on the lattice. Pairs of points that were so ``before`` are not tried.
    """
    current = list(points)
    kept = [k for k, pair in enumerate(zip(points, before, strict=False)) if same(*pair)]
    attempts = {(k, points[j].theta.tobytes()) for k in kept for j in kept}
    gained = 0
    for turn in range(ROUNDS):
        comparison = Comparison.of(problem, target, lattice, current)
        starts: list[tuple[int, int]] = []
        for k in comparison.open.tolist():
            for j in comparison.starts(k, MANY if gained else NEAREST):
                key = (k, current[j].theta.tobytes())
                if key not in attempts:
                    attempts.add(key)
                    starts.append((k, j))
        if not starts:
            break
        name: Key = ("front", "nbi", "branches", turn + 1)
        ends = work.run(
            [
                Task((*name, k + 1, j + 1), _from_other, (problem, target, current[k], current[j]))
                for k, j in starts
            ]
        )
        for (k, _), end in zip(starts, ends, strict=True):
            if _wins(target, end, current[k]):
                current[k] = end
                gained += 1
        if not gained:
            break
    return current


@dataclass(frozen=True)
class Comparison:
    """The points of a front beside one another.

    Attributes
    ----------
    open : indices of the points that a model can dominate in all objectives
    theta : (k, p) parameters over their ranges
    y : (k, n) objectives over theirs; infinite ones where a model cannot be evaluated
    w : (k, n) weights of the objectives, of sum 1
    reach : distance of points that lie beside one another, over the ranges
    far : change of a parameter from which points are far from one another, over its range
    unequal : ratio of the heights of two points of one smooth branch at most
    """

    open: Ints
    theta: Floats
    y: Floats
    w: Floats
    reach: float
    far: float
    unequal: float

    @classmethod
    def of(
        cls, problem: Problem, target: Payoff, lattice: Simplex, points: Sequence[Solution]
    ) -> Comparison:
        """Return the comparison of points of a lattice."""
        theta = np.array([point.theta for point in points]) / (problem.upper - problem.lower)
        y = np.array([point.J for point in points]) / target.scale
        w = np.nan_to_num([np.maximum(point.weights, 0) * target.scale for point in points])
        total = w.sum(axis=1, keepdims=True)
        w = np.divide(w, total, out=np.zeros_like(w), where=total > 0)
        feasible = np.asarray(np.isfinite(y).all(axis=1))
        above = (y - target.utopia / target.scale).min(axis=1) > SAME
        coarse = max(1.0, COARSE / lattice.divisions)
        reach, far = BESIDE / lattice.divisions, JUMP * coarse
        y = np.where(feasible[:, None], y, np.inf)
        return cls(np.flatnonzero(feasible & above), theta, y, w, reach, far, UNEQUAL * coarse)

    def heights(self, k: int) -> tuple[Floats, Floats]:
        """Return how far a point lies above the tangent plane of the front at each other, and back.

        Both (points,), over the ranges; a point that cannot be evaluated has no height.
        """
        y = np.where(np.isfinite(self.y), self.y, self.y[k])
        return (
            np.asarray(((self.y[k] - y) * self.w).sum(axis=1)),
            np.asarray((y - self.y[k]) @ self.w[k]),
        )

    def starts(self, k: int, count: int) -> list[int]:
        """Return the points from which a point is solved again, ``count`` nearest ones at most."""
        away = np.abs(self.y - self.y[k]).max(axis=1)
        away[k] = np.inf
        other, beside = self._far(k), away <= self.reach
        height, back = self.heights(k)
        least, most = np.minimum(height, back), np.maximum(height, back)
        smooth = ~other & (least >= -LEVEL) & (most <= self.unequal * least + LEVEL)
        nearest = away.argsort(kind="stable")[:count]
        chosen = nearest[~smooth[nearest] & np.isfinite(away[nearest])]
        below = np.flatnonzero(beside & (height > HEIGHT + 2 * np.maximum(back, 0)))
        above = below[height[below].argsort(kind="stable")][-LOWER:]
        branches = np.flatnonzero(beside & other)
        branches = branches[away[branches].argsort(kind="stable")]
        return list(dict.fromkeys([*self._apart(branches), *above.tolist(), *chosen.tolist()]))

    def _far(self, k: int) -> Bools:
        """Return which points have parameters far from those of a point, (points,)."""
        return np.asarray((np.abs(self.theta - self.theta[k]) > self.far).any(axis=1))

    def _apart(self, indices: Ints) -> list[int]:
        """Return some points in their order, without those that are not far from one before."""
        out: list[int] = []
        for j in indices.tolist():
            if len(out) == BRANCHES:
                break
            if self._far(j)[out].all():
                out.append(j)
        return out


def _wins(target: Payoff, end: Solution, point: Solution) -> bool:
    """Return whether a solution of the programme through a point is to take its place."""
    beta = target.place(point.J)
    if end.converged and not point.converged:
        return not target.is_better(beta, point.J, end.J)
    return target.is_better(beta, end.J, point.J)


def _from_other(problem: Problem, target: Payoff, point: Solution, start: Solution) -> Solution:
    """Return the programme through a point of the front, solved from another point of it.

    It is not solved to the end where it ends behind the point, or comes to it.
    """
    beta = target.place(point.J)
    programme = Attainment(target, np.zeros((0, point.theta.size))).subproblem(beta)
    end = solve(problem, programme, start, _ROUGH)
    evaluations = end.evaluations
    lead = target.excess(beta, point.J).max() - target.excess(beta, end.J).max()
    away = np.abs((end.theta - point.theta) / (problem.upper - problem.lower)).max()
    if lead >= -BEHIND and not (end.converged and away < ARRIVED):
        for _ in range(FINISHES):
            end = solve(problem, programme, end)
            evaluations += end.evaluations
            if end.converged or not target.is_better(beta, end.J, point.J):
                break
    return replace(end, evaluations=evaluations, beta=point.beta)
