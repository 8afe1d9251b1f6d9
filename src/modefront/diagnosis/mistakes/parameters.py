"""Nominal values that are off by powers of ten, and bounds that exclude what fits the data."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from modefront._typing import Floats
from modefront.diagnosis.evidence import State
from modefront.diagnosis.mistakes.record import RARE, USUAL, Setting, Variant, mistake, one_of

POWERS = (1, -1, 2, -2, 3, -3, 6, -6, 9, -9)
"""Powers of ten by which a value is off."""

WIDER = 4.0
"""Factor by which a bound is moved away."""


@mistake("nominal-value", USUAL)
def wrong_nominal_value(setting: Setting) -> Iterator[Variant]:
    """Yield powers of ten on each positive parameter and its bounds."""
    state = setting.state
    price = one_of(len(POWERS) * len(setting.parameters))
    for j, power in [(j, x) for j in np.flatnonzero(state.is_positive).tolist() for x in POWERS]:
        factor = np.ones(state.start.size)
        factor[j] = 10.0**power

        def change(state: State, factor: Floats = factor) -> State:
            start, lower, upper = (x * factor for x in (state.start, state.lower, state.upper))
            return replace(state, start=start, lower=lower, upper=upper)

        name, given = setting.parameters[j], float(state.start[j])
        numbers = {"name": name, "given": given, "better": given * 10.0**power}
        yield Variant((name,), change, numbers, price)


@mistake("bound", RARE)
def excluding_bound(setting: Setting) -> Iterator[Variant]:
    """Yield bounds at which the fit ends, moved away."""
    state, theta = setting.state, setting.points[-1].theta
    room = state.upper - state.lower
    for side, bounds, away in (("lower", state.lower, -1.0), ("upper", state.upper, 1.0)):
        new = np.where(state.is_positive, bounds * WIDER**away, bounds + away * WIDER * room)
        for j in np.flatnonzero(np.abs(theta - bounds) <= 1e-6 * room).tolist():

            def change(state: State, side: str = side, j: int = j, new: float = new[j]) -> State:
                values = getattr(state, side).copy()
                values[j] = new
                return replace(state, **{side: values})

            name = setting.parameters[j]
            numbers = {"name": name, "side": side, "bound": float(bounds[j])}
            yield Variant((name, side), change, numbers, one_of(2 * len(room)))
