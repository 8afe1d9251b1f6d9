"""Whether a model is solved in a reduced basis, and how exactly.

The time of a study is estimated from operation counts alone (``docs/reduced.md``, whose symbols are
used), so that its digits do not depend on a clock. The constants are seconds on one core of the
machine on which ``benchmarks/choice.py`` has calibrated them; only their ratios count.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np

from modefront.data.modal import ModalData
from modefront.linalg.affine import SparseAffine
from modefront.models.base import Model, is_reduced
from modefront.models.matrices import MatrixModel
from modefront.models.parameters import Parameter
from modefront.models.reduced.model import MEMORY, TOLERANCE, ReducedModel
from modefront.options import Checked, Requirement, any_of, number
from modefront.pairing.match import Pairing, modes_needed

SMALLEST = 100
"""Degrees of freedom from which there may be a basis; smaller models are solved in full."""

LEAST, MOST = 1e-12, 1e-2
"""Tolerances that may be asked for."""

REDUCTION = Requirement(
    f"'auto', 'off' or a relative error of eigenvalues from {LEAST:g} to {MOST:g}",
    any_of({"enum": ["auto", "off"]}, {"type": "number", "minimum": LEAST, "maximum": MOST}),
    lambda value: value if isinstance(value, str) else float(value),
)

GIB = number("GiB for a reduced basis, above 0", above=0)

EVALUATIONS = 300.0, 130.0
"""E without parameters, and for each of them."""

SOLVER = 1e-3
"""o."""

DENSE = 3e-4, 4e-10, 6e-10
"""Of a dense solution: at least, times N^3, and times N^2 for each derivative of a mode."""

SPARSE = 1.5e-2, 1e-5, 4.7e-7
"""Of a sparse one: at least, times N, and times the entries of a factor."""

SETUP = 0.03, 4e-3, 2.5e-8
"""Of S: at least, times the n columns, and times n and the entries of a factor."""


@dataclass(frozen=True)
class Estimate:
    """Estimated times.

    Attributes
    ----------
    full : F
    reduced : R
    setup : S
    evaluations : E
    """

    full: float
    reduced: float
    setup: float
    evaluations: float

    @property
    def share(self) -> float:
        """The time of an evaluation in a basis, over that of a full one."""
        return (self.reduced + SOLVER) / (self.full + SOLVER)

    @property
    def gain(self) -> float:
        """The time of a study with full solutions, over that in a basis."""
        alone = self.evaluations * (self.full + SOLVER)
        return alone / (self.setup + self.evaluations * (self.reduced + SOLVER))


def estimate(model: MatrixModel, count: int) -> Estimate:
    """Return the estimated times of a study that needs ``count`` modes."""
    N, p = model.size, len(model.parameters)
    # For each mode and parameter: its derivative and the modes at both bounds, if not yet spanned.
    columns = min(N, count * (1 + 1.5 * p))
    if isinstance(model.stiffness, SparseAffine):
        # Factors of plates; those of solids fill in more, which a basis saves.
        entries = 0.2 * (model.stiffness.indices.size + N) / 2 * np.log2(N)
        full = SPARSE[0] + SPARSE[1] * N + SPARSE[2] * entries
    else:
        entries, full = N**2 / 2, _dense(N, count * p)
    setup = SETUP[0] + SETUP[1] * columns + SETUP[2] * columns * entries
    evaluations = EVALUATIONS[0] + EVALUATIONS[1] * p
    return Estimate(full, _dense(columns, count * p), setup, evaluations)


def _dense(size: float, derivatives: int) -> float:
    return DENSE[0] + DENSE[1] * size**3 + DENSE[2] * size**2 * derivatives


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
        if self.reduction == "auto" and estimate(model, count).gain < 1:
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
