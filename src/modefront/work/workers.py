"""A backend that hands tasks to other processes: of this machine, or those of a Dask cluster.

Short tasks are sent several at a time. Those of a process that is lost are done again, alone, and
given up the second time: the others are computed to the end, and an error names it. A process of
this machine ends with the one that has started it, and leaves interrupts of the terminal to it.
"""

import importlib
import logging
import math
import multiprocessing
import os
import signal
import threading
import time
from collections import Counter, deque
from collections.abc import Callable, Collection, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, CancelledError, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import cache
from multiprocessing import connection, resource_tracker
from pickle import PicklingError
from typing import Any, Protocol, TypeAlias

from threadpoolctl import threadpool_limits

from modefront.errors import UnfinishedError, wrong
from modefront.inputs import available_memory
from modefront.work.task import Done, Key, Task, computed, spend
from modefront.work.transfer import Message, Reply, Sender, work

SHORT = 0.02  # s of tasks that are sent together, about
TINY = 0.005  # s of all tasks, below which they are computed in the calling process
QUEUED = 2  # messages that are sent at a time, over the number of processes
SHARE = 0.6  # of the memory that is free, for all processes together
WARM = "modefront.front.pareto", "modefront.analysis.front"  # what processes import as they start
MOST = 61  # processes of this machine at most; Windows waits for no more

GONE = "the Dask scheduler is gone; what was done is kept"
ANSWER, JOIN = 10.0, 60.0  # s in which a scheduler has to answer, and a worker to join

ONE_THREAD = {"RAYON_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
"""Environment of a process with one thread: of rslab, `modefront.linalg.products` and the BLAS. A
BLAS that is limited only after it has started its threads makes imports take half as long again."""

Errors: TypeAlias = tuple[type[Exception], ...]


class Pool(Protocol):
    """Processes that compute messages."""

    lost: Errors  # of messages whose process has ended
    gone: Errors  # where there are no processes any more

    @property
    def count(self) -> int:
        """Number of processes."""

    @property
    def ready(self) -> bool:
        """Whether a message would be computed at once."""

    def submit(self, message: Message, objects: dict[str, bytes], /) -> Future[Reply]:
        """Compute a message in one of the processes."""

    def close(self) -> None:
        """End all processes, whatever they do."""


class LocalPool:
    """Processes of this machine, spawned, with one thread each.

    They import `WARM` when they start, and with it what most tasks need. Where one has ended, the
    executor ends the others, and new ones compute what is sent next.
    """

    lost: Errors = (BrokenProcessPool,)
    gone: Errors = ()

    def __init__(self, count: int) -> None:
        self.count = count
        self._start()

    @property
    def ready(self) -> bool:
        """Whether the first process has started."""
        return self._first.done()

    def submit(self, message: Message, objects: dict[str, bytes], /) -> Future[Reply]:
        """Compute a message in one of the processes."""
        with suppress(BrokenProcessPool), _starting():  # of a process that was not needed yet
            return self._executor.submit(work, message, objects)
        self._start()
        with _starting():
            return self._executor.submit(work, message, objects)

    def _start(self) -> None:
        """Start the processes, or others in their place."""
        spawn = multiprocessing.get_context("spawn")
        try:
            with _starting():
                self._executor = ProcessPoolExecutor(self.count, spawn, _prepare)
                # The executor starts a process a task, as long as none of them is idle.
                self._first, *_ = [self._executor.submit(int) for _ in range(self.count)]
        except BaseException:  # an interrupt that was held back
            self.close()
            raise

    def close(self) -> None:
        """End all processes, whatever they do."""
        processes = list((self._executor._processes or {}).values())
        for process in processes:  # first, so that none of them misses what it starts with
            process.kill()
        self._executor.shutdown(wait=False, cancel_futures=True)
        for process in processes:
            process.join()


def _prepare() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGTERM})

    def end_with_parent() -> None:
        if parent := multiprocessing.parent_process():
            connection.wait([parent.sentinel])
            os._exit(1)

    threading.Thread(target=end_with_parent, daemon=True).start()
    for module in WARM:
        importlib.import_module(module)
    _take_one_thread()


@cache
def _take_one_thread() -> None:
    """Limit the BLAS of this process, and what it first shares among threads later, to one."""
    os.environ.update(ONE_THREAD)
    threadpool_limits(1, user_api="blas")


@contextmanager
def _starting() -> Iterator[None]:
    """Start processes with one thread, which hold interrupts back for good, until the context ends.

    Among these is the one in which `multiprocessing` keeps account of semaphores. It is started
    first, since `multiprocessing` lets interrupts pass once it has started it.
    """
    environment, signals = dict(os.environ), None
    os.environ.update(ONE_THREAD)
    try:
        if hasattr(signal, "pthread_sigmask"):  # on Windows the initializer ignores them
            held = {signal.SIGINT, signal.SIGHUP, signal.SIGTERM}
            signals = signal.pthread_sigmask(signal.SIG_BLOCK, held)
            resource_tracker.ensure_running()
            signal.pthread_sigmask(signal.SIG_BLOCK, held)
        yield
    finally:
        for name in ONE_THREAD:
            os.environ.pop(name)
        os.environ.update({x: environment[x] for x in ONE_THREAD if x in environment})
        if signals is not None:
            signal.pthread_sigmask(signal.SIG_SETMASK, signals)


