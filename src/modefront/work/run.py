"""The executor of a run: a backend computes its tasks, their results are kept and costs counted."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from modefront.work.costs import Costs
from modefront.work.progress import Progress
from modefront.work.store import Store
from modefront.work.task import Backend, InTurn, Key, R, Task


@dataclass
class Run:
    """Has a backend carry out tasks, keeps results in a store, and counts the costs of all."""

    store: Store | None = None
    progress: Progress = field(default_factory=Progress)
    backend: Backend = field(default_factory=InTurn)
    costs: dict[tuple[Key, Key], Costs] = field(default_factory=dict)

    def expect(self, stages: Mapping[str, int]) -> None:
        """Note the number of tasks of each stage that are still to come."""
        self.progress.expect(stages)

    def run(self, tasks: Sequence[Task[R]], /) -> list[R]:
        """Return the results of the tasks, kept ones where there are any.

        Raises ValueError for a key that another task of the run had.
        """
        results: dict[int, R] = {}
        names = [task.identity for task in tasks]
        for k, task in enumerate(tasks):
            if names[k] in self.costs or names[k] in names[:k]:
                raise ValueError(f"two tasks are named {task.name}")
        for k, task in enumerate(tasks):
            kept = self.store.read(task) if self.store else None
            if kept is not None:
                self.progress.start(task.stage)
                results[k], self.costs[names[k]] = kept
                self.progress.end(task.stage, None)
        left = [k for k in range(len(tasks)) if k not in results]
        here = [k for k in left if tasks[k].in_process]
        elsewhere = [k for k in left if not tasks[k].in_process]
        for ks, backend in ((elsewhere, self.backend), (here, InTurn())):
            chosen = [tasks[k] for k in ks]

            def started(position: int, chosen: Sequence[Task[R]] = chosen) -> None:
                self.progress.start(chosen[position].stage)

            for position, done in backend.compute(chosen, started):
                task = chosen[position]
                results[ks[position]] = done.result
                self.costs[task.identity] = done.costs
                self.progress.spent.add(done.costs)
                if self.store:
                    self.store.write(task, done.result, done.costs)
                self.progress.end(task.stage, done.seconds)
        return [results[k] for k in range(len(tasks))]

    def total(self, chosen: Callable[[str], bool] = lambda _: True) -> Costs:
        """Return the costs of the tasks of the chosen stages."""
        out = Costs()
        for (key, _), costs in self.costs.items():
            if chosen(str(key[0])):
                out.add(costs)
        return out
