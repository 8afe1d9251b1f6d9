"""The probability that any of several responses to random excitation leaves [-b, b]."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from modefront._typing import Floats
from modefront.predict.structure import Structure
from modefront.reliability import METHODS, FirstPassage, KanaiTajimi, WhiteNoise, step_effect
from modefront.residuals.problem import UpdatingProblem

MOST_WORKERS = 8
"""Threads at most; each takes some 100 MB."""


@dataclass(frozen=True)
class Passage:
    """First-passage probabilities at several levels.

    Attributes
    ----------
    name : what the prediction is called
    structure : the model's modes, with force patterns or the motion of the base
    responses : names of the outputs; failure is that any of them leaves [-b, b]
    levels : barriers b
    noise : white noise at every input, independent of one another
    filter : what the noise passes, or None
    modulation : times in s and factors on the noise, linear between them; none for a constant 1
    duration, step : T and time step in s
    samples : how many are drawn
    method : one of `modefront.reliability.METHODS`
    """

    name: str
    structure: Structure
    responses: tuple[str, ...]
    levels: tuple[float, ...]
    noise: WhiteNoise
    filter: KanaiTajimi | None
    modulation: tuple[tuple[float, float], ...]
    duration: float
    step: float
    samples: int
    method: str

    quantities: ClassVar = ("probability", "variation")

    @property
    def size(self) -> int:
        """How many values each of the quantities has."""
        return len(self.levels)

    def problem(self, problem: UpdatingProblem, theta: Floats) -> FirstPassage:
        """Return what the probability is asked of, at ``theta``.

        Raises ValueError where the time step is too long for the highest mode there.
        """
        return FirstPassage(
            self.structure.system(problem, theta),
            self.noise,
            self.duration,
            self.step,
            self.filter,
            self._factors if self.modulation else None,
        )

    def at(
        self, problem: UpdatingProblem, theta: Floats, seed: np.random.SeedSequence
    ) -> Mapping[str, Floats]:
        """Return the probability at each level and its coefficient of variation, (levels,)."""
        found = METHODS[self.method](
            self.problem(problem, theta), self.levels, self.samples, seed, _workers()
        )
        return {
            "probability": np.array([one.probability for one in found]),
            "variation": np.array([one.coefficient_of_variation for one in found]),
        }

    def halved(
        self, problem: UpdatingProblem, theta: Floats, seed: np.random.SeedSequence
    ) -> Mapping[str, Floats]:
        """Return P with half the time step over P, and its standard error, (levels,)."""
        found = step_effect(
            METHODS[self.method],
            self.problem(problem, theta),
            self.levels,
            self.samples,
            seed,
            _workers(),
        )
        return {
            "ratio": np.array([one.ratio for one in found]),
            "error": np.array([one.standard_error for one in found]),
        }

    def _factors(self, t: Floats) -> Floats:
        times, factors = np.array(self.modulation).T
        return np.interp(t, times, factors)


def _workers() -> int:
    """Return the number of threads; how many there are changes no digit, only memory and time."""
    return min(os.cpu_count() or 1, MOST_WORKERS)
