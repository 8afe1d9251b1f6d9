"""What the commands do, done in Python: paths in, results out that are shown in a few lines."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import modefront as mf
from modefront.cli.show import as_json
from modefront.front.methods import METHODS
from modefront.results.files import read_dataset
from modefront.study.examples import write_example
from modefront.study.kinds import KINDS

QUICK = mf.Search(doubt=0.5)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a study of the three-story building and its results."""
    out = tmp_path_factory.mktemp("python")
    write_example("three-story-c0", out)
    text = (out / "study.toml").read_text()
    (out / "study.toml").write_text(text + "\n[search]\ndoubt = 0.5\n")
    study = mf.load(out / "study.toml")
    mf.run(replace(study, pareto=mf.Pareto(points=3)), out / "results")
    return out


def test_a_study_is_run_by_its_path_as_a_text_or_a_path(tmp_path: Path) -> None:
    write_example("three-story-c0", tmp_path)
    path = tmp_path / "study.toml"
    text = path.read_text().replace("points = 20", "points = 2")
    path.write_text(text + "\n[search]\ndoubt = 0.5\n")
    first, second = mf.run(str(path)), mf.run(path, tmp_path / "results")
    np.testing.assert_array_equal(first["theta"], second["theta"])
    assert (tmp_path / "results" / "results.nc").is_file()
    with pytest.raises(mf.InputError, match=r"none\.toml"):
        mf.run("none.toml")


def assert_short(shown: Any) -> None:
    assert 1 <= len(repr(shown).splitlines()) <= 20
    assert max(map(len, repr(shown).splitlines())) <= 300
    assert "<" in shown._repr_html_()


def test_a_study_is_checked_as_file_and_as_problem(folder: Path) -> None:
    path = folder / "study.toml"
    study = mf.load(path)
    of_study, of_path, of_problem = mf.check(study), mf.check(path), mf.check(study.problem)
    assert str(of_study) == str(of_path)
    assert of_problem.sound
    assert of_problem.mistakes == of_study.mistakes


def test_results_are_shown_in_a_few_lines(folder: Path) -> None:
    study = mf.load(folder / "study.toml")
    results = mf.read_results(folder / "results", study.problem)
    compared = mf.compare([folder / "results"])
    for shown in (
        *(study, study.problem, study.problem.data, mf.check(study), results, results.reference),
        *(results.reference.modes(2), results.shapes(0), results.plot),
        *(compared, compared.fronts[0]),
    ):
        assert_short(shown)
    said = json.loads(as_json(results.data))["remarks"]
    assert said == list(map(str, results.findings))


def test_every_public_class_is_shown_in_a_few_lines(folder: Path) -> None:
    study = mf.load(folder / "study.toml")
    problem, results = study.problem, mf.read_results(folder / "results")
    sensor = problem.data.sensors[0]
    sensor, weights = problem.data.sensors[0], {"frequencies": 1.0, "shapes": 1.0}
    passage = mf.Passage("wind", [sensor], 1e-3, "two", [0.1], 10.0, force=[sensor], damping=0.02)
    shown = (
        *(study, problem, problem.data, problem.groups[0], problem.pairing, problem.model),
        *(study.pareto, study.search, study.identifiability, study.uncertainty, study.noise),
        *(mf.Parameter("k", 1.0, (0.2, 5.0)), mf.Prior(), mf.Reduction(), mf.SoilFilter(2.0, 0.6)),
        *(mf.PeakResponse("push", force=sensor, response=[sensor], damping=0.02), passage),
        *(
            mf.Passage.kind,
            METHODS["nbi"],
            KINDS["chain"],
            mf.DataReader(".rows", lambda path, _: mf.read_csv(path)),
        ),
        *(mf.Weighted("half", weights), results, results.reference),
    )
    for each in shown:
        assert_short(each)
    classes = {getattr(mf, name) for name in mf.__all__}
    public = {x for x in classes if isinstance(x, type) and not issubclass(x, Exception)}
    assert public - set(map(type, shown)) == {mf.Prediction}, "a protocol is no class of results"


def test_fronts_are_compared_by_the_texts_of_their_paths(folder: Path) -> None:
    name = str(folder / "results")
    comparison = mf.compare([name, name])
    assert comparison.pairs[0].least == 0.0
    assert "reference model" in comparison.table.index
    assert [front.name for front in mf.compare(name).fronts] == [name]


def test_no_folder_at_all_is_refused() -> None:
    for function in (mf.compare, mf.report):
        with pytest.raises(mf.InputError, match="one folder of results or more, found none"):
            function([])


def test_a_report_is_written_beside_the_results_or_where_it_is_wanted(folder: Path) -> None:
    assert mf.report(str(folder / "results")) == folder / "results" / "report.html"
    page = mf.report([folder / "results", folder / "results"], folder / "both.html")
    assert page.read_text(encoding="utf-8").startswith("<!doctype html>")
    with pytest.raises(mf.InputError, match=r"ends in \.html, found 'page\.txt'"):
        mf.report(folder / "results", folder / "page.txt")


def test_a_model_is_exported_with_the_study_that_its_results_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_example("three-story-c0", tmp_path)
    study = mf.load(tmp_path / "study.toml")
    quick = replace(study, pareto=mf.Pareto(points=2), search=QUICK)
    mf.run(quick, tmp_path / "results")
    with pytest.raises(mf.InputError, match="the label of a model"):
        mf.export(tmp_path / "results", point="nbi-0")
    with pytest.raises(mf.InputError, match="with other inputs"):
        mf.export(tmp_path / "results")  # options that were changed in Python are in no file
    made = read_dataset(tmp_path / "results").assign_attrs(
        {"inputs": ""}
    )  # as of a study without file
    monkeypatch.setattr("modefront.study.export.read_dataset", lambda _: made)
    with pytest.raises(mf.InputError, match=r"a study in a file .* made in Python"):
        mf.export(tmp_path / "results")


def test_modes_of_a_test_are_data_of_a_study(tmp_path: Path) -> None:
    write_example("hammer-test", tmp_path)
    found = mf.identify(str(tmp_path / "m0-set1-floor3.csv"), band=(1.0, 25.0))
    assert_short(found)
    assert found.data.frequency[0, 0] == pytest.approx(4.7357, rel=1e-3)
    written = found.write(tmp_path / "modes.csv")
    assert [path.name for path in written] == [
        "modes.csv",
        "modes-covariance.csv",
        "modes-identification.json",
    ]
    np.testing.assert_allclose(mf.read_csv(written[0]).frequency, found.data.frequency, rtol=1e-6)


def test_a_program_that_is_not_known_is_named() -> None:
    with pytest.raises(mf.InputError, match=r"one of calculix, abaqus, .*found 'calculx'"):
        mf.import_model("calculx", "base", {"E": "E2"})
