"""Matrices of a structure as affine functions of its parameters, `modefront.linalg.affine`.

A parameter multiplies a property of named members (theta = 1 is the structure as given): Young's
modulus and density enter once, thickness as powers from t (membrane, translational mass) to t^5
(bending of thick shells), the geometric stiffness of a prestress once. Terms of equal exponents
are one term.

Static loads make internal forces: at theta = 1 the displacements u = T q under the forces f are the
solution of T^T K T q = T^T f, with forces at nodes, gravity f = M a, and the forces that make free
strains. The elements turn u into internal forces and their geometric stiffness K_G, which is linear
in them. The structure with it is stable where K + K_G is positive definite: L D L^T has no negative
pivots.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from scipy import sparse

from modefront._typing import Bools, Floats, Ints
from modefront.errors import Fault, noted, refuse, wrong
from modefront.fem.blocks import Block, blocks_of
from modefront.fem.check import check_names, check_points, node_list, unit_vector
from modefront.fem.dofs import Dofs, Followers, following_rows, hold, number_dofs
from modefront.fem.elements.common import ByPower
from modefront.fem.mechanism import check_mechanisms
from modefront.fem.structure import DIRECTIONS, Load, Parameter, Sensor, Structure
from modefront.linalg.affine import Members, Monomials, SparseAffine, sparse_affine, sparse_rows
from modefront.linalg.factorisation import Factorisation, SingularMatrixError, factorise
from modefront.rounding import WRITTEN

LINEAR = {"stiffness": ("E", "spring"), "mass": ("density", "mass"), "prestress": ("prestress",)}
"""Quantities that are plain factors of what a block has by these names."""

SensorPlaces = tuple[Ints, Floats]  # nodes (sensors,), and weights (sensors, 6) of their DOFs


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

    Raises InputError with everything that is wrong with the structure; where that is nothing, with
    what makes it a mechanism or its sensors see nothing. Says where, what was expected and found.

    Parameters
    ----------
    structure : what to assemble
    floating : whether the structure as a whole may move as a rigid body (as if hung in soft cords)
    """
    X, faults = check_points(structure.nodes), list[Fault]()
    with noted(faults):
        check_names(structure)
    blocks = blocks_of(X, structure, faults)
    following = following_rows(X, structure, faults)
    exists = _existing(X, blocks, following)
    held = np.zeros_like(exists)
    following += hold(X, structure.supports, held, exists, faults)
    places = located(X, structure.sensors, np.flatnonzero(exists.any(1)), faults)
    forces = []
    for load in structure.loads:
        with noted(faults, f"load {load.name!r}"):
            forces.append(_forces(load, blocks, exists))
    with noted(faults):
        dofs = number_dofs(exists, held, following)
    refuse(faults)
    with noted(faults):
        check_mechanisms(X, blocks, following, held, exists, floating)
    with noted(faults):
        selection = selection_of(structure.sensors, places, dofs)
    refuse(faults)
    if len(dofs.free) == 0:
        raise wrong("structure", "at least one degree of freedom that is free", "none")
    K, M = (_Terms(dofs.T, structure.parameters) for _ in range(2))
    for block in blocks:
        K.add(block, block.name, block.stiffness, "stiffness")
        M.add(block, block.name, block.mass, "mass")
        K.add(block, block.name, block.prestress, "prestress")
    factor = _stable(K.total()) if forces and not floating else None
    for load, f in zip(structure.loads, forces, strict=True):
        if factor is None:
            found = "a floating one" if floating else "another"
            raise wrong("load", "a structure that is held, and stable without it", found)
        u = dofs.T @ factor.solve((dofs.T.T @ f)[:, None])[:, 0]
        for block in blocks:
            if block.internal is not None:
                strain = load.strains.get(block.name, 0.0)
                made = block.internal().stiffness(u[block.dofs()], strain)
                K.add(block, load.name, {0: made}, "prestress")
    prestressed = forces or any(block.prestress for block in blocks)
    if prestressed and not floating and _stable(K.total()) is None:
        expected = "loads and forces below the critical ones"
        raise wrong("load", expected, "those under which the structure buckles")
    parameters = tuple(each.name for each in structure.parameters)
    sensors = tuple(each.name for each in structure.sensors)
    return StructureMatrices(K.affine(), M.affine(), parameters, sensors, selection, places, dofs)


