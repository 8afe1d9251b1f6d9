"""A progress bar on standard error."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
from rich.progress import Progress as Bar

from modefront.study.session import Progress


@contextmanager
def progress_bar(title: str) -> Iterator[Progress]:
    """Show pieces of work as they are done; the last one is named."""
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("{task.fields[piece]}", markup=False),
    )
    with Bar(*columns, console=Console(stderr=True)) as bar:
        task = bar.add_task(title, piece="", total=None)

        def expect(pieces: int) -> None:
            bar.update(task, total=pieces)

        def done(name: str) -> None:
            bar.update(task, advance=1, piece=name)

        yield Progress(expect, done)
        bar.update(task, total=bar.tasks[0].completed)
