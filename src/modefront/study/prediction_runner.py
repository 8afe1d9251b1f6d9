"""Runs predictions at models, a task for each.

Every model gets the same random numbers (common random numbers), so that predictions differ by the
models alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront.errors import Fault, InputError, ModelError, UnfinishedError
from modefront.predict import Passage, Prediction
from modefront.reliability import StepError
from modefront.residuals.problem import UpdatingProblem
from modefront.work.codec import record
from modefront.work.store import hash_text
from modefront.work.task import Executor, Task, seed_sequence

Arrays = Mapping[str, Floats]


@record
@dataclass(frozen=True)
class Predicted:
    """A prediction of a model.

    Attributes
    ----------
    values : arrays by name; NaN where the model cannot be solved
    solved : whether it can
    """

    values: Arrays
    solved: bool = True


@dataclass(frozen=True)
class PredictionRunner:
    """Runs predictions of a study.

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

        Raises InputError where the time step is too long for one, and UnfinishedError where one
        has not the modes that are needed.
        """
        tasks = [
            self._task(prediction, ("point", name), _at_point, (str(self.file), name, theta))
            for name, theta in points
        ]
        return [result.values for result in self.work.run(tasks)]

    def halved(self, prediction: Passage, name: str, theta: Floats) -> Arrays:
        """Return what half the time step does to the probabilities of a labelled model."""
        arguments = (str(self.file), name, theta, "halved")
        (result,) = self.work.run(
            [self._task(prediction, ("half-step", name), _at_point, arguments)]
        )
        return result.values

    def at_models(self, prediction: Prediction, thetas: Floats, name: str) -> list[Predicted]:
        """Return a prediction at other models (m, p), also where they cannot be solved."""
        tasks = [
            self._task(prediction, (name, i), _at_model, (theta,))
            for i, theta in enumerate(thetas, start=1)
        ]
        return self.work.run(tasks)

    def _task(
        self,
        prediction: Prediction,
        part: tuple[str | int, ...],
        function: Any,
        arguments: tuple[Any, ...],
    ) -> Task[Predicted]:
        """Return a task whose key tells apart all that the prediction depends on."""
        mark = hash_text(f"{prediction!r} {self.seed}")[:8]
        numbers = seed_sequence(self.seed, "predict", prediction.name)
        key = ("predict", prediction.name, *part, mark)
        return Task(key, function, (self.problem, prediction, numbers, *arguments))


def _at_point(
    problem: UpdatingProblem,
    prediction: Prediction,
    numbers: np.random.SeedSequence,
    file: str,
    name: str,
    theta: Floats,
    method: str = "at",
) -> Predicted:
    """Return a prediction at a labelled model."""
    try:
        return Predicted(_evaluated(problem, prediction, numbers, theta, method))
    except StepError as error:
        place = f"[[predict.first_passage]] ({prediction.name!r}) step"
        expected = f"at most {error.limit:.4g} s, a quarter of the shortest period of '{name}'"
        raise InputError(Fault(file, place, expected, f"{error.found:g}")) from None
    except ModelError as error:
        raise UnfinishedError(f"no prediction '{prediction.name}' of '{name}': {error}") from None


def _at_model(
    problem: UpdatingProblem,
    prediction: Prediction,
    numbers: np.random.SeedSequence,
    theta: Floats,
) -> Predicted:
    """Return a prediction at any model; NaN where it cannot be solved."""
    try:
        return Predicted(_evaluated(problem, prediction, numbers, theta, "at"))
    except (StepError, ModelError):
        unknown = np.full(prediction.size, np.nan)
        return Predicted(dict.fromkeys(prediction.quantities, unknown), solved=False)


def _evaluated(
    problem: UpdatingProblem,
    prediction: Prediction,
    numbers: np.random.SeedSequence,
    theta: Floats,
    method: str,
) -> Arrays:
    if isinstance(prediction, Passage):
        return getattr(prediction, method)(problem, theta, seed=numbers)
    return prediction.at(problem, theta)
