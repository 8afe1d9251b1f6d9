"""Backends: who computes the tasks of a run, in this process or in others.

The results of tasks come back in any order. What is decided from them is decided by the caller,
in the order of the tasks, so that it does not depend on the backend.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from modefront.work.costs import Costs, counted
from modefront.work.task import Task


@dataclass(frozen=True)
class Done:
    """The result of a task, what it cost, and the seconds that it took."""

    result: Any
    costs: Costs
    seconds: float


class Backend(Protocol):
    """Computes tasks."""

    @property
    def workers(self) -> int:
        """Number of tasks that are computed at the same time."""

    def compute(
        self, tasks: Sequence[Task[Any]], begun: Callable[[int], None], /
    ) -> Iterator[tuple[int, Done]]:
        """Yield positions and results of tasks as they end; ``begun`` is called at their start."""


def computed(task: Task[Any]) -> Done:
    """Return the result of a task, computed here and now."""
    began = time.perf_counter()
    with counted() as costs:
        result = task()
    return Done(result, costs, time.perf_counter() - began)


@dataclass(frozen=True)
class InTurn:
    """Computes one task after another in the calling process."""

    workers: int = 1

    def compute(
        self, tasks: Sequence[Task[Any]], begun: Callable[[int], None], /
    ) -> Iterator[tuple[int, Done]]:
        """Yield the results in the order of the tasks, each as it is wanted."""
        for k, task in enumerate(tasks):
            begun(k)
            yield k, computed(task)
