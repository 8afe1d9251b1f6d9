"""Modes that change places along a front."""

from __future__ import annotations

import numpy as np
import pytest

from modefront import Group, UpdatingProblem, matrices, modal_data, solve, updating_problem
from modefront.results.remarks import findings_of

pytestmark = pytest.mark.usefixtures("short_chains")

SENSORS = ("a", "b", "c")


def crossing() -> UpdatingProblem:
    """Three masses on springs of their own, lam = (s, 2 s, 3): the last two cross at s = 1.5.

    The frequency of the first one asks for s = 1, that of the second one for s = 2.
    """
    model = matrices(
        ("s",),
        {"base": np.diag([0.0, 0.0, 3.0]), "s": np.diag([1.0, 2.0, 0.0])},
        {"base": np.eye(3)},
        {"a": 0, "b": 1, "c": 2},
    )
    frequency = np.sqrt([1.0, 4.0, 3.0]) / (2 * np.pi)
    groups = (Group("first", frequency=(1,)), Group("second", frequency=(2,), shape=(2,)))
    data = modal_data(frequency, np.eye(3), SENSORS)
    return updating_problem(model, data, groups, {"s": (0.5, 3.0)}, {"s": 0.7})


@pytest.mark.parametrize("s", [1.2, 1.5 - 1e-6, 1.5 + 1e-6, 1.8])
def test_residuals_do_not_see_modes_cross(s: float) -> None:
    result = crossing().evaluate(np.array([s]))
    u = np.sqrt([s, s / 2])
    np.testing.assert_allclose(result.J, (u - 1) ** 2, rtol=1e-12)
    np.testing.assert_allclose(result.dJ[:, 0], (u - 1) * u / s, rtol=1e-9)
    assert result.quantities["paired_mode"].tolist() == [1, 2 + (s > 1.5), 3 - (s > 1.5)]


def test_modes_that_change_places_along_the_front_are_reported() -> None:
    data = solve(crossing(), points=8).dataset
    assert bool(data["converged"].all())
    s = data["theta"].values[:8, 0]
    assert (np.diff(s) > 0).all()
    assert s[[0, -1]] == pytest.approx([1, 2], abs=1e-6)
    last = int((s < 1.5).sum())
    text = list(map(str, findings_of(data, full=True)))
    for measured, before, after in ((2, 2, 3), (3, 3, 2)):
        assert (
            f"measured mode {measured} is paired with model mode {before} at nbi-{last} "
            f"and {after} at nbi-{last + 1}"
        ) in text
    assert (data["mac"].values > 1 - 1e-9).all()
