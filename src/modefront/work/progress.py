"""Progress of a run: tasks done, running, expected, and the time that is left.

Every task belongs to a stage. The extent of a stage is an estimate until it ends; a stage has ended
when a task of another one starts, and its extent then is the number of tasks that it had.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from modefront.work.costs import Costs


@dataclass(frozen=True)
class State:
    """The state of a run.

    Attributes
    ----------
    stage : that of the last task that was started; empty before the first one
    done : tasks done, those kept from an earlier run included
    running : tasks that are being computed
    expected : tasks in all, as far as is known; never less than those done and running
    elapsed : seconds since the run began
    left : estimated seconds until it ends; None before the first computed task has ended
    """

    stage: str
    done: int
    running: int
    expected: int
    elapsed: float
    left: float | None


def ignore(_: State) -> None:
    """Ignore progress reports."""


@dataclass
class Progress:
    """Follows the tasks of a run and reports its state after every change.

    Attributes
    ----------
    report : is called with the state
    clock : returns seconds
    spent : costs of the tasks computed, without those kept from an earlier run
    workers : tasks that are computed at the same time, as far as there are so many
    """

    report: Callable[[State], None] = ignore
    clock: Callable[[], float] = time.monotonic
    spent: Costs = field(default_factory=Costs)
    workers: int = 1
    _expected: dict[str, int] = field(default_factory=dict)
    _done: dict[str, int] = field(default_factory=dict)
    _running: dict[str, int] = field(default_factory=dict)
    _stage: str = ""
    _computed: int = 0
    _seconds: float = 0.0
    _began: float | None = None

    def expect(self, stages: Mapping[str, int]) -> None:
        """Take note of how many tasks of each stage are still to come."""
        for stage, count in stages.items():
            self._expected[stage] = self._done.get(stage, 0) + count
        self.report(self.state)

    def start(self, stage: str) -> None:
        """Take note that a task of a stage is being computed, or taken from what is kept."""
        if self._began is None:
            self._began = self.clock()
        if stage != self._stage and self._stage:
            self._expected[self._stage] = self._met(self._stage)
        self._stage = stage
        self._running[stage] = self._running.get(stage, 0) + 1
        self.report(self.state)

    def end(self, stage: str, seconds: float | None) -> None:
        """Take note that a task has ended; it took no ``seconds`` where its result was kept."""
        self._running[stage] -= 1
        self._done[stage] = self._done.get(stage, 0) + 1
        if seconds is not None:
            self._computed += 1
            self._seconds += seconds
        self.report(self.state)

    @property
    def state(self) -> State:
        """State of the run."""
        stages = {*self._expected, *self._done, *self._running}
        done, running = sum(self._done.values()), sum(self._running.values())
        expected = sum(max(self._expected.get(x, 0), self._met(x)) for x in stages)
        elapsed = 0.0 if self._began is None else self.clock() - self._began
        left = None
        if self._computed:
            left = (expected - done) * self._seconds / self._computed / self.workers
        return State(self._stage, done, running, expected, elapsed, left)

    def _met(self, stage: str) -> int:
        return self._done.get(stage, 0) + self._running.get(stage, 0)
