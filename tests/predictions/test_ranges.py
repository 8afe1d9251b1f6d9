"""Ranges over equivalent and nearly optimal models against closed forms."""

from typing import Any

import numpy as np
import pytest

import modefront as mf
from modefront._typing import Floats
from modefront.optim.problem import Evaluation, Problem, Residual
from modefront.predictions.ranges import Sampled, extreme

LOWER, UPPER = np.array([0.5, 0.5, 0.5]), np.array([2.0, 2.0, 2.0])


class Ratios:
    """Two groups of residuals that know the ratios of three parameters only."""

    objectives = ("a", "b")
    lower, upper, start = LOWER, UPPER, np.ones(3)

    def __init__(self, known: int = 2) -> None:
        self.known = known

    def evaluate(
        self, theta: Floats, *, derivatives: bool = True, second: bool = False
    ) -> Evaluation:
        x, y, z = theta
        r = [np.array([x / y - 1.2, x / y - 0.8])]
        dr = [np.array([[1 / y, -x / y**2, 0.0]] * 2)]
        r.append(np.array([y / z - 1.0]) if self.known > 1 else np.array([x / y - 1.1]))
        dr.append(np.array([[0.0, 1 / z, -y / z**2]]) if self.known > 1 else dr[0][:1])
        parts = [Residual(a, b) for a, b in zip(r, dr, strict=True)]
        J = np.array([x.r @ x.r for x in parts])
        dJ = np.array([2 * x.r @ x.dr for x in parts])
        H = np.array([2 * x.dr.T @ x.dr for x in parts])
        return Evaluation(theta, J, dJ, H, residuals=parts)


def along(problem: Problem, q: Any, thetas: Floats, slack: float = 0.0) -> tuple[float, float]:
    """Return the range of a function of the parameters."""
    J = np.array([problem.evaluate(theta).J for theta in thetas])
    front = Sampled(thetas, J, is_open=slack > 0 or isinstance(problem, Ratios), slack=slack)
    values = np.array([q(theta) for theta in thetas])
    least, greatest = (extreme(problem, front, values, q, s, 1e-4) for s in (1.0, -1.0))
    return least, greatest


def test_a_range_holds_what_known_equivalent_models_predict() -> None:
    """Of q = -(t - 0.6)^2 (t - 1.9)^2 + t / 100, x = y = z = t, two values are local maxima."""

    def q(theta: Floats) -> float:
        t = float(theta.mean())
        return -((t - 0.6) ** 2) * (t - 1.9) ** 2 + 0.01 * t

    problem, near = Ratios(), np.full((1, 3), 0.65)
    far = np.array([[1.8, 1.8, 1.8], [1.9, 1.2, 1.9]])  # the second one is not equivalent
    J, of_far = (np.array([problem.evaluate(x).J for x in models]) for models in (near, far))
    value = np.array([q(near[0])])
    front = Sampled(near, J, is_open=True)
    assert extreme(problem, front, value, q, -1.0, 1e-4) < 0.01
    known = Sampled(near, J, is_open=True, others=(far, of_far))
    t = np.linspace(1.8, 2.0, 100_001)
    best = (-((t - 0.6) ** 2) * (t - 1.9) ** 2 + 0.01 * t).max()
    assert extreme(problem, known, value, q, -1.0, 1e-4) == pytest.approx(best, rel=1e-4)


def test_models_scaled_together_reach_from_bound_to_bound() -> None:
    """x = y = z = t from 0.5 to 2: of q = t^2 + 1/t the least is within, at t = 2^(-1/3)."""
    calls = [0]

    def q(theta: Floats) -> float:
        calls[0] += 1
        return float(theta[0] * theta[1] + 1 / theta[2])

    thetas = np.array([[1.0, 1.0, 1.0], [1.1, 1.1, 1.1]])
    least, greatest = along(Ratios(), q, thetas)
    t = 2 ** (-1 / 3)
    assert least == pytest.approx(t**2 + 1 / t, rel=1e-6)
    assert greatest == pytest.approx(4.5, rel=1e-6)
    assert calls[0] < 120


def test_two_combinations_that_are_open() -> None:
    """x = y, and z is anything: x z + z from 0.5 0.5 + 0.5 to 2 2 + 2."""
    least, greatest = along(Ratios(1), lambda x: float(x[0] * x[2] + x[2]), np.ones((1, 3)))
    assert least == pytest.approx(0.75, rel=1e-6)
    assert greatest == pytest.approx(6.0, rel=1e-6)


