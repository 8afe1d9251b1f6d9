"""Models made of finite elements on a mesh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import scipy.sparse

from modefront import fem
from modefront._typing import Floats, Ints
from modefront.models.affine import Monomials, SparseAffine
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

    def affine(data: Floats, exponents: Ints) -> SparseAffine:
        placed = np.zeros((len(exponents), len(parameters)))
        placed[:, columns] = exponents
        there = data.any(axis=0)  # masses couple far fewer degrees of freedom than stiffnesses
        indptr = np.append(0, np.cumsum(there, dtype=np.int32))[built.indptr].astype(np.int32)
        terms = scipy.sparse.csc_array(data[:, there].T)
        return SparseAffine(indptr, built.indices[there], terms, Monomials(placed))

    return affine_model(
        parameters,
        [built.sensors[i] for i in sensors],
        built.selection[sensors],
        affine(built.stiffness_data, built.stiffness_exponents),
        affine(built.mass_data, built.mass_exponents),
        outputs={built.sensors[i]: built.selection[[i]].toarray()[0] for i in others},
        base={name: motion for name, motion in _motions(built.dofs).items() if motion.any()},
    )


def _motions(dofs: fem.Dofs) -> dict[str, Floats]:
    """Return the free degrees of freedom of a translation of the whole along each axis.

    Slaves of rigid links follow their masters, which is the same translation.
    """
    direction = dofs.free[:, 1]
    return {name: (direction == d).astype(float) for d, name in enumerate(fem.DIRECTIONS[:3])}
