"""The executor of a run: a backend computes its tasks, their results are kept and costs counted."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from modefront.work.costs import Costs, total
from modefront.work.progress import Progress
from modefront.work.store import Store
from modefront.work.task import Backend, Done, InTurn, R, Task, computed


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

    def run(self, tasks: Sequence[Task[R]], /) -> list[R]:
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
        elsewhere = [k for k in left if not tasks[k].in_process]
        chosen = [tasks[k] for k in elsewhere]

        def begun(position: int) -> None:
            self.progress.start(chosen[position].stage)

        for position, done in self.backend.compute(chosen, begun):
            k = elsewhere[position]
            results[k] = self._ended(tasks[k], done)
        for k in left:
            if tasks[k].in_process:
                self.progress.start(tasks[k].stage)
                results[k] = self._ended(tasks[k], computed(tasks[k]))
        return [results[k] for k in range(len(tasks))]

    def total(self, chosen: Callable[[str], bool] = lambda _: True) -> Costs:
        """Return the costs of the tasks of the chosen stages."""
        return total(costs for key, costs in self.costs.items() if chosen(str(key[0])))

    def _ended(self, task: Task[R], done: Done) -> R:
        self.costs[*task.key, *task.turn] = done.costs
        self.progress.spent.add(done.costs)
        if self.store:
            self.store.write(task, done.result, done.costs)
        self.progress.end(task.stage, done.seconds)
        result: R = done.result
        return result
