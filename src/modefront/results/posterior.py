"""What the posterior says of the parameters, and the scatter of the predictions by it.

To first order predictions need two models along each axis of the posterior; with draws, the models
drawn.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from modefront._typing import Floats
from modefront.findings.knowledge import enumeration
from modefront.findings.record import Finding, found, from_text
from modefront.findings.selection import reference
from modefront.front.point import preferred
from modefront.predictions import Prediction
from modefront.predictions.registry import kinds_in
from modefront.predictions.runner import Predicted, PredictionRunner
from modefront.results.analysis import Values, left_open
from modefront.results.findings import as_values
from modefront.results.predictions import by_kind
from modefront.results.schema import described
from modefront.uncertainty.inference import Inference
from modefront.uncertainty.laplace import Posterior
from modefront.uncertainty.prediction import (
    SUMMARY,
    Stencil,
    TruncationError,
    draw,
    lognormal_std,
    stencil,
    summary,
)
from modefront.work.task import seed_sequence

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


@dataclass(frozen=True)
class PosteriorModels:
    """Models around the reference.

    Attributes
    ----------
    differences : finite-difference models along the axes of the posterior; None for none
    samples : (draws, p) samples of the posterior
    limits : what limits them
    """

    differences: Stencil | None
    samples: Floats
    limits: Sequence[Finding]

    @property
    def count(self) -> int:
        """Number of models."""
        along = 2 * len(self.differences.theta) if self.differences else 0
        return along + len(self.samples)


def posterior_models(
    data: xr.Dataset,
    runner: PredictionRunner,
    posterior: Posterior | None,
    draws: int,
    drawn: Floats | None = None,
) -> PosteriorModels:
    """Return the models around the reference at which predictions are evaluated.

    ``drawn`` (draws or more, p) are models of the posterior; they are drawn around the reference
    where it is None.
    """
    problem = runner.problem
    none = np.empty((0, problem.start.size))
    if not runner.predictions:
        return PosteriorModels(None, none, [])
    samples = none if drawn is None else drawn[:draws]
    if posterior is None and len(samples):
        return PosteriorModels(None, samples, [])
    if posterior is None:
        return PosteriorModels(None, none, [found("no-posterior")] if draws else [])
    limits = []
    theta, best = data["theta"].values[reference(data)], preferred(data.attrs)
    parted = zip(problem.model.parameters, left_open(posterior.free), strict=True)
    names = [name for name, is_open in parted if is_open]
    if names:
        limits.append(found("open-in-posterior", enumeration(names), reference=best))
    differences = stencil(theta, posterior.axes, problem.lower, problem.upper)
    if differences is None:
        limits.append(found("no-room", str(best)))
    if draws and drawn is None:
        rng = np.random.default_rng(seed_sequence(runner.seed, "posterior"))
        bounds = problem.lower, problem.upper
        try:
            samples = draw(theta, posterior.axes, rng, draws, bounds)
        except TruncationError as error:
            limits.append(found("no-draws", str(error)))
    return PosteriorModels(differences, samples, limits)


def with_posterior(
    data: xr.Dataset, runner: PredictionRunner, models: PosteriorModels
) -> xr.Dataset:
    """Return results that have predictions with the scatter of these by the posterior."""
    values: Values = {}
    limits = list(models.limits)
    coordinates: dict[str, object] = {}
    for kind, predictions in by_kind(runner.predictions):
        if models.differences is not None:
            variables, more = _to_first_order(data, runner, models.differences, predictions)
            values |= variables
            limits += more
            coordinates[f"{kind.dimension}_other"] = data[kind.dimension].values
        if len(models.samples):
            variables, more = _of_samples(data, runner, models.samples, predictions)
            values |= variables
            limits += more
    if len(models.samples):
        values["draw_theta"] = models.samples
        coordinates["statistic"] = np.array(SUMMARY)
    kept = zip(data["finding"].values.tolist(), data["finding_record"].values, strict=True)
    values |= as_values([*(from_text(str(text), each) for each, text in kept), *limits])
    data = data.drop_vars(["finding", "finding_record"])
    return data.assign(described(values, kinds_in(data))).assign_coords(coordinates)


def _stacked(
    predictions: Sequence[Prediction], rows: Sequence[Sequence[Predicted]]
) -> dict[str, Floats]:
    """Return values at models by their keys, each (models, places)."""
    return {
        variable.key: np.hstack(
            [
                np.array([x.values[variable.key] for x in row]).reshape(len(row), len(each.places))
                for each, row in zip(predictions, rows, strict=True)
            ]
        )
        for variable in predictions[0].kind.variables
    }


def _to_first_order(
    data: xr.Dataset,
    runner: PredictionRunner,
    differences: Stencil,
    predictions: Sequence[Prediction],
) -> tuple[Values, list[Finding]]:
    """Return standard deviations and covariances, of the logarithms where these are linearised."""
    kind = predictions[0].kind
    m, _, p = differences.theta.shape
    thetas = differences.theta.reshape(2 * m, p)
    values = _stacked(predictions, [runner.at_models(each, thetas, "axis") for each in predictions])
    out: Values = {}
    unknown = np.zeros(data.sizes[kind.dimension], dtype=np.bool_)
    for variable in kind.ranged:
        middle = data[variable.name].values[reference(data)]
        beside = values[variable.key].reshape(m, 2, -1)
        with np.errstate(divide="ignore", invalid="ignore"):
            change = (np.log(middle), np.log(beside)) if variable.logarithmic else (middle, beside)
            S = differences.slopes(*change)
        S[~np.isfinite(S).all(axis=1)] = np.nan
        C = S @ S.T
        std, name = np.sqrt(np.diag(C)), f"posterior_{variable.name}"
        unknown |= np.isfinite(middle) & np.isnan(std)
        if variable.logarithmic:
            start = f"posterior_{kind.dimension}_log"
            out |= {f"{start}_std": std, f"{start}_covariance": C}
            out[f"{name}_std"] = lognormal_std(middle, std)
        else:
            out |= {f"{name}_std": std, f"{name}_covariance": C}
    best = preferred(data.attrs)
    return out, [
        found("no-deviation", str(name), reference=best, undefined=kind.undefined)
        for name in data[kind.dimension].values[unknown]
    ]


def _of_samples(
    data: xr.Dataset,
    runner: PredictionRunner,
    samples: Floats,
    predictions: Sequence[Prediction],
) -> tuple[Values, list[Finding]]:
    kind, n = predictions[0].kind, len(samples)
    rows = [runner.at_models(each, samples, "draw") for each in predictions]
    values = _stacked(predictions, rows)
    out: Values = {}
    for variable in kind.ranged:
        out[f"draw_{variable.name}"] = values[variable.key]
        out[f"posterior_{variable.name}"] = summary(values[variable.key])
    failed = [sum(not x.solved for x in row) for row in rows]
    limits = [
        found("unsolved-draws", each.name, count=count, drawn=n, what="cannot be solved")
        for each, count in zip(predictions, failed, strict=True)
        if count
    ]
    first = kind.variables[0]
    missing = np.isnan(values[first.key]).sum(axis=0)
    missing -= np.repeat(failed, [len(each.places) for each in predictions])
    missing[np.isnan(data[first.name].values[reference(data)])] = 0
    limits += [
        found("unsolved-draws", str(name), count=int(count), drawn=n, what=kind.absent)
        for name, count in zip(data[kind.dimension].values, missing, strict=True)
        if count > 0
    ]
    return out, limits
