"""Prestress: static loads, the internal forces that they make, and whether these buckle it.

At theta = 1 the displacements u = T q under the forces f are the solution of T^T K T q = T^T f,
with forces at nodes, gravity f = M a, and the forces that make free strains. The elements turn u
into internal forces and their geometric stiffness K_G, which is linear in them. The structure with
it is stable where K + K_G is positive definite: L D L^T has no negative pivots.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import sparse

from modefront._typing import Bools, Floats
from modefront.fem.blocks import Block
from modefront.fem.check import node_list
from modefront.fem.section import Checks, FemError
from modefront.fem.structure import DIRECTIONS, Load
from modefront.linalg.factorisation import Factorisation, SingularMatrixError, factorise


def load_forces(
    loads: Sequence[Load], blocks: Sequence[Block], exists: Bools, checks: Checks
) -> list[Floats]:
    """Return the forces (6 nodes,) of each load in which nothing is wrong."""
    forces = (checks.attempt(f"load {x.name!r}", _forces, x, blocks, exists) for x in loads)
    return [f for f in forces if f is not None]


def _forces(load: Load, blocks: Sequence[Block], exists: Bools) -> Floats:
    force, a = (np.asarray(x, dtype=float) for x in (load.force, load.acceleration))
    if force.shape not in ((3,), (6,)) or a.shape != (3,) or not np.isfinite([*force, *a]).all():
        found = f"{load.force!r} and {load.acceleration!r}"
        raise FemError(f"expected a force (3,) or (6,) and an acceleration (3,), found {found}")
    f = np.zeros(exists.shape)
    if (np.size(load.nodes) > 0) != force.any():
        raise FemError("expected nodes and a force on them, found one without the other")
    if force.any():
        f[node_list(load.nodes, len(f)), : len(force)] = force
    nowhere = np.argwhere((f != 0) & ~exists)
    if len(nowhere):
        node, direction = nowhere[0]
        raise FemError(f"nothing resists {DIRECTIONS[direction]} of node {node}")
    out = f.ravel()
    known = {block.name for block in blocks if block.internal is not None}
    if unknown := set(load.strains) - known:
        names = ", ".join(sorted(known)) or "none"
        raise FemError(f"nothing named {min(unknown)!r} has strains; those that do: {names}")
    for block in blocks:
        pull = np.tile(np.append(a, np.zeros(3))[list(block.directions)], block.cells.shape[1])
        parts = [M @ pull for M in block.matrices.mass.values()]
        if block.internal is not None and (strain := load.strains.get(block.name, 0.0)):
            parts.append(block.internal().free_forces(strain))
        for each in parts:
            np.add.at(out, block.dofs(), each)
    if not out.any():
        raise FemError("expected forces at nodes, an acceleration or strains, found none")
    return out


def static_state(
    K: sparse.csr_array, T: sparse.csr_array, forces: Sequence[Floats], floating: bool
) -> list[Floats]:
    """Return the displacements (6 nodes,) under each of the forces.

    Raises FemError if nothing holds the structure, or it is not stable without the loads.
    """
    if floating:
        raise FemError("load: expected a structure that is held, found a floating one")
    factor = _stable(K)
    if factor is None:
        raise FemError("load: expected a structure that is stable without it, found another")
    return [T @ factor.solve((T.T @ f)[:, None])[:, 0] for f in forces]


def check_stability(K: sparse.csr_array) -> None:
    """Refuse loads under which the structure buckles."""
    if _stable(K) is None:
        raise FemError(
            "load: expected loads and forces below the critical ones, but under them the structure"
            " buckles"
        )


def _stable(K: sparse.csr_array) -> Factorisation | None:
    """Return the factor of K; None where it is not positive definite."""
    try:
        factor = factorise(K)
    except SingularMatrixError:
        return None
    return None if factor.negative else factor
