"""Predictions of all models that a study has found, as results."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from modefront._typing import Bools, Floats
from modefront.predictions import Passage, PeakResponse, Prediction
from modefront.predictions.first_passage import SIDES
from modefront.solvers.advance import default_points
from modefront.study.asking import Asking
from modefront.study.definition import Study
from modefront.study.store import Arrays

RANGE = ("minimum", "maximum", "spread")
"""Over the Pareto-optimal models; the spread is the ratio of greatest to least."""

Variables = Mapping[str, tuple[tuple[str, ...], Any, str]]


def pieces_of(study: Study) -> int:
    """Return how many pieces of work the predictions of a study are, at most."""
    n, p = len(study.problem.objectives), len(study.parameters)
    points = study.pareto.points or default_points(n)
    front = math.comb(points + n - 2, n - 1) if n > 1 else 0
    points = front + n + len(study.weighted) + 2
    return pieces(study.predictions, points + 2 * p + study.uncertainty.draws)


def pieces(predictions: Sequence[Prediction], models: int) -> int:
    """Return how many pieces of work the predictions of so many models are."""
    return len(predictions) * models + sum(isinstance(one, Passage) for one in predictions)


def predicted(data: xr.Dataset, asking: Asking) -> xr.Dataset:
    """Return results with the predictions of every point; see the page on results.

    What is raised is what `Asking.point` raises.
    """
    predictions = asking.predictions
    if not predictions:
        return data
    models = list(zip(map(str, data["label"].values), data["theta"].values, strict=True))
    labels = [label for label, _ in models]
    halved = labels.index(data.attrs["reference"])  # where the time step is halved
    optimal = data["pareto"].values

    def found(one: Prediction) -> list[Arrays]:
        return [asking.point(one, *model) for model in models]

    peaks = [(one, found(one)) for one in predictions if isinstance(one, PeakResponse)]
    passages = [
        (one, found(one), asking.halved(one, *models[halved]))
        for one in predictions
        if isinstance(one, Passage)
    ]
    variables = {
        "frequency_range": (
            ("range", "mode"),
            _range(data["frequency"].values, optimal),
            "of the frequencies in Hz over the Pareto-optimal models",
        ),
        **(_peak_variables(peaks, optimal) if peaks else {}),
        **(_passage_variables(passages, optimal, labels[halved]) if passages else {}),
    }
    coordinates: dict[str, list[str]] = {"range": list(RANGE)}
    if peaks:
        coordinates["frf"] = [f"{one.name}: {x}" for one, _ in peaks for x in one.response]
    if passages:
        coordinates["failure"] = [
            f"{one.name}: {b:.12g}" for one, *_ in passages for b in one.levels
        ]
    return data.assign(
        {
            name: (dims, np.asarray(values), {"long_name": meaning})
            for name, (dims, values, meaning) in variables.items()
        }
    ).assign_coords(coordinates)


def _range(values: Floats, optimal: Bools) -> Floats:
    """Return least, greatest and their ratio over the optimal rows, (3, columns); NaN for none."""
    known = optimal[:, None] & np.isfinite(values)
    least = np.where(known, values, np.inf).min(axis=0)
    greatest = np.where(known, values, -np.inf).max(axis=0)
    none = ~known.any(axis=0)
    least[none] = greatest[none] = np.nan
    ratio = np.divide(greatest, least, out=np.full(least.shape, np.nan), where=least > 0)
    return np.array([least, greatest, ratio])


def _peak_variables(
    peaks: Sequence[tuple[PeakResponse, list[Arrays]]], optimal: Bools
) -> Variables:
    def of(key: str) -> Floats:
        return np.hstack([np.array([x[key] for x in found]) for _, found in peaks])

    def each(value: Any) -> list[Any]:
        return [value(one) for one, _ in peaks for _ in one.response]

    peak, frequency = of("peak"), of("frequency")
    over = "over the Pareto-optimal models"
    return {
        "frf_peak": (("point", "frf"), peak, "greatest peak of |T| in the band"),
        "frf_peak_frequency": (("point", "frf"), frequency, "frequency of that peak in Hz"),
        "frf_peak_range": (("range", "frf"), _range(peak, optimal), f"of frf_peak {over}"),
        "frf_peak_frequency_range": (
            ("range", "frf"),
            _range(frequency, optimal),
            f"of frf_peak_frequency {over}",
        ),
        "frf_name": (("frf",), each(lambda one: one.name), "name of the prediction"),
        "frf_quantity": (("frf",), each(lambda one: one.quantity), "response over load"),
        "frf_band": (
            ("frf", "bound"),
            each(lambda one: one.band),
            "where peaks are looked for, Hz",
        ),
        "frf_load": (("frf",), each(lambda one: one.loads.load), "what loads the structure"),
        "frf_damping": (("frf",), each(lambda one: one.loads.damped), "damping ratios"),
        "frf_modes": (("frf",), each(lambda one: one.loads.modes), "modes superposed"),
    }


def _passage_variables(
    passages: Sequence[tuple[Passage, list[Arrays], Arrays]], optimal: Bools, at: str
) -> Variables:
    def of(key: str) -> Floats:
        return np.hstack([np.array([x[key] for x in found]) for _, found, _ in passages])

    def each(value: Any) -> list[Any]:
        return [value(one) for one, *_ in passages for _ in one.levels]

    def halved(key: str) -> Floats:
        return np.concatenate([half[key] for *_, half in passages])

    one_a_level = ("failure",)
    probability = of("probability")
    levels = [b for one, *_ in passages for b in one.levels]
    return {
        "failure_probability": (
            ("point", "failure"),
            probability,
            "probability that any response leaves [-level, level] within the duration, at rest "
            "at first",
        ),
        "failure_variation": (
            ("point", "failure"),
            of("variation"),
            "coefficient of variation of that estimate",
        ),
        "failure_probability_range": (
            ("range", "failure"),
            _range(probability, optimal),
            "of failure_probability over the Pareto-optimal models",
        ),
        "failure_name": (one_a_level, each(lambda one: one.name), "name of the prediction"),
        "failure_level": (one_a_level, levels, "barrier, two-sided"),
        "failure_samples": (one_a_level, each(lambda one: one.samples), "samples a model"),
        "failure_method": (one_a_level, each(lambda one: one.method), "method of estimation"),
        "failure_duration": (one_a_level, each(lambda one: one.duration), "duration in s"),
        "failure_step": (one_a_level, each(lambda one: one.step), "time step in s"),
        "failure_density": (
            one_a_level,
            each(lambda one: one.density),
            "spectral density of the white noise, (unit of load)^2/(rad/s)",
        ),
        "failure_sided": (
            one_a_level,
            each(lambda one: SIDES[one.sided].value),
            "whether that density is one- or two-sided",
        ),
        "failure_load": (
            one_a_level,
            each(lambda one: one.loads.load),
            "what loads the structure",
        ),
        "failure_damping": (one_a_level, each(lambda one: one.loads.damped), "damping ratios"),
        "failure_modes": (one_a_level, each(lambda one: one.loads.modes), "modes superposed"),
        "failure_halved": (
            one_a_level,
            halved("ratio"),
            "probability with half the time step over that with the step given",
        ),
        "failure_halved_error": (one_a_level, halved("error"), "standard error of that ratio"),
        "failure_halved_at": (one_a_level, [at] * len(levels), "label of the model of that ratio"),
    }
