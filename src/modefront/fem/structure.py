"""A structure as a value: nodes, members, loads, sensors and parameters.

Every class is plain data; `modefront.fem.assembly.assemble` checks it and turns it into
matrices. Nodes and elements are counted from 0. Units are consistent ones, such as SI.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Literal

import numpy as np
import numpy.typing as npt

from modefront._typing import Ints
from modefront.fem.section import Material, Orthotropic, Section
from modefront.options import (
    ABOVE_ZERO,
    NOT_NEGATIVE,
    NUMBER,
    WHOLE,
    Checked,
    Requirement,
    any_of,
    array,
    mapping,
    number,
    numbers,
    text,
    whole,
)
from modefront.rounding import WRITTEN

Direction = str | Sequence[float]
Vector = Sequence[float]
Axes = tuple[Sequence[float], Sequence[float]]  # local x axis, and a vector in the local x-y plane

Quantity = Literal["E", "density", "thickness", "spring", "mass", "prestress"]
DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")
ALL = DIRECTIONS

NAMED = [sign + name for name in DIRECTIONS for sign in ("", "-")]  # directions by their names

VECTOR = array(NUMBER, 3, 3)
OF_VECTOR = numbers("a vector of 3 numbers", VECTOR)
DIRECTED = numbers("a vector of 3 numbers, not all of them 0", VECTOR, any)
NAMES, OF_NAMES = ", ".join(DIRECTIONS), array({"enum": [*DIRECTIONS]})
SOME = Requirement(f"a list of {NAMES}", {**OF_NAMES, "minItems": 1})
DIRECTION = Requirement(
    "one of " + ", ".join(NAMED) + ", or a vector of 3 numbers",
    any_of({"enum": NAMED}, VECTOR),
    further=lambda x: isinstance(x, str) or any(x),
)
AXES = Requirement(
    "two vectors [[...], [...]]: the local x axis, and one in the local x-y plane",
    array(VECTOR, 2, 2),
    further=lambda x: bool(
        np.linalg.norm(np.cross(*x)) > WRITTEN * np.prod(np.linalg.norm(x, axis=1))
    ),
)
NODE = any_of(whole(0, WHOLE).schema, {"type": "string"})
NODES = Requirement(
    "a node counted from 0, the name of a group or node set, or a list of these",
    any_of(NODE, array(NODE, 1)),
)
PLACE = Requirement("a node from 0, or 3 coordinates", any_of(whole(0, WHOLE).schema, VECTOR))
OFFSETS = Requirement("a vector of 3 numbers for either end", array(VECTOR, 2, 2))
RELEASES = Requirement(f"a list for either end, of {NAMES}", array(OF_NAMES, 2, 2))
FORCE = number("an axial force")

SIX, THREE = array(NOT_NEGATIVE, 6, 6), array(NOT_NEGATIVE, 3, 3)
STIFFNESS = Requirement("a stiffness above 0, or 6 of 0 or more", any_of(ABOVE_ZERO, SIX))
MASS = Requirement("a mass of 0 or more, or 3 for x, y and z", any_of(NOT_NEGATIVE, THREE))
INERTIA = Requirement(
    "3 moments of inertia of 0 or more, or a matrix of 3 x 3", any_of(THREE, array(VECTOR, 3, 3))
)
WEIGHTS = Requirement("numbers above 0, or one for all", any_of(ABOVE_ZERO, array(ABOVE_ZERO, 1)))
LOADED = numbers("3 components, or 6 with moments", any_of(VECTOR, array(NUMBER, 6, 6)))
STRAINS = mapping("a table, group = free strain", number("a strain"))
SCALED = Requirement("a list of groups, springs, masses or loads", array({"type": "string"}, 1))

FACES: Mapping[str, tuple[tuple[int, ...], ...]] = {  # corners of the faces of cells, as in VTK
    "triangle": ((0, 1, 2),),
    "quad": ((0, 1, 2, 3),),
    "tetra": ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)),
    "wedge": ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    "pyramid": ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
    "hexahedron": (
        *((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4)),
        *((1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
    ),
}


@dataclass(frozen=True, eq=False)
class Cells:
    """Cells of one type in one group."""

    group: str  # name
    type: str  # as meshio and VTK say: vertex, line, triangle, quad, hexahedron, tetra10,
    nodes: Ints  # (cells, k) nodes, counted from 0


@dataclass(frozen=True)
class Beams(Checked):
    """Group of Timoshenko beams.

    Attributes
    ----------
    name : of the group; several blocks may share it
    cells : nodes (elements, 2)
    material, section : of all elements
    orientation : vector in the plane of the axis and local y; needed unless the section is the same
        in y and z
    offsets : vectors (2, 3) from the first and second node to the flexible part's ends
    releases : directions of local axes that either end leaves free; ``(("ry", "rz"), ())`` is a
        hinge at the first node. Supports, masses and sensors are on the node's side of it.
    force : axial force of the prestress, tension is positive
    """

    name: str
    cells: npt.ArrayLike
    material: Material
    section: Section
    orientation: Annotated[Vector, DIRECTED] | None = None
    offsets: Annotated[npt.ArrayLike, OFFSETS] = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    releases: Annotated[tuple[Sequence[str], Sequence[str]], RELEASES] = ((), ())
    force: Annotated[float, FORCE] = 0.0

    @property
    def released(self) -> list[int]:
        """Numbers of the released of the 12 directions of both ends."""
        return [6 * end + DIRECTIONS.index(x) for end in (0, 1) for x in self.releases[end]]


@dataclass(frozen=True)
class Trusses(Checked):
    """Group of straight bars that carry axial forces only, such as members of trusses and cables.

    Attributes
    ----------
    name : of the group; several blocks may share it
    cells : nodes (elements, 2)
    material, area : of all elements
    force : axial force of the prestress, tension is positive
    """

    name: str
    cells: npt.ArrayLike
    material: Material
    area: Annotated[float, number("an area above 0", above=0)]
    force: Annotated[float, FORCE] = 0.0


@dataclass(frozen=True)
class Shells(Checked):
    """Group of shells of 3 or 4 nodes, curved where their elements meet at small angles.

    Attributes
    ----------
    name : of the group; several blocks may share it
    cells : nodes (elements, 3) or (elements, 4), counter-clockwise about the normal
    material, thickness : of all elements
    offset : distance of the mid-surface from the nodes along the normal
    direction : of axis 1 of an orthotropic material, a vector that is projected on the shells
    """

    name: str
    cells: npt.ArrayLike
    material: Material | Orthotropic
    thickness: Annotated[float, number("a thickness above 0", above=0)]
    offset: Annotated[float, number("a distance")] = 0.0
    direction: Annotated[Vector, DIRECTED] | None = None


@dataclass(frozen=True)
class Solids(Checked):
    """Group of bricks, wedges or tetrahedra.

    Attributes
    ----------
    name : of the group; several blocks may share it
    cells : nodes of bricks (elements, 8 or 20), wedges (elements, 15) or tetrahedra (elements, 10),
        in the order of VTK
    material : of all elements
    axes : of an orthotropic material; None is the global axes
    """

    name: str
    cells: npt.ArrayLike
    material: Material | Orthotropic
    axes: Annotated[Axes, AXES] | None = None


Group = Beams | Trusses | Shells | Solids


@dataclass(frozen=True)
class Support(Checked):
    """Nodes held in the given directions.

    Attributes
    ----------
    nodes : a node, or (nodes,), counted from 0
    directions : of x, y, z, rx, ry, rz; all of them unless given
    axes : the directions are along these; None is the global axes
    """

    nodes: Annotated[npt.ArrayLike, NODES]
    directions: Annotated[Sequence[str], SOME] = ALL
    axes: Annotated[Axes, AXES] | None = None


@dataclass(frozen=True)
class Spring(Checked):
    """Springs, equal ones, from each node to the ground or to a partner.

    Attributes
    ----------
    name : of the springs, for parameters
    nodes : one spring at each
    stiffness : force per length, or moment per angle for rotations; or (6,), one for each of x, y,
        z, rx, ry, rz
    direction : of one stiffness: one of x, y, z, rx, ry, rz, or a vector of displacement; None is
        along the line to the partner. Between distant nodes a spring on displacements has to act
        along that line: any other would resist a rotation of the whole.
    to : partner of each node; None is the ground
    axes : of six stiffnesses; None is the global axes. Between distant nodes, the six are in the
        middle of two rigid arms.
    """

    name: Annotated[str, text("the name of the springs")]
    nodes: Annotated[npt.ArrayLike, NODES]
    stiffness: Annotated[float | Sequence[float], STIFFNESS]
    direction: Annotated[Direction, DIRECTION] | None = None
    to: Annotated[npt.ArrayLike, NODES] | None = None
    axes: Annotated[Axes, AXES] | None = None


@dataclass(frozen=True)
class Mass(Checked):
    """Lumped mass, the same at each of the nodes.

    Attributes
    ----------
    name : of the masses, for parameters
    nodes : one mass at each
    mass : of each; or (3,), those that motions along x, y and z see, such as water around a pile
    inertia : about the mass's centre, global axes: (3,) principal or (3, 3)
    offset : of the centre from the node, (3,)
    """

    name: Annotated[str, text("the name of the masses")]
    nodes: Annotated[npt.ArrayLike, NODES]
    mass: Annotated[float | Sequence[float], MASS]
    inertia: Annotated[npt.ArrayLike, INERTIA] = (0.0, 0.0, 0.0)
    offset: Annotated[npt.ArrayLike, OF_VECTOR] = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Link(Checked):
    """Rigid link (RBE2): the slaves follow the master in the given directions.

    Attributes
    ----------
    master : node, counted from 0
    slaves : a node, or (nodes,); the master itself is left out
    directions : of x, y, z, rx, ry, rz; all of them unless given
    """

    master: Annotated[int, NODES]
    slaves: Annotated[npt.ArrayLike, NODES]
    directions: Annotated[Sequence[str], SOME] = ALL


@dataclass(frozen=True)
class Coupling(Checked):
    """Interpolating coupling (RBE3): a node follows the mean motion of others.

    It has the rigid motion that is nearest to the displacements of the others, in weighted least
    squares; what acts on it is distributed to them, and stiffens nothing.

    Attributes
    ----------
    node : that follows, counted from 0
    of : nodes (nodes,) whose mean motion it has
    weights : of each of them, or of all
    directions : in which it follows, of x, y, z, rx, ry, rz; all of them unless given
    """

    node: Annotated[int, NODES]
    of: Annotated[npt.ArrayLike, NODES]
    weights: Annotated[npt.ArrayLike, WEIGHTS] = 1.0
    directions: Annotated[Sequence[str], SOME] = ALL


@dataclass(frozen=True)
class Load(Checked):
    """Static load, of which the internal forces add to the stiffness (prestress).

    Forces in the structure as given are found by a linear solution, and held; the axial forces of
    beams and trusses, the membrane forces of shells and the stresses of solids make its geometric
    stiffness.

    Attributes
    ----------
    name : of the load, for parameters
    nodes : at which the force acts; None for no force
    force : (3,) or (6,) with moments, global axes, at each of the nodes
    acceleration : (3,) of gravity, which acts on all masses
    strains : free strain, such as that of heat, by name of the group
    """

    name: Annotated[str, text("the name of the load")]
    nodes: Annotated[npt.ArrayLike, NODES] | None = None
    force: Annotated[Sequence[float], LOADED] = (0.0, 0.0, 0.0)
    acceleration: Annotated[Vector, OF_VECTOR] = (0.0, 0.0, 0.0)
    strains: Annotated[Mapping[str, float], STRAINS] = field(default_factory=dict)


@dataclass(frozen=True)
class Sensor(Checked):
    """Sensor at a node, or at coordinates where a node is.

    Attributes
    ----------
    name : as in the modal data
    at : node, or coordinates (3,)
    direction : x, y, z, rx, ry, rz, with a minus sign before it for the opposite, or a vector of
        displacement (it is normalised)
    tolerance : largest distance of the coordinates from a node; None is 1e-6 of the model's
        diagonal
    """

    name: str
    at: Annotated[int | Vector, PLACE]
    direction: Annotated[Direction, DIRECTION]
    tolerance: Annotated[float, number("a distance above 0", above=0)] | None = None


@dataclass(frozen=True)
class Parameter(Checked):
    """Parameter of a structure: a factor on a quantity of all members with the given names.

    Attributes
    ----------
    name : as in the study; `modefront.Parameter` has its bounds
    quantity : "E", "density" or "thickness" of groups, "spring" stiffness, "mass", or "prestress"
        of loads and of groups with a force
    of : names of groups, springs, masses or loads
    """

    name: str
    quantity: Quantity
    of: Annotated[Sequence[str], SCALED]


@dataclass(frozen=True)
class Structure:
    """Nodes, members, supports, couplings, loads, sensors and parameters of a structure.

    Attributes
    ----------
    nodes : coordinates (nodes, 3)
    groups : beams, trusses, shells and solids
    supports, springs, masses, links, couplings : at nodes
    loads : static ones, of which the internal forces add to the stiffness
    sensors : in the order of the measured shapes
    parameters : factors that are updated
    """

    nodes: npt.ArrayLike
    groups: Sequence[Group] = ()
    supports: Sequence[Support] = ()
    springs: Sequence[Spring] = ()
    masses: Sequence[Mass] = ()
    links: Sequence[Link] = ()
    couplings: Sequence[Coupling] = ()
    loads: Sequence[Load] = ()
    sensors: Sequence[Sensor] = ()
    parameters: Sequence[Parameter] = ()

    @property
    def varied_thickness(self) -> set[str]:
        """Groups whose thickness is a parameter."""
        return {name for p in self.parameters if p.quantity == "thickness" for name in p.of}
