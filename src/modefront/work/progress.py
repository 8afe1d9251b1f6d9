"""Progress of a run: its stage, tasks done, and the time that is left, as a range.

A stage ends when a task of another one starts. A plan says from and to how many searches each
stage takes, whatever the others take; a search takes as long as those of edges and front so far,
and as planned before there are many.
"""

import math
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field

import numpy as np

from modefront.work.task import Costs

Span = tuple[float, float]  # from and to

COUNTED = frozenset(("sample-posterior", "bootstrap", "predict", "second-derivatives"))
"""Stages whose number of tasks is known when they begin."""

SEARCHES = ("edges", "front")  # stages of which a task is a search

MANY, SIMILAR = 8, (0.6, 1.6)
"""Searches whose time counts as much as the planned one; time of a task that is left over the mean
of those before, from and to."""


def together(spans: Iterable[Span]) -> Span:
    """Return the seconds of several independent parts, which are not all long at once.

    Most parts take little more than their least, so these add up. To the other end, geometric
    middles do, and the squares of the distances of the ends from them.
    """
    least, most = np.array([*spans, (0.0, 0.0)]).T
    middle = np.sqrt(least * np.where(np.isfinite(most), most, least))
    return float(least.sum()), float(middle.sum() + np.linalg.norm(most - middle))


@dataclass(frozen=True)
class Plan:
    """Seconds of a search, searches of each stage from and to, and seconds of other stages."""

    search: float = 0.0
    searches: Mapping[str, Span] = field(default_factory=dict)
    other: Mapping[str, Span] = field(default_factory=dict)

    @property
    def seconds(self) -> Span:
        """Seconds of all stages."""
        return together(self.of(stage, self.search) for stage in (*self.searches, *self.other))

    def of(self, stage: str, search: float) -> Span:
        """Return the seconds of a stage, where a search takes so many."""
        few, many = self.searches.get(stage, (0.0, 0.0))
        least, most = self.other.get(stage, (0.0, 0.0))
        return few * search + least, many * search + most


@dataclass(frozen=True)
class State:
    """The state of a run: the stage of the last task that was started, and numbers of tasks.

    ``left`` are the seconds until it ends, from and to, infinite where a search takes longer than
    planned, None where nothing is; ``of_stage`` tasks of this stage that are done, and expected.
    """

    stage: str
    done: int
    running: int
    expected: int
    left: Span | None
    of_stage: tuple[int, int] = (0, 0)


# 11 fields: four are given, the others are its state.
@dataclass
class Progress:
    """Follows the tasks of a run and calls ``report`` with its state after every change.

    ``spent`` are the costs of tasks that were computed and not kept from an earlier run.
    """

    report: Callable[[State], object] = lambda _: None
    spent: Costs = field(default_factory=Costs)
    workers: int = 1
    plan: Plan | None = None
    _expected: Counter[str] = field(default_factory=Counter)
    _done: Counter[str] = field(default_factory=Counter)
    _running: Counter[str] = field(default_factory=Counter)
    _stage: str = ""
    _computed: Counter[str] = field(default_factory=Counter)
    _seconds: defaultdict[str, float] = field(default_factory=lambda: defaultdict(float))
    _ended: set[str] = field(default_factory=set)

    def expect(self, stages: Mapping[str, int]) -> None:
        """Note the number of tasks of each stage that are still to come."""
        for stage, count in stages.items():
            self._expected[stage] = self._done[stage] + count
        self.report(self.state)

    def start(self, stage: str) -> None:
        """Take note that a task of a stage is being computed, or taken from what is kept."""
        if stage != self._stage and self._stage:
            before = self._stage
            self._expected[before] = self._done[before] + self._running[before]
            self._ended.add(self._stage)
        self._ended.discard(stage)
        self._stage = stage
        self._running[stage] += 1
        self.report(self.state)

    def end(self, stage: str, seconds: float | None) -> None:
        """Take note that a task has ended; it took no ``seconds`` where its result was kept."""
        self._running[stage] -= 1
        self._done[stage] += 1
        if seconds is not None:
            self._computed[stage] += 1
            self._seconds[stage] += seconds
        self.report(self.state)

    @property
    def state(self) -> State:
        """State of the run."""
        stages = dict.fromkeys([*self._expected, *self._done, *self._running])
        extents = {x: max(self._expected[x], self._done[x] + self._running[x]) for x in stages}
        return State(
            self._stage,
            self._done.total(),
            self._running.total(),
            sum(extents.values()),
            self._left(extents),
            (self._done[self._stage], extents.get(self._stage, 0)),
        )

    def _left(self, extents: Mapping[str, int]) -> Span | None:
        """Return the seconds that all stages to come will probably take; None without a plan."""
        if self.plan is None:
            return None
        count = MANY + sum(self._computed[stage] for stage in SEARCHES)
        taken = MANY * self.plan.search + sum(self._seconds[stage] for stage in SEARCHES)
        spans: list[Span] = []
        for stage in {*self.plan.searches, *self.plan.other} - self._ended:
            low, high = self.plan.of(stage, taken / count)
            spent, done = self._seconds[stage], self._computed[stage]
            if done and stage in COUNTED:
                mean = (extents[stage] - self._done[stage]) * spent / done
                low, high = (factor * mean for factor in SIMILAR)
            else:
                high = high - spent if high > spent else math.inf
                low = 0.0 if self._done[stage] > done else max(low - spent, 0.0)
            spans.append((low, high))
        least, most = together(spans)
        return least / self.workers, most / self.workers


ITERATION = "iteration "  # what a note begins with that is a detail of the one before it

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
