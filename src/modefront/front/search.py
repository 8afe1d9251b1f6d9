"""The search: proposers are asked, the best offers are solved, and all are told what was found.

An offer is worth making as long as the chance that some subproblem gains more than the tolerance,
or for the first half of the budget, the part of the box that may hold something better, is above
the doubt that is allowed. Of these, the ones with the greatest chance per evaluation are solved,
some at a time. The search ends when no offer is worth making, or at its budget. Nothing depends on
who solves the offers, and in which order they are done.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Annotated

from modefront.front.proposers.base import USUAL, Offer, Proposer
from modefront.front.state import State
from modefront.options import Checked, number, whole
from modefront.work.task import Key, Task

BATCH = 6
"""Offers that are solved at the same time."""

SHARE = number("a share above 0 and below 1", above=0, below=1)

CONFIRMING = 0.5
"""Share of the budget up to which offers are made for the sake of what is unseen alone; the rest is
for the points between the edges."""

SEARCHING = 0.9
"""Share of the budget that is searched with; the rest is for what follows from the front: optimal
weights and the ends of its branches."""


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


@dataclass
class Loop:
    """A search at work.

    Attributes
    ----------
    state : what is known
    proposers : in the order in which they are asked
    search : when it ends
    turn : number of batches that were solved
    costs : searches and evaluations of each proposer
    open : subproblems for which offers were left at the budget
    """

    state: State
    proposers: Sequence[Proposer]
    search: Search
    turn: int = 0
    costs: dict[str, list[int]] = field(default_factory=dict)
    open: set[Key] = field(default_factory=set)

    def run(self, stage: str) -> None:
        """Search until nothing is worth it, or until the budget is spent."""
        budget = int(SEARCHING * self.search.evaluations)
        while offers := self._offers():
            left = budget - self.state.evaluations
            if left <= 0:
                places = self.state.places
                self.open |= {places[offer.place].subproblem.key for _, offer in offers}
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
                gain = self.state.tell(offer.place, offer.start, outcome)
                if outcome.result is not None:
                    proposer.learn(self.state, offer, outcome, gain)
                spent = self.costs.setdefault(proposer.name, [0, 0])
                spent[0] += 1
                spent[1] += outcome.evaluations

    def _offers(self) -> list[tuple[Proposer, Offer]]:
        """Return the offers worth making, the greatest chance per evaluation first."""
        offers: list[tuple[float, Proposer, Offer]] = []
        confirming = self.state.evaluations < CONFIRMING * self.search.evaluations
        for proposer in self.proposers:
            tries, spent = self.costs.get(proposer.name, (0, 0))
            cost = (spent + USUAL) / (tries + 1)  # that a search is expected to take
            for offer in proposer.offers(self.state, BATCH):
                doubt = offer.unseen if confirming else 0.0
                if max(offer.chance, doubt) >= self.search.doubt:
                    offers.append((offer.chance / cost, proposer, offer))
        offers.sort(key=lambda each: -each[0])
        return [(proposer, offer) for _, proposer, offer in offers]
