"""Costs of tasks: counted where an eigenproblem is solved, by all counts that are open there."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass


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

    def add(self, other: Costs) -> None:
        """Add other costs to these."""
        for name, spent in vars(other).items():
            if spent:
                setattr(self, name, getattr(self, name) + spent)


_OPEN: ContextVar[tuple[Costs, ...]] = ContextVar("open", default=())


def spend(costs: Costs) -> None:
    """Add costs to all counts that are open."""
    for count in _OPEN.get():
        count.add(costs)


@contextmanager
def counted() -> Iterator[Costs]:
    """Count what is spent until the context ends."""
    costs = Costs()
    before = _OPEN.set((*_OPEN.get(), costs))
    try:
        yield costs
    finally:
        _OPEN.reset(before)


@contextmanager
def uncounted() -> Iterator[None]:
    """Count nothing until the context ends: the same work was counted before."""
    before = _OPEN.set(())
    try:
        yield
    finally:
        _OPEN.reset(before)
