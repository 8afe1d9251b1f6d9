r"""Checks of the parts of a structure: shapes, ranges, names, volumes.

Volumes and areas are judged by det J at the corners, relative to the element's size. Limits are
shapes from which on an engineer should not trust a mesh; ``benchmarks/elements.py`` measures them.
"""

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from modefront._typing import Floats, Ints
from modefront.errors import Fault, refuse, suggestion, wrong
from modefront.fem import structure as members
from modefront.fem.elements.common import frame
from modefront.fem.elements.shapes import jacobian
from modefront.fem.elements.shell import FOLD, corner_normals
from modefront.fem.elements.solid import SOLIDS
from modefront.fem.structure import DIRECTIONS, Axes, Direction, Structure
from modefront.options import repeated

FLAT = 1e-8  # length, area or volume over that of the element's extent that is rounding
DISTORTED = 0.3  # difference of greatest and least volume at corners of a brick, over the greatest
CURVED = 10.0  # square of the size over radius and thickness, from which on elements are too coarse
SMALL = 4.0  # size of shells over their thickness, below which the share of shear changes with it
OBTUSE = 120.0  # greatest angle in degrees of half of the triangles, from which on they are poor

CORNERS = np.array(  # neighbours of each corner of a brick, in a right-handed order
    [[1, 3, 4], [2, 0, 5], [3, 1, 6], [0, 2, 7], [7, 5, 0], [4, 6, 1], [5, 7, 2], [6, 4, 3]]
)


def check_points(nodes: npt.ArrayLike) -> Floats:
    """Nodes as finite floats (nodes, 3)."""
    X = np.asarray(nodes, dtype=float)
    if X.ndim != 2 or X.shape[1] != 3 or len(X) == 0:
        raise wrong("nodes", "the shape (nodes, 3)", X.shape)
    if len(bad := np.flatnonzero(~np.isfinite(X).all(1))):
        raise wrong("nodes", f"numbers as coordinates of node {bad[0]}", X[bad[0]].tolist())
    return X


def node_list(nodes: npt.ArrayLike, count: int) -> Ints:
    """One node or a list of nodes of a model of `count` as an array."""
    array = np.atleast_1d(np.asarray(nodes))
    if array.ndim != 1 or array.size == 0 or not np.issubdtype(array.dtype, np.integer):
        raise wrong("", "a list of nodes", repr(nodes))
    beyond = array[(array < 0) | (array >= count)]
    if beyond.size:
        raise wrong("", f"nodes from 0 to {count - 1}", beyond[0])
    return array.astype(np.int64)


def cell_array(cells: npt.ArrayLike, sizes: tuple[int, ...], count: int) -> Ints:
    """Cells as integers (elements, k) with k one of `sizes` and nodes below `count`."""
    array = np.asarray(cells)
    integer = np.issubdtype(array.dtype, np.integer)
    if array.ndim != 2 or array.shape[1] not in sizes or len(array) == 0 or not integer:
        expected = f"cells, integers (elements, {' or '.join(map(str, sizes))})"
        raise wrong("", expected, f"{array.dtype} of shape {array.shape}")
    return node_list(array.ravel(), count).reshape(array.shape)


def unit_vector(direction: Direction) -> Floats:
    """Unit vector (6,) in (u, r) of a named direction or a vector of displacement."""
    vector = np.zeros(6)
    if isinstance(direction, str):
        name = direction.removeprefix("-")
        vector[DIRECTIONS.index(name)] = -1.0 if direction != name else 1.0
        return vector
    vector[:3] = np.asarray(direction) / np.linalg.norm(direction)
    return vector


def axes_of(axes: Axes | None) -> Floats:
    """Local axes (3, 3), x, y and z in rows; those of the model without any."""
    return np.eye(3) if axes is None else frame(*np.asarray(axes, dtype=float))


def check_sizes(relative: Floats, cells: Ints, what: str) -> None:
    """No element has a relative length, area or volume (elements,) of zero or less."""
    bad = np.flatnonzero(~(relative > FLAT))
    if len(bad):
        e = bad[0]
        found = f"zero {what}" if abs(relative[e]) <= FLAT else f"negative {what}"
        where = f"element {e} (nodes {', '.join(map(str, cells[e].tolist()))})"
        raise wrong(where, f"{what} > 0 at every corner", f"{found}; so {len(bad)} of {len(cells)}")


def shell_sizes(X: Floats) -> Floats:
    """Smallest relative area at a corner of each shell X (elements, 3 or 4, 3)."""
    extent = np.linalg.norm(np.ptp(X, axis=1), axis=1)[:, None]
    corners = corner_normals(X / np.where(extent > 0, extent, 1)[..., None])
    normal = corners.sum(1, keepdims=True)
    normal = normal / np.linalg.norm(normal, axis=2, keepdims=True).clip(FLAT)
    return np.asarray((corners * normal).sum(2).min(1))


def solid_sizes(X: Floats) -> Floats:
    """Smallest relative det J of each solid X (elements, nodes, 3)."""
    extent = np.linalg.norm(np.ptp(X, axis=1), axis=1)
    extent = np.where(extent > 0, extent, 1)
    kind = SOLIDS[X.shape[1]]
    points = np.vstack([kind.cell.nodes[: kind.corners], kind.stiffness[0]])
    return np.asarray(np.linalg.det(jacobian(X, kind.cell.shape(points)[1])).min(1) / extent**3)


