"""Progress of a run: its stage, tasks done, and the time that is left, as a range.

A stage ends when a task of another one starts. It takes as long as planned, whatever the others
take. One that says how many tasks are to come, from and to, does not end before, and takes as long
as those that it has had: k more take from k (m - 2 s) to k (m + 2 s), where m is their mean, and s
their standard deviation, which counts one that is m beside the mean.
"""

import math
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping
from contextlib import AbstractContextManager
from contextvars import ContextVar
from dataclasses import dataclass, field

import numpy as np

from modefront.work.task import Costs, Count, held

Span = tuple[float, float]  # from and to


def together(spans: Iterable[Span]) -> Span:
    """Return the seconds of several independent parts, which are not all long at once.

    Most parts take little more than their least, so these add up. To the other end, geometric
    middles do, and the squares of the distances of the ends from them.
    """
    least, most = np.array([*spans, (0.0, 0.0)]).T
    middle = np.sqrt(least * np.where(np.isfinite(most), most, least))
    return float(least.sum()), float(middle.sum() + np.linalg.norm(most - middle))


@dataclass(frozen=True)
class State:
    """The state of a run: the stage of the last task that was started, and numbers of tasks.

    ``left`` are the seconds until it ends, from and to, infinite where a stage takes longer than
    planned, None where nothing is; ``of_stage`` tasks of this stage that are done, and ``extent``
    how many there are, from and to, None where this is not known.
    """

    stage: str
    done: int
    running: int
    left: Span | None
    of_stage: int = 0
    extent: Count | None = None


@dataclass
class _Stage:
    """What is known of a stage."""

    done: int = 0  # tasks that have ended, of which some may have been kept
    running: int = 0  # tasks that have started and not ended
    extent: Count | None = None  # of all its tasks; None where this is not known
    seconds: list[float] = field(default_factory=list)  # of tasks that were computed
    has_ended: bool = False

    def left(self, planned: Span) -> Span:
        """Return the seconds that its tasks to come will take."""
        count, spent = len(self.seconds), sum(self.seconds)
        if self.extent is None or not count:
            least, most = planned
            low = 0.0 if self.done > count else max(least - spent, 0.0)
            return low, most - spent if most > spent else math.inf
        mean = spent / count
        std = math.sqrt((mean**2 + sum((x - mean) ** 2 for x in self.seconds)) / count)
        few, many = (max(x - self.done, self.running) for x in self.extent)
        return few * max(mean - 2 * std, 0.0), many * (mean + 2 * std)


@dataclass
class Progress:
    """Follows the tasks of a run and calls ``report`` with its state after every change.

    ``spent`` are the costs of tasks that were computed and not kept from an earlier run; ``plan``
    has the seconds of the stages.
    """

    report: Callable[[State], object] = lambda _: None
    spent: Costs = field(default_factory=Costs)
    workers: int = 1
    plan: Mapping[str, Span] | None = None
    _stages: defaultdict[str, _Stage] = field(default_factory=lambda: defaultdict(_Stage))
    _stage: str = ""

    def expect(self, stages: Mapping[str, Count]) -> None:
        """Note the number of tasks of each stage that are still to come, from and to."""
        for name, (few, many) in stages.items():
            stage = self._stages[name]
            stage.extent = stage.done + few, stage.done + many
        self.report(self.state)

    def start(self, stage: str) -> None:
        """Take note that a task of a stage is being computed, or taken from what is kept."""
        if stage != self._stage and self._stage:
            before = self._stages[self._stage]
            before.has_ended = before.extent is None or before.done >= before.extent[0]
        self._stage = stage
        self._stages[stage].has_ended = False
        self._stages[stage].running += 1
        self.report(self.state)

    def end(self, stage: str, seconds: float | None) -> None:
        """Take note that a task has ended; it took no ``seconds`` where its result was kept."""
        known = self._stages[stage]
        known.running -= 1
        known.done += 1
        if seconds is not None:
            known.seconds.append(seconds)
        self.report(self.state)

    @property
    def state(self) -> State:
        """State of the run."""
        stages = self._stages.values()
        done, running = sum(x.done for x in stages), sum(x.running for x in stages)
        known = self._stages[self._stage] if self._stage else _Stage()
        return State(self._stage, done, running, self._left(), known.done, known.extent)

    def _left(self) -> Span | None:
        """Return the seconds that all stages to come will probably take; None without a plan."""
        if self.plan is None:
            return None
        told = {name: (0.0, 0.0) for name, x in self._stages.items() if x.extent and x.seconds}
        least, most = together(
            self._stages[name].left(planned)
            for name, planned in {**told, **self.plan}.items()
            if not self._stages[name].has_ended
        )
        return least / self.workers, most / self.workers


ITERATION = "iteration "  # what a note begins with that is a detail of the one before it

Listener = Callable[[str], object]

_LISTENER: ContextVar[Listener] = ContextVar("listener", default=lambda _: None)


def note(text: str) -> None:
    """Tell the listener the present step of the running task."""
    _LISTENER.get()(text)


def listening(listener: Listener) -> AbstractContextManager[None]:
    """Send notes to a listener until the context ends."""
    return held(_LISTENER, listener)
