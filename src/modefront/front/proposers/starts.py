r"""Starts: subproblems are solved from random models, until unseen minima are unlikely.

With w minima of different values, to which N random starts have led, the part of the box from
which unseen ones would be reached is expected to be (Boender & Rinnooy Kan 1987,
doi:10.1007/BF02591684)

.. math:: \frac{w (w + 1)}{N (N - 1)} .

That bounds the chance that the next start gains if it is not lost, as those are that meet no
minimum: their part of all starts is that which has been seen. Where enough starts have led to the
best model, the rate at which they have gained is a bound as well. Of several starts at a time, each
has the chance that is left if those before it lead to what is known. Points of the lattice have no
starts: they begin at what others have found.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from modefront._typing import Floats
from modefront.front.search import USUAL, Offer, Outcome, Place, State, at, solve_from
from modefront.front.subproblems import Least
from modefront.optim.sqp import Solution, Status
from modefront.work.task import Key

SURE = 2  # starts that lead to a minimum, from which on it is hardly a matter of chance


@dataclass
class Minima:
    """Minima of a subproblem that random starts have led to."""

    tries: int = 0  # tries, gains: numbers of starts, and of those that gained
    gains: int = 0
    # minima of different values; what ended at the limit of iterations has met none
    ends: list[Solution] = field(default_factory=list)
    counts: list[int] = field(default_factory=list)  # number of starts that led to each
    lost: int = 0  # number of starts that neither met a minimum nor gained
    # parameters of all starts so far, and of the next ones
    thetas: list[Floats] = field(default_factory=list)

    def note(self, place: Place, solution: Solution, tolerance: float) -> bool:
        """Count the end of a start; return whether that has met a minimum."""
        if not solution.feasible or solution.status is Status.EXHAUSTED:
            return False
        for k, end in enumerate(self.ends):
            if _equal(place, solution, end, tolerance):
                self.counts[k] += 1
                return True
        self.ends.append(solution)
        self.counts.append(1)
        return True

    def hits(self, place: Place, tolerance: float) -> int:
        """Return the number of starts that led to the best model."""
        pairs = zip(self.ends, self.counts, strict=True)
        return sum(count for x, count in pairs if _equal(place, x, place.incumbent, tolerance))

    def unseen(self, ahead: int = 0) -> float:
        """Return the part of the box to unseen minima, after starts ``ahead`` to known ones."""
        w, N = max(len(self.ends), 1), sum(self.counts) + ahead
        return min(w * (w + 1) / (N * (N - 1)), 1.0) if N > 1 else 1.0

    def chance(self, place: Place, tolerance: float, ahead: int = 0) -> float:
        """Return the chance that a start gains at most, after so many ``ahead``; see the module."""
        tries, unseen = self.tries + ahead, self.unseen(ahead)
        if self.hits(place, tolerance) >= SURE:
            unseen = min(unseen, (self.gains + 1) / (tries + 2))  # of a uniform prior
        return unseen * ((tries - self.lost + 1) / (tries + 1))


def _equal(place: Place, x: Solution, y: Solution, tolerance: float) -> bool:
    """Return whether two minima are of the same value, or as low as each other behind an edge."""
    of = place.subproblem
    behind = min(of.gain(place.incumbent.J, x), of.gain(place.incumbent.J, y)) > tolerance
    tied = isinstance(of, Least) and of.ties(x.J, y.J)
    return (tied and behind) or max(of.gain(x.J, y), of.gain(y.J, x)) <= tolerance


@dataclass
class Starts:
    """Proposes random starts for edges and weighted models."""

    rng: np.random.Generator  # random numbers
    # minima of a problem that is nearly the same, by the keys of subproblems, from which they are
    # solved for instead of from random models; None without one
    again: Mapping[Key, Sequence[Solution]] | None = None
    minima: dict[Key, Minima] = field(default_factory=dict)  # of each subproblem, by its key

    def offers(self, state: State, most: int) -> Iterator[Offer]:
        """Yield random starts of each place."""
        for place in state.places:
            known = self.of(place)
            if self.again is not None:
                left = self.again.get(place.subproblem.key, ())[known.tries :]
                yield from (solve_from(place, at(x.theta), 1.0) for x in left[:most])
                continue
            if state.is_settled(place) and known.tries >= USUAL:
                continue
            known.thetas = known.thetas or [state.problem.start]
            while len(known.thetas) < known.tries + most:
                # spread evenly over each range
                cells = np.tile(np.arange(USUAL), (state.span.size, 1))
                cells = self.rng.permuted(cells, axis=1).T
                u = (cells + self.rng.uniform(size=cells.shape)) / USUAL
                known.thetas += list(state.problem.lower + state.span * u)
            for ahead in range(most):
                chance = known.chance(place, state.limits.tolerance, ahead)
                start = at(known.thetas[known.tries + ahead])
                yield solve_from(place, start, chance, chance / (len(known.ends) + 1))

    def learn(self, state: State, offer: Offer, outcome: Outcome, gain: float) -> None:
        """Count the start, and keep its minimum if it is new."""
        place, tolerance = offer.place, state.limits.tolerance
        assert place is not None, "starts are of places"
        known = self.of(place)
        known.tries += 1
        known.gains += gain > tolerance
        met = known.note(place, outcome.result, tolerance)
        known.lost += not met and gain <= tolerance

    def unseen(self, state: State) -> float:
        """Return the chance that a start gains at most, of the places that have had some."""
        tried = [x for x in state.places if x.subproblem.key in self.minima]
        left = (x for x in tried if not state.is_settled(x))
        return max((self.of(x).chance(x, state.limits.tolerance) for x in left), default=0.0)

    def of(self, place: Place) -> Minima:
        """Return the minima of a subproblem."""
        return self.minima.setdefault(place.subproblem.key, Minima())
