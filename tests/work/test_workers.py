"""Tasks in other processes: the same results in any order, and what happens to lost ones."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from jobs import (
    Big,
    deadly,
    failing,
    nap,
    normal,
    process_of,
    squares,
    threads,
    total_of_parts,
    totals,
)
from pools import Threads
from problems import box, circles

from modefront.errors import Fault, InputError, ModelError, UnfinishedError
from modefront.front.front import Front
from modefront.front.options import Pareto
from modefront.front.pareto import pareto_front
from modefront.front.search import Search
from modefront.work.store import Run, Store
from modefront.work.task import Executor, Task, counted, seed_sequence
from modefront.work.transfer import Sender
from modefront.work.workers import QUEUED, Workers, backend

orders = st.lists(st.integers(0, 3), min_size=1, max_size=5)


def is_kept(store: Store, task: Task[Any]) -> bool:
    return store.read(task) is not None


# ---- results do not depend on who computes them ------------------------------------------------


@settings(max_examples=25)
@given(orders, st.integers(1, 4), st.lists(st.integers(0, 40), max_size=12, unique=True))
def test_results_costs_and_random_numbers_are_those_of_one_after_another(
    delays: list[int], count: int, numbers: list[int]
) -> None:
    tasks: list[Task[Any]] = [*squares(*numbers)]
    tasks += [Task(("normal", k), normal, (k,), seed_sequence(1, k)) for k in range(3)]
    alone = Run()
    expected = alone.run(tasks)
    with Workers(Threads(count, delays)) as workers:
        work = Run(backend=workers)
        with counted() as spent:
            results = work.run(tasks)
    for first, other in zip(results, expected, strict=True):
        np.testing.assert_array_equal(first, other)
    assert set(work.costs) == set(alone.costs)
    assert work.total().eigenproblems == alone.total().eigenproblems == spent.eigenproblems


def searched(work: Executor) -> Front:
    """Return a front with its edges and weighted models."""
    problem = box(circles, [-1, -1], [2, 2])
    return pareto_front(problem, np.ones(2), Pareto(points=6), search=Search(doubt=0.3), work=work)


@settings(max_examples=4)
@given(orders, st.integers(2, 3))
def test_fronts_are_those_of_one_after_another(delays: list[int], count: int) -> None:
    alone = Run()
    expected = searched(alone)
    with Workers(Threads(count, delays)) as workers:
        work = Run(backend=workers)
        again = searched(work)
    assert [x.label for x in again.points] == [x.label for x in expected.points]
    for one, other in zip(again.points, expected.points, strict=True):
        assert one.solution.theta.tolist() == other.solution.theta.tolist()
        assert one.solution.evaluations == other.solution.evaluations
    assert again.known.tolist() == expected.known.tolist()
    assert set(work.costs) == set(alone.costs)


def test_short_tasks_are_sent_together_and_long_ones_alone() -> None:
    pool = Threads(2)
    with Workers(pool) as workers:
        work = Run(backend=workers)
        work.run(squares(*range(200)))
        assert len(pool.sent) < 60
        long = Threads(2)
        with Workers(long) as others:
            tasks = [Task(("nap", k), time.sleep, (0.03,)) for k in range(4)]
            Run(backend=others).run(tasks)
        assert len(long.sent) == 4


# ---- shared objects ----------------------------------------------------------------------------


@pytest.mark.parametrize("forgets", [False, True])
def test_a_shared_object_is_sent_where_it_is_not_known(forgets: bool) -> None:
    big = Big(np.ones(10**5))
    pool = Threads(2, forgets=forgets)
    with Workers(pool) as workers:
        work = Run(backend=workers)
        assert work.run(totals(big)) == [1e5 + k for k in range(6)]
        assert max(len(message.content) for message in pool.sent) < 10**4
        big.numbers, big.version = 2 * big.numbers, 1
        assert work.run(totals(big, 1)) == [2e5 + k for k in range(6)]


@pytest.mark.slow(2)
@given(st.lists(st.sets(st.integers(0, 2)), min_size=1, max_size=5))
def test_another_process_may_take_what_one_has_lacked(known: list[set[int]]) -> None:
    part = Big(np.ones(5))
    middle = Big(np.ones(4), part=part)
    big = Big(np.ones(3), part=middle)
    pool = Threads(1)
    with Workers(pool) as workers:
        work = Run(backend=workers)
        tasks = [
            [Task(("sum", k), total_of_parts, (big,)) for k in (2 * n, 2 * n + 1)] for n in (0, 1)
        ]
        assert work.run(tasks[0]) == [12.0, 12.0]
        sent, pool.known = len(pool.sent), known
        assert work.run(tasks[1]) == [12.0, 12.0]
    assert len(pool.sent) <= sent + 2 * 4, "each time, at least one object more comes with it"


def test_memory_bounds_how_many_tasks_run_at_a_time() -> None:
    big = Big(np.ones(3), footprint=4e9)
    pool = Threads(3, delays=(3,))
    with Workers(pool, memory=6e9) as workers:
        assert Run(backend=workers).run(totals(big)) == [3.0 + k for k in range(6)]
    assert pool.most == 1
    with Workers(roomy := Threads(3, delays=(3,)), memory=20e9) as workers:
        Run(backend=workers).run(totals(big))
    assert 1 < roomy.most <= QUEUED * 3


def test_memory_is_that_of_an_object_and_not_of_its_parts() -> None:
    big = Big(np.ones(3), footprint=1e6, part=Big(np.ones(3), footprint=4e9))
    task = Task(("sum",), total_of_parts, (big,), memory=1e5)
    assert Sender().message([task, *totals(big)]).memory == 1.1e6


def test_what_cannot_be_sent_is_an_error_of_the_input() -> None:
    tasks = [Task(("lambda", k), lambda: 1) for k in range(2)]
    with Workers(Threads()) as workers, pytest.raises(InputError, match="functions of a module"):
        Run(backend=workers).run(tasks)


# ---- errors and losses -------------------------------------------------------------------------


def test_the_error_of_a_task_is_raised_and_all_others_are_kept(tmp_path: Path) -> None:
    fault = Fault("file", "place", "this", "that")
    tasks = [
        *squares(1, 2),
        Task(("wrong", 1), failing, (InputError([fault, fault]),)),
        Task(("wrong", 2), failing, (ModelError("no modes"),)),
        *squares(3, 4),
    ]
    store = Store(tmp_path)
    with Workers(Threads(2, (2, 0))) as workers, pytest.raises(InputError) as caught:
        Run(store, backend=workers).run(tasks)
    assert caught.value.faults == (fault, fault), "the first one in the order of the tasks"
    assert str(caught.value) == f"{fault}\n{fault}"
    assert all(is_kept(store, task) for task in squares(1, 2, 3, 4))


@settings(max_examples=20)
@given(st.integers(0, 12), orders)
def test_a_lost_process_costs_nothing_but_time(lost: int, delays: list[int]) -> None:
    pool = Threads(2, delays, broken=(lost,))
    with Workers(pool) as workers:
        assert Run(backend=workers).run(squares(*range(30))) == [x * x for x in range(30)]


def test_a_task_that_is_lost_twice_is_named_and_all_others_are_kept(tmp_path: Path) -> None:
    store = Store(tmp_path)
    pool = Threads(1, broken=(0, 2))
    tasks = [Task(("nap", k), nap, (k,)) for k in range(4)]
    text = "task 'nap-0' could not be done: the process that computed it ended, twice"
    with Workers(pool) as workers, pytest.raises(UnfinishedError, match=text):
        Run(store, backend=workers).run(tasks)
    assert [is_kept(store, task) for task in tasks] == [False, True, True, True]


def test_a_task_whose_memory_does_not_suffice_is_tried_alone_and_then_named() -> None:
    tasks = [*squares(1, 2), Task(("greedy",), failing, (MemoryError(),))]
    text = "task 'greedy' could not be done: its memory does not suffice, twice"
    with Workers(Threads()) as workers, pytest.raises(UnfinishedError, match=text):
        Run(backend=workers).run(tasks)


def test_without_a_cluster_the_run_ends_with_what_it_has(tmp_path: Path) -> None:
    store = Store(tmp_path)
    tasks = [Task(("nap", k), nap, (k,)) for k in range(8)]
    with (
        Workers(Threads(2, cut=5)) as workers,
        pytest.raises(UnfinishedError, match="the Dask scheduler is gone"),
    ):
        Run(store, backend=workers).run(tasks)
    kept = sum(is_kept(store, task) for task in tasks)
    assert 0 < kept < 8
    again = Run(store)
    assert again.run(tasks) == list(range(8))
    assert again.progress.state.done == 8


# ---- processes ---------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def two() -> Iterator[Workers]:
    before = dict(os.environ)
    with backend(2) as out:
        assert dict(os.environ) == before, "only the processes are limited to one thread"
        assert out.pool is not None
        while not out.pool.ready:
            time.sleep(0.01)
        yield out


def test_processes_share_the_work_and_are_not_this_one(two: Workers) -> None:
    result = Run(backend=two).run([Task(("process", k), process_of, (k,)) for k in range(8)])
    assert os.getpid() not in result
    assert 1 <= len(set(result)) <= 2


def test_processes_share_nothing_among_threads(two: Workers) -> None:
    assert set(Run(backend=two).run([Task(("threads", k), threads, (k,)) for k in range(8)])) == {1}


@pytest.mark.slow(2)
@pytest.mark.skipif(os.name == "nt", reason="there is no such signal on Windows")
def test_a_killed_process_is_replaced_and_its_tasks_are_done_again(
    two: Workers, tmp_path: Path
) -> None:
    marker = str(tmp_path / "marker")
    tasks = [Task(("deadly", k), deadly, (marker, 1, k)) for k in range(6)]
    assert Run(backend=two).run(tasks) == list(range(6))
    (tmp_path / "marker").unlink()
    tasks = [Task(("deadly", k), deadly, (marker, 9, k), turn=("turn", 2)) for k in range(6)]
    store = Store(tmp_path)
    with pytest.raises(UnfinishedError, match="task 'deadly-2-turn-2' could not be done"):
        Run(store, backend=two).run(tasks)
    assert [is_kept(store, task) for task in tasks] == [k != 2 for k in range(6)]


def test_processes_import_only_what_most_tasks_need() -> None:
    spared = "click", "rich", "xarray", "pandas", "h5py", "scipy.optimize", "scipy.stats"
    code = (
        "import sys, importlib, modefront.__main__\n"
        "from modefront.work.workers import WARM\n"
        "for name in WARM: importlib.import_module(name)\n"
        f"sys.exit(' '.join({{*{spared}, 'modefront.fem.assembly'}} & set(sys.modules)) or 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
    assert done.returncode == 0, done.stderr


def test_one_worker_is_the_process_itself_and_other_numbers_are_refused() -> None:
    with backend(1) as alone:
        assert alone.pool is None
    for wrong in (0, 62, -1):
        with pytest.raises(InputError, match="workers: expected a whole number"), backend(wrong):
            pass
    with pytest.raises(InputError, match="the cluster has its own"), backend(2, "tcp://x:1"):
        pass


ORPHANS = """
import sys, time
from jobs import process_of
from modefront.work.task import Task
from modefront.work.workers import backend
if __name__ == "__main__":
    with backend(2) as work:
        while not work.pool.ready:
            time.sleep(0.01)
        tasks = [Task(("process", k), process_of, (k,)) for k in range(10**4)]
        for _, done in work.compute(tasks, lambda _: None):
            print(done.result, flush=True)
"""


@pytest.mark.skipif(os.name == "nt", reason="there is no such signal on Windows")
def test_processes_end_with_the_one_that_started_them(tmp_path: Path) -> None:
    script = tmp_path / "orphans.py"
    script.write_text(ORPHANS)
    path = os.pathsep.join([*sys.path, str(Path(__file__).parent)])
    with subprocess.Popen(
        [sys.executable, script],
        env={**os.environ, "PYTHONPATH": path},
        stdout=subprocess.PIPE,
        text=True,
    ) as parent:
        assert parent.stdout is not None
        result = {int(parent.stdout.readline()) for _ in range(8)}
        parent.kill()
    for _ in range(500):
        if not any(map(alive, result)):
            break
        time.sleep(0.02)
    assert not any(map(alive, result))


def alive(process: int) -> bool:
    """Return whether a process runs; one that has ended and is not waited for does not."""
    try:
        state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state != "Z"
