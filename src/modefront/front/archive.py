"""Every model that was evaluated competes: the nondominated ones of all evaluations of a search."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront.optim.problem import Evaluation, Problem, SpentError, Wrapped
from modefront.optim.sqp import Solution, begin
from modefront.work.codec import record


@dataclass
class Archive:
    """The models that no other evaluated model dominates, with their objectives ``J`` (., n).

    They are in the order in which they were evaluated; of equal ones the last is there.
    """

    objectives: int
    models: list[Any] = field(default_factory=list)
    J: Floats = field(init=False)

    def __post_init__(self) -> None:
        self.J = np.zeros((0, self.objectives))

    def add(self, J: Floats, model: Any) -> None:
        """Keep a model unless another one dominates it, and drop those that it dominates."""
        dominating = (self.J <= J).all(axis=1) & (self.J < J).any(axis=1)
        if not np.isfinite(J).all() or dominating.any():
            return
        kept = (self.J < J).any(axis=1)
        if not kept.all():
            self.models = [self.models[k] for k in np.flatnonzero(kept)]
        self.models.append(model)
        self.J = np.vstack([self.J[kept], J])


@record
@dataclass(frozen=True)
class Outcome:
    """What a task found: its result, and the nondominated of the models that it evaluated."""

    result: Any  # of the task; None where its evaluations were spent before
    theta: Floats  # theta, J: (models, p) and (models, n)
    J: Floats
    evaluations: int  # number of evaluations
    spent: bool = False  # whether there was none left for it to end

    @property
    def models(self) -> list[Solution]:
        """The models, with the result if it is one of them."""
        found = self.result if isinstance(self.result, Solution) and self.result.feasible else None
        return [
            found if found and np.array_equal(found.theta, x) else begin(Evaluation(x, J))
            for x, J in zip(self.theta, self.J, strict=True)
        ]


def recorded(
    function: Callable[..., Any],
    most: int | None,
    problem: Problem,
    *arguments: Any,
    **options: Any,
) -> Outcome:
    """Return the result of a function of a problem, with the models that it evaluates."""
    archive, count = Archive(len(problem.objectives)), 0

    def evaluation(of: Problem, theta: Floats, derivatives: bool, second: bool) -> Evaluation:
        nonlocal count
        if most is not None and count >= most:
            raise SpentError
        count += 1
        found = of.evaluate(theta, derivatives=derivatives, second=second)
        archive.add(found.J, found.theta)
        return found

    result, spent = None, False
    try:
        result = function(Wrapped(problem, evaluation), *arguments, **options)
    except SpentError:
        spent = True
    thetas = np.array(archive.models).reshape(-1, problem.lower.size)
    return Outcome(result, thetas, archive.J, count, spent)
