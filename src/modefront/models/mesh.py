"""Models made of finite elements on a mesh."""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.linalg import spsolve

from modefront import fem
from modefront.errors import wrong
from modefront.fem.check import check_points, limits_of
from modefront.linalg.affine import Monomials
from modefront.models.geometry import Cells, Geometry
from modefront.models.matrices import MatrixModel


def mesh_model(
    structure: fem.Structure,
    parameters: Sequence[str],
    *,
    floating: bool = False,
    outputs: Sequence[fem.Sensor] = (),
) -> MatrixModel:
    """Return the finite-element model of a structure.

    Parameters
    ----------
    structure
        Nodes, members, supports, links, sensors and the factors that are parameters, in consistent
        units, see `modefront.fem.Structure`. Sensors are in the order of the measured shapes.
    parameters
        Names of the parameters, in the order of theta: those of the structure, and any others, on
        which nothing depends.
    floating
        Whether the structure as a whole may move as a rigid body; otherwise it has to be held.
    outputs
        Places besides the sensors that predictions may name.

    Returns
    -------
    MatrixModel
        K(theta) and M(theta) at the free degrees of freedom, sparse from some 200 on. The base can
        move along ``"x"``, ``"y"`` and ``"z"``, as far as anything is free to do so.

    Raises
    ------
    InputError
        If the structure is wrong: unknown nodes, distorted elements, parts that can move freely,
        sensors where nothing moves; for a parameter that is not among ``parameters``.
    """
    whole = replace(structure, sensors=(*structure.sensors, *outputs))
    built = fem.assemble(whole, floating=floating)
    if missing := [name for name in built.parameters if name not in parameters]:
        expected = f"the structure's {', '.join(built.parameters)}"
        raise wrong("parameters", expected, f"no {missing[0]}")
    of = np.eye(len(parameters))[[list(parameters).index(name) for name in built.parameters]]
    exponents = [A.coefficients.exponents for A in (built.stiffness, built.mass)]
    K = replace(built.stiffness, coefficients=Monomials(exponents[0] @ of))
    M = replace(built.mass, coefficients=Monomials(exponents[1] @ of))
    direction, X = built.dofs.free[:, 1], check_points(structure.nodes)
    types = {2: "line", 3: "triangle", 4: "quad", 8: "hexahedron", 10: "tetra10"}
    types |= {15: "wedge15", 20: "hexahedron20"}
    known = tuple(
        Cells(group.name, types[np.shape(group.cells)[1]], np.asarray(group.cells))
        for group in structure.groups
    )
    moving = [(direction == d).astype(float) for d in range(3)]
    if any(each.axes is not None for each in structure.supports):
        # Nodes on supports in axes of their own follow the base as far as they are free to.
        T = built.dofs.T
        moving = [spsolve((T.T @ T).tocsc(), T[d::6].sum(axis=0)) for d in range(3)]
    translations = 6 * np.arange(len(X))[:, None] + np.arange(3)
    motion = csr_array(built.dofs.T[translations.ravel()])
    (at, along), count = built.places, len(structure.sensors)
    rows = built.selection[count:].toarray()
    return MatrixModel(
        tuple(parameters),
        built.sensors[:count],
        built.selection[:count],
        K,
        M,
        outputs=dict(zip(built.sensors[count:], rows, strict=True)),
        # Slaves of rigid links follow their masters, which is the same translation.
        base={name: r for name, r in zip(fem.DIRECTIONS, moving, strict=False) if r.any()},
        limits=tuple(limits_of(structure, X)),
        geometry=Geometry(X, known, motion, at[:count], along[:count, :3]),
        members=partial(fem.members_of, structure, built.dofs.T, *exponents),
    ).compact()
