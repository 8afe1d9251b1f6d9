"""Points of the border of a front of three objectives."""

from __future__ import annotations

import numpy as np
import pytest
from problems import Derivatives, Known, box

from modefront._typing import Floats
from modefront.solvers.attainment import SHARE
from modefront.solvers.border import without_slack
from modefront.solvers.payoff import Payoff
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


def test_points_whose_bounds_all_hold_stay() -> None:
    problem = box(apart, [-1, -1], [2, 1], 3)
    point = solution(problem, [0.5, 0.3], [0.4, 0.3, 0.3])
    (result,) = without_slack(problem, TARGET, [point])
    assert result is point
