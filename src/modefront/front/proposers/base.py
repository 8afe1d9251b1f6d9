"""The interface of proposers: who says what to search next, and how likely that is to gain."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from modefront._typing import Floats
from modefront.front.archive import Outcome
from modefront.front.state import State
from modefront.front.subproblems import Subproblem
from modefront.optim.problem import Evaluation, Problem
from modefront.optim.sqp import Solution, begin

STEPS = 4
"""Steps of an approach, after which the model that is reached is compared with all others."""


@dataclass(frozen=True)
class Offer:
    """A search that is proposed.

    Attributes
    ----------
    place : number of the subproblem that is solved; -1 where models are only evaluated
    start : model from which it is solved
    chance : probability that some subproblem gains
    function : what is done with the problem and ``arguments``
    final : whether what it leads to is a solution of the subproblem
    unseen : part of the box that may lead to something better; the offer is worth making as long as
        this or the chance is above the doubt that is allowed
    """

    place: int
    start: Solution
    chance: float
    function: Callable[..., Any]
    arguments: tuple[Any, ...]
    final: bool = True
    unseen: float = 0.0


class Proposer(Protocol):
    """Proposes searches."""

    @property
    def name(self) -> str:
        """Name, by which tasks and costs are told apart."""

    def offers(self, state: State, most: int, /) -> Iterator[Offer]:
        """Yield the searches that are most likely to gain, best first, ``most`` or fewer."""

    def learn(self, state: State, offer: Offer, outcome: Outcome, gain: float, /) -> None:
        """Take note of what an offer of its own has led to."""


@dataclass
class Rate:
    """How often searches have gained: the posterior mean of a uniform prior.

    Attributes
    ----------
    tries, gains : numbers of searches, and of those that gained
    idle : searches since the last gain
    """

    tries: int = 0
    gains: int = 0
    idle: int = 0

    def note(self, gained: bool) -> None:
        """Count a search."""
        self.tries += 1
        self.gains += gained
        self.idle = 0 if gained else self.idle + 1

    @property
    def chance(self) -> float:
        """Probability that the next search gains."""
        return (self.gains + 1) / (self.tries + 2)

    @property
    def recent(self) -> float:
        """Likewise, of the searches since the last gain: it falls as a front is completed."""
        return 1 / (self.idle + 2)


def solve_from(place: int, subproblem: Subproblem, start: Solution, chance: float) -> Offer:
    """Return the offer to solve a subproblem from a start."""
    return Offer(place, start, chance, _solved, (subproblem, start))


def approach_from(
    place: int, subproblem: Subproblem, start: Solution, chance: float, steps: int = 100
) -> Offer:
    """Return the offer to approach the solution of a subproblem, by so many steps at most."""
    return Offer(place, start, chance, _approached, (subproblem, start, steps), final=False)


def evaluate_all(thetas: Floats, chance: float) -> Offer:
    """Return the offer to evaluate models (., p) without derivatives."""
    return Offer(-1, at(thetas[0]), chance, _evaluated, (thetas,), final=False)


def at(theta: Floats) -> Solution:
    """Return a start at parameters (p,) at which nothing is known."""
    return begin(Evaluation(theta, np.zeros(1)))


def _solved(problem: Problem, subproblem: Subproblem, start: Solution) -> Solution:
    """Return the solution of a subproblem from a start."""
    if start.evaluation.derivatives is None:
        start = begin(problem.evaluate(start.theta, second=True))
    return subproblem.solve(problem, start) if start.feasible else start


def _approached(problem: Problem, subproblem: Subproblem, start: Solution, steps: int) -> Solution:
    """Return a model on the way to the solution of a subproblem."""
    if start.evaluation.derivatives is None:
        start = begin(problem.evaluate(start.theta, second=True))
    return subproblem.approach(problem, start, steps) if start.feasible else start


def _evaluated(problem: Problem, thetas: Floats) -> Solution:
    """Evaluate models; the recorder of evaluations tells of all of them, the last is returned."""
    for theta in thetas:
        last = problem.evaluate(theta, derivatives=False)
    return begin(last)
