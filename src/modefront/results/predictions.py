"""Predictions of all models of a study, as values of results."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain

import numpy as np
import xarray as xr

from modefront._typing import Bools, Floats
from modefront.front.point import preferred
from modefront.optim.lexicographic import RANK
from modefront.predictions import Prediction, PredictionKind
from modefront.predictions.ranges import Sampled
from modefront.predictions.registry import ATTRIBUTE, as_text
from modefront.predictions.runner import PredictionRunner
from modefront.results.analysis import ALL, Values
from modefront.results.schema import described

RANGE = ("minimum", "maximum", "spread")
"""Over the Pareto-optimal models and all that are equivalent; the spread is greatest over least."""


def extent(predictions: Sequence[Prediction], models: int) -> dict[str, int]:
    """Return the expected number of tasks of the predictions of so many models, and of ranges."""
    return {"predict": sum(models + 1 + (each.kind.check is not None) for each in predictions)}


def by_kind(
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
    for kind, predictions in by_kind(runner.predictions):
        rows = [runner.at_points(each, points) for each in predictions]
        ends = [
            runner.extremes(each, front, _by_key(row, optimal))
            for each, row in zip(predictions, rows, strict=True)
        ]
        values |= _of_points(kind, rows, optimal, ends)
        for setting in kind.settings:
            every = (prediction.settings[setting.name] for prediction in predictions)
            values[setting.name] = list(chain.from_iterable(every))
        for name in ("name", "heading"):
            every = ([getattr(each, name)] * len(each.places) for each in predictions)
            values[f"{kind.dimension}_{name}"] = list(chain.from_iterable(every))
        if kind.check:
            checks = [runner.checked(each, *reference) for each in predictions]
            for variable in kind.check.variables:
                values[variable.name] = np.concatenate([x[variable.key] for x in checks])
            places = sum(len(prediction.places) for prediction in predictions)
            values[kind.check.label.name] = [reference[0]] * places
        coordinates[kind.dimension] = list(chain.from_iterable(x.places for x in predictions))
    kinds = [kind for kind, _ in by_kind(runner.predictions)]
    out = data.assign(described(values, kinds)).assign_coords(coordinates)
    return out.assign_attrs({ATTRIBUTE: as_text(kinds)})


def _by_key(rows: Sequence[Mapping[str, Floats]], optimal: Bools) -> dict[str, Floats]:
    kept = [row for row, is_kept in zip(rows, optimal, strict=True) if is_kept]
    return {key: np.array([row[key] for row in kept]) for key in rows[0]}


def _leaves_open(data: xr.Dataset) -> bool:
    together = ALL if data.sizes["group"] > 1 else data["group"].values[0]
    of = data["combination_of"].values == together
    here = of & (data["combination_at"].values == preferred(data.attrs))
    idle = np.diag(data["collinearity"].values) == 0
    return bool(idle.any() or (data["combination_share"].values[here] <= RANK).any())


def _of_points(
    kind: PredictionKind,
    rows: Sequence[Sequence[Mapping[str, Floats]]],
    optimal: Bools,
    ends: Sequence[Mapping[str, Floats]],
) -> Values:
    """Return the values at all points, (points, places), and their ranges over the optimal ones.

    ``ends`` (2, places) are those between these, and over all models that are equivalent.
    """
    out: Values = {}
    for variable in kind.variables:
        values = np.hstack([np.array([x[variable.key] for x in each]) for each in rows])
        out[variable.name] = values
        if variable.ranged:
            more = np.hstack([x[variable.key] for x in ends])
            known = np.append(optimal, np.ones(len(more), dtype=np.bool_))
            out[f"{variable.name}_range"] = _range(np.vstack([values, more]), known)
    return out


def _range(values: Floats, optimal: Bools) -> Floats:
    """Return least, greatest and their ratio over the optimal rows, (3, columns); NaN for none."""
    known = optimal[:, None] & np.isfinite(values)
    least = np.where(known, values, np.inf).min(axis=0)
    greatest = np.where(known, values, -np.inf).max(axis=0)
    none = ~known.any(axis=0)
    least[none] = greatest[none] = np.nan
    ratio = np.divide(greatest, least, out=np.full(least.shape, np.nan), where=least > 0)
    return np.array([least, greatest, ratio])
