"""Errors with a prior: counts, scatter and the most probable model against closed forms."""

from dataclasses import replace
from typing import Literal

import numpy as np
import pytest
import scipy.integrate
import scipy.stats

import modefront as mf
from modefront._typing import Floats
from modefront.errors import InputError
from modefront.residuals.problem import UpdatingProblem
from modefront.uncertainty.inference import log_values, most_probable
from modefront.uncertainty.prior import (
    PULL,
    Distance,
    NoisePrior,
    Standardised,
    expected,
    prior_widths,
)
from modefront.work.task import IMMEDIATE

FREQUENCY = np.array([4.9, 14.1, 19.9])
SHAPE = np.array([[0.45, 0.8, 1.0], [1.0, 0.3, -0.9], [-0.78, 1.0, -0.64]])
NAMES = ("k1", "k2", "k3")


def problem_of(
    *, sets: int = 1, spread: float = 0.0, frequency_std: Floats | None = None
) -> UpdatingProblem:
    """Return a chain with three parameters; data sets differ by ``spread``."""
    model = mf.chain(NAMES, [20.0] * 3, [80e3] * 3, stiffness_parameters=NAMES)
    rng = np.random.default_rng(1)
    f = FREQUENCY * (1 + spread * rng.normal(size=(sets, 3)))
    phi = SHAPE * (1 + spread * rng.normal(size=(sets, 3, 3)))
    measured = mf.modal_data(f, phi, model.sensors, frequency_std=frequency_std)
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    parameters = [mf.Parameter(name, nominal=1.0, bounds=(0.3, 3.0)) for name in NAMES]
    return mf.updating_problem(model, measured, groups, parameters=parameters)


def test_assumed_errors_are_relative_and_every_shape_loses_its_factor() -> None:
    problem = problem_of()
    noise = NoisePrior(frequency=0.01, shape=0.05).of(problem, None)
    assert noise is not None
    assert noise.a == pytest.approx([3, 6])
    assert noise.S == pytest.approx([0, 0], abs=1e-20)
    assert noise.assumed == "", "the user has said both"
    theta = np.array([0.9, 1.2, 1.1])
    J, scaled = problem.evaluate(theta).J, noise.problem.evaluate(theta).J
    assert scaled[0] == pytest.approx(J[0] / 0.01**2)
    ratio = np.mean([1 / np.mean(x**2) for x in SHAPE])  # greatest component over rms, squared
    assert scaled[1] == pytest.approx(J[1] / (0.05**2 * ratio))


def test_the_distance_from_the_nominal_model_is_added_to_the_logarithms() -> None:
    noise = NoisePrior().of(problem_of(), None)
    assert noise is not None
    J, distance = np.array([3.0, 7.0]), 0.4
    alone = (noise.logs.a * np.log(J + noise.logs.floor)).sum()
    assert noise.programme.value(np.append(J, distance)) == pytest.approx(alone + distance)
    assert noise.programme.gradient(np.append(J, distance))[-1] == pytest.approx(1.0)


def test_standard_deviations_of_the_data_come_first_and_gaps_are_assumed() -> None:
    std = np.array([[0.02, np.nan, 0.0]])
    noise = NoisePrior().of(problem_of(frequency_std=std), "std")
    assert noise is not None
    assert noise.problem.data.frequency_std[0] == pytest.approx([0.02, 0.005 * 14.1, 0.005 * 19.9])
    assert noise.assumed == "frequencies known to 0.5 %, shapes to 3 %"
    half = NoisePrior(frequency=0.01).of(problem_of(frequency_std=std), "std")
    assert half is not None
    assert half.assumed == "shapes known to 3 %"
    usual = NoisePrior(frequency=0.005, shape=0.03).of(problem_of(), None)
    assert usual is not None
    assert usual.assumed == "", "the user has said what is usual"
    alone = NoisePrior().of(replace(problem_of(), groups=(mf.Group("f", frequency="all"),)), None)
    assert alone is not None
    assert alone.assumed == "frequencies known to 0.5 %", "no group has shapes"
    without = NoisePrior().of(problem_of(frequency_std=std), None)
    assert without is not None
    assert without.problem.data.frequency_std[0] == pytest.approx(0.005 * FREQUENCY)


