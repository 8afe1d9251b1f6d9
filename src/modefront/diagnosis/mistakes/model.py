"""Members of which the model has another stiffness or mass than the structure."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from modefront.diagnosis.mistakes.record import IMPRECISE, Explanation, Mistake
from modefront.diagnosis.state import State

NEAREST = 2  # members that are tried: those of which the cost is less ahead of a step

THOUSANDS = (3, -3, 6, -6, 9, -9)  # powers of ten by which units differ


def _scaled(state: State, part: int, factor: float) -> State:
    """Return the state with a factor on a part of the model as its last parameter."""
    start = state.start.copy()
    start[-1] = factor
    return replace(state, start=start, part=np.array(part + 1))


def wrong_member(old: Explanation, *, usual: bool = False) -> Iterator[Mistake]:
    """Yield the members that promise most, several times as stiff or heavy as in the model.

    What is ``usual`` is a factor of up to 2, or its inverse: many members differ so.
    """
    parts = old.fits.parts
    single = np.flatnonzero([not x.whole for x in parts])
    if old.state.part or not single.size:
        return
    ahead, dx = old.fits.by_parts(old.state, old.point.x)
    first = single[np.argsort(ahead[single], kind="stable")[:NEAREST]]
    price = float(np.log(single.size / first.size))
    for k in first.tolist():
        size, factor = ("greater", 4.0) if dx[k] > 0 else ("smaller", 0.25)
        kind, factor = (IMPRECISE, 1.0) if usual else ("wrong-member", factor)
        numbers = {"what": parts[k].of, "place": parts[k].place, "better": "" if usual else size}
        yield Mistake(kind, ("model",), partial(_scaled, part=k, factor=factor), numbers, price)


def wrong_unit(old: Explanation) -> Iterator[Mistake]:
    """Yield powers of ten on the stiffness or mass of groups that no parameter scales."""
    for k, part in enumerate(old.fits.parts if not old.state.part else ()):
        for power in THOUSANDS if part.whole else ():
            numbers = {"what": part.of, "place": part.place, "factor": 10.0**-power}
            change = partial(_scaled, part=k, factor=10.0**power)
            yield Mistake("wrong-unit", (f"{part.of} {part.place}",), change, numbers)
