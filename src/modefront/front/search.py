"""The search: proposers are asked, the best offers are solved, and all are told what was found.

An offer is worth making as long as the chance that some subproblem gains more than the tolerance
is above the doubt that is allowed. Of these, the ones with the greatest chance are solved, some at
a time. The search ends when no offer is worth making, or at its budget. Nothing depends on who
solves the offers, and in which order they are done. Every model that is evaluated competes for all
places, and for one among those of the archive.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, Protocol

import numpy as np

from modefront._typing import Floats
from modefront.front.dominance import Archive
from modefront.front.subproblems import Order, Subproblem
from modefront.optim.problem import DISTINCT, Evaluation, Problem, SpentError, Wrapped
from modefront.optim.sqp import Solution, Status, begin
from modefront.options import Checked, number, whole
from modefront.work.codec import record
from modefront.work.task import IMMEDIATE, Executor, Key, Task

USUAL = 10  # models of a generation, and random starts that cover the box together
BATCH = 6  # offers that are solved at the same time

EDGES, POINTS = 0.5, 0.9
"""Shares of the budget up to which edges and weighted models, and then points between edges, are
searched for; the rest is for what follows from these: optimal weights and the ends of branches."""

SHARE = number("a share above 0 and below 1", above=0, below=1)


@dataclass(frozen=True)
class Search(Checked):
    """How far the search for global minima goes.

    Raises InputError for values that are not possible.

    Attributes
    ----------
    evaluations : budget of eigenproblems, 1 or more; what is open at its end is said
    tolerance : gain of a result, over itself, that counts; between 0 and 1
    doubt : chance of such a gain below which a search is not worth making; between 0 and 1
    """

    evaluations: Annotated[int, whole(1, 10**9)] = 20_000
    tolerance: Annotated[float, SHARE] = 1e-3
    doubt: Annotated[float, SHARE] = 0.05


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
        if of is problem:
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


@dataclass(frozen=True)
class Offer:
    """A search that is proposed."""

    place: Place | None  # whose subproblem is solved; None where models are only evaluated
    start: Solution  # model from which it is solved
    chance: float  # probability that some subproblem gains, at most
    function: Callable[..., Any]  # what is done with the problem and ``arguments``
    arguments: tuple[Any, ...]
    expected: float | None = None  # that probability, as it is expected; None where it is the same


class Proposer(Protocol):
    """Proposes searches."""

    def offers(self, state: "State", most: int, /) -> Iterator[Offer]:
        """Yield the searches that are most likely to gain, best first, ``most`` or fewer."""

    def learn(self, state: "State", offer: Offer, outcome: Outcome, gain: float, /) -> None:
        """Take note of what an offer of its own has led to."""


def solve_from(
    place: Place, start: Solution, chance: float, expected: float | None = None
) -> Offer:
    """Return the offer to solve the subproblem of a place from a start."""
    arguments = (place.subproblem, start, place.incumbent if place.closed else None)
    return Offer(place, start, chance, _solved, arguments, expected)


def at(theta: Floats) -> Solution:
    """Return a start at parameters (p,) at which nothing is known."""
    return begin(Evaluation(theta, np.zeros(1)))


def _solved(
    problem: Problem, subproblem: Subproblem, start: Solution, known: Solution | None
) -> Solution:
    """Return the solution of a subproblem from a start."""
    start = evaluated(problem, start)
    return subproblem.solve(problem, start, known) if start.feasible else start


def evaluated(problem: Problem, solution: Solution) -> Solution:
    """Return a solution, or where its derivatives are not known, a start at its parameters."""
    if solution.evaluation.derivatives:
        return solution
    return begin(problem.evaluate(solution.theta, second=True))


def evaluated_all(problem: Problem, thetas: Floats) -> list[Evaluation]:
    """Return models without derivatives."""
    return [problem.evaluate(theta, derivatives=False) for theta in thetas]


@dataclass
class State:
    """A search, and what it knows."""

    problem: Problem  # that is searched
    limits: Search = field(default_factory=Search)  # when it ends
    work: Executor = IMMEDIATE  # carries out tasks
    least: Floats | None = None  # (n,) values that no objectives fall below; None of unknown ones
    places: list[Place] = field(default_factory=list)  # subproblems with their incumbents
    evaluations: int = 0  # so far
    turn: int = 0  # number of batches that were solved
    # numbers of offers, and of evaluations that they took, by proposer and kind of subproblem
    spent: dict[Key, list[int]] = field(default_factory=dict)
    open: set[Key] = field(default_factory=set)  # subproblems with offers left at the budget
    archive: Archive = field(init=False)  # nondominated models, as the solutions that they are

    def __post_init__(self) -> None:
        self.archive = Archive(len(self.problem.objectives))
        self.span = self.problem.upper - self.problem.lower

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

    def is_settled(self, place: Place) -> bool:
        """Return whether no model can be better than the best one of a place, by what counts."""
        if self.least is None:
            return False
        return place.subproblem.gain(self.least, place.incumbent) <= self.limits.tolerance

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

    def search(self, stage: str, proposers: Sequence[Proposer], share: float = POINTS) -> None:
        """Search until nothing is worth it, or until a share of the budget is spent."""
        most = int(share * self.limits.evaluations)
        while offers := self._offers(proposers):
            left = most - self.evaluations
            if left <= 0:
                for _, offer in offers:
                    places = [offer.place] if offer.place else self.places
                    self.open |= {place.subproblem.key for place in places}
                break
            chosen = offers[:BATCH]
            self.turn += 1
            tasks = [
                Task((stage, self.turn, j), offer.function, (self.problem, *offer.arguments))
                for j, (_, offer) in enumerate(chosen, 1)
            ]
            outcomes = self.run(tasks, max(left, len(tasks)))
            for (proposer, offer), outcome in zip(chosen, outcomes, strict=True):
                like = self._like(proposer, offer)
                like[:] = like[0] + 1, like[1] + outcome.evaluations
                gain = self.tell(offer.place, offer.start, outcome)
                if outcome.result is not None:
                    proposer.learn(self, offer, outcome, gain)

    def _offers(self, proposers: Sequence[Proposer]) -> list[tuple[Proposer, Offer]]:
        """Return the offers worth making, those expected to gain most for their cost first."""
        asked = ((x, offer) for x in proposers for offer in x.offers(self, BATCH))
        offers = [(x, offer) for x, offer in asked if offer.chance >= self.limits.doubt]

        def rate(each: tuple[Proposer, Offer]) -> float:
            (made, took), (_, offer) = self._like(*each), each
            return (offer.chance if offer.expected is None else offer.expected) * made / took

        return sorted(offers, key=rate, reverse=True)

    def _like(self, proposer: Proposer, offer: Offer) -> list[int]:
        """Return how many offers like one were made and what they took, with a usual one before."""
        of = offer.place.subproblem.key[0] if offer.place else ""
        return self.spent.setdefault((type(proposer).__name__, of), [1, USUAL])

    def tell(self, place: Place | None, start: Solution | None, outcome: Outcome) -> float:
        """Let what a search led to compete; return the greatest gain of a subproblem.

        It is a solution of a place from a start, or of none.
        """
        solution: Solution | None = outcome.result
        gain = 0.0
        if place and solution:
            is_incumbent, own = start is place.incumbent, 0.0
            if solution.feasible:
                own = place.subproblem.gain(solution.J, place.incumbent)
                gain = max(gain, own)
                first = (solution.converged or is_incumbent) and not place.closed
                # what is better than the solution by no more than counts does not take its place
                lost = place.subproblem.gain(place.incumbent.J, solution)
                if own > 0 or (first and lost <= self.limits.tolerance):
                    place.incumbent, is_incumbent = solution, True
            # a search that was cut off while it gained goes on from there
            ended = solution.status is not Status.EXHAUSTED or own <= self.limits.tolerance
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

        What is open starts from any model that is better, if its derivatives are known. What has
        ended at a jump is no minimum, and such a model takes its place as it is.
        """
        known, of = place.incumbent, solution.evaluation
        gain = place.subproblem.gain(solution.J, known)
        if gain <= (0.0 if of.derivatives and not place.closed else self.limits.tolerance):
            if gain > 0 and of.derivatives and known.status is Status.JUMP:
                place.incumbent = replace(known, evaluation=of)
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
