"""Every model that was evaluated competes: the nondominated ones of all evaluations of a search."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront.optim.problem import Evaluation, Problem, Wrapped
from modefront.work.codec import record

ROOM = 64
"""Models for which there is room at first; it doubles when it is full."""


@dataclass
class Archive:
    """The models that no other evaluated model dominates: ``theta`` (., p) and ``J`` (., n)."""

    parameters: int
    objectives: int
    _theta: Floats = field(init=False, repr=False)
    _J: Floats = field(init=False, repr=False)
    _count: int = 0

    def __post_init__(self) -> None:
        self._theta = np.zeros((ROOM, self.parameters))
        self._J = np.zeros((ROOM, self.objectives))

    @property
    def theta(self) -> Floats:
        """Parameters (models, p), in the order in which they were evaluated."""
        return self._theta[: self._count]

    @property
    def J(self) -> Floats:
        """Objectives (models, n), likewise."""
        return self._J[: self._count]

    def add(self, theta: Floats, J: Floats) -> None:
        """Keep a model, unless another one is nowhere worse, and drop those that it dominates."""
        if not np.isfinite(J).all():
            return
        worse = self.J > J
        if not worse.any(axis=1).all():
            return
        kept = np.flatnonzero((self.J < J).any(axis=1))
        if kept.size < self._count:
            self._theta[: kept.size], self._J[: kept.size] = self._theta[kept], self._J[kept]
            self._count = kept.size
        if self._count == len(self._J):
            self._theta = np.concatenate([self._theta, np.zeros_like(self._theta)])
            self._J = np.concatenate([self._J, np.zeros_like(self._J)])
        self._theta[self._count], self._J[self._count] = theta, J
        self._count += 1


@dataclass
class Recorder:
    """Counts the evaluations of a problem, and archives the nondominated ones."""

    archive: Archive
    evaluations: int = 0

    def evaluation(
        self, problem: Problem, theta: Floats, derivatives: bool, second: bool
    ) -> Evaluation:
        """Return the evaluation of a problem at ``theta``, and remember it."""
        evaluation = problem.evaluate(theta, derivatives=derivatives, second=second)
        self.evaluations += 1
        self.archive.add(evaluation.theta, evaluation.J)
        return evaluation


@record
@dataclass(frozen=True)
class Outcome:
    """What a task found: its result, and the nondominated of the models that it evaluated.

    Attributes
    ----------
    result : of the task
    theta, J : (models, p) and (models, n)
    evaluations : number of evaluations
    """

    result: Any
    theta: Floats
    J: Floats
    evaluations: int


def recorded(
    function: Callable[..., Any], problem: Problem, *arguments: Any, **options: Any
) -> Outcome:
    """Return the result of a function of a problem, with the models that it evaluates."""
    seen = Recorder(Archive(problem.lower.size, len(problem.objectives)))
    result = function(Wrapped(problem, seen.evaluation), *arguments, **options)
    return Outcome(result, seen.archive.theta, seen.archive.J, seen.evaluations)
