"""An executor that computes one task after another, and keeps what they return."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from modefront.work.costs import Costs, counted, total
from modefront.work.progress import Progress
from modefront.work.store import Store
from modefront.work.task import R, Task


@dataclass
class Serial:
    """Carries out tasks in the calling process, in their order.

    Attributes
    ----------
    store : keeps the results; None for none
    progress : is told of every task
    costs : of every task, by its key and turn, kept ones included
    """

    store: Store | None = None
    progress: Progress = field(default_factory=Progress)
    costs: dict[tuple[Any, ...], Costs] = field(default_factory=dict)

    def expect(self, stages: Mapping[str, int]) -> None:
        """Take note of how many tasks of each stage are still to come."""
        self.progress.expect(stages)

    def run(self, tasks: Sequence[Task[R]]) -> list[R]:
        """Return the results of the tasks, kept ones where there are any.

        Raises ValueError for a key that another task of the run had.
        """
        return [self._one(task) for task in tasks]

    def total(self, chosen: Callable[[str], bool] = lambda _: True) -> Costs:
        """Return what the tasks of the chosen stages have cost."""
        return total(costs for key, costs in self.costs.items() if chosen(str(key[0])))

    def _one(self, task: Task[R]) -> R:
        name = (*task.key, *task.turn)
        if name in self.costs:
            raise ValueError(f"two tasks are named {task.name}")
        self.progress.start(task.stage)
        kept = self.store.read(task) if self.store else None
        if kept is not None:
            result, self.costs[name] = kept
            self.progress.end(task.stage, None)
            return result
        began = self.progress.clock()
        with counted() as costs:
            result = task()
        self.costs[name] = costs
        self.progress.spent.add(costs)
        if self.store:
            self.store.write(task, result, costs)
        self.progress.end(task.stage, self.progress.clock() - began)
        return result
