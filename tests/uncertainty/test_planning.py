"""Gains of further measurements against problems that have them."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

import modefront as mf
from modefront._typing import Floats
from modefront.uncertainty.inference import candidates
from modefront.uncertainty.prior import NoiseModel, NoisePrior

NAMES = ("k1", "k2", "k3")
THETA = np.array([0.9, 1.2, 1.05])


def noise_of(
    modes: int, sensors: int, priors: bool = False, shape: Sequence[int] = (1, 2, 3)
) -> NoiseModel:
    """Return a chain whose lowest modes at some of its sensors are measured without error."""
    model = mf.chain(NAMES, [20.0] * 3, [80e3] * 3, stiffness_parameters=NAMES)
    true = model.modes(THETA, 3)
    phi = true.phi.T[:modes, :sensors]
    top = np.abs(true.phi.T[:modes]).max(axis=1)[:, None]
    data = mf.modal_data(
        true.frequency[:modes],
        phi,
        model.sensors[:sensors],
        frequency_std=0.01 * true.frequency[:modes],
        shape_std=np.broadcast_to(0.02 * top, phi.shape),
    )
    shapes = mf.Group("shapes", shape=shape[:modes])
    groups = [mf.Group("frequencies", frequency="all"), shapes]
    prior = mf.Prior("lognormal", 0.3) if priors else None
    parameters = [mf.Parameter(x, nominal=1.0, bounds=(0.3, 3.0), prior=prior) for x in NAMES]
    problem = mf.updating_problem(model, data, groups, parameters=parameters)
    noise = NoisePrior().of(problem, "std")
    assert noise is not None
    return noise


def deviations(noise: NoiseModel, w: Floats, precision: Floats) -> Floats:
    """Return the standard deviations (p,) of linear residuals with weights w (n,)."""
    found = noise.problem.evaluate(THETA)
    G = sum(v * x.dr.T @ x.dr for v, x in zip(w, found.residuals, strict=True))
    return np.sqrt(np.diag(np.linalg.inv(G + np.diag(precision))))


@pytest.mark.parametrize("priors", [False, True])
def test_a_further_mode_narrows_as_if_it_had_been_measured(priors: bool) -> None:
    before, after = noise_of(2, 3, priors), noise_of(3, 3, priors)
    found = before.problem.evaluate(THETA)
    further = candidates(before, found)
    assert further["candidate_sensor"] == [""]
    assert further["candidate_frequency"] == pytest.approx(after.problem.data.frequency[:, 2])
    w = before.logs.gradient(found.J)
    precision = 1 / (0.3 * THETA) ** 2 if priors else np.full(3, 12 / 2.7**2)
    expected = 1 - deviations(after, w, precision) / deviations(before, w, precision)
    assert expected.max() > 0.1
    assert further["candidate_gain"][0] == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("shape", [(1, 2, 3), (2,)])
def test_a_further_sensor_narrows_as_if_it_had_been_there(shape: Sequence[int]) -> None:
    before, after = noise_of(3, 2, shape=shape), noise_of(3, 3, shape=shape)
    found = before.problem.evaluate(THETA)
    further = candidates(before, found)
    assert further["candidate_sensor"] == [before.problem.model.sensors[2]]
    assert further["candidate_frequency"].tolist() == [0.0]
    w = before.logs.gradient(found.J)
    # One component of three was the greatest: expected errors are those over it.
    tau = np.median(0.02 * np.abs(after.problem.model.modes(THETA, 3).phi).max(axis=0))
    assert tau > 0
    precision = np.full(3, 12 / 2.7**2)
    expected = 1 - deviations(after, w, precision) / deviations(before, w, precision)
    assert further["candidate_gain"][0] == pytest.approx(expected, rel=0.3)
    assert further["candidate_gain"].min() >= 0


def test_of_what_no_group_has_nothing_is_gained() -> None:
    """Where frequencies alone count, shapes of a mode or at a sensor tell nothing more."""
    of = []
    for modes, sensors in ((2, 2), (3, 2)):
        problem = noise_of(modes, sensors).problem
        noise = NoisePrior().of(replace(problem, groups=problem.groups[:1]), "std")
        assert noise is not None
        of.append(noise)
    before, after = of
    found = before.problem.evaluate(THETA)
    further, w = candidates(before, found), before.logs.gradient(found.J)
    precision = np.full(3, 12 / 2.7**2)
    expected = 1 - deviations(after, w, precision) / deviations(before, w, precision)
    assert further["candidate_sensor"] == [""]
    assert further["candidate_gain"][0] == pytest.approx(expected, rel=1e-6)
