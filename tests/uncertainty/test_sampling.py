"""Models drawn from the posterior against closed forms and numerical integration."""

from collections.abc import Callable
from dataclasses import replace
from typing import cast

import numpy as np
import pytest
import scipy.stats
from exact import Residuals, squares

from modefront._typing import Floats
from modefront.residuals.problem import UpdatingProblem
from modefront.uncertainty.most_probable import log_values, maximum
from modefront.uncertainty.prior import NoiseModel
from modefront.uncertainty.sampling import draw_models, truncated, variances
from modefront.work.task import IMMEDIATE

NU = 4.0


def noise_of(
    function: Callable[[Floats], Residuals], lower: list[float], upper: list[float], a: list[float]
) -> NoiseModel:
    """Return residuals in units of expected errors, one group after the other."""
    problem = squares(function, lower, upper, len(a))
    n = len(a)
    return NoiseModel(cast(UpdatingProblem, problem), np.array(a), np.zeros(n), np.ones(n), NU, "")


def test_one_group_of_linear_residuals_has_students_distribution() -> None:
    """t about least squares, a + nu - p degrees of freedom, scale^2 = (J + nu) / dof (A^T A)^-1."""
    rng = np.random.default_rng(0)
    A = 20 * rng.normal(size=(6, 2))
    y = A @ [0.5, -0.3] + rng.normal(size=6)
    noise = noise_of(lambda theta: [(A @ theta - y, A)], [-3, -3], [3, 3], [6.0])
    best = maximum(noise, np.zeros(2))
    exact, (J,), *_ = np.linalg.lstsq(A, y)
    assert best.theta == pytest.approx(exact, abs=1e-5)
    of = variances(noise, noise.problem.evaluate(best.theta))
    assert of.dof == pytest.approx([6 + NU - 2], rel=1e-4)
    assert of.scale == pytest.approx([J + NU])
    draws = draw_models(noise, best.theta, 800, 1, IMMEDIATE).theta
    size = np.sqrt(np.diag(np.linalg.inv(A.T @ A)) * (J + NU) / 8)
    for x, middle, scale in zip(draws.T, exact, size, strict=True):
        p = scipy.stats.kstest((x - middle) / scale, scipy.stats.t(8).cdf).pvalue
        assert p > 0.01


