"""Polish: every incumbent is solved for from where it is."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from modefront.front.archive import Outcome
from modefront.front.proposers.base import Offer, solve_from
from modefront.front.state import State
from modefront.front.subproblems import competes
from modefront.work.task import Key


@dataclass
class Polish:
    """Proposes to solve each subproblem from its incumbent, until that is where it leads to.

    A point of the lattice that no search has reached has the best known model as its incumbent:
    those that lag least behind what they could be come first, next to what is solved. So a front
    is followed from its edges inwards, each point from its neighbour. Equations that are not met
    from there are solved from the nearest models that meet theirs.
    """

    name: str = "polish"
    _tried: set[tuple[Key, bytes]] = field(default_factory=set)

    def offers(self, state: State, most: int) -> Iterator[Offer]:
        """Yield the searches from incumbents that are open, the nearest first."""
        spread = state.orders.spread(np.array([x.incumbent.J for x in state.places]))
        nearest_first = np.argsort(spread, kind="stable").tolist()
        for k in [k for k in nearest_first if not state.places[k].closed][:most]:
            place = state.places[k]
            yield solve_from(k, place, place.incumbent, 1.0)
        equations = [(k, x) for k, x in enumerate(state.places) if not competes(x.subproblem)]
        met = [x.incumbent for _, x in equations if x.incumbent.converged]
        for k, place in equations:
            if place.closed and not place.incumbent.converged:
                key = place.subproblem.key
                nearest = sorted(met, key=lambda x: float(place.subproblem.order.spread(x.J)))
                for start in nearest[: len(state.problem.objectives)]:
                    if (key, start.theta.tobytes()) not in self._tried:
                        yield solve_from(k, place, start, 1.0)

    def learn(self, state: State, offer: Offer, _: Outcome, __: float) -> None:
        """Remember from which model a place was solved."""
        self._tried.add((state.places[offer.place].subproblem.key, offer.start.theta.tobytes()))
