"""The commands: what they print, leave behind and return."""

import errno
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from interruptions import interrupt_after
from texts import two_of_each

import modefront
from modefront.cli.main import main
from modefront.datasets import Dataset
from modefront.errors import UnfinishedError
from modefront.front.options import Pareto
from modefront.front.subproblems import Least
from modefront.optim.problem import Problem
from modefront.optim.sqp import Solution
from modefront.results.files import FILE, read_dataset
from modefront.study import session
from modefront.study.examples import names
from modefront.study.file import load
from modefront.uncertainty.prior import NoisePrior
from modefront.work import store as lock

pytestmark = pytest.mark.usefixtures("short_chains")

STUDY = (
    """
[study]
name = "two masses"
seed = 3

[data]
file = "modes.csv"

[model]
kind = "chain"
masses = [2.0, 1.0]
stiffnesses = [3000.0, 2000.0]
stiffness_parameters = ["k1", "k2"]

"""
    + two_of_each()
    + """
[[weighted]]
name = "mine"
weights = { frequencies = 2.0, shapes = 1.0 }

[pareto]
points = 3

[search]
doubt = 0.5

[noise]
weight = 0
"""
)

DATA = """set,mode,frequency,damping,floor1,floor2
a,1,4.2,,0.6,1.0
a,2,10.5,,1.0,-0.7
b,1,4.1,,,1.0
"""

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def modefront_(capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Run:
    """Return a function that runs a command and returns (status, output, errors)."""

    def run(*arguments: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["modefront", *map(str, arguments)])
        with pytest.raises(SystemExit) as left:
            main()
        out, err = capfd.readouterr()
        assert isinstance(left.value.code, int)
        assert "Traceback" not in err
        return left.value.code, out, err

    return run


def write_study(folder: Path) -> Path:
    (folder / "modes.csv").write_text(DATA)
    file = folder / "study.toml"
    file.write_text(STUDY)
    return file


@pytest.fixture
def study(tmp_path: Path) -> Path:
    return write_study(tmp_path)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of results of a run that was not interrupted."""
    file = write_study(tmp_path_factory.mktemp("whole"))
    modefront.run(modefront.load(file), file.with_name("study-results"))
    return file.with_name("study-results")


@pytest.fixture
def done(study: Path, whole: Path) -> Path:
    """A copy of these results where the study would put its own."""
    return Path(shutil.copytree(whole, study.with_name("study-results")))


def assert_same(first: Dataset, other: Dataset) -> None:
    """Assert that two results agree to the last bit, in what they cost as well."""
    assert first.attrs == other.attrs
    assert set(first.variables) == set(other.variables)
    for name in first.variables:
        assert first[name].dims == other[name].dims
        if first[name].values.dtype.kind in "fib":
            assert first[name].values.tobytes() == other[name].values.tobytes(), name
        else:
            assert first[name].values.tolist() == other[name].values.tolist(), name


def contents(folder: Path) -> list[bytes]:
    files = [path for path in folder.rglob("*") if path.is_file()]
    return [path.read_bytes() for path in files if path.name != lock.FILE]


def test_help_and_version(modefront_: Run) -> None:
    for arguments in (["--help"], ["-h"]):
        status, out, err = modefront_(*arguments)
        assert (status, err) == (0, "")
        for command in ("init", "check", "run", "show", "compare"):
            assert command in out
            assert modefront_(command, "--help")[0] == 0
    assert modefront_("--version") == (0, f"modefront, version {modefront.__version__}\n", "")


def test_help_names_the_examples(modefront_: Run) -> None:
    listed = re.search(r"One of (.*?)\.", " ".join(modefront_("init", "--help")[1].split()))
    assert listed
    told = listed[1].replace(" -", " three-story-").replace(" and", ",").split(", ")
    assert told == names()


def test_the_study_to_start_from_leaves_errors_and_programme_to_their_defaults(
    modefront_: Run, tmp_path: Path
) -> None:
    assert modefront_("init", tmp_path / "first")[0] == 0
    study = load(tmp_path / "first" / "study.toml")
    assert (study.noise, study.pareto.programme) == (NoisePrior(), Pareto().programme)


def test_help_waits_for_nothing_that_takes_long_to_import() -> None:
    code = (
        "import sys, modefront.cli.main\n"
        "sys.exit(' '.join({'numpy', 'scipy', 'xarray', 'rich', 'cma'} & set(sys.modules)) or 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
    assert done.returncode == 0, done.stderr


def test_from_nothing_to_results(modefront_: Run, tmp_path: Path) -> None:
    folder = tmp_path / "first"
    status, out, _ = modefront_("init", folder)
    assert status == 0
    assert f"wrote {folder / 'study.toml'}" in out
    assert f"next: modefront check {folder / 'study.toml'}" in out
    status, out, err = modefront_("check", folder / "study.toml")
    assert (status, err) == (0, "")
    assert out.endswith(f"next: modefront run {folder / 'study.toml'}\n")
    assert "a search ends after 20,000 evaluations" in out
    assert "derivatives agree with finite differences" in out
    assert "no warnings" in out
    found = sorted(path.name for path in folder.iterdir())
    assert found == ["modes.csv", "study.schema.json", "study.toml"]


def test_alone_the_command_prints_its_help_once(modefront_: Run) -> None:
    status, out, err = modefront_()
    assert (status, err) == (0, "")
    assert out.count("Usage:") == 1
    assert "  check " in out


def test_fronts_are_compared_by_text_or_path_and_a_study_is_shown_in_a_line(
    study: Path, done: Path
) -> None:
    assert modefront.compare([str(done), str(done)]) == modefront.compare([done, done])
    loaded = modefront.load(study)
    assert len(repr(loaded)) < 300
    assert "two masses" in repr(loaded)
    assert repr(modefront.check(loaded)).count("\n") < 20


def test_results_lie_where_they_are_wanted(modefront_: Run, study: Path, done: Path) -> None:
    status, out, _ = modefront_("run", study)
    assert status == 0
    assert f"modefront show {done}" in " ".join(out.split())
    data = read_dataset(done)
    assert data.attrs["study"] == "two masses"
    assert data.attrs["seed"] == 3
    labels = [f"nbi-{i + 1}" for i in range(3)]
    labels += ["edge-frequencies", "edge-shapes", "mine", "equal-weights", "optimal-weights"]
    labels += ["nominal"]
    assert data["label"].values.tolist() == labels
    mine = data.isel(point=labels.index("mine"))
    assert mine["weight"].values.tolist() == [2.0, 1.0]

    requested = study.with_name("elsewhere") / "deep"
    assert modefront_("run", study, "-o", requested)[0] == 0
    assert_same(read_dataset(requested), data)


def test_show_prints_tables_and_json_without_nan(modefront_: Run, whole: Path) -> None:
    status, out, err = modefront_("show", whole, "--all")
    assert (status, err) == (0, "")
    for text in ("two masses", "nbi-3", "equal-weights", "k1", "frequencies", "MAC 2"):
        assert text in out

    def refuse(constant: str) -> None:
        raise AssertionError(f"{constant} is no JSON")

    status, out, err = modefront_("show", whole, "--format", "json")
    assert (status, err) == (0, "")
    result = json.loads(out, parse_constant=refuse)
    data = read_dataset(whole)
    assert set(result["variables"]) == set(data.variables)
    for name, value in result["variables"].items():
        assert tuple(value["dimensions"]) == data[name].dims
    assert result["variables"]["theta"]["values"] == data["theta"].values.tolist()
    assert result["variables"]["weight"]["values"][0] == [None, None]
    assert result["attributes"]["model_evaluations"] == data.attrs["model_evaluations"]


def test_compare_prints_tables_and_json(modefront_: Run, whole: Path) -> None:
    status, out, err = modefront_("compare", whole, whole)
    assert (status, err) == (0, "")
    for text in ("Studies side by side", "frequency 2", "k1, k2", "reference"):
        assert text in out
    status, out, err = modefront_("compare", whole, whole, "--format", "json")
    assert (status, err) == (0, "")
    result = json.loads(out)
    assert result["groups"] == ["frequencies", "shapes"]
    assert result["fronts"][1]["length_ratio"] == 1.0
    assert result["pairs"][0]["common"] == ["k1", "k2"]


@pytest.mark.slow(2)
def test_a_front_is_refined_where_neighbours_are_far_apart(
    modefront_: Run, study: Path, done: Path
) -> None:
    coarse = read_dataset(done)
    assert modefront_("run", study, "--refine", "0.1")[0] == 0
    fine = read_dataset(done)
    assert fine.attrs["refined"] == 0.1
    assert fine.attrs["largest_gap"] <= 0.1 < coarse.attrs["largest_gap"]
    assert fine.attrs["hypervolume"] >= coarse.attrs["hypervolume"]
    assert bool(fine["converged"].values.all())
    assert modefront_("run", study)[0] == 0
    assert_same(read_dataset(done), coarse)


def test_bounds_within_which_there_is_no_model_are_said_and_leave_no_results(
    modefront_: Run, study: Path
) -> None:
    # The nominal model can be evaluated, and next to nothing else: stiffnesses are negative.
    study.write_text(STUDY.replace("bounds = [0.2, 5.0]", "bounds = [-1e6, 1.0]"))
    status, out, err = modefront_("run", study)
    assert (status, out) == (1, "")
    assert "modefront: the model cannot be evaluated at any of the parameters tried" in err
    assert not study.with_name("study-results").joinpath(FILE).exists()


def test_where_no_start_leads_to_an_edge_the_best_known_models_are_its_place(
    modefront_: Run, study: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def failed(_: Least, __: Problem, start: Solution, *___: object) -> Solution:
        return replace(start, evaluation=replace(start.evaluation, J=np.full(2, np.nan)))

    monkeypatch.setattr(Least, "solve", failed)
    study.write_text(study.read_text().replace("[search]\n", "[search]\nevaluations = 1000\n"))
    status, out, err = modefront_("run", study)
    results = read_dataset(study.with_name("study-results"))
    J, edges = results["objective"].values, results["kind"].values == "edge"
    assert status == (1 if "not converged, kept and marked as such" in err else 0), "it is said"
    assert (bool(results["converged"].values.all()), err.count("error")) == (status == 0, 0)
    assert out
    assert np.diag(J[edges]) == pytest.approx(J.min(axis=0), rel=1e-3)


def test_an_interrupted_run_goes_on_to_the_same_results(
    modefront_: Run, study: Path, whole: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    broken, tasks = study.with_name("broken"), 5
    interrupt_after(tasks, monkeypatch)
    status, out, err = modefront_("run", study, "-o", broken)
    assert status == 130
    assert out == ""
    assert "interrupted; what was done is kept" in err
    assert not (broken / FILE).exists()
    kept = {path: path.stat().st_mtime_ns for path in broken.rglob("*.npz")}
    assert len(kept) == tasks
    assert modefront_("run", study, "-o", broken)[0] == 0
    assert {path: path.stat().st_mtime_ns for path in kept} == kept, "they are not done again"
    assert_same(read_dataset(broken), read_dataset(whole))


def test_a_run_that_is_done_is_not_done_again(
    modefront_: Run, study: Path, done: Path, whole: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    interrupt_after(0, monkeypatch)
    assert modefront_("run", study)[0] == 0
    assert_same(read_dataset(done), read_dataset(whole))
    assert [path.name for path in done.glob("*.nc")] == [FILE]


def test_what_another_program_has_kept_is_done_again(
    modefront_: Run, study: Path, done: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert "by another version" not in modefront_("run", study)[2]
    (kept,) = (done / "tasks").glob("*-*")
    monkeypatch.setattr(session, "_program", lambda: "other")
    interrupt_after(0, monkeypatch)
    status, _, err = modefront_("run", study)
    assert status == 130
    assert f"not taken over, and may be deleted: {kept}, by another version" in err
    assert (done / FILE).exists()


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_a_damaged_piece_is_done_again(
    modefront_: Run, study: Path, done: Path, whole: Path
) -> None:
    for i, piece in enumerate(sorted(done.rglob("*.npz"))[:6]):
        content = piece.read_bytes()
        piece.write_bytes([content[:-40], content[:30], b"no piece"][i % 3])
    assert modefront_("run", study)[0] == 0
    assert_same(read_dataset(done), read_dataset(whole))


def test_fresh_starts_over_and_deletes_nothing(
    modefront_: Run, study: Path, done: Path, whole: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = contents(done)
    interrupt_after(1, monkeypatch)
    assert modefront_("run", study, "--fresh")[0] == 130, "it does the work again"
    assert len(contents(done)) == len(before) + 1
    assert modefront_("run", study, "--fresh")[0] == 0
    assert_same(read_dataset(done), read_dataset(whole))
    after = contents(done)
    assert all(content in after for content in before)
    assert len(after) == 2 * len(before) + 1


@pytest.mark.slow(5)
@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("study.toml", "seed = 3", "seed = 4"),
        ("modes.csv", "10.5", "10.6"),
    ],
)
def test_a_changed_study_mixes_with_nothing_old(
    file: str, old: str, new: str, modefront_: Run, study: Path, done: Path
) -> None:
    clean = study.with_name("clean")
    before = contents(done)
    changed = study.with_name(file)
    text = changed.read_text()
    changed.write_text(text.replace(old, new))
    assert modefront_("run", study)[0] == 0
    modefront_("run", study, "-o", clean)
    assert_same(read_dataset(done), read_dataset(clean))
    after = contents(done)
    assert all(content in after for content in before), "old tasks and results are kept"

    changed.write_text(text)
    assert modefront_("run", study)[0] == 0
    assert len(contents(done)) == len(after) + 1, "only results.nc is written anew"


def failing(error: BaseException) -> Callable[..., None]:
    def run(*_: object, **__: object) -> None:
        raise error

    return run


@pytest.mark.parametrize(
    ("error", "status", "says"),
    [
        (UnfinishedError("no minimum was found"), 1, "modefront: no minimum was found\n"),
        (
            OSError(errno.ENOSPC, "No space left on device"),
            1,
            "no space left on the drive: free some",
        ),
        (KeyboardInterrupt(), 130, "modefront: interrupted"),
        (ZeroDivisionError("oh"), 1, "an error of the program itself: ZeroDivisionError: oh"),
    ],
)
def test_what_goes_wrong_on_the_way_is_one_message(
    error: BaseException,
    status: int,
    says: str,
    modefront_: Run,
    study: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(session, "run", failing(error))
    result, out, err = modefront_("run", study)
    assert (result, out) == (status, "")
    assert says in err


def test_an_interrupt_that_a_file_turns_into_an_error_is_one(
    modefront_: Run, study: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class HalfOpen:
        """Cannot be closed, as an archive in which a file is being opened."""

        def close(self) -> None:
            raise ValueError("an open writing handle")

        __del__ = close

    def run(*_: object, **__: object) -> None:
        with closing(HalfOpen()):
            signal.raise_signal(signal.SIGTERM)

    monkeypatch.setattr(session, "run", run)
    monkeypatch.setattr(sys, "unraisablehook", sys.__unraisablehook__)  # not that of the tests
    status, out, err = modefront_("run", study)
    assert (status, out) == (130, "")
    assert err.endswith("modefront: interrupted; what was done is kept, run again to continue\n")
    assert "writing handle" not in err


def test_the_traceback_is_there_for_those_who_ask(
    study: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(session, "run", failing(ZeroDivisionError("oh")))
    monkeypatch.setattr(sys, "argv", ["modefront", "run", str(study)])
    monkeypatch.setenv("MODEFRONT_TRACEBACK", "1")
    with pytest.raises(ZeroDivisionError):
        main()


def test_points_that_did_not_converge_are_said_and_kept(
    modefront_: Run, study: Path, done: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = session.run

    def doubtful(*arguments: Any, **options: Any) -> modefront.Results:
        data = run(*arguments, **options)
        data["converged"][1] = False
        return data

    monkeypatch.setattr(session, "run", doubtful)
    status, out, err = modefront_("run", study)
    assert status == 1
    assert "not converged: nbi-2" in out
    assert "modefront: not converged, kept and marked as such: nbi-2\n" in err
    assert study.with_name("study-results").joinpath(FILE).exists()


def start(arguments: Sequence[object]) -> "subprocess.Popen[str]":
    # A test run in the background ignores interrupts, and so would its children.
    heard = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)"
    code = f"{heard}; from modefront.cli.main import main; main()"
    return subprocess.Popen(
        [sys.executable, "-c", code, *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


@pytest.mark.skipif(os.name == "nt", reason="Windows sends no signal to one process alone")
def test_a_signal_interrupts_and_leaves_what_was_done(study: Path, tmp_path: Path) -> None:
    study.write_text(STUDY.replace("points = 3", "points = 300"))
    folder = tmp_path / "signalled"
    with start(["run", study, "-o", folder]) as process:
        while process.poll() is None and len(list(folder.rglob("*.npz"))) < 5:
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert out == ""
    assert "interrupted; what was done is kept" in err
    assert "Traceback" not in err
    assert len(list(folder.rglob("*.npz"))) >= 5
    assert not (folder / FILE).exists()


@pytest.mark.skipif(os.name == "nt", reason="pipes are closed otherwise on Windows")
def test_a_reader_that_leaves_early_is_no_error_to_speak_of(whole: Path) -> None:
    with start(["show", whole, "--format", "json"]) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        err = process.stderr.read()
    assert process.returncode == 1
    assert err == ""