def grid_quantiles(noise: NoiseModel, n: int, q: list[float]) -> Floats:
    """Return quantiles (p, q) of both parameters by integration over a grid."""
    lower, upper = noise.problem.lower, noise.problem.upper
    axes = [np.linspace(a, b, n) for a, b in zip(lower, upper, strict=True)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
    values = log_values(noise, grid).reshape(n, n)
    density = np.exp(-(values - values.min()) / 2)
    out = []
    for axis, other in ((0, 1), (1, 0)):
        total = np.cumsum(density.sum(axis=other))
        out.append(np.interp(q, total / total[-1], axes[axis]))
    return np.array(out)


def banana(theta: Floats) -> Residuals:
    x, y = theta
    r = np.array([(y - x**2) / 0.1, (x - 0.3) / 0.25])
    return [(r, np.array([[-20 * x, 10], [4, 0 * x]]))]


def basins(theta: Floats) -> Residuals:
    x, y = theta
    r = np.array([(x**2 - 1) / 0.3, (y - 0.2 * x) / 0.2])
    return [(r, np.array([[2 * x / 0.3, 0 * x], [0 * x - 1, 0 * x + 5]]))]


def flat(theta: Floats) -> Residuals:
    x, y = theta
    return [(np.array([(x - 0.4) / 0.2]), np.array([[5 + 0 * x, 0 * y]]))]


@pytest.mark.slow(2)
@pytest.mark.parametrize(
    ("function", "a"), [(banana, 2.0), (basins, 2.0), (flat, 1.0)], ids=lambda x: str(x)[:20]
)
def test_intervals_are_those_of_integration(
    function: Callable[[Floats], Residuals], a: float
) -> None:
    """A curved valley, two basins and a parameter without effect: to a tenth of the interval."""
    noise = noise_of(function, [-2, -2], [2, 3], [a])
    best = maximum(noise, np.array([0.9, 0.3]))
    draws = draw_models(noise, best.theta, 400, 2, IMMEDIATE).theta
    expected = grid_quantiles(noise, 201, [0.05, 0.95])
    found = np.quantile(draws, [0.05, 0.95], axis=0).T
    width = np.ptp(expected, axis=1)[:, None]
    assert (np.abs(found - expected) < 0.12 * width).all()


@pytest.mark.parametrize("mean", [-1.5, 0.1, 1.02])
def test_draws_at_bounds_are_those_of_the_truncated_gaussian(mean: float) -> None:
    """One linear residual of known variance whose minimum is beyond, near or between the bounds."""
    std = 0.3

    def line(theta: Floats) -> Residuals:
        x, _ = theta
        return [(np.array([(x - mean) / std]), np.array([[1 / std + 0 * x, 0 * x]]))]

    noise = replace(noise_of(line, [0, 0], [1, 1], [1.0]), weight=1e8)
    draws = draw_models(noise, maximum(noise, np.full(2, 0.5)).theta, 600, 5, IMMEDIATE).theta
    ends = (np.array([0, 1]) - mean) / std
    exact = scipy.stats.truncnorm(*ends, loc=mean, scale=std)
    assert scipy.stats.kstest(draws[:, 0], exact.cdf).pvalue > 0.01
    assert scipy.stats.kstest(draws[:, 1], scipy.stats.uniform.cdf).pvalue > 0.01


@pytest.mark.parametrize(("mean", "std"), [(-50.0, 1.0), (0.3, 0.4), (3.0, 1e-2), (1e6, 1.0)])
def test_truncated_draws_have_the_mean_of_the_truncated_gaussian(mean: float, std: float) -> None:
    rng = np.random.default_rng(0)
    draws = np.array([truncated(mean, std, 1.0, rng) for _ in range(4000)])
    away = min(abs(mean), abs(mean - 1))
    if away > 30 * std:  # exponential from the nearer end
        exact = std**2 / away if mean < 0 else 1 - std**2 / away
    else:
        exact = scipy.stats.truncnorm(-mean / std, (1 - mean) / std, loc=mean, scale=std).mean()
    assert draws.min() >= 0
    assert draws.max() <= 1
    assert draws.mean() == pytest.approx(exact, abs=4 * draws.std() / np.sqrt(4000) + 1e-9)


def test_twins_beyond_a_bound_fill_the_triangle() -> None:
    """Only the sum of two parameters is known, and is greater than bounds allow on average."""

    def total(theta: Floats) -> Residuals:
        x, y = theta
        return [(np.array([(x + y - 1.5) / 0.05]), np.array([[20 + 0 * x, 20 + 0 * x]]))]

    noise = replace(noise_of(total, [0, 0], [1, 1], [1.0]), weight=1e8)
    draws = draw_models(noise, np.array([0.75, 0.75]), 400, 6, IMMEDIATE).theta
    assert draws.sum(axis=1).std() == pytest.approx(0.05, rel=0.15)
    for x in draws.T:  # uniform from 0.5 to 1 but for the noise
        assert scipy.stats.kstest(x, scipy.stats.uniform(0.5, 0.5).cdf).statistic < 0.12


def test_draws_are_those_of_the_seed_and_more_add_to_them() -> None:
    noise = noise_of(banana, [-2, -2], [2, 3], [2.0])
    theta = maximum(noise, np.array([0.3, 0.1])).theta
    few, more = (draw_models(noise, theta, n, 3, IMMEDIATE).theta for n in (15, 30))
    assert few.shape == (15, 2)
    assert few.tolist() == more[:15].tolist()
    assert few.tolist() != draw_models(noise, theta, 15, 4, IMMEDIATE).theta.tolist()
