"""Problems that wrap others, and their bounds."""

from dataclasses import replace

import numpy as np
import pytest
from problems import box, circles

from modefront._typing import Floats
from modefront.optim.problem import (
    AT_BOUND,
    Evaluation,
    Problem,
    SpentError,
    Wrapped,
    at_bounds,
    room,
)


def doubled(problem: Problem, theta: Floats, derivatives: bool, second: bool) -> Evaluation:
    evaluation = problem.evaluate(theta, derivatives=derivatives, second=second)
    return replace(evaluation, J=2 * evaluation.J)


def test_a_wrapped_problem_differs_in_its_evaluations_alone() -> None:
    problem = box(circles, [-2.0, -1.0], [2.0, 3.0])
    wrapped: Problem = Wrapped(problem, doubled)
    theta = np.array([0.5, 1.0])
    assert wrapped.objectives == problem.objectives
    assert wrapped.lower.tolist() == [-2.0, -1.0]
    assert wrapped.upper.tolist() == [2.0, 3.0]
    assert wrapped.start.tolist() == problem.start.tolist()
    assert wrapped.evaluate(theta).J.tolist() == (2 * problem.evaluate(theta).J).tolist()
    assert not wrapped.evaluate(theta, derivatives=False).derivatives
    assert Wrapped(problem, doubled, ("a", "b")).objectives == ("a", "b")


def test_no_more_evaluations_are_made_than_are_allowed_on_either_side_of_a_jump() -> None:
    problem = box(circles, [-2.0, -1.0], [2.0, 3.0])
    theta, plain = np.array([0.5, 1.0]), Wrapped(problem, doubled, most=3)
    here = problem.evaluate(theta)
    assert plain.continued(here, here) is None, "the problem knows no jump"

    class Jumping:
        objectives, start = problem.objectives, problem.start
        lower, upper = problem.lower, problem.upper
        evaluate = problem.evaluate

        def continued(self, inside: Evaluation, beyond: Evaluation) -> Problem | None:
            return None if inside is beyond else problem

    wrapped = Wrapped(Jumping(), doubled, most=3)
    assert wrapped.continued(here, here) is None
    smooth = wrapped.continued(here, replace(here))
    assert smooth is not None
    assert smooth.objectives == problem.objectives
    assert Wrapped(Jumping(), doubled, ("a",)).continued(here, replace(here)) is None
    for each in (wrapped, smooth, wrapped):
        assert each.evaluate(theta).J.tolist() == (2 * here.J).tolist()
    for each in (wrapped, smooth):
        with pytest.raises(SpentError):
            each.evaluate(theta)
    assert wrapped.count == 3


def test_parameters_are_at_bounds_within_rounding_and_have_room_up_to_them() -> None:
    lower, upper, near = np.full(5, -1.0), np.full(5, 3.0), 4 * AT_BOUND
    theta = np.array([-1.0, -1 + near / 2, -1 + 2 * near, 3 - near / 2, 3.0])
    assert at_bounds(theta, lower, upper).tolist() == [-1, -1, 0, 1, 1]
    middle, steps = np.array([0.0, 0.0, 1.0, 2.0, 0.5]), np.array([0.1, -0.2, 0.0, 0.25, -0.25])
    assert room(middle, steps, lower, upper) == 4.0
    assert room(middle, -steps, lower, upper) == 10.0
    assert room(middle, 0 * steps, lower, upper) == np.inf
