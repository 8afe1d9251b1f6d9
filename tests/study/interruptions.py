"""Runs that are interrupted when the result of a task is to be kept."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from modefront.work.store import Store
from modefront.work.task import Task


def interrupt(monkeypatch: pytest.MonkeyPatch, when: Callable[[Task[Any], int], bool]) -> None:
    """Interrupt the next run, once, before the result of which ``when`` is true is kept.

    It is asked with the task and the number of results that have been kept.
    """
    write = Store.write
    written = 0

    def stop(store: Store, task: Task[Any], *rest: Any) -> None:
        nonlocal written
        if when(task, written):
            monkeypatch.setattr(Store, "write", write)
            raise KeyboardInterrupt
        written += 1
        write(store, task, *rest)

    monkeypatch.setattr(Store, "write", stop)


def interrupt_after(tasks: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Interrupt the next run when the results of so many tasks have been kept."""
    interrupt(monkeypatch, lambda _, written: written == tasks)


def interrupt_at(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Interrupt the next run when it comes to keep the result of a task with this in its name."""
    interrupt(monkeypatch, lambda task, _: name in task.name)
