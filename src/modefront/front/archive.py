"""Every model that was evaluated competes: the nondominated ones of all evaluations of a search."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront.optim.problem import Evaluation, Problem, SpentError, Wrapped
from modefront.work.codec import record
from modefront.work.task import Task


@dataclass
class Archive:
    """The models that no other evaluated model dominates: ``theta`` (., p) and ``J`` (., n).

    They are in the order in which they were evaluated.
    """

    parameters: int
    objectives: int
    thetas: list[Floats] = field(default_factory=list)
    J: Floats = field(init=False)

    def __post_init__(self) -> None:
        self.J = np.zeros((0, self.objectives))

    @property
    def theta(self) -> Floats:
        """Parameters (models, p)."""
        return np.array(self.thetas).reshape(-1, self.parameters)

    def add(self, theta: Floats, J: Floats) -> None:
        """Keep a model, unless another one is nowhere worse, and drop those that it dominates."""
        if not np.isfinite(J).all() or not (self.J > J).any(axis=1).all():
            return
        kept = (self.J < J).any(axis=1)
        if not kept.all():
            self.thetas = [self.thetas[k] for k in np.flatnonzero(kept)]
        self.thetas.append(theta)
        self.J = np.vstack([self.J[kept], J])


@record
@dataclass(frozen=True)
class Outcome:
    """What a task found: its result, and the nondominated of the models that it evaluated.

    Attributes
    ----------
    result : of the task; None where its evaluations were spent before
    theta, J : (models, p) and (models, n)
    evaluations : number of evaluations
    spent : whether there was none left for it to end
    """

    result: Any
    theta: Floats
    J: Floats
    evaluations: int
    spent: bool = False


def recorded(
    function: Callable[..., Any],
    most: int | None,
    problem: Problem,
    *arguments: Any,
    **options: Any,
) -> Outcome:
    """Return the result of a function of a problem, with the models that it evaluates."""
    archive, count = Archive(problem.lower.size, len(problem.objectives)), 0

    def evaluation(of: Problem, theta: Floats, derivatives: bool, second: bool) -> Evaluation:
        nonlocal count
        if most is not None and count >= most:
            raise SpentError
        count += 1
        found = of.evaluate(theta, derivatives=derivatives, second=second)
        archive.add(found.theta, found.J)
        return found

    try:
        result = function(Wrapped(problem, evaluation), *arguments, **options)
    except SpentError:
        return Outcome(None, archive.theta, archive.J, count, spent=True)
    return Outcome(result, archive.theta, archive.J, count)


def limited(task: Task[Any], most: int | None) -> Task[Outcome]:
    """Return a task on a problem, its first argument, with the evaluations that it may make."""
    return replace(task, function=recorded, arguments=(task.function, most, *task.arguments))
