"""A lock on a folder of results, so that two runs do not work in it at once.

It is the operating system's lock on a file, which ends with the process that holds it, however that
ends. On drives without such locks the file itself is the lock; `filelock` takes it from a process
that has certainly ended, one of the same machine and namespace, and never for its age.
"""

from __future__ import annotations

import os
import socket
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from filelock import FileLock, SoftFileLock, Timeout

from modefront.errors import Fault, InputError, reason
from modefront.outputs import write_text
from modefront.text import NAME, clean
from modefront.work.store import FOLDER

FILE = "lock"
"""File that is locked; it stays, since a lock on a file that is removed keeps nobody out."""

HOLDER = "lock-holder"
"""File that says which process holds the lock."""

PATIENCE = 0.5
"""Seconds in which a run that is just ending may still let go."""

LONGEST = 400
"""Bytes that say who holds a lock, at most."""


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold the lock of a folder of results while a run works in it; its tasks have a folder.

    Raises InputError where another run holds it, and where the folder cannot be written to.
    """
    path, holder = folder / FOLDER / FILE, folder / FOLDER / HOLDER
    lock = FileLock(path, timeout=PATIENCE)
    try:
        with warnings.catch_warnings(action="ignore"):  # of drives without locks
            lock.acquire()
        write_text(holder, f"process {os.getpid()} on {socket.gethostname()}")
    except Timeout:
        found = f"{_run(holder)}: wait until it has ended, or choose another folder with -o"
        if isinstance(lock, SoftFileLock):
            found += f"; if it was killed, remove '{path}', as this drive has no locks"
        raise InputError(Fault(str(folder), "folder", "no other run in it", found)) from None
    except OSError as error:
        lock.release()
        expected = "a folder that can be written to"
        raise InputError(Fault(str(folder), "folder", expected, reason(error))) from None
    try:
        yield
    finally:
        with suppress(OSError):  # the folder may have been taken away
            holder.unlink()
        lock.release()


def _run(holder: Path) -> str:
    """Return which run holds a lock."""
    try:
        if holder.is_file():  # a pipe in its place would be waited for
            with holder.open("rb") as stream:
                return clean(f"the run of {stream.read(LONGEST).decode('utf-8', 'replace')}", NAME)
    except OSError:
        pass
    return "another run"
