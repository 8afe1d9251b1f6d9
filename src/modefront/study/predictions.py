"""Predictions of all models that a study has found, piece by piece, and as results.

Every model is shaken by the same random numbers, so that what differs is the models' doing.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from modefront._typing import Bools, Floats
from modefront.errors import Fault, InputError, ModelError, UnfinishedError
from modefront.predict import Passage, PeakResponse, Prediction
from modefront.reliability import StepError
from modefront.residuals.problem import UpdatingProblem
from modefront.solvers.advance import default_points
from modefront.study.file import Study
from modefront.study.run import sequence
from modefront.study.store import Arrays, Store, hash_text

RANGE = ("minimum", "maximum", "spread")
"""Over the Pareto-optimal models; the spread is the ratio of greatest to least."""

REPRESENTATIVES = ("optimal-weights", "equal-weights")
"""Labels of the model at which the time step is halved: the first that there is."""

Variables = Mapping[str, tuple[tuple[str, ...], Any, str]]


def pieces_of(study: Study) -> int:
    """Return how many pieces of work the predictions of a study are, at most."""
    n = len(study.problem.objectives)
    points = study.pareto.points or default_points(n)
    front = math.comb(points + n - 2, n - 1) if n > 1 else 0
    models = front + n + len(study.weighted) + 2
    passages = sum(isinstance(one, Passage) for one in study.predictions)
    return len(study.predictions) * models + passages


def predicted(
    data: xr.Dataset,
    problem: UpdatingProblem,
    predictions: Sequence[Prediction],
    seed: int,
    store: Store,
    file: Path = Path("study"),
) -> xr.Dataset:
    """Return results with the predictions of every point; see the page on results.

    Raises InputError, in the name of the study's ``file``, where a time step is too long for a
    model that was found, and UnfinishedError where one has not the modes that are wanted.
    """
    if not predictions:
        return data
    labels = [str(label) for label in data["label"].values]
    work = _Work(problem, labels, data["theta"].values, seed, store, file)
    optimal = data["pareto"].values
    peaks = [(one, work.peak(one)) for one in predictions if isinstance(one, PeakResponse)]
    passages = [(one, *work.passage(one)) for one in predictions if isinstance(one, Passage)]
    variables = {
        "frequency_range": (
            ("range", "mode"),
            _range(data["frequency"].values, optimal),
            "of the frequencies in Hz over the Pareto-optimal models",
        ),
        **(_peak_variables(peaks, optimal) if peaks else {}),
        **(_passage_variables(passages, optimal, labels[work.representative]) if passages else {}),
    }
    coordinates: dict[str, list[str]] = {"range": list(RANGE)}
    if peaks:
        coordinates["frf"] = [f"{one.name}: {x}" for one, _ in peaks for x in one.responses]
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


@dataclass(frozen=True)
class _Work:
    """Asks every model for predictions, a piece of work for each."""

    problem: UpdatingProblem
    labels: Sequence[str]
    theta: Floats
    seed: int
    store: Store
    file: Path

    @property
    def representative(self) -> int:
        """The model at which the time step is halved."""
        return next((self.labels.index(x) for x in REPRESENTATIVES if x in self.labels), 0)

    def peak(self, one: PeakResponse) -> list[Arrays]:
        """Return the peaks of every model."""
        return [self._piece(one, i, one.at) for i in range(len(self.labels))]

    def passage(self, one: Passage) -> tuple[list[Arrays], Arrays]:
        """Return the probabilities of every model, and what half the time step does to one's."""
        numbers = sequence(self.seed, f"predict-{one.name}")
        at = partial(one.at, seed=numbers)
        found = [self._piece(one, i, at) for i in range(len(self.labels))]
        halved = partial(one.halved, seed=numbers)
        return found, self._piece(one, self.representative, halved, "-half-step")

    def _piece(self, one: Prediction, i: int, at: Callable[..., Arrays], what: str = "") -> Arrays:
        """Keep what ``at`` gives of model i; the name tells apart all that it depends on."""
        mark = hash_text(f"{one!r} {self.seed}")[:8]
        name = f"predict-{one.name}{what}-{self.labels[i]}-{mark}"
        return self.store.arrays(name, partial(self._asked, one, i, at))

    def _asked(self, one: Prediction, i: int, at: Callable[..., Arrays]) -> Arrays:
        """Return the prediction of model i, or say that it cannot be had."""
        label = self.labels[i]
        try:
            return at(self.problem, self.theta[i])
        except StepError as error:
            place = f"[[predict.first_passage]] ({one.name!r}) step"
            expected = f"at most {error.limit:.4g} s, a quarter of the shortest period of '{label}'"
            fault = Fault(str(self.file), place, expected, f"{error.found:g}")
            raise InputError(fault) from None
        except ModelError as error:
            raise UnfinishedError(f"no prediction '{one.name}' of '{label}': {error}") from None


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
        return [value(one) for one, _ in peaks for _ in one.responses]

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
        "frf_quantity": (("frf",), each(lambda one: one.quantity.value), "response over load"),
        "frf_band": (
            ("frf", "bound"),
            each(lambda one: list(one.band)),
            "where peaks are looked for, Hz",
        ),
        "frf_load": (("frf",), each(lambda one: one.structure.load), "what loads the structure"),
        "frf_damping": (("frf",), each(lambda one: one.structure.damped), "damping ratios"),
        "frf_modes": (("frf",), each(lambda one: one.structure.modes), "modes superposed"),
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
            each(lambda one: one.noise.density),
            "spectral density of the white noise, (unit of load)^2/(rad/s)",
        ),
        "failure_sided": (
            one_a_level,
            each(lambda one: one.noise.sided.value),
            "whether that density is one- or two-sided",
        ),
        "failure_load": (
            one_a_level,
            each(lambda one: one.structure.load),
            "what loads the structure",
        ),
        "failure_damping": (one_a_level, each(lambda one: one.structure.damped), "damping ratios"),
        "failure_modes": (one_a_level, each(lambda one: one.structure.modes), "modes superposed"),
        "failure_halved": (
            one_a_level,
            halved("ratio"),
            "probability with half the time step over that with the step given",
        ),
        "failure_halved_error": (one_a_level, halved("error"), "standard error of that ratio"),
        "failure_halved_at": (one_a_level, [at] * len(levels), "label of the model of that ratio"),
    }
