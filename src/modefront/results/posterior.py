"""What the posterior says of the parameters."""

from __future__ import annotations

import numpy as np
import xarray as xr

from modefront.results.schema import described
from modefront.uncertainty.inference import Inference
from modefront.uncertainty.prediction import summary

QUANTILES = (0.05, 0.5, 0.95)
"""Quantiles of the parameters: a 90 % interval and the median."""

DETERMINED, OPEN = 1 / 3, 0.8
"""Width of the 90 % interval over that of the prior, below which a parameter is determined, and
above which it is not."""

TRUST = ("determined", "partly", "not determined")
"""What the data say of a parameter."""


def with_intervals(data: xr.Dataset, inference: Inference) -> xr.Dataset:
    """Return results with what the posterior says.

    A quantile is such that the next draw is below it with its probability. Of draws that do not
    settle no parameter is called determined.
    """
    draws, fit, freed = inference.draws, inference.fit, inference.freed
    interval = np.quantile(draws.theta, QUANTILES, axis=0, method="weibull").T
    share = (interval[:, 2] - interval[:, 0]) / inference.widths
    place = np.where((share < DETERMINED) & draws.settled, 0, np.where(share > OPEN, 2, 1))
    p = inference.widths.size
    values = {
        "sample_theta": draws.theta,
        "interval": interval,
        "trust": np.array(TRUST)[place],
        "prior_width": inference.widths,
        "misfit": fit.misfit,
        "nominal_misfit": fit.nominal,
        "likely_mode": fit.pairs,
        "posterior_std": draws.theta.std(axis=0, ddof=1),
        "posterior_covariance": np.cov(draws.theta, rowvar=False).reshape(p, p),
        "posterior_frequency_std": summary(draws.frequency)[1],
        "posterior_mac_std": summary(draws.mac)[1],
        "candidate_frequency": fit.candidates.frequency,
        "candidate_sensor": list(fit.candidates.sensor),
        "candidate_gain": fit.candidates.gain,
    }
    if freed is not None:
        values |= {"freed_theta": freed.theta, "freed_misfit": freed.misfit}
    out = data.assign(described(values)).assign_coords(quantile=list(QUANTILES))
    return out.assign_attrs(assumed=inference.assumed, settled=int(draws.settled))