@pytest.mark.parametrize("sets", [2, 4])
def test_no_model_explains_the_scatter_of_data_sets(sets: int) -> None:
    noise = NoisePrior().of(problem_of(sets=sets, spread=0.02), "sets")
    assert noise is not None
    assert noise.a == pytest.approx([3, 6]), "sets are repeated, and count once"
    f = noise.problem.data.frequency
    w = 1 / (0.005 * f) ** 2
    mean = (w * f).sum(axis=0) / w.sum(axis=0)
    S = (w * (f - mean) ** 2).sum()
    assert noise.S[0] == pytest.approx(S)
    d = 3 * (sets - 1)
    assert noise.level[0] == pytest.approx((4 + S) / (4 + d))
    for theta in np.random.default_rng(0).uniform(0.5, 1.5, (20, 3)):
        assert (noise.problem.evaluate(theta).J >= noise.S).all()


def test_the_posterior_is_the_integral_over_the_variances() -> None:
    """Of two models the ratio of densities is that of integrals over s, done numerically."""
    problem = problem_of()
    noise = NoisePrior(weight=3.0).of(problem, None)
    assert noise is not None
    thetas = np.array([[1.0, 1.0, 1.0], [1.02, 0.99, 1.01]])

    def integral(J: float, a: float) -> float:
        def density(t: float) -> float:  # t = ln s; prior: scaled inverse chi-square about 1
            s = np.exp(t)
            return float(np.exp(-a / 2 * t - J / (2 * s) - 3.0 / 2 * t - 3.0 / (2 * s)))

        return float(scipy.integrate.quad(density, -30, 30, limit=500, points=[0, 3, 6])[0])

    J = [noise.problem.evaluate(theta).J for theta in thetas]
    logs = [sum(np.log(integral(x, a)) for x, a in zip(row, noise.a, strict=True)) for row in J]
    values = log_values(noise, thetas)
    pull = PULL * ((0.02**2 + 2 * 0.01**2) / 2.7**2)
    assert (values[1] - values[0] - pull) / 2 == pytest.approx(logs[0] - logs[1], rel=1e-6)


def test_the_most_probable_model_is_stationary_at_its_weights() -> None:
    problem = problem_of()
    found = {}
    for weight in (4.0, 1e6):
        noise = NoisePrior(weight=weight).of(problem, None)
        assert noise is not None
        found[weight] = most_probable(problem, noise, [np.full(3, 1.1)], IMMEDIATE)[0]
        best = found[weight]
        assert best.converged
        assert best.weights @ best.evaluation.dJ == pytest.approx(
            np.zeros(3), abs=1e-4 * np.abs(best.weights[:, None] * best.evaluation.dJ).max()
        )
    ratio = {w: x.weights[0] / x.weights[1] for w, x in found.items()}
    shape = np.mean([1 / np.mean(x**2) for x in SHAPE])
    assert ratio[1e6] == pytest.approx(0.03**2 * shape / 0.005**2, rel=1e-3)


def test_what_nothing_determines_stays_nominal() -> None:
    """Shapes alone do not change when all stiffnesses are scaled together."""
    problem = problem_of()
    groups = (mf.Group("shapes", shape="all"),)
    parameters = [mf.Parameter(name, nominal=1.3, bounds=(0.3, 3.0)) for name in NAMES]
    shapes = mf.updating_problem(problem.model, problem.data, groups, parameters=parameters)
    noise = NoisePrior().of(shapes, None)
    assert noise is not None
    starts = np.random.default_rng(0).uniform(0.6, 2.0, (4, 3))
    best = most_probable(shapes, noise, list(starts), IMMEDIATE)
    x = best[0].theta
    assert best[0].converged
    # Of the models s x the one nearest to the nominal one has s = 1.
    assert 1.3 * x.sum() / (x @ x) == pytest.approx(1, abs=1e-4)


