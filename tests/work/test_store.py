"""Results of tasks in a folder: each under its own key, whole or not at all."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from modefront.optim.problem import Evaluation
from modefront.optim.sqp import Solution, Status, begin
from modefront.work.store import LONG, LONGEST, Run, Store
from modefront.work.task import Costs, Key, Task

COSTS = Costs(eigenproblems=3, factorisations=2, full_time=0.1)


def solution(J: float = 0.3) -> Solution:
    theta, objective = np.array([0.1, -0.0]), np.array([J, np.inf])
    position = Evaluation(theta, objective, np.zeros((2, 2)), np.full((2, 2, 2), np.nan))
    return replace(begin(position), status=Status.STALLED)


def task(*key: Any, turn: Key = ()) -> Task[Any]:
    return Task(key, solution, turn=turn)


def test_what_is_kept_comes_back_with_what_it_cost(tmp_path: Path) -> None:
    store, first_task = Store(tmp_path / "new" / "folder"), task("edge", "shapes")
    assert store.read(first_task) is None
    store.write(first_task, [solution()], COSTS)
    kept = Store(tmp_path / "new" / "folder").read(first_task)
    assert kept is not None
    ((result,), costs) = kept
    assert costs == COSTS
    assert result.status is Status.STALLED
    for name in ("theta", "J", "dJ", "H"):
        assert (
            getattr(result.evaluation, name).tobytes()
            == getattr(solution().evaluation, name).tobytes()
        )


ODD: list[tuple[Any, ...]] = [
    ("edge", "shapes"),
    ("edge", "Shapes"),
    ("EDGE", "shapes"),
    ("edge", "sh/apes"),
    ("edge", "sh\\apes"),
    ("edge", "sh:apes"),
    ("edge", "sh.apes"),
    ("edge", "sh apes"),
    ("edge", ".."),
    ("edge", ""),
    ("edge", "é"),
    ("edge", "e\u0301"),
    ("edge", "\0"),
    ("edge", "\n"),
    ("edge", "x" * (LONGEST + 1)),
    ("edge", "x" * (LONGEST + 1) + "y"),
    ("edge", "x" * 1000),
    ("edge", "shapes", "from"),
    ("edge", "shapes-from"),
    ("edge-shapes", "from"),
    ("edge", "1"),
    ("edge", 1),
    ("edge", "1_2"),
    ("edge", (1, 2)),
    ("edge", (1, 23)),
]


def test_keys_have_files_of_their_own_whatever_they_hold(tmp_path: Path) -> None:
    store = Store(tmp_path / "folder")
    for number, key in enumerate(ODD):
        store.write(task(*key), [solution(number)], COSTS)
    for number, key in enumerate(ODD):
        kept = store.read(task(*key))
        assert kept is not None
        assert kept[0][0].J[0] == number
    names = [path.name for path in (tmp_path / "folder").iterdir()]
    assert len({name.lower() for name in names}) == len(ODD), "also where case does not matter"
    assert all(name.isascii() and len(name) < 100 for name in names)
    assert [path.name for path in tmp_path.iterdir()] == ["folder"], "none lies elsewhere"


def test_a_turn_is_part_of_the_key(tmp_path: Path) -> None:
    store = Store(tmp_path)
    store.write(task("edge", turn=("round", 1)), 1, COSTS)
    store.write(task("edge", turn=("round", 2)), 2, COSTS)
    assert store.read(task("edge")) is None
    assert store.read(task("edge", turn=("round", 2))) == (2, COSTS)


def test_a_file_of_another_key_is_not_taken(tmp_path: Path) -> None:
    store = Store(tmp_path)
    store.write(task("one"), 1, COSTS)
    store.write(task("two"), 2, COSTS)
    first, two = sorted(tmp_path.iterdir())
    two.write_bytes(first.read_bytes())
    assert store.read(task("one")) == (1, COSTS)
    assert store.read(task("two")) is None


def test_a_new_result_takes_the_place_of_the_old_one(tmp_path: Path) -> None:
    store = Store(tmp_path)
    for number in (1, 2):
        store.write(task("one"), number, COSTS)
    assert store.read(task("one")) == (2, COSTS)
    assert [path.suffix for path in tmp_path.iterdir()] == [".npz"]


def test_a_result_that_cannot_be_kept_leaves_the_old_one(tmp_path: Path) -> None:
    store = Store(tmp_path)
    store.write(task("one"), 1, COSTS)
    with pytest.raises(TypeError, match="expected a registered record"):
        store.write(task("one"), [2, object()], COSTS)
    assert store.read(task("one")) == (1, COSTS)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> tuple[Store, Path, bytes]:
    folder = tmp_path_factory.mktemp("kept")
    store = Store(folder)
    store.write(task("one"), [solution()], COSTS)
    (path,) = folder.iterdir()
    return store, path, path.read_bytes()


def test_a_file_cut_off_anywhere_counts_as_none(whole: tuple[Store, Path, bytes]) -> None:
    store, path, content = whole
    for length in {*range(0, len(content), 37), 0, 1, 4, 22, len(content) - 1}:
        path.write_bytes(content[:length])
        assert store.read(task("one")) is None


@pytest.mark.parametrize("value", [0, 1, 2, 8, 9, 12, 14, 173, 255])
def test_a_file_with_any_wrong_byte_counts_as_none(
    value: int, whole: tuple[Store, Path, bytes]
) -> None:
    """Bytes that ask for a password or for other compressions, and headers that do not parse."""
    store, path, content = whole
    first = content.index(b"PK\x01\x02")
    heads = content.index(b"descr"), content.index(b"shape")
    for position in {
        *range(0, len(content), 13),
        *range(first, first + 46),
        *(head + k for head in heads for k in range(20)),
    }:
        if content[position] != value:
            damaged = bytearray(content)
            damaged[position] = value
            path.write_bytes(damaged)
            assert store.read(task("one")) is None
    path.write_bytes(content)
    assert store.read(task("one")) is not None


@settings(max_examples=100)
@given(data=st.data())
def test_a_file_with_wrong_bytes_counts_as_none(
    whole: tuple[Store, Path, bytes], data: st.DataObject
) -> None:
    store, path, content = whole
    damaged = bytearray(content)
    for _ in range(data.draw(st.integers(1, 3))):
        damaged[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    path.write_bytes(damaged)
    assert (store.read(task("one")) is None) == (bytes(damaged) != content)


@pytest.mark.parametrize(
    "content",
    [
        {},
        [],
        1,
        {"costs": {}},
        {"costs": {"other": 1}, "result": 1},
        {"costs": {}, "result": {"record": "Gone", "fields": {}}},
        {"costs": {}, "result": 1},
    ],
)
def test_a_file_of_other_content_counts_as_none(content: Any, tmp_path: Path) -> None:
    store = Store(tmp_path)
    store.write(task("one"), 1, COSTS)
    (path,) = tmp_path.iterdir()
    head = np.frombuffer(json.dumps(content).encode(), np.uint8)
    np.savez(path, head=head)
    assert store.read(task("one")) is None
    np.savez(path, other=head)
    assert store.read(task("one")) is None
    with path.open("wb") as stream:
        np.save(stream, head)
    assert store.read(task("one")) is None


def test_nothing_that_is_read_is_executed(tmp_path: Path) -> None:
    store = Store(tmp_path)
    store.write(task("one"), np.ones(2), COSTS)
    (path,) = tmp_path.iterdir()
    with np.load(path) as file:
        head = file["head"]
    named: dict[str, Any] = {"head": head, "0": np.array([{"a": 1}], dtype=object)}
    np.savez(path, **named)
    assert store.read(task("one")) is None


def test_a_write_that_is_interrupted_leaves_no_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(_: int) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("modefront.outputs.os.fsync", interrupted)
    with pytest.raises(KeyboardInterrupt):
        Store(tmp_path).write(Task(("x",), len), 1, Costs())
    assert not list(tmp_path.iterdir())


def test_a_run_waits_for_the_drive_only_after_long_tasks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    waited: list[int] = []
    monkeypatch.setattr("modefront.outputs.os.fsync", waited.append)
    Run(Store(tmp_path)).run([Task(("short",), len, ((1, 2),))])
    assert not waited
    Store(tmp_path).write(Task(("long",), len), 1, Costs(), LONG)
    assert len(waited) == 1
    assert Store(tmp_path).read(Task(("short",), len, ((1, 2),))) is not None
