"""Predictions of models around the optimally weighted one: how far its posterior scatters them.

To first order they need two models along each axis of the posterior; with draws, the models drawn.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from modefront._typing import Floats
from modefront.identifiability.words import enumeration
from modefront.predictions import Passage, PeakResponse, Prediction
from modefront.study.asking import FAILED, Asking
from modefront.study.knowledge_variables import Variables, left_open
from modefront.study.run import generator
from modefront.uncertainty.differences import Stencil, stencil
from modefront.uncertainty.laplace import Posterior
from modefront.uncertainty.prediction import SUMMARY, TruncationError, draw, lognormal_std, summary


@dataclass(frozen=True)
class _Kind:
    """A kind of predictions: its dimension, and variables with the quantities that they hold."""

    name: str
    prediction: type[Prediction]
    variables: Mapping[str, str]


PEAK = _Kind("frf", PeakResponse, {"frf_peak": "peak", "frf_peak_frequency": "frequency"})
FAILURE = _Kind("failure", Passage, {"failure_probability": "probability"})
KINDS = (PEAK, FAILURE)


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
    for kind in KINDS:
        predictions = [one for one in asking.predictions if isinstance(one, kind.prediction)]
        if not predictions:
            continue
        for found, more in (
            _to_first_order(data, asking, models, predictions, kind),
            _of_draws(data, asking, models, predictions, kind),
        ):
            variables |= found
            said += more
    if len(models.drawn):
        meaning = "parameters of models drawn from the posterior, within the bounds"
        variables["draw_theta"] = (("draw", "parameter"), models.drawn, meaning)
    finding = data["finding"]
    all_said = np.array([*finding.values.tolist(), *said], dtype=str)
    variables["finding"] = (("finding",), all_said, finding.attrs["long_name"])
    out = data.drop_vars("finding").assign(
        {
            name: (dims, np.asarray(values), {"long_name": meaning})
            for name, (dims, values, meaning) in variables.items()
        }
    )
    names = {f"{kind.name}_other": kind.name for kind in KINDS}
    names = {other: name for other, name in names.items() if other in out.dims}
    coordinates = {other: data[name].values for other, name in names.items()}
    if "statistic" in out.dims:
        coordinates["statistic"] = np.array(SUMMARY)
    return out.assign_coords(coordinates)


def _reference(data: xr.Dataset) -> int:
    """Return the position of the model around which the posterior lies."""
    return [str(x) for x in data["label"].values].index(data.attrs["reference"])


def _answers(
    asking: Asking, predictions: Sequence[Prediction], thetas: Floats, what: str
) -> tuple[dict[str, Floats], dict[str, int]]:
    """Return quantities at models (n, p), each (n, values), and how often predictions failed."""
    found = [
        [asking.other(one, f"{what}-{i}", theta) for i, theta in enumerate(thetas, start=1)]
        for one in predictions
    ]
    asked = list(zip(predictions, found, strict=True))
    values = {
        name: np.hstack(
            [
                np.array([x[name] for x in rows]).reshape(len(thetas), len(one.places))
                for one, rows in asked
            ]
        )
        for name in (x.key for x in predictions[0].kind.variables)
    }
    return values, {one.name: sum(FAILED in x for x in rows) for one, rows in asked}


def _to_first_order(
    data: xr.Dataset,
    asking: Asking,
    models: Around,
    predictions: Sequence[Prediction],
    kind: _Kind,
) -> tuple[Variables, list[str]]:
    """Return standard deviations and covariances; those of probabilities by their logarithms."""
    if models.differences is None:
        return {}, []
    m, _, p = models.differences.theta.shape
    values, _ = _answers(asking, predictions, models.differences.theta.reshape(2 * m, p), "axis")
    out: Variables = {}
    unknown = np.zeros(data.sizes[kind.name], dtype=np.bool_)
    both = (kind.name, f"{kind.name}_other")
    for variable, name in kind.variables.items():
        middle, beside = data[variable].values[_reference(data)], values[name].reshape(m, 2, -1)
        logarithmic = variable == "failure_probability"
        with np.errstate(divide="ignore", invalid="ignore"):
            change = (np.log(middle), np.log(beside)) if logarithmic else (middle, beside)
            S = models.differences.slopes(*change)
        S[~np.isfinite(S).all(axis=1)] = np.nan
        C = S @ S.T
        std = np.sqrt(np.diag(C))
        unknown |= np.isfinite(middle) & np.isnan(std)
        by = f"by the posterior around {data.attrs['reference']}, to first order"
        if logarithmic:
            out["posterior_failure_log_std"] = (
                (kind.name,),
                std,
                f"standard deviation of ln P {by}",
            )
            out["posterior_failure_log_covariance"] = (both, C, f"covariance of ln P {by}")
            out[f"posterior_{variable}_std"] = (
                (kind.name,),
                lognormal_std(middle, std),
                "standard deviation of failure_probability that follows where ln P is Gaussian, "
                "of standard deviation s: P sqrt(e^(s^2) (e^(s^2) - 1)), P that of "
                f"{data.attrs['reference']}",
            )
        else:
            out[f"posterior_{variable}_std"] = (
                (kind.name,),
                std,
                f"standard deviation of {variable} {by}",
            )
            out[f"posterior_{variable}_covariance"] = (both, C, f"covariance of {variable} {by}")
    said = [
        f"no posterior standard deviation of {name}: models within one of "
        f"{data.attrs['reference']} cannot be solved, or have no such peak, or no failures"
        for name in data[kind.name].values[unknown]
    ]
    return out, said


def _of_draws(
    data: xr.Dataset,
    asking: Asking,
    models: Around,
    predictions: Sequence[Prediction],
    kind: _Kind,
) -> tuple[Variables, list[str]]:
    """Return what models drawn from the posterior predict, one by one and summed up."""
    n = len(models.drawn)
    if not n:
        return {}, []
    values, failed = _answers(asking, predictions, models.drawn, "draw")
    out: Variables = {}
    for variable, name in kind.variables.items():
        out[f"draw_{variable}"] = (
            ("draw", kind.name),
            values[name],
            f"{variable} of each model drawn from the posterior; NaN where there is none",
        )
        out[f"posterior_{variable}"] = (
            ("statistic", kind.name),
            summary(values[name]),
            f"{variable} over the models drawn from the posterior"
            + ("; its mean is the robust failure probability" if kind is FAILURE else ""),
        )
    said = [
        f"{count} of {n} models drawn from the posterior cannot be solved for {name}: they are "
        "left out"
        for name, count in failed.items()
        if count
    ]
    first = next(iter(kind.variables.values()))
    missing = np.isnan(values[first]).sum(axis=0)
    missing[np.isnan(data[next(iter(kind.variables))].values[_reference(data)])] = 0
    missing -= np.repeat(
        [failed[one.name] for one in predictions], [len(x.places) for x in predictions]
    )
    said += [
        f"{count} of {n} models drawn from the posterior have no peak for {name}: they are left out"
        for name, count in zip(data[kind.name].values, missing, strict=True)
        if count > 0
    ]
    return out, said
