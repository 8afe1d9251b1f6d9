"""The most probable model, intervals and the verdict of a study, from its file to the terminal."""

from __future__ import annotations

import json
from itertools import combinations
from pathlib import Path
from textwrap import wrap

import numpy as np
import pytest
import xarray as xr
from refusals import command
from two_masses import STUDY

import modefront as mf
from modefront.cli.show import as_json
from modefront.linalg.small import mac
from modefront.results.files import FILE
from modefront.results.verdict import with_verdict
from modefront.study.examples import write_example
from modefront.uncertainty.inference import wider
from modefront.uncertainty.sampling import ROUND

SEARCH, OPEN = mf.Search(doubt=0.5), mf.Identifiability(models=0)

pytestmark = pytest.mark.usefixtures("short_chains")

DATA = """set,mode,frequency,damping,low,high
a,1,4.586,0.02,0.613,1.0
a,2,9.615,,0.843,-0.98
"""


def study(folder: Path, *, noise: str = "", bounds: str = "", data: str = DATA) -> Path:
    text = STUDY.replace("[noise]\nweight = 0\n", noise)
    if bounds:
        text = text.replace("bounds = [0.2, 5.0]", bounds)
    (folder / "modes.csv").write_text(data)
    (folder / "study.toml").write_text(text)
    return folder / "study.toml"


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, xr.Dataset]:
    folder = tmp_path_factory.mktemp("whole")
    return folder, mf.run(mf.load(study(folder)), folder / "results").dataset


def test_the_reference_is_the_most_probable_model_with_intervals(
    whole: tuple[Path, xr.Dataset],
) -> None:
    _, data = whole
    assert data.attrs["reference"] == "most-probable"
    labels = data["label"].values.tolist()
    assert labels.count("most-probable") == 1
    best = data.isel(point=labels.index("most-probable"))
    assert bool(best["converged"])
    low, middle, high = data["interval"].values.T
    assert (low < middle).all()
    assert (middle < high).all()
    assert (low < best["theta"].values).all()
    assert (best["theta"].values < high).all()
    assert data["sample_theta"].shape == (20, 2)
    assert data["quantile"].values.tolist() == [0.05, 0.5, 0.95]
    assert set(data["trust"].values) <= {"determined", "partly", "not determined"}
    lower, upper = data["bounds"].values.T
    assert (data["sample_theta"].values >= lower).all()
    assert (data["sample_theta"].values <= upper).all()


def test_draws_are_a_group_of_the_file(whole: tuple[Path, xr.Dataset]) -> None:
    folder, data = whole
    file = folder / "results" / FILE
    with xr.open_dataset(file, group="posterior", engine="h5netcdf") as draws:
        assert draws["theta"].dims == ("chain", "draw", "parameter")
        assert np.array_equal(draws["theta"][0], data["sample_theta"])


