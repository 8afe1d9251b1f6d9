r"""Sensors at other places or along other directions than the model says.

Degrees of freedom or nodes that a user counts from 1 are all off by one. A sensor that measures
along another axis, or all those of an axis, or two axes exchanged, are tried one by one. So is a
sensor at another place: with the pairs as they are, all nodes are tried at the cost of a few
products, as :math:`\psi^T \varphi` and :math:`\varphi^T \varphi` change by one product each.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
import scipy.sparse

from modefront._typing import Floats, Ints
from modefront.diagnosis.comparison import Comparison
from modefront.diagnosis.measured import Measured
from modefront.fem.mesh import Mesh
from modefront.models.geometry import Geometry

ALONG = 0.99
"""Component of a direction from which on it is one along an axis."""

AXES = ("x", "y", "z")
SIX = (*AXES, "rx", "ry", "rz")

MOVED = 3
"""Sensors that are tried at other places, those that gain most: each of them is paired anew."""


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
    place : where the sensor fits instead; empty for directions
    """

    selection: scipy.sparse.csr_array
    counted: str = ""
    sensors: tuple[int, ...] = ()
    given: str = ""
    better: str = ""
    place: str = ""


def relocations(comparison: Comparison) -> Iterator[Relocation]:
    """Yield all places that are tried.

    Where nodes move along one axis alone, as in a chain, sensors are named by degrees of freedom.
    """
    model = comparison.matrices
    if model is None or comparison.Phi is None:
        return
    geometry = model.geometry
    if geometry is None or len(geometry.axes) < 2:
        selection = model.selection.tocoo()
        if selection.col.size and selection.col.min() > 0:
            entries = selection.data, (selection.row, selection.col - 1)
            shifted = scipy.sparse.csr_array(entries, shape=selection.shape)
            yield Relocation(shifted, counted="degrees of freedom")
        return
    places = Places(geometry, model.selection)
    if (geometry.sensor_nodes > 0).all() and (geometry.sensor_directions != 0).any(axis=1).all():
        yield Relocation(places.at(geometry.sensor_nodes - 1), counted="nodes")
    yield from _turned(places)


def moved(comparison: Comparison, view: Measured, index: Ints) -> Iterator[Relocation]:
    """Yield single sensors, each at the place where its measured motion fits best.

    ``index`` (modes,) are the model modes that belong to the measured ones. Places are nodes, with
    the sensor's direction kept; where nodes move along one axis alone, degrees of freedom.
    """
    model = comparison.matrices
    if model is None or comparison.Phi is None:
        return
    shapes, phi, geometry = comparison.Phi[:, index], comparison.phi[:, index], model.geometry
    in_space = geometry is not None and len(geometry.axes) > 1
    found: list[tuple[float, int, int]] = []
    for s in np.flatnonzero(view.seen.any(axis=(0, 1))).tolist():
        if geometry is not None and in_space:
            values = geometry.displacement(shapes) @ geometry.sensor_directions[s]
        elif model.selection[[s]].nnz == 1:
            values = shapes.T * model.selection[[s]].sum()
        else:
            continue
        gains = _gains(view, phi, s, values)
        place = int(np.argmax(gains))
        found.append((float(gains[place]), s, place))
    for gain, s, place in sorted(found, reverse=True)[:MOVED]:
        if gain <= 0:
            continue
        selection = model.selection.tolil()
        if geometry is not None and in_space:
            at = geometry.weights(np.array([place]), geometry.sensor_directions[[s]])
            words = [_point(geometry.nodes[n]) for n in (geometry.sensor_nodes[s], place)]
        else:
            at = scipy.sparse.csr_array(
                ([model.selection[[s]].sum()], ([0], [place])), shape=(1, model.size)
            )
            dof = int(model.selection[[s]].indices[0])
            words = [f"degree of freedom {k}" for k in (dof, place)]
        selection[[s]] = at.tolil()
        yield Relocation(selection.tocsr(), sensors=(s,), given=words[0], place=words[1])


def _gains(view: Measured, phi: Floats, s: int, values: Floats) -> Floats:
    """Return by how much the MAC values, summed, rise with sensor s at each place, (places,).

    ``phi`` (sensors, modes) is the model's motion of the sensors, ``values`` (modes, places) that
    of the places, in the paired modes.
    """
    psi, seen = view.psi, view.seen
    usable = seen.sum(axis=2) > 1
    share = usable / np.maximum(usable.sum(axis=0), 1)
    cross = (psi * phi.T).sum(axis=2) - psi[:, :, s] * phi[s]
    norm = (seen * phi.T**2).sum(axis=2) - seen[:, :, s] * phi[s] ** 2

    def total(at: Floats) -> Floats:
        x = cross[:, :, None] + psi[:, :, s, None] * at
        b = norm[:, :, None] + seen[:, :, s, None] * at**2
        mac = np.divide(x**2, b, out=np.zeros(b.shape), where=b > 0)
        return np.asarray((share[:, :, None] * mac).sum(axis=(0, 1)))

    return total(values) - total(phi[s][:, None])


