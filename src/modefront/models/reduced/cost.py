r"""Estimated costs of a study with full solutions and in a reduced basis, before it is solved.

The time of a study is estimated from operation counts alone, so that its digits do not depend on a
clock. With E evaluations of the model,

.. math:: T_\text{full} = E\,(F + o), \qquad T_\text{basis} = S + E\,(R + o),

========  ==================================================================================
symbol    meaning
========  ==================================================================================
E         evaluations of a study, which grow with the parameters
F         a full solution: dense, or two sparse factorisations and some dozens of solutions
R         a dense solution in a basis of n columns
S         snapshots and certificates: n solutions, and as many columns to project
o         what the solver takes for each evaluation
n         columns: modes, their derivatives, and the modes at the bounds of each parameter
========  ==================================================================================

The constants are seconds on one core of the machine on which ``benchmarks/choice.py`` has
calibrated them; only their ratios count. The estimate of n is a middle one:
structures whose parameters change much need more columns, chains fewer.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modefront.linalg.affine import SparseAffine
from modefront.models.matrices import MatrixModel

EVALUATIONS = 300.0, 130.0
"""E without parameters, and for each of them."""

SOLVER = 1e-3
"""o."""

DENSE = 3e-4, 4e-10, 6e-10
"""Of a dense solution: at least, times N^3, and times N^2 for each derivative of a mode."""

SPARSE = 1.5e-2, 1e-5, 4.7e-7
"""Of a sparse one: at least, times N, and times the entries of a factor."""

FILL = 0.2
"""Entries of a factor over those of the lower triangle and the logarithm of N to the base 2: of
plates. Those of solids fill in more, which a basis saves."""

SETUP = 0.03, 4e-3, 2.5e-8
"""Of S: at least, times n, and times n and the entries of a factor."""

COLUMNS = 1.5
"""Directions in the basis for each mode and parameter: its derivative and the modes at both bounds,
as far as they are not spanned yet. From 0.6 to 3 were met."""


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
    columns = min(N, count * (1 + COLUMNS * p))
    if isinstance(model.stiffness, SparseAffine):
        entries = FILL * (model.stiffness.indices.size + N) / 2 * np.log2(N)
        full = SPARSE[0] + SPARSE[1] * N + SPARSE[2] * entries
    else:
        entries, full = N**2 / 2, _dense(N, count * p)
    setup = SETUP[0] + SETUP[1] * columns + SETUP[2] * columns * entries
    evaluations = EVALUATIONS[0] + EVALUATIONS[1] * p
    return Estimate(full, _dense(columns, count * p), setup, evaluations)


def _dense(size: float, derivatives: int) -> float:
    return DENSE[0] + DENSE[1] * size**3 + DENSE[2] * size**2 * derivatives
