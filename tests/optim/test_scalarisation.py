"""Scalarisations: their derivatives, and the programmes that they stand for."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from modefront.optim.scalarisation import (
    MARGIN,
    STEEP,
    Constrained,
    LogSum,
    Scalarisation,
    achievement,
    below,
    total,
    weighted,
)

ONES = np.ones(2)
LEVEL = below(np.array([0.0, 1 / 5]), np.array([1 / 2, 0.0]), 0.3 / 2)
PROGRAMMES = [
    weighted(np.array([1.0, 3.0])),
    LEVEL,
    achievement(1e-3 * ONES, np.eye(2), np.array([0.2, 0.1])),
    LogSum(np.array([3.0, 9.0])),
    LogSum(np.array([3.0, 9.0]), np.array([0.5, 0.1])),
    LogSum(np.array([3.0, 0.0]), np.array([0.5, 1.0]), linear=np.array([0.0, 1.0])),
    Constrained(LogSum(np.array([3.0])), 2.0, 0.5),
]


@pytest.mark.parametrize("programme", PROGRAMMES)
@given(st.floats(0.1, 5.0), st.floats(0.1, 5.0))
def test_derivatives_are_those_of_the_value(programme: Scalarisation, x: float, y: float) -> None:
    J, h = np.array([x, y]), 1e-6
    slopes = [
        (programme.value(J + h * e) - programme.value(J - h * e)) / (2 * h) for e in np.eye(2)
    ]
    assert programme.gradient(J) == pytest.approx(slopes, rel=1e-6)
    bends = [
        (programme.gradient(J + h * e) - programme.gradient(J - h * e)) / (2 * h) for e in np.eye(2)
    ]
    assert programme.hessian(J) == pytest.approx(np.array(bends), rel=1e-5, abs=1e-9)


def test_a_penalty_begins_where_a_level_is_exceeded() -> None:
    def penalty(x: float) -> float:
        return float(LEVEL.maximised.at(np.array([x, 7.0])).max())

    assert penalty(0.2) == pytest.approx(0.0)
    assert penalty(0.3) == pytest.approx(0.0, abs=1e-12)
    assert penalty(0.5) == pytest.approx(0.1 * STEEP), "over the scale"
    assert LEVEL.value(np.array([0.3, 7.0])) == pytest.approx(7.0 / 5)


def test_an_achievement_is_the_greatest_of_its_functions() -> None:
    J, d = np.array([0.4, 0.9]), np.array([0.1, 0.2])
    assert achievement(ONES, np.eye(2), d).maximised.at(J) == pytest.approx([0.3, 0.7])
    assert achievement(ONES, np.eye(2), d, 10.0).maximised.at(J) == pytest.approx([3.0, 7.0])
    assert weighted(ONES).maximised.at(J).size == 0


@pytest.mark.parametrize(
    "programme", [weighted(np.array([1.0, 3.0])), PROGRAMMES[2], PROGRAMMES[3]]
)
def test_a_constraint_is_a_steep_penalty_over_a_unit(programme: Scalarisation) -> None:
    within = Constrained(programme, 2.0, 0.5)
    for g in (-0.7, -0.5 * MARGIN, 0.0, 0.02):
        J = np.array([0.4, 0.9, g])
        penalty = STEEP * max(0.0, g / 0.5 + MARGIN)
        assert total(within, J) == pytest.approx(total(programme, J[:2]) / 2 + penalty)
    assert within.maximised.slope == STEEP
    assert within.gradient(J) == pytest.approx([*programme.gradient(J[:2]) / 2, 0.0])


def test_a_sum_of_logarithms_has_the_weights_a_over_J_and_bounded_ones_with_a_floor() -> None:
    a, J, b = np.array([3.0, 9.0]), np.array([0.5, 2.0]), np.array([0.5, 1.0])
    assert LogSum(a).gradient(J) == pytest.approx(a / J)
    assert LogSum(a, b).gradient(J) == pytest.approx(a / (J + b))
    assert (LogSum(a, b).gradient(0 * J) <= a / b).all()
    assert LogSum(a, 0.0, np.array([0.6, 0.0])).value(J) == -np.inf, "an objective vanishes"
    assert LogSum(a).value(np.array([0.5, 0.0])) == -np.inf


def test_the_logarithm_of_an_objective_that_vanishes_has_finite_derivatives() -> None:
    f = LogSum(np.array([3.0, 9.0]))
    J = np.array([0.0, 1e-300])
    assert np.isfinite(f.gradient(J)).all()
    assert np.isfinite(f.hessian(J)).all()
