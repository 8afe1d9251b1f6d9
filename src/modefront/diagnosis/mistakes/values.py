"""Units and values: of frequencies, of damping, of parameters and their bounds."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront.diagnosis.evidence import FREQUENCY, State
from modefront.diagnosis.measured import RIGID, log_frequencies
from modefront.diagnosis.mistakes.record import (
    OFTEN,
    RARE,
    USUAL,
    Mistake,
    Setting,
    changed,
    one_of,
)

RAD, G = 2 * np.pi, float(np.sqrt(9.81))

CONSISTENT = "give lengths, forces and masses in consistent units: m, N, kg or mm, N, t"

UNITS: Sequence[tuple[float, str, str]] = (
    (RAD, "they look like rad/s, 2π times Hz", "divide the column 'frequency' by 6.2832 (2π)"),
    (
        1 / RAD,
        "the model looks as if its matrices gave Hz for rad/s, or the data are divided by 2π twice",
        "see that eigenvalues of K and M are (rad/s)², and multiply the data by 6.2832 (2π) where "
        "they are not in Hz",
    ),
    (60.0, "they look like revolutions or cycles per minute", "divide 'frequency' by 60"),
    (
        G,
        "the model looks as if weight were given for mass, a factor of g = 9.81 on M",
        "divide masses and densities by 9.81",
    ),
    (
        1 / G,
        "the model looks as if stiffness were g = 9.81 times too great, or mass 9.81 too small",
        CONSISTENT,
    ),
    (10**1.5, "masses look like kg with stiffness in kN, or t with N", CONSISTENT),
    (10**-1.5, "masses look like t with stiffness in N, or kg with kN", CONSISTENT),
    (1e3, "E looks like MPa, or lengths like mm, where all else is in SI units", CONSISTENT),
    (1e-3, "lengths look like m where all else is in N, mm and t, or E like Pa", CONSISTENT),
    (10**4.5, "E looks like GPa where all else is in SI units", CONSISTENT),
    (10**-4.5, "E looks like Pa where it should be GPa", CONSISTENT),
    (1e6, "lengths look like mm with thicknesses and sections in m", CONSISTENT),
    (1e-6, "densities look like t/mm³ where all else is in SI units", CONSISTENT),
)
"""Measured frequencies over the model's, what makes them so, and what mends it."""


REACH = 0.25
"""Logarithm of a factor beside a known one that parameters make up for, as in a poor model."""


POWERS = (1, -1, 2, -2, 3, -3, 6, -6, 9, -9)
"""Powers of ten by which a value is off."""

WIDER = 4.0
"""Factor by which a bound is moved away."""


def frequency_factor(setting: Setting) -> Iterator[Mistake]:
    """Yield known factors on all frequencies, and others that pairs show."""
    price, known = one_of(1, len(UNITS)), np.log([factor for factor, _, _ in UNITS])
    found = [(price, *unit) for unit in UNITS]
    for factor in sorted(_ratios(setting)):
        if np.abs(known - np.log(factor)).min() >= REACH:
            looks = f"stiffness over mass is off by {factor**2:.3g}"
            mend = "check units, sections and masses, or the nominal values of the parameters"
            found.append((3 * price, factor, looks, mend))
    for price, factor, looks, mend in found:
        numbers = {"factor": factor, "looks": looks, "mend": mend}
        change = changed("frequency", partial(np.multiply, 1 / factor))
        total = price + one_of(OFTEN, 1)
        yield Mistake("frequency-factor", ("frequencies",), change, total, numbers)


def _ratios(setting: Setting) -> set[float]:
    """Return factors between measured and model frequencies: of pairs, and of modes in order."""
    logs, out = setting.state.data.logs, set()
    known = np.flatnonzero(np.isfinite(logs))
    for point, (_, f, _) in zip(setting.points, setting.wholes, strict=True):
        elastic = np.log(f[f > RIGID * f.max()])
        if known.size and elastic.size:
            ascending = np.sort(logs[known])
            of_pairs = np.median(logs[known] - log_frequencies(f)[point.index[known]])
            in_order = np.median(ascending[: elastic.size] - elastic[: known.size])
            out |= {of_pairs, in_order, *(ascending[0] - elastic[:3])}
    return {float(np.exp(round(float(value), 4))) for value in out}


QUANTITIES: Sequence[tuple[str, Callable[[Floats], Floats]]] = (
    ("periods in s", lambda f: 1 / f),
    ("eigenvalues in (rad/s)²", lambda f: np.sqrt(f) / RAD),
)
"""Quantities that are no frequencies, with what makes frequencies of them."""


def other_quantity(setting: Setting) -> Iterator[Mistake]:
    """Yield quantities that are no frequencies."""
    known = np.flatnonzero(np.isfinite(setting.state.data.logs))
    for quantity, new in QUANTITIES if known.size else ():
        given = np.exp(setting.state.data.logs[known[0]])
        numbers: dict[str, Any] = {"quantity": quantity, "mode": setting.names.modes[known[0]]}
        numbers |= {"given": float(given), "better": float(new(given))}
        change = changed("frequency", new)
        yield Mistake("other-quantity", ("frequencies",), change, one_of(RARE, 1), numbers)


def damping_in_percent(setting: Setting) -> Iterator[Mistake]:
    """Yield damping over 100."""
    known = setting.state.data.damping[np.isfinite(setting.state.data.damping)]
    if known.size:
        numbers = {"least": float(known.min()), "greatest": float(known.max())}
        change = changed("damping", lambda zeta: zeta / 100)
        yield Mistake("damping", ("damping",), change, one_of(OFTEN, 1), numbers)


SLIPS, FAR = (10.0, 0.1, 100.0, 0.01, 2.0, 0.5), 4.0
"""Factors on the frequency of a mode by a lost decimal point or aliasing, and the logarithm of the
range in which others are."""


def wrong_frequency(setting: Setting) -> Iterator[Mistake]:
    """Yield known factors on the frequency of each mode, and the one that the model has.

    Of the latter nothing is known: its price is the range that it may be in over the width of a
    normal distribution.
    """
    modes, logs = setting.names.modes, setting.state.data.logs
    known = one_of(OFTEN, len(SLIPS) * len(modes))
    unknown = one_of(OFTEN, FAR / (FREQUENCY * np.sqrt(2 * np.pi)) * len(modes))
    for r in np.flatnonzero(np.isfinite(logs)).tolist():
        found = [(known, factor, f", and {1 / factor:g} times it would fit") for factor in SLIPS]
        for point, (_, f, _) in zip(setting.points[::-1], setting.wholes[::-1], strict=True):
            q, mac = int(point.index[r]), point.mac(setting.state.data)[r]
            found.append((unknown, float(np.exp(logs[r] - log_frequencies(f)[q])), ""))
            alike = "" if np.isnan(mac) else f" (MAC {mac:.2f})"
            numbers = {"model": q + 1, "f": float(f[q]), "alike": alike}
            numbers["measured"] = float(np.exp(logs[r]))
        for price, factor, looks in found:
            over = np.where(np.arange(len(modes)) == r, factor, 1.0)
            change = changed("frequency", partial(np.multiply, 1 / over))
            subject, said = (str(modes[r]),), numbers | {"looks": looks}
            yield Mistake("far-from-model", subject, change, price, said)


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
