"""Parts of the cost of an explanation against closed forms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.optimize
import scipy.stats

from modefront._typing import Floats
from modefront.data.modal import ModalData, modal_data
from modefront.diagnosis.comparison import compare
from modefront.diagnosis.evidence import Fits, step
from modefront.diagnosis.mistakes import Explanation, other_quantity
from modefront.diagnosis.state import SPREAD, State, median, scaled, stacked
from modefront.models.chain import chain
from modefront.residuals.groups import Group
from modefront.residuals.problem import UpdatingProblem


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


def state_of(shapes: Floats) -> State:
    f, one = np.tile([1.0, 2.0], (len(shapes), 1)), np.ones(1)
    data = modal_data(f, shapes, ("a", "b", "c"))
    places = {"a": 0, "b": 1, "c": 2}
    model = chain(["k"], [1.0] * 3, [1.0] * 3, stiffness_parameters=["k"] * 3, sensors=places)
    problem = UpdatingProblem(model, data, (Group("f", frequency="all"),), one / 5, 5 * one, one)
    return Fits(compare(problem)).plain


def test_sets_that_differ_in_scale_and_gaps_have_the_same_shape() -> None:
    shape = np.array([[1.0, 2.0, 3.0], [2.0, 1.0, -2.0]])
    sets = np.array([shape, -3.0 * shape, 0.1 * shape])
    sets[0, 0, 0] = sets[1, 1, 2] = np.nan
    mean = state_of(sets).mean
    size = np.sqrt((shape**2).mean(axis=1, keepdims=True))
    np.testing.assert_allclose(np.abs(mean), np.abs(shape / size), rtol=1e-3)


def test_noise_between_sets_does_not_depend_on_their_order_or_sign() -> None:
    rng = np.random.default_rng(1)
    shape = np.array([[1.0, 2.0, 3.0], [2.0, 1.0, -2.0]])
    sets = shape + 0.03 * rng.standard_normal((3, 2, 3))
    noise = state_of(sets).noise
    assert state_of(-2 * sets[::-1]).noise == pytest.approx(noise, abs=1e-3)
    wrong = sets.copy()
    wrong[1, :, 2] *= -1
    assert state_of(wrong).noise > noise + 10


def fits_of(theta: Floats, scatter: float = 0.0) -> Fits:
    """Return fits of a chain of six masses to four modes at three parameters."""
    names = [f"k{1 + i // 2}" for i in range(6)]
    model = chain(["k1", "k2", "k3"], [1.0] * 6, [100.0] * 6, stiffness_parameters=names)
    modes, unit = model.modes(theta, 4, derivatives=False), np.ones(3)
    shape = modes.phi.T + scatter * np.random.default_rng(5).standard_normal((4, 6))
    data, groups = modal_data(modes.frequency, shape, model.sensors), (Group("f", frequency="all"),)
    return Fits(compare(UpdatingProblem(model, data, groups, 0.2 * unit, 5 * unit, unit)))


def test_a_fit_finds_the_structure_from_which_the_data_come() -> None:
    theta = np.array([1.2, 0.8, 1.1])
    fits = fits_of(theta)
    (result,) = fits.fitted([fits.plain])
    found = fits.theta(fits.plain, result.x)
    np.testing.assert_allclose(found[:3], theta, rtol=0.03)
    assert found[3] == 1.0, "no member is scaled"
    along = fits.plain.along.copy()
    along[2] *= -1
    both = stacked([fits.plain, replace(fits.plain, along=along)])
    right, reversed_ = fits.at(both, np.stack([result.x] * 2)).ahead
    assert right == pytest.approx(result.cost, abs=0.1)
    assert reversed_ > result.cost + 10


def test_parameters_are_the_same_beside_other_nominal_values() -> None:
    fits = fits_of(np.ones(3))
    fits.unit, plain = np.array([0.0, 2.0, 0.0]), fits.plain
    x = np.array([0.3, -0.5, 0.1, 0.0])
    off = replace(plain, start=np.array([10.0, 0.0, 0.1, 1.0]))
    np.testing.assert_allclose(fits.x(plain, fits.theta(plain, x)), x)
    same = fits.theta(off, fits.x(off, fits.theta(plain, x)))
    np.testing.assert_allclose(same, fits.theta(plain, x))


def test_the_cost_ahead_is_between_those_before_and_after_a_step() -> None:
    """The parabola lies above the cost, as its weights are those of Student's distribution."""
    fits = fits_of(np.array([1.2, 0.8, 1.1]), 0.05)
    (best,), plain = fits.fitted([fits.plain]), stacked([fits.plain])
    near = fits.at(plain, best.x[None] + np.array([0.1, -0.1, 0.1, 0.0])).of(0)
    after = fits.at(plain, near.x[None] + step(near.g, near.H, 0.0)).of(0)
    assert near.cost > after.cost + 0.5
    assert after.cost < near.ahead < (after.cost + near.cost) / 2


