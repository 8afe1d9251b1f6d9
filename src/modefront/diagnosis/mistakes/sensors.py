"""Sensors that are reversed, exchanged, at another place or along another direction."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import permutations, product
from typing import Any

import numpy as np
import scipy.sparse

from modefront._typing import Floats
from modefront.diagnosis.evidence import OF_MODEL, SHAPE, State
from modefront.diagnosis.measured import NOTHING, loss
from modefront.diagnosis.measured import SHAPE as NOISE
from modefront.diagnosis.mistakes.record import (
    MANY,
    OFTEN,
    TRIED,
    USUAL,
    Mistake,
    Setting,
    changed,
    mismatch,
    one_of,
    promising,
    without,
)
from modefront.findings.knowledge import enumeration
from modefront.models.geometry import ALONG, Geometry, axis_name
from modefront.rounding import ACCUMULATED

FACTORS = (10.0, 0.1, 100.0, 0.01, 1e3, 1e-3, 9.81, 1 / 9.81, 2.0, 0.5)
"""Factors on the values of a sensor by another unit or sensitivity."""

NEAREST = 4
"""Places of each sensor, or beginnings of a row, that are tried: those that promise most."""

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


def _beside(setting: Setting, sets: list[int]) -> list[tuple[Floats, Floats, Floats]]:
    """Return shapes (sets, modes, n) of measured sensors, what they should be, and their scale.

    They should be what the model has where all data sets have a mistake, else what the sets have in
    common; for each point.
    """
    data, some = setting.state.data, setting.measured
    a = data.factors(data.mean)[sets]
    x = np.where(data.seen[sets], data.psi[sets] / np.where(a == 0, 1.0, a), np.nan)[..., some]
    return [
        (
            x,
            (each.beta[:, None] * each.chi if len(sets) == len(data.psi) else data.mean)[:, some],
            each.sigma * data.motion[some],
        )
        for each in setting.points
    ]


def wrong_factor(setting: Setting) -> Iterator[Mistake]:
    """Yield sensors that are reversed or in other units, those first by which the cost falls most.

    What a sensor should have is said by the others, as it would change the scale of the shape.
    """
    where, names = parts(setting.names.sets), setting.names.sensors
    count = len(where) * len(setting.measured)
    for kind, factors, price in (
        ("reversed-sensor", (-1.0,), one_of(OFTEN, count)),
        ("sensor-factor", FACTORS, one_of(USUAL, len(FACTORS) * count)),
    ):
        found = []
        for sets, name in where:
            for x, t, scale in _beside(setting, sets):
                xt, tt = np.nan_to_num(x * t), np.isfinite(x) * t**2
                others, square = (y.sum(axis=2, keepdims=True) - y for y in (xt, tt))
                y = t * np.divide(others, square, out=np.zeros(square.shape), where=square > 0)
                r = np.nan_to_num(x / np.reshape([1.0, *factors], (-1, 1, 1, 1)) - y) / scale
                before, *after = loss(r, OF_MODEL).mean(axis=1).sum(axis=1)
                for factor, cost in zip(factors, after, strict=True):
                    for s, gain in zip(setting.measured, (before - cost).tolist(), strict=True):
                        numbers = {"sensor": names[s], "where": name, "factor": factor}
                        change = partial(_rescaled, sets=sets, s=s, factor=factor)
                        one = Mistake(kind, (names[s], name), change, price, numbers)
                        found.append((gain, one))
        yield from promising(found)


def _rescaled(state: State, sets: list[int], s: int, factor: float) -> State:
    """Return the state with a sensor over a factor, and the cost of the values as they are given.

    A density of values is one over their unit, which changes with the factor and the mean square.
    """
    shape = state.data.shape.copy()
    shape[sets, :, s] /= factor
    new = replace(state.data, shape=shape)
    units = np.log(new.size / state.data.size) * new.seen.sum(axis=2)
    left_out = np.nansum(units) + new.seen[sets, :, s].sum() * np.log(abs(factor))
    return replace(state, data=replace(new, left_out=new.left_out + float(left_out)))


def exchanged_sensors(setting: Setting) -> Iterator[Mistake]:
    """Yield pairs of sensors; of many, those after whose exchange residuals are the least."""
    where, found, count = parts(setting.names.sets), [], len(setting.measured)
    price = one_of(USUAL, len(where) * count * (count - 1) / 2)
    pairs = np.argwhere(np.triu(np.ones((count, count)), 1) > 0)
    for sets, name in where if len(pairs) else ():
        costs = [mismatch(*each) for each in _beside(setting, sets)]
        gain = np.max([x.diagonal()[:, None] + x.diagonal() - x - x.T for x in costs], axis=0)
        best = np.argsort(-gain[tuple(pairs.T)], kind="stable")[:TRIED]
        for i, j in pairs[best].tolist():
            s, t = setting.measured[i], setting.measured[j]
            names = setting.names.sensors[s], setting.names.sensors[t]
            numbers = {"sensors": enumeration(names), "where": name}
            change = changed("shape", partial(_exchanged, sets=sets, s=s, t=t))
            one = Mistake("exchanged-sensors", (*names, name), change, price, numbers, True)
            found.append((float(gain[i, j]), one))
    yield from promising(found)


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
    """Yield rows of shapes, or all, in which a value is lost or too many, and the rest moved.

    Where it begins is what makes each shape most like a mode of the model, by the sum of their MAC.
    """
    state, names, found = setting.state, setting.names, []
    data, (K, _, n) = state.data, state.data.shape.shape
    where: dict[str, tuple[slice, slice]] = {"all data": np.s_[:, :]}
    for k, name in enumerate(names.sets):
        where |= {f"set {name}": np.s_[k : k + 1, :]} if K > 1 else {}
        for r, mode in enumerate(names.modes):
            where[f"mode {mode}" + f" of set {name}" * (K > 1)] = np.s_[k : k + 1, r : r + 1]
    price = one_of(USUAL, 2 * n * len(where))
    for (by, what), whole in product(((1, "lost"), (-1, "too many")), setting.wholes):
        phi = (whole.Phi if state.selection is None else state.selection @ whole.Phi).T
        for name, rows in where.items():
            x, seen = (y[rows].reshape(-1, 1, n) for y in (data.psi, data.seen))
            products = (x * phi, x * np.roll(phi, -by, axis=1))
            squares = (seen * phi**2, seen * np.roll(phi, -by, axis=1) ** 2)
            cross, size = (
                np.cumsum(own, axis=-1) - own + np.cumsum(moved[..., ::-1], axis=-1)[..., ::-1]
                for own, moved in (products, squares)
            )
            mac = np.divide(cross**2, size, out=np.zeros(size.shape), where=size > 0)
            likeness = mac.max(axis=1).sum(axis=0)
            for start in np.argsort(-likeness[:-1])[:NEAREST].tolist():
                numbers = {"where": name, "sensor": names.sensors[start], "what": what}
                change = changed("shape", partial(_moved, rows=rows, start=start, by=by))
                one = Mistake("shifted-values", (name,), change, price, numbers, True)
                found.append((float(likeness[start] - likeness[-1]), one))
    yield from promising(found)


def _moved(shape: Floats, rows: tuple[slice, slice], start: int, by: int) -> Floats:
    part = shape[rows]  # a view
    part[..., start:] = np.roll(part[..., start:], by, axis=-1)
    part[..., start if by > 0 else -1] = np.nan
    return shape


def relocated(state: State, sensors: Sequence[int], **changed: Any) -> State:
    """Return the state with other ``sensor_nodes`` or ``sensor_directions`` of some sensors."""
    assert state.geometry is not None
    assert state.selection is not None
    parts = {name: getattr(state.geometry, name).copy() for name in changed}
    for name, values in parts.items():
        values[sensors] = changed[name]
    geometry, chosen = replace(state.geometry, **parts), list(sensors)
    rows = geometry.weights(geometry.sensor_nodes[chosen], geometry.sensor_directions[chosen])
    order = np.arange(state.selection.shape[0])
    order[chosen] = order.size + np.arange(len(chosen))
    selection = scipy.sparse.csr_array(scipy.sparse.vstack([state.selection, rows]).tocsr()[order])
    return replace(state, geometry=geometry, selection=selection)


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
    selection, geometry = setting.state.selection, setting.state.geometry
    if selection is None or geometry is None:
        return
    products = (selection @ selection.T).toarray()
    squares, names = np.diag(products), setting.names.sensors
    is_same = np.abs(squares[:, None] + squares - 2 * products) <= ACCUMULATED * squares
    found, count, nodes = [], 0, np.arange(len(geometry.nodes))
    for s in setting.measured:
        rows = geometry.weights(nodes, np.tile(geometry.sensor_directions[s], (nodes.size, 1)))
        moves = abs(rows).sum(axis=1) > 0
        count = max(count, int(moves.sum()))
        gains = np.where(moves, _gain(setting, s, rows), -np.inf)
        gains[geometry.sensor_nodes[s]] = -np.inf
        best = np.argsort(-gains)[:NEAREST]
        found += [(float(gains[k]), s, k) for k in best[gains[best] > -np.inf].tolist()]
    price = one_of(USUAL, count * len(setting.measured))
    for _, s, k in sorted(found, key=lambda each: -each[0])[:TRIED]:
        others = [names[t] for t in np.flatnonzero(is_same[s]).tolist() if t != s]
        numbers = {
            "sensor": names[s],
            "given": _place(geometry, geometry.sensor_nodes[s]),
            "place": _place(geometry, k),
            "too": f", where the model has {enumeration(others, MANY)} too" if others else "",
        }
        change, less = partial(relocated, sensors=[s], sensor_nodes=k), OFTEN_SHARED * bool(others)
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
    found: list[tuple[float, list[int], Floats, str]] = []
    for (a, b), sign in product(permutations(axes, 2), (1.0, -1.0)):
        turned = sign * np.eye(3)[b] * given[members[a], a, None]
        if len(members[a]) > 1:
            found.append((np.inf, members[a], turned, ""))
        for s, new in zip(members[a], turned, strict=True):
            rows = geometry.weights(geometry.sensor_nodes[[s]], new[None])
            found.append((float(_gain(setting, s, rows)[0]), [s], new[None], ""))
        if a < b and sign > 0 and members[a] and members[b]:
            both, swap = members[a] + members[b], np.eye(3)
            swap[[a, b]] = swap[[b, a]]
            found.append((np.inf, both, given[both] @ swap, f"{'xyz'[a]} and {'xyz'[b]}"))
    single, several = one_of(OFTEN, 2 * len(axes) * len(setting.measured)), one_of(OFTEN, 12)
    for gain, some, new, two in sorted(found, key=lambda each: -each[0])[: 2 * TRIED]:
        sensors = tuple(setting.names.sensors[s] for s in some)
        numbers = {
            "sensors": enumeration(sensors, MANY),
            "given": two or axis_name(given[some[0]]),
            "better": " and ".join(two.split(" and ")[::-1]) or axis_name(new[0]),
            "s": "s" * (len(some) == 1),
            "turn": " in turn" * bool(two),
        }
        change = partial(relocated, sensors=some, sensor_directions=new)
        price = several if np.isinf(gain) else single
        yield Mistake("wrong-direction", sensors, change, price, numbers)


def counted_from_one(setting: Setting) -> Iterator[Mistake]:
    """Yield all sensors at the node, or the degree of freedom, before their own."""
    geometry = setting.state.geometry
    if geometry is None or (geometry.sensor_nodes == 0).any():
        return
    if geometry.sensor_directions.any(axis=1).all():
        every, nodes = list(range(geometry.sensor_nodes.size)), geometry.sensor_nodes - 1
        what = "degrees of freedom" if len(geometry.axes) == 1 else "nodes"
        change = partial(relocated, sensors=every, sensor_nodes=nodes)
        yield Mistake("counted-from-one", (what,), change, one_of(USUAL, 1), {"what": what})
