"""Nominal values that are off by powers of ten, and bounds that exclude what fits the data."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from modefront._typing import Floats
from modefront.diagnosis.evidence import State
from modefront.diagnosis.mistakes.record import RARE, USUAL, Mistake, Setting, one_of

POWERS = (1, -1, 2, -2, 3, -3, 6, -6, 9, -9)
"""Powers of ten by which a value is off."""

WIDER = 4.0
"""Factor by which a bound is moved away."""


def wrong_nominal_value(setting: Setting) -> Iterator[Mistake]:
    """Yield powers of ten on each positive parameter and its bounds."""
    state = setting.state
    price = one_of(USUAL, len(POWERS) * len(setting.parameters))
    for j, power in [(j, x) for j in np.flatnonzero(state.is_positive).tolist() for x in POWERS]:
        factor = np.ones(state.start.size)
        factor[j] = 10.0**power
        name, given = setting.parameters[j], float(state.start[j])
        numbers = {"name": name, "given": given, "better": given * 10.0**power}
        yield Mistake("nominal-value", (name,), partial(_scaled, factor=factor), price, numbers)


def _scaled(state: State, factor: Floats) -> State:
    start, lower, upper = (x * factor for x in (state.start, state.lower, state.upper))
    return replace(state, start=start, lower=lower, upper=upper)


def excluding_bound(setting: Setting) -> Iterator[Mistake]:
    """Yield bounds at which the fit ends, moved away."""
    state, theta = setting.state, setting.points[-1].theta
    room, price = state.upper - state.lower, one_of(RARE, 2 * theta.size)
    for side, bounds, away in (("lower", state.lower, -1.0), ("upper", state.upper, 1.0)):
        wider = np.where(state.is_positive, bounds * WIDER**away, bounds + away * WIDER * room)
        for j in np.flatnonzero(np.abs(theta - bounds) <= 1e-6 * room).tolist():
            name = setting.parameters[j]
            numbers = {"name": name, "side": side, "bound": float(bounds[j])}
            change = partial(_moved, side=side, j=j, bound=wider[j])
            yield Mistake("bound", (name, side), change, price, numbers)


def _moved(state: State, side: str, j: int, bound: float) -> State:
    values = getattr(state, side).copy()
    values[j] = bound
    return replace(state, **{side: values})
