"""Readers of other packages in processes of their own, with limits on time and memory.

A reader that ends its process, runs without an end, or takes all memory takes only this process
with it. What it has read comes back as plain arrays and texts in a file that is not unpickled.

A server is started with the first file: it imports what readers need once, and has each file read
by a fork of itself. Where the system has no forks, it reads one file and ends.
"""

from __future__ import annotations

import atexit
import importlib
import json
import os
import queue
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import astuple
from pathlib import Path
from typing import Any

import numpy as np

from modefront.errors import Fault, InputError, reason
from modefront.inputs import available_memory
from modefront.outputs import output, write_text
from modefront.text import one_line

MOST_OUTPUT = 20_000
"""Bytes of what a process prints that are looked at."""

LEAST_SECONDS, SPEED = 60.0, 10**6
"""Time that reading may take, and bytes that are read a second at least besides: chosen against
readers that do not end, far above what whole files take."""

GRACE = 30.0
"""Seconds that a server may take to start and to answer, besides the time for reading."""

CRASHED = 255
"""Exit status above which a process was ended by the system, on Windows."""

ARRAYS, TEXTS, OUTPUT = "arrays.npz", "texts.json", "output.txt"

REFUSED = 2
"""Exit status of a reader that raised InputError, whose faults are the texts."""

Read = tuple[dict[str, np.ndarray[Any, Any]], Any]
"""Arrays by name, and texts and numbers as JSON has them."""


class IsolatedError(RuntimeError):
    """A reader failed, took too long, or ended its process; the message says which."""


def isolated(
    function: str,
    path: Path,
    seconds: float | None = None,
    memory: int | None = None,
    arguments: Sequence[str] = (),
) -> Read:
    """Return the arrays and texts that a function reads from a file in another process.

    Parameters
    ----------
    function
        ``module:name`` of a function that takes the path and returns `Read`.
    path
        The file, or what its name begins with.
    seconds, memory
        Limits, by the size of the file and what is free unless given; that of memory, in bytes,
        holds where the system has such limits.
    arguments
        Further texts that the function takes.

    Raises
    ------
    IsolatedError
        Where nothing was read.
    InputError
        Where the function raises it.
    """
    if _INSIDE:
        return _called(function, path, arguments)
    seconds = seconds or LEAST_SECONDS + _size(path) / SPEED
    memory = memory or available_memory()
    with tempfile.TemporaryDirectory(prefix="modefront-") as name:
        folder = Path(name)
        called = [str(path), *arguments]
        status = _SERVER.status([function, called, name, seconds, memory, str(Path.cwd())], seconds)
        printed = ""
        with suppress(OSError), (folder / OUTPUT).open("rb") as stream:
            printed = stream.read(MOST_OUTPUT).decode("utf-8", "replace")
        if status is None or status == -getattr(signal, "SIGALRM", 0):
            text = f"nothing within {seconds:.0f} s, after which reading was given up"
            raise IsolatedError(text)
        if status < 0 or status > CRASHED:
            raise IsolatedError(f"a file that ends its reader (signal {abs(status)})")
        if status == REFUSED:
            texts = json.loads((folder / TEXTS).read_text(encoding="ascii"))
            raise InputError(Fault(*parts) for parts in texts)
        if status:
            raise IsolatedError(one_line(printed, 400) or f"status {status} of the reader")
        try:
            with np.load(folder / ARRAYS, allow_pickle=False) as file:
                arrays = {each: file[each] for each in file.files}
            return arrays, json.loads((folder / TEXTS).read_text(encoding="ascii"))
        except (OSError, ValueError) as error:
            raise IsolatedError(f"nothing that can be used: {reason(error)}") from None


_INSIDE = False
"""Whether this is a process that reads a file, so that no other one is needed."""


def _called(function: str, path: Path, arguments: Sequence[str]) -> Read:
    """Return what a function reads in this process."""
    module, name = function.split(":")
    try:
        found: Read = getattr(importlib.import_module(module), name)(path, *arguments)
    except (InputError, MemoryError):
        raise
    except (Exception, SystemExit) as error:  # what readers raise is not documented
        raise IsolatedError(one_line(reason(error), 400) or type(error).__name__) from None
    return found


def _size(path: Path) -> int:
    """Return the bytes of all files that belong to one by their names."""
    try:
        files = [each for each in path.parent.iterdir() if each.name.startswith(path.stem)]
        return sum(each.stat().st_size for each in files if each.is_file())
    except OSError:
        return 0


