"""Fixed parameters, bounds and priors that are wrong are named, and right ones are not."""

from dataclasses import replace

import numpy as np
import pytest

import modefront as mf
from modefront._typing import Floats
from modefront.uncertainty.inference import (
    Freed,
    contradicted,
    excluding,
    most_probable,
    refused,
    unfixed,
    wider,
)
from modefront.uncertainty.prior import NoisePrior
from modefront.work.task import IMMEDIATE, counted

pytestmark = pytest.mark.usefixtures("short_chains")

NAMES = ("k1", "k2", "k3", "k4", "k5")
FIXED = ("k2", "k4")


def problem_of(truth: Floats, seed: int) -> mf.UpdatingProblem:
    """Return a measured chain of five stories, of which two stiffnesses are fixed."""
    model = mf.chain(NAMES, [20.0] * 5, [80e3] * 5, stiffness_parameters=NAMES)
    rng, true = np.random.default_rng(seed), model.modes(truth, 4)
    shape = true.phi.T
    top = np.abs(shape).max(axis=1)[:, None]
    data = mf.modal_data(
        true.frequency * (1 + 0.005 * rng.normal(size=4)),
        shape + 0.03 * top * rng.normal(size=shape.shape),
        model.sensors,
    )
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    parameters = [mf.Parameter(x, nominal=1.0, bounds=(0.3, 3.0), fixed=x in FIXED) for x in NAMES]
    return mf.updating_problem(model, data, groups, parameters=parameters)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("wrong", [*FIXED, ""])
def test_the_wrong_one_is_named_and_a_right_one_is_not(wrong: str, seed: int) -> None:
    rng = np.random.default_rng([seed, 1])
    truth = np.where(np.isin(NAMES, FIXED), 1.0, rng.uniform(0.8, 1.25, 5))
    truth[np.isin(NAMES, wrong)] = rng.choice([0.65, 1.5])
    problem = problem_of(truth, seed)
    noise = NoisePrior().of(problem, None)
    assert noise is not None
    theta = most_probable(problem, noise, [problem.start], IMMEDIATE)[0].theta
    before = noise.over_expected(noise.problem.evaluate(theta).J)
    found = unfixed(noise, theta, before, IMMEDIATE)
    if not wrong:
        assert found is None
        return
    assert found is not None
    name, value, misfit = found
    assert name == wrong
    assert value == pytest.approx(truth[NAMES.index(wrong)], rel=0.1)
    assert (before - misfit).max() > 1


def test_the_verdict_says_what_to_write() -> None:
    problem = problem_of(np.array([0.9, 1.5, 1.1, 1.0, 1.2]), 1)
    options = mf.Identifiability(models=0)
    search = mf.Search(doubt=0.5)
    results = mf.solve(problem, points=2, search=search, identifiability=options)
    (said,) = [x for x in results.verdict if "which is fixed" in x]
    assert said.startswith("With k2 = 1.")
    assert said.endswith("write fixed = false in its [[parameter]].")
    assert results.attrs["fixed_parameter"] == "k2"


@pytest.mark.parametrize(("std", "away"), [(0.1, 5.0), (0.15, 3.3), (0.2, 0.0), (0.4, 0.0)])
def test_a_prior_that_the_data_contradict_is_named(std: float, away: float) -> None:
    problem = problem_of(np.array([0.9, 1.0, 1.5, 1.0, 1.2]), 1)
    priors = (None, mf.Prior("normal", std), mf.Prior("lognormal", 0.3))
    noise = NoisePrior().of(replace(problem, priors=priors), None)
    assert noise is not None
    theta = most_probable(problem, noise, [problem.start], IMMEDIATE)[0].theta
    found = contradicted(noise, theta, IMMEDIATE)
    if not away:
        assert found is None
        return
    assert found is not None
    assert found[0] == "k3"
    assert found[1] == pytest.approx(1.5, rel=0.05)
    assert found[2] == pytest.approx(away, rel=0.1)


