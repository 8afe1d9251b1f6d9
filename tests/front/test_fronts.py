"""Problems with known answers: points called Pareto optimal lie on the front, and cover it."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from problems import (
    FLAT_CORNERS,
    Derivatives,
    Known,
    bowls,
    box,
    circles,
    concave,
    curved,
    disconnected,
    flat_bowls,
    many_minima,
    patches,
    sphere,
    three_wells,
    valley,
)

from modefront._typing import Floats
from modefront.front.dominance import nondominated, undominated
from modefront.front.front import Front
from modefront.front.gaps import branch_numbers
from modefront.front.indicators import igd_plus
from modefront.front.options import Pareto
from modefront.front.pareto import pareto_front
from modefront.front.point import Kind, of_kind
from modefront.front.simplex import size
from modefront.front.subproblems import RHO
from modefront.optim.problem import Evaluation
from modefront.optim.sqp import Solution

Function = Callable[[Floats], Derivatives]

CASES: dict[Function, tuple[list[float], list[float], int, int]] = {
    circles: ([-2, -2], [2, 2], 2, 11),
    curved: ([-2, -2], [2, 2], 2, 11),
    concave: ([-2, -2], [2, 2], 2, 15),
    disconnected: ([0, -1], [0.651, 1], 2, 25),
    valley: ([0.1, 0.1], [3, 3], 2, 6),
    many_minima: ([-4, -4], [4, 4], 2, 6),
    three_wells: ([-1, -1.5], [2, 1.5], 2, 11),
    bowls: ([-2, -2], [2, 2], 3, 5),
    sphere: ([0, 0, 0], [1, 1, 1], 3, 6),
    flat_bowls: ([-2, -2], [2, 2], 3, 6),
    patches: ([0, 0, 0], [1, 1, 1], 3, 6),
}
"""Bounds, number of objectives, and points along each edge."""


def problem_of(function: Function) -> Known:
    lower, upper, n, _ = CASES[function]
    return box(function, lower, upper, n)


@cache
def front_of(function: Function) -> Front:
    _, _, n, points = CASES[function]
    return pareto_front(problem_of(function), np.ones(n), Pareto(points=points), seed=1)


def along(front: Front) -> list[Solution]:
    return [point.solution for point in of_kind(front.points, Kind.FRONT)]


def objectives(front: Front) -> Floats:
    return np.array([solution.J for solution in along(front)])


@pytest.mark.parametrize(
    "function",
    [pytest.param(x, marks=[pytest.mark.slow(2)] * (x is patches)) for x in CASES],
    ids=lambda function: function.__name__,
)
def test_points_of_a_front_converge_and_no_evaluated_model_dominates_them(
    function: Function,
) -> None:
    front = front_of(function)
    J = objectives(front)
    assert front.target is not None
    assert all(point.converged for point in along(front))
    assert all(point.solution.converged for point in front.points if point.kind is Kind.EDGE)
    assert nondominated(J).all()
    assert undominated(J, front.known, front.target.scale).all()
    assert len(front.places) == len(front.lattice)
    _, _, n, points = CASES[function]
    assert size(n, points) <= len(front.lattice) <= (2 if n > 2 else 1) * size(n, points)
    assert set(front.places.tolist()) == set(range(len(J)))


def test_what_rounding_takes_at_an_edge_does_not_dominate_it() -> None:
    """Next to a flat minimum of J1 models have it to all digits, and J2 is less by a slope."""
    edge, other = np.array([1.0, 4.53]), np.array([2.0, 0.1])
    for less, optimal in ((5e-6, True), (1e-3, False)):
        J = np.array([edge, edge - [0, less], other])
        assert nondominated(J).tolist() == [optimal, True, True]
        assert undominated(J[:1], J, np.ptp(J, axis=0)).tolist() == [optimal]


# ---- edges -----------------------------------------------------------------------------------


def test_edges_are_lexicographic() -> None:
    assert front_of(valley).edges[1].best.theta == pytest.approx([1, 1], abs=1e-6)
    assert front_of(many_minima).edges[0].best.theta == pytest.approx([1, -2], abs=1e-7)
    assert front_of(valley).exact == (True, True)


def test_an_edge_is_its_objective_at_its_least() -> None:
    for function in (circles, curved, concave, three_wells):
        front = front_of(function)
        for i, edge in enumerate(front.edges):
            least = float(front.known[:, i].min())
            assert edge.best.J[i] <= least + 1e-9
            assert all(edge.best.J[i] <= x.J[i] + 1e-9 for x in edge.minima)


# ---- two objectives --------------------------------------------------------------------------


@pytest.mark.parametrize("function", [circles, curved])
def test_the_front_of_two_bowls(function: Function) -> None:
    J = objectives(front_of(function))
    assert len(J) == 11
    assert np.sqrt(J).sum(axis=1) == pytest.approx(1, abs=1e-6)
    # The points lie on the normals: J1 - J2 changes by equal steps, but at the edges, where the
    # front is as steep as the share of all objectives.
    steps = np.diff(J[:, 0] - J[:, 1])
    assert steps[1:-1] == pytest.approx(0.2, abs=1e-6)
    assert steps[[0, -1]] == pytest.approx(0.2, abs=3 * RHO)


def test_a_concave_front_is_covered_evenly() -> None:
    front = front_of(concave)
    J = objectives(front)
    # On the front x1 = x2 = s: J = 1 - exp(-2 (s -+ c)**2) with |s| <= c.
    s = np.array([point.theta.mean() for point in along(front)])
    c = 1 / np.sqrt(2)
    assert J == pytest.approx(1 - np.exp(-2 * (s[:, None] - [c, -c]) ** 2), abs=1e-6)
    between = np.linalg.norm(np.diff(J, axis=0), axis=1)
    assert between.max() < 1.5 * between.min()


def test_a_disconnected_front_ends_at_its_gap() -> None:
    front = front_of(disconnected)
    J = objectives(front)
    (gap,) = front.gaps
    assert gap.end is not None
    assert gap.start is not None
    # The first piece ends at its minimum of J2, the second one begins where it undercuts that.
    x = np.linspace(0, 0.651, 1_000_001)
    f = 1 - x - np.sin(4 * np.pi * x) / 4
    hidden = x[np.flatnonzero((f > np.minimum.accumulate(f) + 1e-12) & (x < 0.6))]
    left, right = hidden[0], hidden[-1]
    assert gap.end.J[0] == pytest.approx(left, abs=1e-4)
    assert gap.start.J[0] == pytest.approx(right, abs=1e-4)
    pieces = branch_numbers(J, nondominated(J), [gap])
    assert set(pieces.tolist()) == {1, 2}
    assert ((pieces == 1) == (left + 1e-6 >= J[:, 0])).all()
    assert ((pieces == 2) == (right - 1e-6 <= J[:, 0])).all()


def test_a_piece_of_the_front_between_the_edges_is_found() -> None:
    front = front_of(three_wells)
    assert [round(float(edge.best.theta[1])) for edge in front.edges] == [-1, 1]
    assert sum(abs(point.theta[1]) < 0.5 for point in along(front)) >= 6


def test_one_best_model_is_a_front_of_one_point() -> None:
    def same(theta: Floats) -> Derivatives:
        J, dJ, H = circles(theta)
        return J[[0, 0]], dJ[[0, 0]], H

    front = pareto_front(box(same, [-2, -2], [2, 2]), np.ones(2), Pareto(points=5))
    assert front.target is None
    assert not along(front)
    assert front.edges[0].best.theta == pytest.approx([0, 0], abs=1e-6)


def test_a_refined_front_has_no_neighbours_far_apart() -> None:
    problem = problem_of(circles)
    coarse = pareto_front(problem, np.ones(2), Pareto(points=4))
    fine = pareto_front(problem, np.ones(2), Pareto(points=4, refined=0.2))
    J = objectives(fine)
    assert (np.diff(J[:, 0]) > 0).all(), "in their order along the front"
    assert max(np.linalg.norm(x - y) for x, y in pairwise(J)) <= 0.2
    assert max(np.linalg.norm(x - y) for x, y in pairwise(objectives(coarse))) > 0.2
    assert np.sqrt(J).sum(axis=1) == pytest.approx(1, abs=1e-6)


def test_a_sweep_of_the_weights_finds_minima_of_weighted_sums() -> None:
    front = pareto_front(problem_of(curved), np.ones(2), Pareto(method="weights", points=6))
    points = along(front)
    # w = (1 - s, s) has its minimum at x = s.
    assert [x.theta[0] for x in points] == pytest.approx(np.linspace(0, 1, 6), abs=1e-5)
    assert [x.theta[1] for x in points] == pytest.approx(np.linspace(0, 1, 6) ** 2, abs=1e-5)


def test_points_without_a_model_are_no_obstacle() -> None:
    """Objectives are defined in a quarter of the box only, which holds the front."""

    def hole(theta: Floats) -> Derivatives:
        J, dJ, H = circles(theta)
        return (J if (np.abs(theta - [0.5, 0.5]) < [1, 1]).all() else J + np.inf), dJ, H

    front = pareto_front(box(hole, [-1.5, -2], [2.5, 2]), np.ones(2), Pareto(points=5), seed=2)
    assert np.sqrt(objectives(front)).sum(axis=1) == pytest.approx(1, abs=1e-6)


# ---- three and more objectives ---------------------------------------------------------------


def test_the_front_of_three_bowls_is_their_triangle() -> None:
    points = along(front_of(bowls))
    assert len(points) >= 15
    for point in points:
        # Each point is stationary for the weights that come with it, and none is negative.
        w = point.weights / point.weights.sum()
        assert point.theta == pytest.approx(w[1:], abs=1e-4)
        assert (w > -1e-9).all()


def sphere_front(rng: np.random.Generator) -> Floats:
    u = np.abs(rng.normal(size=(2000, 3)))
    out: Floats = u / np.linalg.norm(u, axis=1)[:, None]
    return out


def flat_bowls_front(rng: np.random.Generator) -> Floats:
    inside = rng.dirichlet(np.ones(3), 2000) @ FLAT_CORNERS
    return np.array([flat_bowls(theta)[0] for theta in inside])


def patches_front(_: np.random.Generator) -> Floats:
    grid = np.linspace(0, 1, 71)
    J = np.array([patches(np.array([x, y, 0.0]))[0] for x in grid for y in grid])
    return J[nondominated(J)]


@pytest.mark.parametrize(
    ("function", "known", "covered"),
    [
        (sphere, sphere_front, 0.065),
        (flat_bowls, flat_bowls_front, 0.04),
        pytest.param(patches, patches_front, 0.08, marks=pytest.mark.slow(4)),
    ],
)
def test_fronts_of_three_objectives_are_covered_beyond_the_simplex(
    function: Function, known: Callable[[np.random.Generator], Floats], covered: float
) -> None:
    front = front_of(function)
    R = known(np.random.default_rng(0))
    scale = np.ptp(R, axis=0)
    J, R = objectives(front) / scale, R / scale
    assert igd_plus(J, R) <= covered
    # No point of the true front is dominated: the points found lie on it.
    assert igd_plus(R, J) <= 0.03


def test_the_sphere_is_met_and_distance_variables_vanish() -> None:
    assert np.linalg.norm(objectives(front_of(sphere)), axis=1) == pytest.approx(1, abs=1e-6)
    few = pareto_front(problem_of(patches), np.ones(3), Pareto(points=3), seed=1)
    assert max(abs(x.theta[2]) for x in along(few)) < 1e-5


def test_more_objectives_than_parameters_can_meet_on_a_normal() -> None:
    centres = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.2], [0.4, 1.4]])

    def five(theta: Floats) -> Derivatives:
        r = theta - centres
        return (r**2).sum(axis=1), 2 * r, np.array([2 * np.eye(2)] * 5)

    front = pareto_front(box(five, [-2, -2], [2, 2], 5), np.ones(5), Pareto(points=3))
    assert len(along(front)) >= 10
    # The Pareto set is the convex hull of the centres: each point is a mean of them.
    for point in along(front):
        assert point.converged
        w = point.weights / point.weights.sum()
        assert (w > -1e-9).all()
        assert point.theta == pytest.approx(w @ centres, abs=1e-4)


# ---- one objective that jumps ----------------------------------------------------------------

BAND = (0.3, 0.7)
"""Where another mode is paired."""


@dataclass(frozen=True)
class Switching:
    """(x - 0.8)**2, but 0.05 + 2 (x - 0.4)**2 in the band, where another mode is paired.

    From x = 0.2 the way down ends in the band, at 0.05; the minimum, 0, lies behind it.
    """

    lower: Floats = field(default_factory=lambda: np.zeros(1))
    upper: Floats = field(default_factory=lambda: np.ones(1))
    start: Floats = field(default_factory=lambda: np.array([0.2]))
    objectives: tuple[str, ...] = ("J",)

    def evaluate(
        self, theta: Floats, *, derivatives: bool = True, second: bool = False
    ) -> Evaluation:
        x = float(theta[0])
        piece = int(BAND[0] < x < BAND[1])
        c, centre, floor = ((1.0, 0.8, 0.0), (2.0, 0.4, 0.05))[piece]
        J, dJ = c * (x - centre) ** 2 + floor, 2 * c * (x - centre)
        H = np.full((1, 1, 1), 2 * c)
        return Evaluation(theta, np.array([J]), np.array([[dJ]]), H)


def test_the_least_of_one_objective_behind_a_jump_is_found() -> None:
    front = pareto_front(Switching(), np.ones(1))
    assert front.target is None
    assert front.edges[0].best.theta == pytest.approx([0.8], abs=1e-5)
    assert front.edges[0].best.J[0] == pytest.approx(0.0, abs=1e-9)
    assert any(x.J[0] == pytest.approx(0.05, abs=1e-6) for x in front.edges[0].minima)
