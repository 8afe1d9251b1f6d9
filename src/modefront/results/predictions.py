"""Predictions of all models of a study, and their scatter by the posterior, as values of results.

To first order the scatter needs two models along each axis of the posterior; with draws, the models
drawn.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, compress

import numpy as np
import xarray as xr

from modefront._typing import Bools, Floats
from modefront.findings.knowledge import enumeration
from modefront.findings.record import Finding, found, from_text
from modefront.front.point import position, preferred
from modefront.optim.lexicographic import RANK
from modefront.predictions import Prediction, PredictionKind
from modefront.predictions.ranges import Sampled
from modefront.predictions.registry import ATTRIBUTE, as_text, kinds_in
from modefront.predictions.runner import PredictionRunner
from modefront.results.analysis import ALL, Values, left_open
from modefront.results.findings import as_values
from modefront.results.schema import described
from modefront.uncertainty.prediction import (
    SUMMARY,
    Stencil,
    TruncationError,
    draw,
    lognormal_std,
    stencil,
    summary,
)
from modefront.uncertainty.scatter import Posterior
from modefront.work.task import seed_sequence

RANGE = ("minimum", "maximum", "spread")
"""Over the Pareto-optimal models and all that are equivalent; the spread is greatest over least."""


def extent(predictions: Sequence[Prediction], models: int) -> dict[str, int]:
    """Return the expected number of tasks of the predictions of so many models, and of ranges."""
    return {"predict": sum(models + 1 + (each.kind.check is not None) for each in predictions)}


def _by_kind(
    predictions: Sequence[Prediction],
) -> Iterator[tuple[PredictionKind, list[Prediction]]]:
    """Yield the kinds of predictions in their order, each with these."""
    for kind in dict.fromkeys(each.kind for each in predictions):
        yield kind, [each for each in predictions if each.kind == kind]


def with_predictions(data: xr.Dataset, runner: PredictionRunner, slack: float) -> xr.Dataset:
    """Return results with the predictions of every point.

    ``slack`` is the share by which objectives of models may be greater that count in ranges.
    Raises what `PredictionRunner.at_points` raises.
    """
    if not runner.predictions:
        return data
    optimal = data["pareto"].values
    values: Values = {"frequency_range": _range(data["frequency"].values, optimal)}
    coordinates = {"range": list(RANGE)}
    points = list(zip(map(str, data["label"].values), data["theta"].values, strict=True))
    reference = next(point for point in points if point[0] == preferred(data.attrs))
    theta, J = (data[name].values[optimal] for name in ("theta", "objective"))
    front = Sampled(theta, J, slack > 0 or _leaves_open(data), slack)
    kinds = []
    for kind, predictions in _by_kind(runner.predictions):
        rows = [runner.at_points(each, points) for each in predictions]
        best = [list(compress(row, optimal)) for row in rows]
        ends = [
            runner.extremes(each, front, {key: np.array([x[key] for x in row]) for key in row[0]})
            for each, row in zip(predictions, best, strict=True)
        ]
        of_points = _stacked(kind, rows)
        for variable in kind.variables:
            values[variable.name] = of_points[variable.key]
        for variable in kind.ranged:
            # Over the optimal points, and between and beside these over all that are equivalent.
            more = np.hstack([x[variable.key] for x in ends])
            known = np.append(optimal, np.ones(len(more), dtype=np.bool_))
            over = np.vstack([of_points[variable.key], more])
            values[f"{variable.name}_range"] = _range(over, known)
        for setting in kind.settings:
            every = (prediction.settings[setting.name] for prediction in predictions)
            values[setting.name] = list(chain.from_iterable(every))
        for name in ("name", "heading"):
            every = ([getattr(each, name)] * len(each.places) for each in predictions)
            values[f"{kind.dimension}_{name}"] = list(chain.from_iterable(every))
        coordinates[kind.dimension] = list(chain.from_iterable(x.places for x in predictions))
        if kind.check:
            checks = [runner.checked(each, *reference) for each in predictions]
            for variable in kind.check.variables:
                values[variable.name] = np.concatenate([x[variable.key] for x in checks])
            values[kind.check.label.name] = [reference[0]] * len(coordinates[kind.dimension])
        kinds.append(kind)
    out = data.assign(described(values, kinds)).assign_coords(coordinates)
    return out.assign_attrs({ATTRIBUTE: as_text(kinds)})


def _leaves_open(data: xr.Dataset) -> bool:
    together = ALL if data.sizes["group"] > 1 else data["group"].values[0]
    of = data["combination_of"].values == together
    here = of & (data["combination_at"].values == preferred(data.attrs))
    idle = np.diag(data["collinearity"].values) == 0
    return bool(idle.any() or (data["combination_share"].values[here] <= RANK).any())


def _range(values: Floats, optimal: Bools) -> Floats:
    """Return least, greatest and their ratio over the optimal rows, (3, columns); NaN for none."""
    known = optimal[:, None] & np.isfinite(values)
    least = np.where(known, values, np.inf).min(axis=0)
    greatest = np.where(known, values, -np.inf).max(axis=0)
    none = ~known.any(axis=0)
    least[none] = greatest[none] = np.nan
    ratio = np.divide(greatest, least, out=np.full(least.shape, np.nan), where=least > 0)
    return np.array([least, greatest, ratio])


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
    problem, limits = runner.problem, []
    samples = np.empty((0, problem.start.size)) if drawn is None else drawn[:draws]
    if not runner.predictions:
        return PosteriorModels(None, samples[:0], [])
    if posterior is None:
        limits = [found("no-posterior")] if draws and not len(samples) else []
        return PosteriorModels(None, samples, limits)
    theta, best = data["theta"].values[position(data)], preferred(data.attrs)
    names = list(compress(problem.model.parameters, left_open(posterior.free)))
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
    for kind, predictions in _by_kind(runner.predictions):
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
    kind: PredictionKind, rows: Sequence[Sequence[Mapping[str, Floats]]]
) -> dict[str, Floats]:
    """Return values of predictions at models by their keys, each (models, places)."""
    return {
        x.key: np.hstack([np.array([values[x.key] for values in row]) for row in rows])
        for x in kind.variables
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
    rows = [runner.at_models(each, thetas, "axis") for each in predictions]
    values = _stacked(kind, [[x.values for x in row] for row in rows])
    out: Values = {}
    unknown = np.zeros(data.sizes[kind.dimension], dtype=np.bool_)
    for variable in kind.ranged:
        middle = data[variable.name].values[position(data)]
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
    values = _stacked(kind, [[x.values for x in row] for row in rows])
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
    missing[np.isnan(data[first.name].values[position(data)])] = 0
    limits += [
        found("unsolved-draws", str(name), count=int(count), drawn=n, what=kind.absent)
        for name, count in zip(data[kind.dimension].values, missing, strict=True)
        if count > 0
    ]
    return out, limits
