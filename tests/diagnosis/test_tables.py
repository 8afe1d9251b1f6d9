"""Mistakes of tables of shapes: copied columns, other units, lost cells, and two of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from modefront._typing import Floats
from modefront.data.modal import modal_data
from modefront.diagnosis.comparison import compare
from modefront.diagnosis.evidence import Fits
from modefront.diagnosis.mistakes import Explanation, odd_sensor, shifted_values
from modefront.diagnosis.search import diagnose
from modefront.diagnosis.state import NOTHING
from modefront.findings.record import Finding
from modefront.models.chain import chain
from modefront.residuals.groups import Group
from modefront.residuals.problem import UpdatingProblem


def problem_of(*spoil: Callable[[Floats], None]) -> UpdatingProblem:
    """Return a study of eight floors with shapes (5, 8) in which something is wrong."""
    names = ["k1"] * 4 + ["k2"] * 4
    model = chain(["k1", "k2"], [1.0] * 8, [2000.0] * 8, stiffness_parameters=names)
    modes, rng = model.modes(np.array([1.1, 0.9]), 5, derivatives=False), np.random.default_rng(3)
    shape = modes.phi.T * (1 + 0.02 * rng.standard_normal((5, 8)))
    for each in spoil:
        each(shape)
    data, one = modal_data(modes.frequency, shape, model.sensors), np.ones(2)
    return UpdatingProblem(model, data, (Group("f", frequency="all"),), one / 5, 5 * one, one)


def pasted(shape: Floats) -> None:
    shape[:, 2] = shape[:, 6]


def pasted_with_the_other_sign(shape: Floats) -> None:
    shape[:, 2] = -shape[:, 6]


def of_another_unit(shape: Floats) -> None:
    shape[:, 3] *= 1000.0


def with_a_lost_cell(shape: Floats) -> None:
    shape[1, 2:-1], shape[1, -1] = shape[1, 3:].copy(), np.nan


def with_lost_cells(shape: Floats) -> None:
    shape[:, 2:-1], shape[:, -1] = shape[:, 3:].copy(), np.nan


def reversed_floor6(shape: Floats) -> None:
    shape[:, 5] *= -1


def exchanged(shape: Floats) -> None:
    shape[:, [1, 5]] = shape[:, [5, 1]]


def of_other_modes(shape: Floats) -> None:
    shape[[1, 3]] = shape[[3, 1]]


def from_the_other_end(shape: Floats) -> None:
    shape[:] = shape[:, ::-1].copy()


def as_magnitudes(shape: Floats) -> None:
    np.abs(shape, out=shape)


def without_signal(shape: Floats) -> None:
    shape[:, 4] = 0.0


def of_noise(shape: Floats) -> None:
    shape[:, 4] = 0.1 * np.random.default_rng(1).standard_normal(len(shape))


def with_a_slip(shape: Floats) -> None:
    shape[2, int(np.abs(shape[2]).argmax())] *= -1


@pytest.mark.parametrize(
    ("spoil", "kind", "text"),
    [
        (of_other_modes, "exchanged-shapes", "the shapes of modes 2 and 4 are exchanged"),
        (from_the_other_end, "opposite-order", "of all sensors are in the opposite order"),
        (as_magnitudes, "unsigned-shapes", "the shapes have no signs"),
        (without_signal, "odd-sensor", "the values of sensor floor5 are near zero in all modes"),
        (of_noise, "odd-sensor", "the values of sensor floor5 are noise"),
        (with_a_slip, "reversed-value", "in mode 3 has the other sign"),
        (pasted, "copied-sensor", "sensor floor3 has the same digits as floor7"),
        pytest.param(
            *(pasted_with_the_other_sign, "copied-sensor", "floor3 has the same digits as floor7"),
            marks=pytest.mark.slow(1),
        ),
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
    (found,) = diagnose(compare(problem_of(spoil)))
    assert kind in {each.kind for each in (found, *found.others)}
    assert text in str(found)


def test_magnitudes_of_which_one_has_a_sign_are_both_named() -> None:
    found = diagnose(compare(problem_of(as_magnitudes, with_a_slip)))
    assert sorted(each.kind for each in found) == ["reversed-value", "unsigned-shapes"]
    assert "in mode 3 has the other sign" in "".join(map(str, found))


def claims(found: Finding) -> set[tuple[str, str]]:
    """Return kind and subject of a finding, and of what may be instead."""
    return {(each.kind, each.subject) for each in (found, *found.others)}


@pytest.mark.slow(3)
@pytest.mark.parametrize(
    ("spoil", "kind", "sensors"),
    [
        ((reversed_floor6, with_lost_cells), "reversed-sensor", ("floor6", "floor5")),
        ((with_lost_cells, exchanged), "exchanged-sensors", ("floor2, floor7", "floor2, floor6")),
    ],
)
def test_a_mistake_beside_lost_cells_is_of_the_columns_as_they_are_mended_or_as_they_are_given(
    spoil: tuple[Callable[[Floats], None], ...], kind: str, sensors: tuple[str, str]
) -> None:
    """Nobody knows which of the two was first."""
    shifted, other = sorted(
        diagnose(compare(problem_of(*spoil))), key=lambda x: x.kind != "shifted-values"
    )
    assert claims(shifted) == {("shifted-values", "all data")}
    assert claims(other) == {(kind, f"{each}, all data") for each in sensors}


def test_values_cost_the_same_whatever_leaves_them_out() -> None:
    fits = Fits(compare(problem_of()))
    plain = fits.plain
    (point,) = fits.fitted([plain])
    old = Explanation(fits, (), plain, point, 0.0)
    *_, noise = odd_sensor(old)
    assert noise.undone(plain).left_out == pytest.approx(5 * NOTHING)
    for mistake in shifted_values(old):
        new = mistake.undone(plain)
        lost = np.isfinite(plain.shape).sum() - np.isfinite(new.shape).sum()
        assert new.left_out == pytest.approx(NOTHING * lost)
        twice = mistake.undone(replace(plain, left_out=np.ones(())))
        assert twice.left_out == pytest.approx(1 + NOTHING * lost)
