"""Readers of other packages in a process of their own, with limits on time and memory.

It imports what readers need once, and reads one file after another; where one ends it or fails, the
next has another process. Nothing that comes back is unpickled.
"""

import atexit
import importlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

from modefront.errors import Fault, InputError, reason, refuse, refusing
from modefront.inputs import available_memory
from modefront.outputs import output
from modefront.text import one_line
from modefront.work.codec import dump, load, record

LEAST_SECONDS, SPEED = 60.0, 10**6
"""Time that reading may take, and bytes that are read a second at least besides: chosen against
readers that do not end, far above what whole files take."""

TOO_MUCH = "a file that takes more than {:.2g} GB to be read: close other programs, or divide it"
"""What is said of a file that does not fit into the memory."""

record(Fault)


# 6 arguments: what is read from which file, and the limits.
def isolated(
    function: str,
    path: Path,
    expected: str,
    seconds: float | None = None,
    memory: int | None = None,
    arguments: Sequence[str] = (),
) -> Any:
    """Return what a function reads from a file in another process; `dump` says what it may be.

    ``function`` is the ``module:name`` of one that takes the path, or what the names of files begin
    with, and further texts. Limits in seconds and bytes are chosen by the size of the file and what
    is free unless given; that of memory holds where the system has such.

    Raises InputError where the function raises it, and where it fails, takes too long or ends its
    process: the file is not the ``expected`` one then.
    """
    if seconds is None:
        with suppress(OSError):  # all files that belong to one by their names
            files = [x for x in path.parent.iterdir() if x.name.startswith(path.stem)]
            seconds = LEAST_SECONDS + sum(x.stat().st_size for x in files if x.is_file()) / SPEED
    seconds, memory = seconds or LEAST_SECONDS, memory or available_memory()
    with refusing(path, expected):
        if _INSIDE:
            return _called(function, path, arguments)
        with tempfile.TemporaryDirectory(prefix="modefront-") as folder:
            answer = Path(folder) / "answer.npz"
            request = [function, [str(path), *arguments], str(answer), memory, str(Path.cwd())]
            _server(os.getpid()).answer(request, seconds, memory)
            with answer.open("rb") as stream:
                faults, found = load(stream)
            refuse(faults)
            return found


_INSIDE = False  # whether this is a process that reads a file, so that no other one is needed


def _called(function: str, path: Path, arguments: Sequence[str]) -> Any:
    module, name = function.split(":")
    try:
        return getattr(importlib.import_module(module), name)(path, *arguments)
    except (InputError, MemoryError):
        raise
    except (Exception, SystemExit) as error:  # what readers raise is not documented
        cause: BaseException | None = error
        while cause := cause and (cause.__cause__ or cause.__context__):
            if isinstance(cause, MemoryError):
                raise cause from None
        raise RuntimeError(one_line(reason(error), 400)) from None


class _Server:
    """The process that reads files for this one; it is started when the first file is read."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[str] | None = None
        self._lock = threading.Lock()

    def answer(self, request: Sequence[object], seconds: float, memory: int) -> None:
        """Have a file read.

        Raises RuntimeError where that fails, the process ends, or it does not answer in time.
        """
        with self._lock:
            process, late = self._started(), time.monotonic() + seconds
            timer, line = threading.Timer(seconds, _kill, [process]), ""
            timer.start()
            try:
                assert process.stdin is not None
                assert process.stdout is not None
                with suppress(BrokenPipeError):  # it has ended, and says so below
                    process.stdin.write(json.dumps(request) + "\n")
                    process.stdin.flush()
                if line := process.stdout.readline():
                    if error := json.loads(line):
                        line = ""  # what failed may hold much: the next file has another process
                        raise RuntimeError(error)
                    return
                status = process.wait()
            finally:
                timer.cancel()
                if not line:  # it has ended or failed, or there was an interrupt
                    self.end()
        if time.monotonic() > late:
            raise RuntimeError(f"nothing within {seconds:.0f} s, after which reading was given up")
        if status == -getattr(signal, "SIGKILL", 0):  # by the system, which has no more
            raise RuntimeError(TOO_MUCH.format(memory / 1e9))
        raise RuntimeError(f"a file that ends its reader (signal {abs(status)})")

    def end(self) -> None:
        """End the process, with what it has started."""
        process, self._process = self._process, None
        if process is not None:
            _kill(process)
            with suppress(BrokenPipeError):
                process.communicate()

    def _started(self) -> subprocess.Popen[str]:
        if self._process is not None and self._process.poll() is None:
            return self._process
        self.end()
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
        environment |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "PYTHONUTF8": "1"}
        self._process = subprocess.Popen(
            # -P: nothing is imported from the folder that the user works in
            [sys.executable, "-P", "-c", "from modefront.work.isolated import serve; serve()"],
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            start_new_session=True,  # interrupts of the terminal are for this process
        )
        return self._process


@cache
def _server(_: int) -> _Server:
    """Return the server of the process with an identifier: one that is forked has its own."""
    return _Server()


atexit.register(lambda: _server(os.getpid()).end())


def _kill(process: subprocess.Popen[str]) -> None:
    if hasattr(os, "killpg"):
        with suppress(OSError):
            os.killpg(process.pid, signal.SIGKILL)
    process.kill()


def serve() -> None:
    """Read files, one request a line, until there are no more; what is printed goes nowhere."""
    global _INSIDE
    _INSIDE = True
    nowhere, answers = os.open(os.devnull, os.O_WRONLY), os.dup(1)
    for number in (1, 2):
        os.dup2(nowhere, number)
    for line in sys.stdin:
        function, (path, *arguments), answer, memory, work = json.loads(line)
        error = ""
        found: tuple[Sequence[Fault], object]  # what is wrong with the file, and what it holds
        try:
            importlib.import_module(function.split(":")[0])
            os.chdir(work)
            limit(memory)
            try:
                found = (), _called(function, Path(path), arguments)
            except InputError as wrong:
                found = wrong.faults, None
            with output(Path(answer)) as stream:
                dump(found, stream)
        except MemoryError:
            error = TOO_MUCH.format(memory / 1e9)
        except Exception as failed:
            error = reason(failed)
        os.write(answers, f"{json.dumps(error)}\n".encode())


def limit(memory: int) -> None:
    """Limit what this process takes besides, where the system can, and write no core file."""
    try:
        import resource
    except ImportError:  # Windows
        return
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if sys.platform == "linux":  # others count memory that is not taken
        hard = resource.getrlimit(resource.RLIMIT_AS)[1]
        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
        most = memory + pages * resource.getpagesize()  # readers that are imported take much
        most = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.setrlimit(resource.RLIMIT_AS, (most, hard))
