"""The greatest peak of a frequency response function within a band."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, ClassVar, Self

import numpy as np

from modefront._typing import Floats
from modefront.data.modal import ModalData
from modefront.errors import Fault, refuse
from modefront.json_schema import NOT_NEGATIVE, array
from modefront.models.base import Model
from modefront.options import TRUE_OR_FALSE, check_fields, numbers, one_of, rising
from modefront.predictions.base import PredictionKind, ResultVariable, Setting
from modefront.predictions.load_model import (
    ABOVE,
    EITHER,
    MEASURED,
    Base,
    Damping,
    Force,
    ModalLoadModel,
    ModeCount,
    Name,
    Response,
    complete_modes,
    contradictions,
    filled,
    highest_frequency,
    load_case_of,
    load_faults,
    modes_reaching,
    nominal_system,
)
from modefront.residuals.problem import UpdatingProblem
from modefront.response.function import ORDERS, peaks

BAND = numbers(
    "[lowest, highest] frequency in Hz, 0 <= lowest < highest",
    array(NOT_NEGATIVE, 2, 2),
    rising,
)


@dataclass(frozen=True)
class PeakResponse:
    """Peaks of the frequency response of several outputs to one input.

    Raises InputError for values that are not possible, alone or together.

    Attributes
    ----------
    name : name of the prediction
    response : a sensor or output, a list of them, or weighted sums of them by their names
    force : where a force acts: a sensor or output, or weights of them; this or ``base``
    base : direction in which the base accelerates
    quantity : response over load: ``"receptance"``, ``"mobility"``, ``"accelerance"`` or, with a
        base that moves, ``"absolute accelerance"``
    band : lowest and highest frequency in Hz; None for up to 1.1 times the highest measured one
    static : whether the static response of the modes left out is added
    modes : number of modes superposed; None for as many as reach 1.5 times the end of the band
    damping : a ratio, a list of ratios, one a mode, or ``"measured"``
    """

    name: Name
    response: Response
    force: Force | None = None
    base: Base | None = None
    quantity: Annotated[str, one_of(*ORDERS)] = "receptance"
    band: Annotated[tuple[float, float], BAND] | None = None
    static: Annotated[bool, TRUE_OR_FALSE] = True
    modes: ModeCount | None = None
    damping: Damping = MEASURED

    either: ClassVar = EITHER
    kind: ClassVar = PredictionKind(
        "frf",
        "frf",
        (
            ResultVariable("frf_peak", "peak", "greatest peak of |T| in the band"),
            ResultVariable("frf_peak_frequency", "frequency", "frequency of that peak", "Hz"),
        ),
        (
            Setting("frf_quantity", "response over load", "text"),
            Setting("frf_band", "band in which peaks are sought", unit="Hz", dimensions=("bound",)),
            Setting("frf_load", "load case", "text"),
            Setting("frf_damping", "damping ratios", "text"),
            Setting("frf_modes", "modes superposed", "count"),
        ),
        absent="have no peak",
        undefined="have no such peak",
    )

    def __post_init__(self) -> None:
        check_fields(self)
        faults = list(contradictions(self.loads))
        if self.quantity == "absolute accelerance" and self.base is None:
            faults.append(
                Fault("", "quantity", "another one where forces act", f"'{self.quantity}'")
            )
        refuse(faults)

    @property
    def loads(self) -> ModalLoadModel:
        """Load case, outputs, modes and damping."""
        forces = () if self.force is None else (self.force,)
        load_case = load_case_of(self.response, forces, self.base)
        return ModalLoadModel(load_case, self.modes, self.damping, self.static)

    @property
    def places(self) -> tuple[str, ...]:
        """Name of the prediction and of the response, for each of these."""
        return tuple(f"{self.name}: {response}" for response in self.response)

    @property
    def heading(self) -> str:
        """Name, load case and options in a sentence."""
        loads, (low, high) = self.loads, filled(self.band, "band")
        return (
            f"{self.name}: {loads.load}; {self.quantity}, greatest peak from {low:g} to {high:g} "
            f"Hz, {self.modes} modes, damping {loads.damped}"
        )

    @property
    def settings(self) -> Mapping[str, Sequence[object]]:
        """Values of the kind's settings, one a place, by the name of the variable."""
        loads = self.loads
        values = {
            "frf_quantity": self.quantity,
            "frf_band": self.band,
            "frf_load": loads.load,
            "frf_damping": loads.damped,
            "frf_modes": self.modes,
        }
        return {name: [value] * len(self.response) for name, value in values.items()}

    def faults(self, model: Model, data: ModalData) -> Iterator[Fault]:
        """Yield the requirements that the model or the data do not meet."""
        yield from load_faults(self.loads, model, data)
        if self.band is None and highest_frequency(data) is None:
            yield Fault("", "band", BAND.expected, "nothing")

    def complete(self, problem: UpdatingProblem) -> Self:
        """Return the prediction with band and modes that follow from data and nominal model.

        Raises InputError with what this model cannot predict.
        """
        refuse(self.faults(problem.model, problem.data))
        low, top = self.band or (0.0, ABOVE * filled(highest_frequency(problem.data), "band"))
        out = replace(self, band=(low, top), modes=complete_modes(self.loads, problem, top))
        omega, faults = nominal_system(out.loads, problem).omega, []
        last, count = float(omega[-1]) / (2 * math.pi), omega.size
        if (
            last < top
            and (more := modes_reaching(problem.model, problem.start, top, count)) > count
        ):
            expected = f"modes that reach the end of the band, {top:g} Hz: {more}"
            faults.append(Fault("", "modes", expected, f"{count}, up to {last:.4g} Hz"))
        if omega[0] == 0 and self.static:
            expected = "false, as a model with rigid-body modes has no static response"
            faults.append(Fault("", "static", expected, "true"))
        if omega[0] == 0 and low == 0:
            expected = "a lowest frequency above 0, as rigid-body modes have no bounds there"
            faults.append(Fault("", "band", expected, "0"))
        refuse(faults)
        return out

    def evaluate(
        self, problem: UpdatingProblem, theta: Floats, _: np.random.SeedSequence
    ) -> Mapping[str, Floats]:
        """Return the height of the greatest peak and its frequency in Hz, each (responses,).

        NaN where there is no local maximum within the band. Raises ModelError where the model
        cannot be evaluated at ``theta``.
        """
        system = self.loads.system(problem, theta)
        low, high = (2 * np.pi * f for f in filled(self.band, "band"))
        out = np.full((2, len(self.response)), np.nan)
        for o in range(len(self.response)):
            omega, height = peaks(system, self.quantity, o, (low, high))
            if height.size:
                k = int(np.argmax(height))
                out[:, o] = height[k], omega[k] / (2 * np.pi)
        return {"peak": out[0], "frequency": out[1]}

    def check(
        self, _problem: UpdatingProblem, _theta: Floats, _seed: np.random.SeedSequence
    ) -> Mapping[str, Floats]:
        """Return nothing: peaks are exact."""
        return {}
