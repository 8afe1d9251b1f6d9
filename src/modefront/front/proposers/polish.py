"""Polish: every incumbent is solved for from where it is."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import islice

import numpy as np

from modefront.front.search import Offer, Outcome, State, solve_from
from modefront.front.subproblems import LatticePoint
from modefront.work.task import Key


@dataclass
class Polish:
    """Proposes to solve each subproblem from its incumbent, until that is where it leads to.

    A point of the lattice that no search has reached has the best known model as its incumbent:
    those that lag least behind what they could be come first, next to what is solved. So a front
    is followed from its edges inwards, each point from its neighbour. A point that ends beside its
    normal is solved from those that lie on their own, the nearest first, as long as that has a
    chance to gain, and one that does not meet its equations from as many as there are objectives:
    the front may go on from another side.
    """

    idle: int = 0  # searches from other points since the last gain
    _tried: set[tuple[Key, bytes]] = field(default_factory=set)

    def offers(self, state: State, most: int) -> Iterator[Offer]:
        """Yield the searches from incumbents that are open, the nearest first."""
        spread = state.orders.spread(np.array([x.incumbent.J for x in state.places]))
        nearest_first = [state.places[k] for k in np.argsort(spread, kind="stable")]
        for place in [x for x in nearest_first if not x.closed][:most]:
            yield solve_from(place, place.incumbent, 1.0)
        points = [(x, x.subproblem) for x in state.places if isinstance(x.subproblem, LatticePoint)]
        met = [x.incumbent for x, of in points if of.met(x.incumbent)]
        J = np.array([x.J for x in met]).reshape(-1, len(state.problem.objectives))
        for place, of in points:
            if place.closed and not of.met(place.incumbent):
                nearest = [met[m] for m in of.order.spread(J).argsort(kind="stable").tolist()]
                chance, count = 1 / (self.idle + 2), 1
                if of.equations:
                    chance, count = 1.0, J.shape[1]
                    nearest = nearest[:count]
                new = (y for y in nearest if (of.key, y.theta.tobytes()) not in self._tried)
                yield from (solve_from(place, y, chance) for y in islice(new, count))

    def learn(self, state: State, offer: Offer, _: Outcome, gain: float) -> None:
        """Remember from which model a place was solved, and count what others have led to."""
        if offer.place:
            self._tried.add((offer.place.subproblem.key, offer.start.theta.tobytes()))
        if offer.chance < 1:
            self.idle = 0 if gain > state.limits.tolerance else self.idle + 1
