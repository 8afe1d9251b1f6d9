"""Reduced bases on published models: a concrete frame and a steel bridge that was measured."""

from __future__ import annotations

import numpy as np
import pytest
from smu import FOLDER, frequencies_and_shapes, read, weighted_minimum

import modefront as mf
from modefront.work.task import Costs, counted

pytestmark = pytest.mark.skipif(
    not FOLDER.is_dir(), reason=f"the published models are not at {FOLDER}"
)


@pytest.mark.slow(6)
def test_the_frame_is_found_from_a_hundred_random_starts(costs: Costs) -> None:
    structure, rng = read("concrete_frame_sim"), np.random.default_rng(0)
    problem = frequencies_and_shapes(structure, mf.Pairing("order"), reduced=True)
    assert structure.true is not None
    for _ in range(100):
        start = rng.uniform(structure.lower, structure.upper)
        result = weighted_minimum(problem, np.ones(2), start)
        assert np.abs(result.theta - structure.true).max() < 1e-3
    assert costs.eigenproblems <= 3


@pytest.mark.slow(3)
@pytest.mark.parametrize("weight", [10.0, 100.0])
def test_models_of_the_bridge_are_the_same_with_and_without_reduction(weight: float) -> None:
    structure, w = read("steel_bridge_exp"), np.array([weight, 1.0])
    problem, full = (
        frequencies_and_shapes(structure, reduced=reduced) for reduced in (True, False)
    )
    with counted() as costs:
        result = weighted_minimum(problem, w, problem.start)
    assert costs.eigenproblems <= 3
    expected = weighted_minimum(full, w, full.start)
    assert result.converged
    assert expected.converged
    # Fits this poor ask for more of the derivatives of shapes than of the modes themselves.
    assert (np.abs(result.theta - expected.theta) / (full.upper - full.lower)).max() < 1e-3
    least = w @ full.evaluate(expected.theta).J
    assert w @ full.evaluate(result.theta).J == pytest.approx(least, rel=1e-6)
    assert w @ problem.evaluate(result.theta).J == pytest.approx(least, rel=1e-6)