class Cluster:
    """Workers of a Dask cluster that runs already, at the address of its scheduler.

    Raises InputError where `distributed` is not installed or the address is none, UnfinishedError
    where no scheduler answers, no worker joins, or the versions differ.
    """

    ready = True

    def __init__(self, address: str) -> None:
        try:
            distributed: Any = importlib.import_module("distributed")
        except ImportError:
            expected = "the extra 'cluster': pip install modefront[cluster]"
            raise wrong("--scheduler", expected, "no package 'distributed'") from None
        self.lost: Errors = (distributed.KilledWorker,)
        self.gone: Errors = (CancelledError, OSError, distributed.client.ClosedClientError)
        logging.getLogger("distributed").setLevel(logging.CRITICAL)  # errors say what it logs
        self._client = client = object.__new__(distributed.Client)
        try:
            client.__init__(address, timeout=ANSWER, set_as_default=False)
        except (TypeError, ValueError) as error:
            client.status = "closed"  # it was never open, and would wait for itself in the end
            expected = "an address like tcp://HOST:PORT"
            raise wrong("--scheduler", expected, f"{address}: {error}") from None
        except OSError:
            raise UnfinishedError(f"no Dask scheduler answers at {address}") from None
        try:
            self._client.wait_for_workers(1, timeout=JOIN)
        except TimeoutError:
            self._client.close()
            raise UnfinishedError(f"no worker has joined the scheduler {address}") from None
        self._executor = self._client.get_executor(pure=False, retries=0)
        self._count, self._counted = 1, -math.inf

    @property
    def count(self) -> int:
        """Number of threads of all workers, as it was a few seconds ago."""
        if time.monotonic() > self._counted + 10:
            self._counted = time.monotonic()
            with suppress(Exception):  # what is lost shows when it is used
                self._count = max(1, sum(self._client.nthreads().values()))
        return self._count

    def submit(self, message: Message, objects: dict[str, bytes], /) -> Future[Reply]:
        """Compute a message in one of the workers."""
        return self._executor.submit(_work_of_one_thread, message, objects)

    def close(self) -> None:
        """Leave the cluster, which cancels what it still computes for this run."""
        with suppress(Exception):  # a scheduler that is gone needs no farewell
            self._executor.shutdown(wait=False, cancel_futures=True)
            self._client.close(timeout=5)


def _work_of_one_thread(message: Message, objects: dict[str, bytes]) -> Reply:
    _take_one_thread()
    return work(message, objects)


@dataclass
class _Call:
    """Tasks of one call, by their positions: to be sent, to be sent alone, sent, and failed.

    What is sent has a message, and names of shared objects that came with it, as some process did
    not know them.
    """

    pool: Pool
    tasks: Sequence[Task[Any]]
    pending: deque[int]
    alone: deque[int] = field(default_factory=deque)
    flying: dict[Future[Reply], tuple[Sequence[int], Message, Collection[str]]] = field(
        default_factory=dict
    )
    errors: dict[int, Exception] = field(default_factory=dict)


