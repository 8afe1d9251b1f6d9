"""Sensors of the data that are reversed or exchanged: in all data sets, in one, in all but one."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from modefront._typing import Floats
from modefront.diagnosis.mistakes.record import (
    MANY,
    OFTEN,
    TRIED,
    USUAL,
    Change,
    Mistake,
    Setting,
    changed,
    mismatch,
    one_of,
    promising,
)
from modefront.findings.knowledge import enumeration


def parts(sets: tuple[str, ...]) -> list[tuple[list[int], str]]:
    """Return data sets in which a sensor may be wrong, with their names.

    In all, in one, or in two of three: of more sets, most are right.
    """
    every = list(range(len(sets)))
    some = [[k] for k in every] if len(sets) > 1 else []
    some += [[j for j in every if j != k] for k in every] if len(sets) == 3 else []
    named = [(part, enumeration([sets[k] for k in part], MANY)) for part in some]
    of_sets = [(part, f"set{'s' * (len(part) > 1)} {names}") for part, names in named]
    return [(every, "all data"), *of_sets]


def permuted(sets: list[int], sensors: list[int], order: list[int], sign: float) -> Change:
    """Return the change that takes some sensors from others in some data sets."""

    def new(shape: Floats) -> Floats:
        to, of = (np.ix_(sets, range(shape.shape[1]), x) for x in (sensors, order))
        shape[to] = sign * shape[of]
        return shape

    return changed("shape", new)


def reversed_sensor(setting: Setting) -> Iterator[Mistake]:
    """Yield every sensor; of many, those after whose reversal residuals are the least."""
    where, found = parts(setting.names.sets), []
    price = one_of(OFTEN, len(where) * len(setting.measured))
    for sets, name in where:
        costs = _costs(setting, sets), _costs(setting, sets, -1.0)
        gain = np.max([np.diag(a - b) for a, b in zip(*costs, strict=True)], axis=0)
        for value, s in zip(gain.tolist(), setting.measured, strict=True):
            sensor, change = setting.names.sensors[s], permuted(sets, [s], [s], -1.0)
            numbers = {"sensor": sensor, "where": name}
            one = Mistake("reversed-sensor", (sensor, name), change, price, numbers)
            found.append((value, one))
    yield from promising(found)


def exchanged_sensors(setting: Setting) -> Iterator[Mistake]:
    """Yield pairs of sensors; of many, those after whose exchange residuals are the least."""
    where, found, count = parts(setting.names.sets), [], len(setting.measured)
    price = one_of(USUAL, len(where) * count * (count - 1) / 2)
    pairs = np.argwhere(np.triu(np.ones((count, count)), 1) > 0)
    for sets, name in where if len(pairs) else ():
        costs = [(np.diag(cost), cost) for cost in _costs(setting, sets)]
        gain = np.max([own[:, None] + own - x - x.T for own, x in costs], axis=0)
        best = np.argsort(-gain[tuple(pairs.T)], kind="stable")[:TRIED]
        for i, j in pairs[best].tolist():
            s, t = setting.measured[i], setting.measured[j]
            names = setting.names.sensors[s], setting.names.sensors[t]
            numbers = {"sensors": enumeration(names), "where": name}
            change = permuted(sets, [s, t], [t, s], 1.0)
            one = Mistake("exchanged-sensors", (*names, name), change, price, numbers)
            found.append((float(gain[i, j]), one))
    yield from promising(found)


def _costs(setting: Setting, sets: list[int], sign: float = 1.0) -> list[Floats]:
    """Return the cost of each sensor with a sign, beside what each should be, at each point.

    That is what the model has where all data sets have the mistake, else what the sets have in
    common.
    """
    data, some = setting.state.data, setting.measured
    a = data.factors(data.mean)[sets]
    psi = np.where(data.seen[sets], data.psi[sets] / np.where(a == 0, 1.0, a), np.nan)
    of_model = len(sets) == len(data.psi)
    return [
        mismatch(
            sign * psi[:, :, some],
            (point.beta[:, None] * point.chi if of_model else data.mean)[:, some],
            point.sigma * data.motion[some],
        )
        for point in setting.points
    ]
