"""Fronts of each method on the three-story building, with their gaps."""

from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
import xarray as xr
from interruptions import interrupt_at

import modefront as mf
from modefront._typing import Floats
from modefront.front.dominance import nondominated
from modefront.front.point import front_points
from modefront.study.examples import write_example
from modefront.work.task import counted

pytestmark = pytest.mark.slow(2)

METHODS = ("nbi", "weights", "spea2", "nsga2")

EVALUATIONS = 800
"""Of evolutionary methods, twenty generations of forty models."""

WITHOUT = mf.NoisePrior(weight=0)
"""Fronts need no posterior to draw from."""

FEW = mf.Search(doubt=0.5)
"""For claims on fronts between edges, whichever minima these are."""


@cache
def problem(configuration: str) -> mf.UpdatingProblem:
    with TemporaryDirectory() as folder:
        write_example(f"three-story-{configuration}", Path(folder))
        return mf.load(Path(folder) / "study.toml").problem


def grouped(configuration: str, *groups: mf.Group) -> mf.UpdatingProblem:
    base = problem(configuration)
    return mf.UpdatingProblem(base.model, base.data, groups, base.lower, base.upper, base.start)


def solved(method: str, seed: int) -> xr.Dataset:
    result = mf.solve(
        problem("c0"),
        method=method,
        programme="equations",
        population=40,
        evaluations=EVALUATIONS,
        seed=seed,
        noise=WITHOUT,
    )
    return result.dataset


@cache
def results(method: str) -> xr.Dataset:
    return solved(method, seed=1)


def front(data: xr.Dataset) -> Floats:
    J: Floats = data["objective"].values[front_points(data)]
    return J


@pytest.mark.parametrize("method", METHODS)
def test_all_methods_give_the_same_variables_and_count_alike(method: str) -> None:
    data, nbi = results(method), results("nbi")
    assert data.attrs["method"] == method
    assert set(nbi.data_vars) - set(data.data_vars) <= {
        *("piece", "end_label", "end_theta", "end_objective", "end_converged"),
        *("lattice", "lattice_label"),
    }
    n = len(front(data))
    assert data["label"].values[:n].tolist() == [f"{method}-{i + 1}" for i in range(n)]
    evolutionary = method in ("spea2", "nsga2")
    spent = data.attrs["front_evaluations"]
    assert spent == EVALUATIONS if evolutionary else 0 < spent < data.attrs["model_evaluations"]
    converged = data["converged"].values[:n]
    assert not converged.any() if evolutionary else converged.all()
    assert bool(data["converged"].values[n:].all())
    weights = np.isfinite(data["weight"].values[:n]).all(axis=1)
    assert weights.all() if method == "weights" else not weights.any()
    for name in ("hypervolume", "igd_plus", "largest_gap"):
        assert data.attrs[name] > 0


@pytest.mark.slow(4)
@pytest.mark.parametrize("method", ["spea2", "nsga2"])
def test_evolution_repeats_with_the_same_seed_and_stays_behind(method: str) -> None:
    again = solved(method, seed=1)
    assert again.identical(results(method))
    other = solved(method, seed=2)
    assert not np.array_equal(front(other)[:5], front(again)[:5])
    assert again.attrs["hypervolume"] < results("nbi").attrs["hypervolume"] * 1.01


def test_the_weight_sweep_misses_the_branch_next_to_the_frequency_edge() -> None:
    nbi, sweep = results("nbi"), results("weights")
    branch = front(nbi)[(nbi["piece"].values == 1)[front_points(nbi)]]
    assert len(branch) == 5
    # Of the first piece the sweep finds its end, the edge, and nothing else.
    result = front(sweep)
    on_branch = result[result[:, 1] > branch[-1, 1] * (1 + 1e-9)]
    assert len(np.unique(on_branch.round(9), axis=0)) == 1
    assert sweep.attrs["largest_gap"] > 5 * nbi.attrs["largest_gap"]
    assert nondominated(result).all(), "what it finds is optimal"


@pytest.mark.slow(4)
@pytest.mark.parametrize("size", [0.06, 0.02])
def test_refining_closes_the_gaps_of_each_piece_up_to_its_end(size: float) -> None:
    coarse = results("nbi")
    fine = mf.solve(
        problem("c0"), programme="equations", refined=size, seed=1, noise=WITHOUT
    ).dataset
    assert fine.attrs["largest_gap"] <= size < coarse.attrs["largest_gap"]
    assert bool(fine["converged"].all())
    J, scale = front(fine), np.ptp(front(coarse), axis=0)
    assert {tuple(row) for row in front(coarse).tolist()} <= {tuple(row) for row in J.tolist()}
    piece = fine["piece"].values[front_points(fine)]
    ends = fine["end_objective"].values
    for k, end in ((1, ends[0]), (2, ends[1])):
        assert np.linalg.norm((J[piece == k] - end) / scale, axis=1).min() <= size


@pytest.mark.slow(4)
def test_refining_finds_a_gap_that_few_points_step_over() -> None:
    """Of 8 points, none lies in the gap of M0: only that nothing is found there tells of it."""
    expected, coarse = (
        results("nbi"),
        mf.solve(problem("c0"), points=8, programme="equations", seed=1, noise=WITHOUT).dataset,
    )
    assert coarse.sizes["end"] == 0
    fine = mf.solve(
        problem("c0"), points=8, programme="equations", refined=0.1, seed=1, noise=WITHOUT
    ).dataset
    assert fine["end_label"].values.tolist() == ["end-1", "start-2"]
    assert fine["end_objective"].values == pytest.approx(expected["end_objective"].values, rel=1e-4)
    assert fine.attrs["largest_gap"] <= 0.1
    behind = (front(fine) >= fine["end_objective"].values[1]).all(axis=1)
    assert behind.any(), "points that the start of the second piece dominates"
    assert (fine["piece"].values[front_points(fine)][behind] == 0).all()


