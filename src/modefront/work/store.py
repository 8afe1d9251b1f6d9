"""The executor of a run, and results of tasks, so that an interrupted run loses only one.

There is one small file a task in a folder. It ends with a checksum, which alone says whether it is
whole; arrays are stored exactly.
"""

import hashlib
import io
import os
import re
import socket
import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from filelock import FileLock, SoftFileLock, Timeout

from modefront.errors import Fault, InputError, writing
from modefront.outputs import write_bytes, write_text
from modefront.text import NAME, clean
from modefront.work.codec import dump, load
from modefront.work.progress import Progress
from modefront.work.task import Costs, Count, Executor, Key, R, Task
from modefront.work.workers import Workers

FOLDER = "tasks"  # folder of the kept results within that of a run's results
NOTE = "study"  # file in it with the path of the study file from there
CHECKSUM = 32  # bytes of the checksum at the end of a file
LONGEST = 60  # characters of a key in the name of a file, at most
LONG = 1.0  # s of a task for whose result the drive is waited for; shorter ones are soon done anew


@dataclass(frozen=True)
class Store:
    """Keeps results of tasks in a folder."""

    folder: Path

    def read(self, task: Task[Any]) -> tuple[Any, Costs] | None:
        """Return the result of a task and what it cost; None where no whole one is kept."""
        path, kept = self._path(task), b""
        with suppress(OSError):
            if path.is_file():  # a pipe in its place would be waited for
                kept = path.read_bytes()
        content = kept[:-CHECKSUM]
        return load(io.BytesIO(content)) if kept[-CHECKSUM:] == _checksum(task, content) else None

    def write(self, task: Task[Any], result: Any, costs: Costs, seconds: float = LONG) -> None:
        """Keep the result of a task, whole or not at all; a long one outlasts a power failure."""
        content = io.BytesIO()
        dump((result, costs), content)
        path, kept = self._path(task), content.getvalue()
        path.parent.mkdir(parents=True, exist_ok=True)
        write_bytes(path, kept + _checksum(task, kept), lasting=seconds >= LONG)

    def _path(self, task: Task[Any]) -> Path:
        """Return a file that no other task has, whatever the characters of its key and case."""
        safe = re.sub(r"[^A-Za-z0-9_-]", ".", task.name)[:LONGEST]
        return self.folder / f"{safe}-{hash_text(repr(task.identity))[:8]}.npz"


def _checksum(task: Task[Any], content: bytes) -> bytes:
    return hashlib.blake2b(repr(task.identity).encode() + content, digest_size=CHECKSUM).digest()


def hash_text(text: str) -> str:
    """Return a short hash that does not change between runs."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]


FILE = "lock"  # is locked, and stays, since a lock on a file that is removed keeps nobody out
HOLDER = "lock-holder"  # file that says which process holds the lock


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold the lock of a folder of results while a run works in it; its tasks have a folder.

    It is the operating system's lock on a file, which ends with the process that holds it, however
    that ends. On drives without such locks the file itself is the lock; `filelock` takes it from a
    process that has certainly ended, one of the same machine and namespace, and never for its age.

    Raises InputError where another run holds it, and where the folder cannot be written to.
    """
    path, holder = folder / FOLDER / FILE, folder / FOLDER / HOLDER
    lock = FileLock(path, timeout=0.5)  # s, in which a run that is just ending may let go
    with writing(folder):
        try:
            with warnings.catch_warnings(action="ignore"):  # of drives without locks
                lock.acquire()
            write_text(holder, f"process {os.getpid()} on {socket.gethostname()}")
        except Timeout:
            known = "another run"
            with suppress(OSError):
                if holder.is_file():  # a pipe in its place would be waited for
                    text = holder.read_text("utf-8", "replace")
                    known = clean(f"the run of {text}", NAME)
            found = f"{known}: wait until it has ended, or choose another folder with -o"
            if isinstance(lock, SoftFileLock):  # which it has become on a drive without locks
                found += f"; if it was killed, remove '{path}', as this drive has no locks"
            raise InputError(Fault(str(folder), "folder", "no other run in it", found)) from None
        except OSError:
            lock.release()
            raise
    try:
        yield
    finally:
        with suppress(OSError):  # the folder may have been taken away
            holder.unlink()
        lock.release()


@dataclass
class Run(Executor):
    """Has a backend carry out tasks, keeps results in a store, and counts the costs of all."""

    store: Store | None = None
    progress: Progress = field(default_factory=Progress)
    backend: Workers = field(default_factory=Workers)
    costs: dict[tuple[Key, Key], Costs] = field(default_factory=dict)

    def expect(self, stages: Mapping[str, Count]) -> None:
        """Note the number of tasks of each stage that are still to come, from and to."""
        self.progress.expect(stages)

    def run(self, tasks: Sequence[Task[R]], /) -> list[R]:
        """Return the results of the tasks, kept ones where there are any.

        Raises ValueError for a key that another task of the run had.
        """
        names, results = Counter(task.identity for task in tasks), dict[tuple[Key, Key], R]()
        for task in tasks:
            if names[task.identity] > 1 or task.identity in self.costs:
                raise ValueError(f"two tasks are named {task.name}")
        for task in tasks:
            if self.store and (kept := self.store.read(task)):
                self.progress.start(task.stage)
                results[task.identity], self.costs[task.identity] = kept
                self.progress.end(task.stage, None)
        left = [task for task in tasks if task.identity not in results]
        for position, done in self.backend.compute(left, self.progress.start):
            task = left[position]
            results[task.identity], self.costs[task.identity] = done.result, done.costs
            self.progress.spent.add(done.costs)
            if self.store:
                self.store.write(task, done.result, done.costs, done.seconds)
            self.progress.end(task.stage, done.seconds)
        return [results[task.identity] for task in tasks]

    def total(self, chosen: Callable[[str], bool] = lambda _: True) -> Costs:
        """Return the costs of the tasks of the chosen stages."""
        out = Costs()
        for costs in (costs for (key, _), costs in self.costs.items() if chosen(str(key[0]))):
            out.add(costs)
        return out
