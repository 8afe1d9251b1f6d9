"""Scatter of the predictions by the posterior of the reference.

To first order they need two models along each axis of the posterior; with draws, the models drawn.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from modefront._typing import Floats
from modefront.identifiability.words import enumeration
from modefront.predictions import Kind, Prediction, ResultVariable
from modefront.predictions.runner import Predicted, PredictionRunner
from modefront.results.analysis import Values, left_open
from modefront.results.predictions import by_kind
from modefront.results.schema import described
from modefront.uncertainty.differences import Stencil, stencil
from modefront.uncertainty.laplace import Posterior
from modefront.uncertainty.prediction import SUMMARY, TruncationError, draw, lognormal_std, summary
from modefront.work.task import seed_sequence


@dataclass(frozen=True)
class PosteriorModels:
    """Models around the reference.

    Attributes
    ----------
    differences : finite-difference models along the axes of the posterior; None for none
    samples : (draws, p) samples of the posterior
    messages : what limits them
    """

    differences: Stencil | None
    samples: Floats
    messages: Sequence[str]

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
        missing = "there is no posterior: no models are drawn from it"
        return PosteriorModels(None, none, [missing] if draws else [])
    messages = []
    theta, reference = data["theta"].values[_reference(data)], data.attrs["reference"]
    parted = zip(problem.model.parameters, left_open(posterior.free), strict=True)
    names = [name for name, is_open in parted if is_open]
    if names:
        messages.append(
            "the posterior of predictions is that of what the data determine: where they leave "
            f"{enumeration(names)} open, the models are those of {reference}"
        )
    differences = stencil(theta, posterior.axes, problem.lower, problem.upper)
    if differences is None:
        messages.append(f"{reference} has no room for differences between bounds: see draws")
    if draws and drawn is None:
        rng = np.random.default_rng(seed_sequence(runner.seed, "posterior"))
        bounds = problem.lower, problem.upper
        try:
            samples = draw(theta, posterior.axes, rng, draws, bounds)
        except TruncationError as error:
            messages.append(
                f"no models are drawn: the posterior is wider than the bounds ({error})"
            )
    return PosteriorModels(differences, samples, messages)


def with_posterior(
    data: xr.Dataset, runner: PredictionRunner, models: PosteriorModels
) -> xr.Dataset:
    """Return results that have predictions with the scatter of these by the posterior."""
    values: Values = {}
    messages = list(models.messages)
    coordinates: dict[str, object] = {}
    for kind, predictions in by_kind(runner.predictions):
        if models.differences is not None:
            variables, remarks = _to_first_order(data, runner, models.differences, predictions)
            values |= variables
            messages += remarks
            coordinates[f"{kind.dimension}_other"] = data[kind.dimension].values
        if len(models.samples):
            variables, remarks = _of_samples(data, runner, models.samples, predictions)
            values |= variables
            messages += remarks
    if len(models.samples):
        values["draw_theta"] = models.samples
        coordinates["statistic"] = np.array(SUMMARY)
    values["finding"] = [*data["finding"].values.tolist(), *messages]
    return data.drop_vars("finding").assign(described(values)).assign_coords(coordinates)


def _reference(data: xr.Dataset) -> int:
    """Return the position of the model around which the posterior lies."""
    return [str(x) for x in data["label"].values].index(data.attrs["reference"])


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
) -> tuple[Values, list[str]]:
    """Return standard deviations and covariances, of the logarithms where these are linearised."""
    kind = predictions[0].kind
    m, _, p = differences.theta.shape
    thetas = differences.theta.reshape(2 * m, p)
    values = _stacked(predictions, [runner.at_models(each, thetas, "axis") for each in predictions])
    out: Values = {}
    unknown = np.zeros(data.sizes[kind.dimension], dtype=np.bool_)
    for variable in kind.ranged:
        middle = data[variable.name].values[_reference(data)]
        beside = values[variable.key].reshape(m, 2, -1)
        C = _covariance(differences, middle, beside, logarithmic=variable.logarithmic)
        unknown |= np.isfinite(middle) & np.isnan(np.diag(C))
        out |= _scatter(kind, variable, middle, C)
    messages = [
        f"no posterior standard deviation of {name}: models within one of "
        f"{data.attrs['reference']} cannot be solved, or {kind.undefined}"
        for name in data[kind.dimension].values[unknown]
    ]
    return out, messages


def _covariance(
    differences: Stencil, middle: Floats, beside: Floats, *, logarithmic: bool
) -> Floats:
    """Return the covariance of values (places,), or of their logarithms, by differences."""
    with np.errstate(divide="ignore", invalid="ignore"):
        change = (np.log(middle), np.log(beside)) if logarithmic else (middle, beside)
        S = differences.slopes(*change)
    S[~np.isfinite(S).all(axis=1)] = np.nan
    out: Floats = S @ S.T
    return out


def _scatter(kind: Kind, variable: ResultVariable, middle: Floats, C: Floats) -> Values:
    """Return the standard deviation and covariance of a variable, and of its logarithm."""
    std, name = np.sqrt(np.diag(C)), f"posterior_{variable.name}"
    if not variable.logarithmic:
        return {f"{name}_std": std, f"{name}_covariance": C}
    start = f"posterior_{kind.dimension}_log"
    return {
        f"{start}_std": std,
        f"{start}_covariance": C,
        f"{name}_std": lognormal_std(middle, std),
    }


def _of_samples(
    data: xr.Dataset,
    runner: PredictionRunner,
    samples: Floats,
    predictions: Sequence[Prediction],
) -> tuple[Values, list[str]]:
    """Return the predictions of samples of the posterior, each and summed up."""
    kind, n = predictions[0].kind, len(samples)
    rows = [runner.at_models(each, samples, "draw") for each in predictions]
    values = _stacked(predictions, rows)
    out: Values = {}
    for variable in kind.ranged:
        out[f"draw_{variable.name}"] = values[variable.key]
        out[f"posterior_{variable.name}"] = summary(values[variable.key])
    failed = [sum(not x.solved for x in row) for row in rows]
    messages = [
        f"{count} of {n} models drawn from the posterior cannot be solved for {each.name}: they "
        "are left out"
        for each, count in zip(predictions, failed, strict=True)
        if count
    ]
    first = kind.variables[0]
    missing = np.isnan(values[first.key]).sum(axis=0)
    missing -= np.repeat(failed, [len(each.places) for each in predictions])
    missing[np.isnan(data[first.name].values[_reference(data)])] = 0
    messages += [
        f"{count} of {n} models drawn from the posterior {kind.absent} for {name}: they are left "
        "out"
        for name, count in zip(data[kind.dimension].values, missing, strict=True)
        if count > 0
    ]
    return out, messages
