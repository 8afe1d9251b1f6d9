"""A lock on a folder of results, so that two runs do not work in it at once.

The lock is a file that one run makes and removes. It names the machine and the process, so that
one which a process left that ended without removing it is seen as such. On another machine, which
shares the folder by a network drive, processes cannot be looked at: there the lock is renewed
while the run goes on, and is stale when it was not renewed for long.
"""

from __future__ import annotations

import json
import os
import socket
import sys
import threading
import time
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from modefront.errors import Fault, InputError, reason
from modefront.text import NAME, clean

FILE = "running.lock"

RENEWED = 20.0
"""Seconds between renewals."""

STALE = 15 * RENEWED
"""Seconds without renewal after which the lock of another machine is stale."""

ATTEMPTS = 5
"""Attempts to take a lock that others take and leave at the same time."""

LONGEST = 4096
"""Bytes of a lock file, at most."""


@dataclass(frozen=True)
class Owner:
    """Who holds a lock: machine, process and when that began, and a name that nobody else has."""

    host: str
    process: int
    began: str
    token: str


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold the lock of a folder while a run works in it.

    Raises InputError where another run holds it, and where the folder cannot be written to.
    """
    path, process = folder / FILE, this_process()
    _take(path, process)
    stop = threading.Event()
    renewal = threading.Thread(target=_renew, args=(path, stop), daemon=True)
    renewal.start()
    try:
        yield
    finally:
        stop.set()
        renewal.join()
        if _owner(path) == process:
            with suppress(OSError):  # the folder may have been taken away
                path.unlink()


def this_process() -> Owner:
    """Return this process as the owner of a lock."""
    process = os.getpid()
    return Owner(socket.gethostname(), process, began(process), uuid.uuid4().hex)


def began(process: int) -> str:
    """Return when a process began, in the units of the system; empty where that is not known."""
    try:
        text = Path(f"/proc/{process}/stat").read_text(encoding="ascii", errors="replace")
    except OSError:
        return ""
    return text.rpartition(")")[2].split()[19]


def _take(path: Path, process: Owner) -> None:
    """Make the lock file; one that is stale is renamed before, which only one run can do."""
    for _ in range(ATTEMPTS):
        try:
            _make(path, process)
            return
        except FileExistsError:
            pass
        except OSError as error:
            fault = Fault(
                str(path.parent), "folder", "a folder that can be written to", reason(error)
            )
            raise InputError(fault) from None
        other = _owner(path)
        if not _stale(path, other):
            break
        aside = path.with_name(f"{path.name}.{process.token}")
        with suppress(OSError):
            path.rename(aside)
            aside.unlink()
    raise InputError(Fault(str(path.parent), "folder", "no other run in it", _words(path, other)))


def _make(path: Path, process: Owner) -> None:
    """Write the lock file where there is none, whole; raises FileExistsError where there is one."""
    part = path.with_name(f"{path.name}.{process.token}.tmp")
    part.write_text(json.dumps(vars(process)), encoding="utf-8")
    try:
        try:
            os.link(part, path)  # exclusive, and whole, on network drives as well
        except FileExistsError:
            raise
        except OSError:  # drives without hard links
            with path.open("x", encoding="utf-8") as stream:
                stream.write(json.dumps(vars(process)))
    finally:
        part.unlink(missing_ok=True)


def _owner(path: Path) -> Owner | None:
    """Return who holds a lock; None where the file does not say, or is not there."""
    try:
        if not path.is_file() or path.stat().st_size > LONGEST:
            return None
        owner = Owner(**json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError, TypeError):
        return None
    return owner if isinstance(owner.process, int) else None


def _stale(path: Path, owner: Owner | None) -> bool:
    """Return whether a lock was left by a run that has ended."""
    try:
        age = time.time() - path.stat().st_mtime
    except OSError:
        return True  # it is gone
    if owner is None:  # torn, or just being written
        return age > RENEWED
    if owner.host != socket.gethostname():
        return age > STALE
    return not _lives(owner) or (owner.began == "" and age > STALE)


def _lives(owner: Owner) -> bool:
    """Return whether a process of this machine is the one that made a lock."""
    if owner.process <= 0:
        return False
    if owner.began:
        return began(owner.process) == owner.began
    if sys.platform == "win32":  # a signal would end the process there
        return True
    try:
        os.kill(owner.process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return True


def _words(path: Path, owner: Owner | None) -> str:
    """Return who works in a folder, and what to do."""
    then = f"wait until it has ended, or choose another folder with -o ({path.name} is its lock)"
    if owner is None:
        return f"another run: {then}"
    where = "" if owner.host == socket.gethostname() else f" on {clean(owner.host, NAME)}"
    return f"the run of process {owner.process}{where}: {then}"


def _renew(path: Path, stop: threading.Event) -> None:
    """Renew a lock until the run has ended."""
    while not stop.wait(RENEWED):
        with suppress(OSError):
            os.utime(path)
