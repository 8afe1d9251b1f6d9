"""Lexicographic minima: least in one objective, then least in the others."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from problems import Derivatives, Known, box, circles, many_minima, valley

import modefront as mf
from modefront._typing import Floats
from modefront.optim.lexicographic import TIE, Lexicographic
from modefront.optim.problem import Evaluation, Residual
from modefront.optim.sqp import begin

ONES = np.ones(2)


@pytest.mark.parametrize("start", [[2.5, 2.5], [0.3, 2.9], [2.9, 0.2], [0.2, 0.2]])
def test_of_a_curve_of_minima_the_point_is_found_that_is_best_in_the_other(
    start: list[float],
) -> None:
    problem = box(valley, [0.1, 0.1], [3.0, 3.0])
    best = Lexicographic(1, ONES).solve(problem, begin(problem.evaluate(np.array(start))))
    assert best.converged
    assert best.theta == pytest.approx([1, 1], abs=1e-6)
    assert best.J[1] < 1e-12


@pytest.mark.parametrize("stiffness", [1.0, 1e-2, 1e-4])
def test_the_path_goes_on_until_a_weak_objective_is_least(stiffness: float) -> None:
    """Of x y = 1 the point next to (3, 0): x**4 - 3 x**3 = 1. The weaker J2, the farther the path.

    The model at epsilon has J2 = epsilon**2 mu**2 / (4 stiffness), with the multiplier mu.
    """

    def curve(theta: Floats) -> Derivatives:
        x, y = theta
        r = x * y - 1
        J = np.array([(x - 3) ** 2 + y**2, stiffness * r**2])
        dJ = np.array([[2 * (x - 3), 2 * y], [2 * stiffness * r * y, 2 * stiffness * r * x]])
        H = stiffness * np.array([[2 * y**2, 4 * x * y - 2], [4 * x * y - 2, 2 * x**2]])
        return J, dJ, np.array([2 * np.eye(2), H])

    problem = box(curve, [0.1, 0.1], [5.0, 5.0])
    x = max(np.roots([1, -3, 0, 0, -1]).real)
    for start in ([0.5, 4.0], [4.0, 4.0]):
        best = Lexicographic(1, ONES).solve(problem, begin(problem.evaluate(np.array(start))))
        assert best.J[1] < 1e-10
        assert best.theta == pytest.approx([x, 1 / x], abs=1e-4)


def wells(theta: Floats) -> Derivatives:
    """Return J1 and J2, which has two wells in t on the line r = 1; off it the second is none."""
    r, t = theta
    well = np.poly1d([16, -32, 16, -1.5, 0])
    J = np.array([(r - 1) ** 2, 20 * (2 - r) ** 2 + well(t) + 12 * (r - 1) * t])
    dJ = np.array([[2 * (r - 1), 0], [40 * (r - 2) + 12 * t, well.deriv()(t) + 12 * (r - 1)]])
    return J, dJ, np.array([[[2.0, 0], [0, 0]], [[40.0, 12], [12, well.deriv(2)(t)]]])


def test_a_path_that_leads_to_worse_others_than_the_minimum_below_a_start_is_not_taken() -> None:
    problem = box(wells, [0.0, -0.5], [2.0, 1.5])
    best = Lexicographic(0, ONES).solve(problem, begin(problem.evaluate(np.array([1.2, 0.8]))))
    assert best.theta == pytest.approx([1, 1.04155], abs=1e-4)


def test_a_path_ends_where_its_others_exceed_those_of_a_known_minimum() -> None:
    problem, order = box(wells, [0.0, -0.5], [2.0, 1.5]), Lexicographic(0, ONES)
    starts = [begin(problem.evaluate(np.array(x))) for x in ([1.2, 0.8], [1.2, 0.0])]
    second, first = (order.solve(problem, start) for start in starts)
    assert second.J[1] < first.J[1] - 1
    left = order.solve(problem, starts[1], second)
    assert left.converged
    assert order.ties(left.J, second.J)
    assert left.evaluations < first.evaluations
    assert order.solve(problem, starts[0], first).J == pytest.approx(second.J), "that is better"


def test_a_minimum_above_the_least_known_one_is_not_followed_to_its_end() -> None:
    def raised(theta: Floats) -> Derivatives:
        J, dJ, H = valley(theta)
        return J + np.array([0.0, 1.0]), dJ, H

    problem = box(raised, [0.1, 0.1], [3.0, 3.0])
    start = begin(problem.evaluate(np.array([0.3, 2.9])))
    whole = Lexicographic(1, ONES).solve(problem, start)
    better = begin(Evaluation(whole.theta, np.array([2.0, 0.5])))
    short = Lexicographic(1, ONES).solve(problem, start, better)
    assert short.evaluations < whole.evaluations / 2
    assert short.J[0] > whole.J[0]


def test_a_path_is_followed_once() -> None:
    problem, order = box(valley, [0.1, 0.1], [3.0, 3.0]), Lexicographic(1, ONES)
    starts = [begin(problem.evaluate(np.array(x))) for x in ([2.5, 2.5], [0.3, 2.9])]
    first, anew = (order.solve(problem, start) for start in starts)
    again = order.solve(problem, starts[1], first)
    assert again.evaluation is first.evaluation
    assert again.evaluations < 0.7 * anew.evaluations
    assert anew.J == pytest.approx(first.J, abs=1e-6)
    assert first.path is not None
    epsilon, minimised, others = first.path.T
    assert epsilon == pytest.approx(0.1 ** np.arange(1, len(epsilon) + 1))
    assert (np.diff(minimised) < 0).all()
    assert minimised == pytest.approx(others * epsilon, rel=0.2), "J2 is the square of its slope"


def test_a_path_of_another_well_is_none_that_leads_to_its_end() -> None:
    problem, order = box(many_minima, [-4, -4], [4, 4]), Lexicographic(0, ONES)
    first, other = (
        order.solve(problem, begin(problem.evaluate(np.array(x))))
        for x in ([1.1, -1.8], [1.1, 1.8])
    )
    for known, start in ((first, [1.1, 1.8]), (other, [1.1, -1.8])):
        again = order.solve(problem, begin(problem.evaluate(np.array(start))), known)
        assert again.theta == pytest.approx([1, np.copysign(2, start[1])], abs=1e-6)


def test_units_of_objectives_do_not_matter() -> None:
    def scaled(theta: Floats) -> Derivatives:
        J, dJ, H = valley(theta)
        unit = np.array([2.0**20, 2.0**-14])
        return unit * J, unit[:, None] * dJ, unit[:, None, None] * H

    start = np.array([0.3, 2.9])
    one, other = (
        Lexicographic(1, np.array(sizes)).solve(problem, begin(problem.evaluate(start)))
        for problem, sizes in (
            (box(valley, [0.1, 0.1], [3.0, 3.0]), [0.5, 2.0]),
            (box(scaled, [0.1, 0.1], [3.0, 3.0]), [2.0**19, 2.0**-13]),
        )
    )
    assert one.theta == pytest.approx(other.theta, abs=1e-7)
    assert one.evaluations == other.evaluations


@given(st.integers(0, 2**31), st.floats(1e-3, 1e3))
def test_of_a_line_of_minima_the_sizes_decide(seed: int, size: float) -> None:
    """J1 = x**2 leaves y open; J2 / c2 + J3 / c3 is least at a mean of y and 1."""

    def line(theta: Floats) -> Derivatives:
        x, y = theta
        J = np.array([x**2, (x - y) ** 2, (y - 1) ** 2])
        dJ = np.array([[2 * x, 0.0], [2 * (x - y), -2 * (x - y)], [0.0, 2 * (y - 1)]])
        H = np.array([[[2, 0], [0, 0]], [[2, -2], [-2, 2]], [[0, 0], [0, 2]]], dtype=float)
        return J, dJ, H

    problem = box(line, [-2.0, -2.0], [2.0, 2.0], 3)
    theta = np.random.default_rng(seed).uniform(-2, 2, 2)
    order = Lexicographic(0, np.array([1.0, size, 1.0]))
    best = order.solve(problem, begin(problem.evaluate(theta)))
    assert best.converged
    assert best.theta == pytest.approx([0.0, size / (1 + size)], abs=1e-5)


def test_the_local_minimum_of_each_well_is_found_from_within_it() -> None:
    problem = box(many_minima, [-4, -4], [4, 4])
    for x, y in [(1, 2), (1, -2), (-1, 2), (-1, -2)]:
        start = begin(problem.evaluate(np.array([1.1 * x, 0.9 * y])))
        best = Lexicographic(0, ONES).solve(problem, start)
        assert best.theta == pytest.approx([x, y], abs=1e-6)


def test_ties_are_values_within_rounding_of_the_least() -> None:
    order = Lexicographic(0, np.array([10.0, 1.0]))
    J = np.array([2.0, 5.0])
    assert order.ties(J, np.array([2.0 + 1e-6, 9.0]))
    assert not order.ties(J, np.array([2.0 + 1e-5, 5.0]))
    assert order.ties(np.array([0.0, 5.0]), np.array([9e-10, 5.0])), "both are fitted exactly"
    assert order.others.tolist() == [0.0, 1.0]
    assert order.programme(0.5).w.tolist() == [0.1, 0.5]


def test_a_minimum_that_residuals_determine_is_not_open() -> None:
    problem = box(circles, [-2.0, -2.0], [2.0, 2.0])
    order, at = Lexicographic(0, ONES), problem.evaluate(np.zeros(2))
    assert order.is_open(problem, at), "nothing is known of residuals"

    def of(dr: list[list[float]]) -> Evaluation:
        residual = Residual(np.zeros(len(dr)), np.array(dr))
        return replace(at, residuals=[residual, residual])

    assert order.is_open(problem, of([[1.0, 0.0]]))
    assert order.is_open(problem, of([[1.0, 2.0], [2.0, 4.0]]))
    assert not order.is_open(problem, of([[1.0, 2.0], [2.0, 1.0]]))


def test_one_objective_alone_has_its_minimum() -> None:
    def bowl(theta: Floats) -> Derivatives:
        J, dJ, H = circles(theta)
        return J[:1], dJ[:1], H[:1]

    problem: Known = box(bowl, [-2.0, -2.0], [2.0, 2.0], 1)
    start = begin(problem.evaluate(np.array([1.0, -1.0])))
    best = Lexicographic(0, np.ones(1)).solve(problem, start)
    assert best.theta == pytest.approx([0.0, 0.0], abs=1e-7)


def test_an_edge_of_shapes_that_a_scale_leaves_open_does_not_depend_on_sizes() -> None:
    """Where shares of the others are small, rounding moves the limits of the path."""
    names, rng = ["a", "a", "b", "b", "c", "c"], np.random.default_rng(0)
    model = mf.chain(["a", "b", "c"], [10.0] * 6, [1e5] * 6, stiffness_parameters=names)
    true = model.modes(np.array([0.8, 1.1, 1.3]), 5)
    f = true.frequency * (1 + 0.002 * rng.standard_normal(5))
    data = mf.modal_data(f, true.phi.T + 0.002 * rng.standard_normal((5, 6)), model.sensors)
    groups = [mf.Group("f", frequency="all"), mf.Group("s", shape="all")]
    given = [mf.Parameter(name, 1.0, (0.5, 2.0)) for name in model.parameters]
    problem = mf.updating_problem(model, data, groups, parameters=given)
    start = begin(problem.evaluate(problem.start))
    ends = [Lexicographic(1, np.array(x)).solve(problem, start) for x in ([0.005, 2], [1e-5, 0.01])]
    assert ends[0].J[0] == pytest.approx(ends[1].J[0], rel=TIE)
