"""What can be wrong with an input, and how it is said."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Fault:
    """One thing that is wrong: the file, the place in it, what was expected, what was found."""

    file: str
    place: str
    expected: str
    found: str

    def __str__(self) -> str:
        return f"{self.file}: {self.place}: expected {self.expected}, found {self.found}"


class InputError(ValueError):
    """The input is wrong; carries every fault that was found, not only the first."""

    def __init__(self, faults: Fault | Iterable[Fault]) -> None:
        self.faults = (faults,) if isinstance(faults, Fault) else tuple(faults)
        super().__init__("\n".join(map(str, self.faults)))


class ModelError(ValueError):
    """A model cannot be evaluated at the given parameters."""


class UnfinishedError(RuntimeError):
    """The work could not be done; what was found before is kept."""


def suggestion(name: str, known: Iterable[str]) -> str:
    """Return ``'name'`` with the known name that it resembles, for a message."""
    close = difflib.get_close_matches(name, list(known), n=1, cutoff=0.5)
    return f"{name!r}" + (f" (did you mean '{close[0]}'?)" if close else "")