def test_edges_of_three_groups_are_pareto_optimal() -> None:
    """Next to an edge, what is lost in its own objective is of the second order."""
    groups = (
        mf.Group("frequencies", frequency="all"),
        mf.Group("shape 1", shape=[1]),
        mf.Group("shapes 2 and 3", shape=[2, 3]),
    )
    data = mf.solve(grouped("c0", *groups), points=4, seed=1, search=FEW, noise=WITHOUT).dataset
    assert data["pareto"].values[data["kind"].values == "edge"].all()


def test_three_groups_are_covered_within_and_beyond_the_simplex() -> None:
    groups = (
        mf.Group("frequencies", frequency="all"),
        mf.Group("shape 1", shape=[1]),
        mf.Group("shapes 2 and 3", shape=[2, 3]),
    )
    data = mf.solve(grouped("c1", *groups), points=6, seed=1, search=FEW, noise=WITHOUT).dataset
    J = front(data)
    assert len(J) >= 21
    assert bool(data["converged"].all())
    weights = data["stationary_weight"].values[front_points(data)]
    assert (weights > -1e-6).all(), "every point is a local Pareto optimum"


@pytest.mark.slow(4)
def test_each_property_a_group() -> None:
    groups = [mf.Group(f"f{r}", frequency=[r]) for r in (1, 2, 3)]
    groups += [mf.Group(f"s{r}", shape=[r]) for r in (1, 2, 3)]
    data = mf.solve(grouped("c1", *groups), points=2, seed=1, search=FEW, noise=WITHOUT).dataset
    J = front(data)
    assert len(J) >= 6
    assert bool(data["converged"].all())
    assert (data["stationary_weight"].values[front_points(data)] > -1e-6).all()
    assert data.attrs["hypervolume"] > 0


@pytest.mark.parametrize("method", METHODS)
def test_perfect_data_are_one_model_for_every_method(method: str) -> None:
    base = problem("c0")
    modes = base.model.modes(np.array([1.2, 0.9, 1.1]), 3)
    data = mf.modal_data(modes.frequency, modes.phi.T, base.model.sensors)
    perfect = mf.UpdatingProblem(base.model, data, base.groups, base.lower, base.upper, base.start)
    result = mf.solve(perfect, method=method, seed=1, noise=WITHOUT).dataset
    assert result.attrs["front_is_a_point"]
    assert front_points(result).size == 0
    assert result.attrs["front_evaluations"] == 0
    assert np.isnan(result.attrs["hypervolume"])
    (edge,) = result["theta"].values[result["label"].values == "edge-frequencies"]
    assert edge == pytest.approx([1.2, 0.9, 1.1], abs=1e-5)


def test_scatter_next_to_the_end_of_a_piece_is_doubtful() -> None:
    base = problem("c0")
    known = replace(
        base.data,
        frequency_std=0.005 * base.data.frequency,
        shape_std=0.02 * np.abs(base.data.shape).max(axis=2, keepdims=True) + 0 * base.data.shape,
    )
    data = mf.solve(
        replace(base, data=known), points=12, programme="equations", seed=1, noise=WITHOUT
    ).dataset
    J, reach = data["objective"].values, data["objective_std"].values
    ends = data["end_objective"].values
    assert len(ends) == 2
    near = (np.abs(J[:, None] - ends) <= reach[:, None]).all(axis=2).any(axis=1)
    near &= data["kind"].values == "front"
    doubts = data["scatter_doubt"].values.tolist()
    assert [text for text, other in zip(doubts, near, strict=True) if other] == ["ends"] * 2
    assert {"", "ends"} <= set(doubts)
    named = ", ".join(data["label"].values[near])
    assert any(
        f"deviations are approximate at {named}: a branch" in x for x in data["finding"].values
    )


@pytest.mark.parametrize("method", ["spea2", "nsga2"])
def test_an_interrupted_evolution_goes_on_where_it_stopped(
    method: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_example("three-story-c0", tmp_path)
    path = tmp_path / "study.toml"
    settings = f'method = "{method}"\npopulation = 20\nevaluations = 200'
    search = "\n[search]\ndoubt = 0.5\n"
    path.write_text(path.read_text().replace('method = "nbi"', settings) + search)
    whole = mf.run(mf.load(path), tmp_path / "whole").dataset
    interrupt_at(f"front-{method}-100-", monkeypatch)
    with pytest.raises(KeyboardInterrupt):
        mf.run(mf.load(path), tmp_path / "results")
    before = set((tmp_path / "results" / "tasks").rglob("*.npz"))
    assert sum(file.name.startswith(f"front-{method}-") for file in before) == 5
    with counted() as costs:
        assert mf.run(mf.load(path), tmp_path / "results").dataset.identical(whole)
    new = set((tmp_path / "results" / "tasks").rglob("*.npz")) - before
    assert sum(file.name.startswith(f"front-{method}-") for file in new) == 5
    assert 5 * 20 <= costs.eigenproblems < whole.attrs["model_evaluations"] - 5 * 20
