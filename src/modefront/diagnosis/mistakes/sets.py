"""Data sets that contradict each other, and modes that the model does not have."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from modefront._typing import Floats, Ints
from modefront.diagnosis.evidence import State
from modefront.diagnosis.measured import assigned, mac_values, median
from modefront.diagnosis.mistakes.record import (
    MANY,
    OFTEN,
    USUAL,
    Setting,
    Variant,
    changed,
    mistake,
    one_of,
)
from modefront.diagnosis.student import NOTHING
from modefront.findings.knowledge import enumeration

WRONG = {"frequency": 0.2, "shape": 1.0}
"""Scale of values that are wrong: of logarithms of frequencies, and of shapes."""

PARTS = ("frequency", "damping", "shape", "std")

LOOKS = {
    2 * np.pi: ": rad/s for Hz",
    1 / (2 * np.pi): ": Hz for rad/s",
    60.0: ": per minute for Hz",
}
"""Causes of factors on the frequencies of a set."""


@mistake("set-factor", USUAL)
def set_factor(setting: Setting) -> Iterator[Variant]:
    """Yield the median ratio of the frequencies of each set to those of the others."""
    f = setting.state.data.frequency
    for k in setting.compared:
        ratios = np.log(f[k]) - median(np.log(np.delete(f, k, axis=0)))
        if np.isfinite(ratios).sum() < 2:
            continue
        factor = float(np.exp(np.nanmedian(ratios)))
        percent = 100 * (factor - 1)
        is_unit = abs(percent) > 40
        numbers = {
            "set": setting.sets[k],
            "other": setting.others(k),
            "size": f"{factor:.3g} times" if is_unit else f"{percent:+.1f} % off",
            "looks": next((x for y, x in LOOKS.items() if abs(np.log(factor / y)) < 0.1), ""),
            "mend": "give all data sets in Hz"
            if is_unit
            else "the structure differed (mass, temperature, supports): update with one of the "
            "sets, or say by frequency_std how far frequencies scatter",
        }

        def new(f: Floats, k: int = k, factor: float = factor) -> Floats:
            f[k] /= factor
            return f

        price = one_of(len(setting.sets))
        yield Variant((setting.sets[k],), changed("frequency", new), numbers, price)


@mistake("set-numbers", USUAL)
def other_numbers(setting: Setting) -> Iterator[Variant]:
    """Yield the numbering of the modes of each set that makes it most like the others.

    Modes without anything in common keep their numbers.
    """
    data = setting.state.data
    for k in setting.compared:
        rest = replace(data, **{x: np.delete(getattr(data, x), k, axis=0) for x in PARTS})
        mac = mac_values(data.psi[k], data.seen[k], rest.mean.T)
        distance = np.minimum(4 * np.abs(np.log(data.frequency[k])[:, None] - rest.logs), 1.0)
        cost = np.nan_to_num(1 - mac) + np.nan_to_num(distance)
        known = np.isfinite(mac) | np.isfinite(distance)
        index = assigned(np.where(known, cost, 1.0 - np.eye(len(cost))))
        rows = np.flatnonzero(index != np.arange(index.size))
        if not rows.size or np.unique(index).size < index.size:
            continue

        def change(state: State, k: int = k, index: Ints = index) -> State:
            parts = {name: getattr(state.data, name).copy() for name in PARTS}
            for name, values in parts.items():
                values[k, index] = getattr(state.data, name)[k]
            return replace(state, data=replace(state.data, **parts))

        modes, of = (
            enumeration([str(setting.modes[r]) for r in x], MANY) for x in (rows, index[rows])
        )
        numbers = {"set": setting.sets[k], "other": setting.others(k), "modes": modes, "of": of}
        yield Variant((setting.sets[k],), change, numbers, one_of(len(setting.sets)))


@mistake("odd-frequency", OFTEN)
def odd_frequency(setting: Setting) -> Iterator[Variant]:
    """Yield the frequency of each mode that differs most from those of other sets."""
    data = setting.state.data
    yield from _odd(setting, "frequency", np.abs(np.log(data.frequency) - data.logs))


@mistake("odd-shape", OFTEN)
def odd_shape(setting: Setting) -> Iterator[Variant]:
    """Yield the shape of each mode that differs most from those of other sets."""
    data = setting.state.data
    away = ((data.psi - data.factors(data.mean) * data.mean) ** 2).sum(axis=2)
    yield from _odd(setting, "shape", np.where(data.seen.any(axis=2), away, np.nan))


def _odd(setting: Setting, part: str, away: Floats) -> Iterator[Variant]:
    """Yield the values of single sets that are farthest ``away`` (sets, modes), one a mode.

    Of two sets nobody knows which one is wrong: both are yielded, and blame the mode.
    """
    price = one_of(len(setting.sets) * len(setting.modes))
    for r, mode in enumerate(setting.modes if len(setting.sets) > 1 else ()):
        known = np.flatnonzero(np.isfinite(away[:, r]))
        for k in known[np.argsort(-away[known, r])][: 2 if known.size > 1 else 0].tolist():

            def change(state: State, k: int = k, r: int = r) -> State:
                values = getattr(state.data, part).copy()
                count = float(np.isfinite(values[k, r]).sum())
                left_out = state.data.left_out + count * (NOTHING + np.log(WRONG[part]))
                values[k, r] = np.nan
                data = replace(state.data, left_out=left_out, **{part: values})
                return replace(state, data=data)

            others, odd = [j for j in known.tolist() if j != k], setting.sets[k]
            names = [setting.sets[j] for j in others]
            two = setting.sets[max(k, others[0])], setting.sets[min(k, others[0])]
            is_clear = len(others) > 1
            f = setting.state.data.frequency[:, r]
            value, other = float(f[k]), float(np.exp(median(np.log(f[others, None]))[0]))
            if not is_clear:
                value, other = float(f[known[1]]), float(f[known[0]])
            numbers = {
                "mode": mode,
                "who": f"set {odd} disagrees with {enumeration(names, 3)}"
                if is_clear
                else f"sets {two[0]} and {two[1]} disagree",
                "look": f"look at set {odd} again, or leave out its"
                if is_clear
                else "look at both again, or leave out the worse",
                **{"f": value, "other": other, "percent": 100 * (value / other - 1)},
            }
            yield Variant((str(mode), *([odd] if is_clear else [])), change, numbers, price)


@mistake("foreign-mode", USUAL)
def foreign_mode(setting: Setting) -> Iterator[Variant]:
    """Yield modes that the model does not have."""
    for r, mode in enumerate(setting.modes):

        def change(state: State, r: int = r) -> State:
            return replace(state, foreign=state.foreign | (np.arange(state.foreign.size) == r))

        f = np.exp(setting.state.data.logs[r])
        numbers = {"mode": mode, "at": "" if np.isnan(f) else f" at {f:.4g} Hz"}
        yield Variant((str(mode),), change, numbers, one_of(len(setting.modes)))
