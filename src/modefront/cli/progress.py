"""Progress of a run on standard error: a bar in a terminal, one line a stage in a log."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
from rich.progress import Progress as Bar

from modefront.text import NAME, clean
from modefront.work.progress import Progress, State

TITLES: Mapping[str, str] = {
    "check-groups": "groups",
    "sample": "random models",
    "known": "known models",
    "edge": "edges",
    "near": "edges within the tolerance",
    "corner": "corners",
    "weights": "weighted models",
    "front": "front",
    "probe": "probes between the edges",
    "gap": "gaps of the front",
    "optimal-weights": "optimal weights",
    "bounded-weights": "bounded weights",
    "iterated-weights": "iteration of the weights",
    "identifiable": "identifiable part",
    "manifold": "equivalent models",
    "second-derivatives": "uncertainty",
    "bootstrap": "bootstrap",
    "nominal": "nominal model",
    "snapshot": "snapshots",
    "probe-basis": "completeness of the basis",
    "certificate": "certificates",
    "predict": "predictions",
}
"""Stages of a run in words."""

WIDTH = 24
"""Characters of a study's name in the bar, so that all fits into 80 columns."""


@contextmanager
def progress_bar(title: str) -> Iterator[Progress]:
    """Show how many tasks are done, of how many, the stage at work and the time that is left."""
    screen = Console(stderr=True)
    if not screen.is_terminal:
        yield Progress(_Log(screen, title))
        return
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(bar_width=None),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("{task.fields[stage]}", markup=False),
    )
    short = clean(title, WIDTH)
    with Bar(*columns, console=screen) as bar:
        task = bar.add_task(short, stage="", total=None)

        def report(state: State) -> None:
            bar.update(task, total=state.expected, completed=state.done, stage=_stage(state))

        yield Progress(report)
        bar.update(task, total=bar.tasks[0].completed, stage="done")


class _Log:
    """Prints a line when a stage begins."""

    def __init__(self, screen: Console, title: str) -> None:
        self.screen, self.title, self.stage = screen, clean(title, NAME), ""

    def __call__(self, state: State) -> None:
        if state.stage and state.stage != self.stage:
            self.stage = state.stage
            text = f"{self.title}: {state.done}/{state.expected} {_stage(state)}"
            self.screen.print(text, markup=False, highlight=False, soft_wrap=True)


def _stage(state: State) -> str:
    """Return the stage in words, and the time that is left."""
    title = TITLES.get(state.stage, state.stage)
    if state.left is None or state.left < 1:
        return title
    minutes, seconds = divmod(round(state.left), 60)
    return f"{title}, {f'{minutes} min' if minutes else f'{seconds} s'} left"
