"""Scatter of solutions: closed forms of linear problems, and solutions of perturbed problems."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from exact import Residuals, Squares, squares
from hypothesis import given
from hypothesis import strategies as st

from modefront._typing import Floats
from modefront.front.front import Edge, Front
from modefront.front.simplex import payoff
from modefront.front.subproblems import LatticePoint, active_bounds
from modefront.optim.problem import Evaluation, with_second_order
from modefront.optim.scalarisation import LogSum, Scalarisation, below, weighted
from modefront.optim.sqp import Options, Solution, begin, solve
from modefront.uncertainty.noise import Noise
from modefront.uncertainty.points import Role, SolvedPoint, edge_weights
from modefront.uncertainty.scatter import (
    Local,
    Scatter,
    boundary,
    front_scatter,
    given_weights,
    level,
    optimal_weights,
    scatter,
)

TIGHT = Options(step=1e-11, reduction=0.0, iterations=200)


@dataclass(frozen=True)
class Bent:
    """Objectives J_i = |A_i theta + bend (B_i theta)**2 - y_i|**2 whose data y have errors."""

    A: Floats  # (n, rows, p)
    B: Floats
    y: Floats  # (n, rows)
    std: Floats
    bend: float = 0.0

    def model(self, theta: Floats) -> tuple[Floats, Floats]:
        u = self.B @ theta
        return self.A @ theta + self.bend * u**2, self.A + 2 * self.bend * u[..., None] * self.B

    def __call__(self, theta: Floats) -> Residuals:
        g, dg = self.model(theta)
        return list(zip(g - self.y, dg, strict=True))

    def problem(self, lower: float = -5.0, upper: float = 5.0) -> Squares:
        n, _, p = self.A.shape
        return squares(self, [lower] * p, [upper] * p, n)

    def noise(self, theta: Floats) -> Noise:
        g, dg = self.model(theta)
        n, rows = self.y.shape
        J, dJ = np.zeros((n * rows, n)), np.zeros((n * rows, n, theta.size))
        for i in range(n):
            for m in range(rows):
                J[i * rows + m, i] = -2 * (g - self.y)[i, m] * self.std[i, m]
                dJ[i * rows + m, i] = -2 * dg[i, m] * self.std[i, m]
        return Noise(J, dJ)

    def moved(self, source: int, by: float) -> "Bent":
        y = self.y.copy()
        y.flat[source] += by * self.std.flat[source]
        return replace(self, y=y)


def bent(seed: int, p: int = 3, n: int = 2, rows: int = 5, bend: float = 0.1) -> Bent:
    rng = np.random.default_rng(seed)
    A, B = rng.normal(size=(2, n, rows, p))
    return Bent(A, B, rng.normal(size=(n, rows)), rng.uniform(0.1, 1, (n, rows)), bend)


def minimum(problem: Squares, programme: Scalarisation, theta: Floats) -> Solution:
    result = solve(problem, programme, begin(problem.evaluate(theta)), TIGHT)
    return solve(problem, programme, begin(result.evaluation), TIGHT)


def point_of(problem: Squares, result: Solution) -> Evaluation:
    point = with_second_order(problem, result.evaluation)
    assert point is not None
    return point


def compare(
    result: Scatter, ahead: list[Solution], behind: list[Solution], by: float, every: int = 1
) -> None:
    """Assert that a linearisation agrees with solutions of data moved to either side.

    ``every`` so many of the sources of error are compared.
    """
    for m, first, other in zip(range(0, len(result.theta), every), ahead, behind, strict=True):
        theta = (first.theta - other.theta) / (2 * by)
        J = (first.J - other.J) / (2 * by)
        assert result.theta[m] == pytest.approx(theta, rel=1e-4, abs=1e-5)
        assert result.J[m] == pytest.approx(J, rel=1e-4, abs=1e-5)


@given(st.integers(0, 10**6), st.integers(1, 3))
def test_weighted_least_squares_have_their_closed_form(seed: int, n: int) -> None:
    case = bent(seed, n=n, bend=0.0)
    problem = case.problem(-50, 50)
    w = np.random.default_rng(seed + 1).uniform(0.1, 1, n)
    computed = minimum(problem, weighted(w), np.zeros(3))
    point, noise = point_of(problem, computed), case.noise(computed.theta)
    result = scatter(problem, point, w, given_weights(noise), noise)
    A, W = case.A.reshape(-1, 3), np.repeat(w, 5)
    gain = np.linalg.solve(A.T @ (W[:, None] * A), A.T * W)
    expected = gain @ np.diag(case.std.ravel() ** 2) @ gain.T
    assert result.covariance == pytest.approx(expected, rel=1e-6, abs=1e-9)
    assert result.free.shape == (3, 0)


def test_optimal_weights_follow_the_data() -> None:
    case, by = bent(3), 1e-3
    a = np.array([5.0, 5.0])
    problem = case.problem()
    computed = minimum(problem, LogSum(a), np.zeros(3))
    noise, point = case.noise(computed.theta), point_of(problem, computed)
    result = scatter(problem, point, a / computed.J, optimal_weights(point, a, noise), noise)

    def again(source: int, by: float) -> Solution:
        return minimum(case.moved(source, by).problem(), LogSum(a), computed.theta)

    moved = [[again(m, s * by) for m in range(10)] for s in (1, -1)]
    compare(result, moved[0], moved[1], by)


def test_a_level_that_moves_with_the_data() -> None:
    case, by, tolerance = bent(5), 1e-3, 0.3
    first = minimum(case.problem(), weighted(np.array([1.0, 0.0])), np.zeros(3))

    def cut(problem: Squares) -> Solution:
        best = minimum(problem, weighted(np.array([1.0, 0.0])), first.theta)
        value = (1 + tolerance) * best.J[0]
        programme = below(np.array([0.0, 1.0]), np.array([1.0, 0.0]), value)
        return minimum(problem, programme, best.theta + 0.01)

    problem = case.problem()
    computed = cut(problem)
    noise, point = case.noise(computed.theta), point_of(problem, computed)
    dv = (1 + tolerance) * case.noise(first.theta).J[:, 0]
    result = scatter(problem, point, computed.weights, level(point, 0, dv, noise), noise)
    moved = [[cut(case.moved(m, s * by).problem()) for m in range(10)] for s in (1, -1)]
    compare(result, moved[0], moved[1], by)


@pytest.mark.parametrize(
    ("n", "beta", "active", "ranges"),
    [
        (2, [0.3, 0.7], [1, 1], False),
        (3, [0.3, 0.5, 0.2], [1, 1, 1], False),
        pytest.param(3, [0.6, 0.5, -0.1], [1, 1, 1], False, marks=pytest.mark.slow(2)),
        (3, [0.9, -0.4, 0.5], [1, 0, 1], False),
        pytest.param(3, [0.5, 0.2, 0.3], [1, 1, 1], True, marks=pytest.mark.slow(2)),
        (3, [-0.5, 0.6, 0.9], [1, 1, 0], True),
    ],
)
def test_points_of_the_front_follow_their_edges(
    n: int, beta: list[float], active: list[int], ranges: bool
) -> None:
    """Within the simplex and beyond it, with all bounds active and not; by edges or by ranges."""
    case, by = bent(16, n=n, bend=0.05), 1e-3
    place, on = np.array(beta), np.array(active, dtype=bool)

    worst: list[Solution] = []

    def edges_of(problem: Squares) -> list[Solution]:
        return [minimum(problem, weighted(w), np.zeros(3)) for w in np.eye(n)]

    def solved(problem: Squares) -> tuple[list[Solution], Solution]:
        edges = edges_of(problem)
        target = payoff(edges, np.ones(n), worst)
        assert target is not None
        point = LatticePoint(place, (), target)
        result = point.solve(problem, edges[0])
        assert result.converged
        assert (active_bounds(result.weights * target.unit) == on).all()
        return edges, minimum(problem, point.programme, result.theta)

    problem = case.problem()
    if ranges:
        worst = [edges_of(problem)[k] for k in (2, 2, 1)]
    edges, computed = solved(problem)
    columns = []
    for i, edge in enumerate(edges):
        noise, point = case.noise(edge.theta), point_of(problem, edge)
        columns.append(scatter(problem, point, np.eye(n)[i], given_weights(noise), noise).J)
    E, dE = np.array([edge.J for edge in edges]).T, np.stack(columns, axis=2)
    noise, point = case.noise(computed.theta), point_of(problem, computed)
    top = E[range(3), [2, 2, 1]] if ranges else None
    w, conditions = boundary(point, computed.weights, E, dE, place, noise, top=top)
    result = scatter(problem, point, w, conditions, noise)
    ahead, behind = (
        [solved(case.moved(m, s * by).problem())[1] for m in range(0, 5 * n, 2)] for s in (1, -1)
    )
    compare(result, ahead, behind, by, 2)


def test_a_parameter_pressed_against_its_bound_does_not_scatter() -> None:
    case = bent(3, bend=0.0)
    inside = minimum(case.problem(), weighted(np.ones(2)), np.zeros(3)).theta
    upper = np.array([inside[0] - 0.2, 5.0, 5.0])
    problem = replace(case.problem(), upper=upper, start=np.minimum(0, upper - 0.1))
    computed = minimum(problem, weighted(np.ones(2)), problem.start)
    point, noise = point_of(problem, computed), case.noise(computed.theta)
    result = scatter(problem, point, np.ones(2), given_weights(noise), noise)
    A = case.A.reshape(-1, 3)[:, 1:]
    gain = np.linalg.pinv(A)
    expected = gain @ np.diag(case.std.ravel() ** 2) @ gain.T
    assert result.covariance[1:, 1:] == pytest.approx(expected, rel=1e-6)
    assert result.theta.any(axis=0).tolist() == [False, True, True]


def test_what_no_data_determine_is_named_and_left_out() -> None:
    case = bent(3, bend=0.0)
    A = case.A.copy()
    A[..., 1] = 2 * A[..., 0]  # only theta_0 + 2 theta_1 matters
    case = replace(case, A=A)
    problem = case.problem()
    computed = minimum(problem, weighted(np.ones(2)), np.zeros(3))
    point, noise = point_of(problem, computed), case.noise(computed.theta)
    result = scatter(problem, point, np.ones(2), given_weights(noise), noise)
    (direction,) = result.free.T
    assert abs(direction / np.linalg.norm(direction) @ [2, -1, 0]) == pytest.approx(np.sqrt(5))
    reduced = np.column_stack([A.reshape(-1, 3)[:, 0], A.reshape(-1, 3)[:, 2]])
    gain = np.linalg.pinv(reduced)
    expected = gain @ np.diag(case.std.ravel() ** 2) @ gain.T
    combined = np.array([[1.0, 2.0, 0.0], [0.0, 0.0, 1.0]])
    assert combined @ result.covariance @ combined.T == pytest.approx(expected, rel=1e-6)


def test_points_between_edges_have_scatter_where_their_weights_are_known() -> None:
    case = bent(4)
    problem = case.problem()
    edges = [minimum(problem, weighted(w), np.zeros(3)) for w in np.eye(2) + 1e-4]
    ends = [SolvedPoint(f"edge-{i}", edges[i], Role("edge", objective=i)) for i in range(2)]
    minima = [Edge(edge, [edge]) for edge in edges]
    front = Front("nbi", [], minima, [], None, (False, False), None, [])
    for weights, labels in (([0.0, 0.0], {"edge-0", "edge-1"}), ([0.5, 0.5], None)):
        model = minimum(problem, weighted(np.array([0.5, 0.5])), np.zeros(3))
        between = replace(model, weights=np.array(weights), beta=np.array([0.5, 0.5]))
        role = Role("boundary", ("edge-0", "edge-1"))
        points = [*ends, SolvedPoint("nbi-1", between, role)]
        known = {
            each.label: Local(point_of(problem, each.solution), case.noise(each.solution.theta), {})
            for each in points
        }
        points.append(SolvedPoint("nbi-2", edges[0], Role("end", ("edge-0",))))
        found = front_scatter(problem, front, points, known, np.ones(2), np.ones(2))
        assert set(found) == {*(labels or known), "nbi-2"}
        assert found["nbi-2"] is found["edge-0"], "the same point has the same scatter and doubts"


def test_points_of_all_kinds_have_the_conditions_of_what_they_solve() -> None:
    case, ones, a = bent(4), np.ones(2), np.array([5.0, 4.0])
    problem, w = case.problem(), np.array([0.4, 0.9])
    edges = [minimum(problem, weighted(edge_weights(i, ones)), np.zeros(3)) for i in range(2)]
    best = minimum(problem, LogSum(a), np.zeros(3))
    value = 1.3 * edges[1].J[1]
    on = minimum(problem, below(np.array([1.0, 0]), np.array([0, 1.0]), value), edges[1].theta)
    solved = {
        "s": (edges[1], Role("edge", objective=1)),
        "f": (edges[0], Role("edge", objective=0)),
        "level": (on, Role("level", objective=1, tolerance=0.3)),
        "sum": (replace(minimum(problem, weighted(w), np.zeros(3)), weights=w), Role("weights")),
        "optimal": (best, Role("optimal")),
    }
    points = [SolvedPoint(name, *x) for name, x in solved.items()]
    known = {
        x.label: Local(point_of(problem, x.solution), case.noise(x.solution.theta), {})
        for x in points
    }
    minima = [Edge(edge, [edge]) for edge in edges]
    front = Front("nbi", [], minima, [best], None, (False, False), None, [])
    found = front_scatter(problem, front, points, known, a, ones)
    dv = 1.3 * found["s"].J[:, 1]
    for name, each in known.items():
        point, noise = each.evaluation, each.noise
        weights, conditions = {
            "s": (edge_weights(1, ones), given_weights(noise)),
            "f": (edge_weights(0, ones), given_weights(noise)),
            "level": (on.weights, level(point, 1, dv, noise)),
            "sum": (w, given_weights(noise)),
            "optimal": (a / point.J, optimal_weights(point, a, noise)),
        }[name]
        expected = scatter(problem, point, weights, conditions, noise)
        np.testing.assert_allclose(found[name].theta, expected.theta, rtol=1e-9, atol=1e-12)
        np.testing.assert_allclose(found[name].J, expected.J, rtol=1e-9, atol=1e-12)
    assert np.linalg.norm(found["level"].J[:, 1]) == pytest.approx(np.linalg.norm(dv), rel=1e-3)
    assert set(front_scatter(problem, front, points[2:], known, a, ones)) == {"sum", "optimal"}
