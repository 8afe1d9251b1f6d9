"""Sensors of the data that are reversed or exchanged: in all data sets, in one, in all but one."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from modefront._typing import Floats
from modefront.diagnosis.evidence import OF_MODEL
from modefront.diagnosis.mistakes.record import (
    OFTEN,
    TRIED,
    USUAL,
    Change,
    Setting,
    Variant,
    changed,
    enumerated,
    mistake,
    one_of,
)
from modefront.diagnosis.student import loss


def parts(sets: tuple[str, ...]) -> list[tuple[list[int], str]]:
    """Return data sets in which a sensor may be wrong, with their names."""
    every = list(range(len(sets)))
    single = [[k] for k in every] if len(sets) > 1 else []
    without = [[j for j in every if j != k] for k in every] if len(sets) > 2 else []
    named = [
        (part, f"set{'s' * (len(part) > 1)} {enumerated([sets[k] for k in part])}")
        for part in (*single, *without)
    ]
    return [(every, "all data"), *named]


def permuted(sets: list[int], sensors: list[int], order: list[int], sign: float) -> Change:
    """Return the change that takes some sensors from others in some data sets."""

    def new(shape: Floats) -> Floats:
        to, of = (np.ix_(sets, range(shape.shape[1]), x) for x in (sensors, order))
        shape[to] = sign * shape[of]
        return shape

    return changed("shape", new)


@mistake(
    "reversed-sensor",
    OFTEN,
    "sensor {sensor} is reversed in {where}",
    "check the direction of {sensor}, and change the sign of its column, or of the direction in "
    "the model",
)
def reversed_sensor(setting: Setting) -> Iterator[Variant]:
    """Yield every sensor."""
    where = parts(setting.sets)
    price = one_of(len(where) * len(setting.measured))
    for s in setting.measured:
        for sets, name in where:
            numbers = {"sensor": setting.sensors[s], "where": name}
            change = permuted(sets, [s], [s], -1.0)
            yield Variant((setting.sensors[s], name), change, numbers, price)


@mistake(
    "exchanged-sensors",
    USUAL,
    "sensors {sensors} are exchanged in {where}",
    "check the cables of {sensors}, and exchange their columns or sensors",
)
def exchanged_sensors(setting: Setting) -> Iterator[Variant]:
    """Yield pairs of sensors, of many those after whose exchange residuals are the least."""
    where = parts(setting.sets)
    count = len(setting.measured)
    price = one_of(len(where) * count * (count - 1) / 2)
    for sets, name in where:
        gain = _gains(setting, sets)
        pairs = np.argwhere(np.triu(np.ones(gain.shape), 1) > 0)
        best = np.argsort(-gain[tuple(pairs.T)], kind="stable")
        for i, j in pairs[best][: TRIED // (1 if len(sets) == len(setting.sets) else 10)].tolist():
            s, t = setting.measured[i], setting.measured[j]
            names = setting.sensors[s], setting.sensors[t]
            numbers = {"sensors": enumerated(names), "where": name}
            yield Variant((*names, name), permuted(sets, [s, t], [t, s], 1.0), numbers, price)


def _gains(setting: Setting, sets: list[int]) -> Floats:
    """Return how much less residuals cost after each exchange, (sensors, sensors).

    Those from the model where all data sets have it, else those from what the sets have in common.
    """
    data, sensors, out = setting.state.data, setting.measured, []
    a = data.factors(data.mean)[sets]
    psi = (data.psi[sets] / np.where(a == 0, 1.0, a))[:, :, sensors]
    seen = data.seen[sets][:, :, sensors, None]
    for point in setting.points:
        model = point.beta[:, None] * point.chi
        target = (model if len(sets) == len(data.psi) else data.mean)[:, sensors]
        scale = point.sigma * data.motion[sensors, None]
        r = np.where(seen, psi[..., None] - target[:, None], 0.0)
        cost = loss(r / scale, OF_MODEL).mean(axis=0).sum(axis=0)
        own = np.diag(cost)
        out.append(own[:, None] + own - cost - cost.T)
    return np.asarray(np.max(out, axis=0))
