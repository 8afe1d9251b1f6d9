"""Whether a model is solved in a reduced basis, and how exactly (``docs/reduced.md``).

Operation counts decide, so that digits do not depend on a clock.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from scipy.sparse import csr_array

from modefront.data.modal import ModalData
from modefront.linalg.affine import DenseAffine
from modefront.models.base import Model, is_reduced
from modefront.models.matrices import MatrixModel
from modefront.models.parameters import Parameter
from modefront.models.reduced.model import MEMORY, TOLERANCE, ReducedModel
from modefront.options import Checked, Requirement, any_of, number
from modefront.pairing.match import Pairing, modes_needed

SMALLEST = 100  # degrees of freedom from which there may be a basis
LEAST, MOST = 1e-12, 1e-2  # tolerances that may be asked for

REDUCTION = Requirement(
    f"'auto', 'off' or a relative error of eigenvalues from {LEAST:g} to {MOST:g}",
    any_of({"enum": ["auto", "off"]}, {"type": "number", "minimum": LEAST, "maximum": MOST}),
    lambda value: value if isinstance(value, str) else float(value),
)

GIB = number("GiB for a reduced basis, above 0", above=0)

DENSE = 3e4
"""Cube of the unknowns of a dense eigenproblem over those of a sparse one that takes as long: times
that ``benchmarks/choice.py`` measures, from 1000 to 100,000 degrees of freedom."""


def columns(model: MatrixModel, count: int) -> float:
    """Return how many columns a basis is expected to have that has ``count`` modes.

    For each mode and function of the parameters, which is a parameter in most models: the
    derivative, and the modes at both bounds, if not yet spanned.
    """
    terms = np.vstack([A.coefficients.exponents for A in (model.stiffness, model.mass)])
    return count * (1 + 1.5 * len(np.unique(terms[terms.any(axis=1)], axis=0)))


def share(model: MatrixModel, count: int) -> float:
    """Return the expected time of a solution in a basis over that of a sparse one in full."""
    return columns(model, count) ** 3 / (DENSE * model.size)


def stand_in(model: MatrixModel, count: int) -> MatrixModel:
    """Return a model of other matrices whose solution takes as long as one in a basis will."""
    size = int(columns(model, count))
    G = np.random.default_rng(0).standard_normal((size, size))
    pairs = (G @ G.T, model.stiffness.coefficients), (np.eye(size), model.mass.coefficients)
    K, M = (DenseAffine(np.repeat(X[None], len(x.exponents), axis=0), x) for X, x in pairs)
    rows = G[np.arange(len(model.sensors)) % size]
    return MatrixModel(model.parameters, model.sensors, csr_array(rows), K, M)


@dataclass(frozen=True)
class Reduction(Checked):
    """Tolerance and memory of a reduced basis.

    Raises InputError for values that are not possible.

    Attributes
    ----------
    reduction : relative error of eigenvalues that a basis has to keep to, from 1e-12 to 1e-2;
        ``"auto"`` takes a basis with 1e-8 where it pays, ``"off"`` none
    memory : GiB that a basis may take, above 0
    """

    reduction: Annotated[float | Literal["auto", "off"], REDUCTION] = "auto"
    memory: Annotated[float, GIB] = MEMORY

    def of(
        self, model: Model, data: ModalData, pairing: Pairing, parameters: Sequence[Parameter]
    ) -> Model:
        """Return the model in a reduced basis, or as it is: by wish, or where nothing is gained.

        A basis needs matrices that are affine in functions of the parameters.
        """
        if self.reduction == "off" or not isinstance(model, MatrixModel) or model.size < SMALLEST:
            return model
        count = modes_needed(pairing, data, model.size)
        pays = share(model, count) <= 1 and columns(model, count) <= model.size / 2
        if self.reduction == "auto" and not pays:
            return model
        return ReducedModel(
            model.sparse(),
            count,
            np.array([each.nominal for each in parameters]),
            np.array([each.lower for each in parameters]),
            np.array([each.upper for each in parameters]),
            tolerance=TOLERANCE if isinstance(self.reduction, str) else self.reduction,
            memory=self.memory,
            spare=count - len(data.modes),
        )

    def fallback(self, model: Model) -> str:
        """Return why a model is solved in full though a tolerance was asked for, or nothing."""
        if isinstance(self.reduction, str) or is_reduced(model):
            return ""
        if isinstance(model, MatrixModel):
            return f"no reduced basis: the model has only {model.size} degrees of freedom"
        return "no reduced basis: the matrices are not known as affine functions of the parameters"
