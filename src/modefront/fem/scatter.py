r"""Assembly of all terms on one sparsity pattern.

Elements couple nodes, so the pattern is found on nodes, a few entries an element, and then
blown up: the DOFs of node i and neighbour j form a block of d_i x d_j entries. The entry
(a of i, b of j) lies at

    start(i, a) + block(i, j) + b,

start being the CSR row pointer and block the sum of d over the neighbours of i before j. Each
element entry's place is so found once, by additions, and each term is one weighted count.

========  =====================================================================
symbol    meaning
========  =====================================================================
number    (nodes, 6) number of each kept DOF, -1 where there is none
d         kept DOFs of each node
slot      place of each element entry in the data; `nnz` where it is dropped
========  =====================================================================
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy import sparse

from modefront._typing import Bools, Floats, Ints
from modefront.fem.elements.common import ElementMatrices


class InternalForces(Protocol):
    """Internal forces of displacements, and the geometric stiffness that they make."""

    def free_forces(self, strain: float) -> Floats:
        """Return forces (elements, n) that make a free strain."""

    def stiffness(self, q: Floats, strain: float) -> Floats:
        """Return K_G (elements, n, n) of displacements q (elements, n) and a free strain."""


@dataclass(frozen=True)
class Block:
    """Elements of one kind and group with their matrices.

    Attributes
    ----------
    name : of the group, spring or mass
    cells : nodes (elements, k)
    directions : the d DOFs of each node that the matrices have, ascending
    matrices : of size k d
    rigid : whether an element that nothing deforms is one rigid body with its nodes
    prestress : geometric stiffness (elements, k d, k d) of given forces; None without any
    internal : internal forces of displacements; None for elements that make no geometric stiffness
    """

    name: str
    cells: Ints
    directions: tuple[int, ...]
    matrices: ElementMatrices
    rigid: bool = False
    prestress: Floats | None = None
    internal: InternalForces | None = None

    def dofs(self) -> Ints:
        """Return 6 node + direction of each row of the matrices (elements, k d)."""
        dofs = 6 * self.cells[:, :, None] + np.array(self.directions)
        return np.asarray(dofs.reshape(len(dofs), -1))


@dataclass(frozen=True)
class Pattern:
    """CSR pattern: full, symmetric, columns ascending, every diagonal entry present."""

    indptr: Ints
    indices: Ints

    @property
    def nnz(self) -> int:
        """Count of entries."""
        return len(self.indices)


def scatter_plan(number: Ints, blocks: Sequence[Block]) -> tuple[Pattern, list[Ints]]:
    """Pattern of the kept DOFs and, for each block, the slots of its element entries."""
    nodes = len(number)
    d = (number >= 0).sum(1)
    first = np.concatenate([[0], np.cumsum(d)])
    rank = np.where(number >= 0, number - first[:-1, None], 0)

    alive = np.flatnonzero(d)
    pairs = [alive * nodes + alive]
    for block in blocks:
        pairs.append((block.cells[:, :, None] * nodes + block.cells[:, None, :]).ravel())
    keys = np.unique(np.concatenate(pairs))
    i, j = np.divmod(keys, nodes)
    before = np.concatenate([[0], np.cumsum(d[j])])
    row_start = before[np.searchsorted(i, np.arange(nodes))]
    block_start = before[:-1] - row_start[i]
    length = np.bincount(i, weights=d[j], minlength=nodes).astype(np.int64)
    indptr = np.concatenate([[0], np.cumsum(np.repeat(length, d))])

    size = d[i] * d[j]
    pair = np.repeat(np.arange(len(keys)), size)
    entry = np.arange(size.sum()) - np.repeat(np.cumsum(size) - size, size)
    a, b = np.divmod(entry, d[j][pair])
    indices = np.empty(indptr[-1], dtype=np.int64)
    indices[indptr[first[i][pair] + a] + block_start[pair] + b] = first[j][pair] + b

    slots = []
    for block, block_pairs in zip(blocks, pairs[1:], strict=True):
        count, k = block.cells.shape
        dof = number[block.cells][:, :, list(block.directions)]
        offset = rank[block.cells][:, :, list(block.directions)]
        blocks_at = block_start[np.searchsorted(keys, block_pairs)].reshape(count, k, k)
        slot = (
            indptr[dof][:, :, :, None, None]
            + blocks_at[:, :, None, :, None]
            + offset[:, None, None, :, :]
        )
        held = dof < 0
        if held.any():
            slot[held] = indptr[-1]
            np.moveaxis(slot, (3, 4), (1, 2))[held] = indptr[-1]
        slots.append(slot.ravel())
    return Pattern(indptr, indices), slots


def scatter(pattern: Pattern, slot: Ints, matrices: Floats) -> Floats:
    """Data (nnz,) of the sum of element matrices."""
    sums = np.bincount(slot, weights=matrices.ravel(), minlength=pattern.nnz + 1)
    return sums[:-1].astype(np.float64, copy=False)


def condense_links(
    pattern: Pattern, data: Floats, T: sparse.csr_array, slave: Bools
) -> tuple[Pattern, Floats]:
    """T^T K T for all terms at once, on their common pattern.

    Each entry (i, j) of K adds T_ia K_ij T_jb to (a, b). Where neither i nor j is a slave, that
    is the entry itself under a new number, and the order of the entries stays.

    Parameters
    ----------
    pattern, data : kept DOFs; data (terms, nnz)
    T : (kept, free); rows of DOFs that are no slaves have one entry, 1, in ascending columns
    slave : (kept,)
    """
    n = T.shape[1]
    count = np.diff(T.indptr)
    rows = np.repeat(np.arange(len(count)), np.diff(pattern.indptr))
    linked = slave[rows] | slave[pattern.indices]
    number = np.zeros(len(count), dtype=np.int64)
    number[~slave] = T.indices[T.indptr[:-1][~slave]]
    plain = number[rows[~linked]] * n + number[pattern.indices[~linked]]

    i, j = rows[linked], pattern.indices[linked]
    size = count[i] * count[j]
    source = np.repeat(np.arange(len(i)), size)
    entry = np.arange(len(source)) - np.repeat(np.cumsum(size) - size, size)
    at_i, at_j = np.divmod(entry, count[j][source])
    at_i, at_j = T.indptr[i][source] + at_i, T.indptr[j][source] + at_j
    keys = T.indices[at_i].astype(np.int64) * n + T.indices[at_j]
    weight = T.data[at_i] * T.data[at_j]

    # Masters may be without elements of their own: their diagonal entries are new as well.
    kept = np.unique(np.concatenate([keys, np.arange(n, dtype=np.int64) * (n + 1)]))
    place = np.searchsorted(plain, kept)
    new = np.append(plain, -1)[place] != kept
    merged = np.insert(plain, place[new], kept[new])
    stays = np.ones(len(merged), dtype=bool)
    stays[place[new] + np.arange(int(new.sum()))] = False

    row, column = np.divmod(kept, n)
    slot = np.searchsorted(kept, keys)
    mirror = np.searchsorted(kept, column * n + row)
    places = np.searchsorted(merged, kept)
    condensed = np.zeros((len(data), len(merged)))
    for out, term in zip(condensed, data, strict=True):
        out[stays] = term[~linked]
        added = np.bincount(slot, weights=weight * term[linked][source], minlength=len(kept))
        # The two halves were summed in different orders: make them equal to the last digit.
        out[places] += (added + added[mirror]) / 2
    indptr = np.searchsorted(merged, np.arange(n + 1, dtype=np.int64) * n)
    return Pattern(indptr, merged % n), condensed
