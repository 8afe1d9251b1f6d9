"""Finite elements for linear dynamics: structures to affine, sparse K(theta) and M(theta).

>>> import numpy as np
>>> from modefront import fem
>>> X, cells = fem.grids.line(np.zeros(3), np.array([1.0, 0, 0]), 8)
>>> steel = fem.Material(E=210e9, nu=0.3, rho=7850.0)
>>> beam = fem.Structure(
...     nodes=X,
...     groups=(fem.Beams("beam", cells, steel, fem.circle(0.02)),),
...     supports=(fem.Support(0),),
...     sensors=(fem.Sensor("tip", 8, "y"),),
...     parameters=(fem.Parameter("k", "E", ("beam",)),),
... )
>>> model = fem.assemble(beam)
>>> model.stiffness.at(np.array([1.1])).shape
(48, 48)
"""

from modefront.fem import grids
from modefront.fem.assembly import StructureMatrices, assemble
from modefront.fem.dofs import DIRECTIONS, Dofs
from modefront.fem.errors import FemError
from modefront.fem.material import Material
from modefront.fem.mesh import Mesh, read_mesh
from modefront.fem.section import Section, circle, hollow_rectangle, rectangle, tube
from modefront.fem.structure import (
    ALL,
    Beams,
    Direction,
    Link,
    Mass,
    Parameter,
    Sensor,
    Shells,
    Solids,
    Spring,
    Structure,
    Support,
)

__all__ = [
    "ALL",
    "DIRECTIONS",
    "Beams",
    "Direction",
    "Dofs",
    "FemError",
    "Link",
    "Mass",
    "Material",
    "Mesh",
    "Parameter",
    "Section",
    "Sensor",
    "Shells",
    "Solids",
    "Spring",
    "Structure",
    "StructureMatrices",
    "Support",
    "assemble",
    "circle",
    "grids",
    "hollow_rectangle",
    "read_mesh",
    "rectangle",
    "tube",
]
