"""Second derivatives of problems that have them in closed form."""

import numpy as np
import pytest
from problems import box, concave, disconnected

from modefront._typing import Floats
from modefront.solvers.curvature import second_order
from modefront.work.costs import Costs


@pytest.mark.parametrize("position", [[0.3, -0.2], [-2.0, 0.1], [2.0, 2.0], [1.9999, -1.9999]])
def test_second_derivatives_within_and_at_the_bounds(position: list[float], costs: Costs) -> None:
    theta = np.array(position)
    for function in (concave, disconnected):
        problem = box(function, [-2, -2], [2, 2])
        before = costs.eigenproblems
        result = second_order(problem, problem.evaluate(theta))
        assert result is not None
        assert costs.eigenproblems - before == 5
        expected = function(theta)[2]
        assert result.H == pytest.approx(expected, rel=1e-3, abs=1e-3 * np.abs(expected).max())


def test_inside_they_are_exact_to_the_square_of_the_step() -> None:
    problem = box(concave, [-2, -2], [2, 2])
    theta = np.array([0.3, -0.2])
    result = second_order(problem, problem.evaluate(theta))
    assert result is not None
    assert result.H == pytest.approx(concave(theta)[2], rel=1e-5)
    assert (result.H == result.H.transpose(0, 2, 1)).all()


def test_there_are_none_where_the_model_ends() -> None:
    def hole(theta: Floats) -> tuple[Floats, Floats, Floats]:
        J, dJ, H = concave(theta)
        return (J if theta[0] < 0.6 else J * np.inf), dJ, H

    problem = box(hole, [-2, -2], [2, 2])
    assert second_order(problem, problem.evaluate(np.array([0.5999, 0.0]))) is None
