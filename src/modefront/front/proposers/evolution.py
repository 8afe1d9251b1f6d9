"""Evolution: models between those that are known, over all subproblems.

Each child is the incumbent of a subproblem, in which some parameters are those of another known
model or, in every second one, are moved by the difference of two (differential evolution: Storn &
Price 1997, doi:10.1023/A:1008202821328), mutated (Deb & Agrawal 1995). Generations go on as long as
unseen minima are likely and, of places without starts, as they gain.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.front.search import USUAL, Offer, Outcome, State, at, evaluated_all

INDEX = 20.0  # distribution index of mutations: the usual value


@dataclass
class Evolution:
    """Proposes generations of children."""

    rng: np.random.Generator  # random numbers
    unseen: Callable[[State], float]  # returns the chance that there are minima to be found
    alone: bool = True  # whether there are places without starts, which say what is unseen
    idle: int = 0  # generations since the last gain

    def offers(self, state: State, most: int) -> Iterator[Offer]:
        """Yield generations, each with the chance that is left if those before gain nothing."""
        if len(state.places) > 1 and all(place.closed for place in state.places):
            unseen = self.unseen(state)
            for idle in range(self.idle, self.idle + most):
                gains = 1 / (idle + 2)
                bound = max(unseen, gains * self.alone)
                theta = self._children(state)
                yield Offer(None, at(theta[0]), bound, evaluated_all, (theta,), gains * unseen)

    def learn(self, state: State, _: Offer, __: Outcome, gain: float) -> None:
        """Count the generation."""
        self.idle = 0 if gain > state.limits.tolerance else self.idle + 1

    def _children(self, state: State) -> Floats:
        """Return the parameters of a generation, (children, p)."""
        models = [*(x.incumbent for x in state.places), *state.archive.models]
        known, shape = np.array([x.theta for x in models]), (USUAL, state.span.size)
        base = known[self.rng.integers(len(state.places), size=USUAL)]
        one, two = known[self.rng.integers(len(known), size=(2, USUAL))]
        moved = base + self.rng.uniform(0.2, 1.0, size=(USUAL, 1)) * (one - two)
        moved[::2] = one[::2]
        crossed = self.rng.uniform(size=shape) < self.rng.uniform(size=(USUAL, 1))
        theta = np.where(crossed, moved, base)
        u = self.rng.uniform(size=shape)
        below = (2 * u) ** (1 / (INDEX + 1)) - 1
        above = 1 - (2 * (1 - u)) ** (1 / (INDEX + 1))
        mutated = self.rng.uniform(size=shape) < 1 / state.span.size
        theta += np.where(mutated, np.where(u < 0.5, below, above) * state.span, 0.0)
        return np.clip(theta, state.problem.lower, state.problem.upper)
