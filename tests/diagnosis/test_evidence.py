"""Parts of the cost of an explanation against closed forms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.optimize
import scipy.sparse
import scipy.stats

from modefront._typing import Floats
from modefront.data.modal import modal_data
from modefront.diagnosis.evidence import State, point, quick
from modefront.diagnosis.measured import SPREAD, Measured, measured, median, scaled
from modefront.models.chain import chain


def test_the_cost_of_residuals_is_that_of_students_distribution() -> None:
    """The scale is the one that a search by scipy finds."""
    r = 0.05 * np.random.default_rng(0).standard_t(4, 50)
    weight = np.linspace(0.5, 1.0, 50)

    def cost(log: float) -> float:
        densities = scipy.stats.t.logpdf(r, 4, scale=np.exp(log)) - scipy.stats.t.logpdf(0, 4)
        return float(-densities @ weight) + (log - np.log(0.08)) ** 2 / (2 * SPREAD**2)

    result = scipy.optimize.minimize_scalar(cost, bounds=(-6.0, 0.0), method="bounded")
    least, sigma = scaled(r, 0.08, 4.0, weight)
    assert least == pytest.approx(result.fun, abs=0.1)
    assert sigma == pytest.approx(np.exp(result.x), rel=0.02)


def test_medians_pass_over_what_is_not_measured() -> None:
    values = np.array(
        [[1.0, 5.0, np.nan, 2.0], [3.0, np.nan, np.nan, 8.0], [2.0, 7.0, np.nan, 4.0]]
    )
    np.testing.assert_array_equal(median(values), [2.0, 6.0, np.nan, 4.0])


def data_of(shapes: Floats) -> Measured:
    f = np.tile([1.0, 2.0], (len(shapes), 1))
    return measured(modal_data(f, shapes, ("a", "b", "c")))


def test_sets_that_differ_in_scale_and_gaps_have_the_same_shape() -> None:
    shape = np.array([[1.0, 2.0, 3.0], [2.0, 1.0, -2.0]])
    sets = np.array([shape, -3.0 * shape, 0.1 * shape])
    sets[0, 0, 0] = sets[1, 1, 2] = np.nan
    mean = data_of(sets).mean
    size = np.sqrt((shape**2).mean(axis=1, keepdims=True))
    np.testing.assert_allclose(np.abs(mean), np.abs(shape / size), rtol=1e-3)


def test_noise_between_sets_does_not_depend_on_their_order_or_sign() -> None:
    rng = np.random.default_rng(1)
    shape = np.array([[1.0, 2.0, 3.0], [2.0, 1.0, -2.0]])
    sets = shape + 0.03 * rng.standard_normal((3, 2, 3))
    noise = data_of(sets).noise
    assert data_of(-2 * sets[::-1]).noise == pytest.approx(noise, abs=1e-3)
    wrong = sets.copy()
    wrong[1, :, 2] *= -1
    assert data_of(wrong).noise > noise + 10


def test_a_fit_finds_the_structure_from_which_the_data_come() -> None:
    names = ("k1", "k2", "k3")
    model = chain(
        names, [1.0] * 6, [100.0] * 6, stiffness_parameters=[names[i // 2] for i in range(6)]
    )
    theta, unit = np.array([1.2, 0.8, 1.1]), np.ones(3)
    modes = model.modes(theta, 4, derivatives=False)
    data = measured(modal_data(modes.frequency, modes.phi.T, model.sensors))
    state = State(
        data, np.zeros(4, dtype=bool), 4, model.selection, None, unit, 0.2 * unit, 5 * unit
    )
    result = quick(model, model, 4, state).fit(state, unit)
    assert result is not None
    np.testing.assert_allclose(result.theta, theta, rtol=0.03)
    selection = model.selection.toarray()
    selection[2] *= -1
    reversed_ = replace(state, selection=scipy.sparse.csr_array(selection))
    whole = model.full_modes(theta, 4).Phi
    assert point(reversed_, theta, modes.frequency, selection @ whole).cost > result.cost + 10
