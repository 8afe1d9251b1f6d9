"""The state of a search: an incumbent for each subproblem, and all that is known of models."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront.front.archive import Archive, Outcome, limited
from modefront.front.dominance import SAME
from modefront.front.subproblems import Subproblem
from modefront.optim.problem import Evaluation, Problem
from modefront.optim.sqp import Solution, begin
from modefront.work.task import Executor, Task

DISTINCT = 1e-3
"""Distance of two models, over the ranges of the parameters, above which they are two."""

COPY = 10 * SAME
"""Distance of two points, over the ranges of the objectives, below which they are copies."""


@dataclass
class Place:
    """A subproblem with the best model known.

    Attributes
    ----------
    incumbent : the best model
    closed : whether the search from the incumbent itself leads nowhere better
    compared : number of known models that were compared with the incumbent as rivals
    """

    subproblem: Subproblem
    incumbent: Solution
    closed: bool = False
    compared: int = 0


@dataclass
class State:
    """What a search knows.

    Attributes
    ----------
    problem : that is searched
    tolerance : gain of a subproblem that counts
    places : subproblems with their incumbents
    archive : nondominated models of all evaluations
    models : solutions that programmes led to, each once, in the order in which they were found
    evaluations : so far
    """

    problem: Problem
    tolerance: float
    archive: Archive
    places: list[Place] = field(default_factory=list)
    models: list[Solution] = field(default_factory=list)
    evaluations: int = 0

    @property
    def span(self) -> Floats:
        """Ranges of the parameters, (p,)."""
        return self.problem.upper - self.problem.lower

    def add(self, subproblems: Sequence[Subproblem]) -> None:
        """Add subproblems, with the best of the known models."""
        for subproblem in subproblems:
            self.places.append(Place(subproblem, self.best(subproblem)))

    def best(self, subproblem: Subproblem) -> Solution:
        """Return the best of the known models in a subproblem."""
        k = int(subproblem.value(self.archive.J).argmin())
        best = begin(Evaluation(self.archive.theta[k].copy(), self.archive.J[k].copy()))
        values = [float(subproblem.value(x.J)) for x in self.models]
        near = int(np.argmin(values)) if values else -1
        # a model whose derivatives are known saves an evaluation
        close = near >= 0 and subproblem.gain(best.J, self.models[near]) <= self.tolerance
        return self.models[near] if close else best

    def note(self, outcome: Outcome) -> None:
        """Count the evaluations of a task, and archive its models."""
        self.evaluations += outcome.evaluations
        for theta, J in zip(outcome.theta, outcome.J, strict=True):
            self.archive.add(theta, J)

    def tell(self, k: int, start: Solution, final: bool, outcome: Outcome) -> float:
        """Take note of what a search led to; return the greatest gain of a subproblem.

        It is a solution of the place ``k`` where it is ``final``.
        """
        solution: Solution | None = outcome.result
        self.note(outcome)
        gain = 0.0
        if final and solution:
            place = self.places[k]
            is_incumbent = start is place.incumbent
            if solution.feasible:
                own = place.subproblem.gain(solution.J, place.incumbent)
                gain = max(gain, own)
                if self._replaces(solution, own, place, is_incumbent):
                    place.incumbent, is_incumbent = solution, True
            place.closed = place.closed or is_incumbent
        for place in self.places:
            gain = max(gain, self.challenge(place, outcome.theta, outcome.J, solution))
        is_known = not (solution and solution.feasible and solution.evaluation.derivatives)
        if solution and not is_known and self.is_new(solution, self.models):
            self.models.append(solution)
        return gain

    def _replaces(self, solution: Solution, gain: float, place: Place, is_incumbent: bool) -> bool:
        """Return whether a solution of a place, from its incumbent or not, takes that place."""
        if place.subproblem.competes:
            first = (solution.converged or is_incumbent) and not place.closed
            return gain > 0 or (gain > -self.tolerance and first)
        return not place.closed or (solution.converged and not place.incumbent.converged)

    def challenge(
        self, place: Place, theta: Floats, J: Floats, solution: Solution | None = None
    ) -> float:
        """Let models compete for a place; return the gain where it had been solved, else 0."""
        if not len(J) or (place.closed and not place.subproblem.competes):
            return 0.0
        k = int(place.subproblem.value(J).argmin())
        gain = place.subproblem.gain(J[k], place.incumbent)
        if gain <= self.tolerance:
            return 0.0
        was_closed = place.closed
        known = solution is not None and np.array_equal(solution.theta, theta[k])
        place.incumbent = (
            solution if known and solution else begin(Evaluation(theta[k].copy(), J[k].copy()))
        )
        place.closed = False
        return gain if was_closed else 0.0

    def is_new(self, solution: Solution, known: Sequence[Solution]) -> bool:
        """Return whether a solution is another model than all known ones."""
        apart = (np.abs((solution.theta - x.theta) / self.span).max() for x in known)
        return all(distance > DISTINCT for distance in apart)


@dataclass
class Counted:
    """Carries out tasks on a problem, whose models are archived, within a budget.

    Attributes
    ----------
    state : which takes note of them
    inner : carries out the tasks
    budget : evaluations up to which tasks have a result; None where each of them has
    spent : whether some task had none
    """

    state: State
    inner: Executor
    budget: int | None = None
    spent: bool = False

    def run(self, tasks: Sequence[Task[Any]]) -> list[Any]:
        """Return the results of tasks, None where the evaluations of one were spent."""
        outcomes = self.inner.run([limited(task, self.share(len(tasks))) for task in tasks])
        for outcome in outcomes:
            self.state.note(outcome)
            self.spent |= outcome.spent
        return [outcome.result for outcome in outcomes]

    def share(self, tasks: int) -> int | None:
        """Return the evaluations that each of so many tasks may make."""
        if self.budget is None:
            return None
        return max(self.budget - self.state.evaluations, 0) // max(tasks, 1)

    def expect(self, stages: Mapping[str, int]) -> None:
        """Pass on the extent of the work."""
        self.inner.expect(stages)


def distinct_points(points: Sequence[Solution], scale: Floats) -> list[Solution]:
    """Return points of a front, each once: objectives over ``scale`` (n,) tell copies apart."""
    out: list[Solution] = []
    for x in points:
        same = [k for k, y in enumerate(out) if (np.abs(y.J - x.J) <= COPY * scale).all()]
        if not same:
            out.append(x)
        elif x.converged and not out[same[0]].converged:
            out[same[0]] = x
    return out
