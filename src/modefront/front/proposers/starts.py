r"""Starts: subproblems are solved from random models, until unseen minima are unlikely.

With w minima of different values, to which N random starts have led, the part of the box from
which unseen ones would be reached is expected to be (Boender & Rinnooy Kan 1987,
doi:10.1007/BF02591684)

.. math:: \frac{w (w + 1)}{N (N - 1)} .

That bounds the chance that the next start gains, and where enough starts have led to the best
model, so does the rate at which they have gained. Points of the lattice have none: they start from
what others have found.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from modefront._typing import Floats
from modefront.front.archive import Outcome
from modefront.front.proposers.base import USUAL, Offer, at, solve_from
from modefront.front.state import Place, State
from modefront.front.subproblems import is_along
from modefront.optim.sqp import Solution, Status
from modefront.work.task import Key

SURE = 2
"""Starts that lead to a minimum, from which on it is hardly a matter of chance."""


@dataclass
class Minima:
    """Minima of a subproblem that random starts have led to.

    Attributes
    ----------
    tries, gains : numbers of starts, and of those that gained
    ends : minima of different values; what ended at the limit of iterations has met none
    counts : number of starts that led to each
    """

    tries: int = 0
    gains: int = 0
    ends: list[Solution] = field(default_factory=list)
    counts: list[int] = field(default_factory=list)

    def note(self, place: Place, solution: Solution, tolerance: float) -> None:
        """Count the end of a start."""
        if not solution.feasible or solution.status is Status.EXHAUSTED:
            return
        for k, end in enumerate(self.ends):
            if _equal(place, solution, end, tolerance):
                self.counts[k] += 1
                return
        self.ends.append(solution)
        self.counts.append(1)

    def hits(self, place: Place, tolerance: float) -> int:
        """Return the number of starts that led to the best model."""
        pairs = zip(self.ends, self.counts, strict=True)
        return sum(count for x, count in pairs if _equal(place, x, place.incumbent, tolerance))

    @property
    def unseen(self) -> float:
        """Part of the box from which unseen minima are reached."""
        w, N = len(self.ends), sum(self.counts)
        return min(w * (w + 1) / (N * (N - 1)), 1.0) if N > 1 else 1.0

    def chance(self, place: Place, tolerance: float) -> float:
        """Return the chance that a start gains at most; see the module."""
        is_sure = self.hits(place, tolerance) >= SURE
        rate = (self.gains + 1) / (self.tries + 2)  # the posterior mean of a uniform prior
        return min(self.unseen, rate) if is_sure else self.unseen


def _equal(place: Place, x: Solution, y: Solution, tolerance: float) -> bool:
    """Return whether two minima are of the same value."""
    of = place.subproblem
    return max(of.gain(x.J, y), of.gain(y.J, x)) <= tolerance


@dataclass
class Starts:
    """Proposes random starts for edges and weighted models.

    Attributes
    ----------
    rng : random numbers
    again : minima of a problem that is nearly the same, by the keys of subproblems, from which they
        are solved for instead of from random models; None without one
    minima : of each subproblem, by its key
    """

    rng: np.random.Generator
    again: Mapping[Key, Sequence[Solution]] | None = None
    minima: dict[Key, Minima] = field(default_factory=dict)
    _queue: list[Floats] = field(default_factory=list)

    def offers(self, state: State, most: int) -> Iterator[Offer]:
        """Yield random starts of each of them, until points between the edges are searched."""
        if any(is_along(x.subproblem) for x in state.places):
            return
        offers = list(self._of_places(state, most))
        # Of equal chance, the places that have had fewer come first: one without minima waits.
        yield from sorted(offers, key=lambda offer: self.of(state.places[offer.place]).tries)

    def _of_places(self, state: State, most: int) -> Iterator[Offer]:
        for k, place in enumerate(state.places):
            known = self.of(place)
            chance, tries = known.chance(place, state.tolerance), known.tries
            if self.again is not None:
                left = self.again.get(place.subproblem.key, ())[tries : tries + most]
                yield from (solve_from(k, place, at(x.theta), 1.0) for x in left)
                continue
            for number in range(tries, tries + most):
                theta = state.problem.start if number == 0 else self._next(state)
                yield solve_from(k, place, at(theta), chance)

    def learn(self, state: State, offer: Offer, outcome: Outcome, gain: float) -> None:
        """Count the start, and keep its minimum if it is new."""
        place = state.places[offer.place]
        known = self.of(place)
        known.tries += 1
        known.gains += gain > state.tolerance
        known.note(place, outcome.result, state.tolerance)

    def of(self, place: Place) -> Minima:
        """Return the minima of a subproblem."""
        return self.minima.setdefault(place.subproblem.key, Minima())

    def _next(self, state: State) -> Floats:
        """Return random parameters, spread evenly over each range block by block."""
        if not self._queue:
            p = state.span.size
            cells = self.rng.permuted(np.tile(np.arange(USUAL), (p, 1)), axis=1).T
            u = (cells + self.rng.uniform(size=cells.shape)) / USUAL
            self._queue = list(state.problem.lower + state.span * u)
        return self._queue.pop()
