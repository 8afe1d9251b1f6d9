"""Programmes on a lattice, solved outwards from the edges, each from a neighbour that is solved.

Where two such advances meet, each is checked against the other: the better solution stays, and
its advance goes on. An advance that jumps to another branch is another one from there, so that the
branch which it has left is checked against it. So a front whose parts belong to different minima
gets the best of them everywhere, at the price of a few more programmes.
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations, islice
from math import comb
from typing import Protocol

import numpy as np

from modefront._typing import Floats, Ints
from modefront.solvers.problem import Problem
from modefront.solvers.sqp import Solution
from modefront.work.task import IMMEDIATE, Executor, Task

LatticePoint = tuple[int, ...]
"""A point of the lattice: whole coordinates, one an objective, whose sum is that of its corners."""


@dataclass(frozen=True)
class Simplex:
    """The lattice of Das and Dennis: whole coordinates (points, n), each row of the same sum."""

    counts: Ints

    @property
    def divisions(self) -> int:
        """Steps along each edge."""
        return int(self.counts[0].sum())

    @property
    def beta(self) -> Floats:
        """Barycentric coordinates, shape (points, n)."""
        return np.asarray(self.counts / self.divisions)

    def has(self, beta: Floats) -> bool:
        """Return whether coordinates (n,) are those of a point, within the simplex or beyond it."""
        steps = self.divisions * beta
        return bool(np.abs(steps - np.rint(steps)).max() <= SAME * self.divisions)


def simplex(objectives: int, divisions: int) -> Simplex:
    """Return the lattice of Das and Dennis with ``divisions`` steps along each edge.

    The first point is the edge of the first objective, the last point that of the last one.

    >>> simplex(2, 2).beta.tolist()
    [[1.0, 0.0], [0.5, 0.5], [0.0, 1.0]]
    """
    total = divisions + objectives - 1
    bars = np.array(list(combinations(range(total), objectives - 1)), dtype=int)
    ends = np.hstack([np.full((len(bars), 1), -1), bars, np.full((len(bars), 1), total)])
    return Simplex(np.diff(ends, axis=1)[::-1] - 1)


def default_points(objectives: int) -> int:
    """Return how many points lie along each edge if nothing else is wanted: 20, or fewer of many.

    >>> [default_points(n) for n in (2, 3, 6)]
    [20, 20, 6]
    """
    fitting = (points for points in range(20, 2, -1) if size(objectives, points) <= MANY)
    return next(fitting, 2)


def size(objectives: int, points: int) -> int:
    """Return the number of points of the simplex with so many along each edge."""
    return comb(points + objectives - 2, objectives - 1)


def neighbours(place: LatticePoint) -> list[LatticePoint]:
    """Return the points of the lattice one step from one, within the simplex or beyond it."""
    n = len(place)
    return [
        tuple(x + (k == i) - (k == j) for k, x in enumerate(place))
        for i in range(n)
        for j in range(n)
        if i != j
    ]


class Programmes(Protocol):
    """One programme a point beta (n,) of the lattice."""

    @property
    def label(self) -> str:
        """What the points are called."""

    def goes_on(self, J: Floats, /) -> bool:
        """Return whether points beyond the simplex are wanted next to one with these objectives."""

    @property
    def scale(self) -> Floats:
        """Range of each objective over the edges, shape (n,)."""

    def distance(self, beta: Floats, other: Floats, /) -> Floats:
        """Return the distances (...) of a point (n,) and others (..., n), over the ranges."""

    def place(self, edge: int, J: Floats, /) -> Floats:
        """Return the coordinates (n,) to which an edge with these objectives belongs."""

    def solve(self, problem: Problem, beta: Floats, start: Solution) -> Solution:
        """Return the solution at beta, from a start."""

    def solve_again(self, problem: Problem, beta: Floats, start: Solution) -> Solution:
        """Return the solution at beta, from another start than that of one that converged."""

    def is_better(self, beta: Floats, J: Floats, known: Floats) -> bool:
        """Return whether objectives (n,) solve the programme at beta better than known ones."""


BEYOND, SHARE = 300, 2
"""Points beyond the simplex that are tried at most; of three objectives, where the lattice is not
small, so many times those within. With each further objective a point has more neighbours."""

SMALL = 30
"""Points of a small lattice of three objectives, which the front beyond it may exceed by far."""

APART = 1.0
"""Distance of points beyond the simplex in steps of the ranges, one a division, at least: where the
simplex is narrow, the steps of its lattice across are much shorter than those along it."""

DENSE = 60
"""Points beyond the simplex from which on such distances are kept; fewer cost little."""

ATTEMPTS = 3
"""Neighbours from which a point beyond the simplex is tried at most: where none of these leads to a
solution, the front ends."""

AHEAD = 16
"""Next steps that are named to the executor, at most."""

MANY = 300
"""Points of the simplex that are not exceeded if nothing else is wanted."""

JUMP = 0.25
"""Change of a parameter from a point to its neighbour, over its range, above which the neighbour
counts as one of another branch, from which the first point is checked."""

SAME = 1e-6
"""Distance of two points, over the ranges of the objectives, below which they are one."""


# 7 arguments: the problem and its programmes, and what is known of the front from before.
def continuation(
    problem: Problem,
    programmes: Programmes,
    edges: Sequence[Solution],
    lattice: Simplex,
    work: Executor = IMMEDIATE,
    before: Sequence[Solution] = (),
    resumed: bool = False,
) -> list[Solution]:
    """Return one solution a point of the lattice, in its order, then those beyond the simplex.

    ``before`` are solutions of nearly the same problem, from which points are solved first. Where
    the front is ``resumed``, the edges are nearly the same as well.

    Solutions may be dominated, and those that did not converge say so in their status; beyond the
    simplex only those are returned that converged and are not there yet.
    """
    run = _Continuation(problem, programmes, lattice, work, branches=len(edges))
    for i, edge in enumerate(edges):
        run.from_edge(i, edge)
    run.from_before(before, _resumed if resumed else _from_before)
    run.spread()
    return run.solutions()


# 15 fields: the problem, and the state of the work.
@dataclass
class _Continuation:
    """A continuation at work.

    It has more than ten fields because each step reads and changes all of them.

    Attributes
    ----------
    branches : number of branches met so far
    beyond : points beyond the simplex that were tried
    solved : best solution of each point of the lattice
    origin : branch from which it was reached
    renewed : how often it was accepted
    attempts : neighbours from which it was tried
    queue, doubtful : steps from a point that converged, or did not: where to, and from where
    attempted : steps that are done, with the number of the solution that they started from
    fixed : points that an edge lies on
    left_out : steps to points that lie too close
    """

    problem: Problem
    programmes: Programmes
    lattice: Simplex
    work: Executor
    branches: int
    beyond: int = 0
    solved: dict[LatticePoint, Solution] = field(default_factory=dict)
    origin: dict[LatticePoint, int] = field(default_factory=dict)
    renewed: Counter[LatticePoint] = field(default_factory=Counter)
    attempts: Counter[LatticePoint] = field(default_factory=Counter)
    queue: deque[tuple[LatticePoint, LatticePoint]] = field(default_factory=deque)
    doubtful: deque[tuple[LatticePoint, LatticePoint]] = field(default_factory=deque)
    attempted: set[tuple[LatticePoint, LatticePoint, int]] = field(default_factory=set)
    fixed: set[LatticePoint] = field(default_factory=set)
    left_out: set[tuple[LatticePoint, LatticePoint]] = field(default_factory=set)

    @property
    def few(self) -> bool:
        """Whether there are three objectives at most."""
        return self.lattice.counts.shape[1] <= 3

    @property
    def room(self) -> int:
        """Points beyond the simplex that are tried at most."""
        within = len(self.lattice.counts)
        return SHARE * within if self.few and within > SMALL else BEYOND

    def beta(self, point: LatticePoint) -> Floats:
        """Return the coordinates (n,) of a point of the lattice."""
        return np.array(point) / self.lattice.divisions

    def from_edge(self, number: int, edge: Solution) -> None:
        """Accept an edge at the point it lies on, or the solution of the point next to it."""
        divisions = self.lattice.divisions
        coordinates = divisions * self.programmes.place(number, edge.J)
        point, solution = _nearest(coordinates, divisions), edge
        if np.abs(coordinates - point).max() <= SAME * divisions:
            self.fixed.add(point)
        else:
            key = ("front", self.programmes.label, point, "from-edge", number + 1)
            arguments = (self.problem, self.programmes, self.beta(point), edge)
            solution = self.work.run([Task(key, _solve, arguments)])[0]
        if point not in self.solved or self._better(point, solution, self.solved[point]):
            self._accept(point, solution, number)

    def from_before(self, before: Sequence[Solution], solve: Callable[..., Solution]) -> None:
        """Solve points from their solutions of nearly the same problem."""
        tasks: dict[LatticePoint, Task[Solution]] = {}
        divisions = self.lattice.divisions
        for solution in before:
            if solution.beta is None:
                continue
            point = _nearest(divisions * solution.beta, divisions)
            if point not in self.solved:
                key = ("front", self.programmes.label, point, "again")
                arguments = (self.problem, self.programmes, self.beta(point), solution)
                tasks.setdefault(point, Task(key, solve, arguments))
        for point, solution in zip(tasks, self.work.run(list(tasks.values())), strict=True):
            self._accept(point, solution, -1)

    def spread(self) -> None:
        """Solve every point from its neighbours until none is worth another attempt."""
        while self.queue or self.doubtful:
            point, source = (self.queue or self.doubtful).popleft()
            if not self._worth_trying(point, source):
                continue
            if point not in self.solved and min(point) < 0 and not self._fits(point, source):
                continue
            self._step(point, source)

    def solutions(self) -> list[Solution]:
        """Return the solutions within the simplex, then those beyond that are none of these."""
        within = [tuple(row) for row in self.lattice.counts.tolist()]
        out = [self.solved[point] for point in within]
        for point in sorted(set(self.solved) - set(within), reverse=True):
            solution = self.solved[point]
            J = np.array([x.J for x in out])
            away = (np.abs(J - solution.J) / self.programmes.scale).max(axis=1)
            if solution.converged and away.min() > SAME:
                out.append(solution)
        return out

    def _step(self, point: LatticePoint, source: LatticePoint) -> None:
        """Solve a point from a neighbour, and keep the better solution."""
        start, known = self.solved[source], self.solved.get(point)
        self.attempted.add((point, source, self.renewed[source]))
        self.attempts[point] += 1
        solution = self.work.run([self._task(point, source)], self._next())[0]
        if known is None or self._better(point, solution, known):
            far = self._jumps(solution, start)
            self.branches += far
            self._accept(point, solution, self.branches if far else self.origin[source])
        elif (
            solution.converged
            and not self._better(point, known, solution)
            and not self._jumps(known, start)
        ):
            # The way back leads to what is known, unless one of the two lies in another basin.
            self.attempted.add((source, point, self.renewed[point]))

    def _task(self, point: LatticePoint, source: LatticePoint) -> Task[Solution]:
        """Return the task of a step from a neighbour."""
        known = self.solved.get(point)
        again = known is not None and known.converged
        relation = "again-from" if again else "from"  # which it is may turn out late
        key = ("front", self.programmes.label, point, relation, source, self.renewed[source])
        arguments = (self.problem, self.programmes, self.beta(point), self.solved[source])
        return Task(key, _solve_again if again else _solve, arguments)

    def _next(self) -> list[Task[Solution]]:
        """Return the tasks of the next steps, unless the one at hand changes what they are."""
        steps = islice(self.queue, AHEAD)
        return [
            self._task(*step)
            for step in dict.fromkeys(steps)
            if self._worth_trying(*step) and min(step[0]) >= 0
        ]

    def _accept(self, point: LatticePoint, solution: Solution, branch: int) -> None:
        """Keep a solution, and take note of the steps to its neighbours."""
        self.solved[point], self.origin[point] = solution, branch
        self.renewed[point] += 1
        J, divisions = solution.J, self.lattice.divisions
        nearest = _nearest(divisions * self.programmes.place(branch, J), divisions)
        accepted = self.programmes.goes_on(J) and point == nearest
        steps = self.queue if solution.converged else self.doubtful
        steps.extend((near, point) for near in neighbours(point) if accepted or min(near) >= 0)

    def _worth_trying(self, point: LatticePoint, source: LatticePoint) -> bool:
        """Return whether a step may lead to another or a better solution."""
        if point not in self.solved:
            return True
        if point in self.fixed or (point, source, self.renewed[source]) in self.attempted:
            return False
        if not self.few and min(point) < 0:
            return False
        known, start = self.solved[point], self.solved[source]
        if not known.converged:
            return min(point) >= 0 or self.attempts[point] < ATTEMPTS
        other = self.origin[point] != self.origin[source]
        apart = len(point) == 2 or self._jumps(known, start)
        return start.converged and other and apart

    def _fits(self, point: LatticePoint, source: LatticePoint) -> bool:
        """Return whether there is room for a point beyond the simplex, and it is not too close."""
        if self.beyond >= DENSE and self._are_close(point, [source]):
            # It is left out, and those behind it are reached from the same point.
            if (point, source) not in self.left_out:
                self.left_out.add((point, source))
                self.queue.extend((near, source) for near in neighbours(point) if min(near) < 0)
            return False
        if self.beyond >= DENSE and self._are_close(point, list(self.solved)):
            return False
        self.beyond += 1
        return self.beyond <= self.room

    def _are_close(self, point: LatticePoint, others: list[LatticePoint]) -> bool:
        """Return whether a point lies too close to any of some others."""
        distances = self.programmes.distance(np.array(point), np.array(others))
        return bool(distances.min() < APART - SAME)

    def _jumps(self, solution: Solution, other: Solution) -> bool:
        """Return whether two solutions lie on different branches."""
        span = self.problem.upper - self.problem.lower
        return bool((np.abs(solution.theta - other.theta) > JUMP * span).any())

    def _better(self, point: LatticePoint, solution: Solution, known: Solution) -> bool:
        """Return whether a solution of a point is better than a known one."""
        if solution.converged != known.converged:
            return solution.converged
        return self.programmes.is_better(self.beta(point), solution.J, known.J)


def _solve(problem: Problem, programmes: Programmes, beta: Floats, start: Solution) -> Solution:
    return programmes.solve(problem, beta, start)


def _solve_again(
    problem: Problem, programmes: Programmes, beta: Floats, start: Solution
) -> Solution:
    return programmes.solve_again(problem, beta, start)


def _from_before(
    problem: Problem, programmes: Programmes, beta: Floats, before: Solution
) -> Solution:
    """Return a point from its solution before other edges were found."""
    return programmes.solve(problem, beta, _evaluated_again(problem, before))


def _resumed(problem: Problem, programmes: Programmes, beta: Floats, before: Solution) -> Solution:
    """Return a point from its solution in another basis, by a single step.

    A point that did not converge is left to its neighbours: from its own place it would not again.
    """
    start = _evaluated_again(problem, before)
    if start.feasible and not before.converged:
        return replace(start, evaluations=1, beta=beta)
    return programmes.solve_again(problem, beta, start)


def _evaluated_again(problem: Problem, before: Solution) -> Solution:
    return replace(before, evaluation=problem.evaluate(before.theta))


def _nearest(coordinates: Floats, total: int) -> LatticePoint:
    """Return whole numbers with this sum close to coordinates that have it."""
    floor = np.floor(coordinates + SAME).astype(int)
    short = total - int(floor.sum())
    first = np.argsort(floor - coordinates, kind="stable")[:short]
    floor[first] += 1
    return tuple(floor.tolist())
