"""Executors: each task once, in its order, with costs and random numbers of its own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from problems import Known, box, circles

from modefront._typing import Floats
from modefront.front.dominance import Archive
from modefront.front.search import Outcome, recorded
from modefront.optim.problem import Problem
from modefront.work.progress import Progress, State, together
from modefront.work.store import Run, Store
from modefront.work.task import (
    IMMEDIATE,
    Costs,
    Count,
    Executor,
    R,
    Task,
    Within,
    counted,
    seed_sequence,
    spend,
    uncounted,
)

CALLS: list[int] = []


@pytest.fixture(autouse=True)
def _no_calls() -> None:
    CALLS.clear()


def square(x: int) -> int:
    CALLS.append(x)
    spend(Costs(eigenproblems=x))
    return x * x


def normal(scale: float, *, rng: np.random.Generator) -> Floats:
    return scale * rng.normal(size=2)


def squares(*numbers: int) -> list[Task[int]]:
    return [Task(("square", x), square, (x,)) for x in numbers]


def test_results_come_in_the_order_of_tasks() -> None:
    for work in (IMMEDIATE, Run()):
        assert work.run(squares(3, 1, 2)) == [9, 1, 4]
        assert work.run([]) == []


def test_two_tasks_of_one_key_are_refused() -> None:
    work = Run()
    with pytest.raises(ValueError, match="two tasks are named square-3"):
        work.run(squares(3, 3))
    assert not CALLS
    work.run(squares(3))
    with pytest.raises(ValueError, match="two tasks are named square-3"):
        work.run(squares(3))
    assert Within(work, turn=("round", 2)).run(squares(3)) == [9], "another turn is another task"
    assert CALLS == [3, 3]


def test_what_is_kept_is_not_computed_again(tmp_path: Path) -> None:
    first = Run(Store(tmp_path))
    first.run(squares(1, 2))
    again = Run(Store(tmp_path))
    assert again.run(squares(1, 2, 3)) == [1, 4, 9]
    assert CALLS == [1, 2, 3]
    assert again.total().eigenproblems == 1 + 2 + 3, "what it has cost then counts"
    assert again.progress.spent.eigenproblems == 3, "what it costs now is told apart"
    Run().run(squares(1))
    assert CALLS == [1, 2, 3, 1], "nothing is kept without a store"


def test_each_task_has_its_own_costs_and_all_of_them_add_up(costs: Costs) -> None:
    work = Run()
    spend(Costs(eigenproblems=100))
    work.run(squares(1, 2))
    work.run([Task(("other", "x"), square, (5,))])
    assert {key: each.eigenproblems for (key, _), each in work.costs.items()} == {
        ("square", 1): 1,
        ("square", 2): 2,
        ("other", "x"): 5,
    }
    assert work.total(lambda stage: stage == "square").eigenproblems == 3
    every = Costs()
    for each in work.costs.values():
        every.add(each)
    assert work.total() == every
    assert costs.eigenproblems == 100 + 1 + 2 + 5


def test_counts_are_nested_and_work_may_be_left_out(costs: Costs) -> None:
    with counted() as outer:
        spend(Costs(reduced=1))
        with counted() as inner, uncounted():
            spend(Costs(reduced=10))
            with counted() as alone:
                spend(Costs(reduced=100))
        spend(Costs(eigenproblems=2, corrected=3))
    spend(Costs(reduced=1000))
    assert (inner.reduced, alone.reduced) == (0, 100)
    assert outer == Costs(eigenproblems=2, reduced=1, corrected=3)
    assert outer.model_evaluations == 3
    assert costs.reduced == 1001
    failed = Costs()

    def fail() -> None:
        nonlocal failed
        with counted() as failed:
            spend(Costs(reduced=1))
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    spend(Costs(reduced=1))
    assert failed.reduced == 1, "a count ends where its context does"


def test_a_task_that_fails_keeps_nothing_and_can_be_run_again(tmp_path: Path) -> None:
    work = Run(Store(tmp_path))
    with pytest.raises(TypeError):
        work.run([*squares(1), Task(("wrong",), square, ("x",))])
    again = Run(Store(tmp_path))
    again.run([*squares(1), Task(("wrong",), square, (7,))])
    assert CALLS == [1, "x", 7]


def test_random_numbers_are_those_of_the_task_alone() -> None:
    tasks = [
        Task(("normal", k), normal, (2.0,), seed_sequence(seed, "normal", k))
        for seed in (1, 2)
        for k in range(2)
    ]
    result = IMMEDIATE.run(tasks)
    assert len({array.tobytes() for array in result}) == 4
    other_way = IMMEDIATE.run(tasks[::-1])[::-1]
    assert [array.tobytes() for array in other_way] == [array.tobytes() for array in result]
    expected = 2.0 * np.random.default_rng(seed_sequence(2, "normal", 1)).normal(size=2)
    assert result[-1].tolist() == expected.tolist()


@dataclass
class Noting(Executor):
    """An executor that takes note of what it is given."""

    tasks: list[Task[Any]] = field(default_factory=list)
    stages: list[Mapping[str, Count]] = field(default_factory=list)

    def run(self, tasks: Sequence[Task[R]], /) -> list[R]:
        self.tasks += tasks
        return [task() for task in tasks]

    def expect(self, stages: Mapping[str, Count]) -> None:
        self.stages.append(stages)


def test_tasks_of_a_turn_are_named_so() -> None:
    noting = Noting()
    again = Within(noting, turn=("again", 1))
    again.run([Task(("square", (1, 2)), square, (3,), turn=("round", 2))])
    (task,) = noting.tasks
    assert (task.key, task.turn) == (("square", (1, 2)), ("round", 2, "again", 1))
    assert task.stage == "square"
    assert task.name == "square-1_2-round-2-again-1"
    assert task() == 9
    again.expect({"square": (2, 2), "other": (3, 5)})
    assert noting.stages == [{"square": (2, 2), "other": (3, 5)}]


# ---- archives ----------------------------------------------------------------------------------


def visited(problem: Problem, thetas: Sequence[Floats]) -> float:
    return sum(float(problem.evaluate(theta).J.sum()) for theta in thetas)


def tasks_on(problem: Known, seed: int) -> list[Task[Outcome]]:
    rng = np.random.default_rng(seed)
    thetas = rng.uniform(-1, 2, size=(6, 5, 2))
    return [Task(("visit", k), recorded, (visited, None, problem, x)) for k, x in enumerate(thetas)]


def archived(outcomes: Sequence[Outcome]) -> Archive:
    archive = Archive(2)
    for outcome in outcomes:
        for theta, J in zip(outcome.theta, outcome.J, strict=True):
            archive.add(J, theta)
    return archive


class Backwards(Executor):
    """An executor that computes the last task first, as one of many processes may."""

    def run(self, tasks: Sequence[Task[R]], /) -> list[R]:
        return [task() for task in tasks[::-1]][::-1]


@given(st.integers(0, 2**16))
def test_the_archive_is_that_of_one_evaluation_after_another(seed: int) -> None:
    problem = box(circles, [-1, -1], [2, 2])
    tasks = tasks_on(problem, seed)
    visits = [task.arguments[3] for task in tasks]
    straight = recorded(lambda of: [visited(of, thetas) for thetas in visits], None, problem)
    for work in (IMMEDIATE, Run(), Backwards(), Within(Run(), turn=("again", 1))):
        outcomes = work.run(tasks)
        assert [x.result for x in outcomes] == straight.result
        assert sum(x.evaluations for x in outcomes) == straight.evaluations == 30
        archive = archived(outcomes)
        assert np.array_equal(archive.models, straight.theta), "in the order of tasks"
        assert archive.J.tolist() == straight.J.tolist()


def test_kept_tasks_bring_the_models_that_they_had_evaluated(tmp_path: Path) -> None:
    problem = box(circles, [-1, -1], [2, 2])
    archives = []
    for _ in range(2):
        with counted() as costs:
            archives.append(archived(Run(Store(tmp_path)).run(tasks_on(problem, 0))))
    assert costs.eigenproblems == 0
    assert archives[0].J.tolist() == archives[1].J.tolist()
    assert np.array_equal(archives[0].models, archives[1].models)


# ---- progress ----------------------------------------------------------------------------------


def progress() -> tuple[Progress, list[State]]:
    states: list[State] = []
    return Progress(states.append), states


def test_a_run_is_followed_from_task_to_task() -> None:
    follow, states = progress()
    assert follow.state == State("", 0, 0, None)
    follow.expect({"edge": (2, 3)})
    follow.start("edge")
    assert states[-1] == State("edge", 0, 1, None, 0, (2, 3))
    follow.end("edge", 3.0)
    assert states[-1] == State("edge", 1, 0, None, 1, (2, 3))
    follow.start("front")
    assert states[-1] == State("front", 1, 1, None, 0), "nobody has said how many there are"
    follow.end("front", 1.0)
    assert states[-1] == State("front", 2, 0, None, 1)
    assert len(states) == 5, "after every change"


def test_what_is_expected_is_still_to_come() -> None:
    follow, states = progress()
    follow.expect({"front": (2, 2)})
    for _ in range(2):
        follow.start("front")
        follow.end("front", 1.0)
    follow.expect({"front": (1, 3)})
    assert (states[-1].of_stage, states[-1].extent) == (2, (3, 5))


STAGES = st.sampled_from(["a", "b", "c"])
EVENTS = st.lists(
    st.tuples(
        st.just("expect"), st.dictionaries(STAGES, st.integers(0, 5).map(lambda n: (n, 2 * n)))
    )
    | st.tuples(st.just("start"), STAGES)
    | st.tuples(st.just("end"), st.floats(0, 9) | st.none()),
    max_size=40,
)


@given(EVENTS)
def test_nothing_is_lost_and_ranges_are_ranges_whatever_happens(
    events: list[tuple[str, Any]],
) -> None:
    follow, states = progress()
    follow.plan = {"a": (1.0, 5.0)}
    running: list[str] = []
    ended: list[tuple[str, float | None]] = []
    for event, value in events:
        if event == "expect":
            follow.expect(value)
        elif event == "start":
            follow.start(value)
            running.append(value)
        elif running:
            follow.end(running[0], value)
            ended.append((running.pop(0), value))
    for state in states:
        assert state.left is not None
        assert 0 <= state.left[0] <= state.left[1]
    assert all(state.done <= other.done for state, other in pairwise(states))
    last = follow.state
    assert (last.done, last.running) == (len(ended), len(running))


def test_the_time_left_follows_a_plan() -> None:
    follow, states = progress()
    assert follow.state.left is None
    follow.plan = {"edges": (10.0, 100.0), "front": (2.0, 8.0), "predict": (2.0, 8.0)}
    follow.expect({"bootstrap": (4, 4)})
    assert states[-1].left == pytest.approx(together(follow.plan.values()))

    def task(stage: str, seconds: float) -> tuple[float, float]:
        follow.start(stage)
        follow.end(stage, seconds)
        assert states[-1].left is not None
        return states[-1].left

    others, done = [(2.0, 8.0), (2.0, 8.0)], "what was done is subtracted"
    assert task("edges", 0.1) == pytest.approx(together([(9.9, 99.9), *others])), done
    assert task("edges", 99.0) == pytest.approx(together([(0.0, 0.9), *others]))
    assert task("edges", 1.0) == (4.0, np.inf), "it goes on for longer than planned"
    assert task("front", 1.0) == pytest.approx(together([(1.0, 7.0), (2.0, 8.0)])), "edges ended"
    least, most = task("bootstrap", 3.0)
    assert 2.0 <= least < 2.0 + 3 * 3.0 < most, "it was not planned, and one task says little"


def test_the_time_of_tasks_that_are_alike_is_soon_known() -> None:
    follow, states = progress()
    follow.plan = {"bootstrap": (1.0, 1000.0)}
    follow.expect({"bootstrap": (90, 190)})
    ratios = list[float]()
    for _ in range(80):
        follow.start("bootstrap")
        follow.end("bootstrap", 2.0)
        assert states[-1].left is not None
        least, most = states[-1].left
        few, many = (2.0 * (x - len(ratios) - 1) for x in (90, 190))
        assert least <= few < many <= most
        ratios.append(most / many)
    assert ratios[0] > 2.0
    assert ratios[-1] < 1.5
    follow.start("other")
    assert states[-1].left is not None
    assert states[-1].left[0] > 0, "it is to go on"


def test_parts_are_all_short_and_not_all_long_at_once() -> None:
    assert together([]) == (0.0, 0.0)
    assert together([(1.0, 9.0)]) == pytest.approx((1.0, 9.0))
    assert together([(1.0, 9.0)] * 4) == pytest.approx((4.0, 12 + 12.0))
    assert together([(3.0, 3.0), (0.0, np.inf)]) == (3.0, np.inf)


def test_of_a_stage_that_was_kept_in_part_the_least_is_not_known() -> None:
    follow, states = progress()
    follow.plan = {"edges": (10.0, 100.0)}
    follow.start("edges")
    follow.end("edges", None)
    assert states[-1].left == (0.0, 100.0)


def test_serial_tells_of_every_task_and_of_what_it_took(tmp_path: Path) -> None:
    Run(Store(tmp_path)).run(squares(1))
    follow, states = progress()
    work = Run(Store(tmp_path), follow)
    work.expect({"square": (4, 4)})
    work.run(squares(1, 2, 3))
    assert [(state.done, state.running) for state in states[1:]] == [
        *((0, 1), (1, 0), (1, 1), (2, 0), (2, 1), (3, 0))
    ]
    assert all(state.extent == (4, 4) for state in states[1:])
    assert follow.spent.eigenproblems == 2 + 3
