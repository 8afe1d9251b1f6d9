"""Errors beside the scatter of data sets tell whether a model lacks something."""

import re
from dataclasses import replace

import numpy as np
import pytest
import scipy.stats

import modefront as mf
from modefront._typing import Floats
from modefront.datasets import Array, ArrayDataset
from modefront.front.point import Kind
from modefront.reports.page import _noise
from modefront.results.verdict import _front
from modefront.uncertainty.inference import (
    CHANCE,
    _fit,
    _misfits,
    chances,
    most_probable,
)
from modefront.uncertainty.noise import Uncertainty
from modefront.uncertainty.prior import NoisePrior
from modefront.work.task import IMMEDIATE

pytestmark = pytest.mark.usefixtures("short_chains")

N, SETS = 5, 4
SPRING = 0.01


def problem_of(seed: int, spring: float, sets: int = SETS) -> mf.UpdatingProblem:
    """Return a chain of two parameters, and of a spring at its end that the model lacks."""
    parts = np.zeros((N, N, N))
    for i in range(N):
        v = np.eye(N)[i] - (np.eye(N)[i - 1] if i else 0)
        parts[i] = 1e4 * np.outer(v, v)
    K = {"low": parts[:2].sum(axis=0), "high": parts[2:].sum(axis=0)}
    places = {f"s{i}": i for i in range(N)}
    model = mf.matrices(["low", "high"], K, {"base": np.eye(N)}, places)
    whole = {"x": 1.2 * K["low"] + 0.9 * K["high"] + spring * 1e4 * np.diag(np.eye(N)[-1])}
    true = mf.matrices(["x"], whole, {"base": np.eye(N)}, places).modes(np.ones(1), 4)
    rng, shape = np.random.default_rng(seed), true.phi.T
    data = mf.modal_data(
        true.frequency * (1 + 0.005 * rng.normal(size=(sets, 4))),
        shape + 0.02 * np.abs(shape).max() * rng.normal(size=(sets, *shape.shape)),
        model.sensors,
    )
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    parameters = [mf.Parameter(x, nominal=1.0, bounds=(0.3, 3.0)) for x in K]
    return mf.updating_problem(model, data, groups, parameters=parameters)


def lack(problem: mf.UpdatingProblem) -> Floats:
    noise = NoisePrior().of(problem, Uncertainty().of(problem.data))
    assert noise is not None
    theta = most_probable(problem, noise, [problem.start], IMMEDIATE)[0].theta
    return chances(noise, noise.problem.evaluate(theta))[0]


def test_of_right_models_the_probabilities_are_uniform() -> None:
    found = np.array([lack(problem_of(seed, 0.0)) for seed in range(20)]) / 2
    for p in found.T:
        assert scipy.stats.kstest(p, "uniform").pvalue > 0.01


def test_a_spring_that_the_model_lacks_shows_in_several_sets_only() -> None:
    assert (lack(problem_of(1, SPRING)) < CHANCE).any()
    assert np.isnan(lack(problem_of(1, SPRING, sets=1))).all()


@pytest.mark.parametrize(("times", "weight"), [(1, 4.0), (20, 4.0), (20, 1e-3)])
def test_errors_that_are_far_below_those_expected_are_no_chance(times: int, weight: float) -> None:
    problem = problem_of(1, 0.0, sets=1)
    noise = NoisePrior(0.005 * times, 0.02 * times, weight).of(problem, None)
    assert noise is not None
    theta = most_probable(problem, noise, [problem.start], IMMEDIATE)[0].theta
    found = chances(noise, noise.problem.evaluate(theta))[1] < CHANCE
    assert found.tolist() == [times * weight > 4] * 2


def test_copies_of_a_data_set_say_nothing_of_errors() -> None:
    problem = problem_of(1, 0.0)
    data = problem.data
    frequency = np.broadcast_to(data.frequency[:1], data.frequency.shape)
    copied = replace(problem, data=replace(data, frequency=frequency))
    found, noise = lack(copied), NoisePrior().of(copied, "sets")
    assert noise is not None
    assert np.isnan(found[0])
    assert found[1] > CHANCE
    assert noise.level[0] == 1


@pytest.mark.parametrize("sets", [1, 12])
def test_a_compromise_is_one_beside_the_errors_of_all_sets_together(sets: int) -> None:
    """The scatter of the sets, which no model explains, does not hide how far a front goes."""
    problem = problem_of(3, 0.0, sets)
    noise = NoisePrior().of(problem, Uncertainty().of(problem.data))
    assert noise is not None
    best = most_probable(problem, noise, [problem.start], IMMEDIATE)[0].theta
    fit = _fit(noise, best)
    thetas = best * [[1, 1], [0.98, 1], [1, 1.2]]
    own = noise.problem
    far = _misfits(noise, list(thetas))
    data = {
        "label": (("point",), ["most-probable", "nbi-1", "nbi-2"]),
        "kind": (("point",), [Kind.MOST_PROBABLE.value, Kind.FRONT.value, Kind.FRONT.value]),
        "error": (("point", "group"), [np.sqrt(problem.evaluate(x).J) for x in thetas]),
        "paired_mode": (("point", "mode"), np.ones((3, 3))),
        "mac_mode": (("mode",), np.ones(3)),
        "misfit": (("group",), fit["misfit"]),
        "front_misfit": (("point", "group"), far),
        "scatter_share": (("group",), fit["scatter_share"]),
        "group": (("group",), ["frequencies", "shapes"]),
    }
    arrays = {x: Array(y, np.array(z)) for x, (y, z) in data.items()}
    results = ArrayDataset(arrays, {"reference": "most-probable"})
    (said,) = _front(results)
    frequencies, shapes = np.ptp(far[1:], axis=0)
    assert min(frequencies, shapes) > 0.5
    greatest = max(frequencies, shapes)
    (change,) = re.findall(r"of (?:frequencies|shapes) change by ([0-9.]+) times", said)
    assert float(change) == pytest.approx(greatest, rel=0.06)
    near = best * 1.001
    slope = np.sqrt(problem.evaluate(near).J) - arrays["error"].values[0]
    slope /= noise.over_expected(own.evaluate(near).J) - far[0]
    assert _noise(results)[0] == pytest.approx(slope[0], rel=0.1)


def test_of_a_model_that_lacks_something_nothing_is_determined() -> None:
    options = mf.Identifiability(models=0)
    search = mf.Search(doubt=0.5)
    results = mf.solve(problem_of(2, SPRING), points=2, search=search, identifiability=options)
    assert results.verdict[0].endswith("the model lacks something.")
    assert set(results.trust.values.tolist()) == {"partly"}
