"""What chains propose and take, against the definitions of densities and of Metropolis' rule."""

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
import scipy.integrate
import scipy.optimize
import scipy.stats
from exact import Residuals, squares

from modefront._typing import Floats
from modefront.models.parameters import Prior
from modefront.residuals.problem import UpdatingProblem
from modefront.uncertainty.prior import NoiseModel, Standardised
from modefront.uncertainty.sampling import SOLVED, Model, Peak, Sampler, find_peak, mixture

A = np.array([2.0, 5.0])
"""Counts of independent errors of the two groups."""


def bent(theta: Floats) -> Residuals:
    """A curve in the first group, and a plane of three measurements in the second one."""
    x, y = theta
    first = np.array([3 * (y - 0.3 * x**2), 2 * x - 1]), np.array([[-1.8 * x, 3.0], [2.0, 0.0]])
    slopes = np.array([[1.0, 2.0], [-2.0, 1.0], [0.5, -1.5]])
    return [first, (slopes @ theta - [0.4, -0.7, 1.0], slopes)]


def straight(theta: Floats) -> Residuals:
    slopes = np.array([[1.0, 2.0], [-2.0, 1.0], [0.5, -1.5]])
    return [(slopes[:2] @ theta - [0.5, 0.2], slopes[:2]), (slopes @ theta - 0.3, slopes)]


def noise_of(function: Callable[[Floats], Residuals], weight: float = 4.0) -> NoiseModel:
    """Return a problem whose parameters are linear in z: normal priors, and bounds far away."""
    problem = replace(squares(function, [-50, -50], [50, 50], 2), start=np.array([0.1, -0.2]))
    problem = replace(problem, priors=(Prior("normal", 0.7), Prior("normal", 0.4)))
    S, d, level = np.array([0.3, 0.0]), np.zeros(2), np.array([1.2, 0.8])
    return NoiseModel(cast(UpdatingProblem, problem), A, S, d, level, weight, "")


NOISE = noise_of(bent)
TARGET = Standardised(NOISE.problem)


def peak_of(noise: NoiseModel, wide: float = 1.0) -> Peak:
    at, curved = find_peak(noise, np.zeros(2))
    return Peak(at, noise.logs, curved, wide)


def model_at(z: Floats, s: Floats, target: Standardised = TARGET) -> Model:
    return Model(target.evaluate(z), s)


def some(count: int, seed: int = 0) -> list[Model]:
    rng, top = np.random.default_rng(seed), peak_of(NOISE).top
    return [
        model_at(top.z + 0.3 * rng.normal(size=2), top.s * rng.uniform(0.5, 2.0, 2))
        for _ in range(count)
    ]


def test_a_peak_is_a_maximum_and_knows_how_it_bends() -> None:
    peak, h = peak_of(NOISE), 1e-3
    value = scipy.optimize.minimize(lambda z: NOISE.programme.value(TARGET.evaluate(z).J), [0, 0])
    assert peak.at.theta == pytest.approx(value.x, abs=1e-4)
    floor = 4.0 * np.array([1.2, 0.8]) - [0.3, 0.0]
    assert peak.expected == pytest.approx((peak.at.J[:2] + floor) / (A + 4))
    for j, step in enumerate(h * np.eye(2)):
        ahead, behind = (TARGET.evaluate(peak.at.theta + x).residuals for x in (step, -step))
        for i, x in enumerate(peak.at.residuals[:-1]):
            bend = x.dr.T @ (ahead[i].dr - behind[i].dr) / (2 * h)
            assert peak.curved[i, :, :, j] == pytest.approx(bend, abs=1e-6)


def test_variances_lose_the_degrees_of_freedom_that_parameters_take() -> None:
    peak = peak_of(NOISE)
    parts = [x.dr.T @ x.dr / s for x, s in zip(peak.at.residuals, peak.expected, strict=False)]
    inverse = np.linalg.inv(np.eye(2) + sum(parts, np.zeros((2, 2))))
    free = [a + 4 - np.trace(inverse @ x) for a, x in zip(A, parts, strict=True)]
    for wide in (1.0, 4.0, 100.0):
        of = replace(peak, wide=wide)
        assert of.dof == pytest.approx(np.maximum(np.array(free) / wide, 1.0))
        assert of.scale / of.dof == pytest.approx(peak.expected * (A + 4) / free)


@pytest.mark.parametrize("wide", [1.0, 4.0])
def test_a_proposal_has_the_density_of_the_normal_variables_behind_it(wide: float) -> None:
    peak, h = peak_of(NOISE, wide), 1e-5

    def behind(x: Floats) -> Floats:
        return peak.behind(model_at(x[:2], x[2:]))

    for model in some(4):
        x = np.append(model.z, model.s)
        slopes = [(behind(x + s) - behind(x - s)) / (2 * h) for s in h * np.eye(4)]
        u = behind(x)
        expected = scipy.stats.norm.logpdf(u).sum() + np.linalg.slogdet(np.array(slopes))[1]
        constant = np.log(2 * np.pi)  # of the normal variables of two parameters
        assert peak.log_density(model) == pytest.approx(expected + constant, abs=1e-6)
        found = peak.model(TARGET, u)
        assert found is not None
        assert found.s == pytest.approx(model.s, rel=1e-6)
        assert found.z == pytest.approx(model.z, abs=SOLVED)


