r"""Degrees of freedom: which exist, which are held, which follow others.

Every node has six possible DOFs u = (x, y, z, rx, ry, rz); those that an element, mass,
spring or link touches exist. Supports hold some; a rigid link makes those of a slave node
follow the master's,

    u_s = u_m + omega_m x (x_s - x_m),     omega_s = omega_m,

so that all of them are u = T q with the free ones q: K_q = T^T K T is exact.

========  =====================================================================
symbol    meaning
========  =====================================================================
kept      DOFs that exist and are not held (free and slaves); columns of K
q         free DOFs: kept and not slaves
T         (6 nodes, free)
========  =====================================================================
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from modefront._typing import Bools, Floats, Ints
from modefront.fem.elements.common import cross_matrix
from modefront.fem.section import FemError

DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")


def direction_indices(directions: Sequence[str], place: str) -> list[int]:
    """Columns of `directions` in (x, y, z, rx, ry, rz).

    Raises
    ------
    FemError
        If a name is not one of them, or there is none.
    """
    for name in directions:
        if name not in DIRECTIONS:
            raise FemError(f"{place}: direction must be one of {DIRECTIONS}, found {name!r}")
    if not directions:
        raise FemError(f"{place}: no direction is given, expected some of {DIRECTIONS}")
    return [DIRECTIONS.index(name) for name in directions]


@dataclass(frozen=True)
class Dofs:
    """Numbering of the degrees of freedom.

    Attributes
    ----------
    kept : (nodes, 6) number among the kept DOFs, -1 where there is none
    free : (free, 2): node and direction of each free DOF
    T : CSR (6 nodes, free): all displacements u, row 6 node + direction, from the free ones
    slave : (kept,) whether the DOF follows others
    """

    kept: Ints
    free: Ints
    T: sparse.csr_array
    slave: Bools

    def name(self, q: int) -> str:
        """Readable name of the free DOF q."""
        node, direction = self.free[q]
        return f"node {node}, {DIRECTIONS[direction]}"


@dataclass(frozen=True)
class LinkRows:
    """Rigid links as rows: slave DOF = sum of weights times master DOFs.

    Attributes
    ----------
    slave : (rows,) 6 node + direction
    master, weight : (rows, 3): 6 node + direction and factor; unused entries have weight 0
    """

    slave: Ints
    master: Ints
    weight: Floats


def link_rows(X: Floats, master: int, slaves: Ints, directions: Sequence[int]) -> LinkRows:
    """Rows of one rigid link from `master` to `slaves` in the given directions."""
    lever = -cross_matrix(X[slaves] - X[master])
    slave, masters, weight = [], [], []
    for d in directions:
        slave.append(6 * slaves + d)
        columns, w = np.full((len(slaves), 3), 6 * master + d), np.zeros((len(slaves), 3))
        w[:, 0] = 1
        if d < 3:
            e, f = (d + 1) % 3, (d + 2) % 3
            columns[:, 1:] = 6 * master + 3 + np.array([e, f])
            w[:, 1:] = lever[:, d, [e, f]]
        masters.append(columns)
        weight.append(w)
    return LinkRows(np.concatenate(slave), np.concatenate(masters), np.concatenate(weight))


def number_dofs(exists: Bools, held: Bools, links: Sequence[LinkRows]) -> Dofs:
    """Number the DOFs node by node and build T.

    Parameters
    ----------
    exists, held : (nodes, 6), true where an element or link uses the DOF, where a support holds it
    links : rows of all rigid links

    Raises
    ------
    FemError
        If a DOF is slave twice, slave and held, or slave and master.
    """
    nodes = len(exists)
    slave = np.concatenate([link.slave for link in links] + [np.zeros(0, np.int64)])
    masters = np.concatenate([link.master for link in links] + [np.zeros((0, 3), np.int64)])
    weight = np.concatenate([link.weight for link in links] + [np.zeros((0, 3))])

    def refuse(wrong: Ints, what: str) -> None:
        if len(wrong):
            node, direction = divmod(int(wrong[0]), 6)
            raise FemError(f"link: node {node}, {DIRECTIONS[direction]} is a slave and {what}")

    values, counts = np.unique(slave, return_counts=True)
    refuse(values[counts > 1], "a slave of another link; expected one master for each")
    refuse(slave[held.ravel()[slave]], "held by a support; put the support on the master")
    used = masters[weight != 0]
    refuse(np.intersect1d(slave, used), "a master as well; link all slaves to one master")

    kept_mask = (exists & ~held).ravel()
    free_mask = kept_mask.copy()
    free_mask[slave] = False
    kept = np.where(kept_mask, np.cumsum(kept_mask) - 1, -1)
    free = np.where(free_mask, np.cumsum(free_mask) - 1, -1)
    q = np.flatnonzero(free_mask)
    rows = np.concatenate([q, np.repeat(slave, 3)])
    columns = np.concatenate([free[q], free[masters].ravel()])
    values = np.concatenate([np.ones(len(q)), weight.ravel()])
    present = (columns >= 0) & (values != 0)
    T = sparse.csr_array(
        (values[present], (rows[present], columns[present])), shape=(6 * nodes, len(q))
    )
    return Dofs(
        kept.reshape(nodes, 6),
        np.stack(np.divmod(q, 6), 1),
        T,
        ~free_mask[kept_mask],
    )
