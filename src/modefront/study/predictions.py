"""Predictions of all models that a study has found, as results."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np
import xarray as xr

from modefront._typing import Bools, Floats
from modefront.predictions import KINDS, Kind, Prediction, ResultVariable
from modefront.solvers.advance import default_points
from modefront.study.asking import Asking
from modefront.study.definition import Study
from modefront.study.knowledge_variables import Variables
from modefront.study.store import Arrays

RANGE = ("minimum", "maximum", "spread")
"""Over the Pareto-optimal models; the spread is the ratio of greatest to least."""

OVER_OPTIMAL = "over the Pareto-optimal models"


def pieces_of(study: Study) -> int:
    """Return how many pieces of work the predictions of a study are, at most."""
    n, p = len(study.problem.objectives), len(study.parameters)
    points = study.pareto.points or default_points(n)
    front = math.comb(points + n - 2, n - 1) if n > 1 else 0
    points = front + n + len(study.weighted) + 2
    return pieces(study.predictions, points + 2 * p + study.uncertainty.draws)


def pieces(predictions: Sequence[Prediction], models: int) -> int:
    """Return how many pieces of work the predictions of so many models are."""
    return sum(models + (prediction.kind.check is not None) for prediction in predictions)


def by_kind(predictions: Sequence[Prediction]) -> Iterator[tuple[Kind, list[Prediction]]]:
    """Yield the kinds of which there are predictions, with these."""
    for kind in (each.kind for each in KINDS):
        if chosen := [prediction for prediction in predictions if prediction.kind is kind]:
            yield kind, chosen


def predicted(data: xr.Dataset, asking: Asking) -> xr.Dataset:
    """Return results with the predictions of every point; see the page on results.

    What is raised is what `Asking.point` raises.
    """
    if not asking.predictions:
        return data
    optimal = data["pareto"].values
    frequency_range = _range(data["frequency"].values, optimal)
    meaning = f"of the frequencies in Hz {OVER_OPTIMAL}"
    variables: Variables = {"frequency_range": (("range", "mode"), frequency_range, meaning)}
    coordinates = {"range": list(RANGE)}
    for kind, predictions in by_kind(asking.predictions):
        predicted = _Predicted.of(data, asking, kind, predictions)
        variables |= predicted.values(optimal) | predicted.settings() | predicted.check()
        places = chain.from_iterable(prediction.places for prediction in predictions)
        coordinates[kind.dimension] = list(places)
    return assigned(data, variables).assign_coords(coordinates)


def assigned(data: xr.Dataset, variables: Variables) -> xr.Dataset:
    """Return results with more variables."""
    return data.assign(
        {
            name: (dimensions, np.asarray(values), {"long_name": meaning})
            for name, (dimensions, values, meaning) in variables.items()
        }
    )


@dataclass(frozen=True)
class _Predicted:
    """What all models predict of one kind.

    Attributes
    ----------
    at_points : evaluations of each prediction, one a point
    at_reference : the numerical check of each prediction; none where the kind has none
    reference : label of the model of this check
    """

    kind: Kind
    predictions: Sequence[Prediction]
    at_points: Sequence[Sequence[Arrays]]
    at_reference: Sequence[Arrays]
    reference: str

    @classmethod
    def of(
        cls, data: xr.Dataset, asking: Asking, kind: Kind, predictions: Sequence[Prediction]
    ) -> _Predicted:
        """Return the predictions of all points of results."""
        models = list(zip(map(str, data["label"].values), data["theta"].values, strict=True))
        reference = str(data.attrs["reference"])
        theta = dict(reversed(models))[reference]
        at_points = [[asking.point(each, *model) for model in models] for each in predictions]
        checked = predictions if kind.check else ()
        at_reference = [asking.checked(each, reference, theta) for each in checked]
        return cls(kind, predictions, at_points, at_reference, reference)

    def values(self, optimal: Bools) -> Variables:
        """Return the values of all points, and their ranges over the optimal ones."""
        out: Variables = {}
        dimension = self.kind.dimension
        for variable in self.kind.variables:
            values = self._stacked(variable)
            out[variable.name] = (("point", dimension), values, variable.long_name)
            if variable.ranged:
                meaning = f"of {variable.name} {OVER_OPTIMAL}"
                ranges = _range(values, optimal)
                out[f"{variable.name}_range"] = (("range", dimension), ranges, meaning)
        return out

    def _stacked(self, variable: ResultVariable) -> Floats:
        """Return the values of a variable, (points, places)."""
        return np.hstack([np.array([x[variable.key] for x in rows]) for rows in self.at_points])

    def settings(self) -> Variables:
        """Return what was asked for."""
        every = [prediction.settings for prediction in self.predictions]
        return {
            name: (
                (self.kind.dimension, *first.dimensions),
                [value for settings in every for value in settings[name].values],
                first.meaning,
            )
            for name, first in every[0].items()
        }

    def check(self) -> Variables:
        """Return what the numerical check found."""
        check, dimension = self.kind.check, (self.kind.dimension,)
        if check is None:
            return {}
        out: Variables = {
            variable.name: (
                dimension,
                np.concatenate([arrays[variable.key] for arrays in self.at_reference]),
                variable.long_name,
            )
            for variable in check.variables
        }
        count = sum(len(prediction.places) for prediction in self.predictions)
        return out | {check.label: (dimension, [self.reference] * count, check.label_meaning)}


def _range(values: Floats, optimal: Bools) -> Floats:
    """Return least, greatest and their ratio over the optimal rows, (3, columns); NaN for none."""
    known = optimal[:, None] & np.isfinite(values)
    least = np.where(known, values, np.inf).min(axis=0)
    greatest = np.where(known, values, -np.inf).max(axis=0)
    none = ~known.any(axis=0)
    least[none] = greatest[none] = np.nan
    ratio = np.divide(greatest, least, out=np.full(least.shape, np.nan), where=least > 0)
    return np.array([least, greatest, ratio])
