"""Which minima of sum a ln J are accepted, and minima with bounded weights."""

from collections.abc import Callable, Sequence
from functools import cache

import numpy as np
import pytest
from problems import Derivatives, Known, box, circles, curved, valley

from modefront._typing import Floats
from modefront.front.options import Pareto
from modefront.front.pareto import pareto_front
from modefront.front.point import Kind, of_kind
from modefront.front.weights import (
    accepted,
    iterate_weights,
    least_along,
    optimal_minimum,
    regular,
)
from modefront.optim.problem import Evaluation
from modefront.optim.scalarisation import LogSum, weighted
from modefront.optim.sqp import Solution, begin, solve

ONES = np.ones(2)
SIZES = np.full(2, 4.0)


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


def minima_of(problem: Known, a: Floats, b: Floats | float) -> list[Solution]:
    """Return the minima of sum a ln (J + b) below random starts, best first."""
    starts = np.random.default_rng(0).uniform(problem.lower, problem.upper, (6, problem.lower.size))
    found = [
        optimal_minimum(problem, a, np.ones(a.size), b, begin(problem.evaluate(theta)))
        for theta in starts
    ]
    return sorted(found, key=lambda x: float(a @ np.log(np.maximum(x.J + b, 1e-300))))


@cache
def bounded(
    function: Callable[[Floats], Derivatives], a: tuple[float, float], b: tuple[float, float]
) -> Solution:
    problem = box(function, [-1.0, -1.0], [3.0, 3.0])
    best = minima_of(problem, np.array(a), np.array(b))[0]
    assert best.converged
    return best


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
    assert all(not regular(x.J, ONES) for x in minima_of(problem, ONES, 0.0))
    ends = bounded(circles, (2.0, 1.0), (1e-3, 1e-3))
    t = float(np.sqrt(ends.J[0]))
    assert t + np.sqrt(ends.J[1]) == pytest.approx(1)
    assert 0 < t < 1e-3, "close to the centre of the first, not in it"
    # The derivative of 2 ln (t^2 + b) + ln ((1 - t)^2 + b) vanishes.
    assert 2 * t / (t**2 + 1e-3) == pytest.approx((1 - t) / ((1 - t) ** 2 + 1e-3), rel=1e-3)


# ---- the fixed point of the iteration --------------------------------------------------------


def offset(theta: Floats) -> Derivatives:
    J, dJ, H = curved(theta)
    return J + np.array([0.3, 0.2]), dJ, H


def test_optimal_weights_are_a_over_J_and_the_iteration_agrees() -> None:
    problem, a = box(offset, [-2, -2], [2, 2]), np.array([3.0, 5.0])
    best = minima_of(problem, a, 0.0)[0]
    assert best.converged
    again = solve(problem, weighted(a / best.J), begin(best.evaluation))
    assert again.theta == pytest.approx(best.theta, abs=1e-6)
    start = solve(problem, weighted(np.ones(2)), begin(problem.evaluate(problem.start)))
    iterated = iterate_weights(problem, a, SIZES, start)
    assert iterated is not None
    assert iterated.converged
    assert iterated.theta == pytest.approx(best.theta, abs=1e-5)
    programme = LogSum(a)
    for shift in np.random.default_rng(1).normal(scale=1e-3, size=(20, 2)):
        nearby = problem.evaluate(best.theta + shift).J
        assert programme.value(nearby) >= programme.value(best.J)


def test_an_exact_fit_has_no_weights() -> None:
    problem = box(circles, [-2, -2], [2, 2])
    exact = begin(problem.evaluate(np.zeros(2)))
    assert iterate_weights(problem, ONES, SIZES, exact) is None
    assert not regular(exact.J, SIZES)


def test_a_front_has_the_model_of_optimal_weights_or_else_of_bounded_ones() -> None:
    a = np.array([3.0, 5.0])
    front = pareto_front(box(offset, [-2, -2], [2, 2]), a, Pareto(points=5), floor=0.1 * ONES)
    (best,) = of_kind(front.points, Kind.OPTIMAL)
    assert not of_kind(front.points, Kind.BOUNDED)
    assert best is front.reference
    assert front.floor is None
    assert front.iterated is not None
    assert front.iterated.theta == pytest.approx(best.solution.theta, abs=1e-5)
    exact = pareto_front(box(circles, [-2, -2], [2, 2]), a, Pareto(points=5), floor=0.1 * ONES)
    assert not of_kind(exact.points, Kind.OPTIMAL)
    (bound,) = of_kind(exact.points, Kind.BOUNDED)
    assert bound is exact.reference
    assert exact.floor is not None
    w = a / (bound.solution.J + exact.floor)
    assert w @ bound.solution.evaluation.dJ == pytest.approx(np.zeros(2), abs=1e-4)
