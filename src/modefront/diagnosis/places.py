"""Sensors at other places or along other directions than the model says.

Degrees of freedom or nodes that a user counts from 1 are all off by one. A sensor that measures
along another axis, or all those of an axis, or two axes exchanged, are tried one by one.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy.sparse

from modefront._typing import Floats
from modefront.diagnosis.comparison import Comparison
from modefront.models.nodes import SensorNodes

ALONG = 0.99
"""Component of a direction from which on it is one along an axis."""

AXES = ("x", "y", "z")
SIX = (*AXES, "rx", "ry", "rz")


@dataclass(frozen=True)
class DataDirection:
    """A sensor has another direction in the model than the degree of freedom of the data it takes.

    Attributes
    ----------
    sensor : its name
    model, data : directions
    """

    sensor: str
    model: str
    data: str


@dataclass(frozen=True)
class Relocation:
    """Other degrees of freedom for the sensors.

    Attributes
    ----------
    selection : (sensors, N) weights of the degrees of freedom
    counted : "degrees of freedom" or "nodes" that are counted from 1; empty for directions
    sensors : positions of the sensors that have another direction
    given, better : their direction in the model and the one that fits, such as "x" and "-y"
    """

    selection: scipy.sparse.csr_array
    counted: str = ""
    sensors: tuple[int, ...] = ()
    given: str = ""
    better: str = ""


def relocations(comparison: Comparison) -> Iterator[Relocation]:
    """Yield all places that are tried."""
    model = comparison.matrices
    if model is None or comparison.Phi is None:
        return
    if model.nodes is None:
        selection = model.selection.tocoo()
        if selection.col.size and selection.col.min() > 0:
            entries = selection.data, (selection.row, selection.col - 1)
            shifted = scipy.sparse.csr_array(entries, shape=selection.shape)
            yield Relocation(shifted, counted="degrees of freedom")
        return
    nodes = model.nodes
    if (nodes.node > 0).all():
        yield Relocation(nodes.selection(nodes.node - 1, nodes.direction), counted="nodes")
    yield from _turned(nodes)


def _turned(nodes: SensorNodes) -> Iterator[Relocation]:
    """Yield other directions: of all sensors of an axis, of two axes exchanged, of single ones."""
    axis = np.argmax(np.abs(nodes.direction), axis=1)
    along = np.abs(nodes.direction).max(axis=1) > ALONG
    axis = np.where(along & (axis < 3), axis, -1)
    groups = {a: np.flatnonzero(axis == a) for a in range(3)}
    for a, members in groups.items():
        others = [b for b in range(3) if b != a]
        if len(members) > 1:
            for b in others:
                for sign in (1.0, -1.0) if len(members) < len(axis) else (1.0,):
                    yield _to(nodes, {int(s): (b, sign) for s in members}, a, b)
        for s in members.tolist():
            for b in others:
                for sign in (1.0, -1.0):
                    yield _to(nodes, {s: (b, sign)}, a, b)
    for a, b in ((0, 1), (0, 2), (1, 2)):
        if groups[a].size and groups[b].size:
            both = {int(s): (b, 1.0) for s in groups[a]} | {int(s): (a, 1.0) for s in groups[b]}
            yield _to(nodes, both, a, b, exchanged=True)


def _to(
    nodes: SensorNodes,
    changed: dict[int, tuple[int, float]],
    a: int,
    b: int,
    *,
    exchanged: bool = False,
) -> Relocation:
    """Return the relocation of some sensors to other axes; each keeps its own sign, or changes it.

    ``a`` and ``b`` are the axes in the model and in the data.
    """
    direction: Floats = nodes.direction.copy()
    for s, (axis, factor) in changed.items():
        size = direction[s, int(np.argmax(np.abs(direction[s])))]
        direction[s] = 0.0
        direction[s, axis] = factor * size
    members = tuple(sorted(changed))
    given = f"{AXES[a]} and {AXES[b]}" if exchanged else _name(nodes.direction[members[0]], a)
    better = f"{AXES[b]} and {AXES[a]}" if exchanged else _name(direction[members[0]], b)
    return Relocation(nodes.selection(nodes.node, direction), "", members, given, better)


def _name(direction: Floats, axis: int) -> str:
    return ("-" if direction[axis] < 0 else "") + AXES[axis]


def axis_name(direction: Floats) -> str:
    """Return a direction (6,) in words: an axis with its sign, or a vector."""
    greatest = int(np.argmax(np.abs(direction)))
    if abs(direction[greatest]) > ALONG:
        return ("-" if direction[greatest] < 0 else "") + SIX[greatest]
    return "(" + ", ".join(f"{x:.2g}" for x in direction[:3]) + ")"
