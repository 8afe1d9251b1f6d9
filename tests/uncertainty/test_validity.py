"""Where linearised scatter is doubtful: closed forms on both sides of each criterion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from problems import Derivatives, Known, box, many_minima

from modefront._typing import Floats
from modefront.front.front import Edge, Front
from modefront.front.gaps import Gap
from modefront.front.point import Kind, Point
from modefront.front.simplex import payoff
from modefront.front.subproblems import LatticePoint
from modefront.optim.problem import Evaluation, with_second_order
from modefront.optim.scalarisation import weighted
from modefront.optim.sqp import Status, begin, solve
from modefront.uncertainty.noise import Noise
from modefront.uncertainty.points import Role, SolvedPoint
from modefront.uncertainty.scatter import (
    LinearisationWarning,
    Scatter,
    boundary,
    doubts,
    given_weights,
    optimal_weights,
    scatter,
)

CORNERS = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])


def point_at(problem: Known, theta: list[float]) -> Evaluation:
    point = with_second_order(problem, problem.evaluate(np.array(theta)))
    assert point is not None
    return point


@pytest.mark.parametrize(
    ("measured", "doubts"),
    [
        (0.70, ()),
        (0.95, (LinearisationWarning.MEETS,)),
        (1.05, (LinearisationWarning.LEAVES,)),
        (1.30, ()),
    ],
)
def test_a_bound_within_the_scatter_of_a_measured_value(
    measured: float, doubts: tuple[LinearisationWarning, ...]
) -> None:
    """J = (theta - y)**2, y with a standard deviation of 0.1, theta at most 1."""

    def bowl(theta: Floats) -> Derivatives:
        r = theta - measured
        return r**2, 2 * r[None], np.full((1, 1, 1), 2.0)

    problem = box(bowl, [0.0], [1.0], 1)
    theta = min(measured, 1.0)
    noise = Noise(np.array([[-0.2 * (theta - measured)]]), np.array([[[-0.2]]]))
    result = scatter(problem, point_at(problem, [theta]), np.ones(1), given_weights(noise), noise)
    assert result.theta == pytest.approx(0.1 if measured < 1 else 0.0)
    assert result.warnings == doubts


@pytest.mark.parametrize(("d", "doubts"), [(0.9, ()), (1.1, (LinearisationWarning.SADDLE,))])
def test_optimal_weights_hold_a_model_between_close_minima_only(
    d: float, doubts: tuple[LinearisationWarning, ...]
) -> None:
    """J = 1 + (theta -+ d)**2: ln J1 + ln J2 has a minimum at 0 for d < 1, else a maximum."""

    def bowls(theta: Floats) -> Derivatives:
        r = theta - np.array([d, -d])
        return 1 + r**2, 2 * r[:, None], np.full((2, 1, 1), 2.0)

    problem = box(bowls, [-2.0], [2.0])
    point, a = point_at(problem, [0.0]), np.ones(2)
    noise = Noise(np.array([[0.01, 0.0]]), np.array([[[0.01], [0.0]]]))
    result = scatter(problem, point, a / point.J, optimal_weights(point, a, noise), noise)
    assert result.warnings == doubts


def of_corners(beta: Floats, std: float) -> Scatter:
    """Return the scatter of a point of three bowls whose corners have errors."""

    def bowls(theta: Floats) -> Derivatives:
        r = theta - CORNERS
        return 0.1 + (r**2).sum(axis=1), 2 * r, np.array([2 * np.eye(2)] * 3)

    def noise(theta: Floats) -> Noise:
        J, dJ = np.zeros((3, 2, 3)), np.zeros((3, 2, 3, 2))
        for i, k in np.ndindex(3, 2):
            J[i, k, i] = -2 * std * (theta - CORNERS[i])[k]
            dJ[i, k, i, k] = -2 * std
        return Noise(J.reshape(6, 3), dJ.reshape(6, 3, 2))

    problem = box(bowls, [-2.0, -2.0], [2.0, 2.0], 3)
    weights = [weighted(w) for w in np.eye(3)]
    edges = [solve(problem, w, begin(problem.evaluate(np.zeros(2)))) for w in weights]
    dE = []
    for edge, w in zip(edges, np.eye(3), strict=True):
        point, chosen = point_at(problem, edge.theta.tolist()), noise(edge.theta)
        dE.append(scatter(problem, point, w, given_weights(chosen), chosen).J)
    target = payoff(edges, np.ones(3))
    assert target is not None
    result = LatticePoint(beta, (), target).solve(problem, edges[0])
    assert result.converged
    E = np.array([edge.J for edge in edges]).T
    point, chosen = point_at(problem, result.theta.tolist()), noise(result.theta)
    found = boundary(point, result.weights, E, np.stack(dE, axis=2), beta, chosen)
    assert found is not None
    w, conditions = found
    return scatter(problem, point, w, conditions, chosen)


def test_points_next_to_a_change_of_the_active_set_are_doubtful() -> None:
    """From the middle of the triangle across its side, where the third weight vanishes."""
    inside, outside = np.array([0.35, 0.3, 0.35]), np.array([0.6, -0.2, 0.6])
    steps = np.linspace(0, 1, 21)
    line = [(1 - s) * inside + s * outside for s in steps]
    counts = []
    for std in (1e-6, 0.05, 0.15):
        doubtful = [
            LinearisationWarning.SWITCHES in of_corners(beta, std).warnings for beta in line
        ]
        assert not doubtful[0]
        assert not doubtful[-1]
        where = np.flatnonzero(doubtful)
        assert (np.diff(where) == 1).all(), "one band around the change"
        counts.append(where.size)
    assert counts[0] <= 1
    assert counts[0] < counts[1] < counts[2]


@pytest.mark.parametrize(
    ("std", "status", "expected"),
    [
        (19.0, Status.CONVERGED, ()),
        (21.0, Status.CONVERGED, (LinearisationWarning.RIVAL,)),
        (1.0, Status.STALLED, (LinearisationWarning.UNSOLVED,)),
    ],
)
def test_another_model_that_fits_as_well_is_a_rival(
    std: float, status: Status, expected: tuple[LinearisationWarning, ...]
) -> None:
    """J1 vanishes at (1, -2) and (1, 2), J2 is 20 less at the first: errors of J2 decide."""
    problem = box(many_minima, [-4, -4], [4, 4])
    best, other = (begin(problem.evaluate(np.array([1.0, y]))) for y in (-2.0, 2.0))
    assert other.J - best.J == pytest.approx([0, 20])
    best = replace(best, status=status)
    edges = [Edge(best, [best, other]), Edge(other, [other])]
    front = Front("nbi", [Point(Kind.EDGE, best, "J1")], edges, [], None, (True, False), None, [])
    point, none = SolvedPoint("edge-J1", best, Role("edge", objective=0)), np.zeros((1, 2))
    chosen = Scatter(none, np.array([[0.0, std]]), none.T, ())
    assert tuple(doubts(front, point, chosen, np.ones(2), np.ones(2))) == expected


@pytest.mark.parametrize(
    ("std", "known", "doubtful"), [(0.9, 2, False), (1.1, 2, True), (1.1, 1, False)]
)
def test_a_point_whose_scatter_reaches_the_end_of_a_branch_is_doubtful(
    std: float, known: int, doubtful: bool
) -> None:
    """The branch ends one farther in both objectives, and the next begins three away."""
    at = begin(Evaluation(np.zeros(1), np.array([2.0, 5.0])))
    near, far = (begin(Evaluation(np.zeros(1), at.J + x)) for x in ([-1.0, 1.0], [-3.0, 3.0]))
    gap = Gap(1.5, far, near if known == 2 else None)
    front = Front("nbi", [], [], [], None, (False, False), None, [gap])
    at = replace(at, status=Status.CONVERGED)
    none = np.zeros((1, 1))
    scattered = Scatter(none, np.array([[std, -0.6 * std], [0.0, 0.8 * std]]), none.T, ())
    expected = (LinearisationWarning.ENDS,) if doubtful else ()
    for role, said in ((Role("boundary"), expected), (Role("weights"), ())):
        point = SolvedPoint("x", at, role)
        assert tuple(doubts(front, point, scattered, np.ones(2), np.ones(2))) == said