@pytest.mark.slow(4)
def test_kept_tasks_and_other_processes_lead_to_the_same_digits(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path
    monkeypatch.setattr("modefront.uncertainty.sampling.ROUND", ROUND)  # that of other processes
    data = mf.run(mf.load(study(folder)), folder / "results").dataset
    tasks = folder / "results" / "tasks"
    stages = ("sample-posterior", "peaks", "draws", "most-probable")
    kept = [file for name in stages for file in tasks.rglob(f"{name}-*.npz")]
    assert len(kept) > 11
    for file in kept[::2]:
        file.unlink()
    again = mf.run(mf.load(folder / "study.toml"), folder / "results").dataset
    assert again.identical(data)
    other = mf.run(mf.load(folder / "study.toml"), folder / "other", workers=2).dataset
    assert other.identical(data)


def test_points_and_seed_change_nothing(whole: tuple[Path, xr.Dataset]) -> None:
    folder, data = whole
    reference = data.attrs["reference"]
    theta = data["theta"].values[data["label"].values == reference]
    problem = mf.load(folder / "study.toml").problem
    other = mf.solve(problem, points=5, seed=5, search=SEARCH, identifiability=OPEN).dataset
    assert other["theta"].values[other["label"].values == reference] == pytest.approx(
        theta, abs=1e-6
    )


@pytest.mark.parametrize("letters", [8, 60, 200])
def test_the_verdict_has_a_dozen_lines_with_its_title(
    letters: int, whole: tuple[Path, xr.Dataset]
) -> None:
    _, data = whole
    long = [f"{name:x<{letters}}" for name in data["parameter"].values]
    result = with_verdict(data.assign_coords(parameter=long)).attrs["verdict"].splitlines()
    lines = [line for sentence in result for line in wrap(sentence, 80)]
    assert 3 <= len(lines) <= 11
    assert result[0] == data.attrs["verdict"].splitlines()[0]


def test_the_verdict_is_first_everywhere(
    whole: tuple[Path, xr.Dataset], capsys: pytest.CaptureFixture[str]
) -> None:
    folder, data = whole
    said = data.attrs["verdict"].splitlines()
    assert said[0].startswith("Use most-probable: its errors over those expected are ")
    assert any("frequencies known to 0.5 %, shapes to 3 %" in text for text in said)
    assert any(text.startswith("Determined (90 %): k1 ") for text in said)
    assert json.loads(as_json(data))["verdict"] == said
    assert mf.read_results(folder / "results").verdict == said
    assert command("show", folder / "results") == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[1].startswith("Use most-probable")
    first = lines[2 : lines.index("", 2)]
    assert len(first) <= 12
    assert all(len(line) <= 80 for line in first)


def test_expected_errors_are_those_of_the_study(tmp_path: Path) -> None:
    data = mf.run(
        mf.load(study(tmp_path, noise="[noise]\nfrequency = 0.02\nshape = 0.1\n")), tmp_path / "r"
    ).dataset
    assert data.attrs["assumed"] == ""
    assert "say yours" not in data.attrs["verdict"], "of errors that the user has said"
    best = data["label"].values.tolist().index("most-probable")
    assert data["error"].values[best, 0] == pytest.approx(0.02 * data["misfit"].values[0], rel=1e-6)


def test_no_model_is_advised_where_errors_are_far_above_those_expected(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wrong = DATA.replace("9.615", "30.0")
    data = mf.run(mf.load(study(tmp_path, data=wrong)), tmp_path / "r").dataset
    first = data.attrs["verdict"].splitlines()[0]
    assert first.startswith("Do not use any of these models: errors of ")
    assert "times those expected" in first
    assert "etermined" not in data.attrs["verdict"], "nothing is said of its parameters"
    assert data.attrs["reference"] == ""
    results = mf.read_results(tmp_path / "r")
    assert results.reference.label == "most-probable"
    assert json.loads(as_json(data))["attributes"]["settled"] == 0
    assert "determined" not in set(data["trust"].values)
    for option in ("--models", "--uncertainty"):
        assert command("show", tmp_path / "r", option) == 0
        assert "the model is not to be used" in " ".join(capsys.readouterr().out.split())


def test_modes_that_sensors_do_not_tell_apart_are_paired_by_frequencies_and_named() -> None:
    """Noise exchanges the shapes of two modes that are alike at two sensors."""
    names = ("k1", "k2")
    n = 6
    springs = ["k1", *["k2"] * 5]
    model = mf.chain(names, [1.0] * n, [1000.0] * n, stiffness_parameters=springs)
    truth = np.array([1.2, 0.9])
    modes = model.modes(truth, 4)

    def likeness(i: int, j: int) -> float:
        return float(np.triu(mac(modes.phi[[i, j]], modes.phi[[i, j]]), 1).max())

    i, j = max(combinations(range(n), 2), key=lambda x: likeness(*x))
    alike = np.triu(mac(modes.phi[[i, j]], modes.phi[[i, j]]), 1)
    q, r = np.unravel_index(int(alike.argmax()), alike.shape)
    shape = modes.phi[[i, j]].T.copy()
    shape[[q, r]] = shape[[r, q]]
    data = mf.modal_data(modes.frequency, shape, (model.sensors[i], model.sensors[j]))
    parameters = [mf.Parameter(name, nominal=1.0, bounds=(0.5, 2.0)) for name in names]
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    problem = mf.updating_problem(model, data, groups, parameters=parameters)
    results = mf.solve(problem, points=2, search=SEARCH, identifiability=OPEN)
    best = results.data["label"].values.tolist().index("most-probable")
    assert results["paired_mode"].values[best].tolist() == [1, 2, 3, 4]
    assert results["mac_mode"].values.tolist() != [1, 2, 3, 4]
    assert results["frequency"].values[best] == pytest.approx(modes.frequency, rel=0.01)
    named = " and ".join(str(x + 1) for x in sorted((q, r)))
    (said,) = [text for text in results.verdict if text.startswith("Shapes at these sensors")]
    assert f"those measured as {named}: frequencies decide" in said
    low, _, high = results["interval"].values.T
    assert (low <= truth).all()
    assert (truth <= high).all()
    assert results.reference.theta == pytest.approx(dict(zip(names, truth, strict=True)), 0.02)


def test_what_to_measure_fix_or_tie_is_said() -> None:
    """Of two springs in one place only the sum is known, and a further mode tells no more."""
    names = ("k1", "k2", "twin")
    K = np.array([[2.0, -1.0], [-1.0, 1.0]])
    parts = {"k1": np.diag([1.0, 0.0]), "k2": K - np.diag([1.0, 0.0])}
    parts = {name: 1000 * part for name, part in parts.items()}
    model = mf.matrices(
        names, {**parts, "twin": parts["k1"]}, {"base": np.eye(2)}, {"a": 0, "b": 1}
    )
    modes = model.modes(np.array([0.9, 1.1, 1.1]), 2)
    data = mf.modal_data(modes.frequency, modes.phi.T, model.sensors)
    parameters = [mf.Parameter(name, nominal=1.0, bounds=(0.2, 1.8)) for name in names]
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    problem = mf.updating_problem(model, data, groups, parameters=parameters)
    results = mf.solve(problem, points=2, search=SEARCH, identifiability=OPEN)
    assert results["candidate_gain"].values.max(initial=0.0) < 0.1
    (said,) = [text for text in results.verdict if text.startswith("Or leave open less")]
    assert 'twin: tie = "k1"' in said, "as check: the one of which the other leaves least"
    assert "k2" not in said


def test_a_bound_that_holds_the_model_is_named(tmp_path: Path) -> None:
    data = mf.run(mf.load(study(tmp_path, bounds="bounds = [1.0, 1.005]")), tmp_path / "r").dataset
    best = data.isel(point=data["label"].values.tolist().index("most-probable"))
    side = best["at_bound"].values
    assert side.any()
    for name, at in zip(data["parameter"].values, side, strict=True):
        text = f"{name} is at its {'upper' if at > 0 else 'lower'} bound"
        assert (text in data.attrs["verdict"]) == bool(at)


@pytest.mark.parametrize("bounds", [(0.8, 1.1), (0.99, 1.01)])
def test_the_bound_that_excludes_the_truth_is_named_with_the_value_beyond_it(
    bounds: tuple[float, float],
) -> None:
    """The first spring is 1.4, and less is allowed: 1.1, or next to nothing."""
    names = ("k1", "k2")
    model = mf.chain(names, [1.0, 1.0], [1000.0, 1000.0], stiffness_parameters=names)
    modes = model.modes(np.array([1.4, 1.0]), 2)
    data = mf.modal_data(modes.frequency, modes.phi.T, model.sensors)
    parameters = [mf.Parameter(name, nominal=1.0, bounds=bounds) for name in names]
    groups = [mf.Group("frequencies", frequency="all"), mf.Group("shapes", shape="all")]
    problem = mf.updating_problem(model, data, groups, parameters=parameters)
    results = mf.solve(problem, points=2, search=SEARCH, identifiability=OPEN)
    assert results["freed_theta"].values == pytest.approx([1.4, 1.0], abs=1e-4)
    (said,) = [text for text in results.verdict if "bound" in text]
    assert "With k1 = 1.4, errors of frequencies are " in said
    assert "k2 = " not in said.split("With")[1]
    assert results["trust"].values[0] == "partly"
    assert "k1: fixed" not in "".join(results.verdict)


def test_wider_bounds_are_farther_by_their_range_or_ratio() -> None:
    below, above = wider(np.array([0.5, -1.0]), np.array([2.0, 3.0]))
    assert below.tolist() == [0.125, -5.0]
    assert above.tolist() == [8.0, 7.0]


def test_the_published_posterior_is_that_without_expectation(tmp_path: Path) -> None:
    write_example("three-story-c0", tmp_path)
    assert "weight = 0" in (tmp_path / "study.toml").read_text()
    faulty = (tmp_path / "study.toml").read_text().replace("weight = 0", "weight = -1")
    (tmp_path / "study.toml").write_text(faulty)
    with pytest.raises(mf.InputError, match="weight"):
        mf.load(tmp_path / "study.toml")


def test_a_parameter_without_effect_stays_nominal_and_is_not_determined() -> None:
    """The third spring is between masses that no measured mode moves."""
    K = {"k1": np.diag([4000.0, 0.0, 0.0]), "k2": np.diag([0.0, 9000.0, 0.0])}
    K["idle"] = np.diag([0.0, 0.0, 1e6])
    model = mf.matrices(tuple(K), K, {"base": np.eye(3)}, {"a": 0, "b": 1})
    f = np.sqrt([4400.0, 8500.0]) / (2 * np.pi)
    data = mf.modal_data(f, np.eye(2), model.sensors)
    parameters = [mf.Parameter(name, nominal=1.1, bounds=(0.5, 2.0)) for name in K]
    groups = [mf.Group("frequencies", frequency="all")]
    problem = mf.updating_problem(model, data, groups, parameters=parameters)
    results = mf.solve(problem, points=2, search=SEARCH, identifiability=OPEN).dataset
    best = results.isel(point=results["label"].values.tolist().index("most-probable"))
    assert best["theta"].values == pytest.approx([1.1, 8500 / 9000, 1.1], abs=1e-5)
    assert best["theta"].values[2] == 1.1
    assert results["trust"].values.tolist() == ["determined", "determined", "not determined"]
