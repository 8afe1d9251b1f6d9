"""Notes on the steps inside a long task: a search, a generation.

`note` tells the listener of the same thread or process, if there is one; a task is never slower or
different for it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

ITERATION = "iteration "
"""What a note begins with that is a detail of the one before it."""

Listener = Callable[[str], None]


def _ignore(_: str) -> None:
    """Ignore a note."""


_LISTENER: ContextVar[Listener] = ContextVar("listener", default=_ignore)


def note(text: str) -> None:
    """Tell the listener the present step of the running task."""
    _LISTENER.get()(text)


def note_iteration(number: int) -> None:
    """Tell the listener which iteration the search at work has come to."""
    note(f"{ITERATION}{number}")


@contextmanager
def listening(listener: Listener) -> Iterator[None]:
    """Send notes to a listener until the context ends."""
    before = _LISTENER.set(listener)
    try:
        yield
    finally:
        _LISTENER.reset(before)
