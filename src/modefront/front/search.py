"""The search: proposers are asked, the best offers are solved, and all are told what was found.

An offer is worth making as long as the chance that some subproblem gains more than the tolerance
is above the doubt that is allowed. Of these, the ones with the greatest chance are solved, some at
a time. The search ends when no offer is worth making, or at its budget. Nothing depends on who
solves the offers, and in which order they are done.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any, Protocol

import numpy as np

from modefront._typing import Floats
from modefront.front.state import Outcome, Place, State
from modefront.front.subproblems import Subproblem
from modefront.optim.problem import Evaluation, Problem
from modefront.optim.sqp import Solution, begin
from modefront.options import Checked, number, whole
from modefront.work.task import Key, Task

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


@dataclass(frozen=True)
class Offer:
    """A search that is proposed."""

    place: int  # number of the subproblem that is solved; -1 where models are only evaluated
    start: Solution  # model from which it is solved
    chance: float  # probability that some subproblem gains, at most
    function: Callable[..., Any]  # what is done with the problem and ``arguments``
    arguments: tuple[Any, ...]
    expected: float | None = None  # that probability, as it is expected; None where it is the same


class Proposer(Protocol):
    """Proposes searches."""

    def offers(self, state: State, most: int, /) -> Iterator[Offer]:
        """Yield the searches that are most likely to gain, best first, ``most`` or fewer."""

    def learn(self, state: State, offer: Offer, outcome: Outcome, gain: float, /) -> None:
        """Take note of what an offer of its own has led to."""


def solve_from(
    k: int, place: Place, start: Solution, chance: float, expected: float | None = None
) -> Offer:
    """Return the offer to solve the subproblem of a place, the k-th one, from a start."""
    arguments = (place.subproblem, start, place.incumbent if place.closed else None)
    return Offer(k, start, chance, _solved, arguments, expected)


def evaluate_all(thetas: Floats, chance: float, expected: float | None = None) -> Offer:
    """Return the offer to evaluate models (., p) without derivatives."""
    return Offer(-1, at(thetas[0]), chance, evaluated_all, (thetas,), expected)


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
class Loop:
    """A search at work."""

    state: State  # what is known
    search: Search  # when it ends
    turn: int = 0  # number of batches that were solved
    # numbers of offers, and of evaluations that they took, by proposer and kind of subproblem
    spent: dict[Key, list[int]] = field(default_factory=dict)
    # subproblems for which offers were left at the budget
    open: set[Key] = field(default_factory=set)

    def run(self, stage: str, proposers: Sequence[Proposer], share: float = POINTS) -> None:
        """Search until nothing is worth it, or until a share of the budget is spent."""
        most = int(share * self.search.evaluations)
        while offers := self._offers(proposers):
            left = most - self.state.evaluations
            if left <= 0:
                keys = [place.subproblem.key for place in self.state.places]
                for _, offer in offers:
                    self.open |= set(keys if offer.place < 0 else [keys[offer.place]])
                break
            chosen = offers[:BATCH]
            self.turn += 1
            problem = self.state.problem
            tasks = [
                Task((stage, self.turn, j), offer.function, (problem, *offer.arguments))
                for j, (_, offer) in enumerate(chosen, 1)
            ]
            outcomes = self.state.run(tasks, max(left, len(tasks)))
            for (proposer, offer), outcome in zip(chosen, outcomes, strict=True):
                like = self._like(proposer, offer)
                like[:] = like[0] + 1, like[1] + outcome.evaluations
                gain = self.state.tell(offer.place, offer.start, outcome)
                if outcome.result is not None:
                    proposer.learn(self.state, offer, outcome, gain)

    def _offers(self, proposers: Sequence[Proposer]) -> list[tuple[Proposer, Offer]]:
        """Return the offers worth making, those expected to gain most for their cost first."""
        asked = ((x, offer) for x in proposers for offer in x.offers(self.state, BATCH))
        offers = [(x, offer) for x, offer in asked if offer.chance >= self.search.doubt]

        def rate(each: tuple[Proposer, Offer]) -> float:
            (made, took), (_, offer) = self._like(*each), each
            return (offer.chance if offer.expected is None else offer.expected) * made / took

        return sorted(offers, key=rate, reverse=True)

    def _like(self, proposer: Proposer, offer: Offer) -> list[int]:
        """Return how many offers like one were made and what they took, with a usual one before."""
        of = self.state.places[offer.place].subproblem.key[0] if offer.place >= 0 else ""
        return self.spent.setdefault((type(proposer).__name__, of), [1, USUAL])