class Series:
    """The exactly known frequency of two springs in series: 0.4 / x + 0.7 / y = 1."""

    objectives = ("a",)
    lower, upper, start = np.full(2, 0.6), np.full(2, 1.6), np.ones(2)

    def evaluate(
        self, theta: Floats, *, derivatives: bool = True, second: bool = False
    ) -> Evaluation:
        parts = np.array([0.4, 0.7]) / theta
        f = parts.sum() ** -0.5
        r, dr = np.array([f - 1.0]), 0.5 * f**3 * (parts / theta)[None]
        J, H = np.array([r @ r]), 2 * (dr.T @ dr)[None]
        return Evaluation(theta, J, 2 * r[None] @ dr, H, residuals=(Residual(r, dr),))


def test_ends_of_curved_sets_at_bounds_are_found() -> None:
    """From any model x / y reaches from y = 1.6 to x = 1.6."""
    for x in (0.9, 1.1, 1.3, 1.5):
        theta, ends = np.array([[x, 0.7 / (1 - 0.4 / x)]]), (0.4 / 0.9, 1.2 / 0.7)
        front = Sampled(theta, Series().evaluate(theta[0]).J[None], is_open=True)
        for sign, end in zip((1.0, -1.0), ends, strict=True):
            found = extreme(Series(), front, np.ones(1), lambda x: x[0] / x[1], sign, 1e-4)
            assert found == pytest.approx(end, rel=1e-3)


class Bent:
    """Residuals of x = theta_1 theta_2, of which one is as at x = 1 again at x = 3."""

    objectives = ("a",)
    lower, upper, start = np.array([0.1, 0.1]), np.array([10.0, 10.0]), np.ones(2)

    def evaluate(
        self, theta: Floats, *, derivatives: bool = True, second: bool = False
    ) -> Evaluation:
        x = theta[0] * theta[1]
        r = np.array([(x - 1) * (3 - x) + 1.0, (x - 1) ** 2])
        dr = np.outer([4 - 2 * x, 2 * (x - 1)], theta[::-1])
        H, parts = 2 * dr.T @ dr, [Residual(r, dr)]
        return Evaluation(theta, np.array([r @ r]), 2 * (r @ dr)[None], H[None], residuals=parts)


def test_models_that_a_weak_penalty_leads_away_from_are_found_again() -> None:
    """Of q = x^6 / theta_1 the greatest is at theta_1 = 0.1, x = 1; far more, not as good, at 3."""
    problem = Bent()
    start = np.array([[1.0, 1.0]])
    front = Sampled(start, problem.evaluate(start[0]).J[None], is_open=True)

    def q(theta: Floats) -> float:
        return float((theta[0] * theta[1]) ** 6 / theta[0])

    assert extreme(problem, front, np.ones(1), q, -1.0, 1e-4) == pytest.approx(10.0, rel=1e-3)


class Known:
    """Two groups that know all parameters: the squared distances from two models."""

    objectives = ("a", "b")
    lower, upper, start = LOWER, UPPER, np.ones(3)
    ends = (np.array([0.8, 1.0, 1.0]), np.array([1.6, 1.0, 1.0]))

    def evaluate(
        self, theta: Floats, *, derivatives: bool = True, second: bool = False
    ) -> Evaluation:
        r = [theta - end for end in self.ends]
        J, H = np.array([x @ x for x in r]), 2 * np.array([np.eye(3)] * 2)
        parts = tuple(Residual(x, np.eye(3)) for x in r)
        return Evaluation(theta, J, 2 * np.array(r), H, exact=True, residuals=parts)


def test_between_points_the_front_is_solved_for() -> None:
    """Models from one end to the other are optimal: of (x - 1.3)^2 the least is 0, unseen."""
    thetas, calls = np.array([[0.8, 1.0, 1.0], [1.1, 1.0, 1.0], [1.6, 1.0, 1.0]]), [0]

    def q(theta: Floats) -> float:
        calls[0] += 1
        return float((theta[0] - 1.3) ** 2 + theta[1])

    assert along(Known(), q, thetas) == pytest.approx((1.0, 1.25), abs=2e-3)
    assert calls[0] < 40


