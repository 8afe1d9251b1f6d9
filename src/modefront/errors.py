"""Faults of inputs, and the errors that carry them."""

import difflib
import errno
from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from modefront.text import NAME, clean, one_line, shortened

MOST_LINES, MOST_CHARACTERS = 20, 2000  # lines and characters of a message, at most

LONGEST = {"file": 300, "place": 240, "expected": 480, "found": 480}
"""Characters of each part of a fault that a message shows."""

SYSTEM = {
    errno.ENOENT: "no such file or folder",
    errno.EACCES: "no permission: change that of the file or of its folder",
    errno.ENAMETOOLONG: "a name that is too long for this drive: choose a shorter one",
    errno.ENOSPC: "no space left on the drive: free some, then run again",
    errno.EDQUOT: "no space left in the quota of the drive: free some, then run again",
    errno.EROFS: "a drive that is read-only: choose another folder",
    errno.EIO: "a failure of the drive: try again, and look after the drive",
    errno.ESTALE: "a file that the network drive has lost: try again",
    errno.EBUSY: "a file that another program holds: close that program",
    errno.ETXTBSY: "a file that another program runs: close that program",
    errno.EMFILE: "too many open files: raise the limit, ulimit -n",
    errno.ENFILE: "too many open files on this machine: close some programs",
    errno.ENOMEM: "too little memory: close other programs, or use a smaller file",
}
"""Errors of the system of which its own words do not say what to do."""


@dataclass(frozen=True)
class Fault:
    """A fault of an input: the file, the place in it, the expected and the found value.

    The file is empty where an option was given in Python; the place is the option's name then.
    """

    file: str
    place: str
    expected: str
    found: str

    def __str__(self) -> str:
        """Return the fault on one line; names may come from anywhere, and be of any length."""
        shown = {name: clean(getattr(self, name), most) for name, most in LONGEST.items()}
        where = "".join(f"{part}: " for part in (shown["file"], shown["place"]) if part)
        return f"{where}expected {shown['expected']}, found {shown['found']}"


class InputError(ValueError):
    """The input, a file or an option in Python, is wrong.

    Attributes
    ----------
    faults : everything that is wrong, each a `Fault` with the file, the place in it, and what was
        expected and found; the message has a line for each
    """

    def __init__(self, faults: Fault | Iterable[Fault]) -> None:
        self.faults = (faults,) if isinstance(faults, Fault) else tuple(faults)
        lines: list[str] = []  # as many as a message holds
        for line in map(str, self.faults[:MOST_LINES]):
            if lines and sum(map(len, lines)) + len(lines) + len(line) > MOST_CHARACTERS - 41:
                break
            lines.append(line)
        if len(lines) < len(self.faults):
            lines = lines[: MOST_LINES - 1]
            lines.append(f"and {len(self.faults) - len(lines)} more that are wrong")
        super().__init__("\n".join(lines))

    def __reduce__(self) -> "tuple[type[InputError], tuple[tuple[Fault, ...]]]":
        """Return how the error is made again, in another process."""
        return type(self), (self.faults,)


def wrong(option: str, expected: str, found: object) -> InputError:
    """Return the error of a single option or argument that is wrong."""
    return InputError(Fault("", option, expected, str(found)))


def refuse(faults: Iterable[Fault]) -> None:
    """Raise InputError where there are faults."""
    if found := tuple(faults):
        raise InputError(found)


@contextmanager
def noted(faults: list[Fault], place: str = "") -> Iterator[None]:
    """Add the faults of what is done within to others, each once and behind a place; go on."""
    try:
        yield
    except InputError as error:
        placed = (replace(x, place=f"{place} {x.place}".strip()) for x in error.faults)
        faults.extend(x for x in placed if x not in faults)


@contextmanager
def refusing(
    file: object, expected: str, *kinds: type[Exception], place: str = "file"
) -> Iterator[None]:
    """Raise InputError, with the reason, in place of errors of these kinds, or of any kind."""
    try:
        yield
    except Exception as error:
        if isinstance(error, InputError) or not isinstance(error, kinds or Exception):
            raise
        raise InputError(Fault(str(file), place, expected, reason(error))) from error


def writing(path: Path, place: str = "folder") -> AbstractContextManager[None]:
    """Raise InputError, with the reason, where a folder, or a file, cannot be written to."""
    known = "a folder that can be written to" if place == "folder" else "a file that can be written"
    return refusing(path, known, OSError, place=place)


def reason(error: BaseException) -> str:
    r"""Return why something failed, in words and on one line, with what to do where that is known.

    >>> reason(FileNotFoundError(errno.ENOENT, "No such file or directory", "K.mtx"))
    'no such file or folder'
    >>> reason(UnicodeDecodeError("utf-8", b"a\xff", 1, 2, "invalid start byte"))
    'the byte 0xff at position 1, which is not UTF-8: save the file in UTF-8'
    """
    if isinstance(error, UnicodeDecodeError):
        code = error.encoding.upper()
        byte = f"the byte {error.object[error.start]:#04x} at position {error.start}"
        return f"{byte}, which is not {code}: save the file in {code}"
    if isinstance(error, UnicodeEncodeError):
        return f"characters that {error.encoding} lacks"
    if isinstance(error, MemoryError):
        return "more than fits into the memory: close other programs, or use a smaller file"
    if isinstance(error, RecursionError):
        return "too many levels, one in another"
    if isinstance(error, IndexError):
        return "less than there has to be: is the file cut off, or another one?"
    if isinstance(error, ValueError) and "pickle" in str(error):
        return "no arrays of numbers of NumPy; objects, which could run code, are not read"
    if isinstance(error, OSError) and error.errno is not None:
        known = error.strerror or f"error {error.errno} of the system"
        return SYSTEM.get(error.errno) or one_line(known[:1].lower() + known[1:], NAME)
    return one_line(error, LONGEST["found"]) or type(error).__name__


class ModelError(ValueError):
    """A model cannot be evaluated at the given parameters, since its matrices have no modes there.

    A user's function raises it where there is no model; searches then keep away.
    """


class UnfinishedError(RuntimeError):
    """The work could not be done; the results of tasks that were done are kept."""


def suggestion(name: str, known: Iterable[str]) -> str:
    """Return ``'name'`` with the known name that it resembles, for a message."""
    if len(name) > NAME:  # comparing takes the square of the length
        return f"{shortened(name, NAME)!r}"
    close = difflib.get_close_matches(name, list(known), n=1, cutoff=0.5)
    return f"{name!r}" + (f" (did you mean '{shortened(close[0], NAME)}'?)" if close else "")
