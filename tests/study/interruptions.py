"""Runs that are interrupted when a piece of work is to be written."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from modefront.study import store


def interrupt(monkeypatch: pytest.MonkeyPatch, when: Callable[[Path, int], bool]) -> None:
    """Interrupt the next run, once, before the piece of which ``when`` is true.

    It is asked with the path of the piece and the number of those that have been written.
    """
    write = store.write_piece
    written = 0

    def stop(path: Path, *rest: Any) -> None:
        nonlocal written
        if when(path, written):
            monkeypatch.setattr(store, "write_piece", write)
            raise KeyboardInterrupt
        written += 1
        write(path, *rest)

    monkeypatch.setattr(store, "write_piece", stop)


def interrupt_after(pieces: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Interrupt the next run when so many pieces have been written."""
    interrupt(monkeypatch, lambda path, written: written == pieces)


def interrupt_at(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Interrupt the next run when it comes to write a piece with this in its name."""
    interrupt(monkeypatch, lambda path, written: name in path.name)
