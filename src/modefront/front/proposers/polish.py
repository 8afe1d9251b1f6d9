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
    is followed from its edges inwards, each point from its neighbour. Then points are solved from
    those that lie on their normals, the nearest first, as long as that has a chance to gain: the
    front may go on from another side. Where a point lies on its own, or has missed its equations,
    these are as many as there are objectives at most; a point that meets equations is left.
    """

    # searches from other points since the last gain, of points on their normals and of others
    idle: dict[bool, int] = field(default_factory=dict)
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
        for place, of in (x for x in points if x[0].closed):
            nearest = [met[m] for m in of.order.spread(J).argsort(kind="stable").tolist()]
            nearest, on = [x for x in nearest if x is not place.incumbent], of.met(place.incumbent)
            if on and of.equations:
                continue
            near = nearest[: J.shape[1]] if on or of.equations else nearest
            chance = 1.0 if of.equations else 1 / (self.idle.get(on, 0) + 2)
            new = (y for y in near if (of.key, y.theta.tobytes()) not in self._tried)
            count = len(near) if of.equations else 1
            yield from (solve_from(place, y, chance) for y in islice(new, count))

    def learn(self, state: State, offer: Offer, _: Outcome, gain: float) -> None:
        """Remember from which model a place was solved, and count what others have led to."""
        if place := offer.place:
            self._tried.add((place.subproblem.key, offer.start.theta.tobytes()))
            if offer.chance < 1 and gain > state.limits.tolerance:
                self.idle.clear()
            elif offer.chance < 1 and isinstance(of := place.subproblem, LatticePoint):
                on = of.met(place.incumbent)
                self.idle[on] = self.idle.get(on, 0) + 1
