"""Every model that was evaluated competes: the nondominated ones of all evaluations of a run.

A search evaluates many models on its way. One of them may be better than what another search ends
at; a point is Pareto optimal only where none of them dominates it. The archive stands between the
solvers and a problem and keeps the models that no other one dominates. With the result of each task
those that it has evaluated are stored, so that a run that is continued knows the same models.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront.solvers.problem import Evaluation, Problem
from modefront.work.codec import record
from modefront.work.task import Executor, R, Task

ROOM = 64
"""Models for which there is room at first; it doubles when it is full."""


@dataclass
class Archive:
    """A problem that keeps the nondominated models of all its evaluations.

    It is a problem like any other (`modefront.solvers.problem.Problem`).

    Attributes
    ----------
    problem : the problem that is evaluated
    """

    problem: Problem
    _theta: Floats = field(init=False, repr=False)
    _J: Floats = field(init=False, repr=False)
    _count: int = 0

    def __post_init__(self) -> None:
        self._theta = np.zeros((ROOM, self.lower.size))
        self._J = np.zeros((ROOM, len(self.objectives)))

    @property
    def theta(self) -> Floats:
        """Parameters (models, p), in the order in which they were evaluated."""
        return self._theta[: self._count].copy()

    @property
    def J(self) -> Floats:
        """Objectives (models, n), likewise."""
        return self._J[: self._count].copy()

    @property
    def objectives(self) -> tuple[str, ...]:
        """Names of the objectives."""
        return self.problem.objectives

    @property
    def lower(self) -> Floats:
        """Lower bounds, shape (p,)."""
        return self.problem.lower

    @property
    def upper(self) -> Floats:
        """Upper bounds, shape (p,)."""
        return self.problem.upper

    @property
    def start(self) -> Floats:
        """A first guess, shape (p,)."""
        return self.problem.start

    def evaluate(self, theta: Floats, *, derivatives: bool = True) -> Evaluation:
        """Return the objectives at ``theta``, and remember them."""
        evaluation = self.problem.evaluate(theta, derivatives=derivatives)
        self.add(evaluation.theta, evaluation.J)
        return evaluation

    def on_branch(self, branch: tuple[int, ...]) -> Problem:
        """Return the problem of one smooth piece; its evaluations are not remembered."""
        return self.problem.on_branch(branch)

    def add(self, theta: Floats, J: Floats) -> None:
        """Keep a model, unless another one is nowhere worse, and drop those that it dominates."""
        if not np.isfinite(J).all():
            return
        known = self._J[: self._count].T
        nowhere_worse, better_somewhere = known[0] <= J[0], known[0] < J[0]
        for values, value in zip(known[1:], J[1:], strict=True):
            nowhere_worse &= values <= value
            better_somewhere |= values < value
        if nowhere_worse.any():
            return
        if not better_somewhere.all():
            kept = np.flatnonzero(better_somewhere)
            self._theta[: kept.size], self._J[: kept.size] = self._theta[kept], self._J[kept]
            self._count = kept.size
        if self._count == len(self._J):
            self._theta = np.concatenate([self._theta, np.zeros_like(self._theta)])
            self._J = np.concatenate([self._J, np.zeros_like(self._J)])
        self._theta[self._count], self._J[self._count] = theta, J
        self._count += 1


@record
@dataclass(frozen=True)
class Archived:
    """The result of a task with the nondominated models of its evaluations.

    Attributes
    ----------
    result : of the task
    theta, J : (models, p) and (models, n)
    """

    result: Any
    theta: Floats
    J: Floats


@dataclass(frozen=True)
class Archiving:
    """An executor that adds all models that tasks evaluate to an archive.

    The first argument of every task is the problem, or the archive in its place.
    """

    inner: Executor
    archive: Archive

    def run(self, tasks: Sequence[Task[R]], ahead: Sequence[Task[Any]] = (), /) -> list[R]:
        """Return the results of the tasks."""
        results = self.inner.run([self._of(x) for x in tasks], [self._of(x) for x in ahead])
        for each in results:
            for theta, J in zip(each.theta, each.J, strict=True):
                self.archive.add(theta, J)
        return [each.result for each in results]

    def expect(self, stages: Mapping[str, int]) -> None:
        """Pass on the extent of the work."""
        self.inner.expect(stages)

    def _of(self, task: Task[Any]) -> Task[Archived]:
        """Return a task that evaluates the problem itself, and returns what it evaluated."""
        problem, *others = task.arguments
        if problem is self.archive:
            problem = self.archive.problem
        return replace(task, function=archived, arguments=(task.function, problem, *others))


def archived(
    function: Callable[..., Any],
    problem: Problem,
    *arguments: Any,
    work: Executor | None = None,
    **options: Any,
) -> Archived:
    """Return the result of a function of a problem, and the models that it evaluates.

    ``work`` computes the parts of the function, if it has any.
    """
    archive = Archive(problem)
    if work is not None:
        options["work"] = Archiving(work, archive)
    result = function(archive, *arguments, **options)
    return Archived(result, archive.theta, archive.J)
