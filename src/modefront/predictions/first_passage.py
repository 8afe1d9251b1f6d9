"""The probability that any of several responses to random excitation leaves [-b, b]."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, ClassVar, Literal, Self

import numpy as np
from numpy.random import SeedSequence

from modefront import options as opt
from modefront._typing import Arrays, Floats
from modefront.data.modal import ModalData
from modefront.errors import Fault, refuse, wrong
from modefront.models.base import Model
from modefront.predictions import reliability
from modefront.predictions import system as modal
from modefront.predictions.base import NumericalCheck, PredictionKind, ResultVariable, Setting
from modefront.residuals.problem import UpdatingProblem
from modefront.rounding import ACCUMULATED, WRITTEN

STEPS_A_PERIOD = 20  # time steps in the shortest period, where the step is not given
MOST_STEPS = 10**6  # time steps at most: convolutions of more fill the memory

LEVELS = opt.numbers("a list of different levels above 0", opt.array(opt.ABOVE_ZERO, 1, once=True))

MODULATION = opt.Requirement(
    "a list of [time in s, factor], times rising from 0 or more, one factor not zero",
    {
        **opt.array(opt.array([opt.NOT_NEGATIVE, opt.NUMBER], 2, 2), 1),
        "contains": {"items": [{}, {"not": {"const": 0}}]},
    },
    lambda value: tuple((float(t), float(q)) for t, q in value),
    lambda value: opt.rising([t for t, _ in value]) and any(factor for _, factor in value),
)


@dataclass(frozen=True)
class SoilFilter(opt.Checked):
    """A filter of white noise by a layer of soil, after Kanai and Tajimi.

    Raises InputError for values that are not possible.

    Attributes
    ----------
    frequency : of the soil in Hz, above 0
    damping : damping ratio of the soil, above 0
    """

    frequency: Annotated[float, opt.number("a frequency of the soil above 0 Hz", above=0)]
    damping: Annotated[float, opt.number("a damping ratio of the soil above 0", above=0)]

    @property
    def omega(self) -> float:
        """Circular frequency of the soil in rad/s."""
        return 2 * math.pi * self.frequency


FILTER = opt.nested("a table { frequency, damping }, a Kanai-Tajimi filter", SoilFilter)


# 15 fields: the keys of a table of a study file.
@dataclass(frozen=True)
class Passage(modal.ModalPrediction):
    """First-passage probabilities at several levels.

    Raises InputError for values that are not possible, alone or together.

    Attributes
    ----------
    name : name of the prediction
    response : a sensor or output, a list of them, or weighted sums of them by their names; failure
        is that any of these leaves [-b, b]
    density : spectral density of the white noise at every input, (unit of load)²/(rad/s)
    sided : ``"one"`` or ``"two"``: whether the density is for frequencies above 0 only
    levels : barriers b, above 0, in the unit of the responses, the same for all of them
    duration : T in s, above 0
    force : where forces act, each with noise of its own; this or ``base``
    base : direction in which the base accelerates
    step : time step in s, a whole part of the duration and at most a quarter of the shortest
        period; None for a twentieth of it
    filter : filter of the noise, such as that of a soil; None for white noise
    modulation : times in s and factors on the noise, linear between them; None for a constant 1
    samples : number of samples for each model, 2 at least
    method : ``"importance"``, ``"directional"``, ``"additive"`` or ``"monte-carlo"``
    modes : number of modes superposed; None for as many as reach 1.5 times the default band's end
    damping : a ratio, a list of ratios, one a mode, or ``"measured"``
    """

    name: modal.Name
    response: modal.Response
    density: Annotated[float, opt.number("a spectral density above 0", above=0)]
    sided: Literal["one", "two"]
    levels: Annotated[Sequence[float], LEVELS]
    duration: Annotated[float, opt.number("a duration above 0 s", above=0)]
    force: modal.Forces | None = None
    base: modal.Base | None = None
    step: Annotated[float, opt.number("a time step above 0 s", above=0)] | None = None
    filter: Annotated[SoilFilter, FILTER] | None = None
    modulation: Annotated[Sequence[tuple[float, float]], MODULATION] | None = None
    samples: Annotated[int, opt.whole(2, 10**8)] = 2000
    method: Annotated[str, opt.one_of(*reliability.METHODS)] = "importance"
    modes: modal.ModeCount | None = None
    damping: modal.Damping = modal.MEASURED

    kind: ClassVar = PredictionKind(
        "first_passage",
        "failure",
        (
            ResultVariable(
                "failure_probability",
                "probability",
                "probability that any response leaves [-level, level] within the duration, at rest "
                "at first",
                symbol="P",
                mean="the robust failure probability",
            ),
            ResultVariable(
                "failure_variation",
                "variation",
                "coefficient of variation of that estimate",
                ranged=False,
            ),
        ),
        (
            Setting("failure_level", "barrier, two-sided"),
            Setting("failure_samples", "samples a model", "count"),
            Setting("failure_method", "method of estimation", "text"),
            Setting("failure_duration", "duration", unit="s"),
            Setting("failure_step", "time step", unit="s"),
            Setting(
                "failure_density", "spectral density of the white noise, (unit of load)^2/(rad/s)"
            ),
            Setting("failure_sided", "whether that density is one- or two-sided", "text"),
            Setting("failure_load", "load case", "text"),
            Setting("failure_damping", "damping ratios", "text"),
            Setting("failure_modes", "modes superposed", "count"),
        ),
        absent="have no probability",
        undefined="have no failures",
        check=NumericalCheck(
            "half-step",
            (
                ResultVariable(
                    "failure_halved",
                    "ratio",
                    "probability with half the time step over that with the step given",
                ),
                ResultVariable("failure_halved_error", "error", "standard error of that ratio"),
            ),
            ResultVariable("failure_halved_at", "label", "label of the model of that ratio"),
        ),
    )

    def contradictions(self) -> Iterator[Fault]:
        """Yield options that contradict one another."""
        yield from super().contradictions()
        steps = 1.0 if self.step is None else self.duration / self.step
        if steps > MOST_STEPS:
            yield Fault("", "step", f"at most {MOST_STEPS} time steps", f"{steps:.6g}")
        elif steps < 0.5 or abs(steps - round(steps)) > WRITTEN:
            expected = f"a whole number of steps of {self.step:g} s in {self.duration:g} s"
            yield Fault("", "step", expected, f"{steps:.6g} of them")

    @property
    def places(self) -> tuple[str, ...]:
        """Name of the prediction and level, for each of these."""
        return tuple(f"{self.name}: {level:.12g}" for level in self.levels)

    @property
    def heading(self) -> str:
        """Name, load case and options in a sentence."""
        return (
            f"{self.name}: {self.load}; probability that any response leaves [-level, level] "
            f"(two-sided barrier) within {self.duration:g} s, at rest at first; "
            f"{self.sided}-sided spectral density {self.density:g}, time step "
            f"{modal.filled(self.step, 'step'):g} s, {self.samples} samples ({self.method}), "
            f"{self.modes} modes, damping {self.damped}"
        )

    @property
    def settings(self) -> Mapping[str, Sequence[object]]:
        """Values of the kind's settings, one a place, by the name of the variable."""
        sided = [f"{self.sided}-sided"] * len(self.levels)
        return {**super().settings, "failure_level": list(self.levels), "failure_sided": sided}

    def faults(self, model: Model, data: ModalData) -> Iterator[Fault]:
        """Yield the requirements that the model or the data do not meet."""
        yield from super().faults(model, data)
        number_known = self.modes is not None or isinstance(self.damping, tuple)
        if modal.highest_frequency(data) is None and not number_known:
            yield Fault("", "modes", "how many modes, as no frequency was measured", "nothing")

    def complete(self, problem: UpdatingProblem) -> Self:
        """Return the prediction with modes and time step that follow from the nominal model.

        Raises InputError with what this model cannot predict.
        """
        refuse(self.faults(problem.model, problem.data))
        top = modal.ABOVE * (modal.highest_frequency(problem.data) or 0.0)
        out = replace(self, modes=self.complete_modes(problem, top))
        return replace(out, step=out._step(out.nominal(problem)))

    def _step(self, system: modal.ModalSystem) -> float:
        """Return the time step; raise InputError where it is too long, or there are too many."""
        soil = 0.0 if self.filter is None else self.filter.omega
        highest = max(float(system.omega.max()), soil, np.finfo(float).tiny)
        if self.step is not None:
            limit = reliability.LARGEST_ANGLE / highest
            if self.step > limit * (1 + ACCUMULATED):
                period = f"a quarter of the shortest period ({highest / (2 * np.pi):.4g} Hz)"
                expected = f"at most {limit:.4g} s, {period}"
                raise wrong("step", expected, f"{self.step:g}")
            return self.step
        steps = math.ceil(self.duration * highest / (2 * np.pi) * STEPS_A_PERIOD)
        if steps > MOST_STEPS:
            raise wrong("step", f"at most {MOST_STEPS} time steps", steps)
        return self.duration / steps

    def problem(self, problem: UpdatingProblem, theta: Floats) -> reliability.FirstPassage:
        """Return the problem at ``theta``; raise InputError where the step is too long there."""
        modal.filled(self.step, "step")
        system, soil = self.system(problem, theta), self.filter
        times, factors = zip(*self.modulation or [(0.0, 1.0)], strict=True)
        return reliability.FirstPassage(
            system,
            2 * np.pi * (self.density if self.sided == "two" else self.density / 2),
            self.duration,
            self._step(system),
            None if soil is None else (soil.omega, soil.damping),
            (lambda t: np.interp(t, times, factors)) if self.modulation else None,
        )

    def evaluate(self, problem: UpdatingProblem, theta: Floats, seed: SeedSequence) -> Arrays:
        """Return the probability at each level and its coefficient of variation, (levels,).

        Raises ModelError where the model cannot be evaluated at ``theta``, InputError where the
        time step is too long there.
        """
        asked = self.problem(problem, theta), np.array(self.levels), self.samples, seed
        P, variation = reliability.estimate(reliability.METHODS[self.method], *asked)
        return {"probability": P, "variation": variation}

    def check(self, problem: UpdatingProblem, theta: Floats, seed: SeedSequence) -> Arrays:
        """Return P with half the time step over P, and its standard error, (levels,)."""
        asked = self.problem(problem, theta), np.array(self.levels), self.samples, seed
        ratio, error = reliability.step_effect(reliability.METHODS[self.method], *asked)
        return {"ratio": ratio, "error": error}