def _point(x: Floats) -> str:
    return "(" + ", ".join(f"{value:.4g}" for value in x) + ")"


@dataclass(frozen=True, eq=False)
class Places:
    """Nodes and directions of sensors.

    Attributes
    ----------
    geometry : of the model
    selection : (sensors, N) weights of the sensors, kept for those of rotations
    """

    geometry: Geometry
    selection: scipy.sparse.csr_array

    def at(self, nodes: Ints) -> scipy.sparse.csr_array:
        """Return the weights of sensors at other nodes."""
        return self.geometry.weights(nodes, self.geometry.sensor_directions)

    def along(self, sensors: tuple[int, ...], directions: Floats) -> scipy.sparse.csr_array:
        """Return the weights with other ``directions`` (sensors, 3) of some sensors."""
        turned = self.geometry.weights(self.geometry.sensor_nodes, directions).tolil()
        out = self.selection.tolil()
        out[list(sensors)] = turned[list(sensors)]
        return out.tocsr()


def _turned(places: Places) -> Iterator[Relocation]:
    """Yield other directions: of all sensors of an axis, of two axes exchanged, of single ones."""
    directions = places.geometry.sensor_directions
    axis = np.argmax(np.abs(directions), axis=1)
    axis = np.where(np.abs(directions).max(axis=1) > ALONG, axis, -1)
    groups = {a: np.flatnonzero(axis == a) for a in range(3)}
    for a, members in groups.items():
        others = [b for b in places.geometry.axes if b != a]
        if len(members) > 1:
            for b in others:
                for sign in (1.0, -1.0) if len(members) < len(axis) else (1.0,):
                    yield _to(places, {int(s): (b, sign) for s in members}, a, b)
        for s in members.tolist():
            for b in others:
                for sign in (1.0, -1.0):
                    yield _to(places, {s: (b, sign)}, a, b)
    for a, b in ((0, 1), (0, 2), (1, 2)):
        if groups[a].size and groups[b].size:
            both = {int(s): (b, 1.0) for s in groups[a]} | {int(s): (a, 1.0) for s in groups[b]}
            yield _to(places, both, a, b, exchanged=True)


def _to(
    places: Places,
    changed: dict[int, tuple[int, float]],
    a: int,
    b: int,
    *,
    exchanged: bool = False,
) -> Relocation:
    """Return the relocation of some sensors to other axes; each keeps its own sign, or changes it.

    ``a`` and ``b`` are the axes in the model and in the data.
    """
    given: Floats = places.geometry.sensor_directions
    directions = given.copy()
    for s, (axis, factor) in changed.items():
        size = given[s, int(np.argmax(np.abs(given[s])))]
        directions[s] = 0.0
        directions[s, axis] = factor * size
    members = tuple(sorted(changed))
    names = f"{AXES[a]} and {AXES[b]}", f"{AXES[b]} and {AXES[a]}"
    if not exchanged:
        names = _name(given[members[0]], a), _name(directions[members[0]], b)
    return Relocation(places.along(members, directions), "", members, *names)


def _name(direction: Floats, axis: int) -> str:
    return ("-" if direction[axis] < 0 else "") + AXES[axis]


def axis_name(direction: Floats) -> str:
    """Return a direction (6,) in words: an axis with its sign, or a vector."""
    greatest = int(np.argmax(np.abs(direction)))
    if abs(direction[greatest]) > ALONG:
        return ("-" if direction[greatest] < 0 else "") + SIX[greatest]
    return "(" + ", ".join(f"{x:.2g}" for x in direction[:3]) + ")"


@dataclass(frozen=True)
class UnusedGroup:
    """A group of cells of which the model has no elements, and which holds nothing either.

    Attributes
    ----------
    name : of the group
    type : of its cells, as VTK says
    cells : their number
    """

    name: str
    type: str
    cells: int


def unused_groups(mesh: Mesh, elements: Iterable[str], nodes: Iterable[str]) -> list[UnusedGroup]:
    """Return the groups that the model uses neither for ``elements`` nor for ``nodes``.

    A group that shares all of its cells with those that have elements is another name for them.
    """
    with_elements = set(elements)
    used = with_elements.union(nodes)
    made = {
        tuple(sorted(cell))
        for block in mesh.blocks
        if block.group in with_elements
        for cell in block.cells.tolist()
    }
    out: dict[str, UnusedGroup] = {}
    for block in mesh.blocks:
        if (
            block.group in used
            or block.group in out
            or all(tuple(sorted(cell)) in made for cell in block.cells.tolist())
        ):
            continue
        out[block.group] = UnusedGroup(block.group, block.type, len(block.cells))
    return list(out.values())
