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

    def at_points(
        self, prediction: Prediction, points: Sequence[tuple[str, Floats]]
    ) -> list[Arrays]:
        """Return a prediction at labelled models (p,).

        Raises InputError where an option does not suit one of them, and UnfinishedError where one
        has not the modes that are needed.
        """
        file = str(self.file)
        tasks = [
            self._task(prediction, ("point", label), _labelled, (file, label, theta, "evaluate"))
            for label, theta in points
        ]
        return [predicted.values for predicted in self.work.run(tasks)]

    def checked(self, prediction: Prediction, label: str, theta: Floats) -> Arrays:
        """Return the kind's comparison with finer numerics at a labelled model."""
        name = prediction.kind.check.name if prediction.kind.check else ""
        arguments = (str(self.file), label, theta, "check")
        (predicted,) = self.work.run([self._task(prediction, (name, label), _labelled, arguments)])
        return predicted.values

    def at_models(self, prediction: Prediction, thetas: Floats, name: str) -> list[Predicted]:
        """Return a prediction at other models (m, p), also where they cannot be solved."""
        tasks = [
            self._task(
                prediction, (name, i, hash_text(f"{theta.tolist()}")[:8]), _at_model, (theta,)
            )
            for i, theta in enumerate(thetas, start=1)
        ]
        return self.work.run(tasks)

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
def _labelled(
    problem: UpdatingProblem,
    prediction: Prediction,
    numbers: np.random.SeedSequence,
    file: str,
    label: str,
    theta: Floats,
    method: Literal["evaluate", "check"],
) -> Predicted:
    try:
        return Predicted(getattr(prediction, method)(problem, theta, numbers))
    except InputError as error:
        place = f"[[predict.{prediction.kind.table}]] ({prediction.name!r})"
        raise InputError(
            Fault(file, f"{place} {fault.place}", f"{fault.expected} of '{label}'", fault.found)
            for fault in error.faults
        ) from None
    except ModelError as error:
        raise UnfinishedError(f"no prediction '{prediction.name}' of '{label}': {error}") from None


def _at_model(
    problem: UpdatingProblem,
    prediction: Prediction,
    numbers: np.random.SeedSequence,
    theta: Floats,
) -> Predicted:
    """Return a prediction at any model; NaN where it cannot be solved."""
    try:
        return Predicted(prediction.evaluate(problem, theta, numbers))
    except (InputError, ModelError):
        unknown = np.full(len(prediction.places), np.nan)
        values = {variable.key: unknown for variable in prediction.kind.variables}
        return Predicted(values, solved=False)


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
            known[key] = _at_model(problem, prediction, numbers, theta).values
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
