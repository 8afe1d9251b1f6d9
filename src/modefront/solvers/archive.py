"""Every model that was evaluated competes: the nondominated ones of all evaluations of a run.

A search evaluates many models on its way. One of them may be better than what another search ends
at; a point is Pareto optimal only where none of them dominates it. The archive stands between the
solvers and a problem and keeps the models that no other one dominates. With each piece of work it
stores those that the piece has added, so that a run that is continued knows the same models.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from modefront._typing import Floats
from modefront.solvers.checkpoint import Checkpoint, Solutions
from modefront.solvers.problem import Evaluation, Problem
from modefront.solvers.sqp import Solution, Status


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

    @property
    def counts(self) -> Mapping[str, int]:
        """What the evaluations have cost so far, by name."""
        return self.problem.counts

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

    def keeping(self, checkpoint: Checkpoint) -> Checkpoint:
        """Return a checkpoint that keeps the models added by each piece of work with it."""

        def kept(name: str, compute: Callable[[], Solutions]) -> Solutions:
            def work() -> list[Solution]:
                before = {row.tobytes() for row in self.theta}
                found = list(compute())
                added = [k for k, row in enumerate(self.theta) if row.tobytes() not in before]
                return [*found, *(_visited(self.theta[k], self.J[k]) for k in added)]

            found = checkpoint(name, work)
            for one in found:
                if one.status is Status.VISITED:
                    self.add(one.at.theta, one.at.J)
            return [one for one in found if one.status is not Status.VISITED]

        return kept


def _visited(theta: Floats, J: Floats) -> Solution:
    none = np.zeros(0)
    return Solution(Evaluation(theta, J), none, none, 0.0, Status.VISITED, 0)
