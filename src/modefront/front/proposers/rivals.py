"""Rivals: known models whose own derivatives promise another subproblem a gain.

The promise is that of the first step of the local solver. Where it is better than the incumbent, a
few steps are taken from the model, and the one that they lead to is compared in its turn.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from modefront.front.archive import Outcome
from modefront.front.proposers.base import Offer, Rate, approach_from
from modefront.front.state import DISTINCT, State
from modefront.front.subproblems import Point
from modefront.optim.linearised import Linearised
from modefront.optim.sqp import Options, Solution


@dataclass
class Rivals:
    """Proposes models that may lead a subproblem to another basin than that of its incumbent.

    Attributes
    ----------
    found : predicted gain of each pair of place and model that is not tried yet
    rate : of the searches so far
    """

    name: str = "rivals"
    found: dict[tuple[int, int], float] = field(default_factory=dict)
    rate: Rate = field(default_factory=Rate)

    def offers(self, state: State, most: int) -> Iterator[Offer]:
        """Yield the most promising pairs."""
        for k, place in enumerate(state.places):
            if not place.closed:
                continue
            new, of = np.arange(place.compared, len(state.models)), place.subproblem
            if new.size and isinstance(of, Point):
                new = new[of.near(np.array([x.J for x in state.models[place.compared :]]))]
            for m in new.tolist():
                gain = predicted_gain(state, k, state.models[m])
                if gain > state.tolerance:
                    self.found[k, m] = gain
            place.compared = len(state.models)
        used: set[int] = set()
        count = len(state.places)
        self.found = {pair: gain for pair, gain in self.found.items() if pair[0] < count}
        for k, m in sorted(self.found, key=lambda pair: -self.found[pair]):
            if k in used or not state.places[k].closed:
                continue
            used.add(k)
            if len(used) > most:
                break
            place = state.places[k]
            if predicted_gain(state, k, state.models[m]) <= state.tolerance:
                del self.found[k, m]  # the incumbent has become better
                continue
            start, chance = state.models[m], self.rate.recent
            yield approach_from(k, place, start, chance)

    def learn(self, state: State, offer: Offer, _: Outcome, gain: float) -> None:
        """Count the search, and try the pair no more."""
        self.rate.note(gain > state.tolerance)
        m = next(i for i, x in enumerate(state.models) if x is offer.start)
        self.found.pop((offer.place, m), None)


def predicted_gain(state: State, k: int, model: Solution) -> float:
    """Return the gain that a model's own derivatives promise a subproblem, 0 for its incumbent."""
    place, evaluation = state.places[k], model.evaluation
    if np.abs((model.theta - place.incumbent.theta) / state.span).max() <= DISTINCT:
        return 0.0
    local = Linearised(state.problem, place.subproblem.programme, evaluation)
    _, step, _ = local.step(evaluation.H, Options().radius, None)
    J = local.promised(step.s)
    promise, own = place.subproblem.order.value(np.array([J, evaluation.J]))
    return place.subproblem.gain(J if promise < own else evaluation.J, place.incumbent)
