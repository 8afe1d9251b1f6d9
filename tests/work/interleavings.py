"""Runs in one folder that take turns at every call of the system, and are killed at any of them.

A run is a thread that holds the lock of the folder, works for a while and ends. Before each call
for a file it stops until it is told to go on. One that is killed makes no further call: the system
closes its files, and all else stays as it is. Each has the number of a process of its own, and a
clock that only waiting moves.
"""

from __future__ import annotations

import errno
import fcntl
import gc
import os
import sys
import threading
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from modefront.errors import InputError
from modefront.work.store import FILE, HOLDER, locked

FIRST = 2**30
"""Number of the first process; this machine has none of these."""

WORK = 3
"""Calls that the work of a run takes."""

CALLS = ("open", "link", "rename", "replace", "unlink", "remove", "lstat", "stat", "write")
"""Calls before which a run stops."""


NOTHING = os.open(os.devnull, os.O_RDONLY)
"""A file that holds no lock."""


class Killed(BaseException):
    """The run makes no further call."""


class Run(threading.Thread):
    """A run that goes on for one call at a time.

    Attributes
    ----------
    outcome : "waiting" for the lock, "working", "ending", "ended", "refused", "killed" or "failed"
    """

    def __init__(self, results: Path, number: int) -> None:
        super().__init__(daemon=True)
        self.results, self.pid, self.clock = results, FIRST + number, 0.0
        self.go, self.stopped = threading.Semaphore(0), threading.Semaphore(0)
        self.files: set[int] = set()
        self.outcome, self.error = "waiting", ""
        self.left: Killed | None = None
        self.start()
        self.stopped.acquire()

    def run(self) -> None:
        try:
            self.pause()
            with locked(self.results):
                self.outcome = "working"
                for _ in range(WORK):
                    self.pause()
                self.outcome = "ending"
            self.outcome = "ended"
        except InputError as error:
            self.outcome, self.error = "refused", str(error)
        except Killed as killed:
            self.left = killed  # with all frames, so that nothing in them is released
        except BaseException:
            self.outcome, self.error = "failed", traceback.format_exc()
        finally:
            self.stopped.release()

    @property
    def lives(self) -> bool:
        """Whether the run has not ended."""
        return self.outcome in ("waiting", "working", "ending")

    def pause(self) -> None:
        """Wait until the run is told to go on; raises Killed where it is killed."""
        self.stopped.release()
        self.go.acquire()
        if self.outcome == "killed":
            self.go.release()  # whatever it does to clean up
            raise Killed

    def step(self) -> None:
        """Go on to the next call."""
        if self.lives:
            self.go.release()
            self.stopped.acquire()

    def kill(self) -> None:
        """Kill the run where it is."""
        if self.lives:
            self.outcome = "killed"
            self.go.release()
            self.join()
            for file in self.files:  # their numbers stay taken: filelock may yet close them
                os.dup2(NOTHING, file)

    def finish(self) -> None:
        """Let the run go on to its end."""
        while self.lives:
            self.step()
        self.join()


class Machine:
    """Runs on one machine, on a drive with or without locks."""

    def __init__(self, results: Path, has_locks: bool) -> None:
        self.results, self.has_locks = results, has_locks
        self.runs: list[Run] = []
        gc.disable()  # what killed runs leave is not collected in the midst of another one
        self.patch = pytest.MonkeyPatch()
        for name in CALLS:
            self.patch.setattr(os, name, self._stopping(getattr(os, name), name == "open"))
        self.patch.setattr(os, "close", self._closing(os.close))
        self.patch.setattr(os, "getpid", self._number(os.getpid))
        self.patch.setattr(os, "kill", self._signal(os.kill))
        self.patch.setattr(fcntl, "flock", self._flock(fcntl.flock))
        for name in ("monotonic", "perf_counter"):
            call = self._own(getattr(time, name), lambda run: run.clock)
            self.patch.setattr(time, name, call)
        self.patch.setattr(time, "sleep", self._sleep(time.sleep))

    def begin(self) -> Run:
        """Begin another run."""
        self.runs.append(Run(self.results, len(self.runs)))
        return self.runs[-1]

    @property
    def working(self) -> list[Run]:
        """Runs that work in the folder."""
        return [run for run in self.runs if run.outcome == "working"]

    def end(self) -> None:
        """Let all runs end."""
        for run in self.runs:
            run.finish()

    def close(self) -> None:
        """Put the calls back."""
        for run in self.runs:
            run.kill()
        self.runs.clear()
        self.patch.undo()
        gc.enable()
        gc.collect()

    def _stopping(self, call: Callable[..., Any], opens: bool) -> Callable[..., Any]:
        def inner(*arguments: Any, **options: Any) -> Any:
            run = threading.current_thread()
            if not isinstance(run, Run):
                return call(*arguments, **options)
            folder, name = os.path.split(str(arguments[0]))
            if folder.startswith(str(self.results)) or arguments[0] in run.files:
                run.pause()
            out = call(*arguments, **options)
            if opens and name.startswith(FILE) and not name.startswith(HOLDER):
                run.files.add(out)
            return out

        return inner

    def _closing(self, call: Callable[[int], None]) -> Callable[[int], None]:
        def inner(file: int) -> None:
            run = threading.current_thread()
            if isinstance(run, Run):
                run.files.discard(file)
            call(file)

        return inner

    def _own(self, call: Callable[[], Any], of_run: Callable[[Run], Any]) -> Callable[[], Any]:
        def inner() -> Any:
            run = threading.current_thread()
            return of_run(run) if isinstance(run, Run) else call()

        return inner

    def _number(self, call: Callable[[], int]) -> Callable[[], int]:
        def inner() -> int:
            run, asking = threading.current_thread(), sys._getframe(1).f_globals["__name__"]
            # Elsewhere filelock asks whether this process has been forked.
            named = asking in ("filelock._soft", "filelock._identity")
            return run.pid if isinstance(run, Run) and named else call()

        return inner

    def _signal(self, call: Callable[[int, int], None]) -> Callable[[int, int], None]:
        def inner(pid: int, number: int) -> None:
            if pid < FIRST:
                call(pid, number)
            elif not any(run.pid == pid and run.lives for run in self.runs):
                raise ProcessLookupError(errno.ESRCH, "No such process")

        return inner

    def _flock(self, call: Callable[..., None]) -> Callable[..., None]:
        def inner(file: int, how: int) -> None:
            run = threading.current_thread()
            if isinstance(run, Run):
                run.pause()
                if not self.has_locks:
                    raise OSError(errno.ENOSYS, os.strerror(errno.ENOSYS))
            call(file, how)

        return inner

    def _sleep(self, call: Callable[[float], None]) -> Callable[[float], None]:
        def inner(seconds: float) -> None:
            run = threading.current_thread()
            if isinstance(run, Run):
                run.clock += seconds
                run.pause()
            else:
                call(seconds)

        return inner