@dataclass
class Workers:
    """Hands tasks to the processes of a pool, which may take so many bytes of memory together.

    Without a pool, it computes them in this process, one after another.
    """

    pool: Pool | None = None
    memory: float = field(default_factory=lambda: SHARE * available_memory())
    _sender: Sender = field(default_factory=Sender)
    _seconds: dict[str, float] = field(default_factory=dict)
    _losses: Counter[tuple[Key, Key]] = field(default_factory=Counter)

    @property
    def workers(self) -> int:
        """Number of processes."""
        return self.pool.count if self.pool else 1

    def __enter__(self) -> "Workers":
        return self

    def __exit__(self, *_: object) -> None:
        if self.pool:
            self.pool.close()

    def compute(
        self, tasks: Sequence[Task[Any]], begun: Callable[[str], object], /
    ) -> Iterator[tuple[int, Done]]:
        """Yield positions and results of the tasks as they end; ``begun`` hears of their stages.

        Raises UnfinishedError where a task was lost twice or the cluster is gone, InputError where
        the model cannot be sent to another process, and what tasks raise; but for a cluster that
        is gone, all other tasks are computed first.
        """
        if self.pool is None:
            for k, task in enumerate(tasks):
                begun(task.stage)
                yield k, computed(task)
            return
        call = _Call(self.pool, tasks, deque(range(len(tasks))))
        while call.pending or call.alone or call.flying:
            if self._is_for_this_process(call):
                k = call.pending.popleft()
                begun(tasks[k].stage)
                yield k, self._learnt(tasks[k], computed(tasks[k]))
                continue
            self._send(call, begun)
            for future in wait(call.flying, return_when=FIRST_COMPLETED).done:
                yield from self._received(call, future)
        if call.errors:
            raise call.errors[min(call.errors)]

    def _is_for_this_process(self, call: _Call) -> bool:
        """Return whether the next task is computed here: one of this process, and a single one.

        So are tiny ones, and others while the pool starts. Where a process was lost, none of these
        is: it might have been the fault of a task.
        """
        if call.pending and call.tasks[call.pending[0]].in_process:
            return True
        if not call.pending or self._losses:
            return False
        if not call.pool.ready:
            return True
        lone = len(call.pending) == 1 and not call.flying
        seconds = (self._seconds.get(_kind(call.tasks[k]), SHORT) for k in call.pending)
        return lone or sum(seconds) < TINY

    def _send(self, call: _Call, begun: Callable[[str], object]) -> None:
        """Send tasks of a call, as many as the processes have room for."""
        if call.alone:
            if not call.flying:
                positions = [call.alone.popleft()]
                self._submit(call, positions, self._message(call, positions))
            return
        while call.pending and len(call.flying) < QUEUED * call.pool.count:
            share = math.ceil(len(call.pending) / call.pool.count)
            each = self._seconds.get(_kind(call.tasks[call.pending[0]]), SHORT)
            count = max(1, min(share, int(SHORT / max(each, SHORT / 1000))))
            positions = [call.pending[k] for k in range(count)]
            message = self._message(call, positions)
            taken = sum(sent.memory for _, sent, _ in call.flying.values())
            if call.flying and taken + message.memory > self.memory:
                return
            self._submit(call, positions, message)
            for k in positions:
                call.pending.popleft()
                begun(call.tasks[k].stage)

    def _message(self, call: _Call, positions: Sequence[int]) -> Message:
        try:
            return self._sender.message([call.tasks[k] for k in positions])
        except (PicklingError, AttributeError, TypeError) as error:
            expected = "a model that other processes can import: functions of a module"
            raise wrong("workers", expected, error) from None

    def _submit(
        self, call: _Call, positions: Sequence[int], message: Message, lacked: Collection[str] = ()
    ) -> None:
        objects = self._sender.objects([name for name in message.names if name in lacked])
        try:
            call.flying[call.pool.submit(message, objects)] = positions, message, lacked
        except call.pool.gone:
            raise UnfinishedError(GONE) from None

    def _received(self, call: _Call, future: Future[Reply]) -> Iterator[tuple[int, Done]]:
        positions, message, lacked = call.flying.pop(future)
        try:
            reply = future.result()
        except call.pool.lost:
            for k in positions:
                self._lose(call, k, "the process that computed it ended")
            return
        except call.pool.gone:
            raise UnfinishedError(GONE) from None
        if isinstance(reply, tuple):
            self._submit(call, positions, message, {*lacked, *reply})
            return
        for k, done in zip(positions, reply, strict=True):
            if done.error is None:
                spend(done.costs)
                yield k, self._learnt(call.tasks[k], done)
            elif isinstance(done.error, MemoryError):
                self._lose(call, k, "its memory does not suffice")
            else:
                call.errors[k] = done.error

    def _lose(self, call: _Call, position: int, reason: str) -> None:
        """Note that a task was lost: it is done again, alone, and given up the second time."""
        task = call.tasks[position]
        self._losses[task.identity] += 1
        if self._losses[task.identity] == 1:
            call.alone.append(position)
        else:
            text = f"task '{task.name}' could not be done: {reason}, twice; all others are kept"
            call.errors[position] = UnfinishedError(text)

    def _learnt(self, task: Task[Any], done: Done) -> Done:
        kind = _kind(task)
        self._seconds[kind] = (self._seconds.get(kind, done.seconds) + done.seconds) / 2
        return done


def _kind(task: Task[Any]) -> str:
    functions = [task.function, *(x for x in task.arguments[:1] if callable(x))]
    return " ".join([task.stage, *(function.__qualname__ for function in functions)])


@contextmanager
def backend(workers: int, scheduler: str | None = None) -> Iterator[Workers]:
    """Open the workers of so many processes, or of the cluster with this scheduler.

    Raises InputError for a number of processes that is not possible, and what `Cluster` raises.
    """
    if not isinstance(workers, int) or not 1 <= workers <= MOST:
        raise wrong("workers", f"a whole number from 1 to {MOST}", workers)
    if scheduler is not None and workers > 1:
        raise wrong("workers", "1, since the cluster has its own", workers)
    pool: Pool | None = LocalPool(workers) if workers > 1 else None
    with Workers(Cluster(scheduler) if scheduler is not None else pool) as out:
        yield out