def test_explanations_cost_the_same_together_and_alone() -> None:
    """Several data sets with gaps, and modes without a shape, in one batch."""
    model = chain(["k"], [1.0] * 6, [100.0] * 6, stiffness_parameters=["k"] * 6)
    modes, rng = model.modes(np.ones(1), 4, derivatives=False), np.random.default_rng(4)
    shape = modes.phi.T + 0.03 * rng.standard_normal((3, 4, 6))
    shape[0, 1, 2] = shape[2, 3, 5] = np.nan
    f = modes.frequency * np.exp(0.01 * rng.standard_normal((3, 4)))
    nothing = np.full(f.shape, np.nan)
    sets = ("1", "2", "3"), (1, 2, 3, 4), model.sensors
    data = ModalData(*sets, f, nothing, shape, nothing, np.full(shape.shape, np.nan))
    one, groups = np.ones(1), (Group("f", frequency="all"),)
    fits = Fits(compare(UpdatingProblem(model, data, groups, 0.2 * one, 5 * one, one)))
    turned, without = shape * np.array([1.0, 1, 1, -1, 1, 1]), shape.copy()
    without[:, 1] = np.nan
    states = [
        fits.plain,
        replace(fits.plain, shape=turned),
        replace(fits.plain, shape=without),
        replace(fits.plain, start=np.array([3.0, 1.0])),
    ]
    xs, every = np.arange(4.0)[:, None] * [0.1, 0.0], stacked(states)
    together, some = fits.at(every, xs), fits.at(every.of(np.array([1, 3])), xs[[1, 3]])
    alone = [fits.at(stacked([state]), x[None]).of(0) for state, x in zip(states, xs, strict=True)]
    for name in ("cost", "ahead", "H"):
        values = np.array([getattr(x, name) for x in alone])
        np.testing.assert_allclose(getattr(together, name), values, rtol=1e-12)
        np.testing.assert_allclose(getattr(some, name), values[[1, 3]], rtol=1e-12)
    assert np.unique(together.cost.round(3)).size == 4


def test_explanations_start_from_the_better_of_two_starts() -> None:
    """Where the model has no modes, a cost is infinite."""
    fits = fits_of(np.array([1.2, 0.8, 1.1]))
    fits.unit, plain, x = np.ones(3), fits.plain, np.array([0.2, -0.2, 0.1, 0.0])
    states = [plain, replace(plain, start=np.array([-5.0, -5.0, -5.0, 1.0]))]
    ((_, begun),) = fits.begun(states, (plain, x))
    np.testing.assert_allclose(begun.x[0], x)
    assert np.isinf(begun.ahead).tolist() == [False, True]
    costs = [float(x.cost) for x in fits.fitted(states, (plain, x))]
    assert costs[0] <= begun.cost[0] < costs[1] == np.inf


def test_values_that_scatter_little_are_no_more_probable_as_eigenvalues() -> None:
    """Roots scatter half as much, and their density is half of theirs."""
    names = ["k"] * 3
    model = chain(["k"], [1.0] * 3, [1.0] * 3, stiffness_parameters=names)
    modes, rng = model.modes(np.ones(1), 3, derivatives=False), np.random.default_rng(6)
    f = modes.frequency * np.exp(0.003 * rng.standard_normal((40, 3)))
    data = modal_data(f, np.tile(modes.phi.T, (40, 1, 1)), model.sensors)
    one, groups = np.ones(1), (Group("f", frequency="all"),)
    fits = Fits(compare(UpdatingProblem(model, data, groups, one / 5, 5 * one, one)))
    point = fits.at(stacked([fits.plain]), np.zeros((1, 2))).of(0)
    for mistake in other_quantity(Explanation(fits, (), fits.plain, point, 0.0)):
        assert mistake.undone(fits.plain).noise > fits.plain.noise - 1e-6
