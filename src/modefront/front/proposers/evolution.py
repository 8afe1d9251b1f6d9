"""Evolution: models between those that are known, by differential evolution over all subproblems.

Each child is the incumbent of a subproblem, moved by the difference of two other known models
(Storn & Price 1997, doi:10.1023/A:1008202821328) and mutated (Deb & Agrawal 1995).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.front.archive import Outcome
from modefront.front.proposers.base import USUAL, Offer, evaluate_all
from modefront.front.state import State

INDEX = 20.0  # distribution index of mutations: the usual value


@dataclass
class Evolution:
    """Proposes generations of children, until enough of them have gained nothing."""

    rng: np.random.Generator  # random numbers
    idle: int = 0  # generations since the last gain

    def offers(self, state: State, _: int) -> Iterator[Offer]:
        """Yield one generation."""
        if len(state.places) > 1 and all(place.closed for place in state.places):
            yield evaluate_all(self._children(state), 1 / (self.idle + 2))

    def learn(self, state: State, _: Offer, __: Outcome, gain: float) -> None:
        """Count the generation."""
        self.idle = 0 if gain > state.tolerance else self.idle + 1

    def _children(self, state: State) -> Floats:
        """Return the parameters of a generation, (children, p)."""
        lower, upper, span = state.problem.lower, state.problem.upper, state.span
        models = [*(x.incumbent for x in state.places), *state.archive.models]
        known = np.array([x.theta for x in models])
        out = []
        for _ in range(USUAL):
            base = state.places[int(self.rng.integers(len(state.places)))].incumbent.theta
            one, two = known[self.rng.integers(len(known), size=2)]
            crossed = self.rng.uniform(size=base.size) < self.rng.uniform()
            theta = np.where(crossed, base + self.rng.uniform(0.2, 1.0) * (one - two), base)
            mutated = self.rng.uniform(size=base.size) < 1 / base.size
            u = self.rng.uniform(size=base.size)
            below = (2 * u) ** (1 / (INDEX + 1)) - 1
            above = 1 - (2 * (1 - u)) ** (1 / (INDEX + 1))
            polynomial = np.where(u < 0.5, below, above)
            theta = np.where(mutated, theta + polynomial * span, theta)
            out.append(np.clip(theta, lower, upper))
        return np.array(out)
