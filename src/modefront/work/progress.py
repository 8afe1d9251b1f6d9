"""Progress of a run: tasks done, running, expected, and the time that is left.

Every task belongs to a stage. The extent of a stage is an estimate until it ends; a stage has ended
when a task of another one starts, and its extent then is the number of tasks that it had.

Tasks of a stage that has begun take as long as those before them. What the others take is planned;
without a plan they take as long as all tasks.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
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
    left : estimated seconds until it ends; None for as long as nothing is known of it
    of_stage : tasks of this stage that are done, and expected
    surpassed : whether this stage has more tasks than were expected
    """

    stage: str
    done: int
    running: int
    expected: int
    elapsed: float
    left: float | None
    of_stage: tuple[int, int] = (0, 0)
    surpassed: bool = False


# 12 fields: five are given, the others are its state.
@dataclass
class Progress:
    """Follows the tasks of a run and reports its state after every change.

    Attributes
    ----------
    report : is called with the state
    clock : returns seconds
    spent : costs of the tasks computed, without those kept from an earlier run
    workers : tasks that are computed at the same time, as far as there are so many
    planned : seconds that a task of each stage will probably take
    """

    report: Callable[[State], object] = lambda _: None
    clock: Callable[[], float] = time.monotonic
    spent: Costs = field(default_factory=Costs)
    workers: int = 1
    planned: Mapping[str, float] = field(default_factory=dict)
    _expected: Counter[str] = field(default_factory=Counter)
    _done: Counter[str] = field(default_factory=Counter)
    _running: Counter[str] = field(default_factory=Counter)
    _stage: str = ""
    _computed: Counter[str] = field(default_factory=Counter)
    _seconds: dict[str, float] = field(default_factory=dict)
    _began: float | None = None

    def expect(self, stages: Mapping[str, int]) -> None:
        """Note the number of tasks of each stage that are still to come."""
        for stage, count in stages.items():
            self._expected[stage] = self._done[stage] + count
        self.report(self.state)

    def start(self, stage: str) -> None:
        """Take note that a task of a stage is being computed, or taken from what is kept."""
        if self._began is None:
            self._began = self.clock()
        if stage != self._stage and self._stage:
            self._expected[self._stage] = self._met(self._stage)
        self._stage = stage
        self._running[stage] += 1
        self.report(self.state)

    def end(self, stage: str, seconds: float | None) -> None:
        """Take note that a task has ended; it took no ``seconds`` where its result was kept."""
        self._running[stage] -= 1
        self._done[stage] += 1
        if seconds is not None:
            self._computed[stage] += 1
            self._seconds[stage] = self._seconds.get(stage, 0.0) + seconds
        self.report(self.state)

    @property
    def state(self) -> State:
        """State of the run."""
        stages = dict.fromkeys([*self._expected, *self._done, *self._running])
        extents = {stage: max(self._expected[stage], self._met(stage)) for stage in stages}
        return State(
            self._stage,
            self._done.total(),
            self._running.total(),
            sum(extents.values()),
            0.0 if self._began is None else self.clock() - self._began,
            self._left(extents),
            (self._done[self._stage], extents.get(self._stage, 0)),
            self._met(self._stage) > self._expected[self._stage],
        )

    def _left(self, extents: Mapping[str, int]) -> float | None:
        """Return the seconds that all tasks to come will probably take; None for unknown."""
        count = self._computed.total()
        if not count and not self.planned:
            return None
        mean = sum(self._seconds.values()) / count if count else 0.0
        left = 0.0
        for stage, extent in extents.items():
            each = self.planned.get(stage, mean)
            if stage in self._computed:
                each = self._seconds[stage] / self._computed[stage]
            left += (extent - self._done[stage]) * each
        return left / self.workers

    def _met(self, stage: str) -> int:
        return self._done[stage] + self._running[stage]


ITERATION = "iteration "
"""What a note begins with that is a detail of the one before it."""

Listener = Callable[[str], object]

_LISTENER: ContextVar[Listener] = ContextVar("listener", default=lambda _: None)


def note(text: str) -> None:
    """Tell the listener the present step of the running task."""
    _LISTENER.get()(text)


def note_iteration(number: int) -> None:
    """Tell the listener which iteration the search at work has come to."""
    note(f"{ITERATION}{number}")


@contextmanager
def listening(listener: Listener) -> Iterator[None]:
    """Send notes to a listener until the context ends."""
    before = _LISTENER.set(listener)
    try:
        yield
    finally:
        _LISTENER.reset(before)
