"""Checks of completeness that the readers of all formats share.

What a file declares is compared with what it holds; what has a key is there once; and lines of
numbers are whole to the end of the last one. A row that nothing declares, such as the line of a
frequency, can be missing without a trace.
"""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterable
from pathlib import Path

import numpy as np

from modefront._typing import Ints
from modefront.errors import Fault, InputError

NUMBER = re.compile(r"[+-]?0*([0-9]*)(?:[.,]([0-9]*))?(?:[eE]([+-]?[0-9]*))?")
"""Digits of a number before and behind its point, and its exponent."""

ENDED = "whole lines to the end"


def counted(file: object, place: str, what: str, declared: int, found: float) -> None:
    """Raise InputError where a file holds another number of things than it declares."""
    if declared != found:
        expected = f"{declared} {what}, as its header says"
        raise InputError(Fault(str(file), place, expected, f"{found:.12g}"))


def once(file: object, place: str, what: str, keys: Iterable[Hashable]) -> None:
    """Raise InputError where a key comes again."""
    seen: set[Hashable] = set()
    for key in keys:
        if key in seen:
            raise InputError(Fault(str(file), place, f"{what} once", f"{key} again"))
        seen.add(key)


def first_repeated(row: Ints, column: Ints, columns: int) -> int | None:
    """Return the position of an entry of a matrix that is there already; None without one."""
    keys = row.astype(np.int64) * columns + column
    order = np.argsort(keys, kind="stable")
    again = np.flatnonzero(np.diff(keys[order]) == 0)
    return int(order[again[0] + 1]) if again.size else None


def ended(path: Path) -> None:
    """Raise InputError where a file of lines of numbers does not end with the end of a line."""
    if _last(path) not in b"\r\n":
        raise InputError(Fault(str(path), "last line", ENDED, "a file that is cut off"))


def _last(path: Path) -> bytes:
    """Return the last byte of a file; nothing of an empty one."""
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
        raise InputError(Fault(str(path), "last line", expected, found))


def _lengths(text: str) -> tuple[int, int, int]:
    """Return how many digits a number has in all, behind the point, and in its exponent."""
    match = NUMBER.match(text.strip())
    whole, behind, exponent = (part or "" for part in match.groups()) if match else ("", "", "")
    return len((whole + behind).lstrip("0")), len(behind), len(exponent)
