"""Polish: every incumbent is solved for from where it is."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from modefront.front.archive import Outcome
from modefront.front.proposers.base import Offer, solve_from
from modefront.front.state import State


@dataclass
class Polish:
    """Proposes to solve each subproblem from its incumbent, until that is where it leads to.

    A point of the lattice that no search has reached has the best known model as its incumbent:
    those that lag least behind what they could be come first, next to what is solved. So a front
    is followed from its edges inwards, each point from its neighbour.
    """

    name: str = "polish"

    def offers(self, state: State, most: int) -> Iterator[Offer]:
        """Yield the searches from incumbents that are open, the nearest first."""
        open_places = [k for k, place in enumerate(state.places) if not place.closed]
        ranked = sorted(open_places, key=lambda k: lag(state, k))
        for k in ranked[:most]:
            place = state.places[k]
            yield solve_from(k, place.subproblem, place.incumbent, 1.0)

    def learn(self, state: State, _: Offer, outcome: Outcome, __: float) -> None:
        """Let the new model start what is open and lies nearer to it than the incumbents do."""
        solution = outcome.result
        if not (solution.feasible and solution.evaluation.derivatives):
            return
        for place in state.places:
            if not place.closed and place.subproblem.gain(solution.J, place.incumbent) > 0:
                place.incumbent = solution


def lag(state: State, k: int) -> float:
    """Return a number that is the less, the nearer an incumbent is to the solution."""
    place = state.places[k]
    spread = getattr(place.subproblem, "spread", None)
    return float(spread(place.incumbent.J)) if spread else 0.0
