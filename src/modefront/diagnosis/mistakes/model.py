"""Members of which the model has another stiffness or mass than the structure."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from modefront.diagnosis.mistakes.record import Explanation, Mistake
from modefront.diagnosis.mistakes.values import POWERS
from modefront.diagnosis.state import State

SIZES = {"": 1.0, "smaller": 0.25, "greater": 4.0}
"""Factors with which fits of a member begin. Up to a factor of 2 it is as imprecise as others."""

IMPRECISE = "imprecise-member"  # kind that is no mistake, and never named


def _scaled(state: State, part: int, factor: float) -> State:
    """Return the state with a factor on a part of the model as its last parameter."""
    start = state.start.copy()
    start[-1] = factor
    return replace(state, start=start, part=np.array(part + 1))


def wrong_member(old: Explanation) -> Iterator[Mistake]:
    """Yield members that are several times as stiff or heavy as in the model."""
    for k, part in enumerate(old.fits.parts if not old.state.part else ()):
        for size, factor in SIZES.items() if not part.whole else ():
            numbers = {"what": part.of, "place": part.place, "size": size}
            change = partial(_scaled, part=k, factor=factor)
            yield Mistake("wrong-member" if size else IMPRECISE, ("model",), change, numbers)


def wrong_unit(old: Explanation) -> Iterator[Mistake]:
    """Yield powers of ten on the stiffness or mass of groups that no parameter scales."""
    for k, part in enumerate(old.fits.parts if not old.state.part else ()):
        for power in POWERS if part.whole else ():
            numbers = {"what": part.of, "place": part.place, "factor": 10.0**-power}
            change = partial(_scaled, part=k, factor=10.0**power)
            yield Mistake("wrong-unit", (f"{part.of} {part.place}",), change, numbers)
