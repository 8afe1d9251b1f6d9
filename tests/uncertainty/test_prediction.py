"""Derivatives along axes, and samples, of predictions with closed forms."""

import itertools

import numpy as np
import pytest
import scipy.stats

from modefront._typing import Floats
from modefront.uncertainty.inference import Inference
from modefront.uncertainty.prediction import (
    STEP,
    TruncationError,
    draw,
    lognormal_std,
    stencil,
    summary,
)
from modefront.uncertainty.sampling import Draws

WIDE = np.full(3, -1e9), np.full(3, 1e9)
MIDDLE = np.array([1.0, -2.0, 0.5])


def axes(seed: int = 0) -> Floats:
    """Axes of parameters whose units are six orders apart, the third one held."""
    rng = np.random.default_rng(seed)
    return np.asarray(rng.normal(size=(3, 2)) * np.array([[1e-3], [1e3], [0.0]]))


def response(points: Floats, A: Floats) -> Floats:
    return np.asarray(points @ A.T)


def test_covariances_of_linear_predictions_are_exact_also_at_bounds() -> None:
    """Of all ways in which bounds are far, near or met on either side of each axis."""
    rng = np.random.default_rng(1)
    R, A = axes(), rng.normal(size=(4, 3)) * np.array([1e3, 1e-3, 1.0])
    expected = A @ R @ R.T @ A.T
    reach = np.abs(R).sum(axis=1) + 1e-3
    result = 0
    for room in itertools.product((0.0, 0.2, 5.0), repeat=4):
        below, above = np.array([*room[:2], 1.0]), np.array([*room[2:], 1.0])
        lower, upper = MIDDLE - below * reach, MIDDLE + above * reach
        points = stencil(MIDDLE, R, lower, upper)
        if points is None:
            continue
        result += 1
        assert (points.theta >= lower).all()
        assert (points.theta <= upper).all()
        S = points.slopes(response(MIDDLE, A), response(points.theta, A))
        assert S @ S.T == pytest.approx(expected, rel=1e-9, abs=1e-9 * expected.max())
    assert result >= 40


@pytest.mark.parametrize("size", [1.0, 1e-7])
def test_the_gaussian_of_draws_has_the_covariance_of_parameters_in_any_units(size: float) -> None:
    unit = np.array([2e11, 1.0, 1e-12])
    spread = size * np.array([[0.01, 0, 0], [0.03, 0.04, 0], [0, 0, 0.02]])
    z = np.random.default_rng(0).normal(size=(500, 3)) @ spread.T
    draws = Draws(unit * (1 + z), *np.zeros((2, 500, 0)), *np.ones((2, 3)))
    found = Inference(draws, {}, None, None, None, np.zeros((0, 1))).gaussian(1.5 * unit)
    expected = pytest.approx(np.cov(z.T), rel=1e-6, abs=1e-9 * size**2)
    assert found.covariance / np.outer(unit, unit) == expected


def test_errors_of_differences_are_those_of_the_third_derivative() -> None:
    """Of q = exp(theta_1): the central one errs by h^2 / 6, one-sided by h^2 / 3 the other way."""
    R = np.array([[0.01], [0.0], [0.0]])
    theta = np.zeros(3)
    error = {}
    for name, upper in (("central", WIDE[1]), ("aside", np.zeros(3))):
        points = stencil(theta, R, WIDE[0], upper)
        assert points is not None
        S = points.slopes(np.ones(1), np.exp(points.theta[..., :1]))
        error[name] = S[0, 0] / 0.01 - 1
    h = 0.01 * STEP
    assert error["central"] == pytest.approx(h**2 / 6, rel=0.01)
    assert error["aside"] == pytest.approx(-(h**2) / 3, rel=0.01)


def test_an_axis_without_room_has_no_derivative_and_no_axes_have_no_scatter() -> None:
    R = np.array([[1.0], [1.0], [0.0]])
    lower, upper = MIDDLE - np.array([0.0, 1, 1]), MIDDLE + np.array([1, 0.0, 1])
    assert stencil(MIDDLE, R, lower, upper) is None
    points = stencil(MIDDLE, np.zeros((3, 0)), lower, upper)
    assert points is not None
    S = points.slopes(np.ones(2), np.zeros((0, 2, 2)))
    assert (S @ S.T).tolist() == [[0.0, 0.0], [0.0, 0.0]]


def test_the_lognormal_distribution_of_what_is_linear_in_its_logarithm() -> None:
    s = np.array([0.0, 0.1, 2.0, 30.0])
    median = np.array([1e-4, 0.5, 3e-7, 1e-20])
    expected = scipy.stats.lognorm.std(s[1:3], scale=median[1:3])
    result = lognormal_std(median, s)
    assert result[1:3] == pytest.approx(expected, rel=1e-9)
    assert result[0] == 0
    assert np.isinf(result[3])


def test_a_longer_sample_begins_with_a_shorter_one() -> None:
    bounds = MIDDLE - 1e-3, MIDDLE + 1e3
    short, long = (draw(MIDDLE, axes(), np.random.default_rng(2), n, bounds) for n in (7, 4000))
    assert short.shape == (7, 3)
    np.testing.assert_array_equal(long[:7], short)
    assert draw(MIDDLE, axes(), np.random.default_rng(2), 0, bounds).shape == (0, 3)


def test_bounds_that_leave_hardly_anything_end_with_a_statement() -> None:
    tight = np.zeros(2), np.full(2, 1e-3)
    with pytest.raises(TruncationError, match=r"\d of 100000 draws are within the bounds"):
        draw(np.zeros(2), np.eye(2), np.random.default_rng(0), 20, tight)
    # One in a thousand is no reason to give up.
    some = np.zeros(2), np.array([0.1, 0.063])
    result = draw(np.zeros(2), np.eye(2), np.random.default_rng(0), 200, some)
    assert len(result) == 200


def test_a_sample_is_summed_up_without_what_is_missing() -> None:
    values = np.column_stack([np.arange(101.0), np.full(101, np.nan), np.full(101, np.nan)])
    values[3:5, 1] = 1.0, 3.0
    values[7, 2] = 1.0
    result = summary(values)
    assert result[:, 0].tolist() == pytest.approx([50, np.sqrt(101 * 102 / 12), 4.1, 50, 95.9])
    assert result[:, 1].tolist() == pytest.approx([2, np.sqrt(2), 1, 2, 3])
    assert np.isnan(result[:, 2]).all()