def test_weight_zero_expects_nothing() -> None:
    assert NoisePrior(weight=0).of(problem_of(), None) is None
    for frequency in (0, 0.5):  # as a per cent
        with pytest.raises(InputError, match="such as 0"):
            NoisePrior(frequency=frequency)


PRIORS = (None, mf.Prior("normal", 0.2), mf.Prior("lognormal", 0.3))


def test_the_distance_from_the_nominal_model_is_in_the_units_of_priors() -> None:
    """A uniform prior counts as a normal one of so many ranges; all derivatives are exact."""
    problem, theta, h = replace(problem_of(), priors=PRIORS), np.array([0.8, 1.3, 0.7]), 1e-5
    for known in (problem, replace(problem, start=np.array([0.9, 1.1, 1.2]))):
        distance, centre = Distance(known, 12.0), known.start
        r, dr, d2r = distance.residuals(theta)
        ratio = np.log(theta[2] / centre[2]) / 0.3
        away = theta - centre
        assert r == pytest.approx([np.sqrt(12.0) * away[0] / 2.7, away[1] / 0.2, ratio])
        ahead, behind = (distance.residuals(theta + s) for s in (h, -h))
        assert dr == pytest.approx((ahead[0] - behind[0]) / (2 * h), rel=1e-8)
        assert d2r == pytest.approx((ahead[1] - behind[1]) / (2 * h), rel=1e-6, abs=1e-9)
        at = distance.evaluation(known, theta, True, True)
        plain = known.evaluate(theta, second=True)
        assert at.J[:-1].tolist() == plain.J.tolist()
        assert at.J[-1] == pytest.approx(r @ r)
        assert distance.evaluation(known, theta, False, False).J == pytest.approx(at.J)
        for j, step in enumerate(h * np.eye(3)):
            one, other = (distance.evaluation(known, theta + x, True, True) for x in (step, -step))
            assert at.dJ[:, j] == pytest.approx((one.J - other.J) / (2 * h), rel=1e-6, abs=1e-8)
            assert at.H[-1, j] == pytest.approx(
                (one.dJ - other.dJ)[-1] / (2 * h), rel=1e-6, abs=1e-8
            )
        rough = distance.evaluation(known, theta, True, False)
        assert rough.H[-1] == pytest.approx(2 * np.diag(dr**2))
        assert rough.residuals[-1].dr == pytest.approx(np.diag(dr))
        assert rough.gauss_newton[-1] == pytest.approx(rough.H[-1])
    nowhere = distance.evaluation(known, np.array([1.0, -5.0, 1.0]), True, False)
    assert not nowhere.feasible


def test_the_precision_is_that_of_residuals_and_priors() -> None:
    noise = NoisePrior().of(replace(problem_of(), priors=PRIORS), None)
    assert noise is not None
    theta = np.array([0.9, 1.1, 1.2])
    found = noise.problem.evaluate(theta)
    w = (noise.a + 4) / (found.J + 4)
    G = sum(v * x.dr.T @ x.dr for v, x in zip(w, found.residuals, strict=True))
    own = np.diag([12 / 2.7**2, 1 / 0.2**2, 1 / (0.3 * 1.2) ** 2])
    assert noise.precision(found) == pytest.approx(G + own, rel=1e-9)
    far = replace(noise, S=np.array([0.5, 2.0]), level=np.array([4.0, 0.25]))
    expected = np.sqrt([(7.0 - 0.5) / (3 * 4.0), (3.0 - 2.0) / (6 * 0.25)])
    assert far.over_expected(np.array([7.0, 3.0])) == pytest.approx(expected)
    assert far.over_expected(np.array([0.4, 3.0]))[0] == 0


