"""Pairs of modes that are far apart: what the search says of them, and when a window mends them."""

from __future__ import annotations

import numpy as np
import pytest

from modefront._typing import Floats
from modefront.data.modal import modal_data
from modefront.diagnosis.comparison import compare
from modefront.diagnosis.search import diagnose
from modefront.findings.record import Finding
from modefront.models.chain import chain
from modefront.models.matrices import MatrixModel
from modefront.residuals.groups import Group
from modefront.residuals.problem import UpdatingProblem


def chain_of(sensors: dict[str, int] | None = None) -> MatrixModel:
    names = ["k1"] * 4 + ["k2"] * 4
    return chain(["k1", "k2"], [1.0] * 8, [2000.0] * 8, stiffness_parameters=names, sensors=sensors)


def mistakes(model: MatrixModel, frequency: Floats, phi: Floats) -> list[Finding]:
    data, one = modal_data(frequency, phi.T, model.sensors), np.ones(2)
    groups = (Group("f", frequency="all"),)
    return diagnose(compare(UpdatingProblem(model, data, groups, one / 5, 5 * one, one)))


def test_a_window_is_advised_where_a_mode_within_it_is_like_the_measured_one() -> None:
    """Two sensors see the first and the third mode nearly alike, and the data are as the third."""
    model = chain_of({"a": 0, "b": 1})
    modes = model.modes(np.ones(2), 8, derivatives=False)
    (found,) = mistakes(model, modes.frequency[:1], modes.phi[:, [2]])
    assert (found.kind, found.subject) == ("distant-pair", "1")
    assert "model mode 1 at 1.313 Hz is near; set window = 1.5 in [pairing]" in str(found)


@pytest.mark.parametrize(("factor", "looks"), [(0.1, ", and 10 times it would fit;"), (7.0, ";")])
def test_a_frequency_of_which_the_shape_is_far_away_is_said_to_be_wrong(
    factor: float, looks: str
) -> None:
    model = chain_of()
    modes = model.modes(np.ones(2), 5, derivatives=False)
    frequency = modes.frequency.copy()
    frequency[1] *= factor
    (found,) = mistakes(model, frequency, modes.phi)
    assert (found.kind, found.subject) == ("far-from-model", "2")
    assert f"none that is like it is near{looks} check its frequency and shape" in str(found)


def test_a_mode_beyond_the_candidates_is_named_with_what_is_to_be_set() -> None:
    model = chain_of()
    modes = model.modes(np.ones(2), 8, derivatives=False)
    (found,) = mistakes(model, modes.frequency[[0, 7]], modes.phi[:, [0, 7]])
    assert (found.kind, found.subject) == ("beyond-candidates", "2")
    assert "resembles model mode 8" in str(found)
    assert "set spare = 6 in [pairing]" in str(found)


@pytest.mark.parametrize(
    ("frequency", "kind", "text"),
    [
        (60.0, "outside-model", "is outside what the model has: its 8 lowest modes end at 14 Hz;"),
        (9.0, "foreign-mode", "at 9 Hz resembles none of the model's"),
    ],
)
def test_a_mode_that_the_model_does_not_have(frequency: float, kind: str, text: str) -> None:
    model = chain_of()
    modes = model.modes(np.ones(2), 5, derivatives=False)
    f, phi = np.append(modes.frequency[:4], frequency), modes.phi.copy()
    phi[:, 4] = [1.0, 1.0, -1.0, -1.0, 1.0, 1.0, 1.0, 1.0]
    (found,) = mistakes(model, f, phi)
    assert found.kind == kind
    assert text in str(found)


def test_a_mode_that_no_model_mode_is_like_is_said_though_its_cause_is_not_sure() -> None:
    """Four values may be another mode's, or moved to other columns."""
    model = chain_of({"a": 1, "b": 3, "c": 5, "d": 7})
    modes = model.modes(np.ones(2), 4, derivatives=False)
    phi, v = modes.phi.copy(), np.random.default_rng(22).standard_normal(4)
    phi[:, 3] = v - phi[:, 3] * (v @ phi[:, 3]) / (phi[:, 3] @ phi[:, 3])
    (found,) = mistakes(model, modes.frequency, phi)
    assert (found.kind, found.subject) == ("poor-pair", "4")
    assert mistakes(model, modes.frequency, modes.phi) == []
