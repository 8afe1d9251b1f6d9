"""The most probable model without the bounds that hold it: what these cost, and where it goes.

A bound that excludes the truth also drives other parameters to theirs. All bounds that hold the
model are widened at once, and only those beyond which it then lies are to blame.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from modefront._typing import Floats
from modefront.optim.problem import at_bounds
from modefront.uncertainty.most_probable import maximum
from modefront.uncertainty.prior import NoiseModel
from modefront.work.codec import record
from modefront.work.task import Executor, Task


@record
@dataclass(frozen=True)
class Freed:
    """The most probable model between wider bounds.

    Attributes
    ----------
    theta : (p,) its parameters
    misfit : (n,) its root mean square errors over those expected
    """

    theta: Floats
    misfit: Floats


def freed(noise: NoiseModel, theta: Floats, work: Executor) -> Freed | None:
    """Return the most probable model without the bounds that hold theta (p,).

    None where no bound holds it, and where the search without them does not converge.
    """
    lower, upper = noise.problem.lower, noise.problem.upper
    sides = at_bounds(theta, lower, upper)
    if not sides.any():
        return None
    wider_lower, wider_upper = wider(lower, upper)
    problem = replace(
        noise.problem,
        lower=np.where(sides < 0, wider_lower, lower),
        upper=np.where(sides > 0, wider_upper, upper),
    )
    (found,) = work.run(
        [Task(("most-probable", "freed"), _freed, (replace(noise, problem=problem), theta))]
    )
    out: Freed | None = found
    return out


def wider(lower: Floats, upper: Floats) -> tuple[Floats, Floats]:
    """Return bounds (p,) that are farther away by the range, or by the ratio of positive ones."""
    positive = lower > 0
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(positive, upper / lower, 1.0)
        below = np.where(positive, lower / ratio, 2 * lower - upper)
        above = np.where(positive, upper * ratio, 2 * upper - lower)
    return below, above


def _freed(noise: NoiseModel, theta: Floats) -> Freed | None:
    """Return the model to which theta (p,) leads; None where the search does not converge."""
    found = maximum(noise, theta)
    return Freed(found.theta, noise.over_expected(found.J[:-1])) if found.converged else None
