"""Mistakes of tables of shapes: copied columns, other units, lost cells."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from modefront._typing import Floats
from modefront.data.modal import modal_data
from modefront.diagnosis.comparison import compare
from modefront.diagnosis.search import diagnose
from modefront.models.chain import chain
from modefront.residuals.groups import Group
from modefront.residuals.problem import UpdatingProblem


def pasted(shape: Floats) -> None:
    shape[:, 2] = shape[:, 6]


def of_another_unit(shape: Floats) -> None:
    shape[:, 3] *= 1000.0


def with_a_lost_cell(shape: Floats) -> None:
    shape[1, 2:-1], shape[1, -1] = shape[1, 3:].copy(), np.nan


@pytest.mark.parametrize(
    ("spoil", "kind", "text"),
    [
        (pasted, "copied-sensor", "sensor floor3 has the same digits as floor7"),
        (of_another_unit, "sensor-factor", "floor4 in all data are 1e+03 times what the others"),
        (
            with_a_lost_cell,
            "shifted-values",
            "as if a value were lost at sensor floor3",
        ),
    ],
)
def test_the_table_is_said_to_be_wrong_and_where(
    spoil: Callable[[Floats], None], kind: str, text: str
) -> None:
    names = ["k1"] * 4 + ["k2"] * 4
    model = chain(["k1", "k2"], [1.0] * 8, [2000.0] * 8, stiffness_parameters=names)
    modes, rng = model.modes(np.array([1.1, 0.9]), 5, derivatives=False), np.random.default_rng(3)
    shape = modes.phi.T * (1 + 0.02 * rng.standard_normal((5, 8)))
    spoil(shape)
    data, one = modal_data(modes.frequency, shape, model.sensors), np.ones(2)
    groups = (Group("f", frequency="all"),)
    (found,) = diagnose(compare(UpdatingProblem(model, data, groups, one / 5, 5 * one, one)))
    assert kind in {each.kind for each in (found, *found.others)}
    assert text in str(found)


@pytest.mark.slow(3)
def test_a_reversed_sensor_beside_a_lost_cell_is_named_by_the_column_that_is_mended() -> None:
    """All shapes lack a value and the rest moved: the column with the wrong sign is another's."""
    names = ["k1"] * 4 + ["k2"] * 4
    model = chain(["k1", "k2"], [1.0] * 8, [2000.0] * 8, stiffness_parameters=names)
    modes, rng = model.modes(np.array([1.1, 0.9]), 5, derivatives=False), np.random.default_rng(3)
    shape = modes.phi.T * (1 + 0.02 * rng.standard_normal((5, 8)))
    shape[:, 5] *= -1
    shape[:, 2:-1], shape[:, -1] = shape[:, 3:].copy(), np.nan
    data, one = modal_data(modes.frequency, shape, model.sensors), np.ones(2)
    groups = (Group("f", frequency="all"),)
    found = diagnose(compare(UpdatingProblem(model, data, groups, one / 5, 5 * one, one)))
    assert {(x.kind, x.subject) for x in found} == {
        ("shifted-values", "all data"),
        ("reversed-sensor", "floor6, all data"),
    }
