"""Runs predictions at models, a task for each.

Every model gets the same random numbers (common random numbers), so that predictions differ by the
models alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal, TypeVar

import numpy as np

from modefront._typing import Floats
from modefront.errors import Fault, InputError, ModelError, UnfinishedError
from modefront.models.base import full_of, is_reduced
from modefront.predictions import Prediction, ResultVariable
from modefront.predictions.ranges import Sampled, extreme
from modefront.residuals.problem import UpdatingProblem
from modefront.work.codec import record
from modefront.work.store import hash_text
from modefront.work.task import Executor, Part, Task, seed_sequence
from modefront.work.transfer import is_shared

Arrays = Mapping[str, Floats]

T = TypeVar("T")

STEP, ROUGH = 1e-4, 1e-2
"""Steps of differences of a prediction over the ranges of the parameters: of smooth ones, and of
those that are estimated from samples."""


@record
@dataclass(frozen=True)
class Predicted:
    """A prediction of a model.

    Attributes
    ----------
    values : arrays (places,) by key; NaN where the model cannot be solved
    solved : whether it can
    """

    values: Arrays
    solved: bool = True


@dataclass(frozen=True)
class PredictionRunner:
    """Runs the predictions of a study.

    Attributes
    ----------
    file : of the study, named in messages
    """

    problem: UpdatingProblem
    predictions: Sequence[Prediction]
    seed: int
    work: Executor
    file: Path

    def at_models(
        self,
        prediction: Prediction,
        thetas: Sequence[Floats] | Floats,
        name: str,
        labels: Sequence[str] = (),
        method: Literal["evaluate", "check"] = "evaluate",
    ) -> list[Predicted]:
        """Return a prediction at models (m, p), or the kind's comparison with finer numerics.

        Models with ``labels`` raise InputError where an option does not suit them, and
        UnfinishedError where they have not the modes that are needed; others have NaN then.
        """
        parts: list[tuple[Part, ...]] = [(name, label) for label in labels]
        if not labels:
            marks = (hash_text(f"{theta.tolist()}")[:8] for theta in thetas)
            parts = [(name, i, mark) for i, mark in enumerate(marks, start=1)]
        file = str(self.file) if labels else ""
        return self.work.run(
            [
                self._task(prediction, part, _predicted, (theta, method, file, part[-1]))
                for part, theta in zip(parts, thetas, strict=True)
            ]
        )

    def extremes(self, prediction: Prediction, front: Sampled, values: Arrays) -> dict[str, Floats]:
        """Return least and greatest values over a front, and over all models that are equivalent.

        ``values`` (m, places) are those of its m models by key. The ends have the shape
        (2, places), by the key of each variable of which the range is reported.
        """
        mark = hash_text(f"{front.theta.tolist()} {front.is_open} {front.slack}")[:8]
        ends: list[End] = [
            (variable, i, sign)
            for variable in prediction.kind.ranged
            for sign in (1.0, -1.0)
            for i in range(len(prediction.places))
        ]
        # Ends share what is solved between points; over equivalent models each is work of its own.
        parts = [[end] for end in ends] if front.is_open else [ends]
        tasks = [
            self._task(prediction, ("ends", k + 1, mark), _ends, (front, values, part))
            for k, part in enumerate(parts)
        ]
        found = np.concatenate(self.work.run(tasks))
        shape = (len(prediction.kind.ranged), 2, len(prediction.places))
        keys = (variable.key for variable in prediction.kind.ranged)
        return dict(zip(keys, found.reshape(shape), strict=True))

    def _task(
        self,
        prediction: Prediction,
        part: tuple[Part, ...],
        function: Callable[..., T],
        arguments: tuple[Any, ...],
    ) -> Task[T]:
        """Return a task whose key tells apart all that the prediction depends on."""
        mark = hash_text(f"{prediction!r} {self.seed}")[:8]
        numbers = seed_sequence(self.seed, "predict", prediction.name)
        key = ("predict", prediction.name, *part, mark)
        full = full_of(self.problem.model)
        return Task(
            key,
            function,
            (self.problem, prediction, numbers, *arguments),
            # Responses are those of the full model.
            memory=full.footprint if is_reduced(self.problem.model) and is_shared(full) else 0.0,
        )


# 7 arguments: the problem and the prediction, and the model with its label.
def _predicted(
    problem: UpdatingProblem,
    prediction: Prediction,
    numbers: np.random.SeedSequence,
    theta: Floats,
    method: Literal["evaluate", "check"] = "evaluate",
    file: str = "",
    label: str = "",
) -> Predicted:
    """Return a prediction at a model; without a file, NaN where it cannot be solved."""
    try:
        return Predicted(getattr(prediction, method)(problem, theta, numbers))
    except (InputError, ModelError) as error:
        if not file:
            unknown = np.full(len(prediction.places), np.nan)
            return Predicted({x.key: unknown for x in prediction.kind.variables}, solved=False)
        if isinstance(error, ModelError):
            text = f"no prediction '{prediction.name}' of '{label}': {error}"
            raise UnfinishedError(text) from None
        place = f"[[predict.{prediction.kind.table}]] ({prediction.name!r})"
        raise InputError(
            Fault(file, f"{place} {fault.place}", f"{fault.expected} of '{label}'", fault.found)
            for fault in error.faults
        ) from None


End = tuple[ResultVariable, int, float]
"""A variable at a place, and whether its least (1) or its greatest value (-1) is sought."""


def _ends(
    problem: UpdatingProblem,
    prediction: Prediction,
    numbers: np.random.SeedSequence,
    front: Sampled,
    values: Arrays,
    ends: Sequence[End],
) -> Floats:
    """Return the ends of ranges over a front of which the predictions are known."""
    known: dict[bytes, Arrays] = {}

    def at(theta: Floats) -> Arrays:
        key = theta.tobytes()
        if key not in known:
            known[key] = _predicted(problem, prediction, numbers, theta).values
        return known[key]

    own = replace(front, between={})  # the same work, whatever was done before in this process
    return np.array([_end(problem, own, values, at, end) for end in ends])


def _end(
    problem: UpdatingProblem,
    front: Sampled,
    values: Arrays,
    at: Callable[[Floats], Arrays],
    end: End,
) -> float:
    variable, place, sign = end

    def scaled(values: Arrays) -> Floats:
        own = values[variable.key][..., place]
        if not variable.logarithmic:
            return own
        return np.log(own, out=np.full(own.shape, np.nan), where=own > 0)

    step = ROUGH if variable.logarithmic else STEP
    found = extreme(
        problem, front, scaled(values), lambda theta: float(scaled(at(theta))), sign, step
    )
    return float(np.exp(found)) if variable.logarithmic else found
