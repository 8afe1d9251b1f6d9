r"""Matrices of a structure as affine functions of its parameters, `modefront.linalg.affine`.

    K(theta) = sum_j c_j(theta) K_j,   M(theta) = sum_j d_j(theta) M_j,
    c_j(theta) = prod_i theta_i ** e_ji.

A parameter multiplies a property of named members (theta = 1 is the structure as given): Young's
modulus and density enter once, thickness as t (membrane, translational mass) and t^3 (bending,
rotary inertia). Terms of equal exponents are one term.

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

from modefront._typing import Bools, Floats, Ints
from modefront.fem.blocks import element_blocks, mass_blocks, spring_blocks
from modefront.fem.check import check_names, check_parameters, check_points, node_list
from modefront.fem.dofs import Dofs, LinkRows, direction_indices, link_rows, number_dofs
from modefront.fem.elements.common import Part
from modefront.fem.mechanism import check_mechanisms
from modefront.fem.scatter import Block, Pattern, condense_links, scatter, scatter_plan
from modefront.fem.section import Checks, FemError
from modefront.fem.sensors import SensorPlaces, selection_matrix, sensor_places
from modefront.fem.structure import Link, Parameter, Structure, Support
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
    elements = element_blocks(X, structure.groups, checks)
    springs = spring_blocks(X, structure.springs, checks)
    blocks = [*elements, *springs, *mass_blocks(X, structure.masses, checks)]
    links = _links(X, structure, checks)
    held = _held(X, structure, checks)
    exists = _existing(X, blocks, links)
    used = np.flatnonzero(exists.any(1))
    places = sensor_places(X, structure.sensors, used, checks)
    dofs = checks.attempt(number_dofs, exists, held, links)
    checks.close()
    if dofs is None or places is None:
        raise FemError("structure: expected one that can be numbered")
    checks.attempt(check_mechanisms, X, elements, springs, links, held, exists, floating)
    selection = checks.attempt(selection_matrix, structure.sensors, places, dofs)
    checks.close()
    if selection is None or len(dofs.free) == 0:
        raise FemError("structure: no degree of freedom is free; expected at least one")
    pattern, slots = scatter_plan(dofs.kept, blocks)
    K, K_exponents = _terms(
        pattern,
        [(b, s, b.matrices.stiffness) for b, s in zip(blocks, slots, strict=True)],
        structure.parameters,
        ("E", "spring"),
    )
    M, M_exponents = _terms(
        pattern,
        [(b, s, b.matrices.mass) for b, s in zip(blocks, slots, strict=True)],
        structure.parameters,
        ("density", "mass"),
    )
    if pattern.nnz >= np.iinfo(np.int32).max:
        raise FemError(f"structure: {pattern.nnz} entries in K, expected fewer than 2^31")
    if dofs.slave.any():
        T = dofs.T[np.flatnonzero(dofs.kept.ravel() >= 0)]
        pattern, data = condense_links(pattern, np.concatenate([K, M]), T, dofs.slave)
        K, M = data[: len(K)], data[len(K) :]
    return StructureMatrices(
        stiffness=_affine(pattern, K, K_exponents),
        mass=_affine(pattern, M, M_exponents),
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


def _links(X: Floats, structure: Structure, checks: Checks) -> list[LinkRows]:
    rows = (checks.attempt(_link, X, link, f"link {n}") for n, link in enumerate(structure.links))
    return [row for row in rows if row is not None]


def _link(X: Floats, link: Link, place: str) -> LinkRows:
    master = node_list(link.master, len(X), place)
    slaves = node_list(link.slaves, len(X), place)
    return link_rows(X, master[0], slaves, direction_indices(link.directions, place))


def _held(X: Floats, structure: Structure, checks: Checks) -> Bools:
    held = np.zeros((len(X), 6), dtype=bool)
    for n, support in enumerate(structure.supports):
        checks.attempt(_hold, held, support, f"support {n}")
    return held


def _hold(held: Bools, support: Support, place: str) -> None:
    nodes = node_list(support.nodes, len(held), place)
    held[nodes[:, None], direction_indices(support.directions, place)] = True


def _existing(X: Floats, blocks: list[Block], links: list[LinkRows]) -> Bools:
    exists = np.zeros((len(X), 6), dtype=bool)
    for block in blocks:
        exists[np.unique(block.cells)[:, None], list(block.directions)] = True
    for link in links:
        exists.ravel()[link.slave] = True
        exists.ravel()[link.master[link.weight != 0]] = True
    return exists


def _terms(
    pattern: Pattern,
    contributions: list[tuple[Block, Ints, tuple[Part, ...]]],
    parameters: Sequence[Parameter],
    linear: tuple[str, str],
) -> tuple[Floats, Ints]:
    """Data (terms, nnz) and exponents (terms, parameters); `linear` are the plain factors."""
    terms: dict[tuple[int, ...], Floats] = {}
    for block, slot, parts in contributions:
        for part in parts:
            exponents = tuple(
                (1 if p.quantity in linear else part.power if p.quantity == "thickness" else 0)
                * (block.name in p.of)
                for p in parameters
            )
            data = scatter(pattern, slot, part.matrices)
            if exponents in terms:
                terms[exponents] += data
            else:
                terms[exponents] = data
    order = sorted(terms, key=lambda e: (sum(e) > 0, [-k for k in e]))
    return (
        np.array([terms[e] for e in order]).reshape(len(order), pattern.nnz),
        np.array(order, dtype=np.int64).reshape(len(order), len(parameters)),
    )
