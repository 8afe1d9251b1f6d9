"""A mistake as a record, and several of them as an explanation of the data."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, TypeAlias

import numpy as np

from modefront.data.modal import ModalData
from modefront.diagnosis.evidence import Fits, Points
from modefront.diagnosis.state import NOTHING, State
from modefront.findings.record import Finding
from modefront.modes.result import Modes

MANY = 6  # names that a sentence has, at most

BETTER = ("better", "factor", "looks", "place", "sensor", "what", "of", "quantity", "later")
"""Names and numbers of sentences that tell mistakes of the same claim from each other."""

IMPRECISE = "imprecise-member"  # kind that is no mistake, and never named

Change: TypeAlias = Callable[[State], State]


@dataclass(frozen=True, eq=False)
class Mistake:
    """A mistake that may have been made."""

    kind: str  # of the catalogue of findings, which has its sentence and what mends it
    subject: tuple[str, ...]  # what it blames
    change: Change  # returns a state without it
    numbers: Mapping[str, Any] = field(default_factory=dict)  # names and numbers of its sentence
    # negative logarithm of its probability; as it is yielded, among the mistakes of its kind
    price: float = 0.0
    # whether it has moved values to other sensors or modes: it is undone before others, which are
    # said of the right ones
    moves: bool = False

    @property
    def claim(self) -> tuple[str, ...]:
        """What is claimed: the kind, and whom it blames."""
        return (self.kind, *self.subject)

    @property
    def key(self) -> tuple[object, ...]:
        """What tells it from others: the claim, and what is better, without the numbers beside."""
        return (*self.claim, *map(self.numbers.get, BETTER))

    @property
    def finding(self) -> Finding:
        """Its record among all that is found."""
        return Finding(self.kind, ", ".join(self.subject), self.numbers)


@dataclass(frozen=True, eq=False)
class Explanation:
    """Assumed mistakes, the state without them, the end of a fit, and C there with the prices."""

    fits: Fits
    mistakes: tuple[Mistake, ...]
    state: State
    point: Points
    cost: float

    @property
    def claims(self) -> frozenset[tuple[str, ...]]:
        """What is claimed."""
        return frozenset(each.claim for each in self.mistakes)

    @property
    def blamed(self) -> frozenset[tuple[str, ...]]:
        """What is claimed to be a mistake."""
        return frozenset(each.claim for each in self.mistakes if each.kind != IMPRECISE)

    @property
    def data(self) -> ModalData:
        """The measured modes as they are given, with the names of sets, modes and sensors."""
        return self.fits.comparison.data

    @property
    def modes(self) -> Modes:
        """The modes of the model at the fitted parameters."""
        modes = self.fits.of(self.state, self.point.x)
        assert modes is not None
        return modes

    @property
    def measured(self) -> list[int]:
        """Sensors with data, as they are given or in the state."""
        known = self.state.known.any(axis=0) | np.isfinite(self.data.shape).any(axis=(0, 1))
        return np.flatnonzero(known).tolist()


def changed(part: str, place: Any, new: Any, cost: float = 0.0) -> Change:
    """Return the change of some values of a part of the state, for a cost.

    They become what a function makes of them, or are divided by a factor; NaN leaves them out.
    """

    def change(state: State) -> State:
        old = getattr(state, part)
        values, known = old.copy(), old[place]
        values[place] = better = new(known) if callable(new) else known / new
        lost = NOTHING * (np.isfinite(known).sum() - np.isfinite(better).sum())
        parts: Any = {part: values}
        return replace(state, left_out=state.left_out + cost + lost, **parts)

    return change
