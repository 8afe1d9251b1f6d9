"""Points of fronts compete with visited models, with other branches, and with their neighbours."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from problems import Derivatives, Known, box

from modefront._typing import Floats
from modefront.solvers.archive import Archive
from modefront.solvers.attainment import Attainment
from modefront.solvers.border import without_slack
from modefront.solvers.competition import (
    Comparison,
    Visited,
    from_neighbours,
    from_points_beside,
    from_visited,
    polished,
)
from modefront.solvers.continuation import simplex
from modefront.solvers.nbi import Projection
from modefront.solvers.payoff import Payoff
from modefront.solvers.problem import infeasible
from modefront.solvers.sqp import Solution, Status, begin, solve
from modefront.work.run import Run
from modefront.work.task import Within

CENTRES = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
STEP = 0.05
"""Height of all objectives in the left basin."""


def two_basins(theta: Floats) -> Derivatives:
    """Squared distances of (x, y) from three places, and a well at z = -1 and a lower one at 1."""
    r, z = theta[:2] - CENTRES, theta[2]
    well = (z**2 - 1) ** 2 + STEP * (1 - z) / 2
    J = (r**2).sum(axis=1) + well
    dJ = np.column_stack([2 * r, np.full(3, 4 * z * (z**2 - 1) - STEP / 2)])
    H = np.array([np.diag([2.0, 2.0, max(12 * z**2 - 4, 0.0)])] * 3)
    return J, dJ, H


PROBLEM = box(two_basins, [-0.5, -0.5, -1.5], [1.5, 1.5, 1.5], 3)
TARGET = Payoff(np.zeros(3), np.ones(3), np.ones((3, 3)) - np.eye(3))
ATTAINMENT = Attainment(TARGET, np.zeros((0, 3)))


def solved(problem: Known, beta: list[float], z: float) -> Solution:
    """Return the point of the front at beta, from a start near z."""
    start = begin(problem.evaluate(np.array([0.3, 0.3, z])))
    solution = solve(problem, ATTAINMENT.subproblem(np.array(beta)), start)
    assert solution.converged
    assert np.sign(solution.theta[2]) == np.sign(z)
    return replace(solution, beta=np.array(beta))


def test_points_are_solved_again_from_a_better_branch_beside_them() -> None:
    worse, better = solved(PROBLEM, [0.3, 0.4, 0.3], -1.0), solved(PROBLEM, [0.3, 0.3, 0.4], 1.0)
    ends = from_points_beside(PROBLEM, TARGET, simplex(3, 10), [worse, better])
    expected = solved(PROBLEM, [0.3, 0.4, 0.3], 1.0)
    assert ends[0].J == pytest.approx(expected.J, abs=1e-6)
    assert ends[0].evaluations > 0
    assert ends[1] is better
    assert (worse.J - ends[0].J).min() > 0.9 * STEP


def test_a_point_keeps_its_place_on_the_lattice() -> None:
    worse, better = solved(PROBLEM, [0.3, 0.4, 0.3], -1.0), solved(PROBLEM, [0.3, 0.3, 0.4], 1.0)
    ends = from_points_beside(PROBLEM, TARGET, simplex(3, 10), [worse, better])
    assert ends[0].beta is worse.beta
    assert ends[0] is not worse


def test_a_point_far_from_all_others_is_compared_with_the_nearest() -> None:
    worse, better = solved(PROBLEM, [0.6, 0.2, 0.2], -1.0), solved(PROBLEM, [0.2, 0.6, 0.2], 1.0)
    assert np.abs(worse.J - better.J).max() > 3 * 0.1, "three steps of the lattice"
    ends = from_points_beside(PROBLEM, TARGET, simplex(3, 10), [worse, better])
    assert (worse.J - ends[0].J).min() > 0.9 * STEP


def test_models_that_cannot_be_evaluated_do_not_compete() -> None:
    worse, better = solved(PROBLEM, [0.3, 0.4, 0.3], -1.0), solved(PROBLEM, [0.3, 0.3, 0.4], 1.0)
    nowhere = begin(infeasible(np.zeros(3), 3))
    ends = from_points_beside(PROBLEM, TARGET, simplex(3, 10), [worse, nowhere, better])
    assert (worse.J - ends[0].J).min() > 0.9 * STEP
    assert ends[1] is nowhere
    assert ends[2] is better


def test_points_are_solved_again_from_a_basin_that_a_search_has_only_visited() -> None:
    worse = solved(PROBLEM, [0.3, 0.4, 0.3], -1.0)
    visited = Archive(PROBLEM)
    visited.evaluate(np.array([*worse.theta[:2], 0.85]))
    assert (visited.J > worse.J).all(), "no model that is known is ahead of the point"
    ends = from_points_beside(PROBLEM, TARGET, simplex(3, 10), [worse], visited=visited)
    assert ends[0].J == pytest.approx(solved(PROBLEM, [0.3, 0.4, 0.3], 1.0).J, abs=1e-6)


def test_starts_are_the_best_visited_models_far_from_a_point_and_from_one_another() -> None:
    point = solved(PROBLEM, [0.3, 0.4, 0.3], -1.0)
    visited = Archive(PROBLEM)
    x, y = point.theta[:2]
    models = {
        "near the point": ([x, y, -0.95], [0.0, 0.0, 1e-3]),
        "best": ([x, y, 1.0], [2e-3, -1e-3, 0.0]),
        "near the best": ([x, y, 0.8], [3e-3, -2e-3, 0.0]),
        "next": ([x + 0.7, y, 1.0], [-1e-3, 5e-3, 5e-3]),
        "far behind": ([x, y + 0.7, 1.0], [-1e-2, 0.4, -1e-2]),
    }
    for theta, behind in models.values():
        visited.add(np.array(theta), point.J + behind)
    assert len(visited.theta) == len(models), "no model dominates another one"
    starts = Visited.of(PROBLEM, TARGET, simplex(3, 10), visited).starts(point)
    assert np.array(starts) == pytest.approx(np.array([models[x][0] for x in ("best", "next")]))


def test_one_smooth_branch_costs_nothing() -> None:
    betas = simplex(3, 10).beta
    inner = betas[betas.min(axis=1) >= 0.2]
    points = [solved(PROBLEM, list(beta), 1.0) for beta in inner]
    assert len(points) == 15
    forbidden = box(unreachable, [-0.5, -0.5, -1.5], [1.5, 1.5, 1.5], 3)
    ends = from_points_beside(forbidden, TARGET, simplex(3, 10), points)
    assert all(x is y for x, y in zip(ends, points, strict=True))


def test_heights_over_tangent_planes_are_equal_along_a_branch_of_even_curvature() -> None:
    """The point at beta minimises a weighted sum: h_kj = |theta_k - theta_j|^2 = h_jk."""
    points = [solved(PROBLEM, [0.3, y, 0.7 - y], 1.0) for y in (0.3, 0.4)]
    height, back = Comparison.of(PROBLEM, TARGET, simplex(3, 10), points).heights(0)
    expected = ((points[0].theta - points[1].theta) ** 2).sum()
    assert height == pytest.approx([0.0, expected], rel=1e-5)
    assert back == pytest.approx([0.0, expected], rel=1e-5)


def test_pairs_of_points_that_were_compared_cost_nothing() -> None:
    points = [solved(PROBLEM, [0.3, 0.4, 0.3], -1.0), solved(PROBLEM, [0.3, 0.3, 0.4], 1.0)]
    first = from_points_beside(PROBLEM, TARGET, simplex(3, 10), points)
    forbidden = box(unreachable, [-0.5, -0.5, -1.5], [1.5, 1.5, 1.5], 3)
    again = from_points_beside(forbidden, TARGET, simplex(3, 10), first, before=first)
    assert all(x is y for x, y in zip(again, first, strict=True))
    assert without_slack(forbidden, TARGET, first, before=first) == first


def test_points_that_have_stopped_short_of_the_front_are_solved_to_the_end() -> None:
    exact = solved(PROBLEM, [0.3, 0.4, 0.3], 1.0)
    assert exact.learned.any()
    short = replace(exact, evaluation=PROBLEM.evaluate(exact.theta + 1e-3 * np.eye(3)[2]))
    same, end = polished(PROBLEM, TARGET, [exact, short])
    assert same.J == pytest.approx(exact.J, abs=1e-12)
    assert (end.J < short.J).all()
    assert end.theta == pytest.approx(exact.theta, abs=1e-5)
    assert end.evaluations > short.evaluations


def test_polishing_costs_nothing_where_the_first_step_is_below_the_tolerance() -> None:
    exact = solve(
        PROBLEM, ATTAINMENT.subproblem(np.full(3, 1 / 3)), solved(PROBLEM, [1 / 3] * 3, 1.0)
    )
    forbidden = box(unreachable, [-0.5, -0.5, -1.5], [1.5, 1.5, 1.5], 3)
    assert polished(forbidden, TARGET, [exact]) == [exact]


def unreachable(theta: Floats) -> Derivatives:
    raise AssertionError(f"evaluated at {theta}")


def test_of_equal_greatest_excess_the_lower_sum_is_better() -> None:
    beta = np.array([0.6, 0.3, 0.1])
    J = TARGET.Phi @ beta + 0.1 * TARGET.Phi.sum(axis=1)
    lower = J - [0.0, 0.0, 0.01]
    for programmes in (TARGET, ATTAINMENT):
        assert programmes.is_better(beta, lower, J)
        assert not programmes.is_better(beta, J, lower)
        assert not programmes.is_better(beta, lower + 1e-5, J), "a greater excess"
        assert not programmes.is_better(beta, J - 1e-8, J), "the same point"


TWO = Payoff(np.zeros(2), np.ones(2), np.ones((2, 2)) - np.eye(2))
LATTICE = simplex(2, 10)


def in_two_basins(theta: Floats) -> Derivatives:
    J, dJ, H = two_basins(theta)
    return J[:2], dJ[:2], H[:2]


BASINS = box(in_two_basins, [-0.5, -0.5, -1.5], [1.5, 1.5, 1.5], 2)


def projected(problem: Known, beta: Floats, start: list[float]) -> Solution:
    """Return the point of a front of two objectives at beta, from a start."""
    begun = begin(problem.evaluate(np.array(start)))
    solution = replace(solve(problem, Projection(TWO).subproblem(beta), begun), beta=beta)
    assert solution.converged
    return solution


def along(z: float) -> list[Solution]:
    """Return three points of the front of two basins, in that near z."""
    betas = LATTICE.beta[[4, 5, 6]]
    return [projected(BASINS, beta, [beta[1], 0.0, z]) for beta in betas]


def searches(work: Run) -> list[tuple[int, int]]:
    """Return the point and the rank of the visited model of each search."""
    return [(key[4], key[6]) for key in work.costs]


def test_points_of_two_objectives_are_solved_again_from_their_neighbours() -> None:
    work = Run()
    left, right = along(-1.0), along(1.0)
    ends = from_neighbours(BASINS, TWO, LATTICE, [left[0], right[1], left[2]], work)
    for end, better in zip(ends, right, strict=True):
        assert end.J == pytest.approx(better.J, abs=1e-6)
    assert len(work.costs) == 3, "from one point each"
    counted = len(work.costs)
    assert from_neighbours(BASINS, TWO, LATTICE, right, Within(work, turn=("again",))) == right
    assert len(work.costs) == counted, "one smooth branch"


def test_a_visited_model_that_gains_is_tried_at_all_points_that_it_is_best_for() -> None:
    visited, work = Archive(BASINS), Run()
    visited.evaluate(np.array([0.52, 0.0, 0.95]))
    worse = along(-1.0)
    ends = from_visited(BASINS, TWO, LATTICE, worse, visited, work)
    for end, point, better in zip(ends, worse, along(1.0), strict=True):
        assert end.J == pytest.approx(better.J, abs=1e-6)
        assert (point.J - end.J).min() > 0.9 * STEP
    assert searches(work)[0] == (2, 1), "the point that it is the least behind"
    assert sorted(searches(work)) == [(1, 1), (2, 1), (3, 1)]


def test_a_visited_model_that_gains_nothing_is_tried_at_one_point_and_ends_it() -> None:
    visited, work = Archive(BASINS), Run()
    points = along(1.0)[:2]
    visited.add(np.array([0.52, 0.0, -0.85]), points[1].J + np.array([1e-3, 2e-3]))
    visited.add(np.array([0.9, 0.9, 1.0]), points[1].J + np.array([4e-3, 1e-3]))
    ranked = [Visited.of(BASINS, TWO, LATTICE, visited).best(point) for point in points]
    assert ranked == [[0, 1]] * 2, "two models that are far from all points"
    ends = from_visited(BASINS, TWO, LATTICE, points, visited, work)
    assert all(end is point for end, point in zip(ends, points, strict=True))
    assert searches(work) == [(2, 1)]


def many_parameters(theta: Floats) -> Derivatives:
    """Squared distances from two places, and a bowl in others of which no derivative is known."""
    r, u = theta[:1] - CENTRES[:2, :1], theta[1:]
    steep = np.geomspace(1e-3, 100.0, u.size)
    J = (r**2).sum(axis=1) + steep @ u**2
    dJ = np.column_stack([2 * r, np.tile(2 * steep * u, (2, 1))])
    return J, dJ, np.array([np.diag([2.0, *np.zeros(u.size)])] * 2)


def test_a_search_that_does_not_catch_up_is_given_up() -> None:
    problem = box(many_parameters, [-0.5] + [-1.0] * 40, [1.5] + [1.0] * 40, 2)
    beta = np.array([0.5, 0.5])
    point = begin(problem.evaluate(np.array([0.5, *np.zeros(40)])))
    point = replace(point, beta=beta, status=Status.CONVERGED, weights=np.ones(2))
    start = np.array([0.5, *np.linspace(0.3, 0.9, 40)])
    whole = solve(problem, Projection(TWO).subproblem(beta), begin(problem.evaluate(start)))
    visited, work = Archive(problem), Run()
    visited.add(start, point.J + 0.05)
    assert from_visited(problem, TWO, LATTICE, [point], visited, work) == [point]
    assert whole.status is Status.EXHAUSTED
    assert (whole.J > point.J).all(), "the point is not reached in a hundred steps"
    assert work.total().eigenproblems < 0.7 * whole.evaluations


def test_next_points_of_two_objectives_are_left_out_where_the_nearest_gain_nothing() -> None:
    good = along(1.0)[1]
    places = [good.theta, np.array([0.5, 0.9, 1.0]), np.array([1.2, 0.0, 1.0])]
    shifts = [np.zeros(2), np.array([-1e-2, 2e-2]), np.array([-2e-2, 4e-2])]
    points = [
        replace(good, evaluation=replace(good.evaluation, theta=theta, J=good.J + shift))
        for theta, shift in zip(places, shifts, strict=True)
    ]
    work = Run()
    coarse = simplex(2, 20)
    assert [len(Comparison.of(BASINS, TWO, coarse, points).starts(k, 1)) for k in range(3)] == [
        2
    ] * 3
    ends = from_neighbours(BASINS, TWO, coarse, points, work)
    assert all(end is point for end, point in zip(ends, points, strict=True))
    assert [(key[4], key[5]) for key in work.costs] == [(1, 1), (1, 2), (1, 3)], "rank and point"
