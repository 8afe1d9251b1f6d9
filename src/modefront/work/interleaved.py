"""Several functions at a time, each of which asks a backend for the results of tasks.

Each of them has a thread of its own, but only one thread runs at any time: the caller's, or that of
the function that has just been given a result, until it asks for more or ends. So nothing of what
they share needs a lock, and each function does exactly what it does alone.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence
from contextvars import copy_context
from dataclasses import dataclass, field
from itertools import chain, zip_longest
from queue import SimpleQueue
from typing import Any, TypeAlias

from modefront.work.backend import Backend, Done
from modefront.work.costs import uncounted
from modefront.work.task import Task


class _GivenUp(BaseException):
    """Ends a function whose tasks are not computed any more."""


@dataclass(frozen=True)
class _Asked:
    """Tasks that a function asks for, and those that it will probably ask for next."""

    tasks: Sequence[Task[Any]]
    ahead: Sequence[Task[Any]]


@dataclass(frozen=True)
class _Ended:
    """The end of a function: its result, or the error that it has raised."""

    result: Any = None
    error: BaseException | None = None


Answer: TypeAlias = tuple[int, Done]
"""Position and result of a task that was asked for."""


@dataclass
class _Conversation:
    """A function that is suspended as long as it waits for the results of tasks.

    It is the backend of its function.

    Attributes
    ----------
    function : is called with this backend
    workers : number of tasks that are computed at the same time
    ahead : tasks that it will probably ask for next
    """

    function: Callable[[Backend], Any]
    workers: int
    ahead: Sequence[Task[Any]] = ()
    _said: SimpleQueue[_Asked | _Ended | None] = field(default_factory=SimpleQueue)
    _answers: SimpleQueue[Answer | None] = field(default_factory=SimpleQueue)
    _thread: threading.Thread = field(init=False)

    def __post_init__(self) -> None:
        run = copy_context().run
        self._thread = threading.Thread(target=run, args=(self._converse,), daemon=True)

    def begin(self) -> _Asked | _Ended | None:
        """Return what the function first asks for, or its end."""
        self._thread.start()
        return self._said.get()

    def answer(self, position: int, done: Done) -> _Asked | _Ended | None:
        """Return what the function asks for after a result; None where it waits for others."""
        self._answers.put((position, done))
        return self._said.get()

    def close(self) -> None:
        """End the function if it waits."""
        if self._thread.is_alive():
            self._answers.put(None)
            self._thread.join()

    def compute(
        self,
        tasks: Sequence[Task[Any]],
        ahead: Sequence[Task[Any]],
        _: Callable[[int], None],
        /,
    ) -> Iterator[Answer]:
        """Yield the positions and results of tasks, for which the caller is asked."""
        self._said.put(_Asked(tasks, ahead))
        for left in range(len(tasks), 0, -1):
            answer = self._answers.get()
            if answer is None:
                raise _GivenUp
            yield answer
            if left > 1:
                self._said.put(None)

    def _converse(self) -> None:
        try:
            self._said.put(_Ended(self.function(self)))
        except BaseException as error:  # it belongs to the caller
            self._said.put(_Ended(error=error))


def interleaved(
    functions: Sequence[Callable[[Backend], Any]], backend: Backend
) -> Iterator[tuple[int, Any]]:
    """Yield the positions and results of functions as they end, and raise what they raise.

    Each is called with a backend that passes its tasks on. Where a task raises an error, the
    function that has asked for it is given up, and the error is raised when all others have ended.
    """
    talks = [_Conversation(function, backend.workers) for function in functions]
    tasks: list[Task[Any]] = []
    ahead: list[Task[Any]] = []
    origins: list[tuple[int, int]] = []
    errors: dict[int, BaseException] = {}

    def heard(k: int, said: _Asked | _Ended | None) -> Iterator[tuple[int, Any]]:
        """Take note of what a function says, and yield its result if that is its end."""
        if isinstance(said, _Asked):
            talks[k].ahead = said.ahead
            origins.extend((k, position) for position in range(len(said.tasks)))
            tasks.extend(said.tasks)
        elif isinstance(said, _Ended):
            talks[k].ahead = ()
            if said.error is None:
                yield k, said.result
            else:
                errors[k] = said.error
        in_turn = chain.from_iterable(zip_longest(*(talk.ahead for talk in talks)))
        ahead[:] = [task for task in in_turn if task is not None]

    try:
        for k, talk in enumerate(talks):
            yield from heard(k, talk.begin())
        results = backend.compute(tasks, ahead, lambda _: None)
        while True:
            with uncounted():  # a part counts where its function takes the result
                answer = next(results, None)
            if answer is None:
                break
            k, position = origins[answer[0]]
            yield from heard(k, talks[k].answer(position, answer[1]))
        if errors:
            raise errors[min(errors)]
    finally:
        for talk in talks:
            talk.close()
