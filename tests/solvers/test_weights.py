"""Which minima of sum a ln J are accepted, and minima with bounded weights."""

from collections.abc import Callable, Sequence
from functools import cache

import numpy as np
import pytest
from problems import Derivatives, box, circles, valley

from modefront._typing import Floats
from modefront.solvers.explore import Search
from modefront.solvers.problem import Evaluation
from modefront.solvers.scalarisation import LogSum
from modefront.solvers.sqp import Solution, begin
from modefront.solvers.weights import accepted, least_along, optimal_minima

ONES = np.ones(2)
SEARCH = Search(starts=4, limit=6, evolutions=0)


def solution_at(J: Sequence[float]) -> Solution:
    """Return a solution of which only the objectives count."""
    return begin(Evaluation(np.zeros(2), np.array(J)))


def labels(result: Sequence[Solution]) -> list[list[float]]:
    return [solution.J.tolist() for solution in result]


NONE: Floats = np.zeros((0, 2))


def test_a_minimum_that_is_worse_than_known_regular_models_is_absurd() -> None:
    absurd, good = solution_at([0.9, 0.8]), solution_at([0.1, 0.2])
    rivals = [solution_at([0.3, 0.1]), solution_at([0.05, 0.9])]
    assert labels(accepted([absurd, good], ONES, ONES, rivals, NONE, ONES)) == [[0.1, 0.2]]
    assert accepted([absurd], ONES, ONES, rivals, NONE, ONES) == []
    # A rival that fits a group exactly says nothing: sum a ln J falls to minus infinity there.
    singular = [solution_at([1e-14, 0.5])]
    assert labels(accepted([good], ONES, ONES, singular, NONE, ONES)) == [[0.1, 0.2]]


def test_a_minimum_that_a_known_model_dominates_is_none() -> None:
    good = solution_at([0.1, 0.2])
    for known, kept in (([0.1, 0.19], 0), ([0.1, 0.2], 1), ([0.1 - 1e-9, 0.2 - 1e-9], 1)):
        assert len(accepted([good], ONES, ONES, [], np.array([known]), ONES)) == kept
    assert accepted([solution_at([1e-11, 0.2])], ONES, ONES, [], NONE, ONES) == [], "an exact fit"


def test_several_are_accepted_best_first() -> None:
    first, other = solution_at([0.1, 0.2]), solution_at([0.2, 0.1])
    a = np.array([3.0, 1.0])
    assert labels(accepted([other, first], ONES, ONES, [], NONE, ONES)) in (
        [[0.1, 0.2], [0.2, 0.1]],
        [[0.2, 0.1], [0.1, 0.2]],
    )
    assert labels(accepted([other, first], a, ONES, [solution_at([0.2, 0.1])], NONE, ONES))[0] == [
        0.1,
        0.2,
    ]


def test_starts_along_a_front_are_where_the_sum_is_least_among_neighbours() -> None:
    along = [
        solution_at(J) for J in ([1e-12, 2.0], [0.1, 1.0], [0.5, 0.5], [0.6, 0.2], [1.0, 0.19])
    ]
    result = least_along(along, ONES, ONES)
    assert labels(result) == [[0.1, 1.0], [0.6, 0.2]]


@cache
def bounded(
    function: Callable[[Floats], Derivatives], a: tuple[float, float], b: tuple[float, float]
) -> Solution:
    problem = box(function, [-1.0, -1.0], [3.0, 3.0])
    rng = np.random.default_rng(0)
    result = optimal_minima(problem, np.array(a), ONES, SEARCH, [], np.array(b), rng=rng)
    assert result[0].converged
    return result[0]


@pytest.mark.parametrize("function", [circles, valley])
@pytest.mark.parametrize("b", [(0.3, 0.3), (0.1, 0.4)])
def test_bounded_weights_have_their_minimum_where_a_grid_has_it(
    function: Callable[[Floats], Derivatives], b: tuple[float, float]
) -> None:
    a = (2.0, 1.0)
    result = bounded(function, a, b)
    axis = np.linspace(-1, 3, 41)
    grid = [np.array([x, y]) for x in axis for y in axis]
    values = [float(np.array(a) @ np.log(function(theta)[0] + b)) for theta in grid]
    programme = LogSum(np.array(a), np.array(b))
    value = programme.value(result.J)
    assert value <= min(values)
    assert value >= min(values) - 0.1
    w = np.array(a) / (result.J + b)
    assert result.weights == pytest.approx(w)
    assert w @ result.evaluation.dJ == pytest.approx(np.zeros(2), abs=1e-4)


def test_without_a_floor_the_sum_falls_without_bound_and_with_one_it_ends() -> None:
    """On the segment between the circles' centres, sum ln J is least at its ends, exact fits."""
    problem = box(circles, [-1.0, -1.0], [3.0, 3.0])
    result = optimal_minima(problem, ONES, ONES, SEARCH, [], rng=np.random.default_rng(0))
    assert result == []
    ends = bounded(circles, (2.0, 1.0), (1e-3, 1e-3))
    t = float(np.sqrt(ends.J[0]))
    assert t + np.sqrt(ends.J[1]) == pytest.approx(1)
    assert 0 < t < 1e-3, "close to the centre of the first, not in it"
    # The derivative of 2 ln (t^2 + b) + ln ((1 - t)^2 + b) vanishes.
    assert 2 * t / (t**2 + 1e-3) == pytest.approx((1 - t) / ((1 - t) ** 2 + 1e-3), rel=1e-3)
