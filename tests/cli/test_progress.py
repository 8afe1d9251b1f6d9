"""Progress in a terminal and in a log, and estimates of the time."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path

import pytest
from rich.console import Console

import modefront as mf
from modefront.cli.progress import _Lines, _Log
from modefront.front.search import Search
from modefront.study.estimate import SHORT, Estimate, duration, estimate, expected_tasks
from modefront.study.examples import write_example
from modefront.work.costs import Costs
from modefront.work.progress import State, listening, note, note_iteration


def drawn(lines: _Lines, width: int) -> list[str]:
    stream = io.StringIO()
    Console(file=stream, width=width, force_terminal=False).print(lines)
    return stream.getvalue().splitlines()


def test_work_inside_a_long_task_is_seen_and_the_time_goes_on() -> None:
    now = 0.0
    costs = Costs()
    lines = _Lines("a study of a bridge", costs, lambda: now, began=0.0)
    assert drawn(lines, 80)[1] == "starting"
    lines.take(State("front", 2, 1, 27, 0.0, 100.0))
    now, costs.eigenproblems = 30.0, 143
    with listening(lines.hear):
        note("search 7 of at most 60")
        note_iteration(12)
    note("heard by nobody")
    first, second = drawn(lines, 80)
    assert len(first) <= 80
    assert first.startswith("a study of a bridge ")
    assert first.rstrip().endswith("2 of about 27 tasks  0:00:30")
    words = "front, search 7 of at most 60, iteration 12, 143 models solved, 70 s or more"
    assert second == words
    with listening(lines.hear):
        note("search 8 of at most 60")
    assert "search 8 of at most 60, 143 models" in drawn(lines, 80)[1], "a new one has no steps yet"
    lines.take(State("front", 3, 0, 27, 30.0, 50.0))
    now = 40.0
    assert drawn(lines, 80)[1] == "front, 143 models solved, 40 s or more"
    lines.end()
    assert drawn(lines, 80)[0].rstrip().endswith(" 3 tasks  0:00:40")


def test_what_is_not_known_of_the_time_is_not_said() -> None:
    lines = _Lines("a study", Costs(), lambda: 0.0, began=0.0)
    lines.take(State("predict", 3, 1, 9, 0.0, 40.0, (2, 8)))
    assert drawn(lines, 80)[1] == "predictions 2 of about 8, about 40 s left"
    lines.take(State("edges", 349, 1, 384, 0.0, 19.0, (349, 350), surpassed=True))
    assert drawn(lines, 80)[1] == "edges and weighted models 349, longer than expected"


def test_nothing_is_cut_in_a_narrow_terminal() -> None:
    lines = _Lines("three-story C0, chain M0", Costs(), lambda: 0.0, began=0.0)
    lines.take(State("probe-basis", 12, 1, 12345, 0.0, 5000.0))
    lines.hear("search 12 of at most 1000000")
    text = " ".join(" ".join(drawn(lines, 40)).split())
    assert "…" not in text
    assert "completeness of the basis, search 12 of at most 1000000, 83 min or more" in text


def test_a_log_has_a_line_a_stage() -> None:
    stream = io.StringIO()
    log = _Log(Console(file=stream), "a\x1b[31m")
    for done in range(3):
        log(State("front", done, 1, 20, 1.0, 100.0 * done))
    log(State("edges", 3, 0, 20, 1.0, None))
    assert stream.getvalue() == (
        "a\\x1b[31m: 0 of about 20 tasks done: front\n"
        "a\\x1b[31m: 3 of about 20 tasks done: edges and weighted models\n"
    )


def test_the_time_of_a_run_is_estimated_and_more_work_takes_longer(tmp_path: Path) -> None:
    write_example("three-story-c0", tmp_path)
    study = mf.load(tmp_path / "study.toml")
    short = estimate(study)
    assert short is not None
    assert 300 < short.evaluations < 3000  # a run evaluates 836
    assert short.seconds == pytest.approx(short.evaluations * short.each, rel=0.01)
    assert "models at" in short.text
    few = estimate(replace(study, search=Search(evaluations=100)))
    assert few is not None
    assert few.evaluations < short.evaluations
    points = estimate(replace(study, pareto=mf.Pareto(points=9000)))
    assert points is not None
    assert points.evaluations > 10 * short.evaluations


def test_steps_in_many_parameters_are_a_part_of_the_estimate() -> None:
    long = Estimate(8400.0, 20_000, 0.04, 7600.0, (), {})
    assert "2.1 h for steps in so many parameters" in long.text
    assert "predictions" not in long.text
    short = Estimate(840.0, 20_000, 0.04, 40.0, (), {})
    assert "steps" not in short.text


def test_predictions_are_timed_with_few_samples_and_expected_from_the_start(tmp_path: Path) -> None:
    write_example("three-story-c0", tmp_path)
    study = mf.load(tmp_path / "study.toml")
    noise = mf.Passage(
        name="noise", force="floor1", response=["floor1"], levels=[1e-4], density=1e-4, sided="two",
        duration=1.0, step=0.01, damping=0.02, samples=10**8,
    )  # fmt: skip
    long = estimate(replace(study, predictions=[noise]))
    short = estimate(study)
    assert long is not None
    assert short is not None
    assert long.seconds > SHORT + short.seconds
    assert long.evaluations == pytest.approx(short.evaluations, rel=0.01)
    assert "for predictions" in long.text
    assert any("prediction 'noise': fewer samples" in text for text in long.advice)
    assert long.advice[-1].startswith("--workers")
    tasks = expected_tasks(replace(study, predictions=[noise]))
    assert tasks["front"] >= 20
    assert tasks["predict"] == 20 + 2 + 3 + 1 + 2 * 3 + (noise.kind.check is not None)


def test_durations_are_in_the_unit_that_suits_them() -> None:
    assert [duration(x) for x in (0.0123, 0.5, 45.0, 240.0)] == ["12 ms", "0.5 s", "45 s", "4 min"]
