"""The greatest peak of a frequency response function within a band."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from modefront._typing import Floats
from modefront.predict.structure import Structure
from modefront.residuals.problem import UpdatingProblem
from modefront.response import Quantity, peaks


@dataclass(frozen=True)
class PeakResponse:
    """Peaks of the frequency response of several outputs to one input.

    Attributes
    ----------
    name : what the prediction is called
    structure : the model's modes, with one force pattern or the motion of the base
    responses : names of the outputs
    quantity : what is set against the load
    band : lowest and highest frequency in Hz
    """

    name: str
    structure: Structure
    responses: tuple[str, ...]
    quantity: Quantity
    band: tuple[float, float]

    quantities: ClassVar = ("peak", "frequency")

    @property
    def size(self) -> int:
        """How many values each of the quantities has."""
        return len(self.responses)

    def at(self, problem: UpdatingProblem, theta: Floats) -> Mapping[str, Floats]:
        """Return |T| at the greatest peak and its frequency in Hz, each (responses,).

        NaN where |T| has no local maximum within the band.
        """
        system = self.structure.system(problem, theta)
        low, high = (2 * np.pi * f for f in self.band)
        out = np.full((2, len(self.responses)), np.nan)
        for o in range(len(self.responses)):
            found = peaks(system, self.quantity, output=o, band=(low, high))
            if found:
                greatest = max(found, key=lambda one: one.amplitude)
                out[:, o] = greatest.amplitude, greatest.frequency
        return {"peak": out[0], "frequency": out[1]}