def _existing(X: Floats, blocks: list[Block], following: list[Followers]) -> Bools:
    """Return the DOFs (nodes, 6) that anything gives stiffness or mass, or that links use."""
    exists = np.zeros((len(X), 6), dtype=bool)
    for block in blocks:
        terms = block.stiffness, block.mass, block.prestress
        parts = [part for each in terms for part in each.values()]
        used = np.any([np.diagonal(part, axis1=1, axis2=2) != 0 for part in parts], axis=0)
        exists.ravel()[block.dofs()[used]] = True
    for slave, weight in following:
        exists.ravel()[slave] = exists.ravel()[weight.indices] = True
    return exists


def _exponents(parameters: Sequence[Parameter], name: str, power: int, of: str) -> tuple[int, ...]:
    """Return those of what a name has `of` a kind, with a power of thickness."""
    powers = {"thickness": power, **dict.fromkeys(LINEAR[of], 1)}
    return tuple(powers.get(p.quantity, 0) * (name in p.of) for p in parameters)


def members_of(
    structure: Structure, T: sparse.csr_array, stiffness: Floats, mass: Floats
) -> list[Members]:
    """Return what members add to the terms by blocks, given T of `Dofs` and the exponents."""
    out = []
    for block in blocks_of(check_points(structure.nodes), structure, []):
        rows, count = T[block.dofs().ravel()], len(block.cells)
        for of, exponents in (("stiffness", stiffness), ("mass", mass)):
            order, shares = exponents.astype(int).tolist(), []
            for power, A in getattr(block, of).items():
                own = _exponents(structure.parameters, block.name, power, of)
                shares.append((np.full(count, order.index([*own])), A))
            if shares:
                out.append(Members(of, block.name, block.cells, rows, shares))
    return out


class _Terms:
    """Terms of one matrix at the free degrees of freedom, by the exponents of the parameters."""

    def __init__(self, T: sparse.csr_array, parameters: Sequence[Parameter]) -> None:
        self.T, self.parameters = T, parameters
        self.terms: dict[tuple[int, ...], sparse.csr_array] = {}

    def add(self, block: Block, name: str, parts: ByPower, of: str) -> None:
        """Add parts of a block, by the parameters of what a name has `of` a kind."""
        # Summed element by element, in the same order on either side of the diagonal.
        moved = self.T[block.dofs().ravel()]
        for power, matrices in parts.items():
            exponents, places = _exponents(self.parameters, name, power, of), len(matrices)
            each = sparse.bsr_array((matrices, np.arange(places), np.arange(places + 1))).tocsr()
            term = moved.T @ (each @ moved)
            known = self.terms.get(exponents)
            self.terms[exponents] = term if known is None else known + term

    def total(self) -> sparse.csr_array:
        """Return the matrix at theta = 1."""
        return sum(self.terms.values(), sparse.csr_array((self.T.shape[1],) * 2))

    def affine(self) -> SparseAffine:
        """Return the matrix as a function of theta, the constant term first."""
        order = sorted(self.terms, key=lambda e: (sum(e) > 0, [-k for k in e]))
        exponents = np.array(order, dtype=float).reshape(len(order), len(self.parameters))
        if (entries := max((A.nnz for A in self.terms.values()), default=0)) >= 2**31:
            raise wrong("structure", "fewer than 2^31 entries in a matrix", entries)
        # Links sum the two halves in different orders: make them equal to the last digit.
        terms = [(self.terms[e] + self.terms[e].T) / 2 for e in order]
        return sparse_affine(terms, Monomials(exponents), self.T.shape[1])


