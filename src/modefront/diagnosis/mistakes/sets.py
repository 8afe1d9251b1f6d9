"""Data sets that contradict each other, and modes that the model does not have."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from modefront._typing import Floats, Ints
from modefront.diagnosis.evidence import State, point_of
from modefront.diagnosis.measured import NOTHING, mac_values, median
from modefront.diagnosis.mistakes.record import (
    MANY,
    OFTEN,
    USUAL,
    Mistake,
    Setting,
    changed,
    one_of,
    without,
)
from modefront.findings.knowledge import enumeration
from modefront.pairing.match import assigned

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
            "other": _others(sets, k),
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


def _others(sets: tuple[str, ...], k: int) -> str:
    """Return the names of the data sets besides one."""
    return enumeration([*sets[:k], *sets[k + 1 :]], 2)


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
            numbers = {"set": sets[k], "other": _others(sets, k), "modes": wrong, "of": right}
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
