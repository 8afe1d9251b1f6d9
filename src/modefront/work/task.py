"""Tasks and executors: the work of a run, apart from who does it.

A task is a module-level function with picklable arguments and a key that nothing else in the run
has. Tasks of one call of `Executor.run` are independent of each other; their results come back in
the order of the tasks, whoever computed them and whenever. Random numbers belong to the task: a
task with a seed passes a generator of its own to its function.
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

R = TypeVar("R")


@dataclass(frozen=True)
class Task(Generic[R]):
    """A function to call, and what it is called with.

    Attributes
    ----------
    key : names the task within its turn; the first part is the stage of the run
    function : at module level; its result is a record (`modefront.work.codec`) or a list of these
    arguments : picklable
    seed : of the generator that the function is passed as ``rng``; None where it takes none
    turn : which repetition of the stage the task belongs to
    """

    key: Key
    function: Callable[..., R]
    arguments: tuple[Any, ...] = ()
    seed: np.random.SeedSequence | None = None
    turn: Key = ()

    @property
    def stage(self) -> str:
        """First part of the key."""
        return str(self.key[0])

    @property
    def name(self) -> str:
        """Key and turn in one line."""
        parts = [
            "_".join(map(str, part)) if isinstance(part, tuple) else str(part)
            for part in (*self.key, *self.turn)
        ]
        return "-".join(parts)

    def __call__(self) -> R:
        """Return the result of the function."""
        if self.seed is None:
            return self.function(*self.arguments)
        return self.function(*self.arguments, rng=np.random.default_rng(self.seed))


class Executor(Protocol):
    """Carries out tasks."""

    def run(self, tasks: Sequence[Task[R]]) -> list[R]:
        """Return the results of independent tasks, in their order."""

    def expect(self, stages: Mapping[str, int]) -> None:
        """Take note of how many tasks of each stage are still to come, in the order of stages."""


@dataclass(frozen=True)
class Immediate:
    """Computes every task at once, keeps and reports nothing."""

    def run(self, tasks: Sequence[Task[R]]) -> list[R]:
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

    def run(self, tasks: Sequence[Task[R]]) -> list[R]:
        """Return the results of the tasks."""
        return self.inner.run(
            [replace(x, key=(*self.part, *x.key), turn=(*x.turn, *self.turn)) for x in tasks]
        )

    def expect(self, stages: Mapping[str, int]) -> None:
        """Pass on the extent of the work; that of a part is known by the part."""
        self.inner.expect({str(self.part[0]): sum(stages.values())} if self.part else stages)


def seed_sequence(seed: int, *parts: Part) -> np.random.SeedSequence:
    """Return the seed of the random numbers that belong to a part of a run with this seed."""
    return np.random.SeedSequence([seed, zlib.crc32("-".join(map(str, parts)).encode())])
