"""A pool for tests that computes messages in threads, in any order, and loses some."""

from __future__ import annotations

import time
from collections.abc import Collection, Sequence
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field

from modefront.work import transfer
from modefront.work.transfer import Message, Reply


@dataclass
class Threads:
    """Computes messages after delays, in milliseconds, one after another taken in turn.

    The messages with the numbers ``broken`` are lost; from the one numbered ``cut`` on, there is no
    cluster any more. Every message ``forgets`` shared objects.
    Where there is ``known``, each message meets a process that knows no other shared objects among
    those of the message than the ones in these places, taken in turn.
    """

    count: int = 2
    delays: Sequence[int] = (0,)
    broken: Sequence[int] = ()
    cut: int | None = None
    forgets: bool = False
    known: Sequence[Collection[int]] = ()
    ready: bool = True
    lost: tuple[type[Exception], ...] = (BrokenProcessPool,)
    gone: tuple[type[Exception], ...] = (CancelledError,)
    sent: list[Message] = field(default_factory=list)
    closed: bool = False
    most: int = 0
    under_way: set[Future[Reply]] = field(default_factory=set)
    executor: ThreadPoolExecutor = field(default_factory=lambda: ThreadPoolExecutor(8))

    def submit(self, message: Message, objects: dict[str, bytes], /) -> Future[Reply]:
        number = len(self.sent)
        self.sent.append(message)
        if self.cut is not None and number >= self.cut:
            raise CancelledError
        future = self.executor.submit(self._compute, number, message, objects)
        self.under_way = {x for x in self.under_way if not x.done()} | {future}
        self.most = max(self.most, len(self.under_way))
        return future

    def _compute(self, number: int, message: Message, objects: dict[str, bytes]) -> Reply:
        time.sleep(1e-3 * self.delays[number % len(self.delays)])
        if number in self.broken:
            raise BrokenProcessPool
        if self.forgets and not objects:
            transfer._OBJECTS.clear()
        if self.known:
            places = self.known[number % len(self.known)]
            with transfer._LOCK:
                for place, name in enumerate(message.names):
                    if place not in places:
                        transfer._OBJECTS.pop(name, None)
        return transfer.work(message, objects)

    def close(self) -> None:
        self.closed = True
        self.executor.shutdown()
