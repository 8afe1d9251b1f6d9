"""Models made of finite elements on a mesh."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse

from modefront import fem
from modefront._typing import Floats, Ints
from modefront.models.affine import Monomials, SparseAffine
from modefront.models.matrices import MatrixModel, affine_model


def mesh_model(
    structure: fem.Structure, parameters: Sequence[str], *, floating: bool = False
) -> MatrixModel:
    """Return the model of a structure, with parameters in the order given.

    ``parameters`` names all of the structure's, and may name more, on which then nothing
    depends. ``floating`` allows the structure as a whole to move as a rigid body. Raises
    `modefront.fem.FemError` where the structure is wrong.
    """
    built = fem.assemble(structure, floating=floating)
    columns = [list(parameters).index(name) for name in built.parameters]

    def affine(data: Floats, exponents: Ints) -> SparseAffine:
        placed = np.zeros((len(exponents), len(parameters)))
        placed[:, columns] = exponents
        terms = scipy.sparse.csc_array(data.T)
        return SparseAffine(built.indptr, built.indices, terms, Monomials(placed))

    return affine_model(
        parameters,
        built.sensors,
        built.selection,
        affine(built.stiffness_data, built.stiffness_exponents),
        affine(built.mass_data, built.mass_exponents),
    )
