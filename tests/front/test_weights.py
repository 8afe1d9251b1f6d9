"""Which minima of sum a ln J are accepted, and the iteration of the weights."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from problems import Derivatives, Known, box, circles, curved

from modefront._typing import Floats
from modefront.front.options import Pareto
from modefront.front.pareto import pareto_front
from modefront.front.point import Kind, of_kind
from modefront.front.weights import accepted, is_minimum, iterate_weights, least_along
from modefront.optim.lexicographic import EXACT
from modefront.optim.problem import Evaluation
from modefront.optim.scalarisation import LogSum, weighted
from modefront.optim.sqp import TIGHT, Solution, begin, solve

ONES = np.ones(2)
SUM = LogSum(ONES, vanishing=EXACT)


def solution_at(J: Sequence[float]) -> Solution:
    """Return a solution of which only the objectives count."""
    return begin(Evaluation(np.zeros(2), np.array(J)))


def labels(result: Sequence[Solution]) -> list[list[float]]:
    return [solution.J.tolist() for solution in result]


def quadratic(curvature: tuple[float, float]) -> Known:
    """Return a problem of J = (1 + x + c x^2, 1 - x + c x^2 + y^2): I is stationary at 0."""

    def function(theta: Floats) -> Derivatives:
        (x, y), (c, d) = theta, curvature
        J = np.array([1 + x + c * x**2, 1 - x + c * x**2 + d * y**2])
        dJ = np.array([[1 + 2 * c * x, 0.0], [-1 + 2 * c * x, 2 * d * y]])
        return J, dJ, np.array([np.diag([2 * c, 0.0]), np.diag([2 * c, 2 * d])])

    return box(function, [-1.0, -1.0], [1.0, 1.0])


@pytest.mark.parametrize(
    ("curvature", "holds"), [((0.6, 1.0), True), ((0.4, 1.0), False), ((0.6, 0.0), True)]
)
def test_a_minimum_is_accepted_by_its_own_curvature(
    curvature: tuple[float, float], holds: bool
) -> None:
    """Second derivatives of I along x are 4 c - 2; along y nothing changes where d is 0."""
    problem = quadratic(curvature)
    there = problem.evaluate(np.zeros(2))
    exact = replace(there, exact=True)
    found = begin(exact)
    assert is_minimum(problem, found.evaluation, SUM) == holds
    assert len(accepted(problem, [found], SUM)) == holds


def test_regular_minima_are_accepted_best_first_and_no_exact_fit() -> None:
    problem, programme = quadratic((0.6, 1.0)), LogSum(np.array([3.0, 1.0]), vanishing=EXACT)
    first, other, exact = (solution_at(J) for J in ([0.1, 0.2], [0.2, 0.1], [1e-11, 0.2]))
    assert labels(accepted(problem, [other, exact, first], programme)) == [[0.1, 0.2], [0.2, 0.1]]


def test_starts_along_a_front_are_where_the_sum_is_least_among_neighbours() -> None:
    along = [
        solution_at(J) for J in ([1e-12, 2.0], [0.1, 1.0], [0.5, 0.5], [0.6, 0.2], [1.0, 0.19])
    ]
    result = least_along(along, SUM)
    assert labels(result) == [[0.1, 1.0], [0.6, 0.2]]


def minima_of(problem: Known, a: Floats) -> list[Solution]:
    """Return the minima of sum a ln J below random starts, best first."""
    starts = np.random.default_rng(0).uniform(problem.lower, problem.upper, (6, problem.lower.size))
    found = [
        solve(problem, LogSum(a, vanishing=EXACT), begin(problem.evaluate(theta)), TIGHT)
        for theta in starts
    ]
    return sorted(found, key=lambda x: LogSum(a).value(x.J))


def test_on_a_front_of_exact_fits_the_sum_falls_without_bound() -> None:
    """On the segment between the circles' centres, sum ln J is least at its ends, exact fits."""
    problem = box(circles, [-1.0, -1.0], [3.0, 3.0])
    assert all(SUM.value(x.J) == -np.inf for x in minima_of(problem, ONES))


# ---- the fixed point of the iteration --------------------------------------------------------


def offset(theta: Floats) -> Derivatives:
    J, dJ, H = curved(theta)
    return J + np.array([0.3, 0.2]), dJ, H


def test_optimal_weights_are_a_over_J_and_the_iteration_agrees() -> None:
    problem, a = box(offset, [-2, -2], [2, 2]), np.array([3.0, 5.0])
    best = minima_of(problem, a)[0]
    assert best.converged
    again = solve(problem, weighted(a / best.J), begin(best.evaluation))
    assert again.theta == pytest.approx(best.theta, abs=1e-6)
    start = solve(problem, weighted(np.ones(2)), begin(problem.evaluate(problem.start)))
    iterated = iterate_weights(problem, LogSum(a, vanishing=4 * EXACT), start)
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
    assert iterate_weights(problem, SUM, exact) is None


@pytest.mark.parametrize("points", [pytest.param(3, marks=pytest.mark.slow(2)), 5, 11])
def test_a_front_has_the_model_of_optimal_weights_where_one_is_regular(points: int) -> None:
    a = np.array([3.0, 5.0])
    front = pareto_front(box(offset, [-2, -2], [2, 2]), a, Pareto(points=points))
    (best,) = of_kind(front.points, Kind.OPTIMAL)
    assert best is front.reference
    assert front.iterated is not None
    assert front.iterated.theta == pytest.approx(best.solution.theta, abs=1e-5)
    again = minima_of(box(offset, [-2, -2], [2, 2]), a)[0]
    assert best.solution.theta == pytest.approx(again.theta, abs=1e-6)
    exact = pareto_front(box(circles, [-2, -2], [2, 2]), a, Pareto(points=points))
    assert not of_kind(exact.points, Kind.OPTIMAL)
    assert exact.reference.kind is Kind.EQUAL
