"""Degrees of freedom by node and direction, as a finite-element program numbers them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.sparse import csr_array

from modefront._typing import Floats, Ints
from modefront.data.csv import read_table
from modefront.fem.check import unit_vector
from modefront.fem.structure import DIRECTIONS
from modefront.inputs import wrong
from modefront.outputs import write_table
from modefront.rounding import ACCUMULATED
from modefront.work.codec import record

COLUMNS = ("node", "direction", "weight")  # header of a file of degrees of freedom
NUMBERS = {name: k + 1 for k, name in enumerate(DIRECTIONS)}


@record
@dataclass(frozen=True, eq=False)
class DofTable:
    """Node and direction of every degree of freedom of a model.

    Several degrees of freedom may have the same node and direction, as those that a program makes
    through the thickness of a shell: the motion of the node is their weighted sum.
    """

    node: Ints  # (N,) number of the node; 0 or less where a degree of freedom belongs to none
    direction: Ints  # (N,) 1 to 6 for x, y, z, rx, ry, rz; other numbers for other quantities
    weight: Floats  # (N,) share in the motion of the node; 0 for what is no part of it

    @property
    def size(self) -> int:
        """Number of degrees of freedom N."""
        return self.node.size

    def of_direction(self, direction: str) -> list[tuple[int, float]]:
        """Return all degrees of freedom of nodes in a direction, each with the weight 1."""
        chosen = np.flatnonzero((self.direction == NUMBERS[direction]) & (self.node > 0))
        return [(dof, 1.0) for dof in chosen.tolist()]

    def sensor(self, node: int, direction: str | Sequence[float]) -> list[tuple[int, float]]:
        """Return the weighted degrees of freedom that are the motion of a node in a direction.

        The direction is ``x``, ``y``, ``z``, ``rx``, ``ry`` or ``rz``, with a minus sign for the
        opposite, or a vector of three numbers, which is scaled to the length 1. Raises LookupError,
        with what was expected and what was found, where the node does not move so.
        """
        dofs = np.flatnonzero((self.node == node) & (self.node > 0))
        if dofs.size == 0:
            nodes = np.unique(self.node[self.node > 0])
            near = nodes[np.argsort(np.abs(nodes - node), kind="stable")[:6]]
            named = ", ".join(map(str, np.sort(near).tolist())) + ", …" * (nodes.size > 6)
            raise LookupError(f"a node with degrees of freedom, {named}", str(node))
        moving, out = dofs[self.weight[dofs] != 0], list[tuple[int, float]]()
        vector = unit_vector(direction)
        for axis in np.flatnonzero(abs(vector) > ACCUMULATED).tolist():  # more is no rounding
            chosen = moving[self.direction[moving] == axis + 1]
            if chosen.size == 0:
                known = np.unique(self.direction[moving]).tolist()
                names = ", ".join(map(name_of, known)) or "none, all are held"
                expected = f"a direction in which node {node} can move ({names})"
                found = f"{name_of(axis + 1)}, which is held or not in the model"
                raise LookupError(expected, found)
            weights = float(vector[axis]) * self.weight[chosen]
            out += zip(chosen.tolist(), weights.tolist(), strict=True)
        return out

    def label(self, dof: int) -> str:
        """Return a degree of freedom as a message names it."""
        if self.node[dof] <= 0:
            return f"degree of freedom {dof} (from 0), which has no node"
        return f"node {self.node[dof]} {name_of(int(self.direction[dof]))}"


def motion_of_nodes(dofs: DofTable, nodes: Ints) -> csr_array:
    """Return weights (6 nodes, N) of x, y, z, rx, ry, rz of one after the other ascending node."""
    part = (dofs.direction >= 1) & (dofs.direction <= 6) & np.isin(dofs.node, nodes)
    chosen = np.flatnonzero(part)
    row = 6 * np.searchsorted(nodes, dofs.node[chosen]) + dofs.direction[chosen] - 1
    return csr_array((dofs.weight[chosen], (row, chosen)), shape=(6 * nodes.size, dofs.size))


def name_of(direction: int) -> str:
    """Return the name of a direction; its number where it has none."""
    return DIRECTIONS[direction - 1] if 0 < direction <= len(DIRECTIONS) else str(direction)


def write_dofs(path: Path, dofs: DofTable) -> None:
    """Write a table of degrees of freedom as CSV: one row a degree of freedom, in their order."""
    rows = zip(dofs.node.tolist(), dofs.direction.tolist(), dofs.weight.tolist(), strict=True)
    write_table(path, [COLUMNS, *((node, name_of(k), f"{w:.17g}") for node, k, w in rows)])


def read_dofs(path: Path) -> DofTable:
    """Return a table of degrees of freedom; without a column ``weight``, equal labels share 1.

    Raises InputError for a file that is not such a table.
    """
    read = read_table(path, "a table of degrees of freedom")
    if tuple(names := read.header) not in (COLUMNS, COLUMNS[:2]):
        expected = "node,direction or node,direction,weight"
        raise wrong(path, expected, ",".join(names), "header")
    read.close()
    node, direction = np.zeros((2, len(read.rows)), np.intp)
    table = DofTable(node, direction, np.ones(len(read.rows)))
    numbers = NUMBERS | {str(k): k for k in range(-1, 1000)}
    for k, (line, row) in enumerate(read.rows):
        try:
            label, name, *weight = row
            node[k], direction[k] = int(label), numbers[name]
            table.weight[k : k + len(weight)] = [float(x) for x in weight]
            if not np.isfinite(table.weight[k]):
                raise ValueError
        except (ValueError, KeyError, OverflowError):
            expected = f"a node, a direction ({', '.join(DIRECTIONS)})"
            expected += " and a weight" if len(names) > 2 else ""
            raise wrong(path, expected, ",".join(row), f"line {line}") from None
    if len(names) > 2:
        return table
    labels = np.column_stack([table.node, table.direction])
    _, inverse, counts = np.unique(labels, axis=0, return_inverse=True, return_counts=True)
    return replace(table, weight=1.0 / counts[inverse.ravel()])
