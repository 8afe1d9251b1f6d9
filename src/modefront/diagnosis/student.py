r"""Residuals whose scale is not known, in units of which few large ones cost little.

Residuals :math:`r_k` of a kind have Student's distribution with a scale :math:`\sigma` that is
expected near :math:`\sigma_0`. The negative logarithm of their probability, less a constant, is

.. math:: C = \min_\sigma \sum_k w_k \Big[\ln \sigma
   + \tfrac{\nu + 1}{2} \ln\Big(1 + \frac{r_k^2}{\nu \sigma^2}\Big)\Big]
   + \frac{1}{2 s^2} \ln^2 \frac{\sigma}{\sigma_0}.

So where all are large, a single large one is nothing special (Lange, Little & Taylor, J. Am. Stat.
Assoc. 84, 1989, doi:10.1080/01621459.1989.10478852).
"""

from __future__ import annotations

import numpy as np

from modefront._typing import Floats
from modefront.rounding import ACCUMULATED

SCALES, SPREAD = np.linspace(-4.0, 4.0, 33), 0.5
"""Logarithms of the scales that are tried, over the one that is expected, and their spread."""

NOTHING = 0.5
"""Cost of a value of which nothing is known: of one from a normal distribution of size 1."""


def loss(r: Floats, nu: float) -> Floats:
    """Return the cost of residuals over their scale."""
    return np.asarray((nu + 1) / 2 * np.log1p(r**2 / nu))


def scaled(
    r: Floats, expected: float, nu: float, weight: Floats | float = 1.0
) -> tuple[float, float]:
    """Return C of residuals r, each with a weight, and the scale sigma with which it is least."""
    if not r.size:
        return 0.0, expected
    scales, weight = expected * np.exp(SCALES), np.broadcast_to(weight, r.shape)
    costs = loss(r / scales[:, None], nu) @ weight + weight.sum() * np.log(scales)
    costs = costs + (SCALES / SPREAD) ** 2 / 2
    k = min(max(int(np.argmin(costs)), 1), SCALES.size - 2)
    a, b, c = costs[k - 1 : k + 2]
    shift = float(np.clip((a - c) / (2 * (a - 2 * b + c) + ACCUMULATED), -0.5, 0.5))
    least = float(b - (a - c) * shift / 4)
    return least, float(scales[k] * np.exp(shift * (SCALES[1] - SCALES[0])))