def test_a_problem_without_fixed_parameters_has_no_other_model() -> None:
    model = mf.chain(["k"], [20.0], [80e3], stiffness_parameters=["k"])
    data = mf.modal_data(np.array([10.0]), np.array([[1.0]]), model.sensors)
    groups = [mf.Group("frequencies", frequency="all")]
    problem = mf.updating_problem(model, data, groups, {"k": (0.3, 3.0)}, {"k": 1.0})
    assert problem.whole is None


@pytest.mark.parametrize(
    ("theta", "misfit", "less", "wrong"),
    [
        ([0.2, 1.0, 3.5], [1.1, 2.0], 40.0, [0, 2]),
        ([0.4, 1.0, 3.5], [1.1, 2.0], 40.0, [2]),  # the first one turns back
        ([0.2, 1.0, 3.5], [1.9, 2.0], 40.0, []),  # no error is a tenth less
        ([0.2, 1.0, 3.5], [1.1, 2.0], 6.0, []),  # -2 ln p falls by no more than by chance
    ],
)
def test_bounds_are_to_blame_where_wider_ones_lower_errors_beyond_chance(
    theta: list[float], misfit: list[float], less: float, wrong: list[int]
) -> None:
    """Of two bounds right ones let -2 ln p fall by 7.9 in one of a hundred cases."""
    free = Freed(np.array(theta), np.array(misfit), less)
    sides, at = np.array([-1, 0, 1]), np.array([0.3, 1.0, 3.0])
    assert excluding(sides, at, np.array([2.0, 2.0]), free) == wrong


def test_trials_are_the_same_in_a_basis_and_in_full() -> None:
    """A chain of 120 stories in five parts, one of the fixed parts softer; bases of a few modes."""
    stories = [name for name in NAMES for _ in range(24)]
    model = mf.chain(NAMES, [20.0] * 120, [8e7] * 120, stiffness_parameters=stories)
    true = model.modes(np.array([0.9, 0.65, 1.1, 1.0, 1.2]), 4)
    data = mf.modal_data(true.frequency, true.phi.T[:, ::8], model.sensors[::8])
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    parameters = [mf.Parameter(x, nominal=1.0, bounds=(0.3, 3.0), fixed=x in FIXED) for x in NAMES]
    found = []
    for reduction in (mf.Reduction("off"), mf.Reduction(1e-8)):
        problem = mf.updating_problem(
            model, data, groups, parameters=parameters, reduction=reduction
        )
        noise = NoisePrior().of(problem, None)
        assert noise is not None
        theta = np.array([0.9, 0.8, 1.3])
        with counted() as costs:
            found.append(unfixed(noise, theta, np.full(2, 3.0), IMMEDIATE))
    full, reduced = found
    assert full is not None
    assert reduced is not None
    assert (reduced[0], full[0]) == ("k2", "k2")
    assert reduced[1] == pytest.approx(full[1], rel=1e-6)
    assert reduced[2] == pytest.approx(full[2], abs=1e-5)
    assert costs.eigenproblems < 10


def test_wider_bounds_are_one_range_or_one_ratio_farther_away() -> None:
    below, above = wider(np.array([0.5, -1.0, 0.0, 2.0]), np.array([2.0, 3.0, 4.0, 6.0]))
    assert below.tolist() == pytest.approx([0.125, -5.0, -4.0, 2 / 3])
    assert above.tolist() == pytest.approx([8.0, 7.0, 8.0, 18.0])


def test_models_far_from_the_data_or_worse_than_the_nominal_one_are_refused() -> None:
    misfit, nominal = np.array([11.0, 2.3, 2.3, 1.9, 9.9]), np.array([1.0, 2.0, 2.2, 1.0, 11.0])
    far, worse = refused(misfit, nominal)
    assert far.tolist() == [True, False, False, False, False]
    assert worse.tolist() == [False, True, False, False, False]
