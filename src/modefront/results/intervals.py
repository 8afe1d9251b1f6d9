"""Intervals of the parameters by the posterior, and which of them the data determine."""

from __future__ import annotations

import numpy as np
import xarray as xr

from modefront._typing import Floats
from modefront.results.schema import described
from modefront.uncertainty.freed import Freed

QUANTILES = (0.05, 0.5, 0.95)
"""Quantiles of the parameters: a 90 % interval and the median."""

DETERMINED, OPEN = 1 / 3, 0.8
"""Width of the 90 % interval over that of the prior, below which a parameter is determined, and
above which it is not."""


TRUST = ("determined", "partly", "not determined")
"""What the data say of a parameter."""


def with_intervals(
    data: xr.Dataset, samples: Floats, misfit: Floats, assumed: str, widths: Floats
) -> xr.Dataset:
    """Return results with quantiles of models (samples, p) that were drawn from the posterior.

    A quantile is such that the next draw is below it with its probability. ``misfit`` (n,) are the
    errors of the groups over those expected, ``assumed`` says which of these are assumed, and
    ``widths`` (p,) are those of the 90 % intervals of the priors.
    """
    interval = np.quantile(samples, QUANTILES, axis=0, method="weibull").T
    share = (interval[:, 2] - interval[:, 0]) / widths
    place = np.where(share < DETERMINED, 0, np.where(share > OPEN, 2, 1))
    values = {
        "sample_theta": samples,
        "interval": interval,
        "trust": np.array(TRUST)[place],
        "misfit": misfit,
    }
    out = data.assign(described(values)).assign_coords(quantile=list(QUANTILES))
    return out.assign_attrs(assumed=assumed)


def with_freed(data: xr.Dataset, found: Freed | None) -> xr.Dataset:
    """Return results with the model to which wider bounds lead; as they are without one."""
    if found is None:
        return data
    return data.assign(described({"freed_theta": found.theta, "freed_misfit": found.misfit}))
