"""A progress bar on standard error."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
from rich.progress import Progress as Bar

from modefront.work.progress import Progress, State


@contextmanager
def progress_bar(title: str) -> Iterator[Progress]:
    """Show how many tasks are done, of how many, and the stage of the last one."""
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("{task.fields[stage]}", markup=False),
    )
    with Bar(*columns, console=Console(stderr=True)) as bar:
        task = bar.add_task(title, stage="", total=None)

        def report(state: State) -> None:
            bar.update(task, total=state.expected, completed=state.done, stage=state.stage)

        yield Progress(report)
        bar.update(task, total=bar.tasks[0].completed)
