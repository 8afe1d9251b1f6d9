"""Degrees of freedom: which exist, which are held, which follow others.

Every node has six possible DOFs u = (x, y, z, rx, ry, rz); those that have stiffness or mass, or
that a link uses, exist. Supports hold some; by a rigid link those of a slave follow the master's,

    u_s = u_m + omega_m x (x_s - x_m),     omega_s = omega_m,

an interpolating coupling those of a node the mean motion of others, and a support that is not along
an axis one displacement the others of its node. So all of them are u = T q with the free ones q:
K_q = T^T K T is exact.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from scipy import sparse
from scipy.linalg import block_diag, qr

from modefront._typing import Bools, Floats, Ints
from modefront.errors import Fault, noted, wrong
from modefront.fem.check import axes_of, node_list
from modefront.fem.elements.common import attachment
from modefront.fem.structure import DIRECTIONS, Coupling, Structure, Support
from modefront.linalg.affine import sparse_rows
from modefront.rounding import ACCUMULATED, COMPUTED, WRITTEN


@dataclass(frozen=True)
class Dofs:
    """Numbering of the degrees of freedom.

    Attributes
    ----------
    free : (free, 2): node and direction of each free DOF
    T : CSR (6 nodes, free): all displacements u, row 6 node + direction, from the free ones
    """

    free: Ints
    T: sparse.csr_array


Followers: TypeAlias = tuple[Ints, sparse.csr_array]
"""Degrees of freedom that follow others, 6 node + direction, and CSR weights: u[slave] = W u."""


def following_rows(X: Floats, structure: Structure, faults: list[Fault]) -> list[Followers]:
    """Return the rows of links and couplings in which nothing is wrong; note the faults."""
    rows = []
    for n, link in enumerate(structure.links):
        with noted(faults, f"link {n}"):
            master, slaves = (node_list(nodes, len(X)) for nodes in (link.master, link.slaves))
            slaves = slaves[slaves != master[0]]
            motion = rigid_motion(X[slaves] - X[master])[:, :, None]
            masters = np.tile(master, (len(slaves), 1))
            directions = [DIRECTIONS.index(name) for name in link.directions]
            rows.append(_followers(X, slaves, masters, motion, directions))
    for n, coupling in enumerate(structure.couplings):
        with noted(faults, f"coupling {n}"):
            rows.append(_coupling(X, coupling))
    return rows


def _coupling(X: Floats, coupling: Coupling) -> Followers:
    """Return the rows of a node with the mean motion of others.

    With the displacement P_i q of node i in the rigid motion q of `node`, least squares of
    sum_i w_i |u_i - P_i q|^2 are q = (sum_i w_i P_i^T P_i)^-1 sum_i w_i P_i^T u_i.
    """
    node = node_list(coupling.node, len(X))
    of = node_list(coupling.of, len(X))
    weights = np.asarray(coupling.weights, dtype=float)
    if weights.shape not in ((), of.shape) or node[0] in of:
        expected = f"other nodes than {node[0]}, with a weight above 0 for each or for all"
        raise wrong("", expected, f"nodes {of.tolist()} and weights {weights.tolist()}")
    directions = [DIRECTIONS.index(name) for name in coupling.directions]
    size = np.ptp(X[of], axis=0).max() or 1.0
    P = rigid_motion(X[of] - X[node])[:, :3] * np.repeat([1, 1 / size], 3)
    weighted = np.broadcast_to(weights, of.shape)[:, None, None] * P
    normal = np.einsum("ndi,ndj->ij", weighted, P)
    inverse = np.linalg.pinv(normal, rcond=COMPUTED, hermitian=True)
    lost = [d for d in directions if abs(inverse[d] @ normal - np.eye(6)[d]).max() > COMPUTED]
    if lost:
        names = ", ".join(DIRECTIONS[d] for d in lost)
        expected = "nodes that are not on one line, or fewer directions"
        raise wrong("", expected, f"nodes that do not determine {names} of node {node[0]}")
    factors = np.zeros((1, 6, len(of), 6))
    factors[0, :, :, :3] = np.einsum("ij,ndj->ind", inverse, weighted)
    factors[0, 3:] /= size
    return _followers(X, node, of[None], factors, directions)


def _followers(X: Floats, slave: Ints, masters: Ints, weight: Floats, axes: list[int]) -> Followers:
    """Return rows of axes of slaves (slaves,) by factors (slaves, 6, k, 6) on their masters."""
    width = 6 * masters.shape[1]
    columns = (6 * masters[:, :, None] + np.arange(6)).reshape(-1, width)
    columns, weight = np.repeat(columns, len(axes), axis=0), weight[:, axes]
    rows = sparse_rows(weight.reshape(-1, width), columns, 6 * len(X))
    return (6 * slave[:, None] + np.array(axes)).ravel(), rows


def rigid_motion(arms: Floats) -> Floats:
    """Motions (points, 6, 6) of points at arms (points, 3) from a node, from its motion."""
    return attachment(arms[:, None])[:, 0]


def hold(
    X: Floats, supports: Sequence[Support], held: Bools, exists: Bools, faults: list[Fault]
) -> list[Followers]:
    """Hold what supports hold; return what follows where they are not along global axes.

    Rows C u = 0 of a node that are not along global axes are solved for as many of its DOFs, by
    QR with pivoting. What is held altogether is added to ``held`` (nodes, 6).
    """
    skew: dict[int, list[Floats]] = {}
    for n, each in enumerate(supports):
        with noted(faults, f"support {n}"):
            nodes = node_list(each.nodes, len(X))
            directions = [DIRECTIONS.index(name) for name in each.directions]
            if each.axes is None:
                held[nodes[:, None], directions] = True
                continue
            R = axes_of(each.axes)
            for node in nodes.tolist():
                skew.setdefault(node, []).append(block_diag(R, R)[directions])
    out = []
    for node, several in skew.items():
        C = np.concatenate([np.eye(6)[held[node]], *several]) * exists[node]
        _, R, order = qr(C, pivoting=True)
        rank = int((abs(R.diagonal()) > WRITTEN).sum())
        weight = np.zeros((rank, 6))
        weight[:, order[rank:]] = -np.linalg.solve(R[:rank, :rank], R[:rank, rank:])
        weight[abs(weight) <= ACCUMULATED] = 0
        follows, dofs = weight.any(axis=1), 6 * node + np.arange(6)
        held[node, order[:rank][~follows]] = True
        rows = sparse_rows(weight[follows], np.tile(dofs, (follows.sum(), 1)), 6 * len(X))
        out.append((dofs[order[:rank][follows]], rows))
    return out


def number_dofs(exists: Bools, held: Bools, following: Sequence[Followers]) -> Dofs:
    """Number the DOFs node by node and build T; refuse those that are slaves twice, or held too.

    A DOF ``exists`` (nodes, 6) where an element or link uses it, and a support holds those that are
    ``held`` (nodes, 6). The rows ``following`` of links, couplings and supports may be chains.
    """
    nodes = len(exists)
    none = np.zeros(0, np.int64), sparse.csr_array((0, 6 * nodes))
    slaves, weights = zip(none, *following, strict=True)
    slave, weight = np.concatenate(slaves), sparse.csr_array(sparse.vstack(weights))

    def refuse(slaves: Ints, expected: str, found: str) -> None:
        if len(slaves):
            node, direction = divmod(int(slaves[0]), 6)
            raise wrong(f"slave at node {node}, {DIRECTIONS[direction]}", expected, found)

    values, counts = np.unique(slave, return_counts=True)
    refuse(values[counts > 1], "one link, coupling or support in axes that it follows", "another")
    refuse(slave[held.ravel()[slave]], "no support but that of the master", "held by a support")

    free = (exists & ~held).ravel()
    free[slave] = False
    q = np.flatnonzero(free)
    # Slaves of slaves: u_s = A u_s + B q is (1 + A + A^2 + ...) B q, where no chain is closed.
    A, B = weight[:, slave], weight[:, q]
    total, step = B, A
    for _ in following:
        if step.nnz == 0:
            break
        total, step = total + step @ B, sparse.csr_array(step @ A)
        step.eliminate_zeros()
    refuse(slave[abs(step).sum(1) > 0], "a master that does not follow it", "one by way of others")
    all_rows = sparse.vstack([sparse.eye_array(len(q)), total], format="coo")
    places = np.append(q, slave)[all_rows.row], all_rows.col
    T = sparse.csr_array((all_rows.data, places), shape=(6 * nodes, len(q)))
    return Dofs(np.stack(np.divmod(q, 6), 1), T)
