"""Sensors of the data that are reversed or exchanged: in all data sets, in one, in all but one."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from modefront._typing import Floats
from modefront.diagnosis.evidence import OF_MODEL
from modefront.diagnosis.mistakes.record import (
    MANY,
    OFTEN,
    TRIED,
    USUAL,
    Change,
    Setting,
    Variant,
    changed,
    mistake,
    one_of,
    promising,
)
from modefront.diagnosis.student import loss
from modefront.findings.knowledge import enumeration


def parts(sets: tuple[str, ...]) -> list[tuple[list[int], str]]:
    """Return data sets in which a sensor may be wrong, with their names.

    In all, in one, or in two of three: of more sets, most are right.
    """
    every = list(range(len(sets)))
    some = [[k] for k in every] if len(sets) > 1 else []
    some += [[j for j in every if j != k] for k in every] if len(sets) == 3 else []
    named = [(part, enumeration([sets[k] for k in part], MANY)) for part in some]
    return [
        (every, "all data"),
        *((part, f"set{'s' * (len(part) > 1)} {names}") for part, names in named),
    ]


def permuted(sets: list[int], sensors: list[int], order: list[int], sign: float) -> Change:
    """Return the change that takes some sensors from others in some data sets."""

    def new(shape: Floats) -> Floats:
        to, of = (np.ix_(sets, range(shape.shape[1]), x) for x in (sensors, order))
        shape[to] = sign * shape[of]
        return shape

    return changed("shape", new)


@mistake("reversed-sensor", OFTEN)
def reversed_sensor(setting: Setting) -> Iterator[Variant]:
    """Yield every sensor; of many, those after whose reversal residuals are the least."""
    where, found = parts(setting.sets), []
    price = one_of(len(where) * len(setting.measured))
    for sets, name in where:
        gain = np.full(len(setting.measured), -np.inf)
        for psi, target, scale in _residuals(setting, sets):
            before, after = (_cost((x - target[:, None]) / scale) for x in (psi, -psi))
            gain = np.maximum(gain, before - after)
        for value, s in zip(gain.tolist(), setting.measured, strict=True):
            sensor = setting.sensors[s]
            numbers = {"sensor": sensor, "where": name}
            change = permuted(sets, [s], [s], -1.0)
            found.append((value, Variant((sensor, name), change, numbers, price)))
    yield from promising(found)


@mistake("exchanged-sensors", USUAL)
def exchanged_sensors(setting: Setting) -> Iterator[Variant]:
    """Yield pairs of sensors; of many, those after whose exchange residuals are the least."""
    where, found, count = parts(setting.sets), [], len(setting.measured)
    price = one_of(len(where) * count * (count - 1) / 2)
    for sets, name in where:
        gain = np.full((count, count), -np.inf)
        for psi, target, scale in _residuals(setting, sets):
            cost = np.array([_cost((psi - x[:, None, None]) / scale) for x in target.T]).T
            own = np.diag(cost)
            gain = np.maximum(gain, own[:, None] + own - cost - cost.T)
        pairs = np.argwhere(np.triu(np.ones(gain.shape), 1) > 0)
        best = np.argsort(-gain[tuple(pairs.T)], kind="stable")[:TRIED]
        for i, j in pairs[best].tolist():
            s, t = setting.measured[i], setting.measured[j]
            names = setting.sensors[s], setting.sensors[t]
            numbers = {"sensors": enumeration(names), "where": name}
            change = permuted(sets, [s, t], [t, s], 1.0)
            found.append((float(gain[i, j]), Variant((*names, name), change, numbers, price)))
    yield from promising(found)


def _residuals(setting: Setting, sets: list[int]) -> Iterator[tuple[Floats, Floats, Floats]]:
    """Yield shapes (modes, sets, sensors), what they should be (modes, sensors), and the scale.

    That is the model's where all data sets have the mistake, else what the sets have in common.
    """
    data, sensors = setting.state.data, setting.measured
    a = data.factors(data.mean)[sets]
    psi = np.where(data.seen[sets], data.psi[sets] / np.where(a == 0, 1.0, a), np.nan)
    for point in setting.points:
        of_model = len(sets) == len(data.psi)
        target = point.beta[:, None] * point.chi if of_model else data.mean
        scale = point.sigma * data.motion[sensors]
        yield psi[:, :, sensors].transpose(1, 0, 2), target[:, sensors], scale


def _cost(r: Floats) -> Floats:
    """Return the cost of residuals (modes, sets, sensors), mean over the sets, (sensors,)."""
    return np.asarray(loss(np.nan_to_num(r), OF_MODEL).mean(axis=1).sum(axis=0))