def test_a_first_step_errs_by_third_derivatives() -> None:
    peak = peak_of(NOISE)
    errors = []
    for size in (0.2, 0.1):
        missing = size * np.array([3.0, -4.0])
        _, step, bend = peak.first(peak.top, missing)
        goal = peak.forward(peak.top)[0] + missing
        root = scipy.optimize.root(
            lambda z, goal=goal: peak.forward(model_at(z, peak.expected))[0] - goal, peak.top.z
        )
        errors.append(np.linalg.norm(peak.top.z + step + bend - root.x))
    assert errors[0] > 6 * errors[1] > 0


def test_the_posterior_of_models_and_variances_is_that_of_models() -> None:
    def integral(model: Model, i: int) -> float:
        """Return the logarithm of the integral over one variance, the other one being 1."""

        def density(t: float) -> float:
            s = np.ones(2)
            s[i] = np.exp(t)
            return float(np.exp(Model(model.found, s).log_posterior(NOISE.logs) + t))

        return float(np.log(scipy.integrate.quad(density, -20, 20, points=[0, 2], limit=200)[0]))

    differences = []
    for model in some(2):
        known = Model(model.found, np.ones(2))  # counted twice: neither integral leaves it out
        whole = integral(known, 0) + integral(known, 1) - known.log_posterior(NOISE.logs)
        differences.append(whole + NOISE.programme.value(model.found.J) / 2)
    assert differences[0] == pytest.approx(differences[1], abs=1e-6)


@pytest.mark.parametrize("b", [1.0, 0.4])
def test_steps_nearby_leave_a_gaussian_be(b: float) -> None:
    noise = noise_of(straight)
    target, s, rng = Standardised(noise.problem), np.array([0.5, 2.0]), np.random.default_rng(1)
    of = Sampler(target, noise.logs, [])
    here = model_at(np.array([0.8, -1.2]), s, target)
    dr, r = np.vstack([x.dr for x in here.found.residuals]), here.found.residuals
    over = np.diag(np.repeat([*(1 / s), 1.0], [2, 3, 2]))
    A = dr.T @ over @ dr
    middle = here.z - np.linalg.solve(A, dr.T @ over @ np.concatenate([x.r for x in r]))
    mean, precision = here.newton(b)
    assert precision == pytest.approx(A / b**2)
    assert mean - middle == pytest.approx(np.sqrt(1 - b**2) * (here.z - middle), abs=1e-9)
    for _ in range(5):
        here, chance = of.nearby(here, b, rng)
        assert chance == pytest.approx(1.0)


def taking(seed: int, random: float) -> np.random.Generator:
    """Return random numbers of which the uniform ones are given."""
    rng: Any = np.random.default_rng(seed)
    given = SimpleNamespace(normal=rng.normal, choice=rng.choice, random=lambda: random)
    return cast(np.random.Generator, given)


def test_steps_nearby_are_taken_by_metropolis_rule() -> None:
    of, b, chances = Sampler(TARGET, NOISE.logs, []), 0.8, []
    for k, here in enumerate(some(6)):
        new, chance = of.nearby(here, b, taking(k, 0.0))
        gain = 0.0
        for x, y, sign in ((here, new, -1), (new, here, 1)):
            mean, precision = x.newton(b)
            there = scipy.stats.multivariate_normal(mean, np.linalg.inv(precision))
            gain += sign * (there.logpdf(y.z) + x.log_posterior(NOISE.logs))
        assert chance == pytest.approx(min(1.0, np.exp(gain)), rel=1e-6)
        assert (new.z != here.z).all()
        chances.append(chance)
        if chance < 1:
            assert of.nearby(here, b, taking(k, chance * 1.001))[0] is here
            assert of.nearby(here, b, taking(k, chance * 0.999))[0] is not here
    assert min(chances) < 1


@pytest.mark.parametrize("wides", [(1.0,), (1.0, 4.0)])
def test_steps_across_are_taken_by_metropolis_rule(wides: tuple[float, ...]) -> None:
    peaks = [peak_of(NOISE, wide) for wide in wides]
    of, refused = Sampler(TARGET, NOISE.logs, peaks), 0
    for k, here in enumerate(some(8)):
        new = of.across(here, taking(k, 1e-300))
        assert new is not here
        value = [
            x.log_posterior(NOISE.logs) - np.logaddexp.reduce([y.log_density(x) for y in peaks])
            for x in (here, new)
        ]
        chance = float(np.exp(value[1] - value[0]))
        assert (of.across(here, taking(k, chance * 1.0001))) is here
        again = of.across(here, taking(k, chance * 0.9999))
        np.testing.assert_array_equal(again.z, new.z)
        refused += chance < 1
    assert refused


@pytest.mark.parametrize(("tilt", "count"), [(0.0, 2), (0.5, 2), (2.5, 1)])
def test_faint_peaks_are_left_out_and_each_is_there_once(tilt: float, count: int) -> None:
    """Two wells, of which a further residual makes one less likely."""

    def wells(theta: Floats) -> Residuals:
        x = theta[0]
        r = np.array([(x**2 - 1) / 0.2, tilt * (x - 1)])
        return [(r, np.array([[10 * x, 0 * x], [tilt + 0 * x, 0 * x]])), straight(theta)[1]]

    noise = replace(noise_of(wells), weight=1e6)
    starts = [np.array(x) for x in ([-1.0, 0.0], [1.0, 0.0], [0.9, 0.1])]
    peaks = mixture(noise, [find_peak(noise, x) for x in starts])
    assert len(peaks) == count
    value = [noise.programme.value(x.at.J) for x in peaks]
    assert value == sorted(value)
    assert Standardised(noise.problem).theta(peaks[0].at.theta)[0][0] > 0 or not tilt
