"""Sensors that are reversed, exchanged, at another place or along another direction."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import combinations, permutations, product
from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront.diagnosis.evidence import OF_MODEL, SHAPE, State
from modefront.diagnosis.measured import NOTHING, loss
from modefront.diagnosis.measured import SHAPE as NOISE
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
from modefront.models.geometry import ALONG, Geometry, axis_name
from modefront.rounding import ACCUMULATED

FACTORS = (10.0, 0.1, 100.0, 0.01, 1e3, 1e-3, 9.81, 1 / 9.81, 2.0, 0.5)
"""Factors on the values of a sensor by another unit or sensitivity."""

NEAREST = 4
"""Places of each sensor that are tried: those where the model moves most as measured."""

OFTEN_SHARED = 2.0
"""Logarithm of how much likelier a sensor is at a wrong place where it shares it with another."""


def parts(sets: tuple[str, ...]) -> list[tuple[list[int], str]]:
    """Return data sets in which a sensor may be wrong, with their names.

    In all, in one, or in two of three: of more sets, most are right.
    """
    every = list(range(len(sets)))
    some = [[k] for k in every] if len(sets) > 1 else []
    some += [[j for j in every if j != k] for k in every] if len(sets) == 3 else []
    name = "set{} {}".format
    of_sets = [(x, name("s" * (len(x) > 1), enumeration([sets[k] for k in x]))) for x in some]
    return [(every, "all data"), *of_sets]


def wrong_factor(setting: Setting) -> Iterator[Mistake]:
    """Yield sensors that are reversed, or in other units."""
    where, names = parts(setting.names.sets), setting.names.sensors
    count = len(where) * len(setting.measured)
    reversed_, other = one_of(OFTEN, count), one_of(USUAL, len(FACTORS) * count)
    for (sets, name), s in product(where, setting.measured):
        for factor in (-1.0, *FACTORS):
            kind = "reversed-sensor" if factor < 0 else "sensor-factor"
            numbers = {"sensor": names[s], "where": name, "factor": factor}
            change = partial(_rescaled, sets=sets, s=s, factor=factor)
            price = reversed_ if factor < 0 else other
            yield Mistake(kind, (names[s], name), change, price, numbers)


def _rescaled(state: State, sets: list[int], s: int, factor: float) -> State:
    """Return the state with a sensor over a factor, and the cost of the values as they are given.

    A density of values is one over their unit, which changes with the factor and the mean square.
    """
    data, shape = state.data, state.data.shape.copy()
    shape[sets, :, s] /= factor
    new, count = replace(data, shape=shape), data.seen.sum(axis=2)
    if factor > 0:
        change = np.nan_to_num(shape[..., s] ** 2 - data.shape[..., s] ** 2)
        units = np.log1p(change / (np.maximum(count, 1) * data.size**2)) / 2 * count
        left_out = np.nansum(units) + data.seen[sets, :, s].sum() * np.log(factor)
        new = replace(new, left_out=data.left_out + left_out)
    return replace(state, data=new)


def exchanged_sensors(setting: Setting) -> Iterator[Mistake]:
    """Yield pairs of sensors, in all data sets or some."""
    where, names = parts(setting.names.sets), setting.names.sensors
    pairs = list(combinations(setting.measured, 2))
    price = one_of(USUAL, len(where) * len(pairs))
    for (s, t), (sets, name) in product(pairs, where):
        numbers = {"sensors": enumeration((names[s], names[t])), "where": name}
        change = changed("shape", partial(_exchanged, sets=sets, s=s, t=t))
        subject = names[s], names[t], name
        yield Mistake("exchanged-sensors", subject, change, price, numbers, True)


def _exchanged(shape: Floats, sets: list[int], s: int, t: int) -> Floats:
    for k in sets:
        shape[k, :, [s, t]] = shape[k, :, [t, s]]
    return shape


def copied_sensor(setting: Setting) -> Iterator[Mistake]:
    """Yield sensors that have the values of another one, digit by digit.

    A copy says nothing on its own: its values cost as much as those that fit as well as is usual.
    """
    shape, names = setting.state.data.shape, setting.names.sensors
    same = [
        (s, t)
        for s, t in permutations(setting.measured, 2)
        if np.array_equal(shape[:, :, s], shape[:, :, t], equal_nan=True) and shape[..., s].any()
    ]
    for s, t in same:
        sets = np.isfinite(shape[:, :, s]).sum(axis=0)
        of_model, of_noise = (sets > 0).sum(), np.maximum(sets - 1, 0).sum()
        usual = np.log(SHAPE) * of_model + np.log(NOISE) * of_noise + NOTHING * sets.sum()
        change, price = without("shape", np.s_[..., s], usual), one_of(OFTEN, len(same))
        numbers, subject = {"sensor": names[s], "other": names[t]}, sorted((names[s], names[t]))
        yield Mistake("copied-sensor", tuple(subject), change, price, numbers)


def shifted_values(setting: Setting) -> Iterator[Mistake]:
    """Yield rows of shapes, or all, in which a value is lost or too many, and the rest moved."""
    names, (K, _, n) = setting.names, setting.state.data.shape.shape
    where: dict[str, tuple[slice, slice]] = {"all data": np.s_[:, :]}
    for k, name in enumerate(names.sets):
        where |= {f"set {name}": np.s_[k : k + 1, :]} if K > 1 else {}
        for r, mode in enumerate(names.modes):
            where[f"mode {mode}" + f" of set {name}" * (K > 1)] = np.s_[k : k + 1, r : r + 1]
    price = one_of(USUAL, 2 * n * len(where))
    for name, start, (by, what) in product(where, range(n - 1), ((1, "lost"), (-1, "too many"))):
        numbers = {"where": name, "sensor": names.sensors[start], "what": what}
        change = changed("shape", partial(_moved, rows=where[name], start=start, by=by))
        yield Mistake("shifted-values", (name,), change, price, numbers, True)


def _moved(shape: Floats, rows: tuple[slice, slice], start: int, by: int) -> Floats:
    part = shape[rows]  # a view
    part[..., start:] = np.roll(part[..., start:], by, axis=-1)
    part[..., start if by > 0 else -1] = np.nan
    return shape


def _relocated(state: State, sensors: Sequence[int], **changed: Any) -> State:
    """Return the state with other ``sensor_nodes`` or ``sensor_directions`` of some sensors."""
    assert state.geometry is not None
    parts = {name: getattr(state.geometry, name).copy() for name in changed}
    for name, values in parts.items():
        values[sensors] = changed[name]
    geometry, rows = replace(state.geometry, **parts), state.rows.copy()
    weights = geometry.weights(geometry.sensor_nodes[sensors], geometry.sensor_directions[sensors])
    rows[sensors] = weights @ state.basis
    return replace(state, geometry=geometry, rows=rows)


def wrong_place(setting: Setting) -> Iterator[Mistake]:
    """Yield sensors at other nodes, directions kept; in a chain, at other degrees of freedom."""
    geometry, rows, data = setting.state.geometry, setting.state.rows, setting.state.data
    if geometry is None:
        return
    names, given, along = setting.names.sensors, geometry.sensor_nodes, geometry.sensor_directions
    can = np.diff(geometry.motion.indptr).reshape(-1, 3) > 0  # nodes x axes
    there = {s: np.flatnonzero(can[:, along[s] != 0].any(axis=1)) for s in setting.measured}
    price = one_of(USUAL, max(map(len, there.values()), default=0) * len(there))
    nearest: dict[tuple[int, int], None] = {}
    for point, solved in zip(setting.points, setting.solved, strict=True):
        used = np.flatnonzero(~setting.state.foreign)
        shapes = geometry.displacement(setting.state.basis @ solved.phi[:, point.pairs[used]])
        shapes *= point.beta[used, None, None]
        for s, nodes in there.items():
            x = np.where(data.known[used, s], data.mean[used, s], np.nan)[:, None]
            r = (shapes[:, nodes] @ along[s] - x) / (point.sigma * data.motion[s])
            cost = loss(np.nan_to_num(r), OF_MODEL).sum(axis=0)
            order = [k for k in nodes[np.argsort(cost, kind="stable")].tolist() if k != given[s]]
            nearest |= dict.fromkeys((s, k) for k in order[:NEAREST])
    for s, k in nearest:
        same = np.abs(rows - rows[s]).max(axis=1) <= ACCUMULATED * np.abs(rows[s]).max()
        others = [names[t] for t in np.flatnonzero(same).tolist() if t != s]
        numbers = {
            "sensor": names[s],
            "given": _place(geometry, given[s]),
            "place": _place(geometry, k),
            "too": f", where the model has {enumeration(others, MANY)} too" if others else "",
        }
        change, less = partial(_relocated, sensors=[s], sensor_nodes=k), OFTEN_SHARED * bool(others)
        yield Mistake("wrong-place", (names[s],), change, price - less, numbers)


def _place(geometry: Geometry, k: int) -> str:
    if len(geometry.axes) == 1:
        return f"degree of freedom {k}"
    return f"({', '.join(f'{x:.4g}' for x in geometry.nodes[k])})"


def wrong_direction(setting: Setting) -> Iterator[Mistake]:
    """Yield other directions: of single sensors, of all along an axis, of two axes exchanged."""
    geometry = setting.state.geometry
    if geometry is None or len(geometry.axes) == 1:
        return
    given, axes = geometry.sensor_directions, geometry.axes
    along = np.where(np.abs(given).max(axis=1) > ALONG, np.abs(given).argmax(axis=1), -1)
    members = {a: np.flatnonzero(along == a).tolist() for a in axes}
    single, several = one_of(OFTEN, 2 * len(axes) * len(setting.measured)), one_of(OFTEN, 12)
    found: list[tuple[float, list[int], Floats, str]] = []
    for (a, b), sign in product(permutations(axes, 2), (1.0, -1.0)):
        turned = sign * np.eye(3)[b] * given[members[a], a, None]
        if len(members[a]) > 1:
            found.append((several, members[a], turned, ""))
        pairs = zip(members[a], turned, strict=True)
        found += [(single, [s], new[None], "") for s, new in pairs]
        if a < b and sign > 0 and members[a] and members[b]:
            both, swap = members[a] + members[b], np.eye(3)
            swap[[a, b]] = swap[[b, a]]
            found.append((several, both, given[both] @ swap, f"{'xyz'[a]} and {'xyz'[b]}"))
    for price, some, new, two in found:
        sensors = tuple(setting.names.sensors[s] for s in some)
        numbers = {
            "sensors": enumeration(sensors, MANY),
            "given": two or axis_name(given[some[0]]),
            "better": " and ".join(two.split(" and ")[::-1]) or axis_name(new[0]),
            "s": "s" * (len(some) == 1),
            "turn": " in turn" * bool(two),
        }
        change = partial(_relocated, sensors=some, sensor_directions=new)
        yield Mistake("wrong-direction", sensors, change, price, numbers)


def counted_from_one(setting: Setting) -> Iterator[Mistake]:
    """Yield all sensors at the node, or the degree of freedom, before their own."""
    geometry = setting.state.geometry
    if geometry is None or (geometry.sensor_nodes == 0).any():
        return
    if geometry.sensor_directions.any(axis=1).all():
        every, nodes = list(range(geometry.sensor_nodes.size)), geometry.sensor_nodes - 1
        what = "degrees of freedom" if len(geometry.axes) == 1 else "nodes"
        change = partial(_relocated, sensors=every, sensor_nodes=nodes)
        yield Mistake("counted-from-one", (what,), change, one_of(USUAL, 1), {"what": what})
