r"""Matrices of a structure as affine functions of its parameters.

    K(theta) = sum_j c_j(theta) K_j,   M(theta) = sum_j d_j(theta) M_j,
    c_j(theta) = prod_i theta_i ** e_ji,

all K_j and M_j on one sparsity pattern. A parameter multiplies a property of named members
(theta = 1 is the structure as given): Young's modulus and density enter once, thickness as t
(membrane, translational mass) and t^3 (bending, rotary inertia). Terms of equal exponents are
one term.

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
import numpy.typing as npt
from scipy import sparse

from modefront.fem.assembly import Block, Pattern, condense_links, scatter, scatter_plan
from modefront.fem.blocks import element_blocks, mass_blocks, spring_blocks
from modefront.fem.check import check_names, check_parameters, check_points, node_list
from modefront.fem.dofs import BoolArray, Dofs, LinkRows, direction_indices, link_rows, number_dofs
from modefront.fem.elements.kit import Part
from modefront.fem.elements.shapes import FloatArray, IntArray
from modefront.fem.errors import FemError
from modefront.fem.mechanism import check_mechanisms
from modefront.fem.sensors import selection_matrix
from modefront.fem.structure import Parameter, Structure

IndexArray = npt.NDArray[np.int32]


@dataclass(frozen=True)
class AffineMatrices:
    """Matrices of a structure, K(theta) and M(theta), on one pattern.

    Attributes
    ----------
    indptr, indices
        CSR pattern of the free DOFs: full, symmetric, sorted, with every diagonal entry; of 32
        bits, as the sparse solvers want them.
    stiffness_data, mass_data
        (terms, nnz).
    stiffness_exponents, mass_exponents
        (terms, parameters), integers; the constant term, if there is one, comes first.
    parameters
        Names.
    sensors
        Names.
    selection
        CSR (sensors, free DOFs).
    dofs
        Numbering; `dofs.T` gives all displacements from the free ones.
    """

    indptr: IndexArray
    indices: IndexArray
    stiffness_data: FloatArray
    stiffness_exponents: IntArray
    mass_data: FloatArray
    mass_exponents: IntArray
    parameters: tuple[str, ...]
    sensors: tuple[str, ...]
    selection: sparse.csr_array
    dofs: Dofs

    def stiffness(self, theta: npt.ArrayLike) -> sparse.csr_array:
        """K at parameters theta (parameters,)."""
        return self._matrix(self.stiffness_data, self.stiffness_exponents, theta)

    def mass(self, theta: npt.ArrayLike) -> sparse.csr_array:
        """M at parameters theta (parameters,)."""
        return self._matrix(self.mass_data, self.mass_exponents, theta)

    def _matrix(
        self, data: FloatArray, exponents: IntArray, theta: npt.ArrayLike
    ) -> sparse.csr_array:
        c = np.prod(np.asarray(theta, dtype=float) ** exponents, axis=1)
        n = len(self.indptr) - 1
        return sparse.csr_array((c @ data, self.indices, self.indptr), shape=(n, n))


def assemble(structure: Structure, *, floating: bool = False) -> AffineMatrices:
    """Check a structure and assemble its terms.

    Parameters
    ----------
    structure
        What to assemble.
    floating
        Whether the structure as a whole may move as a rigid body (as if hung in soft cords).

    Raises
    ------
    FemError
        If the structure is wrong or a mechanism: says where, what was expected and found.
    """
    X = check_points(structure.nodes)
    check_names(structure)
    check_parameters(structure)
    elements = element_blocks(X, structure.groups)
    springs = spring_blocks(X, structure.springs)
    blocks = [*elements, *springs, *mass_blocks(X, structure.masses)]
    links = _links(X, structure)
    held = _held(X, structure)
    exists = _existing(X, blocks, links)
    dofs = number_dofs(exists, held, links)
    check_mechanisms(X, elements, springs, links, held, exists, floating)
    if len(dofs.free) == 0:
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
    return AffineMatrices(
        indptr=pattern.indptr.astype(np.int32),
        indices=pattern.indices.astype(np.int32),
        stiffness_data=K,
        stiffness_exponents=K_exponents,
        mass_data=M,
        mass_exponents=M_exponents,
        parameters=tuple(p.name for p in structure.parameters),
        sensors=tuple(s.name for s in structure.sensors),
        selection=selection_matrix(X, structure.sensors, np.flatnonzero(exists.any(1)), dofs),
        dofs=dofs,
    )


def _links(X: FloatArray, structure: Structure) -> list[LinkRows]:
    rows = []
    for n, link in enumerate(structure.links):
        place = f"link {n}"
        master = node_list(link.master, len(X), place)
        slaves = node_list(link.slaves, len(X), place)
        rows.append(link_rows(X, master[0], slaves, direction_indices(link.directions, place)))
    return rows


def _held(X: FloatArray, structure: Structure) -> BoolArray:
    held = np.zeros((len(X), 6), dtype=bool)
    for n, support in enumerate(structure.supports):
        place = f"support {n}"
        nodes = node_list(support.nodes, len(X), place)
        held[nodes[:, None], direction_indices(support.directions, place)] = True
    return held


def _existing(X: FloatArray, blocks: list[Block], links: list[LinkRows]) -> BoolArray:
    exists = np.zeros((len(X), 6), dtype=bool)
    for block in blocks:
        exists[np.unique(block.cells)[:, None], list(block.directions)] = True
    for link in links:
        exists.ravel()[link.slave] = True
        exists.ravel()[link.master[link.weight != 0]] = True
    return exists


def _terms(
    pattern: Pattern,
    contributions: list[tuple[Block, IntArray, tuple[Part, ...]]],
    parameters: Sequence[Parameter],
    linear: tuple[str, str],
) -> tuple[FloatArray, IntArray]:
    """Data (terms, nnz) and exponents (terms, parameters); `linear` are the plain factors."""
    terms: dict[tuple[int, ...], FloatArray] = {}
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
