"""A mistake as a record, and what mistakes are sought for."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, TypeAlias

import numpy as np

from modefront._typing import Floats
from modefront.data.modal import ModalData
from modefront.diagnosis.evidence import Points
from modefront.diagnosis.state import NOTHING, State
from modefront.findings.record import Finding
from modefront.modes.result import Modes

RARE, USUAL, OFTEN = 0.005, 0.02, 0.05  # probabilities with which a study has a mistake of a kind
MANY = 6  # names that a sentence has, at most

Change: TypeAlias = Callable[[State], State]


@dataclass(frozen=True, eq=False)
class Mistake:
    """A mistake that may have been made."""

    kind: str  # of the catalogue of findings, which has its sentence and what mends it
    subject: tuple[str, ...]  # what it blames
    change: Change  # returns a state without it
    price: float  # negative logarithm of the probability that a study has it
    numbers: Mapping[str, Any] = field(default_factory=dict)  # names and numbers of its sentence
    # whether it has moved values to other sensors or modes: it is undone before others, which are
    # said of the right ones
    moves: bool = False

    @property
    def claim(self) -> tuple[str, ...]:
        """What is claimed: the kind, and whom it blames."""
        return (self.kind, *self.subject)

    @property
    def finding(self) -> Finding:
        """Its record among all that is found."""
        return Finding(self.kind, ", ".join(self.subject), self.numbers)


@dataclass(frozen=True, eq=False)
class Setting:
    """What mistakes are sought for: a state, with names of its sets, modes, sensors and parameters.

    ``point`` is the state beside the model with these ``modes``, at fitted parameters; ``nominal``
    are the frequencies of the nominal model, which sentences name.
    """

    state: State
    point: Points
    modes: Modes
    nominal: Floats
    names: ModalData
    parameters: tuple[str, ...]

    @property
    def measured(self) -> list[int]:
        """Sensors with data, as they are given or in the state."""
        known = self.state.known.any(axis=0) | np.isfinite(self.names.shape).any(axis=(0, 1))
        sensors: list[int] = np.flatnonzero(known).tolist()
        return sensors


def one_of(probability: float, count: float) -> float:
    """Return the price of one of ``count`` mistakes, one of which a study has so often."""
    return float(np.log(max(count, 1) / probability))


def changed(
    part: str, place: Any, new: Callable[[Floats], Floats] | float, cost: float = 0.0
) -> Change:
    """Return the change of some values of a part of the state, for a cost.

    They become what a function makes of them, or are divided by a factor, of which NaN leaves out.
    Of values that are left out nothing is known.
    """

    def change(state: State) -> State:
        values = getattr(state, part).copy()
        count = np.isfinite(values).sum()
        values[place] = new(values[place]) if callable(new) else values[place] / new
        lost = NOTHING * (count - np.isfinite(values).sum())
        parts: Any = {part: values}
        return replace(state, left_out=state.left_out + cost + lost, **parts)

    return change
