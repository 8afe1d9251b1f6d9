"""Fronts of which a part is flat, cut where a closed form says."""

import numpy as np
import pytest
from problems import Derivatives, Known, box, circles

from modefront._typing import Floats
from modefront.analysis.front import _solved_points, flat_points, identifiable_part
from modefront.front.front import Edge, Front
from modefront.front.options import Pareto
from modefront.front.point import Kind, Point, of_kind
from modefront.front.simplex import lattice, payoff
from modefront.front.subproblems import LatticePoint, Least
from modefront.optim.sqp import Solution, begin


def flat(theta: Floats) -> Derivatives:
    """J2 = 1 + exp(-4 x) + y**2 hardly falls any more where J1 = x**2 goes on to rise."""
    x, y = theta
    e = np.exp(-4 * x)
    J, dJ = np.array([x**2, 1 + e + y**2]), np.array([[2 * x, 0], [-4 * e, 2 * y]])
    return J, dJ, np.array([np.diag([2.0, 0]), np.diag([16 * e, 2.0])])


def whole_front(problem: Known, sizes: Floats, divisions: int = 19) -> Front:
    """The points of the lattice between the edges, each from the one before, and the edges."""
    solution = begin(problem.evaluate(problem.start))
    names = problem.objectives
    edges = [Least(i, sizes, name).solve(problem, solution) for i, name in enumerate(names)]
    target = payoff(edges, sizes)
    assert target is not None
    along = []
    for row in lattice(len(edges), divisions):
        solution = LatticePoint(row / divisions, tuple(row), target).solve(problem, solution)
        assert solution.converged
        along.append(solution)
    points = [Point(Kind.FRONT, x, "nbi", i) for i, x in enumerate(along, 1)]
    points += [Point(Kind.EDGE, x, name) for name, x in zip(names, edges, strict=True)]
    best = [Edge(x, [x]) for x in edges]
    return Front("nbi", points, best, [], None, (False,) * len(edges), target, [])


def solutions(front: Front, kind: Kind) -> list[Solution]:
    return [point.solution for point in of_kind(front.points, kind)]


def test_a_flat_part_is_found_and_the_rest_covered_by_itself() -> None:
    problem = box(flat, [0, -1], [4, 1])
    front = whole_front(problem, np.array([16.0, 1.0]))
    along = solutions(front, Kind.FRONT)
    part = identifiable_part(problem, front, 0.01, 19)
    least = 1 + np.exp(-16.0)
    J = np.array([point.J for point in along])
    assert part.flat.tolist() == [0, (J[:, 1] <= 1.01 * least).sum() - 1]
    assert part.flat[1] >= 8
    (end,) = of_kind(part.points, Kind.IDENTIFIABLE_EDGE)
    assert end.name == problem.objectives[1]
    # J2 = 1.01 of the least at exp(-4 x) = 0.01 and a little
    cut = -np.log(1.01 * least - 1) / 4
    # The least J2 is known to a share of 1e-6, a tie, which counts here where J2 is flat.
    assert end.solution.theta == pytest.approx([cut, 0], abs=1e-4)
    points = [point.solution for point in of_kind(part.points, Kind.IDENTIFIABLE)]
    chosen = np.array([point.J for point in points])
    assert all(point.converged for point in points)
    assert chosen[:, 0].max() == pytest.approx(cut**2, rel=1e-4)
    assert chosen[:, 1] == pytest.approx(1 + np.exp(-4 * np.sqrt(chosen[:, 0])), abs=1e-6)
    # Even along the front in units of its range: what was one point is twenty.
    scaled = chosen / np.ptp(chosen, axis=0)
    steps = np.linalg.norm(np.diff(scaled, axis=0), axis=1)
    assert steps.max() < 3 * steps.min()


def test_points_of_the_part_solve_bounds_whatever_those_of_the_front_solve() -> None:
    problem = box(flat, [0, -1], [4, 1])
    front = whole_front(problem, np.array([16.0, 1.0]))
    part = identifiable_part(problem, front, 0.01, 19)
    solved = _solved_points(problem, front, part, Pareto(programme="equations"), 0.01)
    roles = {point.label: point.role for point in solved}
    assert roles["nbi-5"].equations
    assert roles["identifiable-5"].kind == "boundary"
    assert not roles["identifiable-5"].equations


