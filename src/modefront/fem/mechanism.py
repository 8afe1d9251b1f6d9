"""Mechanisms: motions of a structure that no stiffness resists, found before any solve.

Elements that share a node with rotations (beams, shells) or a face (solids) move together as
one rigid body when nothing deforms. Every such body b has the motion (t_b, omega_b), in which a
node at x has u = t_b + omega_b x (x - c_b) and omega = omega_b, all of them: u = H b.

Supports, links, nodes shared by bodies (hinges) and what resists few motions only (springs, bars,
beams with releases: u^T K u = 0 is as many rows as K has eigenvalues) each set rows of u, or the
difference of two, to zero. The null space of these rows C is what can move freely. It is found for
each part, a set of bodies that rows connect.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from modefront._typing import Bools, Floats, Ints
from modefront.errors import wrong
from modefront.fem.blocks import Block
from modefront.fem.dofs import Followers, rigid_motion
from modefront.fem.elements.solid import SOLIDS
from modefront.fem.structure import DIRECTIONS
from modefront.linalg.affine import sparse_rows
from modefront.linalg.factorisation import factorise
from modefront.rounding import ACCUMULATED, COMPUTED, WRITTEN

STEPS = 4  # of inverse iteration: each leaves of other motions the ratio of shift and eigenvalue
NAMED = 0.05  # share of a direction in a motion, over the greatest, from which the message names it


@dataclass(frozen=True)
class Bodies:
    """Rigid bodies of a structure."""

    home: Ints  # (nodes,) body, -1 for nodes without DOFs
    shared: Ints  # (ties, 2): node and a body other than its home that it belongs to
    centre: Floats  # centre, extent: (bodies, 3) and (bodies,)
    extent: Floats
    moves: Bools  # (bodies, 6) whether the motion exists: a lone node may lack rotations


def rigid_bodies(X: Floats, elements: Sequence[Block], exists: Bools) -> Bodies:
    """Bodies of the elements and of the nodes that belong to none."""
    n, label = _incidence(len(X), elements, exists).T
    _, b = np.unique(label, return_inverse=True)
    home = np.full(len(X), -1)
    home[n[::-1]] = b[::-1]  # the first of those of a node
    shared = np.stack([n, b], 1)[b != home[n]]
    members = np.bincount(b)
    centre = np.stack([np.bincount(b, weights=x) for x in X[n].T], 1) / members[:, None]
    extent = np.zeros(len(members))
    np.maximum.at(extent, b, np.linalg.norm(X[n] - centre[b], axis=1))
    alone = members == 1
    moves = np.repeat(~alone[:, None], 6, axis=1)
    np.logical_or.at(moves, b, exists[n])
    extent[alone] = float(np.ptp(X, axis=0).max()) or 1.0
    return Bodies(home, shared, centre, extent, moves)


def _incidence(nodes: int, elements: Sequence[Block], exists: Bools) -> Ints:
    """Pairs (node, body), each once: connected elements, and nodes that belong to none.

    A node of solids alone has no rotations, so that solids are connected by faces only; it belongs
    to the body of each.
    """
    none, size = np.zeros((0, 2), np.int64), nodes
    pairs, solid_pairs, corners = [none], [none], [none]
    for block in elements:
        count, k = block.cells.shape
        vertex, size = size + np.arange(count), size + count
        to_nodes = np.stack([block.cells, np.repeat(vertex[:, None], k, axis=1)], 2)
        if block.d == 6:
            pairs.append(to_nodes.reshape(-1, 2))
        else:
            solid_pairs.append(to_nodes.reshape(-1, 2))
            corners.append(to_nodes[:, : SOLIDS[k].corners].reshape(-1, 2))
    at = np.concatenate(corners)
    touched = sparse.coo_array((np.ones(len(at)), at.T[::-1]), shape=(size, nodes)).tocsr()
    common = (touched @ touched.T).tocoo()
    faces = common.data >= 3  # an edge has two corners
    edges = np.concatenate([*pairs, np.stack([common.row, common.col], 1)[faces]])
    graph = sparse.coo_array((np.ones(len(edges)), edges.T), shape=(size, size))
    _, label = connected_components(graph, directed=False)

    solid = np.concatenate(solid_pairs)
    in_solid = np.zeros(nodes, dtype=bool)
    in_solid[solid[:, 0]] = True
    turns = exists.any(1) & (exists[:, 3:].any(1) | ~in_solid)
    own = np.stack([np.flatnonzero(turns), label[:nodes][turns]], 1)
    return np.append(own, np.unique(np.stack([solid[:, 0], label[solid[:, 1]]], 1), axis=0), axis=0)


def constraint_rows(
    X: Floats, bodies: Bodies, soft: Sequence[Block], following: Sequence[Followers], held: Bools
) -> sparse.csr_array:
    """C (rows, 6 bodies), of unit length; zeros for rows that leave all motions of bodies free."""
    H = _motions(X, bodies, np.arange(len(X)), bodies.home)
    node, body = bodies.shared.T
    other = _motions(X, bodies, node, body)
    translations, one = np.arange(other.shape[0]) % 6 < 3, sparse.eye_array(H.shape[0]).tocsr()
    fixed = np.flatnonzero(held & (bodies.home >= 0)[:, None])
    own = one[(6 * node[:, None] + np.arange(3)).ravel()]
    rows = [own, *(weight for _, weight in following), one[fixed]]
    for block in soft:  # rows of displacements that its elements resist
        K = sum(block.prestress.values(), next(iter(block.stiffness.values())))
        scale = np.sqrt(np.diagonal(K, axis1=1, axis2=2).clip(0))
        unit = np.where(scale > 0, scale, 1)
        values, vectors = np.linalg.eigh(K / unit[:, :, None] / unit[:, None])
        vectors = vectors * (values > ACCUMULATED * values[:, -1:])[:, None]
        resisted = np.swapaxes(vectors, 1, 2) * unit[:, None]
        columns = np.repeat(block.dofs(), resisted.shape[1], axis=0)
        rows.append(sparse_rows(resisted.reshape(len(columns), -1), columns, H.shape[0]))
    same = sparse.vstack([other[translations], *(H[slave] for slave, _ in following)]).tocsr()
    A = sparse.vstack(rows).tocsr()
    same.resize((A.shape[0], H.shape[1]))
    C, size = A @ H - same, abs(A) @ abs(H) + abs(same)
    norm, most = (np.sqrt(np.asarray(x.power(2).sum(1)).ravel()) for x in (C, size))
    real = norm > COMPUTED * most  # less is what rounding leaves within a body
    return sparse.csr_array(sparse.diags_array(real / np.where(real, norm, 1)) @ C)


def _motions(X: Floats, bodies: Bodies, node: Ints, body: Ints) -> sparse.csr_array:
    """Return displacements of nodes in motions of bodies, six rows each, zeros for a body -1."""
    P = rigid_motion(X[node] - bodies.centre[body]) * (body >= 0)[:, None, None]
    P[:, :, 3:] /= bodies.extent[body, None, None]
    columns = np.repeat(6 * body.clip(0)[:, None] + np.arange(6), 6, axis=0)
    return sparse_rows(P.reshape(-1, 6), columns, 6 * len(bodies.extent))


def null_space(C: sparse.csr_array) -> Floats:
    """Orthonormal null space (columns, k) of C.

    The negative pivots of C^T C less a small shift say how many motions are free (Sylvester), and
    inverse iteration finds them.
    """
    gram, one = C.T @ C, sparse.eye_array(C.shape[1])
    shift = ACCUMULATED * max(float(abs(gram).sum(0).max()), 1.0)
    count = factorise(gram - shift * one).negative or 0
    N = np.random.default_rng(0).normal(size=(C.shape[1], count))
    if count:
        factor = factorise(gram + shift * one)
        for _ in range(STEPS):
            N = np.linalg.qr(factor.solve(N))[0]
    return N


def check_mechanisms(
    X: Floats,
    blocks: Sequence[Block],
    following: Sequence[Followers],
    held: Bools,
    exists: Bools,
    floating: bool,
) -> None:
    """Refuse structures with a motion that nothing resists; name the nodes that move, and how.

    A support holds the DOFs ``held`` (nodes, 6) of those that there are; a ``floating`` structure
    may move as a rigid body as a whole.
    """
    bodies = rigid_bodies(X, [block for block in blocks if block.rigid], exists)
    soft = [block for block in blocks if block.stiffness and not block.rigid]
    C = constraint_rows(X, bodies, soft, following, held)
    count = len(bodies.extent)
    touches = abs(C) @ sparse.kron(sparse.eye_array(count), np.ones((6, 1)))
    parts, part_of = connected_components(touches.T @ touches, directed=False)
    loose = 0
    for part in range(parts):
        inside = np.flatnonzero(part_of == part)
        columns = (6 * inside[:, None] + np.arange(6))[bodies.moves[inside]]
        own = C[:, columns]
        N = null_space(own)
        if floating:
            # Motions (6 bodies, 6) in which all bodies of the part move as one, scaled like C.
            arms = bodies.centre[inside] - bodies.centre[inside].mean(0)
            size = max(np.linalg.norm(arms, axis=1).max(), bodies.extent[inside].max())
            motions = np.zeros((count, 6, 6))
            motions[inside] = rigid_motion(arms)
            motions[:, :, 3:] /= size
            motions[:, 3:] *= bodies.extent[:, None, None]
            whole = motions.reshape(-1, 6)[columns]
            allowed = null_space(sparse.csr_array(own @ whole)).shape[1]
            loose += allowed > 0
            if N.shape[1] <= allowed and loose <= 1:
                continue
        if N.shape[1]:
            expected = "every part to be held by supports, springs or links"
            raise wrong("mechanism", expected, _describe(X, bodies, columns, N, parts))


def _describe(X: Floats, bodies: Bodies, columns: Ints, N: Floats, parts: int) -> str:
    """Message that names the nodes that move, how, and a likely reason."""
    share = np.zeros((len(bodies.extent), 6))
    share.ravel()[columns] = (N**2).sum(1)
    moving = np.flatnonzero(share.max(1) > WRITTEN)
    total = share[moving].sum(0)
    ways = ", ".join(DIRECTIONS[d] for d in np.flatnonzero(total > NAMED * total.max()))
    nodes = np.flatnonzero(np.isin(bodies.home, moving))
    names = ", ".join(map(str, nodes[:8].tolist())) + (", ..." if len(nodes) > 8 else "")
    centre = ", ".join(f"{c:.4g}" for c in X[nodes].mean(0))
    message = (
        f"{len(nodes)} nodes ({names}) about ({centre}) that can move freely in {ways}"
        f" ({N.shape[1]} independent motions)"
    )
    message += f". The structure falls into {parts} parts that nothing connects" * (parts > 1)
    others = np.flatnonzero((bodies.home >= 0) & ~np.isin(bodies.home, moving))
    if len(others):
        distance, first = scipy.spatial.KDTree(X[others]).query(X[nodes])
        for k in np.flatnonzero(distance <= WRITTEN * np.ptp(X, axis=0).max())[:1]:
            pair = f"Nodes {nodes[k]} and {others[first[k]]}"
            message += f". {pair} are at the same place but not the same node: merge them"
    return message
