"""Asks models for predictions, a piece of work for each answer.

Every model is shaken by the same random numbers, so that what differs is the models' doing.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from modefront._typing import Floats
from modefront.errors import Fault, InputError, ModelError, UnfinishedError
from modefront.predictions import Prediction
from modefront.residuals.problem import UpdatingProblem
from modefront.study.run import sequence
from modefront.study.store import Arrays, Store, hash_text

FAILED = "failed"
"""Name of the array that is there where a model could not be solved."""


@dataclass(frozen=True)
class Asking:
    """What is asked of models, and where the answers are kept.

    Attributes
    ----------
    file : the study's, for what is said of it
    """

    problem: UpdatingProblem
    predictions: Sequence[Prediction]
    seed: int
    store: Store
    file: Path

    def point(self, one: Prediction, label: str, theta: Floats) -> Arrays:
        """Return the prediction of a model that was found.

        Raises InputError where the time step is too long for it, and UnfinishedError where it has
        not the modes that are wanted.
        """
        return self._piece(one, label, partial(self._found, one, label, one.evaluate, theta))

    def checked(self, one: Prediction, label: str, theta: Floats) -> Arrays:
        """Return the comparison with finer numerics at such a model; empty where there is none."""
        if one.kind.check is None:
            return {}
        check = partial(self._found, one, label, one.check, theta)
        return self._piece(one, label, check, f"-{one.kind.check.piece}")

    def other(self, one: Prediction, label: str, theta: Floats) -> Arrays:
        """Return the prediction of any other model; `FAILED` and NaN where it cannot be had."""
        return self._piece(one, label, partial(self._tried, one, theta), what="-posterior")

    def _numbers(self, one: Prediction) -> np.random.SeedSequence:
        return sequence(self.seed, f"predict-{one.name}")

    def _piece(
        self, one: Prediction, label: str, answer: Callable[[], Arrays], what: str = ""
    ) -> Arrays:
        """Keep an answer; the name tells apart all that it depends on."""
        mark = hash_text(f"{one!r} {self.seed}")[:8]
        return self.store.arrays(f"predict-{one.name}{what}-{label}-{mark}", answer)

    def _found(
        self, one: Prediction, label: str, ask: Callable[..., Arrays], theta: Floats
    ) -> Arrays:
        try:
            return ask(self.problem, theta, self._numbers(one))
        except InputError as error:
            place = f"[[predict.{one.kind.table}]] ({one.name!r})"
            raise InputError(
                Fault(str(self.file), f"{place} {x.place}", f"{x.expected} of '{label}'", x.found)
                for x in error.faults
            ) from None
        except ModelError as error:
            raise UnfinishedError(f"no prediction '{one.name}' of '{label}': {error}") from None

    def _tried(self, one: Prediction, theta: Floats) -> Arrays:
        try:
            return one.evaluate(self.problem, theta, self._numbers(one))
        except (InputError, ModelError):
            none = np.full(len(one.places), np.nan)
            return {**{x.key: none for x in one.kind.variables}, FAILED: np.ones(1)}
