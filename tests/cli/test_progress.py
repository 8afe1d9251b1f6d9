"""Progress in a terminal and in a log, and estimates of the time."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from rich.console import Console

import modefront as mf
from modefront.cli.progress import _Lines, _Log
from modefront.front.search import Search
from modefront.front.subproblems import Least
from modefront.optim.sqp import Solution
from modefront.study.estimate import SHORT, TIMED, duration, estimate
from modefront.study.examples import write_example
from modefront.work.progress import ITERATION, State, listening, note, together
from modefront.work.task import Costs


def drawn(lines: _Lines, width: int) -> list[str]:
    stream = io.StringIO()
    Console(file=stream, width=width, force_terminal=False).print(lines)
    return stream.getvalue().splitlines()


def test_work_inside_a_long_task_is_seen_and_the_time_goes_on() -> None:
    now = 0.0
    costs = Costs()
    lines = _Lines("a study of a bridge", costs, lambda: now, began=0.0)
    assert drawn(lines, 80)[1] == "starting"
    lines.take(State("front", 2, 1, (100.0, 400.0)))
    now, costs.eigenproblems = 30.0, 143
    with listening(lines.hear):
        note("search 7 of 60")
        note(f"{ITERATION}12")
    note("heard by nobody")
    first, second = drawn(lines, 80)
    assert len(first) <= 80
    assert first.startswith("a study of a bridge ")
    assert first.rstrip().endswith(" 2 tasks  0:00:30")
    words = "front, search 7 of 60, iteration 12, 143 models solved, 70 s to 6 min left"
    assert second == words
    with listening(lines.hear):
        note("search 8 of 60")
    assert "search 8 of 60, 143 models" in drawn(lines, 80)[1], "a new one has no steps yet"
    lines.take(State("front", 3, 0, (50.0, np.inf)))
    now = 40.0
    assert drawn(lines, 80)[1] == "front, 143 models solved, 40 s or more"
    lines.take(State("front", 3, 0, (5.0, 60.0)))
    now = 101.0
    assert drawn(lines, 80)[1] == "front, 143 models solved, longer than expected"
    lines.is_done = True
    assert drawn(lines, 80)[0].rstrip().endswith(" 3 tasks  0:01:41")


def test_what_is_not_known_of_the_time_is_not_said() -> None:
    lines = _Lines("a study", Costs(), lambda: 0.0, began=0.0)
    lines.take(State("predict", 3, 1, (0.2, 40.0), 2, (8, 8)))
    assert drawn(lines, 80)[1] == "predictions 2 of 8, at most 40 s left"
    lines.take(State("bootstrap", 3, 1, (0.2, 40.0), 2, (8, 12)))
    assert drawn(lines, 80)[1] == "bootstrap 2 of 8 to 12, at most 40 s left"
    lines.take(State("edges", 349, 1, (0.0, np.inf), 349))
    assert drawn(lines, 80)[1] == "edges and weighted models 349, longer than expected"


def test_nothing_is_cut_in_a_narrow_terminal() -> None:
    lines = _Lines("three-story C0, chain M0", Costs(), lambda: 0.0, began=0.0)
    lines.take(State("probe-basis", 12, 1, (3000.0, 5000.0)))
    lines.hear("search 12 of at most 1000000")
    text = " ".join(" ".join(drawn(lines, 40)).split())
    assert "…" not in text
    assert "completeness of the basis, search 12 of at most 1000000, 50 min to 83 min left" in text


def test_a_log_has_a_line_a_stage() -> None:
    stream = io.StringIO()
    log = _Log(Console(file=stream), "a\x1b[31m")
    for done in range(3):
        log(State("front", done, 1, (100.0 * done, 400.0)))
    log(State("edges", 3, 0, None))
    assert stream.getvalue() == (
        "a\\x1b[31m: 0 tasks done: front, at most 7 min left\n"
        "a\\x1b[31m: 3 tasks done: edges and weighted models\n"
    )


def test_as_many_searches_are_timed_whatever_the_first_ones_take(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else one is the last because it is long, and the mean of few is too great.

    What the first one imports is no part of a search, and one in twenty is as long as it.
    """
    now, counts, solve = [0.0], list[int](), Least.solve

    def slow(self: Least, *given: Any) -> Solution:
        found = solve(self, *given)
        counts.append(1 + found.evaluations)
        now.append(now[-1] + 2.0 * counts[-1] + 50.0 * (len(counts) == 1))
        return found

    monkeypatch.setattr(Least, "solve", slow)
    monkeypatch.setattr(
        "modefront.study.estimate.time", SimpleNamespace(process_time=lambda: now[-1])
    )
    write_example("three-story-c0", tmp_path)
    found = estimate(mf.load(tmp_path / "study.toml"))
    assert found is not None
    assert len(now) == 1 + TIMED
    assert found.search == pytest.approx(2.0 * (0.05 * counts[0] + 0.95 * np.mean(counts[1:])))


def test_the_time_of_a_run_is_estimated_and_more_work_takes_longer(tmp_path: Path) -> None:
    write_example("three-story-c0", tmp_path)
    study = mf.load(tmp_path / "study.toml")
    short = estimate(study)
    assert short is not None
    few, many = (sum(x) for x in zip(*short.searches.values(), strict=True))
    assert 20 < few < 85 < many < 1000, "a run makes about 85 searches"
    assert set(short.plan) == set(short.searches), (
        "with weight = 0 there is no posterior to draw from"
    )
    least, most = short.range
    assert least == pytest.approx(few * short.search)
    assert least < most < many * short.search, "not all long"
    assert "searches of" in short.text
    started = estimate(study, 10.0)  # seconds until the study was read
    assert started is not None
    before, after = np.subtract(started.range, together(started.plan.values()))
    assert before == pytest.approx(10.0)
    assert after < 20.0
    small = estimate(replace(study, search=Search(evaluations=100)))
    assert small is not None
    assert small.searches["edges"][1] < short.searches["edges"][1]
    doubtful = estimate(replace(study, search=Search(doubt=0.9)))
    assert doubtful is not None
    assert doubtful.searches["edges"] == pytest.approx((3.0, 4.0)), "one start of each at least"
    assert 0 < doubtful.range[0] < doubtful.range[1]
    points = estimate(replace(study, pareto=mf.Pareto(points=9000)))
    assert points is not None
    assert points.searches["front"][0] > 100 * short.searches["front"][0]


def test_predictions_are_timed_with_few_samples(tmp_path: Path) -> None:
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
    assert long.range[0] > SHORT + short.range[1]
    assert long.searches == short.searches
    assert "for predictions" in long.text
    assert any("prediction 'noise': fewer samples" in text for text in long.advice)
    assert long.advice[-1].startswith("--workers")


def test_durations_are_in_the_unit_that_suits_them() -> None:
    assert [duration(x) for x in (0.0123, 0.5, 45.0, 240.0)] == ["12 ms", "0.5 s", "45 s", "4 min"]
