"""Groups of a mesh that are no part of the model."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from modefront.fem.mesh import Mesh


@dataclass(frozen=True)
class UnusedGroup:
    """A group of cells of which the model has no elements, and which holds nothing either.

    Attributes
    ----------
    name : of the group
    type : of its cells, as VTK says
    cells : their number
    """

    name: str
    type: str
    cells: int


def unused_groups(mesh: Mesh, elements: Iterable[str], nodes: Iterable[str]) -> list[UnusedGroup]:
    """Return the groups that the model uses neither for ``elements`` nor for ``nodes``.

    A group that shares all of its cells with those that have elements is another name for them.
    """
    with_elements = set(elements)
    used = with_elements.union(nodes)
    made = {
        tuple(sorted(cell))
        for block in mesh.blocks
        if block.group in with_elements
        for cell in block.cells.tolist()
    }
    out: dict[str, UnusedGroup] = {}
    for block in mesh.blocks:
        if block.group in used or block.group in out or _is_made(block.cells.tolist(), made):
            continue
        out[block.group] = UnusedGroup(block.group, block.type, len(block.cells))
    return list(out.values())


def _is_made(cells: Sequence[Sequence[int]], made: set[tuple[int, ...]]) -> bool:
    return all(tuple(sorted(cell)) in made for cell in cells)
