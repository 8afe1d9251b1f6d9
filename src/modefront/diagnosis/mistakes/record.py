"""A mistake as a record, and what mistakes are sought for."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeAlias

import numpy as np

from modefront._typing import Floats
from modefront.data.modal import ModalData
from modefront.diagnosis.evidence import OF_MODEL, Point, State, Whole
from modefront.diagnosis.measured import loss
from modefront.findings.record import Finding

RARE, USUAL, OFTEN = 0.005, 0.02, 0.05
"""Probabilities with which a study has a mistake of a kind."""

TRIED = 40
"""Mistakes of a kind that are tried where there may be many: those that promise most."""

MANY = 6
"""Names that a sentence has, at most."""

Change: TypeAlias = Callable[[State], State]


@dataclass(frozen=True, eq=False)
class Mistake:
    """A mistake that may have been made.

    Attributes
    ----------
    kind : of the catalogue of findings, which has its sentence and what mends it
    subject : what it blames
    change : returns a state without it
    price : negative logarithm of the probability that a study has it
    numbers : names and numbers of its sentence
    moves : whether it has moved values to other sensors or modes: it is undone before others, which
        are said of the right ones
    """

    kind: str
    subject: tuple[str, ...]
    change: Change
    price: float
    numbers: Mapping[str, Any] = field(default_factory=dict)
    moves: bool = False

    @property
    def claim(self) -> tuple[str, ...]:
        """What is claimed: the kind, and whom it blames."""
        return (self.kind, *self.subject)

    @property
    def variant(self) -> tuple[str, ...]:
        """What tells it from others with the same claim too."""
        return (*self.claim, str(self.numbers))

    @property
    def finding(self) -> Finding:
        """Its record among all that is found."""
        return Finding(self.kind, ", ".join(self.subject), self.numbers)


@dataclass(frozen=True, eq=False)
class Setting:
    """What mistakes are sought for: a state, with names of its sets, modes, sensors and parameters.

    ``wholes`` and ``points`` are the model, and the state beside it, at nominal and at fitted
    parameters.
    """

    state: State
    wholes: Sequence[Whole]
    points: Sequence[Point]
    names: ModalData
    parameters: tuple[str, ...]

    @property
    def measured(self) -> list[int]:
        """Sensors with data."""
        known: list[int] = np.flatnonzero(self.state.data.known.any(axis=0)).tolist()
        return known

    @property
    def compared(self) -> range:
        """Data sets, where there are others to compare them with."""
        return range(len(self.names.sets) if len(self.names.sets) > 1 else 0)


def mismatch(x: Floats, target: Floats, scale: Floats) -> Floats:
    """Return the cost of columns x (sets, modes, n) beside others (modes, m), (n, m).

    ``scale`` (n,) is that of their differences; those that are not known count nothing.
    """
    r = (x[..., None] - target[:, None]) / scale[:, None]
    return np.asarray(loss(np.nan_to_num(r), OF_MODEL).mean(axis=0).sum(axis=0))


def promising(found: Iterable[tuple[float, Mistake]]) -> Iterator[Mistake]:
    """Yield the mistakes that promise most, of pairs with the fall of the cost by each, once."""
    once: dict[tuple[str, ...], Mistake] = {}
    for _, each in sorted(found, key=lambda pair: -pair[0]):
        once.setdefault(each.variant, each)
    yield from list(once.values())[:TRIED]


def one_of(probability: float, count: float) -> float:
    """Return the price of one of ``count`` mistakes, one of which a study has so often."""
    return float(np.log(max(count, 1) / probability))


def changed(part: str, new: Callable[[Floats], Floats]) -> Change:
    """Return the change of a part of the data into what a function makes of it."""

    def change(state: State) -> State:
        values: Any = {part: new(getattr(state.data, part).copy())}
        return replace(state, data=replace(state.data, **values))

    return change


def without(part: str, place: Any, cost: float) -> Change:
    """Return the change that leaves out some values of a part of the data, for a cost."""

    def change(state: State) -> State:
        values = getattr(state.data, part).copy()
        values[place] = np.nan
        data: Any = {part: values, "left_out": state.data.left_out + float(cost)}
        return replace(state, data=replace(state.data, **data))

    return change
