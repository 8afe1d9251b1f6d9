"""What looks wrong in the reading of a study, before any model is solved."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from modefront._typing import Floats
from modefront.fem.mesh import Mesh
from modefront.findings.record import Finding, found

ALONG = 0.99
"""Component of a direction from which on it is one along an axis."""

SIX = ("x", "y", "z", "rx", "ry", "rz")


def axis_name(direction: Floats) -> str:
    """Return a direction, (3,) or (6,), in words: an axis with its sign, or a vector."""
    greatest = int(np.argmax(np.abs(direction)))
    if abs(direction[greatest]) > ALONG:
        return ("-" if direction[greatest] < 0 else "") + SIX[greatest]
    return "(" + ", ".join(f"{x:.2g}" for x in direction[:3]) + ")"


def unused_groups(mesh: Mesh, elements: Iterable[str], nodes: Iterable[str]) -> list[Finding]:
    """Return the groups that the model uses neither for ``elements`` nor for ``nodes``.

    A group that shares all of its cells with those that have elements is another name for them.
    """
    with_elements = set(elements)
    used = with_elements.union(nodes)
    made = {
        tuple(sorted(cell))
        for block in mesh.blocks
        if block.group in with_elements
        for cell in block.nodes.tolist()
    }
    out: dict[str, Finding] = {}
    for block in mesh.blocks:
        if (
            block.group in used
            or block.group in out
            or all(tuple(sorted(cell)) in made for cell in block.nodes.tolist())
        ):
            continue
        out[block.group] = found(
            "unused-group", block.group, type=block.type, cells=len(block.nodes)
        )
    return list(out.values())
