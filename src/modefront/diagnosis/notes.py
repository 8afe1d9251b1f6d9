"""What looks wrong in the reading of a study, before any model is solved."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.fem.mesh import Mesh

ALONG = 0.99
"""Component of a direction from which on it is one along an axis."""

SIX = ("x", "y", "z", "rx", "ry", "rz")


@dataclass(frozen=True)
class DataDirection:
    """A sensor has another direction in the model than the degree of freedom of the data it takes.

    Attributes
    ----------
    sensor : its name
    model, data : directions
    """

    sensor: str
    model: str
    data: str
    kind = "data-direction"

    def __str__(self) -> str:
        """Return the finding and what mends it."""
        return (
            f"sensor {self.sensor} is along {self.model} in the model, but takes {self.data} of "
            "the data; write the same direction in [model.sensors] and [data.sensors]"
        )


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
    kind = "unused-group"

    def __str__(self) -> str:
        """Return the finding and what mends it."""
        return (
            f"mesh group '{self.name}' of {self.cells} {self.type} cells has no elements and holds "
            f'nothing; give it a [[model.group]] name = "{self.name}", or leave it out of the mesh'
        )


@dataclass(frozen=True)
class ComparedPair:
    """A group compares the shapes of a pair of modes one by one.

    Attributes
    ----------
    modes : numbers of the measured modes
    group : name of the group
    """

    modes: tuple[int, int]
    group: str
    kind = "compared-pair"

    def __str__(self) -> str:
        """Return the finding and what mends it."""
        a, b = self.modes
        return (
            f"modes {a} and {b} of the data are a pair of one frequency: their shapes are any two "
            f"of a plane, and group '{self.group}' compares them one by one; write subspace = "
            f"[{a}, {b}], and the other modes in shape = […]"
        )


Note = DataDirection | UnusedGroup | ComparedPair
"""What is found where a study is read."""


def axis_name(direction: Floats) -> str:
    """Return a direction, (3,) or (6,), in words: an axis with its sign, or a vector."""
    greatest = int(np.argmax(np.abs(direction)))
    if abs(direction[greatest]) > ALONG:
        return ("-" if direction[greatest] < 0 else "") + SIX[greatest]
    return "(" + ", ".join(f"{x:.2g}" for x in direction[:3]) + ")"


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
        if (
            block.group in used
            or block.group in out
            or all(tuple(sorted(cell)) in made for cell in block.cells.tolist())
        ):
            continue
        out[block.group] = UnusedGroup(block.group, block.type, len(block.cells))
    return list(out.values())
