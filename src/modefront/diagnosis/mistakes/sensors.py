"""Sensors that are reversed, exchanged, at another place or along another direction."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import combinations, permutations, product
from typing import Any

import numpy as np

from modefront._typing import Floats, Ints
from modefront.diagnosis.evidence import OF_MODEL, SHAPE, log_frequencies, mac_values, pair_costs
from modefront.diagnosis.mistakes.record import MANY, Explanation, Mistake, changed
from modefront.diagnosis.state import SHAPE as NOISE
from modefront.diagnosis.state import State, loss
from modefront.findings.knowledge import enumeration
from modefront.models.geometry import ALONG, Geometry, axis_name
from modefront.pairing.match import assigned
from modefront.rounding import ACCUMULATED

FACTORS = (10.0, 0.1, 100.0, 0.01, 1e3, 1e-3, 9.81, 1 / 9.81, 2.0, 0.5)
"""Factors on the values of a sensor by another unit or sensitivity."""

NEAREST = 4  # places of each sensor that are tried: those where the model moves most as measured

OFTEN_SHARED = 2.0  # logarithm of how much likelier a wrong place is that another sensor is at


def parts(sets: tuple[str, ...]) -> list[tuple[list[int], str]]:
    """Return data sets in which a sensor may be wrong, with their names.

    In all, in one, or in two of three: of more sets, most are right.
    """
    every = range(len(sets))
    sizes = (1, 2) if len(sets) == 3 else (1,) * (len(sets) > 1)
    some = [list(x) for n in sizes for x in combinations(every, n)]
    names = [f"set{'s' * (len(x) > 1)} {enumeration([sets[k] for k in x])}" for x in some]
    return [(list(every), "all data"), *zip(some, names, strict=True)]


def wrong_factor(old: Explanation) -> Iterator[Mistake]:
    """Yield sensors that are reversed, or in other units."""
    where, names = parts(old.data.sets), old.data.sensors
    moving = [s for s in old.measured if np.nan_to_num(old.state.shape[..., s]).any()]
    for (sets, name), s, factor in product(where, moving, (-1.0, *FACTORS)):
        kind = "reversed-sensor" if factor < 0 else "sensor-factor"
        numbers = {"sensor": names[s], "where": name, "factor": factor}
        change = partial(_rescaled, sets=sets, s=s, factor=factor)
        yield Mistake(kind, (names[s], name), change, numbers)


def _rescaled(state: State, sets: list[int], s: int, factor: float) -> State:
    """Return the state with a sensor over a factor, and the cost of the values as they are given.

    A density of values is one over their unit, which changes with the factor and the mean square.
    """
    shape, old = state.shape.copy(), state.shape[sets, :, s]
    shape[sets, :, s] = old / factor
    measured, count = np.isfinite(old), state.seen[sets].sum(axis=2)
    share = np.nan_to_num(old / state.size[sets]) ** 2 / np.maximum(count, 1)
    of_size = (count * np.log1p(share * (factor**-2 - 1))).sum() / 2
    cost = of_size + measured.sum() * np.log(abs(factor))
    return replace(state, shape=shape, left_out=state.left_out + cost)


def exchanged_sensors(old: Explanation) -> Iterator[Mistake]:
    """Yield pairs of sensors, in all data sets or some."""
    where, names = parts(old.data.sets), old.data.sensors
    for (s, t), (sets, name) in product(combinations(old.measured, 2), where):
        order = np.arange(len(names))
        order[[s, t]] = t, s
        numbers = {"sensors": enumeration((names[s], names[t])), "where": name}
        change = changed("shape", sets, partial(_arranged, order=order))
        subject = names[s], names[t], name
        yield Mistake("exchanged-sensors", subject, change, numbers, moves=True)


def _arranged(shape: Floats, order: Ints) -> Floats:
    """Return shapes with their components in another order, and nothing where that is -1."""
    return np.where(order < 0, np.nan, shape[..., order])


def opposite_order(old: Explanation) -> Iterator[Mistake]:
    """Yield the opposite order of all sensors."""
    order = np.arange(len(old.data.sensors))
    order[old.measured] = old.measured[::-1]
    change = changed("shape", ..., partial(_arranged, order=order))
    yield Mistake("opposite-order", ("sensors",), change, moves=True)


def unsigned_shapes(old: Explanation) -> Iterator[Mistake]:
    """Yield signs for shapes of which none has any but for one value, as if they were magnitudes.

    The signs are those of the model that fits the frequencies alone.
    """
    state, fits = old.state, old.fits
    signs = np.sign(np.nan_to_num(fits.plain.shape))
    if np.minimum((signs > 0).sum(axis=2), (signs < 0).sum(axis=2)).sum() > 1:
        return
    unknown = replace(state, shape=np.full(state.shape.shape, np.nan))
    (end,) = fits.fitted([unknown])
    if modes := fits.of(state, end.x):
        phi = state.rows @ modes.phi[-state.rows.shape[1] :]
        mac = mac_values(np.abs(state.mean), state.known, np.abs(phi))
        cost = pair_costs(mac, state.logs, log_frequencies(modes.frequency))
        signs = np.sign(phi[:, assigned(cost[:, : state.candidates])].T)
        change = changed("shape", ..., partial(np.multiply, signs))
        yield Mistake("unsigned-shapes", ("shapes",), change)


def odd_sensor(old: Explanation) -> Iterator[Mistake]:
    """Yield sensors without signal, where the model has nothing either, or with noise alone."""
    for s in old.measured:
        name, rows = old.data.sensors[s], old.state.rows.copy()
        rows[s] = 0.0
        for what, change in (
            ("near zero in all modes", partial(replace, rows=rows)),
            ("noise: they fit no place, sign or unit", changed("shape", np.s_[..., s], np.nan)),
        ):
            yield Mistake("odd-sensor", (name,), change, {"sensor": name, "what": what})


def reversed_value(old: Explanation) -> Iterator[Mistake]:
    """Yield single components, of shapes that one data set alone has, with the other sign.

    Of magnitudes, only one that has a sign which no more of its shape have than another one.
    """
    state, names = old.state, old.data
    once = state.seen & (state.seen.any(axis=2).sum(axis=0) == 1)[:, None]
    if any(each.kind == "unsigned-shapes" for each in old.mistakes):
        signs = np.sign(np.nan_to_num(old.fits.plain.shape))
        once &= (signs != 0) & (signs * signs.sum(axis=2, keepdims=True) <= 0)
    for k, r, s in np.argwhere(once).tolist():
        numbers = {"mode": names.modes[r], "sensor": names.sensors[s]}
        change = changed("shape", np.s_[k, r, s], -1.0)
        yield Mistake("reversed-value", tuple(map(str, numbers.values())), change, numbers)


def copied_sensor(old: Explanation) -> Iterator[Mistake]:
    """Yield sensors that have the values of another one, digit by digit, whatever their signs.

    A copy says nothing on its own: its values cost as much as those that fit as well as is usual.
    """
    shape, names = np.abs(old.state.shape), old.data.sensors
    for s, t in permutations(old.measured, 2):
        same = np.array_equal(shape[:, :, s], shape[:, :, t], equal_nan=True)
        if not same or not np.nan_to_num(shape[..., s]).any():
            continue
        sets = old.state.seen[:, :, s].sum(axis=0)
        of_model, of_noise = (sets > 0).sum(), np.maximum(sets - 1, 0).sum()
        usual = np.log(SHAPE) * of_model + np.log(NOISE) * of_noise
        change = changed("shape", np.s_[..., s], np.nan, usual)
        numbers, subject = {"sensor": names[s], "other": names[t]}, sorted((names[s], names[t]))
        yield Mistake("copied-sensor", tuple(subject), change, numbers)


def shifted_values(old: Explanation) -> Iterator[Mistake]:
    """Yield rows of shapes, or all, in which a value is lost or too many, and the rest moved."""
    names, (K, _, n) = old.data, old.state.shape.shape
    where: dict[str, tuple[slice, slice]] = {"all data": np.s_[:, :]}
    for k, name in enumerate(names.sets):
        where |= {f"set {name}": np.s_[k : k + 1, :]} if K > 1 else {}
        for r, mode in enumerate(names.modes):
            where[f"mode {mode}" + f" of set {name}" * (K > 1)] = np.s_[k : k + 1, r : r + 1]
    every = np.arange(n)
    for (name, rows), start in product(where.items(), range(n - 1)):
        lost, too_many = np.insert(every[:-1], start, -1), np.append(np.delete(every, start), -1)
        for what, order in (("lost", lost), ("too many", too_many)):
            numbers = {"where": name, "sensor": names.sensors[start], "what": what}
            change = changed("shape", rows, partial(_arranged, order=order))
            yield Mistake("shifted-values", (name,), change, numbers, moves=True)


def _relocated(state: State, sensors: Sequence[int], **changed: Any) -> State:
    """Return the state with other ``sensor_nodes`` or ``sensor_directions`` of some sensors."""
    assert state.geometry is not None
    parts = {name: getattr(state.geometry, name).copy() for name in changed}
    for name, values in parts.items():
        values[sensors] = changed[name]
    geometry, rows = replace(state.geometry, **parts), state.rows.copy()
    nodes, directions = geometry.sensor_nodes[sensors], geometry.sensor_directions[sensors]
    rows[sensors] = np.einsum("si,sin->sn", directions, state.moves[nodes])
    return replace(state, geometry=geometry, rows=rows)


def wrong_place(old: Explanation) -> Iterator[Mistake]:
    """Yield sensors at other nodes, directions kept; in a chain, at other degrees of freedom."""
    state, geometry, names = old.state, old.state.geometry, old.data.sensors
    if geometry is None:
        return
    given, along = geometry.sensor_nodes, geometry.sensor_directions
    can = np.diff(geometry.motion.indptr).reshape(-1, 3) > 0  # nodes x axes
    there = {s: np.flatnonzero(can[:, along[s] != 0].any(axis=1)) for s in old.measured}
    there = {s: nodes[nodes != given[s]] for s, nodes in there.items()}
    phi = old.modes.phi[len(names) :, old.point.pairs] * old.point.beta
    shapes = (state.moves @ phi).transpose(2, 0, 1)
    x = np.where(state.known, state.mean, np.nan)
    for s, nodes in there.items():
        r = (shapes[:, nodes] @ along[s] - x[:, [s]]) / (old.point.sigma * state.motion[s])
        cost = loss(np.nan_to_num(r), OF_MODEL).sum(axis=0)
        apart, size = np.abs(state.rows - state.rows[s]).max(axis=1), np.abs(state.rows[s]).max()
        others = [names[t] for t in np.flatnonzero(apart <= ACCUMULATED * size) if t != s]
        too = f", where the model has {enumeration(others, MANY)} too" if others else ""
        price = np.log(max(len(nodes) / NEAREST, 1)) - OFTEN_SHARED * bool(others)
        for k in nodes[np.argsort(cost, kind="stable")[:NEAREST]].tolist():
            numbers = {"sensor": names[s], "place": _place(geometry, k), "too": too}
            numbers["given"] = _place(geometry, given[s])
            change = partial(_relocated, sensors=[s], sensor_nodes=k)
            yield Mistake("wrong-place", (names[s],), change, numbers, float(price))


def _place(geometry: Geometry, k: int) -> str:
    if len(geometry.axes) == 1:  # a chain, above the ground
        return f"degree of freedom {k - 1}"
    return f"({', '.join(f'{x:.4g}' for x in geometry.nodes[k])})"


def wrong_direction(old: Explanation) -> Iterator[Mistake]:
    """Yield other directions: of single sensors, of all along an axis, of two axes exchanged."""
    geometry = old.state.geometry
    if geometry is None or len(geometry.axes) == 1:
        return
    given, axes, names = geometry.sensor_directions, geometry.axes, old.data.sensors
    along, turned = np.where(abs(given).max(axis=1) > ALONG, abs(given).argmax(axis=1), -1), []
    for (a, b), sign in product(permutations(axes, 2), (1.0, -1.0)):
        some, turn = np.flatnonzero(along == a).tolist(), np.zeros((3, 3))
        turn[a, b] = sign
        turned += [([s], turn) for s in some] + [(some, turn)] * (len(some) > 1)
    for a, b in combinations(axes, 2):
        both, swap = np.flatnonzero((along == a) | (along == b)).tolist(), np.eye(3)
        swap[[a, b]] = swap[[b, a]]
        turned += [(both, swap)] * bool(0 < (along == a).sum() < len(both))
    for some, turn in turned:
        each = given[some], given[some] @ turn
        before, after = (list(dict.fromkeys(map(axis_name, x))) for x in each)
        numbers = {"sensors": enumeration([names[s] for s in some], MANY)}
        numbers |= {"s": "s" * (len(some) == 1), "turn": " in turn" * (len(after) > 1)}
        numbers |= {"given": enumeration(before), "better": enumeration(after)}
        change = partial(_relocated, sensors=some, sensor_directions=each[1])
        yield Mistake("wrong-direction", tuple(names[s] for s in some), change, numbers)


def counted_from_one(old: Explanation) -> Iterator[Mistake]:
    """Yield all sensors at the node, or the degree of freedom, before their own."""
    geometry = old.state.geometry
    if geometry is None or (geometry.sensor_nodes == 0).any():
        return
    every, nodes = list(range(geometry.sensor_nodes.size)), geometry.sensor_nodes - 1
    what = "degrees of freedom" if len(geometry.axes) == 1 else "nodes"
    change = partial(_relocated, sensors=every, sensor_nodes=nodes)
    if change(old.state).rows.any(axis=1).all():
        yield Mistake("counted-from-one", (what,), change, {"what": what})
