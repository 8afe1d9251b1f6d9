"""The interface of proposers: who says what to search next, and how likely that is to gain."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from modefront._typing import Floats
from modefront.front.archive import Outcome
from modefront.front.state import Place, State
from modefront.front.subproblems import Subproblem
from modefront.optim.problem import Evaluation, Problem
from modefront.optim.sqp import Solution, begin

USUAL = 10  # models of a generation, and random starts that cover the box together


@dataclass(frozen=True)
class Offer:
    """A search that is proposed."""

    place: int  # number of the subproblem that is solved; -1 where models are only evaluated
    start: Solution  # model from which it is solved
    chance: float  # probability that some subproblem gains, at most
    function: Callable[..., Any]  # what is done with the problem and ``arguments``
    arguments: tuple[Any, ...]
    expected: float | None = None  # that probability, as it is expected; None where it is the same


class Proposer(Protocol):
    """Proposes searches."""

    def offers(self, state: State, most: int, /) -> Iterator[Offer]:
        """Yield the searches that are most likely to gain, best first, ``most`` or fewer."""

    def learn(self, state: State, offer: Offer, outcome: Outcome, gain: float, /) -> None:
        """Take note of what an offer of its own has led to."""


def solve_from(
    k: int, place: Place, start: Solution, chance: float, expected: float | None = None
) -> Offer:
    """Return the offer to solve the subproblem of a place, the k-th one, from a start."""
    arguments = (place.subproblem, start, place.incumbent if place.closed else None)
    return Offer(k, start, chance, _solved, arguments, expected)


def evaluate_all(thetas: Floats, chance: float, expected: float | None = None) -> Offer:
    """Return the offer to evaluate models (., p) without derivatives."""
    return Offer(-1, at(thetas[0]), chance, _evaluated, (thetas,), expected)


def at(theta: Floats) -> Solution:
    """Return a start at parameters (p,) at which nothing is known."""
    return begin(Evaluation(theta, np.zeros(1)))


def _solved(
    problem: Problem, subproblem: Subproblem, start: Solution, known: Solution | None
) -> Solution:
    """Return the solution of a subproblem from a start."""
    start = evaluated(problem, start)
    return subproblem.solve(problem, start, known) if start.feasible else start


def evaluated(problem: Problem, solution: Solution) -> Solution:
    """Return a solution, or where its derivatives are not known, a start at its parameters."""
    if solution.evaluation.derivatives:
        return solution
    return begin(problem.evaluate(solution.theta, second=True))


def _evaluated(problem: Problem, thetas: Floats) -> list[Evaluation]:
    """Return models without derivatives."""
    return [problem.evaluate(theta, derivatives=False) for theta in thetas]
