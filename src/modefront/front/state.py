"""The state of a search: an archive of models, and an incumbent for each subproblem.

Every model that is evaluated competes for all places, and for one among those of the archive.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront.front.dominance import SAME
from modefront.front.subproblems import Order, Subproblem
from modefront.optim.problem import DISTINCT, Evaluation, Problem, SpentError, Wrapped
from modefront.optim.sqp import Solution, Status, begin
from modefront.work.codec import record
from modefront.work.task import IMMEDIATE, Executor, Task

COPY = 10 * SAME
"""Distance of two points, over the ranges of the objectives, below which they are copies."""


class Archive:
    """The models that no other evaluated model dominates, with their objectives ``J`` (., n).

    They are in the order in which they were evaluated; of equal ones the last is there.
    """

    def __init__(self, objectives: int) -> None:
        self.models: list[Any] = []
        self.J: Floats = np.zeros((0, objectives))

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
    archive = Archive(len(problem.objectives))

    def evaluation(of: Problem, theta: Floats, derivatives: bool, second: bool) -> Evaluation:
        found = of.evaluate(theta, derivatives=derivatives, second=second)
        archive.add(found.J, found.theta)
        return found

    metered = Wrapped(problem, evaluation, most=most)
    result, spent = None, False
    try:
        result = function(metered, *arguments, **options)
    except SpentError:
        spent = True
    thetas = np.array(archive.models).reshape(-1, problem.lower.size)
    return Outcome(result, thetas, archive.J, metered.count, spent)


@dataclass
class Place:
    """A subproblem with the best model known."""

    subproblem: Subproblem
    incumbent: Solution  # the best model
    closed: bool = False  # whether the search from the incumbent itself leads nowhere better


@dataclass
class State:
    """What a search knows."""

    problem: Problem  # that is searched
    tolerance: float  # gain of a subproblem that counts
    work: Executor = IMMEDIATE  # carries out tasks
    # subproblems with their incumbents
    places: list[Place] = field(default_factory=list)
    evaluations: int = 0  # so far
    # nondominated models of all evaluations, as the solutions that they are
    archive: Archive = field(init=False)

    def __post_init__(self) -> None:
        self.archive = Archive(len(self.problem.objectives))

    @property
    def span(self) -> Floats:
        """Ranges of the parameters, (p,)."""
        return self.problem.upper - self.problem.lower

    def add(self, subproblems: Sequence[Subproblem]) -> None:
        """Add subproblems, with the best of the known models."""
        for x in subproblems:
            best = int(x.order.value(self.archive.J).argmin())
            self.places.append(Place(x, self.archive.models[best]))

    @property
    def orders(self) -> Order:
        """The orders of all places, as one of many."""
        orders = [x.subproblem.order for x in self.places]
        parts = zip(*((x.unit, x.offset, x.greatest, x.share) for x in orders), strict=True)
        return Order(*map(np.array, parts))

    def run(self, tasks: Sequence[Task[Any]], most: int | None = None) -> list[Outcome]:
        """Return what tasks on the problem find, each in its share of ``most`` evaluations."""
        share = None if most is None else max(most, 0) // max(len(tasks), 1)
        recording = [
            replace(task, function=recorded, arguments=(task.function, share, *task.arguments))
            for task in tasks
        ]
        outcomes: list[Outcome] = self.work.run(recording)
        for outcome in outcomes:
            self.evaluations += outcome.evaluations
            for model in outcome.models:
                self.archive.add(model.J, model)
        return outcomes

    def tell(self, k: int, start: Solution | None, outcome: Outcome) -> float:
        """Let what a search led to compete; return the greatest gain of a subproblem.

        It is a solution of the place ``k`` from a start, or of none where that is -1.
        """
        solution: Solution | None = outcome.result
        gain = 0.0
        if k >= 0 and solution:
            place = self.places[k]
            is_incumbent, own = start is place.incumbent, 0.0
            if solution.feasible:
                own = place.subproblem.gain(solution.J, place.incumbent)
                gain = max(gain, own)
                first = (solution.converged or is_incumbent) and not place.closed
                # what is better than the solution by no more than counts does not take its place
                lost = place.subproblem.gain(place.incumbent.J, solution)
                if own > 0 or (first and lost <= self.tolerance):
                    place.incumbent, is_incumbent = solution, True
            # a search that was cut off while it gained goes on from there
            ended = solution.status is not Status.EXHAUSTED or own <= self.tolerance
            place.closed = place.closed or (is_incumbent and ended)
        if self.places and len(outcome.J):
            orders = self.orders
            values = orders.value(outcome.J[:, None])
            best, models = values.argmin(axis=0), outcome.models
            known = orders.value(np.array([x.incumbent.J for x in self.places]))
            # Among equals in its objective, an edge has an order of its own; weights are few too.
            ahead = (values.min(axis=0) < known) | (orders.greatest == 0)
            for j in np.flatnonzero(ahead).tolist():
                gain = max(gain, self._challenge(self.places[j], models[best[j]]))
        return gain

    def _challenge(self, place: Place, solution: Solution) -> float:
        """Let a model compete for a place; return the gain where it had been solved, else 0.

        What is open starts from any model that is better, if its derivatives are known.
        """
        ready = not place.closed and solution.evaluation.derivatives
        gain = place.subproblem.gain(solution.J, place.incumbent)
        if gain <= (0.0 if ready else self.tolerance):
            return 0.0
        was_closed, place.closed = place.closed, False
        place.incumbent = solution
        return gain if was_closed else 0.0

    def distinct(self, solutions: Iterable[Solution]) -> list[Solution]:
        """Return solutions in their order, without those of models that are among them already."""
        out: list[Solution] = []
        for x in solutions:
            apart = (np.abs((x.theta - y.theta) / self.span).max() for y in out)
            if all(distance > DISTINCT for distance in apart):
                out.append(x)
        return out


def distinct_points(points: Sequence[Solution], scale: Floats) -> list[Solution]:
    """Return points of a front, each once: objectives over ``scale`` (n,) tell copies apart."""
    out: list[Solution] = []
    J = np.zeros((len(points), scale.size))  # of those that are kept
    for x in points:
        same = np.flatnonzero((np.abs(J[: len(out)] - x.J) <= COPY * scale).all(axis=1)).tolist()
        if not same:
            J[len(out)] = x.J
            out.append(x)
        elif x.converged and not out[same[0]].converged:
            out[same[0]], J[same[0]] = x, x.J
    return out
