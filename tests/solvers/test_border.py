"""Points of the border of a front of three objectives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from problems import Derivatives, Known, box

from modefront._typing import Floats
from modefront.solvers.attainment import SHARE
from modefront.solvers.border import without_slack
from modefront.solvers.payoff import Payoff
from modefront.solvers.problem import Evaluation, ObjectiveDerivatives, Residual
from modefront.solvers.sqp import Solution, Status, begin


def apart(theta: Floats) -> Derivatives:
    """Two bowls in x and one in y, which alone depends on y: on the front, y vanishes."""
    x, y = theta
    J = np.array([x**2, (x - 1) ** 2, y**2])
    dJ = np.array([[2 * x, 0], [2 * x - 2, 0], [0, 2 * y]])
    H = np.zeros((3, 2, 2))
    H[0, 0, 0] = H[1, 0, 0] = H[2, 1, 1] = 2
    return J, dJ, H


def solution(problem: Known, theta: list[float], shares: list[float]) -> Solution:
    start = begin(problem.evaluate(np.array(theta)))
    beta = TARGET.place(start.J)
    weights = np.array(shares) + SHARE
    return Solution(start.evaluation, start.learned, weights, 0.0, Status.CONVERGED, 1, beta)


TARGET = Payoff(np.zeros(3), np.ones(3), np.eye(3))


def test_objectives_that_no_bound_holds_are_made_small() -> None:
    problem = box(apart, [-1, -1], [2, 1], 3)
    point = solution(problem, [0.5, 0.3], [0.5, 0.5, 0.0])
    (result,) = without_slack(problem, TARGET, [point])
    assert result.J == pytest.approx([0.25, 0.25, 0.0], abs=1e-9)
    assert result.evaluations > point.evaluations
    assert result.converged
    assert result.beta is not None
    assert point.beta is not None
    assert (result.beta == point.beta).all()


@dataclass(frozen=True)
class Sums(Known):
    """A problem whose objectives are sums of squares, from a function of its residuals."""

    def evaluate(self, theta: Floats, *, derivatives: bool = True) -> Evaluation:
        x, y, w = theta
        residuals = (
            Residual(np.array([x, y]), np.eye(2, 3)),
            Residual(np.array([x - 1.0]), np.eye(1, 3)),
            Residual(np.array([w]), np.eye(1, 3, 2)),
        )
        J = np.array([part.r @ part.r for part in residuals])
        dJ = np.array([2 * part.r @ part.dr for part in residuals])
        H = np.array([2 * part.dr.T @ part.dr for part in residuals])
        return Evaluation(theta, J, ObjectiveDerivatives(dJ, H), residuals=residuals)


@pytest.mark.parametrize("angle", [0.5, 1.5, 3.0, -2.0])
def test_residuals_around_an_exact_fit_turn_to_where_the_others_are_least(angle: float) -> None:
    """On the front y = 0, so that sqrt(J1) + sqrt(J2) = 1, wherever on a circle one begins."""
    e = 2e-3
    lower, upper = np.array([-1.0, -1.0, 0.5]), np.array([2.0, 2.0, 2.0])
    problem = Sums(apart, lower, upper, lower, ("J1", "J2", "J3"))
    start = [e * np.cos(angle), e * np.sin(angle), 0.5]
    point = solution(problem, start, [0.0, 0.5, 0.5])
    (result,) = without_slack(problem, TARGET, [point])
    assert np.sqrt(result.J[:2]).sum() == pytest.approx(1.0, abs=1e-3 * e)
    assert (result.J <= point.J).all()


def test_points_whose_bounds_all_hold_stay() -> None:
    problem = box(apart, [-1, -1], [2, 1], 3)
    point = solution(problem, [0.5, 0.3], [0.4, 0.3, 0.3])
    (result,) = without_slack(problem, TARGET, [point])
    assert result is point
