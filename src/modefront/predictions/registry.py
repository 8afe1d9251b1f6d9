"""Classes of predictions that study files may name, and those that results hold."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, is_dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from modefront._typing import Floats
from modefront.errors import Fault, InputError, refuse
from modefront.families import Family
from modefront.options import each_once
from modefront.predictions.base import (
    NumericalCheck,
    Prediction,
    PredictionKind,
    ResultVariable,
    Setting,
)
from modefront.text import NAME, clean

if TYPE_CHECKING:
    import xarray as xr

ATTRIBUTE = "prediction_kinds"
"""Attribute of results that holds the kinds of their predictions, in JSON."""


def _faults(prediction: Any) -> Iterator[Fault]:
    place = f"prediction class {getattr(prediction, '__qualname__', prediction)!s}"
    if not (isinstance(prediction, type) and is_dataclass(prediction)):
        yield Fault("", place, "a frozen dataclass", clean(repr(prediction), NAME))
        return
    kind = getattr(prediction, "kind", None)
    if not isinstance(kind, PredictionKind):
        yield Fault("", place, "an attribute kind, a PredictionKind", clean(repr(kind), NAME))
        return
    methods = ("places", "heading", "settings", "faults", "complete", "evaluate", "check")
    missing = [name for name in methods if not hasattr(prediction, name)]
    if "name" not in prediction.__dataclass_fields__:
        missing.append("name")
    if missing:
        yield Fault("", place, "what modefront.Prediction has", f"no {', '.join(missing)}")
    other: Any = CLASSES.added.get(kind.table)
    names = [(x.__module__, x.__qualname__) for x in (other or prediction, prediction)]
    if names[0] != names[1]:
        yield Fault("", place, "a table of its own", f"'{kind.table}', of {other.__qualname__}")


CLASSES: Family[type[Prediction]] = Family(
    "modefront.predictions",
    "a class of predictions",
    lambda each: isinstance(each, type),
    lambda each: each.kind.table,
    faults=_faults,
)
"""Classes of predictions by the names of their tables in study files."""


def as_text(kinds: Iterable[PredictionKind]) -> str:
    """Return kinds in JSON."""
    return json.dumps([asdict(kind) for kind in kinds])


@cache
def kinds_from(text: str) -> tuple[PredictionKind, ...]:
    """Return kinds from JSON; raises ValueError for what `as_text` does not make."""
    try:
        kinds = tuple(_kind(**values) for values in json.loads(text)) if text else ()
        refuse(each_once("dimension", [kind.dimension for kind in kinds]))
    except (TypeError, KeyError, RecursionError, InputError) as error:
        raise ValueError(clean(str(error), NAME)) from None
    return kinds


def _kind(variables: Any, settings: Any, check: Any, **values: Any) -> PredictionKind:
    if check is not None:
        compared = tuple(ResultVariable(**each) for each in check["variables"])
        check = NumericalCheck(check["name"], compared, ResultVariable(**check["label"]))
    return PredictionKind(
        variables=tuple(ResultVariable(**each) for each in variables),
        settings=tuple(Setting(**each) for each in settings),
        check=check,
        **values,
    )


def kinds_in(data: xr.Dataset) -> tuple[PredictionKind, ...]:
    """Return the kinds of which sound results have predictions."""
    return kinds_from(str(data.attrs.get(ATTRIBUTE, "")))


@dataclass(frozen=True)
class Quantity:
    """A number that models predict, as results hold it: one variable at one place.

    Attributes
    ----------
    variable : what it is
    place : where, without the name of the prediction
    label : of the place, with that name
    values : (points,) of all models
    extent : least, greatest and their ratio over the Pareto-optimal models; NaN for none
    std : standard deviation by the posterior, of the logarithm where that is linearised, as a
        factor then; None where it is not known to the results
    drawn : statistics over the models drawn from the posterior, by name; none without draws
    """

    variable: ResultVariable
    place: str
    label: str
    values: Floats
    extent: Floats
    std: float | None
    drawn: Mapping[str, float]


def quantity(
    data: xr.Dataset, variable: ResultVariable, i: int, of: str = "", log_std: str = ""
) -> Quantity:
    """Return the quantity that is the i-th column of a variable of results.

    ``of`` is the name of its prediction, ``log_std`` names the variable with the standard deviation
    of its logarithm.
    """
    name, values = variable.name, data[variable.name]
    label = str(values[values.dims[1]].values[i])
    extent, std, drawn = np.full(3, np.nan), None, {}
    if variable.ranged:
        extent = data[f"{name}_range"].values[:, i]
        if (deviations := data.get(log_std or f"posterior_{name}_std")) is not None:
            std = float(deviations.values[i])
        if (statistics := data.get(f"posterior_{name}")) is not None:
            of_draws = zip(statistics["statistic"].values, statistics.values[:, i], strict=True)
            drawn = {str(statistic): float(value) for statistic, value in of_draws}
    place = label.removeprefix(f"{of}: ")
    return Quantity(variable, place, label, values.values[:, i], extent, std, drawn)


@dataclass(frozen=True)
class RecordedPrediction:
    """A prediction in results.

    Attributes
    ----------
    kind : what it is
    name : of the prediction
    heading : its load case and options
    load : its load; empty where the kind has no such setting
    positions : of its values along the dimension of the kind
    places : names of these values, without that of the prediction
    quantities : of each place in turn, one a variable
    """

    kind: PredictionKind
    name: str
    heading: str
    load: str
    positions: tuple[int, ...]
    places: tuple[str, ...]
    quantities: tuple[Quantity, ...]


def predictions_in(data: xr.Dataset) -> Iterator[RecordedPrediction]:
    """Yield the predictions of sound results."""
    for kind in kinds_in(data):
        start = kind.dimension
        names, load = data[f"{start}_name"].values.tolist(), data.get(f"{start}_load")
        for name in dict.fromkeys(names):
            positions = tuple(i for i, each in enumerate(names) if each == name)
            quantities = tuple(
                quantity(data, x, i, name, f"posterior_{start}_log_std" * x.logarithmic)
                for i in positions
                for x in kind.variables
            )
            yield RecordedPrediction(
                kind,
                str(name),
                str(data[f"{start}_heading"].values[positions[0]]),
                "" if load is None else str(load.values[positions[0]]),
                positions,
                tuple(dict.fromkeys(x.place for x in quantities)),
                quantities,
            )