class Branches:
    """Sums of wells: a short branch up to x = 0.3, another one at 0.5, and one that ends at 3."""

    objectives = ("a", "b")
    lower, upper, start = np.zeros(1), np.full(1, 3.0), np.zeros(1)
    wells = (((0.0156, 0.5, 0.08),), ((0.3, 0.3, 0.15), (0.85, 0.52, 0.08), (0.98, 3.0, 0.5)))

    def evaluate(
        self, theta: Floats, *, derivatives: bool = True, second: bool = False
    ) -> Evaluation:
        (x,) = theta
        J = np.array([[x * x / 9, 2 * x / 9, 2 / 9], [1.0, 0.0, 0.0]])  # and their derivatives
        for row, wells in zip(J, self.wells, strict=True):
            for depth, at, w in wells:
                u = (x - at) / w
                row -= depth * np.exp(-u * u) * np.array([1, -2 * u / w, (4 * u * u - 2) / w**2])
        return Evaluation(theta, J[:, 0], J[:, 1:2], J[:, 2:, None], exact=True)


def test_a_branch_of_which_one_model_is_known_is_followed_to_its_end() -> None:
    """No model is nearer than its ends to the middle of two branches; the first ends at 0.3."""
    thetas = np.array([[0.0], [0.5], [3.0]])
    least, greatest = along(Branches(), lambda x: float(abs(x[0] - 0.3)), thetas)
    assert least == pytest.approx(0.0, abs=3e-3)
    assert greatest == pytest.approx(2.7)


def test_a_range_is_the_same_for_any_points_of_the_front() -> None:
    def q(theta: Floats) -> float:
        return float(np.sin(4 * theta[0]))

    ranges = [
        along(Known(), q, np.array([[x, 1.0, 1.0] for x in np.linspace(0.8, 1.6, count)]))
        for count in (3, 4, 7, 12)
    ]
    assert np.ptp(ranges, axis=0).max() < 2e-3


def test_nearly_optimal_models_within_a_slack_count() -> None:
    """A slack of 3 doubles the distances from both ends, which are 0.3 and 0.5."""
    theta = np.array([[1.1, 1.0, 1.0]])
    least, greatest = along(Known(), lambda x: float(x[1]), theta, 3.0)
    # Within 0.6 of the first end and 1.0 of the second: at x = 0.8 the nearer sphere is widest.
    assert greatest == pytest.approx(1.0 + 0.6, rel=2e-3)
    assert least == pytest.approx(0.5, rel=2e-3)


def test_where_a_model_has_no_value_it_is_left_out() -> None:
    def q(theta: Floats) -> float:
        return float(theta[0]) if theta[0] < 1.5 else np.nan

    least, greatest = along(Ratios(), q, np.array([[1.0, 1.0, 1.0], [1.9, 1.9, 1.9]]))
    assert least == pytest.approx(0.5, rel=1e-6)
    assert greatest == pytest.approx(1.5, rel=1e-2)


@pytest.mark.slow(4)
@pytest.mark.usefixtures("short_chains")
def test_results_have_the_range_over_stiffness_and_mass_scaled_together() -> None:
    """The receptance falls as 1 / t when all stiffnesses and masses are scaled by t."""
    names = ("k", "m")
    model = mf.chain(
        names,
        [20.0, 20.0],
        [8e4, 8e4],
        stiffness_parameters=["k", "k"],
        mass_parameters=["m", "m"],
    )
    data = mf.modal_data(np.array([6.4, 16.0]), np.array([[0.6, 1.0], [1.0, -0.7]]), model.sensors)
    groups = [mf.Group("first", frequency=[1]), mf.Group("second", frequency=[2])]
    parameters = [mf.Parameter(name, nominal=1.0, bounds=(0.5, 2.0)) for name in names]
    problem = mf.updating_problem(model, data, groups, parameters=parameters)
    peak = mf.PeakResponse("peak", response=[model.sensors[0]], force="floor2", damping=0.02)
    results = mf.solve(problem, points=3, predictions=[peak], search=mf.Search(doubt=0.5))
    optimal = results["pareto"].values
    theta, value = results["theta"].values[optimal], results["frf_peak"].values[optimal, 0]
    least, greatest, spread = results["frf_peak_range"].values[:, 0]
    assert least == pytest.approx((value / (2.0 / theta.max(axis=1))).min(), rel=1e-4)
    assert greatest == pytest.approx((value / (0.5 / theta.min(axis=1))).max(), rel=1e-4)
    assert spread > 3


def test_of_two_extremes_along_equivalent_models_the_farther_one_is_found() -> None:
    """x = y = z = t: of q = (t - 1.1)^2 the greatest value is at t = 2, not at 0.5 nearby."""
    least, greatest = along(Ratios(), lambda x: float((x[0] - 1.1) ** 2), np.full((1, 3), 0.9))
    assert least == pytest.approx(0.0, abs=1e-8)
    assert greatest == pytest.approx(0.9**2, rel=1e-6)
