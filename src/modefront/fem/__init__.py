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

The names are imported when they are first used: processes that solve models need no elements.
"""

from typing import TYPE_CHECKING

from modefront._lazy import lazy

if TYPE_CHECKING:
    from modefront.fem import grids as grids
    from modefront.fem.assembly import StructureMatrices as StructureMatrices
    from modefront.fem.assembly import assemble as assemble
    from modefront.fem.assembly import members_of as members_of
    from modefront.fem.dofs import Dofs as Dofs
    from modefront.fem.mesh import Mesh as Mesh
    from modefront.fem.mesh import read_mesh as read_mesh
    from modefront.fem.section import Material as Material
    from modefront.fem.section import Orthotropic as Orthotropic
    from modefront.fem.section import Section as Section
    from modefront.fem.section import circle as circle
    from modefront.fem.section import hollow_rectangle as hollow_rectangle
    from modefront.fem.section import rectangle as rectangle
    from modefront.fem.section import tube as tube
    from modefront.fem.structure import ALL as ALL
    from modefront.fem.structure import DIRECTIONS as DIRECTIONS
    from modefront.fem.structure import Beams as Beams
    from modefront.fem.structure import Coupling as Coupling
    from modefront.fem.structure import Direction as Direction
    from modefront.fem.structure import Link as Link
    from modefront.fem.structure import Load as Load
    from modefront.fem.structure import Mass as Mass
    from modefront.fem.structure import Parameter as Parameter
    from modefront.fem.structure import Sensor as Sensor
    from modefront.fem.structure import Shells as Shells
    from modefront.fem.structure import Solids as Solids
    from modefront.fem.structure import Spring as Spring
    from modefront.fem.structure import Structure as Structure
    from modefront.fem.structure import Support as Support
    from modefront.fem.structure import Trusses as Trusses

__getattr__, __dir__, __all__ = lazy(__name__, __file__)