def test_a_flat_part_of_which_the_end_is_not_found_is_counted_and_not_cut() -> None:
    problem = box(flat, [0, -1], [4, 1])
    front = whole_front(problem, np.array([16.0, 1.0]))

    def holed(theta: Floats) -> Derivatives:
        """Around the end, at x = 1.15, the model is not defined."""
        J, dJ, H = flat(theta)
        return (J if abs(theta[0] - 1.15) > 0.1 else J * np.inf), dJ, H

    J = np.array([x.J for x in solutions(front, Kind.FRONT)])
    assert front.scale is not None
    beside = flat_points(J, np.array([0.0, 1 + np.exp(-16.0)]), 0.01, front.scale)
    part = identifiable_part(box(holed, [0, -1], [4, 1]), front, 0.01, 19)
    assert beside[1] >= 8
    assert part.flat.tolist() == [0, 0]
    assert part.uncut.tolist() == beside.tolist()
    assert part.target is None
    assert len(part.points) == 0


def test_a_front_that_bends_everywhere_is_left_alone() -> None:
    problem = box(circles, [-2, -2], [2, 2])
    part = identifiable_part(problem, whole_front(problem, np.ones(2)), 0.01, 19)
    assert not part.points
    assert not part.flat.any()
    assert not part.uncut.any()


def test_an_objective_that_is_fitted_exactly_has_no_flat_part() -> None:
    J = np.column_stack([np.zeros(20), np.linspace(1, 2, 20)])
    assert flat_points(J, np.array([0.0, 1.0]), 0.01, np.ones(2)).tolist() == [0, 0]


def test_one_point_beside_the_edge_is_not_flat() -> None:
    J = np.array([[1.0, 3.0], [1.001, 2.0], [1.5, 0.5], [2.0, 0.4]])
    assert flat_points(J, np.array([1.0, 0.4]), 0.01, np.ones(2)).tolist() == [0, 0]


def flat_three(theta: Floats) -> Derivatives:
    """J3 hardly falls any more where J1 goes on to rise; J2 goes with its own parameter.

    J1 = x**2 + y**2 / 4, J2 = x**2 / 4 + (y - 1)**2, J3 = 1 + exp(-4 x) + (y - 1 / 2)**2.
    """
    x, y = theta
    e = np.exp(-4 * x)
    J = np.array([x**2 + y**2 / 4, x**2 / 4 + (y - 1) ** 2, 1 + e + (y - 0.5) ** 2])
    dJ = np.array([[2 * x, y / 2], [x / 2, 2 * (y - 1)], [-4 * e, 2 * (y - 0.5)]])
    H = np.array([np.diag([2, 0.5]), np.diag([0.5, 2]), np.diag([16 * e, 2.0])])
    return J, dJ, H


def test_a_flat_patch_of_three_objectives_is_left_out() -> None:
    problem = box(flat_three, [0, -1], [4, 2], 3)
    front = whole_front(problem, np.ones(3), 9)
    edges, along = (solutions(front, kind) for kind in (Kind.EDGE, Kind.FRONT))
    part = identifiable_part(problem, front, 0.01, 9)
    level = 1.01 * edges[2].J[2]
    J = np.array([point.J for point in along])
    assert part.flat.tolist() == [0, 0, (J[:, 2] <= level).sum() - 1]
    assert part.flat[2] >= 5
    (end,) = of_kind(part.points, Kind.IDENTIFIABLE_EDGE)
    assert end.name == problem.objectives[2]
    # The end is the best of J1 and J2 over their ranges at that level: on the curve of the level.
    y = np.linspace(0.4, 0.6, 200_001)
    room = level - 1 - (y - 0.5) ** 2
    y, x = y[room > 0], -np.log(room[room > 0]) / 4
    assert front.scale is not None
    J1, J2 = x**2 + y**2 / 4, x**2 / 4 + (y - 1) ** 2
    k = np.argmin(J1 / front.scale[0] + J2 / front.scale[1])
    assert end.solution.theta == pytest.approx([x[k], y[k]], abs=1e-5)
    points = [point.solution for point in of_kind(part.points, Kind.IDENTIFIABLE)]
    chosen = np.array([point.J for point in points])
    assert all(point.converged for point in points)
    assert chosen[:, 2].min() >= level * (1 - 1e-6)
    assert len(chosen) > 1.2 * (J[:, 2] > level).sum(), "more of them where the front bends"
    # Beyond the new simplex too: next to the level, but away from its end.
    at_level = chosen[chosen[:, 2] < level + 0.05 * np.ptp(chosen[:, 2])]
    assert np.ptp(at_level[:, 0]) > 0.05 * np.ptp(chosen[:, 0])
