"""Predictions of models around the optimally weighted one: how far its posterior scatters them.

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
from modefront.study.asking import FAILED, Asking
from modefront.study.knowledge_variables import Variables, left_open
from modefront.study.predictions import assigned, by_kind
from modefront.study.run import generator
from modefront.uncertainty.differences import Stencil, stencil
from modefront.uncertainty.laplace import Posterior
from modefront.uncertainty.prediction import SUMMARY, TruncationError, draw, lognormal_std, summary


@dataclass(frozen=True)
class Around:
    """Models around the optimally weighted one.

    Attributes
    ----------
    differences : models along the axes of the posterior; None where there are none
    drawn : (draws, p) models drawn from it
    said : what is to be known of these, in words
    """

    differences: Stencil | None
    drawn: Floats
    said: Sequence[str]

    @property
    def models(self) -> int:
        """How many models there are."""
        along = 2 * len(self.differences.theta) if self.differences else 0
        return along + len(self.drawn)


def around(data: xr.Dataset, asking: Asking, posterior: Posterior | None, draws: int) -> Around:
    """Return the models around the optimally weighted one that predictions are to be made with."""
    problem = asking.problem
    none = np.empty((0, problem.start.size))
    if not asking.predictions:
        return Around(None, none, [])
    if posterior is None:
        missing = "there is no posterior: no models are drawn from it"
        return Around(None, none, [missing] if draws else [])
    said = []
    theta = data["theta"].values[_reference(data)]
    parted = zip(problem.model.parameters, left_open(posterior.free), strict=True)
    names = [name for name, is_open in parted if is_open]
    if names:
        said.append(
            "the posterior of predictions is that of what the data determine: where they leave "
            f"{enumeration(names)} open, the models are those of {data.attrs['reference']}"
        )
    differences = stencil(theta, posterior.axes, problem.lower, problem.upper)
    if differences is None:
        said.append(
            f"{data.attrs['reference']} has no room for differences between bounds: see draws"
        )
    drawn = none
    if draws:
        rng = generator(asking.seed, "posterior")
        bounds = problem.lower, problem.upper
        try:
            drawn = draw(theta, posterior.axes, rng, draws, bounds)
        except TruncationError as error:
            said.append(f"no models are drawn: the posterior is wider than the bounds ({error})")
    return Around(differences, drawn, said)


def predicted_around(data: xr.Dataset, asking: Asking, models: Around) -> xr.Dataset:
    """Return results that have predictions with how far the posterior scatters these."""
    variables: Variables = {}
    said = list(models.said)
    coordinates: dict[str, object] = {}
    for kind, predictions in by_kind(asking.predictions):
        for found, more in (
            _to_first_order(data, asking, models, predictions, kind),
            _of_draws(data, asking, models, predictions, kind),
        ):
            variables |= found
            said += more
        if models.differences is not None:
            coordinates[f"{kind.dimension}_other"] = data[kind.dimension].values
    if len(models.drawn):
        meaning = "parameters of models drawn from the posterior, within the bounds"
        variables["draw_theta"] = (("draw", "parameter"), models.drawn, meaning)
        coordinates["statistic"] = np.array(SUMMARY)
    finding = data["finding"]
    findings = np.array([*finding.values.tolist(), *said], dtype=str)
    variables["finding"] = (("finding",), findings, finding.attrs["long_name"])
    return assigned(data.drop_vars("finding"), variables).assign_coords(coordinates)


def _reference(data: xr.Dataset) -> int:
    """Return the position of the model around which the posterior lies."""
    return [str(x) for x in data["label"].values].index(data.attrs["reference"])


def _answers(
    asking: Asking, predictions: Sequence[Prediction], thetas: Floats, what: str
) -> tuple[dict[str, Floats], dict[str, int]]:
    """Return values at models (n, p) by their keys, each (n, places), and how many failed."""
    found = [
        [asking.other(one, f"{what}-{i}", theta) for i, theta in enumerate(thetas, start=1)]
        for one in predictions
    ]
    asked = list(zip(predictions, found, strict=True))
    values = {
        variable.key: np.hstack(
            [
                np.array([x[variable.key] for x in rows]).reshape(len(thetas), len(one.places))
                for one, rows in asked
            ]
        )
        for variable in predictions[0].kind.variables
    }
    return values, {one.name: sum(FAILED in x for x in rows) for one, rows in asked}


def _to_first_order(
    data: xr.Dataset,
    asking: Asking,
    models: Around,
    predictions: Sequence[Prediction],
    kind: Kind,
) -> tuple[Variables, list[str]]:
    """Return standard deviations and covariances, of the logarithms where these are linearised."""
    if models.differences is None:
        return {}, []
    m, _, p = models.differences.theta.shape
    values, _ = _answers(asking, predictions, models.differences.theta.reshape(2 * m, p), "axis")
    out: Variables = {}
    unknown = np.zeros(data.sizes[kind.dimension], dtype=np.bool_)
    reference = str(data.attrs["reference"])
    for variable in kind.ranged:
        middle = data[variable.name].values[_reference(data)]
        beside = values[variable.key].reshape(m, 2, -1)
        C = _covariance(models.differences, middle, beside, logarithmic=variable.logarithmic)
        unknown |= np.isfinite(middle) & np.isnan(np.diag(C))
        out |= _scatter(kind, variable, middle, C, reference)
    said = [
        f"no posterior standard deviation of {name}: models within one of {reference} cannot be "
        f"solved, or {kind.undefined}"
        for name in data[kind.dimension].values[unknown]
    ]
    return out, said


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


def _scatter(
    kind: Kind, variable: ResultVariable, middle: Floats, C: Floats, reference: str
) -> Variables:
    """Return the standard deviation and covariance of a variable, and of its logarithm."""
    own, both = (kind.dimension,), (kind.dimension, f"{kind.dimension}_other")
    std, name = np.sqrt(np.diag(C)), variable.name
    by = f"by the posterior around {reference}, to first order"
    if not variable.logarithmic:
        return {
            f"posterior_{name}_std": (own, std, f"standard deviation of {name} {by}"),
            f"posterior_{name}_covariance": (both, C, f"covariance of {name} {by}"),
        }
    symbol, start = variable.symbol, f"posterior_{kind.dimension}_log"
    return {
        f"{start}_std": (own, std, f"standard deviation of ln {symbol} {by}"),
        f"{start}_covariance": (both, C, f"covariance of ln {symbol} {by}"),
        f"posterior_{name}_std": (
            own,
            lognormal_std(middle, std),
            f"standard deviation of {name} that follows where ln {symbol} is Gaussian, of standard "
            f"deviation s: {symbol} sqrt(e^(s^2) (e^(s^2) - 1)), {symbol} that of {reference}",
        ),
    }


def _of_draws(
    data: xr.Dataset,
    asking: Asking,
    models: Around,
    predictions: Sequence[Prediction],
    kind: Kind,
) -> tuple[Variables, list[str]]:
    """Return what models drawn from the posterior predict, one by one and summed up."""
    n = len(models.drawn)
    if not n:
        return {}, []
    values, failed = _answers(asking, predictions, models.drawn, "draw")
    out: Variables = {}
    for variable in kind.ranged:
        drawn = values[variable.key]
        out[f"draw_{variable.name}"] = (
            ("draw", kind.dimension),
            drawn,
            f"{variable.name} of each model drawn from the posterior; NaN where there is none",
        )
        out[f"posterior_{variable.name}"] = (
            ("statistic", kind.dimension),
            summary(drawn),
            f"{variable.name} over the models drawn from the posterior"
            + (f"; its mean is {variable.mean}" if variable.mean else ""),
        )
    said = [
        f"{count} of {n} models drawn from the posterior cannot be solved for {name}: they are "
        "left out"
        for name, count in failed.items()
        if count
    ]
    said += [
        f"{count} of {n} models drawn from the posterior {kind.absent} for {name}: they are left "
        "out"
        for name, count in _absent(data, predictions, kind, values, failed)
        if count > 0
    ]
    return out, said


def _absent(
    data: xr.Dataset,
    predictions: Sequence[Prediction],
    kind: Kind,
    values: dict[str, Floats],
    failed: dict[str, int],
) -> list[tuple[str, int]]:
    """Return how many models were solved and have no value, where the reference has one."""
    first = kind.variables[0]
    missing = np.isnan(values[first.key]).sum(axis=0)
    sizes = [len(prediction.places) for prediction in predictions]
    missing -= np.repeat([failed[prediction.name] for prediction in predictions], sizes)
    missing[np.isnan(data[first.name].values[_reference(data)])] = 0
    return list(zip(data[kind.dimension].values.tolist(), missing.tolist(), strict=True))
