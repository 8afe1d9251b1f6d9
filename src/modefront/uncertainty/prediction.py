r"""The uncertainty of predictions, given that of the parameters.

A prediction q of covariance C of the parameters has, to first order, the covariance
:math:`\partial q \, C \, \partial q^T`. Where q bends too much for that, or where there is no
gradient, it is evaluated at a sample of the Gaussian.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from modefront._typing import Floats


def linear(covariance: Floats, slope: Floats) -> Floats:
    """Return the covariance (q, q) of predictions with derivatives ``slope`` (q, p)."""
    out: Floats = slope @ covariance @ slope.T
    return out


def sampled(
    theta: Floats,
    covariance: Floats,
    predict: Callable[[Floats], Floats],
    rng: np.random.Generator,
    count: int = 1000,
    bounds: tuple[Floats, Floats] | None = None,
) -> Floats:
    """Return predictions (count, ...) at a sample of the Gaussian around ``theta`` (p,).

    With ``bounds`` (lower, upper), draws outside them are drawn again: the Gaussian is truncated.
    """
    lam, V = np.linalg.eigh(covariance)
    root = V * np.sqrt(np.maximum(lam, 0.0))
    lower, upper = bounds if bounds is not None else (-np.inf, np.inf)
    out: list[Floats] = []
    while len(out) < count:
        drawn = theta + root @ rng.standard_normal(theta.size)
        if ((drawn >= lower) & (drawn <= upper)).all():
            out.append(predict(drawn))
    return np.array(out)
