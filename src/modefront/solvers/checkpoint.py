"""How solvers hand over pieces of work as soon as they are done."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from modefront.solvers.sqp import Solution

Solutions = Sequence[Solution]

Checkpoint = Callable[[str, Callable[[], Solutions]], Solutions]
"""Returns the solutions of the piece of work of this name: kept ones, or those computed now."""


def compute_always(_: str, compute: Callable[[], Solutions]) -> Solutions:
    """Keep nothing."""
    return compute()
