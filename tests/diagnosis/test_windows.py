"""A pair of modes that are far apart: a window is advised only where it would mend that."""

from __future__ import annotations

import numpy as np
import pytest

from modefront.data.modal import modal_data
from modefront.diagnosis.comparison import bad_pairs, compare
from modefront.models.chain import chain
from modefront.residuals.groups import Group
from modefront.residuals.problem import UpdatingProblem


@pytest.mark.parametrize(
    ("ratio", "kind", "remedy"),
    [
        (1.0, "distant-pair", "model mode 1 at 1.313 Hz is near; set window = 1.5 in [pairing]"),
        (0.1, "far-from-model", "none that is like it is near; check its frequency and shape"),
    ],
)
def test_a_window_is_advised_where_a_mode_within_it_is_like_the_measured_one(
    ratio: float, kind: str, remedy: str
) -> None:
    """Two sensors see the first and the third mode nearly alike, and the data are as the third."""
    springs, sensors = ["k"] * 8, {"a": 0, "b": 1}
    model = chain(["k"], [1.0] * 8, [2000.0] * 8, stiffness_parameters=springs, sensors=sensors)
    modes = model.modes(np.ones(1), 8, derivatives=False)
    data = modal_data(ratio * modes.frequency[:1], modes.phi[:, [2]].T, model.sensors)
    one = np.ones(1)
    problem = UpdatingProblem(model, data, (Group("f", frequency="all"),), one / 5, 5 * one, one)
    (found,) = bad_pairs(compare(problem))
    assert (found.kind, found.subject) == (kind, "1")
    assert remedy in str(found)
