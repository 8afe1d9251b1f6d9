"""Second derivatives at a model, exact or from differences, and what they cost."""

import numpy as np
import pytest
from exact import squares
from problems import Derivatives, Known, box, concave, disconnected

import modefront as mf
from modefront._typing import Floats
from modefront.analysis.front import _local
from modefront.optim.problem import with_second_order
from modefront.optim.sqp import given
from modefront.uncertainty.points import Role, SolvedPoint
from modefront.work.task import Costs

K = ("k1", "k2", "k3")


def chain() -> mf.UpdatingProblem:
    """Two data sets of a chain with noise, gaps and standard deviations."""
    rng = np.random.default_rng(3)
    model = mf.chain(K, [2.0, 1.5, 1.0], [3e3, 2e3, 4e3], stiffness_parameters=K)
    modes = model.modes(np.ones(3), 3)
    f = modes.frequency * (1 + 0.05 * rng.normal(size=(2, 3)))
    phi = modes.phi.T + 0.05 * rng.normal(size=(2, 3, 3))
    f[0, 2], phi[1, 0, 2] = np.nan, np.nan
    data = mf.modal_data(f, phi, model.sensors, frequency_std=0.01 * f)
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    return mf.updating_problem(
        model, data, groups, dict.fromkeys(K, (0.2, 5.0)), dict.fromkeys(K, 1.0)
    )


def test_a_model_that_knows_them_costs_nothing_or_one_evaluation(costs: Costs) -> None:
    problem, theta = chain(), np.array([1.1, 0.9, 1.2])
    first, second = (problem.evaluate(theta, second=x) for x in (False, True))
    before = costs.eigenproblems
    assert with_second_order(problem, second) is second
    assert costs.eigenproblems == before
    result = with_second_order(problem, first)
    assert costs.eigenproblems == before + 1
    assert result is not None
    assert result.exact
    assert result.H == pytest.approx(second.H, rel=1e-12)


def test_scatter_takes_one_eigenproblem_besides_a_solution(costs: Costs) -> None:
    problem = chain()
    evaluation = problem.evaluate(np.array([1.1, 0.9, 1.2]), second=True)
    before = costs.eigenproblems
    local = _local(problem, SolvedPoint("x", given(evaluation), Role("optimal")), None, "std")
    assert costs.eigenproblems == before + 1
    assert local is not None
    assert local.noise.J.shape == (5, 2)


def test_slopes_of_frequencies_and_mac_are_exact() -> None:
    problem, theta, h = chain(), np.array([1.1, 0.9, 1.2]), 1e-5
    slopes = problem.slopes_at(*problem.modes(theta))
    for j, unit in enumerate(np.eye(3)):
        ahead, behind = (problem.evaluate(theta + s * h * unit).quantities for s in (1, -1))
        for name, computed in slopes.items():
            assert computed[:, j] == pytest.approx(
                (ahead[name] - behind[name]) / (2 * h), rel=1e-6, abs=1e-8
            )


@pytest.mark.parametrize("position", [[0.3, -0.2], [-2.0, 0.1], [2.0, 2.0], [1.9999, -1.9999]])
def test_differences_within_and_at_the_bounds(position: list[float], costs: Costs) -> None:
    theta = np.array(position)
    for function in (concave, disconnected):
        problem = box(function, [-2, -2], [2, 2])
        before = costs.eigenproblems
        result = with_second_order(problem, problem.evaluate(theta))
        assert result is not None
        assert costs.eigenproblems - before == 2 + 4
        expected = function(theta)[2]
        # At a bound they are those at a step within: third derivatives are below 500, steps 0.0012.
        assert result.H == pytest.approx(expected, abs=0.6)


def test_inside_differences_are_exact_to_the_square_of_the_step() -> None:
    problem = box(concave, [-2, -2], [2, 2])
    theta = np.array([0.3, -0.2])
    result = with_second_order(problem, problem.evaluate(theta))
    assert result is not None
    assert result.H == pytest.approx(concave(theta)[2], rel=1e-5)
    assert (result.H == result.H.transpose(0, 2, 1)).all()


def test_gauss_newton_stays_what_it_is_beside_differences() -> None:
    def parabola(theta: Floats) -> list[tuple[Floats, Floats]]:
        x, y = theta
        return [(np.array([y - x**2, 0.3 + x]), np.array([[-2 * x, 1], [1, 0]]))]

    problem = squares(parabola, [-1, -1], [1, 1], exact=False)
    result = with_second_order(problem, problem.evaluate(np.array([0.3, 0.5])))
    known = squares(parabola, [-1, -1], [1, 1]).evaluate(np.array([0.3, 0.5]), second=True)
    assert result is not None
    assert result.H == pytest.approx(known.H, abs=1e-5)
    dr = parabola(np.array([0.3, 0.5]))[0][1]
    assert result.gauss_newton[0] == pytest.approx(2 * dr.T @ dr, rel=1e-14)


def test_there_are_none_where_the_model_ends() -> None:
    def hole(theta: Floats) -> Derivatives:
        J, dJ, H = concave(theta)
        return (J if theta[0] < 0.6 else J * np.inf), dJ, H

    problem: Known = box(hole, [-2, -2], [2, 2])
    assert with_second_order(problem, problem.evaluate(np.array([0.5999, 0.0]))) is None
