"""The published three-story building, and what must not change its front.

Christodoulou et al. (2008, doi:10.1016/j.cma.2008.04.010): least MAC values, dominated points and
the place of the optimally weighted model are as printed there. Of the greatest frequency errors
some differ from the printed ones (6.0, 2.7, 4.9 and 5.1, 2.3, 3.1 %); what is asserted here is
what the chain of the printed masses and stiffness gives.
"""

from functools import cache

import numpy as np
import pytest
import xarray as xr

import modefront as mf
from modefront._typing import Floats

FREQUENCY = {"M0": [4.646, 13.81, 19.48], "M1": [3.908, 11.57, 16.31]}
SHAPE = {
    "M0": [[0.4561, 0.8069, 1.0], [1.0, 0.3009, -0.9026], [-0.7801, 1.0, -0.6448]],
    "M1": [[0.4408, 0.8219, 1.0], [1.0, 0.3528, -0.8709], [-0.7892, 1.0, -0.5708]],
}
FLOORS = ("floor1", "floor2", "floor3")
NAMES = ("k1", "k2", "k3")
GROUPS = (mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all"))
WITHOUT = mf.NoisePrior(weight=0)
"""The published study expects nothing of the errors: there is no posterior to draw from."""


def problem_of(
    model: str,
    *,
    names: tuple[str, ...] = NAMES,
    stiffness: float = 1.0,
    mass: float = 1.0,
    shape_scales: tuple[float, ...] = (1.0, 1.0, 1.0),
    start: float = 1.0,
) -> mf.UpdatingProblem:
    """Return the problem with parameters in any order and matrices and shapes in any scale."""
    added = 9.5 * mass if model == "M1" else 0.0
    chain = mf.chain(
        names,
        [22.6 * mass, 22.6 * mass, 17.176 * mass],
        [84763.8 * stiffness] * 3,
        added_masses=[added] * 3,
        stiffness_parameters=NAMES,
    )
    shape = np.array(SHAPE[model]) * np.array(shape_scales)[:, None]
    data = mf.modal_data(np.array(FREQUENCY[model]), shape, FLOORS)
    bounds = dict.fromkeys(names, (0.2, 5.0))
    return mf.updating_problem(chain, data, GROUPS, bounds, dict.fromkeys(names, start))


def solved(problem: mf.UpdatingProblem, seed: int = 1) -> xr.Dataset:
    how = mf.Pareto(points=20, programme="equations")
    return mf.solve(problem, pareto=how, seed=seed, noise=WITHOUT).dataset


@cache
def results(model: str) -> xr.Dataset:
    return solved(problem_of(model))


def nbi(data: xr.Dataset) -> xr.Dataset:
    return data.isel(point=data["kind"].values == "front")


def errors(data: xr.Dataset) -> Floats:
    front = nbi(data)
    relative = np.abs(front["frequency"].values / front["measured_frequency"].values - 1)
    return 100 * relative.max(axis=0)


@pytest.mark.parametrize(
    ("model", "mac", "frequency_errors", "dominated"),
    [
        ("M0", [0.990, 0.863, 0.851], [6.12, 2.80, 4.20], [6, 7]),
        ("M1", [0.997, 0.895, 0.884], [5.15, 2.74, 3.22], []),
    ],
)
def test_the_published_front(
    model: str, mac: list[float], frequency_errors: list[float], dominated: list[int]
) -> None:
    data = results(model)
    front = nbi(data)
    assert front.sizes["point"] == 20
    assert bool(data["converged"].all())
    assert front["mac"].min("point").values == pytest.approx(mac, abs=0.002)
    assert errors(data) == pytest.approx(frequency_errors, abs=0.05)
    among = front["dominated_among_front"].values
    assert (np.flatnonzero(among) + 1).tolist() == dominated
    # The start of the second branch of M0 dominates point 8 as well.
    known = [*dominated, 8] if model == "M0" else []
    assert (np.flatnonzero(~front["pareto"].values) + 1).tolist() == known
    labels = data["label"].values.tolist()
    optimal = data["theta"].values[labels.index("optimal-weights")]
    distance = np.linalg.norm(front["theta"].values - optimal, axis=1)
    assert distance.argmin() == 19
    assert distance[19] < 0.005


def test_the_gap_of_M0_ends_at_the_second_minimum_of_the_frequencies() -> None:
    data = results("M0")
    assert data["end_label"].values.tolist() == ["end-1", "start-2"]
    end, start = data["end_objective"].values
    assert start == pytest.approx([3.2440e-4, 0.26556], rel=1e-4)
    assert end[0] == pytest.approx(start[0], rel=1e-6)
    assert end[1] > start[1]
    minima = data["minimum_objective"].values[data["minimum_of"].values == "frequencies"]
    assert len(minima) >= 2
    assert np.abs(minima / start - 1).max(axis=1).min() < 1e-4
    # Point 8 is dominated by no other point, but by the start of the second piece.
    assert data["piece"].values[:20].tolist() == [1] * 5 + [0] * 3 + [2] * 12


def test_the_optimal_weights_of_M0_are_regular_and_confirmed() -> None:
    data = results("M0")
    assert data["exact"].values.tolist() == [True, False]
    labels = data["label"].values.tolist()
    position = labels.index("optimal-weights")
    J, w = data["objective"].values[position], data["weight"].values[position]
    assert w * J == pytest.approx([3, 9], rel=1e-9)
    iterated = data["minimum_theta"].values[data["minimum_of"].values == "iterated-weights"][0]
    assert iterated == pytest.approx(data["theta"].values[position], abs=1e-5)


@pytest.mark.slow(3)
def test_a_search_costs_less_where_more_doubt_is_allowed() -> None:
    for model in ("M0", "M1"):
        data = results(model)
        assert data.attrs["front_evaluations"] < data.attrs["model_evaluations"] < 5000
        quick = mf.solve(
            problem_of(model), points=20, seed=1, search=mf.Search(doubt=0.5), noise=WITHOUT
        ).dataset
        assert quick.attrs["model_evaluations"] < data.attrs["model_evaluations"]


@pytest.mark.slow(2)
@pytest.mark.parametrize("model", ["M0", "M1"])
def test_global_optima_do_not_depend_on_the_seed(model: str) -> None:
    expected = results(model)
    labels = ["edge-frequencies", "edge-shapes", "equal-weights", "optimal-weights"]
    for seed in (11, 12):
        result = mf.solve(problem_of(model), points=2, seed=seed, noise=WITHOUT).dataset
        for label in labels:
            first, other = (
                data["theta"].values[data["label"].values.tolist().index(label)]
                for data in (result, expected)
            )
            assert first == pytest.approx(other, abs=2e-5), (label, seed)


def compare(result: xr.Dataset, expected: xr.Dataset, order: list[int] | None = None) -> None:
    order = order or [0, 1, 2]
    ours, theirs = nbi(result), nbi(expected)
    assert ours["theta"].values == pytest.approx(theirs["theta"].values[:, order], abs=2e-5)
    assert ours["pareto"].values.tolist() == theirs["pareto"].values.tolist()
    J, expected_J = ours["objective"].values, theirs["objective"].values
    assert (np.abs(J - expected_J) <= 1e-6 * np.ptp(expected_J, axis=0)).all()
    for label in ("optimal-weights", "equal-weights"):
        first, other = (
            data["theta"].values[data["label"].values.tolist().index(label)]
            for data in (result, expected)
        )
        assert first == pytest.approx(other[order], abs=2e-5)


@pytest.mark.slow(2)
@pytest.mark.parametrize("model", ["M0", "M1"])
def test_the_order_of_the_parameters_does_not_matter(model: str) -> None:
    other = solved(problem_of(model, names=("k3", "k1", "k2")), 2)
    compare(other, results(model), [2, 0, 1])


@pytest.mark.slow(2)
@pytest.mark.parametrize("model", ["M0", "M1"])
def test_units_do_not_matter(model: str) -> None:
    # Tonnes and kilonewtons a metre: the frequencies stay.
    other = solved(problem_of(model, stiffness=1e-3, mass=1e-3), 3)
    compare(other, results(model))


@pytest.mark.slow(3)
def test_sign_and_scale_of_measured_shapes_do_not_matter() -> None:
    other = solved(problem_of("M0", shape_scales=(-1.0, 250.0, -3e-4)), 4)
    compare(other, results("M0"))


@pytest.mark.slow(2)
def test_scaling_the_model_scales_the_parameters() -> None:
    # Stiffnesses and masses twice as large, each alone: theta makes up for it.
    problem = problem_of("M0", stiffness=2.0)
    wider = mf.UpdatingProblem(
        problem.model, problem.data, GROUPS, problem.lower / 2, problem.upper / 2, problem.start / 2
    )
    result = solved(wider, 5)
    expected = nbi(results("M0"))["theta"].values
    assert 2 * nbi(result)["theta"].values == pytest.approx(expected, abs=2e-5)
    heavier = problem_of("M0", mass=2.0)
    wider = mf.UpdatingProblem(
        heavier.model, heavier.data, GROUPS, 2 * problem.lower, 2 * problem.upper, 2 * problem.start
    )
    result = solved(wider, 6)
    assert nbi(result)["theta"].values / 2 == pytest.approx(expected, abs=2e-5)


def test_matrices_give_the_same_front_as_the_chain() -> None:
    k, m = 84763.8, np.diag([22.6, 22.6, 17.176])
    stiffness = {
        "k1": k * np.diag([1.0, 0, 0]),
        "k2": k * np.array([[1.0, -1, 0], [-1, 1, 0], [0, 0, 0]]),
        "k3": k * np.array([[0.0, 0, 0], [0, 1, -1], [0, -1, 1]]),
    }
    sensors = {name: i for i, name in enumerate(FLOORS)}
    model = mf.matrices(NAMES, stiffness, {"base": m}, sensors)
    data = mf.modal_data(np.array(FREQUENCY["M0"]), np.array(SHAPE["M0"]), FLOORS)
    problem = mf.updating_problem(
        model, data, GROUPS, dict.fromkeys(NAMES, (0.2, 5.0)), dict.fromkeys(NAMES, 1.0)
    )
    compare(solved(problem), results("M0"))


@pytest.mark.slow(2)
def test_single_modes_as_groups() -> None:
    groups = [
        mf.Group("mode 1", frequency=[1], shape=[1]),
        mf.Group("modes 2 and 3", frequency=[2, 3], shape=[2, 3]),
    ]
    base = problem_of("M1")
    problem = mf.UpdatingProblem(
        base.model, base.data, tuple(groups), base.lower, base.upper, base.start
    )
    data = mf.solve(problem, points=6, seed=1, noise=WITHOUT).dataset
    assert data["properties"].values.tolist() == [4, 8]
    assert bool(data["converged"].all())


def test_perfect_data_are_a_front_of_one_point() -> None:
    base = problem_of("M0")
    modes = base.model.modes(np.array([1.2, 0.9, 1.1]), 3)
    data = mf.modal_data(modes.frequency, modes.phi.T, FLOORS)
    problem = mf.UpdatingProblem(base.model, data, GROUPS, base.lower, base.upper, base.start)
    result = solved(problem)
    assert result.attrs["front_is_a_point"]
    assert "front" not in result["kind"].values
    edge = result["theta"].values[result["label"].values.tolist().index("edge-frequencies")]
    assert edge == pytest.approx([1.2, 0.9, 1.1], abs=1e-5)
    assert "optimal-weights" not in result["label"].values
