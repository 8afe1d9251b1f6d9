"""Importance sampling over elementary failures (Au and Beck, 2001).

Samples are drawn from the mixture of the normal densities given each elementary failure,

    h(z) = Σ_oj (P_oj/ΣP) φ(z) 1[z ∈ E_oj]/P_oj  =  φ(z) N(z)/ΣP,

N(z) the number of (o, j) at which |x_oj| > b. All of them fail, and the weight is

    φ(z)/h(z) = ΣP / N(z),            P = ΣP · E_h[1/N].

S. K. Au, J. L. Beck, "First excursion probabilities for linear systems by very efficient
importance sampling", Probab. Eng. Mech. 16 (2001) 193-207, doi:10.1016/S0266-8920(01)00002-9,
eqs. 25-29.
"""

from collections.abc import Iterator

import numpy as np

from modefront.reliability.elementary import Failed, conditional
from modefront.reliability.estimate import Estimator
from modefront.response.system import FloatArray


def _share(failed: Failed, level: float, magnitudes: Iterator[FloatArray]) -> FloatArray:
    exceedances = np.zeros(failed.z.shape[0])
    for x in magnitudes:
        exceedances += np.count_nonzero(x > level, axis=1)
    # The failure that was drawn is one of them, even where rounding leaves it on the barrier.
    return 1 / np.maximum(exceedances, 1)


importance_sampling = Estimator("importance sampling", conditional(_share))
