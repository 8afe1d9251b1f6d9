"""The executor of a run: a backend computes its tasks, their results are kept and costs counted."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from modefront.work.backend import Backend, Done, InTurn, computed
from modefront.work.costs import Costs, spend, total, uncounted
from modefront.work.interleaved import interleaved
from modefront.work.progress import Progress
from modefront.work.store import Store
from modefront.work.task import Key, R, Task

KEPT = 5.0
"""Seconds from which the result of a part of a task is kept until that of the task is."""


@dataclass
class Run:
    """Carries out tasks, and keeps what they return.

    Attributes
    ----------
    store : keeps the results; None for none
    progress : is told of every task
    backend : computes the tasks
    costs : of every task, by its key and turn, kept ones included
    """

    store: Store | None = None
    progress: Progress = field(default_factory=Progress)
    backend: Backend = field(default_factory=InTurn)
    costs: dict[tuple[Any, ...], Costs] = field(default_factory=dict)

    def expect(self, stages: Mapping[str, int]) -> None:
        """Note the number of tasks of each stage that are still to come."""
        self.progress.expect(stages)

    def run(self, tasks: Sequence[Task[R]], ahead: Sequence[Task[Any]] = (), /) -> list[R]:
        """Return the results of the tasks, kept ones where there are any.

        Raises ValueError for a key that another task of the run had.
        """
        names: list[tuple[Any, ...]] = [(*task.key, *task.turn) for task in tasks]
        for k, name in enumerate(names):
            if name in self.costs or name in names[:k]:
                raise ValueError(f"two tasks are named {tasks[k].name}")
        results: dict[int, R] = {}
        for k, task in enumerate(tasks):
            kept = self.store.read(task) if self.store else None
            if kept is not None:
                self.progress.start(task.stage)
                results[k], self.costs[names[k]] = kept
                self.progress.end(task.stage, None)
        left = [k for k in range(len(tasks)) if k not in results]
        elsewhere = [k for k in left if not tasks[k].in_process and not tasks[k].has_parts]
        likely = [x for x in ahead if not (self.store and self.store.has(x))] if left else []
        chosen = [tasks[k] for k in elsewhere]

        def begun(position: int) -> None:
            self.progress.start(chosen[position].stage)

        if chosen:
            for position, done in self.backend.compute(chosen, likely, begun):
                k = elsewhere[position]
                results[k] = self._ended(tasks[k], done)
        here = [k for k in left if k not in results]
        with_parts = [k for k in here if tasks[k].has_parts]
        if self.backend.workers > 1 and len(with_parts) > 1:
            here = [k for k in here if k not in with_parts]
            functions = [partial(self._in_parts, tasks[k], names[k]) for k in with_parts]
            for place, result in interleaved(functions, self.backend):
                results[with_parts[place]] = result
        for k in here:
            results[k] = self._in_parts(tasks[k], names[k], self.backend)
        return [results[k] for k in range(len(tasks))]

    def _in_parts(self, task: Task[R], name: Key, backend: Backend) -> R:
        """Return the result of a task whose function is called in this process."""
        self.progress.start(task.stage)
        parts = Parts(backend, self.store, (*name, "part"))
        result = self._ended(task, computed(task, parts))
        parts.forget()
        return result

    def total(self, chosen: Callable[[str], bool] = lambda _: True) -> Costs:
        """Return the costs of the tasks of the chosen stages."""
        return total(costs for key, costs in self.costs.items() if chosen(str(key[0])))

    def _ended(self, task: Task[R], done: Done) -> R:
        """Keep the result of a task, and return it."""
        self.costs[*task.key, *task.turn] = done.costs
        self.progress.spent.add(done.costs)
        if self.store:
            self.store.write(task, done.result, done.costs)
        self.progress.end(task.stage, done.seconds)
        result: R = done.result
        return result


@dataclass
class Parts:
    """Carries out the parts of one task, whose costs are among those of the task.

    What took long is kept until the task is done.

    Attributes
    ----------
    backend : computes the parts
    store : keeps their results; None for none
    part : put before the keys of the parts
    """

    backend: Backend
    store: Store | None
    part: Key
    _kept: list[Task[Any]] = field(default_factory=list)

    def run(self, tasks: Sequence[Task[R]], ahead: Sequence[Task[Any]] = (), /) -> list[R]:
        """Return the results of the parts, kept ones where there are any."""
        named = [self._of(task) for task in tasks]
        results: dict[int, R] = {}
        for k, task in enumerate(named):
            kept = self.store.read(task) if self.store and self.store.has(task) else None
            if kept is not None:
                results[k] = kept[0]
                spend(kept[1])
                self._kept.append(task)
        left = [k for k in range(len(tasks)) if k not in results]
        if left:
            chosen, likely = [named[k] for k in left], [self._of(task) for task in ahead]
            # In this process a part counts while it is computed, in others where it has ended.
            with uncounted():
                ended = list(self._computed(chosen, likely))
            for position, done in sorted(ended, key=lambda each: each[0]):
                spend(done.costs)
                results[left[position]] = done.result
        return [results[k] for k in range(len(tasks))]

    def expect(self, stages: Mapping[str, int]) -> None:
        """Ignore the extent of the parts: the task counts as one."""

    def forget(self) -> None:
        """Remove the results of the parts: that of the task is kept."""
        if self.store:
            for task in self._kept:
                self.store.remove(task)

    def _computed(
        self, tasks: Sequence[Task[R]], ahead: Sequence[Task[Any]]
    ) -> list[tuple[int, Done]]:
        ended = []
        for position, done in self.backend.compute(tasks, ahead, _ignore):
            if self.store and done.seconds >= KEPT:
                self.store.write(tasks[position], done.result, done.costs)
                self._kept.append(tasks[position])
            ended.append((position, done))
        return ended

    def _of(self, task: Task[R]) -> Task[R]:
        return replace(task, key=(*self.part, *task.key))


def _ignore(_: int) -> None:
    """Ignore that a part has begun."""
