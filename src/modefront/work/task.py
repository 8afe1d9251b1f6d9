"""Tasks and executors: the work of a run, apart from who does it, and its costs.

Tasks of one call of `Executor.run` are independent, and their results come back in their order.
Costs are counted where an eigenproblem is solved, by all counts that are open there.
"""

import time
import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace
from typing import Any, Generic, TypeVar

import numpy as np

from modefront.work.codec import record


@record
@dataclass
class Costs:
    """Numbers of solutions, and seconds that they took.

    Eigenproblems are solved in full, ``corrected`` ones with the factor of another one, ``reduced``
    ones in a basis; ``certificates`` are estimates of the error of these.
    """

    eigenproblems: int = 0
    corrected: int = 0
    factorisations: int = 0
    reduced: int = 0
    certificates: int = 0
    full_time: float = 0.0
    corrected_time: float = 0.0
    reduced_time: float = 0.0
    certificate_time: float = 0.0

    @property
    def model_evaluations(self) -> int:
        """Eigenproblems solved in full or in a reduced basis."""
        return self.eigenproblems + self.reduced

    def add(self, other: "Costs") -> None:
        """Add other costs to these."""
        for name, spent in vars(other).items():
            if spent:
                setattr(self, name, getattr(self, name) + spent)


V = TypeVar("V")

_OPEN: ContextVar[tuple[Costs, ...]] = ContextVar("open", default=())


def spend(costs: Costs) -> None:
    """Add costs to all counts that are open."""
    for count in _OPEN.get():
        count.add(costs)


@contextmanager
def held(variable: ContextVar[V], value: V) -> Iterator[None]:
    """Give a variable a value until the context ends."""
    before = variable.set(value)
    try:
        yield
    finally:
        variable.reset(before)


@contextmanager
def counted() -> Iterator[Costs]:
    """Count what is spent until the context ends."""
    costs = Costs()
    with held(_OPEN, (*_OPEN.get(), costs)):
        yield costs


def uncounted() -> AbstractContextManager[None]:
    """Count nothing until the context ends: the same work was counted before."""
    return held(_OPEN, ())


Part = str | int | tuple[int, ...]

Key = tuple[Part, ...]  # parts that name a task; the first one names its stage

Count = tuple[int, int]  # from and to

R = TypeVar("R")


@dataclass(frozen=True)
class Task(Generic[R]):
    """A function with its arguments."""

    key: Key  # names the task within its turn; the first part is the stage of the run
    # at module level; its result is a record (`modefront.work.codec`) or a list of these
    function: Callable[..., R]
    arguments: tuple[Any, ...] = ()  # picklable
    # of the generator that the function is passed as ``rng``; None where it takes none
    seed: np.random.SeedSequence | None = None
    turn: Key = ()  # which repetition of the stage the task belongs to
    # whether it changes its arguments, and is computed in the process that has them
    in_process: bool = False
    memory: float = 0.0  # bytes that it takes besides its arguments, where these are many

    @property
    def stage(self) -> str:
        """First part of the key."""
        return str(self.key[0])

    @property
    def identity(self) -> tuple[Key, Key]:
        """Identity of the task among all tasks of the run."""
        return self.key, self.turn

    @property
    def name(self) -> str:
        """Key and turn in one line."""
        parts = (part if isinstance(part, tuple) else (part,) for part in (*self.key, *self.turn))
        return "-".join("_".join(map(str, part)) for part in parts)

    def __call__(self) -> R:
        """Return the result of the function."""
        if self.seed is None:
            return self.function(*self.arguments)
        return self.function(*self.arguments, rng=np.random.default_rng(self.seed))


class Executor:
    """Carries out tasks: at once, unless others do so in their way; keeps and reports nothing."""

    def run(self, tasks: Sequence[Task[R]], /) -> list[R]:
        """Return the results of independent tasks, in their order."""
        return [task() for task in tasks]

    def expect(self, stages: Mapping[str, Count]) -> None:
        """Take note of how many tasks of each stage are still to come, from and to."""


IMMEDIATE = Executor()


@dataclass(frozen=True)
class Within(Executor):
    """An executor for a repetition of the work, whose tasks have a further turn."""

    inner: Executor
    turn: Key

    def run(self, tasks: Sequence[Task[R]], /) -> list[R]:
        """Return the results of the tasks."""
        return self.inner.run([replace(x, turn=(*x.turn, *self.turn)) for x in tasks])

    def expect(self, stages: Mapping[str, Count]) -> None:
        """Pass on the extent of the work."""
        self.inner.expect(stages)


def seed_sequence(seed: int, *parts: Part) -> np.random.SeedSequence:
    """Return the seed of the random numbers that belong to a part of a run with this seed."""
    return np.random.SeedSequence([seed, zlib.crc32("-".join(map(str, parts)).encode())])


@dataclass(frozen=True)
class Done:
    """The result of a task, or its error, what it cost, and the seconds that it took."""

    result: Any
    costs: Costs
    seconds: float
    error: Exception | None = None


def computed(task: Task[Any]) -> Done:
    """Return the result of a task, computed here and now."""
    began = time.perf_counter()
    with counted() as costs:
        result = task()
    return Done(result, costs, time.perf_counter() - began)
