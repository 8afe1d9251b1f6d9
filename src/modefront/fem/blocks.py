"""From the members of a structure to blocks of element matrices, checked on the way."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from modefront._typing import Floats, Ints
from modefront.errors import Fault, noted, wrong
from modefront.fem import check
from modefront.fem import structure as members
from modefront.fem.elements import common, shell
from modefront.fem.elements.beam import Axial, beam, truss
from modefront.fem.elements.solid import SOLIDS, solid, solid_stresses
from modefront.fem.section import Material
from modefront.rounding import COMPUTED, TINY, WRITTEN


@dataclass(frozen=True)
class Block:
    """Elements of one kind and group with their matrices."""

    name: str  # of the group, spring or mass
    cells: Ints  # nodes (elements, k)
    d: int  # DOFs of each node that the matrices have: 3 translations, or all 6
    stiffness: common.ByPower  # stiffness, mass: matrices of size k d
    mass: common.ByPower
    rigid: bool = False  # whether an element that nothing deforms is one rigid body with its nodes
    prestress: common.ByPower = field(default_factory=dict)  # geometric stiffness of given forces
    internal: Callable[[], Axial | common.Stresses] | None = None  # forces, if they make stiffness

    def dofs(self) -> Ints:
        """Return 6 node + direction of each row of the matrices (elements, k d)."""
        dofs = 6 * self.cells[:, :, None] + np.arange(self.d)
        return np.asarray(dofs.reshape(len(dofs), -1))


def blocks_of(X: Floats, structure: members.Structure, faults: list[Fault]) -> list[Block]:
    """Return a block for each group, and set of springs or masses; note the faults of others."""
    shells: list[tuple[members.Shells, Ints]] = []
    for group in structure.groups:
        if isinstance(group, members.Shells):
            with noted(faults, f"group {group.name!r}"):
                cells = check.cell_array(group.cells, (3, 4), len(X))
                check.check_sizes(check.shell_sizes(X[cells]), cells, "area")
                shells.append((group, cells))
    every = [cells for _, cells in shells]
    shared = (shell.directors(X, every), shell.narrowness(X, every)) if shells else ((), ())
    blocks: list[Block] = []
    for (group, cells), d, narrow in zip(shells, *shared, strict=True):
        with noted(faults, f"group {group.name!r}"):
            x, t = X[cells], group.thickness
            m, r, varied = _grain(x, group), group.offset * d, structure.varied_thickness
            given = m, group.material, t, group.offset, group.name in varied
            internal = partial(shell.shell_stresses, x, r, m, common.ply(group.material), t)
            made = shell.shell(x, d, narrow, *given)
            blocks.append(Block(group.name, cells, 6, *made, rigid=True, internal=internal))
    for member in (*structure.groups, *structure.springs, *structure.masses):
        kind, make = MADE.get(type(member), ("", None))
        with noted(faults, f"{kind} {member.name!r}"):
            blocks += [make(X, member)] if make else []
    return blocks


def _lines(X: Floats, group: members.Beams | members.Trusses) -> Block:
    if not isinstance(group.material, Material):
        raise wrong("material", "an isotropic one", repr(group.material))
    cells = check.cell_array(group.cells, (2,), len(X))
    r = np.asarray(getattr(group, "offsets", np.zeros((2, 3))), dtype=float)
    ends = X[cells] + r
    axis = ends[:, 1] - ends[:, 0]
    L = np.linalg.norm(axis, axis=1)
    check.check_sizes(L / np.ptp(X, axis=0).max(initial=TINY), cells, "length")
    axis = axis / L[:, None]
    if isinstance(group, members.Trusses):
        d, rigid, (made, axial) = 3, False, truss(axis, L, group.material, group.area)
    else:
        d, rigid, R = 6, not group.released, common.frame(axis, _orientation(group, cells, axis))
        made, axial = beam(R, L, r, group.material, group.section, group.released)
    given = {0: group.force * axial.unit} if group.force else {}
    return Block(group.name, cells, d, *made, rigid, given, lambda: axial)


def _orientation(group: members.Beams, cells: Ints, axis: Floats) -> Floats:
    """Return vectors (elements, 3), or one for all, in the planes of axes and local y of beams."""
    section = group.section
    if group.orientation is None:
        y, z = (section.I_y, section.kappa_y), (section.I_z, section.kappa_z)
        if y != z or any(section.shear_centre):
            expected = "a vector in the plane of the beam's axis and its local y"
            found = "nothing, and the section is not the same in y and z"
            raise wrong("orientation", expected, found)
        return np.where(np.abs(axis[:, 2:]) > 0.9, np.eye(3)[0], np.eye(3)[2])
    v = check.unit_vector(group.orientation)[:3]
    parallel = np.flatnonzero(np.linalg.norm(np.cross(axis, v), axis=1) < WRITTEN)
    if len(parallel):
        nodes = ", ".join(map(str, cells[parallel[0]].tolist()))
        expected = f"a vector not parallel to the axis of element {parallel[0]} (nodes {nodes})"
        raise wrong("orientation", expected, tuple(group.orientation))
    return v


def _grain(x: Floats, group: members.Shells) -> Floats:
    """Return vectors (elements, 3) in the planes of shells along axis 1 of the material."""
    if isinstance(group.material, Material):
        return x[:, 1] - x[:, 0]
    if group.direction is None:
        raise wrong("direction", "that along which axis 1 of the material is", "nothing")
    v = check.unit_vector(group.direction)[:3]
    R = shell.centre_axes(x)[:, :2]
    m = (R @ v)[:, None] @ R
    across = np.flatnonzero(np.linalg.norm(m[:, 0], axis=1) < WRITTEN)
    if len(across):
        expected = f"a vector not normal to the shell at element {across[0]}"
        raise wrong("direction", expected, tuple(group.direction))
    return np.asarray(m[:, 0])


def _solids(X: Floats, group: members.Solids) -> Block:
    if np.ndim(group.cells) == 2 and np.shape(group.cells)[1] == 4:
        found = "tetrahedra of 4 nodes, which are far too stiff in bending"
        raise wrong("", "second-order elements (10 nodes)", found)
    cells = check.cell_array(group.cells, tuple(SOLIDS), len(X))
    check.check_sizes(check.solid_sizes(X[cells]), cells, "volume")
    C = common.elasticity(group.material, check.axes_of(group.axes))
    made, internal = solid(X[cells], group.material.rho, C), partial(solid_stresses, X[cells], C)
    return Block(group.name, cells, 3, *made, rigid=True, internal=internal)


def _springs(X: Floats, member: members.Spring) -> Block:
    """Return springs of stiffness k that store 1/2 k (s q)^2: K = sum k s^T s.

    With a unit vector a on displacements or rotations of the nodes, s is (a, -a), or (a) to the
    ground.
    """
    nodes = check.node_list(member.nodes, len(X))[:, None]
    if member.to is not None:
        to = check.node_list(member.to, len(X))
        if len(to) != len(nodes):
            raise wrong("to", f"{len(nodes)} partners", len(to))
        nodes = np.stack([nodes[:, 0], to], 1)
    gap = X[nodes[:, -1]] - X[nodes[:, 0]]
    if np.ndim(member.stiffness):
        k = np.asarray(member.stiffness, dtype=float)
        if not k.any() or member.direction is not None:
            found = f"{member.stiffness!r} and direction {member.direction!r}"
            raise wrong("stiffness", "6 stiffnesses, not all 0, without a direction", found)
        arms = np.stack([gap / 2, -gap / 2], 1)[:, : nodes.shape[1]]
        A = common.attachment(arms, check.axes_of(member.axes))
        rows = A[:, 0] - A[:, 1] if nodes.shape[1] == 2 else A[:, 0]
    else:
        k = np.array([member.stiffness], dtype=float)
        axis = _spring_axis(X, member, nodes, gap)
        rows = np.concatenate([axis, -axis][: nodes.shape[1]], 1)[:, None]
    K = common.symmetric(np.swapaxes(rows, 1, 2) @ (k[:, None] * rows))
    return Block(member.name, nodes, 6, {0: K}, {})


def _spring_axis(X: Floats, member: members.Spring, nodes: Ints, gap: Floats) -> Floats:
    """Return the unit vectors (springs, 6) along which springs of one stiffness act."""
    length = np.linalg.norm(gap, axis=1, keepdims=True)
    size = np.ptp(X, axis=0).max()
    if member.axes is not None:
        raise wrong("axes", "none, as they are for 6 stiffnesses: a vector as direction", "some")
    if member.direction is None:
        if member.to is None or (length <= COMPUTED * size).any():
            raise wrong("direction", "one, unless it joins two distant nodes", "nothing")
        return np.pad(gap / length, ((0, 0), (0, 3)))
    axis = np.tile(check.unit_vector(member.direction), (len(nodes), 1))
    slant = np.linalg.norm(np.cross(gap, axis[:, :3]), axis=1)
    skew = np.flatnonzero(slant > WRITTEN * length[:, 0] + COMPUTED * size)
    if axis[0, :3].any() and len(skew):
        expected = "one along their line between distant nodes, else it resists a rotation of the "
        expected += "whole (or six stiffnesses, which act by rigid arms)"
        found = f"nodes {nodes[skew[0], 0]} and {nodes[skew[0], 1]} not along {member.direction!r}"
        raise wrong("direction", expected, found)
    return axis


def _masses(X: Floats, member: members.Mass) -> Block:
    """Return masses m of inertia I about their centres, at offset c from the nodes.

    Their energy is 1/2 m |u + omega x c|^2 + 1/2 omega^T I omega, with an m for each direction.
    """
    nodes = check.node_list(member.nodes, len(X))[:, None]
    inertia, c = np.asarray(member.inertia, dtype=float), np.asarray(member.offset, dtype=float)
    m = np.broadcast_to(np.asarray(member.mass, dtype=float), 3)
    inertia = np.diag(inertia) if inertia.shape == (3,) else inertia
    even = np.allclose(inertia, inertia.T, rtol=COMPUTED, atol=0)
    least = np.linalg.eigvalsh(inertia)[0] if even else -np.inf
    if least < -COMPUTED * inertia.max():
        raise wrong("inertia", "a symmetric matrix that is not negative", inertia.tolist())
    centre = np.concatenate([np.eye(3), -common.cross_matrix(c)], 1)
    M = centre.T @ (m[:, None] * centre)
    M[3:, 3:] += inertia
    return Block(member.name, nodes, 6, {}, {0: np.tile(common.symmetric(M), (len(nodes), 1, 1))})


MADE: Mapping[type, tuple[str, Callable[[Floats, Any], Block]]] = {
    members.Beams: ("group", _lines),
    members.Trusses: ("group", _lines),
    members.Solids: ("group", _solids),
    members.Spring: ("spring", _springs),
    members.Mass: ("mass", _masses),
}
"""What messages call members, and what makes blocks of them; shells are made before these."""
