"""Progress of a run on standard error: two lines in a terminal, one line a stage in a log."""

import math
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import timedelta

from rich.console import Console, ConsoleOptions, RenderResult
from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.table import Column, Table
from rich.text import Text

from modefront.study.estimate import duration
from modefront.text import NAME, clean
from modefront.work.progress import ITERATION, Progress, Span, State, listening
from modefront.work.task import Costs, counted

TITLES: Mapping[str, str] = {
    "check-groups": "check of the groups",
    "sample": "random models",
    "known": "known models",
    "edges": "edges and weighted models",
    "near": "edges within the tolerance",
    "gap": "gaps of the front",
    "most-probable": "most probable model",
    "peaks": "peaks of the posterior",
    "space": "basis of the posterior",
    "sample-posterior": "draws of the posterior",
    "draws": "weights of the draws",
    "iterated-weights": "iteration of the weights",
    "identifiable": "identifiable part",
    "manifold": "equivalent models",
    "second-derivatives": "uncertainty",
    "nominal": "nominal model",
    "shapes": "mode shapes",
    "snapshot": "snapshots",
    "probe-basis": "completeness of the basis",
    "certificate": "certificates",
    "predict": "predictions",
}
"""Stages of a run in words, where these are others than their names."""

WIDTH, LEAST = 24, 8
"""Characters of a study's name, so that all fits into 80 columns, and of the bar, at least."""


@contextmanager
def progress_bar(title: str, plan: Mapping[str, Span] | None) -> Iterator[Progress]:
    """Show how many tasks are done, what goes on and the time that is left by a plan of the run."""
    screen = Console(stderr=True)
    if not screen.is_terminal:
        yield Progress(_Log(screen, title), plan=plan)
        return
    with counted() as costs:
        lines = _Lines(clean(title, WIDTH), costs)
        progress = Progress(lines.take, plan=plan)
        # Clock and counts go on while a task takes long.
        with Live(lines, console=screen, refresh_per_second=4), listening(lines.hear):
            yield progress
            lines.is_done = True


@dataclass
class _Lines:
    """What is drawn, with the time at which it is drawn."""

    title: str
    costs: Costs
    clock: Callable[[], float] = time.monotonic
    state: State = field(default_factory=lambda: State("", 0, 0, None))
    steps: tuple[str, ...] = ()
    taken: float = 0.0
    began: float = field(default_factory=time.monotonic)
    is_done: bool = False

    def take(self, state: State) -> None:
        """Note the state of the run."""
        if (state.stage, state.done) != (self.state.stage, self.state.done):
            self.steps = ()
        self.state, self.taken = state, self.clock()

    def hear(self, text: str) -> None:
        """Note the step that the running task reports."""
        before = self.steps if text.startswith(ITERATION) else ()
        self.steps = (*(x for x in before if not x.startswith(ITERATION)), text)

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        now = self.clock()
        grid = Table.grid("", Column(ratio=1, min_width=LEAST), "", padding=(0, 1), expand=True)
        count = Text(f"{self.state.done} tasks  {timedelta(seconds=int(now - self.began))}")
        bar = ProgressBar(total=1.0, completed=self.share(now))
        grid.add_row(Text(self.title), bar, count)
        yield grid
        yield Text(self.words, overflow="fold")

    def share(self, now: float) -> float:
        """Return the share of the time that has passed, by the middle of what is left."""
        if self.is_done or self.state.left is None:
            return float(self.is_done)
        least, most = self.state.left
        left = least if most == math.inf else (least + most) / 2
        return (now - self.began) / max(self.taken - self.began + left, now - self.began, 1e-9)

    @property
    def words(self) -> str:
        """Sentence on the running task and the time left."""
        if self.is_done:
            return f"done, {self.costs.model_evaluations} models solved"
        if not self.state.stage:
            return "starting"
        count = f" {self.state.of_stage}" * (self.state.of_stage > 0)
        if self.state.extent is not None:
            ends = dict.fromkeys(max(x, self.state.of_stage) for x in self.state.extent)
            count = f" {self.state.of_stage} of {' to '.join(map(str, ends))}"
        parts = [_title(self.state.stage) + count, *self.steps]
        if self.costs.model_evaluations:
            parts.append(f"{self.costs.model_evaluations} models solved")
        parts.append(_left(self.state, self.clock() - self.taken))
        return ", ".join(filter(None, parts))


class _Log:
    """Prints a line when a stage begins."""

    def __init__(self, screen: Console, title: str) -> None:
        self.screen, self.title, self.stage = screen, clean(title, NAME), ""

    def __call__(self, state: State) -> None:
        if state.stage and state.stage != self.stage:
            self.stage = state.stage
            words = ", ".join(filter(None, [_title(state.stage), _left(state)]))
            text = f"{self.title}: {state.done} tasks done: {words}"
            self.screen.print(text, markup=False, highlight=False, soft_wrap=True)


def _title(stage: str) -> str:
    return TITLES.get(stage, stage.replace("-", " "))


def _left(state: State, since: float = 0.0) -> str:
    """Return what is known of the time that is left, ``since`` seconds after the state was so."""
    if state.left is None:
        return ""
    least, most = (max(x - since, 0.0) for x in state.left)
    if most == math.inf or most <= 0 < round(state.left[1]):
        return f"{duration(round(least))} or more" if least >= 1 else "longer than expected"
    if most < 1:
        return ""
    ends = [duration(round(x)) for x in (least, most) if x >= 1]
    return f"{' to ' if len(ends) > 1 else 'at most '}".join(["", *ends][-2:]) + " left"
