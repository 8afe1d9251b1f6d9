r"""The uncertainty of predictions, given that of the parameters.

A prediction q of covariance C of the parameters has, to first order, the covariance
:math:`\partial q \, C \, \partial q^T`. With axes R, :math:`R R^T = C`, the parameters are
:math:`\theta = \hat\theta + R z`, z standard normal, and that is :math:`S S^T` with
:math:`S = \partial q / \partial z` (`modefront.uncertainty.differences`).

A probability P varies by orders of magnitude. Its logarithm is what is nearly linear: where it has
the standard deviation s around :math:`\ln \hat P`, P is lognormal with the median :math:`\hat P`,
the mean :math:`\hat P e^{s^2/2}` and the standard deviation

.. math:: \hat P \sqrt{e^{s^2} (e^{s^2} - 1)} .

Where q bends too much for that, or where there is no gradient, it is evaluated at a sample of the
Gaussian. The mean of probabilities over the posterior is the robust, or updated, failure
probability (Papadimitriou, Beck & Katafygiotis 2001, Probabilistic Engineering Mechanics 16,
103-113, doi:10.1016/S0266-8920(00)00012-6).
"""

from __future__ import annotations

import numpy as np

from modefront._typing import Floats

SUMMARY = ("mean", "standard deviation", "5 %", "50 %", "95 %")
"""Statistics of a sample: two moments and three quantiles."""

BATCH = 1000
"""Draws that are made at a time."""

SELDOM = 1e-4
"""Share of draws within the bounds below which there is no sampling by trial."""

TRIALS = 100_000
"""Draws after which that share is judged."""


class TruncationError(ValueError):
    """The share of a Gaussian within the bounds is too small to sample."""


def linear(covariance: Floats, slope: Floats) -> Floats:
    """Return the covariance (q, q) of predictions with derivatives ``slope`` (q, p)."""
    out: Floats = slope @ covariance @ slope.T
    return out


def lognormal_std(median: Floats, s: Floats) -> Floats:
    """Return the standard deviation of what has this median and, of its logarithm, the std s."""
    with np.errstate(over="ignore"):
        grown = np.expm1(s**2)
        out: Floats = median * np.sqrt(grown * (grown + 1))
    return out


def draw(
    theta: Floats,
    axes: Floats,
    rng: np.random.Generator,
    count: int,
    bounds: tuple[Floats, Floats] | None = None,
) -> Floats:
    """Return a sample (count, p) of theta + axes z, z standard normal, axes (p, m).

    With ``bounds`` (lower, upper), draws outside them are drawn again: the Gaussian is truncated.
    A longer sample begins with a shorter one. Raises TruncationError where fewer than
    one draw of 10,000 is within the bounds.
    """
    lower, upper = bounds if bounds is not None else (-np.inf, np.inf)
    parts: list[Floats] = []
    accepted = drawn_count = 0
    while accepted < count:
        if drawn_count >= TRIALS and accepted < SELDOM * drawn_count:
            raise TruncationError(f"{accepted} of {drawn_count} draws are within the bounds")
        drawn = theta + rng.standard_normal((BATCH, axes.shape[1])) @ axes.T
        within = drawn[((drawn >= lower) & (drawn <= upper)).all(axis=1)]
        parts.append(within)
        accepted += len(within)
        drawn_count += BATCH
    return np.concatenate([*parts, np.empty((0, theta.size))])[:count]


def summary(values: Floats) -> Floats:
    """Return mean, standard deviation and quantiles (`SUMMARY`) of columns, (5, columns).

    Rows that are NaN are left out of a column; fewer than two others give NaN.
    """
    out = np.full((len(SUMMARY), values.shape[1]), np.nan)
    for i, column in enumerate(values.T):
        known = column[np.isfinite(column)]
        if known.size > 1:
            out[:2, i] = known.mean(), known.std(ddof=1)
            out[2:, i] = np.quantile(known, [0.05, 0.5, 0.95])
    return out
