"""Units and values of frequencies, damping and parameters; sets that disagree; foreign modes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from modefront._typing import Floats, Ints
from modefront.diagnosis.evidence import FREQUENCY, State, point_of
from modefront.diagnosis.measured import NOTHING, RIGID, log_frequencies, mac_values, median
from modefront.diagnosis.mistakes.record import (
    MANY,
    OFTEN,
    RARE,
    USUAL,
    Mistake,
    Setting,
    changed,
    one_of,
    without,
)
from modefront.findings.knowledge import enumeration
from modefront.pairing.match import assigned

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
            change = partial(_moved, side=side, j=j, bound=wider[j])
            yield Mistake("bound", (setting.parameters[j], side), change, price)


def _moved(state: State, side: str, j: int, bound: float) -> State:
    values = getattr(state, side).copy()
    values[j] = bound
    return replace(state, **{side: values})


WRONG = {"frequency": 0.2, "shape": 1.0}
"""Scale of values that are wrong: of logarithms of frequencies, and of shapes."""

PARTS = ("frequency", "damping", "shape", "std")

LOOKS = {
    2 * np.pi: ": rad/s for Hz",
    1 / (2 * np.pi): ": Hz for rad/s",
    60.0: ": per minute for Hz",
}
"""Causes of factors on the frequencies of a set."""


def set_factor(setting: Setting) -> Iterator[Mistake]:
    """Yield the median ratio of the frequencies of each set to those of the others."""
    f, sets = setting.state.data.frequency, setting.names.sets
    for k in setting.compared:
        ratios = np.log(f[k]) - median(np.log(np.delete(f, k, axis=0)))
        if np.isfinite(ratios).sum() < 2:
            continue
        factor = float(np.exp(np.nanmedian(ratios)))
        percent = 100 * (factor - 1)
        is_unit = abs(percent) > 40
        numbers = {
            "set": sets[k],
            "other": enumeration([*sets[:k], *sets[k + 1 :]], 2),
            "size": f"{factor:.3g} times" if is_unit else f"{percent:+.1f} % off",
            "looks": next((x for y, x in LOOKS.items() if abs(np.log(factor / y)) < 0.1), ""),
            "mend": "give all data sets in Hz"
            if is_unit
            else "the structure differed (mass, temperature, supports): update with one of the "
            "sets, or say by frequency_std how far frequencies scatter",
        }
        over = np.where(np.arange(len(sets)) == k, factor, 1.0)[:, None]
        change = changed("frequency", partial(np.multiply, 1 / over))
        yield Mistake("set-factor", (sets[k],), change, one_of(USUAL, len(sets)), numbers)


def other_numbers(setting: Setting) -> Iterator[Mistake]:
    """Yield the numbering of the modes of each set that makes it most like the others.

    Modes without anything in common keep their numbers.
    """
    data, sets, modes = setting.state.data, setting.names.sets, setting.names.modes
    for k in setting.compared:
        rest = replace(data, **{x: np.delete(getattr(data, x), k, axis=0) for x in PARTS})
        mac = mac_values(data.psi[k], data.seen[k], rest.mean.T)
        distance = np.minimum(4 * np.abs(np.log(data.frequency[k])[:, None] - rest.logs), 1.0)
        cost = np.nan_to_num(1 - mac) + np.nan_to_num(distance)
        known = np.isfinite(mac) | np.isfinite(distance)
        index = assigned(np.where(known, cost, 1.0 - np.eye(len(cost))))
        rows = np.flatnonzero(index != np.arange(index.size))
        if rows.size:
            wrong, right = (
                enumeration([str(modes[r]) for r in x], MANY) for x in (rows, index[rows])
            )
            numbers = {
                "set": sets[k],
                "other": enumeration([*sets[:k], *sets[k + 1 :]], 2),
                "modes": wrong,
                "of": right,
            }
            change = partial(_renumbered, k=k, index=index)
            price = one_of(USUAL, len(sets))
            yield Mistake("set-numbers", (sets[k],), change, price, numbers, True)


def _renumbered(state: State, k: int, index: Ints) -> State:
    parts = {name: getattr(state.data, name).copy() for name in PARTS}
    for name, values in parts.items():
        values[k, index] = getattr(state.data, name)[k]
    return replace(state, data=replace(state.data, **parts))


def odd_frequency(setting: Setting) -> Iterator[Mistake]:
    """Yield the frequency of each mode that differs most from those of other sets."""
    data = setting.state.data
    yield from _odd(setting, "frequency", np.abs(np.log(data.frequency) - data.logs))


def odd_shape(setting: Setting) -> Iterator[Mistake]:
    """Yield the shape of each mode that differs most from those of other sets."""
    data = setting.state.data
    away = ((data.psi - data.factors(data.mean) * data.mean) ** 2).sum(axis=2)
    yield from _odd(setting, "shape", np.where(data.seen.any(axis=2), away, np.nan))


def _odd(setting: Setting, part: str, away: Floats) -> Iterator[Mistake]:
    """Yield the values of single sets that are farthest ``away`` (sets, modes), one a mode.

    Of two sets nobody knows which one is wrong: both are yielded, and blame the mode.
    """
    sets, data = setting.names.sets, setting.state.data
    price = one_of(OFTEN, len(sets) * len(setting.names.modes))
    for r, mode in enumerate(setting.names.modes if len(sets) > 1 else ()):
        known = np.flatnonzero(np.isfinite(away[:, r]))
        for k in known[np.argsort(-away[known, r])][: 2 if known.size > 1 else 0].tolist():
            others, subject = [j for j in known.tolist() if j != k], [str(mode)]
            value, other = (
                data.frequency[k, r],
                np.exp(median(np.log(data.frequency[others, r, None]))[0]),
            )
            if len(others) > 1:
                subject.append(sets[k])
                names = enumeration([sets[j] for j in others], 3)
                who = f"set {sets[k]} disagrees with {names}"
                look = f"look at set {sets[k]} again, or leave out its"
            else:
                (first, second), look = known, "look at both again, or leave out the worse"
                value, other = data.frequency[second, r], data.frequency[first, r]
                who = f"sets {sets[second]} and {sets[first]} disagree"
            numbers = {
                **{"mode": mode, "who": who, "look": look},
                **{"f": float(value), "other": float(other)},
                "percent": float(100 * (value / other - 1)),
            }
            count = np.isfinite(getattr(data, part)[k, r]).sum()
            change = without(part, np.s_[k, r], count * (NOTHING + np.log(WRONG[part])))
            yield Mistake(f"odd-{part}", tuple(subject), change, price, numbers)


def foreign_mode(setting: Setting) -> Iterator[Mistake]:
    """Yield modes that the model does not have, or has not so high."""
    modes, (*_, (_, of_model, _)) = setting.names.modes, setting.wholes
    price = one_of(USUAL, len(modes))
    for r, f in enumerate(np.exp(setting.state.data.logs).tolist()):
        numbers = {"mode": modes[r], "at": "" if np.isnan(f) else f" at {f:.4g} Hz", "measured": f}
        numbers |= {"modes": of_model.size, "highest": float(of_model.max())}
        kind = "outside-model" if f > of_model.max() else "foreign-mode"
        yield Mistake(kind, (str(modes[r]),), partial(_foreign, r=r), price, numbers)


def _foreign(state: State, r: int) -> State:
    return replace(state, foreign=state.foreign | (np.arange(state.foreign.size) == r))


def later_mode(setting: Setting) -> Iterator[Mistake]:
    """Yield measured modes that are like model modes beyond those among which pairs are sought."""
    state, modes = setting.state, setting.names.modes
    for whole, own in zip(setting.wholes, setting.points, strict=True):
        free = point_of(replace(state, candidates=whole.frequency.size), whole)
        before, after = own.mac(state.data), free.mac(state.data)
        for r in np.flatnonzero(free.index >= state.candidates).tolist():
            later = int(free.index[r]) + 1
            numbers = {"later": later, "f": float(whole.frequency[later - 1])}
            numbers |= {
                "mac": float(after[r]),
                "best": float(before[r]),
                "spare": later - len(modes),
            }
            change = partial(replace, candidates=later)
            price = one_of(USUAL, whole.frequency.size - state.candidates)
            yield Mistake("beyond-candidates", (str(modes[r]),), change, price, numbers)
