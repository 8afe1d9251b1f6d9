"""Who does the work of a study; imported before all that takes long, so that it can start early."""

from __future__ import annotations

from contextlib import AbstractContextManager

from modefront.work.task import Backend
from modefront.work.workers import backend

WARM = "modefront.front.pareto", "modefront.analysis.front"
"""What processes import when they start: nearly all that their tasks need."""


def processes(workers: int, scheduler: str | None) -> AbstractContextManager[Backend]:
    """Return the context in which so many processes, or those of a cluster, do the work."""
    return backend(workers, scheduler, WARM)
