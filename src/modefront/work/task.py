"""Tasks and executors: the work of a run, apart from who does it.

A task is a module-level function with picklable arguments and a key that nothing else in the run
has. Tasks of one call of `Executor.run` are independent of each other; their results come back in
the order of the tasks, whoever computed them and whenever. Random numbers belong to the task: a
task with a seed passes a generator of its own to its function.

Where one task follows from another, a caller names those that it will probably ask for next. An
executor may compute them ahead; what is not asked for then is forgotten, and neither results nor
costs depend on it.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Generic, Protocol, TypeVar

import numpy as np

Part = str | int | tuple[int, ...]

Key = tuple[Part, ...]
"""Parts that name a task; the first one names its stage."""

Identity = tuple[Key, Key, Callable[..., Any]]
R = TypeVar("R")


@dataclass(frozen=True)
class Task(Generic[R]):
    """A function with its arguments.

    Attributes
    ----------
    key : names the task within its turn; the first part is the stage of the run
    function : at module level; its result is a record (`modefront.work.codec`) or a list of these
    arguments : picklable
    seed : of the generator that the function is passed as ``rng``; None where it takes none
    turn : which repetition of the stage the task belongs to
    has_parts : whether the function is passed an executor as ``work``, which computes its parts
    in_process : whether it changes its arguments, and is computed in the process that has them
    memory : bytes that it takes besides its arguments, where these are many
    """

    key: Key
    function: Callable[..., R]
    arguments: tuple[Any, ...] = ()
    seed: np.random.SeedSequence | None = None
    turn: Key = ()
    has_parts: bool = False
    in_process: bool = False
    memory: float = 0.0

    @property
    def stage(self) -> str:
        """First part of the key."""
        return str(self.key[0])

    @property
    def identity(self) -> Identity:
        """Identity of the task among all tasks of the run.

        The function is a part, so that no other one that was expected under its name is taken for
        it.
        """
        return self.key, self.turn, self.function

    @property
    def name(self) -> str:
        """Key and turn in one line."""
        parts = [
            "_".join(map(str, part)) if isinstance(part, tuple) else str(part)
            for part in (*self.key, *self.turn)
        ]
        return "-".join(parts)

    def __call__(self, work: Executor | None = None) -> R:
        """Return the result of the function; ``work`` computes its parts, if it has any."""
        options: dict[str, Any] = {}
        if self.seed is not None:
            options["rng"] = np.random.default_rng(self.seed)
        if self.has_parts:
            options["work"] = work or IMMEDIATE
        return self.function(*self.arguments, **options)


class Executor(Protocol):
    """Carries out tasks."""

    def run(self, tasks: Sequence[Task[R]], ahead: Sequence[Task[Any]] = (), /) -> list[R]:
        """Return the results of independent tasks, in their order.

        Tasks ``ahead`` will probably be asked for next, in this order.
        """

    def expect(self, stages: Mapping[str, int]) -> None:
        """Take note of how many tasks of each stage are still to come, in the order of stages."""


@dataclass(frozen=True)
class Immediate:
    """Computes every task at once, keeps and reports nothing."""

    def run(self, tasks: Sequence[Task[R]], _: Sequence[Task[Any]] = (), /) -> list[R]:
        """Return the results of the tasks."""
        return [task() for task in tasks]

    def expect(self, stages: Mapping[str, int]) -> None:
        """Ignore the extent of the work."""


IMMEDIATE = Immediate()


@dataclass(frozen=True)
class Within:
    """An executor for a part of the work, or for a repetition of it.

    Attributes
    ----------
    inner : carries out the tasks
    part : put before the keys of the tasks, so that their stage is that of the part
    turn : put behind their turns
    """

    inner: Executor
    part: Key = ()
    turn: Key = ()

    def run(self, tasks: Sequence[Task[R]], ahead: Sequence[Task[Any]] = (), /) -> list[R]:
        """Return the results of the tasks."""
        return self.inner.run([self._of(x) for x in tasks], [self._of(x) for x in ahead])

    def expect(self, stages: Mapping[str, int]) -> None:
        """Pass on the extent of the work; that of a part is known by the part."""
        self.inner.expect({str(self.part[0]): sum(stages.values())} if self.part else stages)

    def _of(self, task: Task[R]) -> Task[R]:
        return replace(task, key=(*self.part, *task.key), turn=(*task.turn, *self.turn))


def seed_sequence(seed: int, *parts: Part) -> np.random.SeedSequence:
    """Return the seed of the random numbers that belong to a part of a run with this seed."""
    return np.random.SeedSequence([seed, zlib.crc32("-".join(map(str, parts)).encode())])
