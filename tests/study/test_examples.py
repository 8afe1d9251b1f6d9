"""The examples that ``init`` writes."""

import re
import runpy
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest

import modefront as mf
from modefront._typing import Floats
from modefront.data.csv import read_csv
from modefront.errors import InputError
from modefront.front.options import Pareto
from modefront.front.pareto import pareto_front
from modefront.study.check import check
from modefront.study.examples import names, write_example
from modefront.study.file import load
from modefront.work.task import counted

EXAMPLES = Path(__file__).parents[2] / "examples"


def test_the_promised_examples_are_there() -> None:
    promised = {"three-story", "footbridge", "three-groups", "eighteen-stories", "wrong-class"}
    assert promised | {"three-story-c0", "three-story-c1"} <= set(names())


LONG = ("calculix", "three-story-fe-c1")
"""What tests of imports, and the other example of the kind, look at as well."""


@pytest.mark.parametrize(
    "name", [pytest.param(x, marks=[pytest.mark.slow(2)] * (x in LONG)) for x in names()]
)
def test_each_example_is_written_whole_and_is_sound(name: str, tmp_path: Path) -> None:
    written = write_example(name, tmp_path / "new" / "folder")
    assert sorted(written) == sorted((tmp_path / "new" / "folder").iterdir())
    study = load(tmp_path / "new" / "folder" / "study.toml")
    checked = check(study)
    assert checked.sound
    assert bool(checked.warnings) == (name == "eighteen-stories"), "more parameters than data"


def test_nothing_is_overwritten(tmp_path: Path) -> None:
    (tmp_path / "modes.csv").write_text("mine")
    with pytest.raises(InputError, match="nothing is overwritten, found an existing one"):
        write_example("three-story-c0", tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["modes.csv"]
    assert (tmp_path / "modes.csv").read_text() == "mine"


def test_every_file_in_the_way_is_named_links_to_nothing_too(tmp_path: Path) -> None:
    (tmp_path / "modes.csv").write_text("mine")
    (tmp_path / "study.toml").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(InputError) as caught:
        write_example("three-story-c0", tmp_path)
    assert len(caught.value.faults) == 2
    assert not (tmp_path / "elsewhere").exists()


def test_an_unknown_example_is_answered_with_the_known_ones(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"expected one of ambient-test, calculix, .*did you mean"):
        write_example("three-storey", tmp_path / "new")
    assert not (tmp_path / "new").exists()


def solved(name: str, study: str, folder: Path) -> mf.Results:
    """Return the results of a study of an example."""
    if not (folder / "new").exists():
        write_example(name, folder / "new")
    return mf.run(load(folder / "new" / study), folder / study.removesuffix(".toml"))


def held(results: mf.Results, truth: Floats | list[float]) -> list[bool]:
    """Return which 90 % intervals hold the truth."""
    low, _, high = results.interval.values.T
    return ((low <= truth) & (truth <= high)).tolist()


@pytest.mark.slow(3)
@pytest.mark.parametrize(
    ("name", "study", "truth"),
    [
        ("footbridge", "study.toml", [0.92, 1.25, 0.6, 1.2]),
        ("three-groups", "study.toml", [1.19, 0.93, 1.05, 0.78]),
        ("wrong-class", "study-neighbour.toml", [1.1, 0.95, 1.05, 0.9, 1.0, 0.25]),
        ("eighteen-stories", "study-zones.toml", [1.0, 3 / (2 + 1 / 0.7), 1.0, 1.0, 1.0, 1.0]),
    ],
)
def test_intervals_of_simulated_examples_hold_their_truth(
    name: str, study: str, truth: list[float], tmp_path: Path
) -> None:
    results = solved(name, study, tmp_path)
    assert results.verdict[0].startswith("Use most-probable")
    assert (results["trust"].values == "determined").all()
    assert all(held(results, truth))


@pytest.mark.slow(6)
def test_more_parameters_than_data_are_not_determined(tmp_path: Path) -> None:
    results = solved("eighteen-stories", "study.toml", tmp_path)
    truth = np.ones(18)
    truth[4] = 0.7
    assert "determined" not in results["trust"].values
    assert all(held(results, truth))
    assert any(sentence.startswith("Measure the mode") for sentence in results.verdict)


@pytest.mark.slow(2)
def test_a_front_of_objectives_that_nearly_tie_ends_long_before_the_budget(tmp_path: Path) -> None:
    """Edges are told apart by less than counts, and go back and forth as models are found."""
    write_example("hammer-test", tmp_path / "new")
    problem = load(tmp_path / "new" / "study.toml").problem
    with counted() as costs:
        front = pareto_front(problem, problem.properties, Pareto(points=20))
    assert front.open == ()
    assert costs.eigenproblems < 3000


@pytest.mark.slow(3)
def test_a_model_of_a_wrong_class_is_refused(tmp_path: Path) -> None:
    results = solved("wrong-class", "study.toml", tmp_path)
    assert results.verdict[0].startswith("Do not use any of these models: errors of frequencies")
    assert results.attrs["reference"] == ""


@pytest.mark.slow(4)
def test_the_script_simulates_the_modal_tests_that_are_shipped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shipped, made = tmp_path / "shipped", tmp_path / "made"
    for name in ("hammer-test", "ambient-test"):
        write_example(name, shipped / name)
        (made / name).mkdir(parents=True)
        for file in (shipped / name).glob("test*.toml"):
            shutil.copy(file, made / name)
    monkeypatch.setattr(sys, "argv", ["modal_tests.py", str(made)])
    runpy.run_path(str(EXAMPLES / "modal_tests.py"), run_name="__main__")
    files = list(made.rglob("*.csv"))
    assert len(files) == 12 + 2 + 3
    for file in files:
        text, expected = (x.read_text() for x in (file, shipped / file.relative_to(made)))
        again, numbers = (
            np.array([float(x) for x in re.findall(r"-?\d[\d.e+-]*", t)]) for t in (text, expected)
        )
        assert again == pytest.approx(numbers, rel=1e-3, abs=1e-6)


def test_the_script_makes_the_measurements_that_are_shipped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made, shipped = tmp_path / "made", tmp_path / "shipped"
    for name in ("footbridge", "three-groups", "eighteen-stories", "wrong-class"):
        write_example(name, shipped / name)
    shutil.copytree(shipped, made)
    for file in (*made.rglob("modes.csv"), *(made / "three-groups").glob("*.npy")):
        file.unlink()
    monkeypatch.setattr(sys, "argv", ["gallery.py", str(made)])
    runpy.run_path(str(EXAMPLES / "gallery.py"), run_name="__main__")
    for file in shipped.rglob("modes.csv"):
        again, expected = (read_csv(root / file.relative_to(shipped)) for root in (made, shipped))
        assert again.frequency == pytest.approx(expected.frequency, rel=1e-4)
        assert again.shape == pytest.approx(expected.shape, abs=1e-3)
    for file in (shipped / "three-groups").glob("*.npy"):
        assert np.load(made / "three-groups" / file.name) == pytest.approx(np.load(file))
