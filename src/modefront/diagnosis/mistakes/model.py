"""Members of which the model has another stiffness or mass than the structure."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from itertools import product

import numpy as np

from modefront.diagnosis.mistakes.record import IMPRECISE, Explanation, Mistake
from modefront.diagnosis.state import State

NEAREST = 4  # members that are tried: those of which the cost is less ahead of a step

THOUSANDS = (3, -3, 6, -6, 9, -9)  # powers of ten by which units differ


def _scaled(state: State, part: int, factor: float) -> State:
    """Return the state with a factor on a part of the model as its last parameter."""
    start = state.start.copy()
    start[-1] = factor
    return replace(state, start=start, part=np.array(part + 1))


def wrong_member(old: Explanation) -> Iterator[Mistake]:
    """Yield members that are several times as stiff or heavy as in the model."""
    yield from _members(old, {"smaller": 0.25, "greater": 4.0})


def imprecise_member(old: Explanation) -> Iterator[Mistake]:
    """Yield members that differ by up to a factor of 2 from the model, as many do."""
    yield from _members(old, {"": 1.0})


def _members(old: Explanation, sizes: Mapping[str, float]) -> Iterator[Mistake]:
    """Yield members with the factors with which fits begin."""
    fits, every = old.fits, enumerate(old.fits.parts if not old.state.part else ())
    single = [k for k, part in every if not part.whole]
    begun = fits.begun([_scaled(old.state, k, 1.0) for k in single], (old.state, old.point.x))
    costs = np.concatenate([np.zeros(0), *(each.ahead for _, each in begun)])
    first = [single[k] for k in np.argsort(costs, kind="stable")[:NEAREST]]
    for k, (size, factor) in product(first, sizes.items()):
        numbers = {"what": fits.parts[k].of, "place": fits.parts[k].place, "better": size}
        change, price = partial(_scaled, part=k, factor=factor), np.log(len(single) / len(first))
        kind = "wrong-member" if size else IMPRECISE
        yield Mistake(kind, ("model",), change, numbers, float(price))


def wrong_unit(old: Explanation) -> Iterator[Mistake]:
    """Yield powers of ten on the stiffness or mass of groups that no parameter scales."""
    for k, part in enumerate(old.fits.parts if not old.state.part else ()):
        for power in THOUSANDS if part.whole else ():
            numbers = {"what": part.of, "place": part.place, "factor": 10.0**-power}
            change = partial(_scaled, part=k, factor=10.0**power)
            yield Mistake("wrong-unit", (f"{part.of} {part.place}",), change, numbers)
