"""First passage by the additive rules of probability.

With the elementary failures in an order, E_1, E_2, …, the rule P(A ∪ B) = P(A) + P(B) - P(A ∩ B),
used over and over, gives their union as a sum of disjoint parts,

    P = Σ_k [ P(E_k) - P(E_k ∩ (E_1 ∪ … ∪ E_{k-1})) ] = Σ_k P_k P(none of E_1 … E_{k-1} | E_k).

Here the order is that of time (outputs at the same time by their number), so that a part is the
probability of failing at that time for the first time. Drawing k with probability P_k/ΣP and z
given E_k, the weight is

    ΣP · 1[E_k is the first].

That is a count, and no order matters to P: averaged over the failures that a sample contains, the
indicator becomes 1/N, the weight of `modefront.reliability.importance`, which is why that has the
smaller variance. This one is simpler, and a check on it that shares no weight with it; where P is
not small, ΣP is large, few samples are the first, and the coefficient of variation shows it.

K.-V. Yuen, L. S. Katafygiotis, Probab. Eng. Mech. 20 (2005) 109-114,
doi:10.1016/j.probengmech.2004.07.003, for the rules; the estimator is as derived here.
"""

from collections.abc import Iterator

import numpy as np

from modefront.reliability.elementary import Failed, conditional
from modefront.reliability.estimate import Estimator
from modefront.response.system import FloatArray


def _share(failed: Failed, level: float, magnitudes: Iterator[FloatArray]) -> FloatArray:
    first = np.ones(failed.z.shape[0], dtype=bool)
    steps = np.arange(failed.z.shape[-1])
    for output, x in enumerate(magnitudes):
        # At the time of the failure drawn, outputs of lower number come before it.
        end = failed.step + (output < failed.output)
        first &= ~np.any((x > level) & (steps < end[:, None]), axis=1)
    return first.astype(np.float64)


additive_rules = Estimator("additive rules", conditional(_share))
