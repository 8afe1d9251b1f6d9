"""Faults of inputs, and the errors that carry them."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Fault:
    """One thing that is wrong: the file, the place in it, what was expected, what was found.

    The file is empty where an option was given in Python; the place is the option's name then.
    """

    file: str
    place: str
    expected: str
    found: str

    def __str__(self) -> str:
        where = "".join(f"{part}: " for part in (self.file, self.place) if part)
        return f"{where}expected {self.expected}, found {self.found}"


class InputError(ValueError):
    """The input, a file or an option in Python, is wrong; carries every fault that was found."""

    def __init__(self, faults: Fault | Iterable[Fault]) -> None:
        self.faults = (faults,) if isinstance(faults, Fault) else tuple(faults)
        super().__init__("\n".join(map(str, self.faults)))

    def __reduce__(self) -> tuple[type[InputError], tuple[tuple[Fault, ...]]]:
        """Return how the error is made again, in another process."""
        return type(self), (self.faults,)


def wrong(option: str, expected: str, found: object) -> InputError:
    """Return the error of a single option or argument that is wrong."""
    return InputError(Fault("", option, expected, str(found)))


def refuse(faults: Iterable[Fault]) -> None:
    """Raise InputError where there are faults."""
    if found := tuple(faults):
        raise InputError(found)


class ModelError(ValueError):
    """A model cannot be evaluated at the given parameters."""


class UnfinishedError(RuntimeError):
    """The work could not be done; what was found before is kept."""


def suggestion(name: str, known: Iterable[str]) -> str:
    """Return ``'name'`` with the known name that it resembles, for a message."""
    close = difflib.get_close_matches(name, list(known), n=1, cutoff=0.5)
    return f"{name!r}" + (f" (did you mean '{close[0]}'?)" if close else "")
