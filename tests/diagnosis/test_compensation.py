"""The search over mistakes: what other parameters make up for is found nevertheless."""

from __future__ import annotations

import numpy as np
import pytest

from modefront.data.modal import modal_data
from modefront.diagnosis.comparison import compare
from modefront.diagnosis.search import diagnose
from modefront.models.chain import chain
from modefront.residuals.groups import Group
from modefront.residuals.problem import UpdatingProblem


@pytest.mark.slow(2)
def test_the_right_power_of_ten_is_tried_though_other_parameters_have_made_up_for_it() -> None:
    """One of ten springs is 100 times too stiff: where the others have been fitted, 1 looks bad."""
    rng, n = np.random.default_rng(2), 9
    names = [f"k{i + 1}" for i in range(n + 1)]
    model = chain(names, [1.0] * n, [1e4] * (n + 1), stiffness_parameters=names)
    modes = model.modes(np.exp(0.25 * rng.standard_normal(n + 1)), 5, derivatives=False)
    frequency = modes.frequency * np.exp(0.01 * rng.standard_normal(5))
    scatter = 0.04 * np.abs(modes.phi).mean() * rng.standard_normal((5, n))
    data = modal_data(frequency, modes.phi.T + scatter, model.sensors)
    unit = np.ones(n + 1)
    unit[4] = 100.0
    groups = (Group("frequencies", frequency="all"), Group("shapes", shape="all"))
    problem = UpdatingProblem(model, data, groups, unit / 5, 5 * unit, unit)
    (found,) = diagnose(compare(problem))
    assert (found.kind, found.subject) == ("nominal-value", "k5")
    assert found.numbers["better"] == pytest.approx(1.0)
