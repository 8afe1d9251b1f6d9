"""Functions of tasks, in a module that other processes can import."""

from __future__ import annotations

import os
import signal
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_info

from modefront._typing import Floats
from modefront.linalg.products import shared_pool
from modefront.work.task import Costs, Task, spend
from modefront.work.transfer import shared


def square(x: int) -> int:
    spend(Costs(eigenproblems=x))
    return x * x


def squares(*numbers: int) -> list[Task[int]]:
    return [Task(("square", x), square, (x,)) for x in numbers]


def normal(k: int, *, rng: np.random.Generator) -> Floats:
    return k + rng.normal(size=3)


@shared
@dataclass
class Big:
    """An object that is sent once."""

    numbers: Floats
    footprint: float = 0.0
    version: int = 0
    part: Any = None


def total(big: Big, x: int) -> float:
    return float(big.numbers.sum()) + x


def total_of_parts(big: Big) -> float:
    time.sleep(0.002)  # else it would be computed in the process that asks for it
    return float(big.numbers.sum()) + (total_of_parts(big.part) if big.part else 0.0)


def totals(big: Big, turn: int = 0) -> list[Task[float]]:
    return [Task(("total", k), total, (big, k), turn=("turn", turn)) for k in range(6)]


def failing(error: Exception) -> int:
    raise error


def nap(k: int) -> int:
    time.sleep(0.02)
    return k


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
