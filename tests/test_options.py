"""Options check themselves, with the same words in Python and in a study file."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import modefront as mf
from modefront.front import methods
from modefront.study.examples import write_example
from modefront.work.task import counted

METHODS = "'nbi', 'weights', 'spea2', 'nsga2'"

RECORDS: dict[str, Callable[..., Any]] = {
    "pareto": mf.Pareto,
    "search": mf.Search,
    "pairing": mf.Pairing,
    "identifiability": mf.Identifiability,
    "uncertainty": mf.Uncertainty,
}

WRONG: list[tuple[str, dict[str, Any], str]] = [
    ("pareto", {"method": "nbii"}, f"method: expected one of {METHODS}, found 'nbii'"),
    ("pareto", {"method": ["nbi"]}, f"method: expected one of {METHODS}, found ['nbi']"),
    ("pareto", {"points": -3}, "points: expected a whole number from 2 to 10000, found -3"),
    ("pareto", {"points": 2.5}, "points: expected a whole number from 2 to 10000, found 2.5"),
    ("pareto", {"points": "20"}, "points: expected a whole number from 2 to 10000, found '20'"),
    ("pareto", {"points": True}, "points: expected a whole number from 2 to 10000, found true"),
    ("pareto", {"tolerance": math.nan}, "tolerance: expected a share from 0 to 1, found nan"),
    ("pareto", {"tolerance": 2}, "tolerance: expected a share from 0 to 1, found 2"),
    (
        "pareto",
        {"population": 50, "evaluations": 40},
        "evaluations: expected at least the population, 50, found 40",
    ),
    ("pareto", {"refined": 0}, "refined: expected a distance from 0.001 to 1, found 0"),
    (
        "pareto",
        {"refined": 0.1, "method": "spea2"},
        "refined: expected two groups and method 'nbi', found 2 groups, method 'spea2'",
    ),
    (
        "search",
        {"evaluations": 0},
        "evaluations: expected a whole number from 1 to 1000000000, found 0",
    ),
    ("search", {"tolerance": 0}, "tolerance: expected a share above 0 and below 1, found 0"),
    ("search", {"doubt": 1.0}, "doubt: expected a share above 0 and below 1, found 1.0"),
    ("pairing", {"method": "MAC"}, "method: expected one of 'mac', 'order', found 'MAC'"),
    ("pairing", {"window": 1}, "window: expected a ratio of frequencies above 1, found 1"),
    ("pairing", {"spare": -1}, "spare: expected a whole number from 0 to 1000, found -1"),
    (
        "identifiability",
        {"step": 0.6},
        "step: expected a share of the ranges from 0.001 to 0.5, found 0.6",
    ),
    (
        "uncertainty",
        {"source": "stds"},
        "source: expected one of 'auto', 'std', 'sets', 'none', found 'stds'",
    ),
    (
        "uncertainty",
        {"source": "none", "bootstrap": 2},
        "bootstrap: expected 0 with source = 'none', found 2",
    ),
    (
        "uncertainty",
        {"source": "sets"},
        "source: expected a mode measured in two data sets for 'sets', found none",
    ),
    ("uncertainty", {"draws": 3}, "draws: expected 0 without predictions, found 3"),
]


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """A study of the three-story building without options."""
    write_example("three-story-c0", tmp_path)
    path = tmp_path / "study.toml"
    path.write_text(path.read_text().partition("[pareto]")[0])
    return path


@pytest.mark.parametrize(("table", "values", "says"), WRONG)
def test_python_and_the_study_file_refuse_the_same_in_the_same_words(
    table: str, values: dict[str, Any], says: str, study: Path
) -> None:
    problem = mf.load(study).problem
    with pytest.raises(mf.InputError) as of_python:
        mf.Study(problem, **{table: RECORDS[table](**values)})
    assert str(of_python.value) == says
    lines = [f"{key} = {_toml(value)}" for key, value in values.items()]
    study.write_text(study.read_text() + "\n".join([f"[{table}]", *lines]))
    with pytest.raises(mf.InputError) as of_file:
        mf.load(study)
    assert str(of_file.value) == f"{study}: [{table}] {says}"


def _toml(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else repr(value)


def test_what_solve_is_given_is_checked_before_any_work(study: Path) -> None:
    problem = mf.load(study).problem
    wrong: dict[str, Any]
    for wrong, says in (
        ({"method": "nbii"}, "method: expected one of"),
        ({"points": np.nan}, "points: expected a whole number"),
        ({"refined": 0.1, "method": "nsga2"}, "refined: expected two groups and method 'nbi'"),
        ({"seed": -1}, "seed: expected a whole number from 0"),
        ({"seed": "1"}, "seed: expected a whole number from 0"),
        ({"weighted": [mf.Weighted("mine", {"frequencies": 1.0})]}, "'mine' weights shapes: expec"),
        ({"weighted": 2 * [mf.Weighted("a", {"frequencies": 1, "shapes": 1})]}, "each name once"),
    ):
        with counted() as costs, pytest.raises(mf.InputError, match=says):
            mf.solve(problem, **wrong)
        assert costs.eigenproblems == 0
    unknown: dict[str, Any] = {"nodes": 3}
    with pytest.raises(TypeError, match="nodes"):
        mf.solve(problem, **unknown)


def test_one_group_cannot_be_refined_nor_can_a_simplex_have_too_many_points(study: Path) -> None:
    problem = mf.load(study).problem
    group = mf.Group("all", frequency="all", shape="all")
    with pytest.raises(mf.InputError, match=r"refined: expected two groups .* found 1 group, meth"):
        mf.solve(replace(problem, groups=(group,)), refined=0.1)
    three = tuple(mf.Group(f"mode {r}", frequency=[r], shape=[r]) for r in (1, 2, 3))
    with pytest.raises(mf.InputError, match=r"points: .* the simplex of 3 groups, found 500"):
        mf.solve(replace(problem, groups=three), points=500)


@pytest.mark.parametrize("method", ["spea2", "nsga2"])
def test_a_method_whose_package_is_missing(method: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(methods, "find_spec", lambda _: None)
    with pytest.raises(mf.InputError, match=f"method: expected the package pymoo for '{method}'"):
        mf.Pareto(method)


def test_all_that_is_wrong_with_a_record_is_said_at_once() -> None:
    with pytest.raises(mf.InputError) as caught:
        mf.Pareto("nbii", points=1, tolerance=-1)
    assert [fault.place for fault in caught.value.faults] == ["method", "points", "tolerance"]


def test_numbers_of_numpy_are_numbers() -> None:
    points: Any = np.int64(7)
    bounds: Any = np.array([0.2, 5.0])
    assert repr(mf.Pareto(points=points)) == repr(mf.Pareto(points=7))
    assert repr(mf.Pareto(tolerance=np.float64(0.5))) == repr(mf.Pareto(tolerance=0.5))
    assert mf.Parameter("k", np.float64(1), bounds) == mf.Parameter("k", 1, (0.2, 5))
    assert mf.Search(10 * points).evaluations == 70
    fraction: Any = np.float64(7)
    with pytest.raises(mf.InputError, match="points: expected a whole number"):
        mf.Pareto(points=fraction)


def test_a_search_checks_itself() -> None:
    assert mf.Search() == mf.Search(evaluations=20_000, tolerance=1e-3, doubt=0.05)
    with pytest.raises(mf.InputError, match="evaluations: expected a whole number from 1"):
        mf.Search(evaluations=0)
    with pytest.raises(mf.InputError) as caught:
        mf.Search(tolerance=0.0, doubt=1.0)
    assert [fault.place for fault in caught.value.faults] == ["tolerance", "doubt"]
    with pytest.raises(mf.InputError, match="programme: expected one of 'bounds', 'equations'"):
        mf.Pareto(programme="equation")


@pytest.mark.parametrize(
    ("bounds", "nominal", "says"),
    [
        ((1.0, 1.0), 1.0, r"bounds: expected \[lower, upper\], .* found \[1.0, 1.0\]"),
        ((5.0, 0.2), 1.0, r"bounds: expected \[lower, upper\], .* found \[5.0, 0.2\]"),
        ((0.2, np.nan), 1.0, r"bounds: expected \[lower, upper\], .* found \[0.2, nan\]"),
        ((0.2, 5.0), 6.0, "nominal: expected a value within its bounds, 0.2 to 5, found 6"),
        ((0.2, 5.0), "1", "nominal: expected a finite number, found '1'"),
    ],
)
def test_a_parameter_checks_itself(bounds: Any, nominal: Any, says: str) -> None:
    with pytest.raises(mf.InputError, match=says):
        mf.Parameter("k", nominal, bounds)


def test_parameters_of_a_problem(study: Path) -> None:
    problem = mf.load(study).problem
    model, data, groups = problem.model, problem.data, problem.groups
    names = model.parameters
    given = [mf.Parameter(name, 1.0, (0.2, 5.0)) for name in names]
    again = mf.updating_problem(model, data, groups, parameters=given[::-1])
    np.testing.assert_array_equal(again.lower, problem.lower)
    np.testing.assert_array_equal(again.start, problem.start)
    bounds, nominal = dict.fromkeys(names, (0.2, 5.0)), dict.fromkeys(names, 1.0)
    flat = bounds | {names[1]: (1.0, 1.0)}
    with pytest.raises(mf.InputError, match=f"bounds of '{names[1]}': expected .lower, upper."):
        mf.updating_problem(model, data, groups, flat, nominal)
    with pytest.raises(mf.InputError, match=f"nominal of '{names[2]}': expected .* found nothing"):
        mf.updating_problem(model, data, groups, bounds, dict.fromkeys(names[:2], 1.0))
    with pytest.raises(mf.InputError, match=f"parameters: expected one called '{names[0]}'"):
        mf.updating_problem(model, data, groups, parameters=given[1:])
    with pytest.raises(mf.InputError, match=f"expected each name once, found '{names[0]}' twice"):
        mf.updating_problem(model, data, groups, parameters=[*given, given[0]])
    with pytest.raises(mf.InputError, match=f"bounds of '{names[0]}': expected .lower, upper."):
        mf.solve(replace(problem, lower=problem.start, upper=problem.start))
    with pytest.raises(mf.InputError, match="groups: expected each name once, found 'all' twice"):
        mf.solve(replace(problem, groups=2 * (mf.Group("all", frequency="all"),)))


def test_weights_check_themselves() -> None:
    with pytest.raises(mf.InputError, match="weights shapes: expected a weight above 0, found -1"):
        mf.Weighted("mine", {"frequencies": 1.0, "shapes": -1})
    with pytest.raises(mf.InputError, match=r"name: expected a label for the model .* found ''"):
        mf.Weighted("", {"frequencies": 1.0})
    weighted = mf.Weighted("mine", {"b": 2, "a": np.float64(1)})
    assert weighted.of(["a", "b"]).tolist() == [1.0, 2.0]
    (fault,) = weighted.faults(["a", "bb", "b"])
    assert (fault.place, fault.found) == ("weights bb", "nothing")
    (fault,) = mf.Weighted("mine", {"a": 1, "bb": 1, "c": 1}).faults(["a", "bb"])
    assert (fault.place, fault.expected) == ("weights c", "the name of a group")


def test_given_weights_have_no_label_that_results_have(study: Path) -> None:
    problem = mf.load(study).problem

    def named(name: str) -> list[mf.Weighted]:
        return [mf.Weighted(name, {"frequencies": 3.0, "shapes": 1.0})]

    for name in ("nbi", "nbi-", "nbi-x", "edge-others", "near-shapes", "sample", "second-1"):
        assert mf.Study(problem, weighted=named(name)).weighted[0].name == name
    without = mf.NoisePrior(weight=0)
    quick: dict[str, Any] = {"points": 3, "search": mf.Search(doubt=0.5), "noise": without}
    data = mf.solve(problem, weighted=named("sample"), **quick).dataset
    labels = {*data["label"].values.tolist()} - {"sample"}
    assert {"nbi-1", "edge-shapes", "equal-weights"} < labels
    for name in (*labels, "nsga2-400", "identifiable-3"):
        with pytest.raises(mf.InputError, match="name: expected another name than the labels"):
            mf.Study(problem, weighted=named(name))


@pytest.mark.slow(3)
def test_a_study_made_in_python_is_that_of_a_file(study: Path, tmp_path: Path) -> None:
    study.write_text(
        study.read_text()
        + "[pareto]\npoints = 3\n[search]\ndoubt = 0.5\n[noise]\nweight = 0\n"
        + '[[weighted]]\nname = "sample"\nweights = { shapes = 1, frequencies = 3 }\n'
    )
    read = mf.load(study)
    made = mf.Study(
        read.problem,
        name="by hand",
        seed=1,
        pareto=mf.Pareto(points=3),
        weighted=(mf.Weighted("sample", {"frequencies": 3.0, "shapes": 1.0}),),
        search=mf.Search(doubt=0.5),
        noise=mf.NoisePrior(weight=0),
    )
    assert replace(made, name=read.name, origin=read.origin) == read
    of_file, of_python = mf.run(read, tmp_path / "a"), mf.run(made, tmp_path / "b")
    in_memory = mf.run(made)
    for name in of_file.variables:
        np.testing.assert_array_equal(of_file[name], of_python[name])
        np.testing.assert_array_equal(of_file[name], in_memory[name])
    assert "sample" in of_file["label"].values
    assert of_python.attrs["study"] == "by hand"
    # Pieces of a model that only Python knows are never taken for those of another one.
    mf.run(made, tmp_path / "b")
    assert (tmp_path / "b" / "results.1.nc").exists()


def test_options_that_take_the_place_of_those_of_a_file_are_other_inputs(study: Path) -> None:
    read = mf.load(study)
    assert replace(read).work == read.work
    assert replace(read, pareto=mf.Pareto(refined=0.1)).work == read.work
    assert replace(read, pareto=mf.Pareto(points=5)).work != read.work
    assert replace(read, seed=9).work != read.work
    assert replace(read, name="other").work == read.work
    assert replace(read, name="other").digest != read.digest
    assert replace(read, problem=replace(read.problem)).work == ""


@pytest.mark.slow(3)
def test_pareto_and_its_options_may_be_given_together(study: Path) -> None:
    problem = mf.load(study).problem
    without = mf.NoisePrior(weight=0)
    quick: dict[str, Any] = {"search": mf.Search(doubt=0.5), "seed": 2, "noise": without}
    group = mf.solve(problem, pareto=mf.Pareto("weights", 9), points=3, **quick).dataset
    other = mf.solve(problem, method="weights", points=3, **quick).dataset
    np.testing.assert_array_equal(group["theta"], other["theta"])


def test_a_reduction_takes_a_basis_or_says_why_not(study: Path) -> None:
    with pytest.raises(mf.InputError, match="reduction: expected 'auto', 'off' or a relative err"):
        mf.Reduction(0.5)
    with pytest.raises(mf.InputError, match="memory: expected GiB for a reduced basis, above 0"):
        mf.Reduction(memory=0)
    problem = mf.load(study).problem
    model = problem.model
    assert mf.Reduction("off").of(model, problem.data, problem.pairing, ()) is model
    assert mf.Reduction("off").fallback(model) == ""
    assert "only 3 degrees of freedom" in mf.Reduction(1e-6).fallback(model)
