"""Costs of tasks: counted where an eigenproblem is solved, and nowhere else.

`spend` adds to every count that is open (`counted`) in the same thread or task, so the costs of a
task are its own, whatever else is computed at the same time.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass


@dataclass
class Costs:
    """Numbers of solutions, and seconds that they took.

    Attributes
    ----------
    eigenproblems : solved in full, with derivatives or without
    corrected : solved in full with the factor of another one, for a reduced basis
    factorisations : of sparse matrices, for these and for certificates
    reduced : eigenproblems solved in a reduced basis
    certificates : estimates of the error of reduced solutions
    full_time, corrected_time, reduced_time, certificate_time : seconds that these took
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


def total(costs: Iterable[Costs]) -> Costs:
    """Return the sum of costs."""
    out = Costs()
    for each in costs:
        out.add(each)
    return out


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
