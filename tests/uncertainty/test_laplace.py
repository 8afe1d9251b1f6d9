"""The posterior against closed forms and numerical integration."""

from collections.abc import Callable

import numpy as np
import pytest
import scipy.integrate
import scipy.stats
from exact import Residuals, Squares, squares

from modefront._typing import Floats
from modefront.optim.problem import Evaluation, with_second_order
from modefront.optim.scalarisation import LogSum
from modefront.optim.sqp import Options, begin, solve
from modefront.results.assemble import left_open
from modefront.uncertainty.prediction import draw
from modefront.uncertainty.scatter import Posterior, laplace

TIGHT = Options(step=1e-11, reduction=0.0, iterations=200)


def found_at(problem: Squares, a: Floats) -> tuple[Evaluation, Posterior]:
    evaluation = solve(problem, LogSum(a), begin(problem.evaluate(problem.start)), TIGHT).evaluation
    point = with_second_order(problem, evaluation)
    assert point is not None
    posterior = laplace(problem, point, a)
    assert posterior is not None
    return point, posterior


def regression(rng: np.random.Generator, rows: int) -> tuple[Floats, Floats]:
    A = rng.normal(size=(rows, 2))
    return A, A @ [1.0, -2.0] + 0.1 * rng.normal(size=rows)


def test_one_group_of_linear_residuals_has_students_covariance() -> None:
    """With s unknown, theta has Student's t; Laplace has its peak: s = J / a, C = s (A^T A)^-1."""
    A, y = regression(np.random.default_rng(0), 40)
    problem = squares(lambda theta: [(A @ theta - y, A)], [-5, -5], [5, 5], 1)
    point, posterior = found_at(problem, np.array([40.0]))
    expected = point.J[0] / 40 * np.linalg.inv(A.T @ A)
    assert posterior.covariance == pytest.approx(expected, rel=1e-6)
    C, z = 1e-4 * A, 1e-4 * y  # residuals in another unit
    other = squares(lambda theta: [(C @ theta - z, C)], [-5, -5], [5, 5], 1)
    same = found_at(other, np.array([40.0]))[1].covariance
    assert same == pytest.approx(posterior.covariance, rel=1e-6)
    lower, upper = ((point.theta + x).tolist() for x in (-1e-3, 1e-3))  # far within the scatter
    near = squares(lambda theta: [(A @ theta - y, A)], lower, upper, 1)
    assert found_at(near, np.array([40.0]))[1].covariance == pytest.approx(same, rel=1e-6)
    # The t distribution with a - 2 degrees of freedom has the greater variance J / (a - 4).
    t = point.J[0] / (40 - 4) * np.linalg.inv(A.T @ A)
    assert posterior.covariance == pytest.approx(t, rel=0.11)


def two_groups(theta: Floats) -> Residuals:
    x, y = theta
    rng = np.random.default_rng(4)
    e, f = 0.1 * rng.normal(size=(2, 60))
    r1 = x - 1 + e
    r2 = y**2 / 2 + x / 2 - 1.2 + f
    unit, zero = np.ones(60), np.zeros(60)
    return [(r1, np.column_stack([unit, zero])), (r2, np.column_stack([unit / 2, y * unit]))]


@pytest.mark.slow(2)
def test_two_groups_against_integration_over_parameters_and_variances() -> None:
    """The variances are integrated numerically too: the marginal is not taken on trust."""
    a = np.array([60.0, 60.0])
    problem = squares(two_groups, [0.5, 0.5], [1.5, 2.0], 2)
    point, posterior = found_at(problem, a)
    std = np.sqrt(np.diag(posterior.covariance))
    grid = [np.linspace(m - 6 * s, m + 6 * s, 81) for m, s in zip(point.theta, std, strict=True)]
    ln_s = np.linspace(-2.0, 2.5, 181)

    def density(theta: Floats) -> float:
        J = [r @ r for r, _ in two_groups(theta)]
        total = 1.0
        for i in range(2):
            s = np.exp(ln_s) * point.J[i] / a[i]
            # p(D | theta, s) p(s) ds with p(s) = 1 / s, as an integral over ln s
            ln_p = -a[i] / 2 * (np.log(s) + J[i] / (a[i] * s) - np.log(point.J[i] / a[i]) - 1)
            total *= scipy.integrate.simpson(np.exp(ln_p), x=ln_s)
        return total

    p = np.array([[density(np.array([x, y])) for y in grid[1]] for x in grid[0]])
    p /= p.sum()
    x, y = np.meshgrid(*grid, indexing="ij")
    mean = np.array([(p * x).sum(), (p * y).sum()])
    d = np.stack([x - mean[0], y - mean[1]])
    covariance = np.einsum("xy,ixy,jxy->ij", p, d, d)
    assert mean == pytest.approx(point.theta, abs=0.05 * std.max())
    assert posterior.covariance == pytest.approx(covariance, rel=0.06)
    # ... and of a prediction, by its gradient and by a sample.
    slope = np.array([[point.theta[1], point.theta[0]]])
    product = (slope @ posterior.covariance @ slope.T)[0, 0]
    exact = (p * (x * y) ** 2).sum() - (p * x * y).sum() ** 2
    assert product == pytest.approx(exact, rel=0.08)
    everywhere = np.full(point.theta.size, -np.inf), np.full(point.theta.size, np.inf)
    rng = np.random.default_rng(0)
    drawn = draw(point.theta, posterior.axes, rng, 4000, everywhere).prod(axis=1)
    assert drawn.var() == pytest.approx(product, rel=0.08)