def check_names(structure: Structure) -> None:
    """Names are used once, but for groups of one kind; parameters scale what named members have."""
    has: dict[str, set[str]] = {
        "E": {g.name for g in structure.groups},
        "density": {g.name for g in structure.groups},
        "thickness": {g.name for g in structure.groups if isinstance(g, members.Shells)},
        "spring": {s.name for s in structure.springs},
        "mass": {m.name for m in structure.masses},
        "prestress": {x.name for x in structure.loads}
        | {g.name for g in structure.groups if getattr(g, "force", 0)},
    }
    own = [s.name for s in structure.springs] + [m.name for m in structure.masses]
    faults = [
        Fault("", f"{what} {x!r}", "a name used once", "it twice")
        for what, names in (
            ("member", [*has["E"], *own, *(x.name for x in structure.loads)]),
            ("sensor", [s.name for s in structure.sensors]),
            ("parameter", [p.name for p in structure.parameters]),
        )
        for x in repeated(names)
    ]
    for name in sorted(has["E"]):
        classes = sorted({type(g).__name__ for g in structure.groups if g.name == name})
        if len(classes) > 1:
            faults.append(Fault("", f"group {name!r}", "one kind", ", ".join(classes)))
    for parameter in structure.parameters:
        known = sorted(has[parameter.quantity])
        expected = f"the name of what has {parameter.quantity}: {', '.join(known) or 'none has'}"
        faults += [
            Fault("", f"parameter {parameter.name!r}", expected, suggestion(name, known))
            for name in parameter.of
            if name not in known
        ]
    refuse(faults)


def limits_of(structure: Structure, nodes: Floats) -> Iterator[str]:
    """Yield warnings on the elements of a structure; its nodes (nodes, 3) are checked."""
    for group in structure.groups:
        cells = np.asarray(group.cells)
        X = nodes[cells]
        if isinstance(group, members.Shells):
            normal = corner_normals(X).mean(axis=1)
            area = np.linalg.norm(normal, axis=1)
            size = np.sqrt(area if cells.shape[1] == 4 else area / 2)
            yield from _curved(group, cells, normal / area[:, None], size)
            sides = np.roll(X, -1, axis=1) - X
            sides /= np.linalg.norm(sides, axis=2, keepdims=True)
            turns = np.arccos((sides * np.roll(sides, 1, axis=1)).sum(2).clip(-1, 1))
            angle = 180 - float(np.degrees(np.median(turns.min(axis=1))))
            if cells.shape[1] == 3 and angle >= OBTUSE:
                yield (
                    f"half of the triangles of group '{group.name}' have angles of {angle:.0f}° "
                    "and more: expect bending frequencies off by 3 % at 120° and 13 % at 150° "
                    "where a span has 16; divide along the shorter diagonals, or take "
                    "quadrilaterals"
                )
            if group.name in structure.varied_thickness and size.min() < SMALL * group.thickness:
                ratio = size.min() / group.thickness
                yield (
                    f"shells of group '{group.name}' are as small as {ratio:.2g} of their "
                    "thickness, which is a parameter: at twice the nominal one, frequencies differ "
                    "by up to 11 % from those of a model with that thickness; begin near it"
                )
        elif isinstance(group, members.Solids) and cells.shape[1] == 8:
            volume = np.abs(np.linalg.det(X[:, CORNERS] - X[:, :, None]))
            distortion = 1 - volume.min(axis=1) / volume.max(axis=1)
            if count := int((distortion >= DISTORTED).sum()):
                yield (
                    f"{count} of {len(distortion)} bricks of group '{group.name}' are distorted, "
                    f"by up to {100 * distortion.max():.0f} % of the volume at their corners "
                    f"(element {int(np.argmax(distortion))}): expect bending frequencies too great "
                    "by some 20 % at a third and 30 % at a half where a span has 5 bricks, by 3 to "
                    "6 % where it has 10; refine, or take bricks of 20 nodes"
                )


def _curved(group: members.Shells, cells: Ints, normal: Floats, size: Floats) -> Iterator[str]:
    """Yield a warning where elements are large beside radius and thickness of the shell."""
    edges = np.sort(np.stack([cells, np.roll(cells, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    owner = np.repeat(np.arange(len(cells)), cells.shape[1])
    order = np.lexsort(edges.T)
    same = (edges[order][1:] == edges[order][:-1]).all(axis=1)
    a, b = owner[order][:-1][same], owner[order][1:][same]
    angle = np.arccos(np.abs(np.einsum("ei,ei->e", normal[a], normal[b])).clip(0, 1))
    coarse = angle * np.maximum(size[a], size[b]) / group.thickness
    worst = float(coarse[angle < np.radians(FOLD)].max(initial=0.0))
    if worst >= CURVED:
        yield (
            f"elements of group '{group.name}' are up to {worst:.2g} times as large as radius and "
            "thickness of the curved shell allow (size² / radius / thickness): expect errors of "
            "the frequencies of up to 10 % where it is curved in two directions; refine"
        )
