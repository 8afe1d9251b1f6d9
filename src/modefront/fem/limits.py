r"""Limits of the elements: errors by thickness, skew, distortion and curvature.

Shells are Kirchhoff's: transverse shear is left out. Of a bending wave with the wave number k, the
eigenvalue is too great by the factor

.. math:: 1 + \frac{D k^2}{\kappa G h} = 1 + \frac{h^2 k^2}{5 (1 - \nu)},

with the thickness h and the shear factor 5/6. The waves are those of the highest measured
frequency, :math:`k^2 = \omega \sqrt{\rho h / D}`, or of half a wave over the span, if these are
shorter. Source: Mindlin 1951, doi:10.1115/1.4010217. The other
numbers to expect are measured by ``benchmarks/elements.py``.
"""

from __future__ import annotations

import numpy as np

from modefront._typing import Floats, Ints
from modefront.fem.element_limits import Limits, Thickness
from modefront.fem.structure import Shells, Solids, Structure

SKEW = 30.0
"""Degrees between the lines through opposite midpoints of a quadrilateral and a right angle."""

DISTORTED = 0.3
"""Difference of the greatest and least volume at the corners of a brick, over the greatest."""

CURVED = 1.0
"""Square of the size of an element over radius and thickness, from which on it is too stiff."""

SINGLE = 10.0
"""Error in per cent that was met, at most, of stiffnesses of shells curved in one direction."""

SKEW_ERROR, STEEPEST = (0.022, 0.058), 75.0
"""Errors of the first frequency of rhombic plates of 12 x 12 quadrilaterals at 45°, hinged and
clamped, which grow with the square of the tangent of the angle; and the angle up to which."""

CORNERS = np.array(
    [[1, 3, 4], [2, 0, 5], [3, 1, 6], [0, 2, 7], [7, 5, 0], [4, 6, 1], [5, 7, 2], [6, 4, 3]]
)
"""Neighbours of each corner of a brick, in the order of a right-handed system."""


def limits_of(structure: Structure, nodes: Floats) -> Limits:
    """Return the limits of the elements of a structure; its nodes (nodes, 3) are checked."""
    thickness, shapes = [], []
    for group in structure.groups:
        cells = np.asarray(group.cells)
        if isinstance(group, Shells):
            thickness.append(_thickness(group, nodes[np.unique(cells)]))
            shapes += _skew(group, nodes[cells]) if cells.shape[1] == 4 else []
            shapes += _curved(group, cells, nodes)
        elif isinstance(group, Solids) and cells.shape[1] == 8:
            shapes += _distorted(group, nodes[cells])
    return Limits(tuple(thickness), tuple(shapes))


def _thickness(group: Shells, X: Floats) -> Thickness:
    extents = np.sort(np.linalg.svd(X - X.mean(axis=0), compute_uv=False))
    share = extents[-2] / np.linalg.norm(extents) if len(extents) > 1 else 1.0
    span = float(np.linalg.norm(np.ptp(X, axis=0)) * share)
    h, material = group.thickness, group.material
    D = material.E * h**3 / (12 * (1 - material.nu**2))
    shear = h**2 / (5 * (1 - material.nu))
    return Thickness(group.name, h / span, span, shear, float(np.sqrt(material.rho * h / D)))


def _skew(group: Shells, X: Floats) -> list[str]:
    """Return a warning where quadrilaterals X (elements, 4, 3) are skew."""
    middle = (X + np.roll(X, -1, axis=1)) / 2
    u, v = middle[:, 2] - middle[:, 0], middle[:, 3] - middle[:, 1]
    cosine = np.einsum("ei,ei->e", u, v) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1)
    skew = np.degrees(np.arcsin(np.abs(cosine).clip(0, 1)))
    if skew.max() < SKEW:
        return []
    tangent = float(np.tan(np.radians(min(skew.max(), STEEPEST))))
    hinged, clamped = (100 * each * tangent**2 * 144 / len(skew) for each in SKEW_ERROR)
    return [
        f"{int((skew >= SKEW).sum())} of {len(skew)} quadrilaterals of group '{group.name}' are "
        f"skew by up to {skew.max():.0f}° (element {int(np.argmax(skew))}): expect the first "
        f"frequency of a plate of them {hinged:.2g} % (hinged) to {clamped:.2g} % (clamped) too "
        "low; refine, or take triangles"
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


def _curved(group: Shells, cells: Ints, nodes: Floats) -> list[str]:
    """Return a warning where elements are large beside radius and thickness of the shell."""
    X, corners = nodes[cells], cells.shape[1]
    normal = np.cross(X[:, 1] - X[:, 0], X[:, 2] - X[:, 0])
    if corners == 4:
        normal = np.cross(X[:, 2] - X[:, 0], X[:, 3] - X[:, 1])
    size = np.sqrt(np.linalg.norm(normal, axis=1) / (1 if corners == 3 else 2))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    edges = np.sort(np.stack([cells, np.roll(cells, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    owner = np.repeat(np.arange(len(cells)), corners)
    order = np.lexsort(edges.T)
    same = (edges[order][1:] == edges[order][:-1]).all(axis=1)
    a, b = owner[order][:-1][same], owner[order][1:][same]
    angle = np.arccos(np.abs(np.einsum("ei,ei->e", normal[a], normal[b])).clip(0, 1))
    smooth = angle < np.pi / 4  # greater ones are folds
    locking = angle * np.maximum(size[a], size[b]) / group.thickness
    worst = float(locking[smooth].max(initial=0.0))
    if worst < CURVED:
        return []
    stiffness = worst**2 / (100 + 2 * worst)
    return [
        f"elements of group '{group.name}' are up to {worst:.2g} times as large as radius and "
        "thickness of the curved shell allow (size² / radius / thickness): expect it up to "
        f"{100 * stiffness:.0f} % too stiff in bending where it is curved in two directions, "
        f"{min(100 * stiffness, SINGLE):.0f} % where in one; refine"
    ]