def test_standardised_residuals_have_the_derivatives_of_their_values() -> None:
    of, z, h = Standardised(replace(problem_of(), priors=PRIORS)), np.array([0.3, -0.5, 1.1]), 1e-5
    at = of.evaluate(z)
    assert at.J[-1] == pytest.approx(z @ z)
    assert at.J[:-1] == pytest.approx(of.problem.evaluate(of.theta(z)[0]).J)
    assert of.evaluate(z, derivatives=False).J == pytest.approx(at.J)
    for j, step in enumerate(h * np.eye(3)):
        one, other = (of.evaluate(z + x) for x in (step, -step))
        assert at.dJ[:, j] == pytest.approx((one.J - other.J) / (2 * h), rel=1e-6, abs=1e-7)
        for x, ahead, behind in zip(at.residuals, one.residuals, other.residuals, strict=True):
            assert x.dr[:, j] == pytest.approx((ahead.r - behind.r) / (2 * h), rel=1e-6, abs=1e-7)
    assert at.H == pytest.approx(np.array([2 * x.dr.T @ x.dr for x in at.residuals]))
    far = of.evaluate(np.full(3, 99.0))
    assert far.theta.tolist() == of.upper.tolist()
    assert of.theta(far.theta)[0] == pytest.approx([3.0, 3.0, 3.0])


def test_widths_of_priors_are_those_of_their_distributions_between_the_bounds() -> None:
    widths = [0.9 * 2.7]
    for prior in PRIORS[1:]:
        assert prior is not None
        is_log = prior.kind == "lognormal"
        ends = (np.log([0.3, 3.0]) if is_log else np.array([-0.7, 2.0])) / prior.std
        x = prior.std * scipy.stats.truncnorm(*ends).ppf([0.05, 0.95])
        widths.append(float(np.ptp(np.exp(x) if is_log else x)))
    problem = replace(problem_of(), priors=PRIORS)
    assert prior_widths(problem) == pytest.approx(widths, rel=1e-4)


@pytest.mark.parametrize("source", ["std", "sets"])
def test_expected_deviations_are_those_of_the_data_or_assumed_value_by_value(
    source: Literal["std", "sets"],
) -> None:
    """Those of means over the sets in which a mode was measured: sums, not means, of squares."""
    rng, sizes = np.random.default_rng(0), {"frequency": 0.01, "shape": 0.05}
    f, phi = rng.uniform(5, 9, (3, 2)), rng.uniform(0.2, 1, (3, 2, 4))
    f[0, 1], phi[1, 0], phi[2, 1, 2:] = np.nan, np.nan, np.nan
    f_std, phi_std = 0.02 * f, 0.03 * phi
    f_std[1, 1], f_std[2, 0] = np.nan, 3e-9
    phi_std[0, 1], phi_std[2, 0, 1], phi_std[0, 0, 3] = 0.0, 0.0, np.nan
    given = mf.modal_data(f, phi, ("a", "b", "c", "d"), frequency_std=f_std, shape_std=phi_std)
    found = expected(given, sizes, source)
    shapes = [x[np.isfinite(x)] for x in phi.reshape(-1, 4) if np.isfinite(x).any()]
    ratio = np.sqrt(np.mean([x.max() ** 2 / np.mean(x**2) for x in shapes]))
    for k, r in np.ndindex(3, 2):
        if np.isfinite(f[k, r]):
            known = source == "std" and f_std[k, r] > 1e-9 * f[k, r]
            std = f_std[k, r] if known else 0.01 * f[k, r]
            many = np.isfinite(f[:, r]).sum()
            assert found.frequency_std[k, r] == pytest.approx(std / np.sqrt(many))
        here = np.isfinite(phi[k, r])
        assert np.isnan(found.shape_std[k, r, ~here]).all()
        if here.any():
            own = np.nan_to_num(phi_std[k, r, here])
            positive = own > 0
            size = np.where(positive, own, np.median(own[positive])) if positive.any() else own
            if source == "sets" or not positive.any():
                size = np.full(here.sum(), 0.05 * ratio * np.sqrt(np.mean(phi[k, r, here] ** 2)))
            many = np.isfinite(phi[:, r]).any(axis=1).sum()
            assert found.shape_std[k, r, here] == pytest.approx(size / np.sqrt(many))
