"""From the members of a structure to blocks of element matrices, checked on the way."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modefront._typing import Floats, Ints
from modefront.fem.check import (
    ALONG,
    COINCIDENT,
    cell_array,
    check_positive,
    check_sizes,
    node_list,
    shell_sizes,
    solid_sizes,
    unit_vector,
)
from modefront.fem.elements.beam import beam
from modefront.fem.elements.point import lumped_mass, spring
from modefront.fem.elements.shell import directors, narrowness, shell
from modefront.fem.elements.solid import SOLIDS, solid
from modefront.fem.scatter import Block
from modefront.fem.section import Checks, FemError
from modefront.fem.structure import Beams, Mass, Shells, Solids, Spring
from modefront.rounding import TINY

SYMMETRIC = 1e-9
"""Relative error of an inertia matrix that passes for the digits it is given with."""

TRANSLATIONS = (0, 1, 2)
SIX = (0, 1, 2, 3, 4, 5)
"""Directions of nodes of solids, and of beams and shells."""


def element_blocks(
    X: Floats, groups: Sequence[Beams | Shells | Solids], checks: Checks
) -> list[Block]:
    """One block for each group of elements in which nothing is wrong."""
    shells = [each for each in groups if isinstance(each, Shells)]
    cells = [checks.attempt(_shell_cells, X, each) for each in shells]
    sound = [each for each in cells if each is not None]
    shared = iter(zip(directors(X, sound), narrowness(X, sound), strict=True) if sound else ())
    blocks: list[Block | None] = [
        _shells(X, group, each, *next(shared))
        for group, each in zip(shells, cells, strict=True)
        if each is not None
    ]
    for group in groups:
        if isinstance(group, Beams):
            blocks.append(checks.attempt(_beams, X, group))
        elif isinstance(group, Solids):
            blocks.append(checks.attempt(_solids, X, group))
    return [block for block in blocks if block is not None]


def _beams(X: Floats, group: Beams) -> Block:
    place = f"group {group.name!r}"
    cells = cell_array(group.cells, (2,), len(X), place)
    r = np.asarray(group.offsets, dtype=float)
    if r.shape != (2, 3):
        raise FemError(f"{place}: expected offsets of the shape (2, 3), found {r.shape}")
    ends = X[cells] + r
    axis = ends[:, 1] - ends[:, 0]
    length = np.linalg.norm(axis, axis=1)
    check_sizes(length / np.ptp(X, axis=0).max(initial=TINY), cells, "length", place)
    axis = axis / length[:, None]
    section = group.section
    if group.orientation is None:
        if section.I_y != section.I_z or section.kappa_y != section.kappa_z:
            raise FemError(
                f"{place}: the section is not the same in y and z, so orientation is needed:"
                " a vector in the plane of the beam's axis and its local y"
            )
        upright = np.abs(axis[:, 2:]) > 0.9
        orientation = np.where(upright, np.eye(3)[0], np.eye(3)[2])
    else:
        v = unit_vector(tuple(group.orientation), f"{place}, orientation")[:3]
        orientation = np.broadcast_to(v, axis.shape)
        parallel = np.flatnonzero(np.linalg.norm(np.cross(axis, v), axis=1) < ALONG)
        if len(parallel):
            raise FemError(
                f"{place}: orientation {tuple(group.orientation)} must not be parallel to the"
                f" axis, but it is at element {parallel[0]}"
                f" (nodes {', '.join(map(str, cells[parallel[0]].tolist()))})"
            )
    return Block(group.name, cells, SIX, beam(X[cells], group.material, section, orientation, r))


def _shell_cells(X: Floats, group: Shells) -> Ints:
    place = f"group {group.name!r}"
    cells = cell_array(group.cells, (3, 4), len(X), place)
    check_positive(group.thickness, "thickness", place)
    check_sizes(shell_sizes(X[cells]), cells, "area", place)
    return cells


def _shells(X: Floats, group: Shells, cells: Ints, d: Floats, narrow: Floats) -> Block:
    matrices = shell(X[cells], d, narrow, group.material, group.thickness, group.offset)
    return Block(group.name, cells, SIX, matrices)


def _solids(X: Floats, group: Solids) -> Block:
    place = f"group {group.name!r}"
    if np.ndim(group.cells) == 2 and np.shape(group.cells)[1] == 4:
        raise FemError(
            f"{place}: tetrahedra of 4 nodes are far too stiff in bending; mesh with second-order"
            " elements (10 nodes)"
        )
    cells = cell_array(group.cells, tuple(SOLIDS), len(X), place)
    check_sizes(solid_sizes(X[cells]), cells, "volume", place)
    return Block(group.name, cells, TRANSLATIONS, solid(X[cells], group.material))


def spring_blocks(X: Floats, springs: Sequence[Spring], checks: Checks) -> list[Block]:
    """One block for each named set of springs in which nothing is wrong."""
    blocks = (checks.attempt(_springs, X, s, f"spring {s.name!r}") for s in springs)
    return [block for block in blocks if block is not None]


def _springs(X: Floats, member: Spring, place: str) -> Block:
    nodes = node_list(member.nodes, len(X), place)[:, None]
    check_positive(member.stiffness, "stiffness", place)
    gap = np.zeros((len(nodes), 3))
    if member.to is not None:
        to = node_list(member.to, len(X), place)
        if len(to) != len(nodes):
            raise FemError(f"{place}: expected {len(nodes)} partners, found {len(to)}")
        nodes = np.stack([nodes[:, 0], to], 1)
        gap = X[nodes[:, 1]] - X[nodes[:, 0]]
    length = np.linalg.norm(gap, axis=1, keepdims=True)
    size = np.ptp(X, axis=0).max()
    if member.direction is None:
        if member.to is None or (length <= COINCIDENT * size).any():
            raise FemError(f"{place}: a direction is needed unless it joins two distant nodes")
        axis = np.pad(gap / length, ((0, 0), (0, 3)))
    else:
        axis = np.tile(unit_vector(member.direction, place), (len(nodes), 1))
        slant = np.linalg.norm(np.cross(gap, axis[:, :3]), axis=1)
        skew = np.flatnonzero(slant > ALONG * length[:, 0] + COINCIDENT * size)
        if axis[0, :3].any() and len(skew):
            raise FemError(
                f"{place}: between distant nodes it must act along their line, else it resists a"
                f" rotation of the whole; nodes {nodes[skew[0], 0]} and {nodes[skew[0], 1]} do not"
                f" lie along {member.direction!r}. Link one of them rigidly to a node at the other"
            )
    used = tuple(np.flatnonzero(axis.any(0)).tolist())
    matrices = spring(axis[:, list(used)], member.stiffness, nodes.shape[1])
    return Block(member.name, nodes, used, matrices)


def mass_blocks(X: Floats, masses: Sequence[Mass], checks: Checks) -> list[Block]:
    """One block for each named set of lumped masses in which nothing is wrong."""
    blocks = (checks.attempt(_masses, X, m, f"mass {m.name!r}") for m in masses)
    return [block for block in blocks if block is not None]


def _masses(X: Floats, member: Mass, place: str) -> Block:
    nodes = node_list(member.nodes, len(X), place)[:, None]
    inertia, c = np.asarray(member.inertia, dtype=float), np.asarray(member.offset, dtype=float)
    if inertia.shape == (3,):
        inertia = np.diag(inertia)
    if inertia.shape != (3, 3) or c.shape != (3,):
        raise FemError(
            f"{place}: expected inertia (3,) or (3, 3) and offset (3,), found {inertia.shape} and"
            f" {c.shape}"
        )
    symmetric = np.allclose(inertia, inertia.T, rtol=SYMMETRIC, atol=0)
    if (
        member.mass < 0
        or not symmetric
        or np.linalg.eigvalsh(inertia)[0] < -SYMMETRIC * inertia.max()
    ):
        raise FemError(
            f"{place}: expected mass >= 0 and inertia symmetric and not negative, found"
            f" {member.mass!r} and {inertia.tolist()}"
        )
    rotates = bool(inertia.any() or c.any())
    used = SIX if rotates else TRANSLATIONS
    M = lumped_mass(member.mass, inertia, c, len(nodes), len(used))
    return Block(member.name, nodes, used, M)
