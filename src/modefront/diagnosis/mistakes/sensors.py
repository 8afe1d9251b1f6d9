"""Sensors that are reversed, exchanged, at another place or along another direction."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import permutations, product
from typing import Any

import numpy as np
import scipy.sparse

from modefront._typing import Floats, Ints
from modefront.diagnosis.evidence import SHAPE, State
from modefront.diagnosis.measured import SHAPE as NOISE
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
from modefront.diagnosis.notes import ALONG, axis_name
from modefront.findings.knowledge import enumeration
from modefront.models.geometry import Geometry
from modefront.rounding import ACCUMULATED, TINY

FACTORS = (10.0, 0.1, 100.0, 0.01, 1e3, 1e-3, 9.81, 1 / 9.81, 2.0, 0.5)
"""Factors on the values of a sensor by another unit or sensitivity."""

NEAREST = 4
"""Places of each sensor that are tried: those that promise most."""

OFTEN_SHARED = 2.0
"""Logarithm of how much likelier a sensor is at a wrong place where it shares it with another."""


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


def wrong_factor(setting: Setting) -> Iterator[Mistake]:
    """Yield for each sensor the factor of wrong units that is nearest to what the others say."""
    data, where, found = setting.state.data, parts(setting.names.sets), []
    price = one_of(USUAL, len(FACTORS) * len(where) * len(setting.measured))
    for (sets, name), point in product(where, setting.points):
        x, seen = data.psi[sets], data.seen[sets]
        of_model = len(sets) == len(data.psi)
        t = seen * (point.beta[:, None] * point.chi if of_model else data.mean)
        square = (t**2).sum(axis=2, keepdims=True) - t**2
        along = (x * t).sum(axis=2, keepdims=True) - x * t
        y = t * np.divide(along, square, out=np.zeros(t.shape), where=square > 0)
        slope = (x * y).sum(axis=(0, 1)) / np.maximum((y**2).sum(axis=(0, 1)), TINY)
        gain = (slope - 1) ** 2 * (y**2).sum(axis=(0, 1))
        for s in np.flatnonzero(slope > 0).tolist():
            factor = min(FACTORS, key=lambda each: abs(np.log(each / slope[s])))
            numbers = {"sensor": setting.names.sensors[s], "where": name, "factor": factor}
            change = partial(_rescaled, sets=sets, s=s, factor=factor)
            subject = setting.names.sensors[s], name
            found.append((gain[s], Mistake("sensor-factor", subject, change, price, numbers)))
    yield from promising(found)


def _rescaled(state: State, sets: list[int], s: int, factor: float) -> State:
    """Return the state with a sensor over a factor, and the cost of the values as they are given.

    A density of values is one over their unit, which changes with the factor and the mean square.
    """
    shape = state.data.shape.copy()
    shape[sets, :, s] /= factor
    new = replace(state.data, shape=shape)
    units = np.log(new.size / state.data.size) * new.seen.sum(axis=2)
    left_out = np.nansum(units) + new.seen[sets, :, s].sum() * np.log(factor)
    return replace(state, data=replace(new, left_out=new.left_out + float(left_out)))


def copied_sensor(setting: Setting) -> Iterator[Mistake]:
    """Yield sensors that have the values of another one, digit by digit.

    A copy says nothing on its own: its values cost as much as those that fit exactly.
    """
    shape, names = setting.state.data.shape, setting.names.sensors
    same = [
        (s, t)
        for s, t in permutations(setting.measured, 2)
        if np.array_equal(shape[:, :, s], shape[:, :, t], equal_nan=True) and shape[..., s].any()
    ]
    for s, t in same:
        numbers = {"sensor": names[s], "other": names[t]}
        change = partial(_without, s=s)
        yield Mistake(
            "copied-sensor", (names[s], names[t]), change, one_of(OFTEN, len(same)), numbers
        )


def _without(state: State, s: int) -> State:
    data, shape = state.data, state.data.shape.copy()
    seen = data.seen[:, :, s].sum(axis=0)
    exact = np.log(SHAPE) * (seen > 0).sum() + np.log(NOISE) * np.maximum(seen - 1, 0).sum()
    shape[:, :, s] = np.nan
    return replace(state, data=replace(data, shape=shape, left_out=data.left_out + float(exact)))


def shifted_values(setting: Setting) -> Iterator[Mistake]:
    """Yield rows of shapes, or all, in which a value is lost or too many, and the rest moved.

    Where it begins is what makes the shapes most like those of the model, by their MAC.
    """
    data, (K, m, n) = setting.state.data, setting.state.data.shape.shape
    every = list(range(K)), list(range(m)), "all data"
    rows = [
        ([k], [r], f"mode {mode}" + f" of set {name}" * (K > 1))
        for k, name in enumerate(setting.names.sets)
        for r, mode in enumerate(setting.names.modes)
    ]
    for by, point in product((1, -1), setting.points):
        ahead = np.roll(point.chi, -by, axis=1)
        for sets, modes, name in (every, *rows):
            x, seen = data.psi[np.ix_(sets, modes)], data.seen[np.ix_(sets, modes)]
            cross, size = (
                _joined(seen * a, seen * b)
                for a, b in (
                    (x * point.chi[modes], x * ahead[modes]),
                    (point.chi[modes] ** 2, ahead[modes] ** 2),
                )
            )
            mac = np.divide(cross**2, size, out=np.zeros(size.shape), where=size > 0)
            start = int(np.argmax(mac.sum(axis=(0, 1))[:-1]))
            change = changed("shape", partial(_moved, rows=np.ix_(sets, modes), start=start, by=by))
            numbers = {
                "where": name,
                "sensor": setting.names.sensors[start],
                "what": "lost" if by > 0 else "too many",
            }
            price = one_of(USUAL, 2 * n * (1 + len(rows)))
            yield Mistake("shifted-values", (name,), change, price, numbers)


def _joined(a: Floats, b: Floats) -> Floats:
    """Return sums along the last axis of a up to each place and of b from there on."""
    return np.asarray(np.cumsum(a, axis=-1) - a + np.cumsum(b[..., ::-1], axis=-1)[..., ::-1])


def _moved(shape: Floats, rows: tuple[Ints, ...], start: int, by: int) -> Floats:
    part = shape[rows]
    new = part.copy()
    new[..., start:] = np.nan
    if by > 0:
        new[..., start + 1 :] = part[..., start:-1]
    else:
        new[..., start:-1] = part[..., start + 1 :]
    shape[rows] = new
    return shape


def at_rows(state: State, sensors: Sequence[int], rows: scipy.sparse.csr_array) -> State:
    """Return the state in which sensors have other weights (sensors, N)."""
    assert state.selection is not None
    ones = np.ones(len(sensors)), (sensors, np.arange(len(sensors)))
    place = scipy.sparse.csr_array(ones, shape=(state.selection.shape[0], len(sensors)))
    difference = place @ (rows - state.selection[list(sensors)])
    return replace(state, selection=(state.selection + difference).tocsr())


def relocated(state: State, sensors: Sequence[int], **changed: Any) -> State:
    """Return the state with other ``sensor_nodes`` or ``sensor_directions`` of some sensors."""
    assert state.geometry is not None
    parts = {name: getattr(state.geometry, name).copy() for name in changed}
    for name, values in parts.items():
        values[sensors] = changed[name]
    geometry = replace(state.geometry, **parts)
    places = geometry.sensor_nodes[sensors], geometry.sensor_directions[sensors]
    return replace(at_rows(state, sensors, geometry.weights(*places)), geometry=geometry)


def in_space(setting: Setting) -> Geometry | None:
    """Return the geometry of a model whose nodes move along several axes."""
    geometry = setting.state.geometry
    return geometry if geometry is not None and len(geometry.axes) > 1 else None


def _gain(setting: Setting, s: int, rows: scipy.sparse.csr_array) -> Floats:
    """Return by how much the cost falls with sensor s at other rows (places, N), (places,)."""
    data, out = setting.state.data, []
    used = data.known[:, s] & ~setting.state.foreign
    x = data.mean[None, used, s, None]
    for point, whole in zip(setting.points, setting.wholes, strict=True):
        beta = point.beta[used, None]
        there = beta * (rows @ whole.Phi[:, point.index[used]]).T
        targets = np.column_stack([beta * point.chi[used, s, None], there])
        costs = mismatch(x, targets, point.sigma * data.motion[[s]])[0]
        out.append(costs[0] - costs[1:])
    return np.asarray(np.max(out, axis=0))


def wrong_place(setting: Setting) -> Iterator[Mistake]:
    """Yield sensors at other nodes, directions kept; in a chain, at other degrees of freedom."""
    selection, geometry = setting.state.selection, in_space(setting)
    if selection is None:
        return
    found: list[tuple[float, int, int, int]] = []
    count = 0
    for s in setting.measured:
        rows, place = _rows(setting, s)
        moves = abs(rows).sum(axis=1) > 0
        if moves.any() and selection[[s]].nnz:
            count = max(count, int(moves.sum()))
            gains = np.where(moves, _gain(setting, s, rows), -np.inf)
            best = [k for k in np.argsort(-gains)[:NEAREST].tolist() if moves[k] and k != place]
            found += [(float(gains[k]), s, place, k) for k in best]
    products = (selection @ selection.T).toarray()
    squares = np.diag(products)
    is_same = np.abs(squares[:, None] + squares - 2 * products) <= ACCUMULATED * squares
    price, names = one_of(USUAL, count * len(setting.measured)), setting.names.sensors
    for _, s, place, k in sorted(found, key=lambda each: -each[0])[:TRIED]:
        others = [names[t] for t in np.flatnonzero(is_same[s]).tolist() if t != s]
        numbers = {
            "sensor": names[s],
            "given": _place(geometry, place),
            "place": _place(geometry, k),
            "too": f", where the model has {enumeration(others, MANY)} too" if others else "",
        }
        change = partial(relocated, sensors=[s], sensor_nodes=k)
        if geometry is None:
            change = partial(at_rows, sensors=[s], rows=_rows(setting, s)[0][[k]])
        less = OFTEN_SHARED if others else 0.0
        yield Mistake("wrong-place", (names[s],), change, price - less, numbers)


def _rows(setting: Setting, s: int) -> tuple[scipy.sparse.csr_array, int]:
    """Return the weights (places, N) that sensor s has at each place, and the place of its own."""
    geometry, selection = in_space(setting), setting.state.selection
    if geometry is not None:
        along = np.tile(geometry.sensor_directions[s], (len(geometry.nodes), 1))
        return geometry.weights(np.arange(len(along)), along), int(geometry.sensor_nodes[s])
    assert selection is not None
    own = selection[[s]]
    place = int(own.indices[0]) if own.nnz else 0
    return (own.sum() * scipy.sparse.eye_array(own.shape[1])).tocsr(), place


def _place(geometry: Geometry | None, k: int) -> str:
    if geometry is None:
        return f"degree of freedom {k}"
    return f"({', '.join(f'{x:.4g}' for x in geometry.nodes[k])})"


def wrong_direction(setting: Setting) -> Iterator[Mistake]:
    """Yield other directions: of single sensors, of all along an axis, of two axes exchanged."""
    geometry = in_space(setting)
    if geometry is None or setting.state.selection is None:
        return
    given, axes = geometry.sensor_directions, geometry.axes
    along = np.where(np.abs(given).max(axis=1) > ALONG, np.abs(given).argmax(axis=1), -1)
    members = {a: np.flatnonzero(along == a).tolist() for a in axes}
    single, several = one_of(OFTEN, 2 * len(axes) * len(setting.measured)), one_of(OFTEN, 12)
    found = []
    for a, b in [(a, b) for a in axes for b in axes if a != b and members[a]]:
        for new in (np.eye(3)[b], -np.eye(3)[b]):
            turned = new * given[members[a], a, None]
            if len(members[a]) > 1:
                yield _turned(setting, members[a], turned, several)
            for s, direction in zip(members[a], turned, strict=True):
                rows = geometry.weights(geometry.sensor_nodes[[s]], direction[None])
                one = _turned(setting, [s], direction[None], single)
                found.append((float(_gain(setting, s, rows)[0]), one))
    yield from promising(found)
    for a, b in [(a, b) for a in axes for b in axes if a < b and members[a] and members[b]]:
        both, swap = members[a] + members[b], np.eye(3)
        swap[[a, b]] = swap[[b, a]]
        names = f"{'xyz'[a]} and {'xyz'[b]}", f"{'xyz'[b]} and {'xyz'[a]}"
        yield _turned(setting, both, given[both] @ swap, several, names)


def _turned(
    setting: Setting,
    some: list[int],
    new: Floats,
    price: float,
    names: tuple[str, str] | None = None,
) -> Mistake:
    """Return the mistake of sensors that measure along ``new`` (sensors, 3) in truth."""
    assert setting.state.geometry is not None
    given = setting.state.geometry.sensor_directions
    before, after = names or (axis_name(given[some[0]]), axis_name(new[0]))
    sensors = tuple(setting.names.sensors[s] for s in some)
    numbers = {
        "sensors": enumeration(sensors, MANY),
        "given": before,
        "better": after,
        "s": "s" * (len(some) == 1),
        "turn": " in turn" if names else "",
    }
    change = partial(relocated, sensors=some, sensor_directions=new)
    return Mistake("wrong-direction", sensors, change, price, numbers)


def counted_from_one(setting: Setting) -> Iterator[Mistake]:
    """Yield all sensors at the node, or the degree of freedom, before their own."""
    geometry, selection = in_space(setting), setting.state.selection
    if selection is None:
        return
    every = list(range(selection.shape[0]))
    if geometry is not None:
        if (geometry.sensor_nodes == 0).any() or not geometry.sensor_directions.any(axis=1).all():
            return
        change = partial(relocated, sensors=every, sensor_nodes=geometry.sensor_nodes - 1)
    else:
        first = selection[:, [0]]
        if first.nnz or not selection.nnz:
            return
        shifted = scipy.sparse.hstack([selection[:, 1:], first], format="csr")
        change = partial(at_rows, sensors=every, rows=shifted)
    what = "degrees of freedom" if geometry is None else "nodes"
    yield Mistake("counted-from-one", (what,), change, one_of(USUAL, 1), {"what": what})
