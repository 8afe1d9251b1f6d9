r"""The uncertainty of predictions, given that of the parameters; see docs/uncertainty.md.

A probability varies by orders of magnitude, and its logarithm is what is nearly linear: P is
lognormal. Derivatives are central differences, one-sided ones of second order near bounds. A step
of one half a standard deviation leaves 0.06 % of one for smooth peaks; probabilities, estimated
with the same random numbers for all models, are rough below it.
"""

from dataclasses import dataclass

import numpy as np

from modefront._typing import Floats
from modefront.optim.problem import room
from modefront.uncertainty.sampling import QUANTILES

SUMMARY = ("mean", "standard deviation", "5 %", "50 %", "95 %")  # statistics of a sample
STEP = 0.5  # of a difference, in standard deviations
LEAST = 0.05  # shortest step, where bounds are near
NEGLIGIBLE = 1e-9  # part of an axis in the standard deviation of a parameter that counts as none
BATCH = 1000  # draws that are made at a time

TRIALS = 10_000  # draws for one within the bounds, at most, where samples are drawn by trial


@dataclass(frozen=True)
class Stencil:
    """Models for finite differences of predictions, with the coefficients of the differences."""

    theta: Floats  # (m, 2, p) parameters, two an axis
    factors: Floats  # (m, 3) of the prediction in the middle and at these

    def slopes(self, middle: Floats, values: Floats) -> Floats:
        """Return derivatives (q, m) of predictions (q,) in the middle and (m, 2, q) around it."""
        first = np.outer(middle, self.factors[:, 0])
        return first + np.einsum("mk,mkq->qm", self.factors[:, 1:], values)


def stencil(theta: Floats, axes: Floats, lower: Floats, upper: Floats) -> Stencil | None:
    """Return differences about theta (p,) along axes (p, m) within bounds; None without room."""
    m = axes.shape[1]
    std = np.linalg.norm(axes, axis=1)
    directions = np.where(np.abs(axes) > NEGLIGIBLE * std[:, None], axes, 0.0).T
    points, factors = np.empty((m, 2, theta.size)), np.empty((m, 3))
    for k, direction in enumerate(directions):
        up, down = (room(theta, s * direction, lower, upper) for s in (1.0, -1.0))
        side = 1.0 if up >= down else -1.0
        central, aside = min(STEP, up, down), min(STEP, max(up, down) / 2)
        if max(central, aside) < LEAST:
            return None
        a, b = (central, -central) if central >= aside else (side * aside, 2 * side * aside)
        factors[k] = -(a + b) / (a * b), b / (a * (b - a)), -a / (b * (b - a))
        points[k] = np.clip(theta + np.array([[a], [b]]) * direction, lower, upper)
    return Stencil(points, factors)


class TruncationError(ValueError):
    """The share of a Gaussian within the bounds is too small to sample."""


def lognormal_std(median: Floats, s: Floats) -> Floats:
    """Return the standard deviation of what has this median and, of its logarithm, the std s."""
    with np.errstate(over="ignore"):
        grown = np.expm1(s**2)
        return np.asarray(median * np.sqrt(grown * (grown + 1)))


def draw(
    theta: Floats, axes: Floats, rng: np.random.Generator, count: int, bounds: tuple[Floats, Floats]
) -> Floats:
    """Return a sample (count, p) of theta + axes z, z standard normal, axes (p, m).

    Draws outside the bounds (lower, upper) are drawn again: the Gaussian is truncated. A longer
    sample begins with a shorter one. Raises TruncationError where fewer than one draw of 10,000 is
    within the bounds.
    """
    (lower, upper), out, tried = bounds, np.empty((0, theta.size)), 0
    while len(out) < count:
        if tried >= 10 * TRIALS and len(out) * TRIALS < tried:
            raise TruncationError(f"{len(out)} of {tried} draws are within the bounds")
        drawn = theta + rng.standard_normal((BATCH, axes.shape[1])) @ axes.T
        out = np.vstack([out, drawn[((drawn >= lower) & (drawn <= upper)).all(axis=1)]])
        tried += BATCH
    return out[:count]


def summary(values: Floats) -> Floats:
    """Return the `SUMMARY` (5, columns) of columns without what is NaN; NaN for fewer than two."""
    out = np.full((len(SUMMARY), values.shape[1]), np.nan)
    for i, column in enumerate(values.T):
        known = column[np.isfinite(column)]
        if known.size > 1:
            out[:2, i] = known.mean(), known.std(ddof=1)
            out[2:, i] = np.quantile(known, QUANTILES, method="weibull")
    return out
