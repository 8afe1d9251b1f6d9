"""The estimators against exact results, published-style reference values and one another."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.stats import norm

from modefront.predictions.reliability import (
    METHODS,
    FirstPassage,
    elementary_failures,
    estimate,
    gaussian_response,
    step_effect,
)
from modefront.predictions.system import ModalSystem

CONDITIONAL = ["importance", "directional", "additive"]
OSCILLATOR = ModalSystem(np.array([7.85]), np.array([0.02]), np.eye(1), np.eye(1))
REFERENCE = FirstPassage(OSCILLATOR, 2 * np.pi, 30.0, 0.02)
REFERENCE_VALUES = {1.6: 8.37e-3, 1.8: 1.144e-3, 2.1: 3.48e-5, 2.4: 5.84e-7}


class Estimate(NamedTuple):
    level: float
    probability: float
    coefficient_of_variation: float
    unit_coefficient_of_variation: float

    @property
    def standard_error(self):
        return self.probability * self.coefficient_of_variation


def run(method, problem, levels, samples, of_numbers, workers=1):
    """Return the estimates of a method, by its name, level by level."""
    levels = np.array(levels, dtype=float)
    found = estimate(METHODS[method], problem, levels, samples, of_numbers, workers)
    return [Estimate(b, p, v, v * samples**0.5) for b, p, v in zip(levels, *found, strict=True)]


def seed(number):
    return np.random.SeedSequence(number)


@pytest.mark.parametrize("method", CONDITIONAL)
def test_reference_values(method):
    for result in run(method, REFERENCE, list(REFERENCE_VALUES), 4000, seed(7), 1):
        expected = REFERENCE_VALUES[result.level]
        assert abs(result.probability - expected) < 4 * result.standard_error
        assert result.coefficient_of_variation < 0.05


def test_reference_values_by_counting():
    result, _ = run("monte-carlo", REFERENCE, [1.6, 1.8], 8_000, seed(8), 1)
    assert abs(result.probability - 8.37e-3) < 4 * result.standard_error
    bernoulli = np.sqrt((1 - result.probability) / result.probability)
    assert result.unit_coefficient_of_variation == pytest.approx(bernoulli, rel=1e-3)


@pytest.mark.slow(2)
def test_unit_coefficients_of_variation_of_the_reference():
    (plain,) = run("importance", REFERENCE, [2.1], 12_000, seed(1))
    (directional,) = run("directional", REFERENCE, [2.1], 12_000, seed(1))
    assert plain.unit_coefficient_of_variation <= 1.0
    assert directional.unit_coefficient_of_variation <= 0.8


def test_estimated_coefficient_of_variation_is_that_of_repetitions():
    short = replace(REFERENCE, duration=3.0)
    for method in CONDITIONAL:
        runs = [run(method, short, [1.0], 50, seed(k), 1)[0] for k in range(80)]
        p = np.array([run.probability for run in runs])
        claimed = np.sqrt(np.mean([run.standard_error**2 for run in runs]))
        assert p.std(ddof=1) == pytest.approx(claimed, rel=0.3)


@pytest.mark.parametrize("method", CONDITIONAL)
def test_one_time_step_is_known_exactly(method):
    """One response at one time: P = 2Φ(-b/σ), without any spread."""
    problem = FirstPassage(OSCILLATOR, 2 * np.pi, 0.02, 0.02)
    sigma = gaussian_response(problem).deviation[0, 0]
    for result, beta in zip(
        run(method, problem, sigma * np.array([0.1, 3.0, 30.0]), 50, seed(0), 1),
        (0.1, 3.0, 30.0),
        strict=True,
    ):
        assert result.probability == pytest.approx(2 * norm.sf(beta), rel=1e-9)
        assert result.unit_coefficient_of_variation < 1e-9


@pytest.mark.parametrize("method", [*CONDITIONAL, "monte-carlo"])
@pytest.mark.parametrize("beta", [0.3, 0.8])
def test_two_time_steps_against_quadrature(method, beta):
    """Two correlated normal numbers: one integral, also where P is no small number."""
    problem = FirstPassage(OSCILLATOR, 2 * np.pi, 0.04, 0.02)
    response = gaussian_response(problem)
    a = response.design_excitation(np.array([0, 0]), np.array([0, 1]))[:, 0]
    level = beta * response.deviation[0, 1]

    def stays(z):
        low, high = ((s * level - a[1, 0] * z) / a[1, 1] for s in (-1, 1))
        return norm.pdf(z) * (norm.cdf(high) - norm.cdf(low))

    bound = min(level / a[0, 0], 9.0)
    exact = 1 - quad(stays, -bound, bound, epsabs=1e-12)[0]
    (result,) = run(method, problem, [level], 10_000, seed(4), 1)
    assert abs(result.probability - exact) < 4 * result.standard_error + 1e-9


@st.composite
def problems(draw):
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    m, outputs, inputs = (draw(st.integers(1, k)) for k in (4, 3, 2))
    system = ModalSystem(
        omega=rng.uniform(2, 15, m),
        zeta=rng.uniform(0.005, 0.3, m),
        input=rng.normal(size=(m, inputs)),
        output=rng.normal(size=(outputs, m)),
    )
    soil = draw(st.sampled_from([None, (15.0, 0.6)]))
    modulation = draw(st.sampled_from([None, lambda t: np.minimum(t / 2, 1)]))
    noise = 2 * np.pi * rng.uniform(0.05, 3)
    return FirstPassage(system, noise, 6.0, 0.05, soil=soil, modulation=modulation)


@pytest.mark.slow(3)
@settings(max_examples=12, deadline=None, derandomize=True)
@given(problem=problems())
def test_estimators_agree_with_counting(problem):
    response = gaussian_response(problem)

    def excess(factor):
        return elementary_failures(response, factor * response.deviation.max())[-1] - 0.05

    # P is about 1e-2 where the elementary failures sum to some times that.
    level = brentq(excess, 0.5, 8) * response.deviation.max()
    (counted,) = run("monte-carlo", problem, [level], 20_000, seed(11))
    assert 3e-3 < counted.probability < 5.5e-2
    for method in CONDITIONAL:
        (result,) = run(method, problem, [level], 2_000, seed(12), 1)
        error = np.hypot(result.standard_error, counted.standard_error)
        assert abs(result.probability - counted.probability) < 4 * error


@settings(max_examples=8, deadline=None)
@given(problem=problems(), power=st.integers(-8, 8))
def test_responses_and_levels_scale_together(problem, power):
    """A factor of two is exact in floating point, so that nothing at all may change."""
    system, factor = problem.system, 2.0**power
    scaled = replace(problem, system=replace(system, output=factor * system.output))
    level = 2 * gaussian_response(problem).deviation.max()
    for method in METHODS:
        (result,) = run(method, problem, [level], 40, seed(5), 1)
        (other,) = run(method, scaled, [factor * level], 40, seed(5), 1)
        assert other[1:] == result[1:]


def test_directions_never_have_the_larger_spread():
    """Rao and Blackwell: the radius integrated out, the variance can only fall."""
    for level in (0.6, 1.0, 1.4):
        short = replace(REFERENCE, duration=4.0)
        (plain,) = run("importance", short, [level], 4000, seed(2))
        (directional,) = run("directional", short, [level], 4000, seed(2))
        delta = directional.unit_coefficient_of_variation
        assert delta < 1.02 * plain.unit_coefficient_of_variation


def test_a_response_counted_twice_fails_no_more_often():
    twice = replace(REFERENCE, system=replace(OSCILLATOR, output=np.array([[1.0], [-1.0]])))
    for method in CONDITIONAL:
        (result,) = run(method, twice, [1.8], 1500, seed(3), 1)
        assert abs(result.probability - 1.144e-3) < 4 * result.standard_error


def test_an_input_split_in_two_is_the_same_input():
    split = replace(REFERENCE, system=replace(OSCILLATOR, input=np.array([[0.6, 0.8]])))
    (result,) = run("directional", split, [1.8], 1500, seed(3))
    assert abs(result.probability - 1.144e-3) < 4 * result.standard_error


@pytest.mark.parametrize("method", METHODS)
def test_same_digits_on_one_worker_and_many(method):
    short = replace(REFERENCE, duration=4.0)
    given_seed = seed(9)
    alone = run(method, short, [0.5, 0.9], 201, given_seed, 1)
    assert run(method, short, [0.5, 0.9], 201, given_seed, 3) == alone
    assert run(method, short, [0.9], 201, given_seed, 2) == alone[1:]
    assert run(method, short, [0.5, 0.9], 201, seed(10), 1) != alone


def test_one_pass_serves_levels_far_apart():
    together = run("importance", REFERENCE, [1.6, 2.4], 500, seed(6))
    apart = [run("importance", REFERENCE, [b], 500, seed(6))[0] for b in (1.6, 2.4)]
    assert list(together) == apart


def test_the_error_falls_with_the_root_of_the_samples():
    problem = replace(REFERENCE, duration=2.0)
    (result,) = run("directional", problem, [0.8], 100, seed(0))
    delta = result.unit_coefficient_of_variation
    assert result.coefficient_of_variation == pytest.approx(delta / 10)
    assert result.standard_error == pytest.approx(result.probability * delta / 10)


@pytest.mark.parametrize("method", METHODS)
def test_nothing_sampled_is_said(method):
    """A barrier beyond the range of floating point, or one that no sample reached."""
    (result,) = run(method, replace(REFERENCE, duration=1.0), [100.0], 10, seed(0), 1)
    assert result.probability == 0
    assert result.coefficient_of_variation == np.inf


def test_halving_the_step():
    """Peaks between the times are missed: the finer grid sees more failures."""
    coarse, directional = replace(REFERENCE, time_step=0.1), METHODS["directional"]
    level = np.array([1.8])
    (ratio,), (error,) = step_effect(directional, coarse, level, 2000, seed(1))
    assert ratio - 1 > 2 * error
    (ratio,), (error,) = step_effect(directional, REFERENCE, level, 2000, seed(1))
    assert abs(ratio - 1) < max(0.1, 4 * error)


def test_halving_the_step_where_nothing_failed():
    short = replace(REFERENCE, duration=1.0)
    ratio, error = step_effect(METHODS["monte-carlo"], short, np.array([100.0]), 10, seed(1))
    assert np.isnan([ratio, error]).all()
