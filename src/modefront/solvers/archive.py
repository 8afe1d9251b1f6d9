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


@dataclass
class Archive:
    """A problem that keeps the nondominated models of all its evaluations.

    It is a problem like any other (`modefront.solvers.problem.Problem`).

    Attributes
    ----------
    problem : the problem that is evaluated
    theta, J : (models, p) and (models, n), in the order in which they were evaluated
    """

    problem: Problem
    theta: Floats = field(init=False)
    J: Floats = field(init=False)

    def __post_init__(self) -> None:
        self.theta = np.zeros((0, self.lower.size))
        self.J = np.zeros((0, len(self.objectives)))

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
        at = self.problem.evaluate(theta, derivatives=derivatives)
        self.add(at.theta, at.J)
        return at

    def on_branch(self, branch: tuple[int, ...]) -> Problem:
        """Return the problem of one smooth piece; its evaluations are not remembered."""
        return self.problem.on_branch(branch)

    def add(self, theta: Floats, J: Floats) -> None:
        """Keep a model, unless another one is nowhere worse, and drop those that it dominates."""
        if not np.isfinite(J).all() or (self.J <= J).all(axis=1).any():
            return
        kept = (self.J < J).any(axis=1)
        self.theta = np.vstack([self.theta[kept], theta])
        self.J = np.vstack([self.J[kept], J])


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
