"""Models made of finite elements on a mesh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modefront import fem
from modefront._typing import Floats
from modefront.linalg.affine import Monomials, SparseAffine
from modefront.models.matrices import MatrixModel, affine_model


def mesh_model(
    structure: fem.Structure,
    parameters: Sequence[str],
    *,
    floating: bool = False,
    outputs: Sequence[fem.Sensor] = (),
) -> MatrixModel:
    """Return the model of a structure, with parameters in the order given.

    ``parameters`` names all of the structure's, and may name more, on which then nothing
    depends. ``floating`` allows the structure as a whole to move as a rigid body. ``outputs`` are
    places besides the sensors that predictions may name. The base can move along x, y and z, as
    far as anything is free to do so. Raises `modefront.fem.FemError` where the structure is wrong.
    """
    whole = replace(structure, sensors=(*structure.sensors, *outputs))
    built = fem.assemble(whole, floating=floating)
    sensors, others = np.split(np.arange(len(built.sensors)), [len(structure.sensors)])
    columns = [list(parameters).index(name) for name in built.parameters]

    def placed(matrix: SparseAffine) -> SparseAffine:
        exponents = np.zeros((len(matrix.coefficients.exponents), len(parameters)))
        exponents[:, columns] = matrix.coefficients.exponents
        return replace(matrix, coefficients=Monomials(exponents))

    return affine_model(
        parameters,
        [built.sensors[i] for i in sensors],
        built.selection[sensors],
        placed(built.stiffness),
        placed(built.mass),
        outputs={built.sensors[i]: built.selection[[i]].toarray()[0] for i in others},
        base={name: motion for name, motion in _motions(built.dofs).items() if motion.any()},
    )


def _motions(dofs: fem.Dofs) -> dict[str, Floats]:
    """Return the free degrees of freedom of a translation of the whole along each axis.

    Slaves of rigid links follow their masters, which is the same translation.
    """
    direction = dofs.free[:, 1]
    return {name: (direction == d).astype(float) for d, name in enumerate(fem.DIRECTIONS[:3])}
