r"""Points of a front solved again from the points beside them, and from visited models.

Where branches of the front meet, or the front folds, the lattice leads along one branch as far as
it goes, and another one may be better. So each point of the front is compared with the points
beside it. On one smooth branch both are near in the parameters, and each lies above the tangent
plane of the front at the other one by nearly the same height,

.. math:: h_{kj} = w_j^T (y_k - y_j) \approx \tfrac12 (y_k - y_j)^T \kappa\, (y_k - y_j)
    \approx h_{jk} ,

up to the third order of their distance. Where that does not hold, the programme through the point,

.. math:: \min_\theta\; \max_i \frac{y_i(\theta) - y_{k,i}}{r_i} ,

which is negative as soon as a model dominates the point, is solved from the other one
(`modefront.solvers.attainment`). So it is from the models that some search has visited on its way
and that lie little behind the point, far from it in the parameters: a basin in which no search has
ended, and so no point of the front lies, shows in these only. Of two objectives, each of these is
tried at one point first, and points compete with one another where the front was explored.

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

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np

from modefront._typing import Bools, Floats, Ints
from modefront.solvers.archive import Archive
from modefront.solvers.attainment import SAME
from modefront.solvers.basins import programmes_of
from modefront.solvers.continuation import JUMP, Simplex
from modefront.solvers.flat import same
from modefront.solvers.payoff import Payoff
from modefront.solvers.problem import Problem
from modefront.solvers.sqp import Options, Solution, Status, begin, solve
from modefront.work.task import IMMEDIATE, Executor, Key, Task

ROUNDS = 4
"""Times at most that all points are compared, besides a first time with the visited models only:
what one has gained may lead others on."""

BESIDE = 1.5
"""Distance of points that are compared, in steps of the ranges."""

NEAREST, MANY = 3, 6
"""Points that each point is compared with however far they are, since the front may have gaps; and
as soon as some point has gained. On a frame with many minima (`benchmarks/edges.py`, frame-4), 3, 6
and 10 improve 3, 37 and 53 of 236 points with 8,000, 17,000 and 32,000 evaluations."""

SIDES = 1
"""The same of two objectives, where other branches count for more. With the nearest one, a rugged
front of 185 points (`benchmarks/rugged.py`, rugged ZDT3) has none behind the true one by 1 % of the
ranges instead of 37, with a third more evaluations; with three, others take twice as many and gain
nothing."""

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

VISITED, LITTLE = 3, 1.0
"""Models visited at most from which a point is solved, and their excess over the point at most, in
steps of the ranges. On a frame with many minima (`benchmarks/edges.py`, frame-4), three of a step
improve 32 of 208 points with 9,000 evaluations, and three of 0.3 steps 23 with 5,500."""

FINISHES = 2
"""Searches at most from a model that dominates a point: beside exact fits one does not suffice.
With the rule of two objectives, 11 of 12 fronts of three are as they were, but one of 220 points of
a frame (`benchmarks/edges.py`, frame-26) is left behind by 6 % of an objective."""

WORTH = 0.1
"""Share of the best visited models that have to lead to a better point, or the next best ones are
left out, of two objectives; likewise of the nearest of other points. On 74 problems
(`benchmarks/edges.py`), 7 of 464 searches from the best visited models for each point did, by up to
0.8 of the ranges, and 1 of 465 from the next two, by 5e-4."""

PARTS = 10
"""Parts of a search of two objectives, which goes on as long as it catches up with the point, at
most: together no longer than the two searches that finish those of more."""

_ROUGH = Options(step=1e-4, iterations=20)
_PART = Options(iterations=20)


# 7 arguments: the front, and what is known beside it.
def from_points_beside(
    problem: Problem,
    target: Payoff,
    lattice: Simplex,
    points: Sequence[Solution],
    work: Executor = IMMEDIATE,
    before: Sequence[Solution] = (),
    visited: Archive | None = None,
) -> list[Solution]:
    """Return the points, each solved again from those beside it on what may be another branch.

    Points that are new compete with the models that the run has ``visited``, too. A point keeps
    its place on the lattice. Pairs of points that were so ``before`` are not tried.
    """
    kept = [k for k, pair in enumerate(zip(points, before, strict=False)) if same(*pair)]
    attempts = {(k, points[j].theta.tobytes()) for k in kept for j in kept}
    competition = _Competition(problem, target, lattice, list(points), attempts)
    new = set(range(len(points))) - set(kept)
    gained = 0
    for turn in range(ROUNDS + 1):
        name: Key = ("front", "nbi", "branches", turn)
        tasks = competition.from_visited(name, new, visited) if visited else []
        if turn:
            tasks += competition.from_points(name, MANY if gained else NEAREST)
        new = competition.won(tasks, work)
        gained += len(new)
        if turn and not new and (not tasks or not gained):
            break
    return competition.points


def from_neighbours(
    problem: Problem,
    target: Payoff,
    lattice: Simplex,
    points: Sequence[Solution],
    work: Executor = IMMEDIATE,
) -> list[Solution]:
    """Return the points of two objectives, each solved again from those beside it.

    The nearest of other branches comes first, and others follow only where enough points gain.
    """
    competition = _Competition(problem, target, lattice, list(points), set())
    for turn in range(ROUNDS):
        if not competition.won_by_rank(("front", "nbi", "neighbours", turn), work):
            break
    return competition.points


# 6 arguments: the front, and what is known beside it.
def from_visited(
    problem: Problem,
    target: Payoff,
    lattice: Simplex,
    points: Sequence[Solution],
    visited: Archive,
    work: Executor = IMMEDIATE,
) -> list[Solution]:
    """Return the points, each solved again from models that the run has visited in other basins.

    A model is tried at the one point that it is the least behind, of those for which it is the best
    one; only where that gains, it is tried at the others, and only where enough have gained, the
    next best models are. A search that does not catch up is given up: where parameters outnumber
    data, every search leaves models behind that are far from all points, and lead to others with
    the same objectives, slowly.
    """
    competition = _Competition(problem, target, lattice, list(points), set())
    new = set(range(len(points)))
    for turn in range(ROUNDS):
        gained: set[int] = set()
        for rank in range(VISITED):
            name: Key = ("front", "nbi", "visited", turn)
            groups = competition.by_best_visited(new - gained, visited, rank)
            firsts = [
                start
                for theta, of in groups
                for start in competition.from_one(name, rank, theta, of[:1])
            ]
            better = competition.won(firsts, work)
            rest = [
                start
                for theta, of in groups
                if of[0] in better
                for start in competition.from_one(name, rank, theta, of[1:])
            ]
            gained |= better | competition.won(rest, work)
            if len(better) < WORTH * len(groups):
                break
        if not gained:
            break
        new = gained
    return competition.points


def polished(
    problem: Problem, target: Payoff, points: Sequence[Solution], work: Executor = IMMEDIATE
) -> list[Solution]:
    """Return the points, each solved once more through itself.

    Where the front is a cliff, a point that has converged may lie 1e-8 of the ranges behind it,
    which is worth percents of the objective that falls there. Others cost nothing: their first step
    is below the tolerance. Points that have learned no second derivatives, which are not of such a
    programme's making, would begin anew: they stay.
    """
    chosen = [k for k, point in enumerate(points) if point.converged and point.learned.any()]
    tasks = [
        Task(("front", "nbi", "polished", k + 1), _through, (problem, target, points[k]))
        for k in chosen
    ]
    out = list(points)
    for k, end in zip(chosen, work.run(tasks), strict=True):
        if end.converged and (end.J <= points[k].J).all() and (end.J < points[k].J).any():
            out[k] = replace(end, evaluations=points[k].evaluations + end.evaluations)
    return out


Start: TypeAlias = tuple[int, Task[Solution]]
"""The index of a point, and the task that solves it again."""


@dataclass
class _Competition:
    """The points of a front so far, and from which parameters each was solved again."""

    problem: Problem
    target: Payoff
    lattice: Simplex
    points: list[Solution]
    attempts: set[tuple[int, bytes]]
    comparison: Comparison = field(init=False)

    def __post_init__(self) -> None:
        self.comparison = Comparison.of(self.problem, self.target, self.lattice, self.points)

    def from_visited(self, name: Key, new: Collection[int], archive: Archive) -> list[Start]:
        """Return the tasks that solve points that are ``new`` from the models of an archive."""
        visited = Visited.of(self.problem, self.target, self.lattice, archive)
        return [
            self._start(k, (*name, k + 1, "visited", rank + 1), _from_visited, theta)
            for k in self.comparison.open.tolist()
            if k in new
            for rank, theta in enumerate(visited.starts(self.points[k]))
            if self._is_untried(k, theta)
        ]

    def by_best_visited(
        self, new: Collection[int], archive: Archive, rank: int
    ) -> list[tuple[Floats, list[int]]]:
        """Return models of an archive, each with the points that it is to be tried at.

        These are ``new``, the model is the best one for them, or of lower ``rank``, and it is the
        least behind the first of them.
        """
        visited = Visited.of(self.problem, self.target, self.lattice, archive)
        groups: dict[int, list[tuple[float, int]]] = {}
        for k in self.comparison.open.tolist():
            best = visited.best(self.points[k]) if k in new else []
            if len(best) > rank and (k, visited.theta[best[rank]].tobytes()) not in self.attempts:
                behind = float(visited.excess(self.points[k])[best[rank]])
                groups.setdefault(best[rank], []).append((behind, k))
        return [(visited.theta[i], [k for _, k in sorted(of)]) for i, of in groups.items()]

    def from_one(self, name: Key, rank: int, theta: Floats, of: Sequence[int]) -> list[Start]:
        """Return the tasks that solve points from one model of an archive."""
        return [
            self._start(k, (*name, k + 1, "visited", rank + 1), _from_visited, theta)
            for k in of
            if self._is_untried(k, theta)
        ]

    def from_points(self, name: Key, count: int) -> list[Start]:
        """Return the tasks that solve points from ``count`` nearest others, and other branches."""
        return [
            self._start(k, (*name, k + 1, j + 1), _from_other, self.points[j])
            for k in self.comparison.open.tolist()
            for j in self.comparison.starts(k, count)
            if self._is_untried(k, self.points[j].theta)
        ]

    def won_by_rank(self, name: Key, work: Executor) -> set[int]:
        """Return the indices of points of two objectives in whose places better solutions are.

        Each is solved from the first of the other points that come into question, and if enough
        have gained by that, those that have not from the next one.
        """
        out: set[int] = set()
        for rank in range(BRANCHES + LOWER + SIDES):
            starts = [
                self._start(k, (*name, rank + 1, k + 1, j + 1), _from_other, self.points[j])
                for k in self.comparison.open.tolist()
                if k not in out
                for j in self.comparison.starts(k, SIDES)[rank : rank + 1]
                if self._is_untried(k, self.points[j].theta)
            ]
            better = self.won(starts, work)
            out |= better
            if len(better) < WORTH * len(starts):
                break
        return out

    def won(self, starts: Sequence[Start], work: Executor) -> set[int]:
        """Return the indices of the points whose places better solutions have taken."""
        out = set()
        ends = work.run([task for _, task in starts])
        for (k, _), end in zip(starts, ends, strict=True):
            if _wins(self.target, end, self.points[k]):
                self.points[k] = end
                out.add(k)
        if out:
            self.comparison = Comparison.of(self.problem, self.target, self.lattice, self.points)
        return out

    def _is_untried(self, k: int, theta: Floats) -> bool:
        """Return whether a point was not solved from these parameters, and take note of them."""
        untried = (k, theta.tobytes()) not in self.attempts
        self.attempts.add((k, theta.tobytes()))
        return untried

    def _start(
        self, k: int, key: Key, function: Callable[..., Solution], start: Solution | Floats
    ) -> Start:
        return k, Task(key, function, (self.problem, self.target, self.points[k], start))


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


@dataclass(frozen=True)
class Visited:
    """The models that the run has visited and that no other one of these dominates.

    Attributes
    ----------
    theta : (m, p) parameters
    J : (m, n) objectives
    span : (p,) ranges of the parameters
    normal : (n,) towards greater objectives
    far : change of a parameter from which models are far from one another, over its range
    little : excess over a point up to which a model lies little behind it
    """

    theta: Floats
    J: Floats
    span: Floats
    normal: Floats
    far: float
    little: float

    @classmethod
    def of(cls, problem: Problem, target: Payoff, lattice: Simplex, archive: Archive) -> Visited:
        """Return the models of an archive beside the points of a lattice."""
        normal = target.scale * target.Phi.sum(axis=1)
        span, little = problem.upper - problem.lower, LITTLE / lattice.divisions
        return cls(archive.theta, archive.J, span, normal, JUMP, little)

    def starts(self, point: Solution) -> list[Floats]:
        """Return the parameters (p,) of the best models far from a point and from one another."""
        return [self.theta[i] for i in self.best(point)]

    def best(self, point: Solution) -> list[int]:
        """Return the indices of the best models far from a point and from one another."""
        excess = self.excess(point)
        near = np.flatnonzero(excess < self.little)
        left = near[excess[near].argsort(kind="stable")]
        left = left[self._far(left, point.theta)]
        out: list[int] = []
        while left.size and len(out) < VISITED:
            out.append(int(left[0]))
            left = left[self._far(left, self.theta[out[-1]])]
        return out

    def excess(self, point: Solution) -> Floats:
        """Return how far each model lies behind a point, (models,), in units of the ranges."""
        return np.asarray(((self.J - point.J) / self.normal).max(axis=1))

    def _far(self, indices: Ints, theta: Floats) -> Bools:
        """Return which of some models are far from parameters (p,)."""
        away = np.abs(self.theta[indices] - theta) > self.far * self.span
        return np.asarray(away.any(axis=1))


def _wins(target: Payoff, end: Solution, point: Solution) -> bool:
    """Return whether a solution of the programme through a point is to take its place."""
    beta = target.place(point.J)
    if end.converged and not point.converged:
        return not target.is_better(beta, point.J, end.J)
    return target.is_better(beta, end.J, point.J)


def _through(problem: Problem, target: Payoff, point: Solution) -> Solution:
    """Return the programme through a point of the front, solved from the point itself.

    The weights stay those of the programme of its place, whose bounds need not all be active.
    """
    programme = programmes_of(problem, target).subproblem(target.place(point.J))
    return replace(solve(problem, programme, point), beta=point.beta, weights=point.weights)


def _from_visited(problem: Problem, target: Payoff, point: Solution, theta: Floats) -> Solution:
    """Return the programme through a point of the front, solved from a visited model."""
    end = _from_other(problem, target, point, begin(problem.evaluate(theta)))
    return replace(end, evaluations=end.evaluations + 1)


def _behind(target: Payoff, point: Solution, end: Solution) -> float:
    """Return how far the end of a search lies behind a point, in units of the ranges."""
    beta = target.place(point.J)
    return float(target.excess(beta, end.J).max() - target.excess(beta, point.J).max())


def _has_come_to(problem: Problem, point: Solution, end: Solution) -> bool:
    """Return whether a search has ended at a point."""
    away = np.abs((end.theta - point.theta) / (problem.upper - problem.lower)).max()
    return end.converged and bool(away < ARRIVED)


def _from_other(problem: Problem, target: Payoff, point: Solution, start: Solution) -> Solution:
    """Return the programme through a point of the front, solved from another point of it.

    It is not solved to the end where it ends behind the point, or comes to it; nor, of two
    objectives, where one part has not caught up with half of what the one before lay behind.
    """
    beta, two = target.place(point.J), point.J.size == 2
    programme = programmes_of(problem, target).subproblem(beta)
    end = solve(problem, programme, start, _ROUGH)
    evaluations, behind = end.evaluations, _behind(target, point, end)
    if behind <= BEHIND and not _has_come_to(problem, point, end):
        for options in [_PART] * PARTS if two else [Options()] * FINISHES:
            before, end = behind, solve(problem, programme, end, options)
            evaluations, behind = evaluations + end.evaluations, _behind(target, point, end)
            ended = end.status is not Status.EXHAUSTED
            if two and (ended or behind > max(before / 2, 0)):
                break
            if not two and (end.converged or not target.is_better(beta, end.J, point.J)):
                break
    return replace(end, evaluations=evaluations, beta=point.beta)