def test_what_residuals_do_not_change_keeps_its_prior_and_is_named() -> None:
    A, y = regression(np.random.default_rng(0), 40)
    B = np.column_stack([A[:, 0], 2 * A[:, 0]])
    problem = squares(lambda theta: [(B @ theta - y, B)], [-50, -50], [50, 50], 1)
    point, posterior = found_at(problem, np.array([40.0]))
    (direction,) = posterior.free.T
    assert abs(direction / np.linalg.norm(direction) @ [2, -1]) == pytest.approx(np.sqrt(5))
    variance = np.array([1.0, 2.0]) @ posterior.covariance @ [1.0, 2.0]
    assert variance == pytest.approx(point.J[0] / 40 / (A[:, 0] @ A[:, 0]), rel=1e-6)


def test_what_is_left_open_does_not_depend_on_units() -> None:
    """As of a modulus in Pa and a factor that only their product determines."""
    A, y = regression(np.random.default_rng(0), 40)
    B = np.column_stack([A[:, 0] / 1e11, A[:, 0], A[:, 1]])
    lower, upper = np.array([[-50e11, -50, -50], [50e11, 50, 50]])
    problem = squares(lambda theta: [(B @ theta - y, B)], lower, upper, 1)
    assert left_open(found_at(problem, np.array([40.0]))[1].free).tolist() == [True, True, False]


def test_a_parameter_pressed_against_a_bound_is_given() -> None:
    A, y = regression(np.random.default_rng(0), 40)
    problem = squares(lambda theta: [(A @ theta - y, A)], [-5, -5], [0.9, 5], 1)
    point, posterior = found_at(problem, np.array([40.0]))
    assert posterior.held.tolist() == [True, False]
    assert posterior.covariance[0].tolist() == [0, 0]
    assert posterior.covariance[1, 1] == pytest.approx(
        point.J[0] / 40 / (A[:, 1] @ A[:, 1]), rel=1e-6
    )


def exact_fit(theta: Floats) -> Residuals:
    return [(theta - 1, np.eye(2))]


def hill(theta: Floats) -> Residuals:
    return [(1 - (theta - 1) ** 2, -2 * (theta - 1) * np.eye(2))]


def saddle(theta: Floats) -> Residuals:
    x, y = theta
    return [(np.array([1 - (x - 1) ** 2, y - 1]), np.array([[-2 * (x - 1), 0], [0, 1]]))]


@pytest.mark.parametrize("function", [exact_fit, hill, saddle])
def test_there_is_no_posterior_without_a_regular_minimum(
    function: Callable[[Floats], Residuals],
) -> None:
    problem = squares(function, [-2, -2], [2, 2], 1)
    point = with_second_order(problem, problem.evaluate(np.ones(2)))
    assert point is not None
    assert laplace(problem, point, np.array([2.0])) is None


def test_a_truncated_sample_stays_within_the_bounds() -> None:
    lower, upper = np.array([-0.5, -9.0]), np.array([0.5, 9.0])
    rng = np.random.default_rng(0)
    drawn = draw(np.zeros(2), np.eye(2), rng, 500, (lower, upper))
    assert drawn.shape == (500, 2)
    assert (drawn >= lower).all()
    assert (drawn <= upper).all()
    # Variance of a Gaussian truncated at half its standard deviation, in closed form.
    z = 0.5
    density = np.exp(-(z**2) / 2) / np.sqrt(2 * np.pi)
    mass = 2 * (scipy.stats.norm.cdf(z) - 0.5)
    assert drawn[:, 0].var() == pytest.approx(1 - 2 * z * density / mass, rel=0.15)
