"""Structures that others measured or published; without their data, these tests are skipped."""

from __future__ import annotations

import numpy as np
import pytest
from smu import FOLDER, frequencies_and_shapes, read

from modefront import Pairing
from modefront.solvers.scalarisation import weighted
from modefront.solvers.sqp import begin
from modefront.solvers.sqp import solve as descend

pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason=f"there is no folder {FOLDER}")


def test_random_starts_find_the_true_concrete_frame() -> None:
    """913 of its 2,302 degrees of freedom have no mass; some starts are next to a mechanism."""
    frame = read("concrete_frame_sim")
    assert frame.true is not None
    problem = frequencies_and_shapes(frame, Pairing("order"))
    rng = np.random.default_rng(7)
    for theta in rng.uniform(frame.lower, frame.upper, (12, 12)):
        found = descend(problem, weighted(np.ones(2)), begin(problem.evaluate(theta)))
        np.testing.assert_allclose(found.at.theta, frame.true, atol=1e-5)
    assert problem.counts["eigenproblems"] < 12 * 25


def test_modes_of_the_steel_bridge_come_in_another_order_than_in_the_test() -> None:
    bridge = read("steel_bridge_exp")
    problem = frequencies_and_shapes(bridge)
    modes, pairs = problem.modes(problem.start, derivatives=False)
    assert (pairs.index + 1).tolist() == [2, 1, 3, 4, 5]
    assert (pairs.mac > 0.9).all()
    wrong, ordered = frequencies_and_shapes(bridge, Pairing("order")).modes(problem.start)
    assert (ordered.mac[:2] < 0.1).all()
