"""Limits of the elements: shapes from which on an engineer should not trust a mesh.

The errors to expect are measured by ``benchmarks/elements.py``.
"""

from __future__ import annotations

import numpy as np

from modefront._typing import Floats, Ints
from modefront.fem.elements.shell import FOLD, corner_normals
from modefront.fem.structure import Shells, Solids, Structure

DISTORTED = 0.3
"""Difference of the greatest and least volume at the corners of a brick, over the greatest."""

CURVED = 10.0
"""Square of the size of an element over radius and thickness, from which on it is too coarse."""

SMALL = 4.0
"""Size of shells over their thickness, below which another thickness has another share of shear."""

OBTUSE = 120.0
"""Greatest angle in degrees of half of the triangles of a group, from which on they are poor."""

CORNERS = np.array(
    [[1, 3, 4], [2, 0, 5], [3, 1, 6], [0, 2, 7], [7, 5, 0], [4, 6, 1], [5, 7, 2], [6, 4, 3]]
)
"""Neighbours of each corner of a brick, in the order of a right-handed system."""


def limits_of(structure: Structure, nodes: Floats) -> tuple[str, ...]:
    """Return warnings on the elements of a structure; its nodes (nodes, 3) are checked."""
    out = []
    for group in structure.groups:
        cells = np.asarray(group.cells)
        if isinstance(group, Shells):
            normal = corner_normals(nodes[cells]).mean(axis=1)
            area = np.linalg.norm(normal, axis=1)
            size = np.sqrt(area if cells.shape[1] == 4 else area / 2)
            out += _curved(group, cells, normal / area[:, None], size)
            if cells.shape[1] == 3:
                out += _obtuse(group, nodes[cells])
            if group.name in structure.varied_thickness and size.min() < SMALL * group.thickness:
                ratio = size.min() / group.thickness
                out.append(
                    f"shells of group '{group.name}' are as small as {ratio:.2g} of their "
                    "thickness, which is a parameter: at twice the nominal one, frequencies differ "
                    "by up to 11 % from those of a model with that thickness; begin near it"
                )
        elif isinstance(group, Solids) and cells.shape[1] == 8:
            out += _distorted(group, nodes[cells])
    return tuple(out)


def _obtuse(group: Shells, X: Floats) -> list[str]:
    """Return a warning where triangles X (elements, 3, 3) have great angles."""
    sides = np.roll(X, -1, axis=1) - X
    sides /= np.linalg.norm(sides, axis=2, keepdims=True)
    turns = np.arccos((sides * np.roll(sides, 1, axis=1)).sum(2).clip(-1, 1))
    angle = 180 - float(np.degrees(np.median(turns.min(axis=1))))
    if angle < OBTUSE:
        return []
    return [
        f"half of the triangles of group '{group.name}' have angles of {angle:.0f}° and more: "
        "expect bending frequencies off by 3 % at 120° and 13 % at 150° where a span has 16; "
        "divide along the shorter diagonals, or take quadrilaterals"
    ]


def _distorted(group: Solids, X: Floats) -> list[str]:
    """Return a warning where bricks X (elements, 8, 3) are distorted."""
    edges = X[:, CORNERS] - X[:, :, None]
    volume = np.abs(np.linalg.det(edges))
    distortion = 1 - volume.min(axis=1) / volume.max(axis=1)
    if distortion.max() < DISTORTED:
        return []
    return [
        f"{int((distortion >= DISTORTED).sum())} of {len(distortion)} bricks of group "
        f"'{group.name}' are distorted, by up to {100 * distortion.max():.0f} % of the volume at "
        f"their corners (element {int(np.argmax(distortion))}): expect bending frequencies "
        "too great by some 20 % at a third and 30 % at a half where a span has 5 bricks, by 3 to "
        "6 % where it has 10; refine, or take bricks of 20 nodes"
    ]


def _curved(group: Shells, cells: Ints, normal: Floats, size: Floats) -> list[str]:
    """Return a warning where elements are large beside radius and thickness of the shell."""
    edges = np.sort(np.stack([cells, np.roll(cells, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    owner = np.repeat(np.arange(len(cells)), cells.shape[1])
    order = np.lexsort(edges.T)
    same = (edges[order][1:] == edges[order][:-1]).all(axis=1)
    a, b = owner[order][:-1][same], owner[order][1:][same]
    angle = np.arccos(np.abs(np.einsum("ei,ei->e", normal[a], normal[b])).clip(0, 1))
    coarse = angle * np.maximum(size[a], size[b]) / group.thickness
    worst = float(coarse[angle < np.radians(FOLD)].max(initial=0.0))
    if worst < CURVED:
        return []
    return [
        f"elements of group '{group.name}' are up to {worst:.2g} times as large as radius and "
        "thickness of the curved shell allow (size² / radius / thickness): expect errors of the "
        "frequencies of up to 10 % where it is curved in two directions; refine"
    ]
