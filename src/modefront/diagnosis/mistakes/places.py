"""Sensors of the model at other places, or along other directions, than those of the test."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import scipy.sparse

from modefront.diagnosis.evidence import State
from modefront.diagnosis.mistakes.record import (
    MANY,
    OFTEN,
    TRIED,
    USUAL,
    Change,
    Setting,
    Variant,
    mistake,
    one_of,
    promising,
)
from modefront.diagnosis.notes import ALONG, axis_name
from modefront.findings.knowledge import enumeration
from modefront.models.geometry import Geometry
from modefront.rounding import ACCUMULATED

AXES = "xyz"

NEAREST = 4
"""Places of each sensor that are tried: those that promise most."""

OFTEN_SHARED = 2.0
"""Logarithm of how much likelier a sensor is at a wrong place where it shares it with another."""


def at_rows(state: State, sensors: Sequence[int], rows: scipy.sparse.csr_array) -> State:
    """Return the state in which sensors have other weights (sensors, N)."""
    assert state.selection is not None
    ones = np.ones(len(sensors)), (sensors, np.arange(len(sensors)))
    place = scipy.sparse.csr_array(ones, shape=(state.selection.shape[0], len(sensors)))
    difference = place @ (rows - state.selection[list(sensors)])
    return replace(state, selection=(state.selection + difference).tocsr())


def relocated(sensors: Sequence[int], **changed: Any) -> Change:
    """Return the change that gives sensors other ``sensor_nodes`` or ``sensor_directions``."""

    def change(state: State) -> State:
        assert state.geometry is not None
        parts = {name: getattr(state.geometry, name).copy() for name in changed}
        for name, values in parts.items():
            values[sensors] = changed[name]
        geometry = replace(state.geometry, **parts)
        places = geometry.sensor_nodes[sensors], geometry.sensor_directions[sensors]
        return replace(at_rows(state, sensors, geometry.weights(*places)), geometry=geometry)

    return change


def in_space(setting: Setting) -> Geometry | None:
    """Return the geometry of a model whose nodes move along several axes."""
    geometry = setting.state.geometry
    return geometry if geometry is not None and len(geometry.axes) > 1 else None


@mistake("wrong-place", USUAL)
def wrong_place(setting: Setting) -> Iterator[Variant]:
    """Yield sensors at other nodes, directions kept; in a chain, at other degrees of freedom."""
    selection, geometry = setting.state.selection, in_space(setting)
    if selection is None:
        return
    products = (selection @ selection.T).toarray()
    squares = np.diag(products)
    is_same = np.abs(squares[:, None] + squares - 2 * products) <= ACCUMULATED * squares
    found: list[tuple[float, int, int, int, Change]] = []
    places = 0
    for s in setting.measured:
        own = selection[[s]]
        if geometry is not None:
            along = np.tile(geometry.sensor_directions[s], (len(geometry.nodes), 1))
            rows = geometry.weights(np.arange(len(geometry.nodes)), along)
        else:
            rows = (own.sum() * scipy.sparse.eye_array(own.shape[1])).tocsr()
        there = abs(rows).sum(axis=1) > 0
        if not there.any() or own.nnz == 0:
            continue
        places = max(places, int(there.sum()))
        place = int(own.indices[0]) if geometry is None else geometry.sensor_nodes[s]
        gains = np.where(there, setting.gain(s, rows), -np.inf)
        for k in np.argsort(-gains)[:NEAREST].tolist():
            if not there[k] or k == place:
                continue
            change = relocated([s], sensor_nodes=k)
            if geometry is None:
                change = partial(at_rows, sensors=[s], rows=rows[[k]])
            found.append((float(gains[k]), s, place, k, change))
    price = one_of(places * len(setting.measured))
    for _, s, place, k, change in sorted(found, key=lambda each: -each[0])[:TRIED]:
        others = [setting.sensors[t] for t in np.flatnonzero(is_same[s]).tolist() if t != s]
        name = setting.sensors[s]
        numbers = {
            "sensor": name,
            "given": _place(geometry, place),
            "place": _place(geometry, k),
            "too": f", where the model has {enumeration(others, MANY)} too" if others else "",
        }
        less = OFTEN_SHARED if others else 0.0
        yield Variant((name,), change, numbers, price - less)


def _place(geometry: Geometry | None, k: int) -> str:
    if geometry is None:
        return f"degree of freedom {k}"
    return f"({', '.join(f'{x:.4g}' for x in geometry.nodes[k])})"


@mistake("wrong-direction", OFTEN)
def wrong_direction(setting: Setting) -> Iterator[Variant]:
    """Yield other directions: of single sensors, of all along an axis, of two axes exchanged."""
    geometry = in_space(setting)
    if geometry is None or setting.state.selection is None:
        return
    given = geometry.sensor_directions
    axis = np.where(np.abs(given).max(axis=1) > ALONG, np.abs(given).argmax(axis=1), -1)
    found = []
    groups = {a: np.flatnonzero(axis == a).tolist() for a in geometry.axes}
    single = one_of(2 * len(geometry.axes) * len(setting.measured))
    several = one_of(12)
    for a, members in groups.items():
        for b, sign in [(b, sign) for b in geometry.axes if b != a for sign in (1.0, -1.0)]:
            if len(members) > 1:
                yield _turned(setting, geometry, dict.fromkeys(members, (b, sign)), several)
            for s in members:
                turned = np.eye(3)[[b]] * sign * given[s, a]
                gain = setting.gain(s, geometry.weights(geometry.sensor_nodes[[s]], turned))
                variant = _turned(setting, geometry, {s: (b, sign)}, single)
                found.append((float(gain[0]), variant))
    yield from promising(found)
    for a, b in [(a, b) for a in geometry.axes for b in geometry.axes if a < b]:
        if groups[a] and groups[b]:
            both = dict.fromkeys(groups[a], (b, 1.0)) | dict.fromkeys(groups[b], (a, 1.0))
            names = f"{AXES[a]} and {AXES[b]}", f"{AXES[b]} and {AXES[a]}"
            yield _turned(setting, geometry, both, several, names)


def _turned(
    setting: Setting,
    geometry: Geometry,
    along: Mapping[int, tuple[int, float]],
    price: float,
    names: tuple[str, str] | None = None,
) -> Variant:
    """Return the variant in which sensors are along axes, each with its sign times another one."""
    some, given = list(along), geometry.sensor_directions
    sizes = given[some, np.abs(given[some]).argmax(axis=1)]
    axes, signs = (np.array(x) for x in zip(*along.values(), strict=True))
    new = np.eye(3)[axes] * (signs * sizes)[:, None]
    sensors = tuple(setting.sensors[s] for s in some)
    before, after = names or (axis_name(given[some[0]]), axis_name(new[0]))
    numbers = {
        "sensors": enumeration(sensors, MANY),
        "given": before,
        "better": after,
        "s": "s" * (len(some) == 1),
        "turn": " in turn" if names else "",
    }
    return Variant(sensors, relocated(some, sensor_directions=new), numbers, price)


@mistake("counted-from-one", USUAL)
def counted_from_one(setting: Setting) -> Iterator[Variant]:
    """Yield all sensors at the node, or the degree of freedom, before their own."""
    geometry, selection = in_space(setting), setting.state.selection
    if selection is None:
        return
    every = list(range(selection.shape[0]))
    if geometry is not None:
        if (geometry.sensor_nodes == 0).any() or not geometry.sensor_directions.any(axis=1).all():
            return
        change = relocated(every, sensor_nodes=geometry.sensor_nodes - 1)
    else:
        entries = selection.tocoo()
        if not entries.col.size or entries.col.min() == 0:
            return
        parts = entries.data, (entries.row, entries.col - 1)
        shifted = scipy.sparse.csr_array(parts, shape=selection.shape)
        change = partial(at_rows, sensors=every, rows=shifted)
    what = "degrees of freedom" if geometry is None else "nodes"
    yield Variant((what,), change, {"what": what})
