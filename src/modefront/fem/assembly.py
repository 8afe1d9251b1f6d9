r"""Matrices of a structure as affine functions of its parameters, `modefront.linalg.affine`.

    K(theta) = sum_j c_j(theta) K_j,   M(theta) = sum_j d_j(theta) M_j,
    c_j(theta) = prod_i theta_i ** e_ji.

A parameter multiplies a property of named members (theta = 1 is the structure as given): Young's
modulus and density enter once, thickness as powers from t (membrane, translational mass) to t^5
(bending of thick shells), the geometric stiffness of a prestress once. Terms of equal exponents
are one term.

==========  ================================================================
symbol      meaning
==========  ================================================================
theta       parameters, factors on nominal values
e_ji        exponent of parameter i in term j
T           (6 nodes, free DOFs): all displacements from the free ones
==========  ================================================================
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.linalg import block_diag

from modefront._typing import Bools, Floats, Ints
from modefront.fem.blocks import element_blocks, mass_blocks, spring_blocks
from modefront.fem.check import axes_of, check_names, check_parameters, check_points, node_list
from modefront.fem.dofs import (
    Dofs,
    Followers,
    direction_indices,
    hold,
    mean_motion,
    number_dofs,
    rigid_link,
)
from modefront.fem.elements.common import Part
from modefront.fem.mechanism import check_mechanisms
from modefront.fem.prestress import check_stability, load_forces, static_state, strain
from modefront.fem.scatter import Block, Pattern, condense_links, scatter, scatter_plan
from modefront.fem.section import Checks, FemError
from modefront.fem.sensors import SensorPlaces, selection_matrix, sensor_places
from modefront.fem.structure import Coupling, Link, Parameter, Structure, Support
from modefront.linalg.affine import Monomials, SparseAffine


@dataclass(frozen=True)
class StructureMatrices:
    """Matrices of a structure at its free degrees of freedom.

    Attributes
    ----------
    stiffness, mass : K(theta) and M(theta), each on its own pattern, since masses couple far fewer
        degrees of freedom than stiffnesses; a constant term comes first
    parameters : names of the parameters, in the order of theta
    sensors : names of the sensors
    selection : (sensors, free degrees of freedom) displacement at each sensor
    places : where the sensors are, and in which directions they measure
    dofs : numbering; ``dofs.T`` gives all displacements from the free ones
    """

    stiffness: SparseAffine
    mass: SparseAffine
    parameters: tuple[str, ...]
    sensors: tuple[str, ...]
    selection: sparse.csr_array
    places: SensorPlaces
    dofs: Dofs


def assemble(structure: Structure, *, floating: bool = False) -> StructureMatrices:
    """Check a structure and assemble its terms.

    Parameters
    ----------
    structure : what to assemble
    floating : whether the structure as a whole may move as a rigid body (as if hung in soft cords)

    Raises
    ------
    FemError
        With everything that is wrong with the structure; where that is nothing, with what makes
        it a mechanism or its sensors see nothing. Says where, what was expected and found.
    """
    X, checks = check_points(structure.nodes), Checks()
    checks.attempt(check_names, structure)
    checks.attempt(check_parameters, structure)
    blocks = [
        *element_blocks(X, structure.groups, structure.varied_thickness, checks),
        *spring_blocks(X, structure.springs, checks),
        *mass_blocks(X, structure.masses, checks),
    ]
    following = _following(X, structure, checks)
    exists = _existing(X, blocks, following)
    held = np.zeros_like(exists)
    following += _hold(X, structure, held, exists, checks)
    places = sensor_places(X, structure.sensors, np.flatnonzero(exists.any(1)), checks)
    forces = load_forces(structure.loads, blocks, exists, checks)
    dofs = checks.attempt(number_dofs, exists, held, following)
    checks.close()
    if dofs is None or places is None:
        raise FemError("structure: expected one that can be numbered")
    checks.attempt(check_mechanisms, X, blocks, following, held, exists, floating)
    selection = checks.attempt(selection_matrix, structure.sensors, places, dofs)
    checks.close()
    if selection is None or len(dofs.free) == 0:
        raise FemError("structure: no degree of freedom is free; expected at least one")
    pattern, slots = scatter_plan(dofs.kept, blocks)
    if pattern.nnz >= np.iinfo(np.int32).max:
        raise FemError(f"structure: {pattern.nnz} entries in K, expected fewer than 2^31")
    each = list(zip(blocks, slots, strict=True))
    K = _Terms(pattern, structure.parameters)
    for block, slot in each:
        K.add(block.name, slot, block.matrices.stiffness, ("E", "spring"))
        if block.prestress is not None:
            K.add(block.name, slot, (Part(0, block.prestress),), ("prestress",))
    if forces:
        at = static_state(pattern, K.total(), dofs, forces, floating)
        for block, slot in each:
            if block.internal is None:
                continue
            internal = block.internal()
            for load, u in zip(structure.loads, at, strict=True):
                made = internal.stiffness(u[block.dofs()], strain(load, block.name))
                K.add(load.name, slot, (Part(0, made),), ("prestress",))
    if not floating and (forces or any(block.prestress is not None for block in blocks)):
        check_stability(pattern, K.total(), dofs)
    M = _Terms(pattern, structure.parameters)
    for block, slot in each:
        M.add(block.name, slot, block.matrices.mass, ("density", "mass"))
    (K_data, K_exponents), (M_data, M_exponents) = K.sorted(), M.sorted()
    if dofs.slave.any():
        T = dofs.T[np.flatnonzero(dofs.kept.ravel() >= 0)]
        pattern, data = condense_links(pattern, np.concatenate([K_data, M_data]), T, dofs.slave)
        K_data, M_data = data[: len(K_data)], data[len(K_data) :]
    return StructureMatrices(
        stiffness=_affine(pattern, K_data, K_exponents),
        mass=_affine(pattern, M_data, M_exponents),
        parameters=tuple(p.name for p in structure.parameters),
        sensors=tuple(s.name for s in structure.sensors),
        selection=selection,
        dofs=dofs,
        places=places,
    )


def _affine(pattern: Pattern, data: Floats, exponents: Ints) -> SparseAffine:
    """Return the matrix of terms (terms, nnz) on the entries that are not zero in all of them."""
    kept = data.any(axis=0)
    indptr = np.append(0, np.cumsum(kept, dtype=np.int32))[pattern.indptr].astype(np.int32)
    terms = sparse.csc_array(data[:, kept].T)
    coefficients = Monomials(exponents.astype(float))
    return SparseAffine(indptr, pattern.indices[kept].astype(np.int32), terms, coefficients)


def _following(X: Floats, structure: Structure, checks: Checks) -> list[Followers]:
    """Return the rows of links and couplings in which nothing is wrong."""
    rows = [
        *(checks.attempt(_link, X, link, f"link {n}") for n, link in enumerate(structure.links)),
        *(
            checks.attempt(_coupling, X, coupling, f"coupling {n}")
            for n, coupling in enumerate(structure.couplings)
        ),
    ]
    return [row for row in rows if row is not None]


def _link(X: Floats, link: Link, place: str) -> Followers:
    master = node_list(link.master, len(X), place)
    slaves = node_list(link.slaves, len(X), place)
    slaves = slaves[slaves != master[0]]
    return rigid_link(X, master[0], slaves, direction_indices(link.directions, place))


def _coupling(X: Floats, coupling: Coupling, place: str) -> Followers:
    node = node_list(coupling.node, len(X), place)[0]
    of = node_list(coupling.of, len(X), place)
    weights = np.asarray(coupling.weights, dtype=float)
    if weights.shape not in ((), of.shape) or not (weights > 0).all() or node in of:
        raise FemError(
            f"{place}: expected other nodes than {node}, with a weight above 0 for each or for all,"
            f" found nodes {of.tolist()} and weights {weights.tolist()}"
        )
    directions = direction_indices(coupling.directions, place)
    return mean_motion(X, node, of, np.broadcast_to(weights, of.shape), directions, place)


def _hold(
    X: Floats, structure: Structure, held: Bools, exists: Bools, checks: Checks
) -> list[Followers]:
    """Hold what supports hold; return what follows where they are not along global axes."""
    skew: list[tuple[Ints, Floats]] = []

    def support(each: Support, place: str) -> None:
        nodes = node_list(each.nodes, len(X), place)
        directions = direction_indices(each.directions, place)
        R = axes_of(each.axes, place)
        if each.axes is None:
            held[nodes[:, None], directions] = True
        else:
            skew.append((nodes, block_diag(R, R)[directions]))

    for n, each in enumerate(structure.supports):
        checks.attempt(support, each, f"support {n}")
    return hold(held, exists, skew)


def _existing(X: Floats, blocks: list[Block], following: list[Followers]) -> Bools:
    """Return the DOFs (nodes, 6) that anything gives stiffness or mass, or that links use."""
    exists = np.zeros((len(X), 6), dtype=bool)
    for block in blocks:
        parts = [part.matrices for part in (*block.matrices.stiffness, *block.matrices.mass)]
        if block.prestress is not None:
            parts.append(block.prestress)
        used = np.any([np.diagonal(part, axis1=1, axis2=2) != 0 for part in parts], axis=0)
        exists.ravel()[block.dofs()[used]] = True
    for each in following:
        exists.ravel()[each.slave] = True
        exists.ravel()[each.weight.indices] = True
    return exists


class _Terms:
    """Terms of one matrix: data (nnz,) by the exponents of the parameters."""

    def __init__(self, pattern: Pattern, parameters: Sequence[Parameter]) -> None:
        self.pattern, self.parameters = pattern, parameters
        self.terms: dict[tuple[int, ...], Floats] = {}

    def add(self, name: str, slot: Ints, parts: Sequence[Part], linear: Sequence[str]) -> None:
        """Add parts of elements of a name; `linear` are the quantities that are plain factors."""
        for part in parts:
            exponents = tuple(
                (1 if p.quantity in linear else part.power if p.quantity == "thickness" else 0)
                * (name in p.of)
                for p in self.parameters
            )
            data = scatter(self.pattern, slot, part.matrices)
            self.terms[exponents] = (
                self.terms[exponents] + data if exponents in self.terms else data
            )

    def total(self) -> Floats:
        """Return the data (nnz,) at theta = 1."""
        return np.sum(list(self.terms.values()), axis=0)

    def sorted(self) -> tuple[Floats, Ints]:
        """Return data (terms, nnz) and exponents (terms, parameters), the constant term first."""
        order = sorted(self.terms, key=lambda e: (sum(e) > 0, [-k for k in e]))
        return (
            np.array([self.terms[e] for e in order]).reshape(len(order), self.pattern.nnz),
            np.array(order, dtype=np.int64).reshape(len(order), len(self.parameters)),
        )
