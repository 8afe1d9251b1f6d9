"""Functions of tasks, in a module that other processes can import."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_info

from modefront._typing import Floats
from modefront.linalg.products import shared_pool
from modefront.work.costs import Costs, spend
from modefront.work.task import Executor, Task
from modefront.work.transfer import shared


def square(x: int) -> int:
    spend(Costs(eigenproblems=x))
    return x * x


def squares(*numbers: int) -> list[Task[int]]:
    return [Task(("square", x), square, (x,)) for x in numbers]


def normal(k: int, *, rng: np.random.Generator) -> Floats:
    return k + rng.normal(size=3)


def chain(number: int, *, work: Executor) -> list[int]:
    """Return squares that follow from each other, with those that may come next named."""
    out = []
    for k in range(3):
        tasks = [Task(("link", i), square, (number + i,)) for i in range(k, k + 3)]
        out += work.run(tasks[:1], tasks[1:])
    return out


def fragile(error: Exception, *, work: Executor) -> int:
    """Raise the error of a part."""
    return work.run([*squares(1), Task(("fails",), failing, (error,))])[0]


def broken_off(*, work: Executor) -> int:
    """Raise an error between two parts."""
    raise ZeroDivisionError(work.run(squares(2, 3)))


def one_part(*, work: Executor) -> int:
    return work.run([Task(("nap",), nap, (1,))])[0]


def negative(x: int) -> int:
    return -x * x


@shared
@dataclass
class Big:
    """An object that is sent once."""

    numbers: Floats
    footprint: float = 0.0
    version: int = 0
    parts: Sequence[Any] = ()


def total(big: Big, x: int) -> float:
    return float(big.numbers.sum()) + x


def total_of_parts(big: Big) -> float:
    time.sleep(0.002)  # else it would be computed in the process that asks for it
    return float(big.numbers.sum()) + sum(total_of_parts(part) for part in big.parts)


def totals(big: Big, turn: int = 0) -> list[Task[float]]:
    return [Task(("total", k), total, (big, k), turn=("turn", turn)) for k in range(6)]


def failing(error: Exception) -> int:
    raise error


def nap(k: int) -> int:
    time.sleep(0.02)
    return k


def slow(calls: str, *, work: Executor) -> int:
    (part,) = work.run([Task(("part",), long_part)])
    with Path(calls).open("a") as stream:
        stream.write("x")
    if Path(calls).read_text() == "x":
        raise ZeroDivisionError
    return part


def long_part() -> int:
    spend(Costs(eigenproblems=3))
    return 7


def deadly(marker: str, times: int, number: int) -> int:
    """End the process, the first times that this is called with the number 2."""
    if number == 2:
        path = Path(marker)
        before = len(path.read_text()) if path.exists() else 0
        if before < times:
            path.write_text("x" * (before + 1))
            os.kill(os.getpid(), signal.SIGKILL)
    return number


def threads(_: int) -> int:
    time.sleep(0.05)
    blas = [x["num_threads"] for x in threadpool_info() if x["user_api"] == "blas"]
    return max(shared_pool()[1], *blas)


def process_of(_: int) -> int:
    time.sleep(0.05)
    return os.getpid()
