"""Processes that compute messages of tasks: spawned on this machine, or those of a Dask cluster.

A process of this machine ends with the one that has started it, whatever ends that, and leaves
interrupts of the terminal to it.
"""

from __future__ import annotations

import importlib
import logging
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import CancelledError, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from enum import Enum
from functools import cache
from multiprocessing import resource_tracker
from multiprocessing.connection import wait
from typing import Any, Protocol

from threadpoolctl import threadpool_limits

from modefront.errors import Fault, InputError, UnfinishedError
from modefront.work.transfer import Message, Reply, work

ANSWER, JOIN = 10.0, 60.0
"""Seconds in which a scheduler has to answer, and one of its workers to join."""

ONE_THREAD = {"RAYON_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
"""Environment of a process with one thread: of rslab, `modefront.linalg.products` and the BLAS. A
BLAS that is limited only after it has started its threads makes imports take half as long again."""

OFTEN = 10.0
"""Seconds after which the workers of a cluster are counted again."""


class Loss(Enum):
    """Tasks that are lost with an error that is not one of a task."""

    PROCESS = "the process that computed the task"
    POOL = "all processes, which can be started again"
    CLUSTER = "the cluster"


class Pool(Protocol):
    """Processes that compute messages."""

    @property
    def count(self) -> int:
        """Number of processes."""

    @property
    def ready(self) -> bool:
        """Whether a message would be computed at once."""

    def submit(self, message: Message, objects: dict[str, bytes], /) -> Future[Reply]:
        """Compute a message in one of the processes."""

    def lost(self, error: Exception, /) -> Loss | None:
        """Return the loss that an error means; None where it is an error of the task."""

    def restart(self) -> None:
        """Start the processes again."""

    def close(self) -> None:
        """End all processes, whatever they do."""


@dataclass
class LocalPool:
    """Processes of this machine, spawned, with one thread each.

    They import the modules ``warm`` when they start, and with them what most tasks need.
    """

    count: int
    warm: Sequence[str] = ()
    _executor: ProcessPoolExecutor = field(init=False)
    _first: Future[int] = field(init=False)

    def __post_init__(self) -> None:
        self.restart()

    @property
    def ready(self) -> bool:
        """Whether the first process has started."""
        return self._first.done()

    def submit(self, message: Message, objects: dict[str, bytes], /) -> Future[Reply]:
        """Compute a message in one of the processes."""
        with _starting():  # the executor may start a process that it has not needed yet
            return self._executor.submit(work, message, objects)

    def lost(self, error: Exception, /) -> Loss | None:
        """Return that all processes are lost where one has ended: the executor ends the others."""
        return Loss.POOL if isinstance(error, BrokenProcessPool) else None

    def restart(self) -> None:
        """Start the processes, or others in their place."""
        spawn = multiprocessing.get_context("spawn")
        try:
            with _starting():
                self._executor = ProcessPoolExecutor(self.count, spawn, _prepare, (self.warm,))
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


def _prepare(warm: Sequence[str]) -> None:
    """Prepare a process: one thread, no interrupts, an end with its parent."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGTERM})
    threading.Thread(target=_end_with_parent, daemon=True).start()
    for module in warm:
        importlib.import_module(module)
    _take_one_thread()


@cache
def _take_one_thread() -> None:
    """Limit the BLAS of this process, and what it first shares among threads later, to one."""
    os.environ.update(ONE_THREAD)
    threadpool_limits(1, user_api="blas")


def _end_with_parent() -> None:
    """End the process as soon as the one that has started it has ended."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os._exit(1)


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
            os.environ.update({name: environment[name]} if name in environment else {})
        if signals is not None:
            signal.pthread_sigmask(signal.SIG_SETMASK, signals)


@dataclass
class Cluster:
    """Workers of a Dask cluster that runs already, at the address of its scheduler.

    Raises InputError where `distributed` is not installed or the address is none, UnfinishedError
    where no scheduler answers, no worker joins, or the versions differ.
    """

    address: str
    _count: int = 1
    _counted: float = -OFTEN
    _client: Any = field(init=False)
    _executor: Any = field(init=False)

    def __post_init__(self) -> None:
        place = "--scheduler"
        try:
            distributed: Any = importlib.import_module("distributed")
        except ImportError:
            expected = "the extra 'cluster': pip install modefront[cluster]"
            raise InputError(Fault("", place, expected, "no package 'distributed'")) from None
        try:
            logging.getLogger("distributed").setLevel(logging.CRITICAL)  # errors say what it logs
            self._client = distributed.Client(self.address, timeout=ANSWER, set_as_default=False)
        except ValueError as error:
            expected = "an address like tcp://HOST:PORT"
            raise InputError(Fault("", place, expected, f"{self.address}: {error}")) from None
        except OSError:
            raise UnfinishedError(f"no Dask scheduler answers at {self.address}") from None
        try:
            self._client.wait_for_workers(1, timeout=JOIN)
        except TimeoutError:
            self._client.close()
            raise UnfinishedError(f"no worker has joined the scheduler {self.address}") from None
        self._executor = self._client.get_executor(pure=False, retries=0)

    @property
    def count(self) -> int:
        """Number of threads of all workers, as it was a few seconds ago."""
        if time.monotonic() > self._counted + OFTEN:
            self._counted = time.monotonic()
            with suppress(Exception):  # what is lost shows when it is used
                self._count = max(1, sum(self._client.nthreads().values()))
        return self._count

    @property
    def ready(self) -> bool:
        """True: the workers run already."""
        return True

    def submit(self, message: Message, objects: dict[str, bytes], /) -> Future[Reply]:
        """Compute a message in one of the workers."""
        return self._executor.submit(_work_of_one_thread, message, objects)

    def lost(self, error: Exception, /) -> Loss | None:
        """Return whether a worker or the whole cluster is lost."""
        from distributed import KilledWorker

        if isinstance(error, KilledWorker):
            return Loss.PROCESS
        return Loss.CLUSTER if isinstance(error, CancelledError | OSError) else None

    def restart(self) -> None:
        """Do nothing: the scheduler replaces workers."""

    def close(self) -> None:
        """Leave the cluster, which cancels what it still computes for this run."""
        with suppress(Exception):  # a scheduler that is gone needs no farewell
            self._executor.shutdown(wait=False, cancel_futures=True)
            self._client.close(timeout=5)


def _work_of_one_thread(message: Message, objects: dict[str, bytes]) -> Reply:
    _take_one_thread()
    return work(message, objects)
