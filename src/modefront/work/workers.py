"""A backend that hands tasks to other processes.

Tasks are sent as bytes, short ones several at a time.

Where a process is lost, the tasks that it may have computed are done again, one at a time. One
that is lost alone as well, or whose memory does not suffice twice, is given up: the others are
computed to the end, and an error names it.
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import contextmanager
from dataclasses import dataclass, field
from math import ceil
from pickle import PicklingError
from typing import Any

from modefront.errors import Fault, InputError, UnfinishedError, wrong
from modefront.inputs import available_memory
from modefront.work.costs import spend
from modefront.work.pools import Cluster, LocalPool, Loss, Pool
from modefront.work.task import Backend, Done, InTurn, Key, Task, computed
from modefront.work.transfer import Message, Reply, Sender

SHORT = 0.02
"""Seconds of tasks that are sent together, about."""

TINY = 0.005
"""Seconds of all tasks below which they are computed in the calling process."""

QUEUED = 2
"""Messages that are sent, over the number of processes."""

LOSSES = 2
"""Times that a task is lost, after which it is given up."""

SHARE = 0.6
"""Share of the memory that is available that processes may take."""

WARM = "modefront.front.pareto", "modefront.analysis.front"
"""What processes import when they start: nearly all that the tasks of a run need."""

MOST = 61
"""Processes of this machine at most; Windows waits for no more."""


@dataclass
class _Call:
    """Tasks of one call.

    Attributes
    ----------
    tasks : of the call
    begun : is called with the position of each task that is sent or computed
    pending : positions of tasks to be sent
    alone : positions of tasks that are sent one at a time, since a process was lost with them
    flying : positions of tasks that were sent, their message, and the names of shared objects that
        came with it, as some process did not know them; by what will come back
    errors : of tasks, by their position
    """

    tasks: Sequence[Task[Any]]
    begun: Callable[[int], None]
    pending: deque[int]
    alone: deque[int] = field(default_factory=deque)
    flying: dict[Future[Reply], tuple[Sequence[int], Message, frozenset[str]]] = field(
        default_factory=dict
    )
    errors: dict[int, Exception] = field(default_factory=dict)


@dataclass
class Workers:
    """Hands tasks to the processes of a pool.

    Attributes
    ----------
    pool : the processes
    memory : bytes that they may take together
    """

    pool: Pool
    memory: float = field(default_factory=lambda: SHARE * available_memory())
    _sender: Sender = field(default_factory=Sender)
    _seconds: dict[str, float] = field(default_factory=dict)
    _losses: Counter[tuple[Key, Key]] = field(default_factory=Counter)

    @property
    def workers(self) -> int:
        """Number of processes."""
        return self.pool.count

    def __enter__(self) -> Workers:
        return self

    def __exit__(self, *_: object) -> None:
        self.pool.close()

    def compute(
        self, tasks: Sequence[Task[Any]], begun: Callable[[int], None], /
    ) -> Iterator[tuple[int, Done]]:
        """Yield the results of the tasks as they end.

        Raises UnfinishedError where a task was lost twice or the cluster is gone, InputError where
        the model cannot be sent to another process, and what tasks raise; but for a cluster that
        is gone, all other tasks are computed first.
        """
        call = _Call(tasks, begun, deque(range(len(tasks))))
        while call.pending or call.alone or call.flying:
            if self._is_for_this_process(call):
                k = call.pending.popleft()
                begun(k)
                done = computed(tasks[k])
                self._learn(tasks[k], done.seconds)
                yield k, done
                continue
            self._send(call)
            for future in wait(call.flying, return_when=FIRST_COMPLETED).done:
                if future in call.flying:  # else it was lost with another one
                    yield from self._received(call, future)
        if call.errors:
            raise call.errors[min(call.errors)]

    def _is_for_this_process(self, call: _Call) -> bool:
        """Return whether the next task is computed here: a single one, and while the pool starts.

        So are tiny ones. Where a process was lost, none is: it might have been the fault of a task.
        """
        if not call.pending or self._losses:
            return False
        if not self.pool.ready:
            return True
        lone = len(call.pending) == 1 and not call.flying
        seconds = (self._seconds.get(_kind(call.tasks[k]), SHORT) for k in call.pending)
        return lone or sum(seconds) < TINY

    def _send(self, call: _Call) -> None:
        """Send tasks of a call, as many as the processes have room for."""
        if call.alone:
            if not call.flying:
                self._submit(call, [call.alone.popleft()])
            return
        while call.pending and len(call.flying) < QUEUED * self.pool.count:
            share = ceil(len(call.pending) / self.pool.count)
            each = self._seconds.get(_kind(call.tasks[call.pending[0]]), SHORT)
            count = max(1, min(share, int(SHORT / max(each, SHORT / 1000))))
            positions = [call.pending[k] for k in range(count)]
            if not self._submit(call, positions):
                return
            for k in positions:
                call.pending.popleft()
                call.begun(k)

    def _submit(self, call: _Call, positions: Sequence[int]) -> bool:
        """Send tasks; return False where the memory does not suffice for one message more."""
        try:
            message = self._sender.message([call.tasks[k] for k in positions])
        except (PicklingError, AttributeError, TypeError) as error:
            expected = "a model that other processes can import: functions of a module"
            raise InputError(Fault("", "workers", expected, str(error))) from None
        taken = sum(sent.memory for _, sent, _ in call.flying.values())
        if call.flying and taken + message.memory > self.memory:
            return False
        self._fly(call, positions, message, frozenset())
        return True

    def _fly(
        self, call: _Call, positions: Sequence[int], message: Message, lacked: frozenset[str]
    ) -> None:
        """Send tasks with the shared objects that a process has lacked."""
        objects = self._sender.objects([name for name in message.names if name in lacked])
        sent = positions, message, lacked
        try:
            call.flying[self.pool.submit(message, objects)] = sent
        except Exception as error:
            loss = self.pool.lost(error)
            if loss is Loss.CLUSTER:
                raise UnfinishedError("the Dask scheduler is gone") from None
            if loss is not Loss.POOL:
                raise
            self.pool.restart()
            call.flying[self.pool.submit(message, objects)] = sent

    def _received(self, call: _Call, future: Future[Reply]) -> Iterator[tuple[int, Done]]:
        try:
            reply = future.result()
        except Exception as error:
            loss = self.pool.lost(error)
            if loss is None:
                raise
            self._lose(call, future, loss)
            return
        positions, message, lacked = call.flying.pop(future)
        if reply.lacking:
            self._fly(call, positions, message, lacked.union(reply.lacking))
            return
        for k, done in zip(positions, reply.done, strict=False):
            self._learn(call.tasks[k], done.seconds)
            spend(done.costs)
            yield k, done
        if reply.error is None:
            return
        failed, *others = positions[len(reply.done) :]
        if isinstance(reply.error, MemoryError):
            self._lost_one(call, failed, "its memory does not suffice")
        else:
            call.errors[failed] = reply.error
        call.pending.extend(others)

    def _lose(self, call: _Call, future: Future[Reply], loss: Loss) -> None:
        """Take note of a loss; the tasks that it concerns are done again, one at a time."""
        if loss is Loss.CLUSTER:
            raise UnfinishedError("the Dask scheduler is gone; what was done is kept")
        lost = list(call.flying.values()) if loss is Loss.POOL else [call.flying[future]]
        if loss is Loss.POOL:
            call.flying.clear()
            self.pool.restart()
        else:
            del call.flying[future]
        for positions, *_ in lost:
            for k in positions:
                self._lost_one(call, k, "the process that computed it ended")

    def _lost_one(self, call: _Call, position: int, reason: str) -> None:
        """Take note that a task was lost, and give it up where that is not the first time."""
        task = call.tasks[position]
        self._losses[task.identity] += 1
        if self._losses[task.identity] < LOSSES:
            call.alone.append(position)
            return
        text = f"task '{task.name}' could not be done: {reason}, twice; all others are kept"
        call.errors[position] = UnfinishedError(text)

    def _learn(self, task: Task[Any], seconds: float) -> None:
        kind = _kind(task)
        self._seconds[kind] = (self._seconds.get(kind, seconds) + seconds) / 2


def _kind(task: Task[Any]) -> str:
    functions = [task.function, *(x for x in task.arguments[:1] if callable(x))]
    return " ".join([task.stage, *(function.__qualname__ for function in functions)])


@contextmanager
def backend(
    workers: int, scheduler: str | None = None, warm: Sequence[str] = WARM
) -> Iterator[Backend]:
    """Open the backend of so many processes, or of the cluster with this scheduler.

    Processes import the modules ``warm`` when they start. Raises InputError for a number of
    processes that is not possible, and what `Cluster` raises.
    """
    if not isinstance(workers, int) or not 1 <= workers <= MOST:
        raise wrong("workers", f"a whole number from 1 to {MOST}", workers)
    if scheduler is not None and workers > 1:
        raise wrong("workers", "1, since the cluster has its own", workers)
    if scheduler is None and workers == 1:
        yield InTurn()
        return
    pool = LocalPool(workers, warm) if scheduler is None else Cluster(scheduler)
    with Workers(pool) as out:
        yield out
