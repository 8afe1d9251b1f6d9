"""Problems that wrap others."""

from dataclasses import replace

import numpy as np
from problems import box, circles

from modefront._typing import Floats
from modefront.optim.problem import Evaluation, Problem, Wrapped


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
