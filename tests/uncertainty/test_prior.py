"""Errors with a prior: counts, scatter and the most probable model against closed forms."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.integrate

import modefront as mf
from modefront._typing import Floats
from modefront.errors import InputError
from modefront.residuals.problem import UpdatingProblem
from modefront.uncertainty.inference import log_values, most_probable
from modefront.uncertainty.prior import PULL, NoisePrior
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
