r"""Starts: subproblems are solved from random models, until unseen minima are unlikely.

With w minima of different values after N random starts, the part of the box from which unseen
minima would be reached is expected to be (Boender & Rinnooy Kan 1987, doi:10.1007/BF02591684)

.. math:: \frac{w (w + 1)}{N (N - 1)} .

That bounds the chance that the next start gains, and so does the rate at which starts have gained.
Points of the lattice share their starts: each takes a few steps from a random model towards a
random point; whether it is followed is left to `modefront.front.proposers.rivals`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from modefront._typing import Floats
from modefront.front.archive import Outcome
from modefront.front.proposers.base import STEPS, Offer, Rate, approach_from, at, solve_from
from modefront.front.proposers.prediction import promised
from modefront.front.state import Place, State
from modefront.front.subproblems import Least, Point, Subproblem, Weights, is_along
from modefront.optim.lexicographic import EXACT
from modefront.optim.sqp import Solution
from modefront.work.task import Key

BLOCK = 10
"""Starts that are spread evenly over each range together."""

NEAR = 1e-2
"""Distance of two minima that were only approached, over the ranges, above which they are two."""


@dataclass
class Starts:
    """Proposes random starts for some subproblems.

    Attributes
    ----------
    rng : random numbers
    rates : of each subproblem, by its key; those of all points of the lattice share one, ()
    ends : distinct minima of each subproblem
    ties : minima of each subproblem that starts have led to
    tried : models from which the end of the front at an edge was sought
    along : rates of searches along the minima of the objective of an edge
    limits : distinct ends of these
    """

    rng: np.random.Generator
    name: str = "starts"
    rates: dict[Key, Rate] = field(default_factory=dict)
    ends: dict[Key, list[Solution]] = field(default_factory=dict)
    ties: dict[Key, list[Solution]] = field(default_factory=dict)
    tried: dict[Key, list[Solution]] = field(default_factory=dict)
    along: dict[Key, Rate] = field(default_factory=dict)
    limits: dict[Key, list[Solution]] = field(default_factory=dict)
    _queue: list[Floats] = field(default_factory=list)

    def offers(self, state: State, most: int) -> Iterator[Offer]:
        """Yield random starts of each subproblem that is worth one."""
        points = []
        for k, place in enumerate(state.places):
            if is_along(place.subproblem):
                points.append(k)
                continue
            key = place.subproblem.key
            rate = self.rates.setdefault(key, Rate())
            chance = coverage(rate, len(self.ends.get(key, ())))
            for number in range(rate.tries, rate.tries + most):
                theta = state.problem.start if number == 0 else self._next(state)
                yield approach_from(k, place.subproblem, at(theta), chance)
            yield from self._along(state, k)
        if points:
            rate = self.rates.setdefault((), Rate())
            for _ in range(most):
                k = points[int(self.rng.integers(len(points)))]
                place = state.places[k]
                start = at(self._next(state))
                yield approach_from(k, place.subproblem, start, rate.recent, STEPS)

    def _along(self, state: State, k: int) -> Iterator[Offer]:
        """Yield searches of an edge whose minima are open: from these, and models next to it."""
        place = state.places[k]
        if not isinstance(place.subproblem, Least):
            return
        order, best = place.subproblem.order, place.incumbent
        if not (place.closed and order.is_open(state.problem, best.evaluation)):
            return
        key = place.subproblem.key
        rate = self.along.setdefault(key, Rate())
        chance = coverage(rate, len(self.limits.get(key, ())))
        tried = self.tried.setdefault(key, [])
        i = place.subproblem.objective
        weighted = [x for x in state.places if isinstance(x.subproblem, Weights)]
        every = ((x, x.subproblem) for x in state.places)
        points = [(float(each.beta[i]), x) for x, each in every if isinstance(each, Point)]
        nearest = sorted(points, key=lambda pair: -pair[0])[1:2]
        others = (*weighted, *(x for _, x in nearest))
        known = [x.incumbent for x in others if x.closed]
        known += [x for x in self.ties.get(key, ()) if order.ties(x.J, best.J)]
        for solution in known:
            if all(solution is not x for x in tried):
                yield solve_from(k, place.subproblem, solution, chance)

    def learn(self, state: State, offer: Offer, outcome: Outcome, gain: float) -> None:
        """Count the start, and keep its minimum if it is new."""
        place, solution = state.places[offer.place], outcome.result
        key = place.subproblem.key
        if offer.final:
            self.along[key].note(gain > state.tolerance, outcome.evaluations)
            self.tried[key].append(offer.start)
            limits = self.limits.setdefault(key, [])
            if all(abs(place.subproblem.gain(solution.J, x)) > state.tolerance for x in limits):
                limits.append(solution)
            return
        shared = is_along(place.subproblem)
        rate = self.rates.setdefault(() if shared else key, Rate())
        rate.note(gain > state.tolerance, outcome.evaluations)
        if shared or not solution.feasible:
            return
        ends = self.ends.setdefault(key, [])
        self.ties.setdefault(key, []).append(solution)
        if all(self._differ(state, place.subproblem, solution, x) for x in ends):
            ends.append(solution)

    def _differ(self, state: State, subproblem: Subproblem, x: Solution, y: Solution) -> bool:
        """Return whether two minima are apart and promise different values."""
        if np.abs((x.theta - y.theta) / state.span).max() <= NEAR:
            return False
        one, two = (promised(state.problem, subproblem, each.evaluation) for each in (x, y))
        w = subproblem.weights(x)
        most = max(float(w @ one), float(w @ two), EXACT)
        return abs(float(w @ (one - two))) > state.tolerance * most

    @property
    def unseen(self) -> float:
        """Greatest part of the box from which unseen minima of a subproblem are reached."""
        parts = (unseen(self.rates[key].tries, len(x)) for key, x in self.ends.items())
        return max(parts, default=1.0)

    def record(self, place: Place, best: Solution, tolerance: float) -> tuple[int, int, int]:
        """Return how many starts a subproblem had, different minima, and starts that led to best.

        Minima count as the best where neither is better by more than the tolerance.
        """
        key = place.subproblem.key
        hits = [
            max(place.subproblem.gain(best.J, x), place.subproblem.gain(x.J, best)) <= tolerance
            for x in self.ties.get(key, ())
        ]
        tries = self.rates[key].tries if key in self.rates else 0
        return tries, len(self.ends.get(key, ())), sum(hits)

    def _next(self, state: State) -> Floats:
        """Return random parameters, spread evenly over each range block by block."""
        if not self._queue:
            p = state.span.size
            cells = self.rng.permuted(np.tile(np.arange(BLOCK), (p, 1)), axis=1).T
            u = (cells + self.rng.uniform(size=cells.shape)) / BLOCK
            self._queue = list(state.problem.lower + state.span * u)
        return self._queue.pop()


def coverage(rate: Rate, w: int) -> float:
    """Return the chance that a search gains, where w different minima were found so far."""
    return min(unseen(rate.tries, w), rate.chance)


def unseen(N: int, w: int) -> float:
    """Return the part of the box from which unseen minima are reached, at w minima after N starts.

    >>> unseen(10, 2) < 0.07 < unseen(10, 3)
    True
    """
    return min(w * (w + 1) / (N * (N - 1)), 1.0) if N > 1 else 1.0
