"""Files that are read: regular ones, whole, of a size that their kind can have."""

import os
import re
import stat
from collections import Counter
from collections.abc import Hashable, Iterable
from pathlib import Path

import numpy as np

from modefront._typing import Ints
from modefront.errors import Fault, InputError, reason

MEGABYTE = 10**6

MOST_DATA, MOST_TABLES = 2000 * MEGABYTE, 64 * MEGABYTE
"""Bytes of a file of data, and of a TOML file: chosen against files that fill the memory."""

KINDS = {
    stat.S_IFDIR: "a folder",
    stat.S_IFIFO: "a pipe",
    stat.S_IFSOCK: "a socket",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
}
"""Names of the kinds of files that are not regular."""


def file_size(path: Path, expected: str, most: int | None = None) -> int:
    """Return the size of a regular file, ``most`` or less, in bytes; links are followed.

    ``expected`` says what it should be. Raises InputError where there is no such file, where it is
    a folder, a pipe or a device, and where it is empty or too large.
    """
    try:
        status = path.stat()
    except (FileNotFoundError, NotADirectoryError):
        raise wrong(path, expected, "no such file") from None
    except (OSError, ValueError) as error:  # ValueError where the name holds a null
        raise wrong(path, expected, reason(error)) from None
    if kind := KINDS.get(stat.S_IFMT(status.st_mode)):
        inside = sorted(x.name for x in path.glob("*.toml"))[:3]
        raise wrong(path, expected, f"{kind} with {', '.join(inside)}" if inside else kind)
    if not status.st_size:
        raise wrong(path, expected, "an empty file")
    if most is not None and status.st_size > most:
        limit = f"{expected} of up to {most / MEGABYTE:g} MB"
        raise wrong(path, limit, f"{status.st_size / MEGABYTE:.6g} MB")
    return status.st_size


def read_text_bytes(path: Path, expected: str, most: int) -> bytes:
    """Return the content of a regular file.

    Raises InputError as `file_size` does, and where the file cannot be read.
    """
    file_size(path, expected, most)
    try:
        return path.read_bytes()
    except (OSError, MemoryError) as error:
        raise wrong(path, expected, reason(error)) from None


def available_memory() -> int:
    """Return the memory in bytes that may be taken, 8 GB where the system does not say."""
    memory = 8 * 10**9
    try:
        with Path("/proc/meminfo").open(encoding="ascii") as stream:
            for line in stream:
                if line.startswith("MemAvailable:"):
                    memory = int(line.split()[1]) * 1024
        limit = Path("/sys/fs/cgroup/memory.max")
        if limit.is_file() and (text := limit.read_text(encoding="ascii").strip()).isdigit():
            used = int(Path("/sys/fs/cgroup/memory.current").read_text(encoding="ascii"))
            memory = min(memory, max(int(text) - used, 0))
    except (OSError, ValueError):
        if hasattr(os, "sysconf") and "SC_PHYS_PAGES" in os.sysconf_names:
            memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // 2
    return memory


def wrong(path: Path, expected: str, found: str, place: str = "file") -> InputError:
    """Return the error of a file, or of a place in it."""
    return InputError(Fault(str(path), place, expected, found))


NUMBER = re.compile(r"[+-]?0*([0-9]*)(?:[.,]([0-9]*))?(?:[eE]([+-]?[0-9]*))?")
"""Digits of a number before and behind its point, and its exponent."""

BARE = re.compile(r"(?<=[0-9.])([+-][0-9]+)$")
"""An exponent without its letter, as Fortran writes it where three digits leave no room."""

ENDED = "whole lines to the end"


def fortran(text: str) -> float:
    """Return a number as Fortran writes it; raises ValueError for anything else.

    >>> [fortran(text) for text in (" 1.5", "1.5+3", "1.5D3", "-1.00000-100")]
    [1.5, 1500.0, 1500.0, -1e-100]
    """
    return float(BARE.sub(r"E\1", text.strip().upper().replace("D", "E")))


def counted(file: object, place: str, what: str, declared: int, found: float) -> None:
    """Raise InputError where a file holds another number of things than it declares."""
    if declared != found:
        expected = f"{declared} {what}, as its header says"
        raise InputError(Fault(str(file), place, expected, f"{found:.12g}"))


def once(file: object, place: str, what: str, keys: Iterable[Hashable]) -> None:
    """Raise InputError where a key comes again."""
    for key, count in Counter(keys).items():
        if count > 1:
            raise InputError(Fault(str(file), place, f"{what} once", f"{key} again"))


def first_repeated(row: Ints, column: Ints, columns: int) -> int | None:
    """Return the position of an entry of a matrix that is there already; None without one."""
    keys = row.astype(np.int64) * columns + column
    order = np.argsort(keys, kind="stable")
    again = np.flatnonzero(np.diff(keys[order]) == 0)
    return int(order[again[0] + 1]) if again.size else None


def ended(path: Path) -> None:
    """Raise InputError where a file of lines of numbers does not end with the end of a line."""
    if _last(path) not in b"\r\n":
        raise wrong(path, ENDED, "a file that is cut off", "last line")


def _last(path: Path) -> bytes:
    with path.open("rb") as stream:
        stream.seek(-min(1, stream.seek(0, 2)), 2)
        return stream.read(1)


def ended_column(path: Path, column: Iterable[str]) -> None:
    """Raise InputError where the last number of a table may be cut off.

    Some spreadsheets write no end of the last line. Then the number has to be as long as the others
    in its column, of which there has to be one: in its exponent, and in its digits, those behind
    the point where all have as many of these, or else those that are significant.
    """
    if not _last(path).strip() or not (texts := list(column)):
        return
    *others, last = map(_lengths, texts)
    alike = list(map(set, zip(*others, strict=True)))
    k = 1 if others and len(alike[1]) == 1 < len(alike[0]) else 0  # behind the point, or in all
    if not others or last[k] < max(alike[k]) or last[2] < max(alike[2]):
        found = f"{texts[-1].strip()!r} without the end of its line: is the file cut off?"
        expected = f"{ENDED}, or a last number with as many digits as the others in its column"
        raise wrong(path, expected, found, "last line")


def _lengths(text: str) -> tuple[int, int, int]:
    """Return how many digits a number has in all, behind the point, and in its exponent."""
    match = NUMBER.match(text.strip())
    whole, behind, exponent = (part or "" for part in match.groups()) if match else ("", "", "")
    return len((whole + behind).lstrip("0")), len(behind), len(exponent)