def located(X: Floats, sensors: Sequence[Sensor], used: Ints, faults: list[Fault]) -> SensorPlaces:
    """Return nodes and directions of sensors, coordinates among the nodes `used`; note faults."""
    tree = scipy.spatial.KDTree(X[used]) if used.size else None
    nodes = np.zeros(len(sensors), dtype=np.int64)
    for n, sensor in enumerate(sensors):
        with noted(faults, f"sensor {sensor.name!r}"):
            if isinstance(sensor.at, int):
                nodes[n] = node_list(sensor.at, len(X))[0]
                continue
            if tree is None:
                raise wrong("", "a node of an element", "none at all")
            point = np.asarray(sensor.at, dtype=float)
            distance, nearest = tree.query(point)
            node = nodes[n] = used[nearest]
            diagonal = float(np.linalg.norm(tree.maxes - tree.mins))
            tolerance = WRITTEN * diagonal if sensor.tolerance is None else sensor.tolerance
            if distance > tolerance:
                expected = f"a node within {tolerance:.3g} of {tuple(point.tolist())}"
                near = f"node {node} at {tuple(X[node].tolist())}, {distance:.3g} away"
                raise wrong("", expected, f"none; the nearest is {near}")
    return nodes, np.reshape([unit_vector(x.direction) for x in sensors], (-1, 6))


def selection_of(sensors: Sequence[Sensor], places: SensorPlaces, dofs: Dofs) -> sparse.csr_array:
    """Return L, CSR (sensors, free DOFs), with y = L q; refuse sensors of what cannot move.

    A sensor at node n along the unit vector a measures a . u_n = a . (T q)_n: one on a slave of a
    rigid link measures what its master moves.
    """
    nodes, directions = places
    columns = 6 * nodes[:, None] + np.arange(6)
    selection = sparse_rows(directions, columns, dofs.T.shape[0]) @ dofs.T
    faults = list[Fault]()
    for n in np.flatnonzero(abs(selection).sum(1) == 0).tolist():
        found = f"{sensors[n].direction!r} at node {nodes[n]}, which is held or has no stiffness"
        faults.append(Fault("", f"sensor {sensors[n].name!r}", "a direction that can move", found))
    refuse(faults)
    return selection


def _forces(load: Load, blocks: Sequence[Block], exists: Bools) -> Floats:
    force, a = (np.asarray(x, dtype=float) for x in (load.force, load.acceleration))
    f = np.zeros(exists.shape)
    if (load.nodes is not None) != force.any():
        raise wrong("", "nodes and a force on them", "one without the other")
    if load.nodes is not None:
        f[node_list(load.nodes, len(f)), : len(force)] = force
    for node, direction in np.argwhere((f != 0) & ~exists):
        raise wrong("", f"what resists {DIRECTIONS[direction]} of node {node}", "nothing")
    out = f.ravel()
    known = {block.name for block in blocks if block.internal is not None}
    if unknown := set(load.strains) - known:
        expected = f"the name of what has strains: {', '.join(sorted(known)) or 'none has'}"
        raise wrong("strains", expected, repr(min(unknown)))
    for block in blocks:
        pull = np.tile(np.append(a, np.zeros(3))[: block.d], block.cells.shape[1])
        parts = [M @ pull for M in block.mass.values()]
        if block.internal is not None and (strain := load.strains.get(block.name, 0.0)):
            parts.append(block.internal().free_forces(strain))
        for each in parts:
            np.add.at(out, block.dofs(), each)
    if not out.any():
        raise wrong("", "forces at nodes, an acceleration or strains", "none")
    return out


def _stable(K: sparse.csr_array) -> Factorisation | None:
    try:
        factor = factorise(K)
    except SingularMatrixError:
        return None
    return None if factor.negative else factor