class _Server:
    """The process that reads files for this one; it is started when the first file is read."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[str] | None = None
        self._owner = 0
        self._lock = threading.Lock()

    def status(self, request: Sequence[object], seconds: float) -> int | None:
        """Return how the reading of a file has ended; None where it has not."""
        with self._lock:
            process = self._started()
            assert process.stdin is not None
            try:
                with suppress(BrokenPipeError):  # it has ended, and says so below
                    process.stdin.write(json.dumps(request) + "\n")
                    process.stdin.flush()
                line = _line(process, seconds + GRACE)
            except BaseException:  # an interrupt
                self.end()
                raise
            if line is None:
                self.end()
                return None
            if line:
                return int(line)
            code = process.wait()
            self.end()
            return code

    def end(self) -> None:
        """End the process, with what it has started, if this process owns it."""
        process, self._process = self._process, None
        if process is None or self._owner != os.getpid():
            return
        if hasattr(os, "killpg"):
            with suppress(OSError):
                os.killpg(process.pid, signal.SIGKILL)
        process.kill()
        with suppress(BrokenPipeError):
            process.communicate()

    def _started(self) -> subprocess.Popen[str]:
        if self._process is not None and self._owner == os.getpid():
            if self._process.poll() is None:
                return self._process
            self.end()
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
        environment |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "PYTHONUTF8": "1"}
        self._process = subprocess.Popen(
            # -P: nothing is imported from the folder that the user works in
            [sys.executable, "-P", "-c", "from modefront.isolated import serve; serve()"],
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            start_new_session=True,  # interrupts of the terminal are for this process
        )
        self._owner = os.getpid()
        return self._process


_SERVER = _Server()
atexit.register(_SERVER.end)


def _line(process: subprocess.Popen[str], seconds: float) -> str | None:
    """Return the next line that a process prints, empty where it ends; None after some time."""
    assert process.stdout is not None
    lines: queue.Queue[str] = queue.Queue()
    read: Callable[[], str] = process.stdout.readline
    threading.Thread(target=lambda: lines.put(read()), daemon=True).start()
    try:
        return lines.get(timeout=seconds)
    except queue.Empty:
        return None


def serve() -> None:
    """Have files read, one request a line, until there are no more."""
    for line in sys.stdin:
        function, called, folder, seconds, memory, work = json.loads(line)
        if not hasattr(os, "fork"):
            status = _read(function, called, folder, memory, work)
            print(status, flush=True)
            return
        with suppress(Exception):  # what fails fails again, and is said, below
            importlib.import_module(function.split(":")[0])
        child = os.fork()
        if not child:
            signal.setitimer(signal.ITIMER_REAL, seconds)
            os._exit(_read(function, called, folder, memory, work))
        print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)


def _read(function: str, called: Sequence[str], folder: str, memory: int, work: str) -> int:
    """Read one file into a folder, and return the exit status; what is printed goes there."""
    global _INSIDE
    _INSIDE = True
    printed = os.open(Path(folder) / OUTPUT, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    answers = os.dup(1)
    for number in (1, 2):
        os.dup2(printed, number)
    path, *arguments = called
    message, status = "", 0
    try:
        os.chdir(work)
        limit(memory)
        arrays, texts = _called(function, Path(path), arguments)
        named: Mapping[str, Any] = arrays
        with output(Path(folder) / ARRAYS) as stream:
            np.savez(stream, allow_pickle=False, **named)
        write_text(Path(folder) / TEXTS, json.dumps(texts))
    except InputError as error:
        write_text(Path(folder) / TEXTS, json.dumps([astuple(fault) for fault in error.faults]))
        status = REFUSED
    except MemoryError:
        message = f"a file that takes more than {memory / 1e9:.2g} GB to be read"
    except Exception as error:
        message = str(error) or type(error).__name__
    sys.stdout.flush()
    if message:
        os.ftruncate(printed, 0)
        os.lseek(printed, 0, os.SEEK_SET)
        os.write(printed, message.encode("utf-8", "replace"))
    os.dup2(answers, 1)
    return 1 if message else status


def limit(memory: int) -> None:
    """Limit the memory of this process, where the system can, and write no core file."""
    try:
        import resource
    except ImportError:  # Windows
        return
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if sys.platform == "linux":  # others count memory that is not taken
        hard = resource.getrlimit(resource.RLIMIT_AS)[1]
        most = memory if hard == resource.RLIM_INFINITY else min(memory, hard)
        resource.setrlimit(resource.RLIMIT_AS, (most, most))
