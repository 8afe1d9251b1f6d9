"""``[[predict.frf]]`` and ``[[predict.first_passage]]``: what the Pareto models are to predict.

A table is read as far as it goes on its own (`read_predictions`); what depends on the modes of
the nominal model is checked and filled in when there are some (`Draft.complete`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import numpy as np

from modefront._typing import Floats
from modefront.data.modal import ModalData
from modefront.errors import ModelError, suggestion
from modefront.models.base import Model
from modefront.models.ports import Pattern, Ports
from modefront.pairing.match import modes_needed
from modefront.predict import Passage, PeakResponse, Prediction, Structure
from modefront.predict.structure import measured_damping, modes_reaching
from modefront.reliability import METHODS, KanaiTajimi, Sided, WhiteNoise
from modefront.reliability.problem import LARGEST_ANGLE
from modefront.residuals.problem import UpdatingProblem
from modefront.response import ModalSystem, Quantity
from modefront.toml import Table, has_name, is_name, is_number, repeated

ABOVE = 1.1
"""Upper end of the band that is taken where none is given, over the highest measured frequency."""

BEYOND = 1.5
"""What the modes reach where their number is not given, over the upper end of the band."""

STEPS_A_PERIOD = 20
"""Time steps in the shortest period, where the step is not given."""

MOST_STEPS = 10**6

SIDES = {"one": Sided.ONE, "two": Sided.TWO}

NAMED = "the name of a sensor or output, or a table of them with weights that are not zero"


@dataclass(frozen=True)
class Draft:
    """A prediction as its table says it; ``modes`` and ``step`` are None where they are not said.

    ``structure`` has as many modes as are known to be wanted, which is at least one.
    """

    table: Table
    make: Callable[[Structure, float], Prediction]
    structure: Structure
    top: float
    modes: int | None
    low: float = field(default=math.inf)
    duration: float | None = None
    step: float | None = None
    soil: float = 0.0

    def complete(self, problem: UpdatingProblem) -> Prediction | None:
        """Return the prediction, or None where the nominal model shows faults."""
        before = len(self.table.faults)
        model, theta = problem.model, problem.start
        known = modes_needed(problem.pairing, problem.data, model.size)
        count = self.modes or modes_reaching(model, theta, BEYOND * self.top, known)
        structure = replace(self.structure, modes=count)
        try:
            system = structure.system(problem, theta)
        except ModelError as error:
            self.table.fault("modes", "modes that the nominal model has", str(error))
            return None
        self._check(system, problem)
        step = self._step(system)
        return None if len(self.table.faults) > before else self.make(structure, step)

    def _check(self, system: ModalSystem, problem: UpdatingProblem) -> None:
        """Note loads without effect, rigid-body modes in the way and modes that end too early."""
        if not (np.abs(system.output) @ np.abs(system.input)).any():
            self.table.fault("response", "responses that the load can move", "none")
        last = float(system.omega[-1]) / (2 * np.pi)
        if self.duration is None and self.modes is not None and last < self.top:
            more = modes_reaching(problem.model, problem.start, self.top, system.omega.size)
            if more > system.omega.size:
                expected = f"modes that reach the end of the band, {self.top:g} Hz: {more}"
                self.table.fault("modes", expected, f"{system.omega.size}, up to {last:.4g} Hz")
        if system.omega[0] == 0 and self.duration is None:
            if self.structure.static:
                expected = "false, as a model with rigid-body modes has no static response"
                self.table.fault("static", expected, "true")
            if self.low == 0:
                expected = "a lowest frequency above 0, as rigid-body modes have no bounds there"
                self.table.fault("band", expected, "0")

    def _step(self, system: ModalSystem) -> float:
        """Return the time step, and note one that is too long for the nominal model."""
        if self.duration is None:
            return math.nan
        highest = max(float(system.omega.max()), self.soil)
        if self.step is not None:
            limit = LARGEST_ANGLE / highest
            if self.step > limit * (1 + 1e-12):
                expected = (
                    f"at most {limit:.4g} s, a quarter of the shortest period "
                    f"({highest / (2 * np.pi):.4g} Hz)"
                )
                self.table.fault("step", expected, f"{self.step:g}")
            return self.step
        steps = math.ceil(self.duration * highest / (2 * np.pi) * STEPS_A_PERIOD)
        if steps > MOST_STEPS:
            self.table.fault("step", f"at most {MOST_STEPS} time steps", f"{steps}")
        return self.duration / steps


def read_predictions(root: Table, model: Model | None, data: ModalData | None) -> list[Draft]:
    """Return the predictions that a study asks for, as far as its tables alone say."""
    table = root.table("predict", "tables [[predict.frf]] and [[predict.first_passage]]", None)
    if table is None:
        return []
    drafts: list[Draft | None] = []
    named = []
    for key, read in (("frf", _frf), ("first_passage", _first_passage)):
        for one in table.tables(key, required=False):
            drafts.append(_closed(one, read(one, model, data)))
            named.append(one)
    table.close()
    for name in repeated(one.values.get("name") for one in named if has_name(one)):
        table.fault("", "each name once", f"'{name}' twice")
    return [draft for draft in drafts if draft is not None]


def _closed(table: Table, draft: Draft | None) -> Draft | None:
    table.close()
    return draft


def _frf(one: Table, model: Model | None, data: ModalData | None) -> Draft | None:
    before = len(one.faults)
    name = one.text("name", "what the prediction is called") or ""
    ports, responses = _ports(one, model, several=False)
    quantity = Quantity(
        one.choice("quantity", [x.value for x in Quantity], Quantity.RECEPTANCE.value)
    )
    if quantity is Quantity.ABSOLUTE_ACCELERANCE and ports.base is None:
        one.fault("quantity", "another one where forces act", f"'{quantity.value}'")
    top = _highest(data)
    band = one.numbers(
        "band",
        "[lowest, highest] frequency in Hz, 0 <= lowest < highest",
        lambda x: len(x) == 2 and 0 <= x[0] < x[1],
        ... if top is None and data is not None else [0.0, ABOVE * (top or 1.0)],
    )
    static = one.take("static", "true or false", lambda x: isinstance(x, bool), True)
    modes, damping = _modes(one, model, data)
    if len(one.faults) > before or band is None:
        return None
    low, high = band

    def make(structure: Structure, _: float) -> Prediction:
        return PeakResponse(name, structure, responses, quantity, (low, high))

    return Draft(one, make, Structure(ports, 1, damping, static), high, modes, low)


def _first_passage(one: Table, model: Model | None, data: ModalData | None) -> Draft | None:
    before = len(one.faults)
    name = one.text("name", "what the prediction is called") or ""
    ports, responses = _ports(one, model, several=True)
    density = one.number("density", "a spectral density above 0", lambda x: x > 0)
    sided = one.choice("sided", tuple(SIDES))
    levels = one.numbers(
        "levels",
        "a list of different levels above 0",
        lambda x: bool(x) and min(x) > 0 and len(set(x)) == len(x),
    )
    duration = one.number("duration", "a duration above 0 s", lambda x: x > 0)
    step = one.number("step", "a time step above 0 s", lambda x: x > 0, default=None)
    if duration is not None and step is not None:
        _check_steps(one, duration, step)
    samples = one.integer("samples", 2, 10**8, default=2000)
    method = one.choice("method", tuple(METHODS), "importance")
    soil = _filter(one)
    modulation = _modulation(one)
    modes, damping = _modes(one, model, data)
    top = _highest(data)
    if top is None and modes is None and data is not None:
        one.fault("modes", "how many modes, as no frequency was measured", "nothing")
    if len(one.faults) > before:
        return None
    noise = WhiteNoise(density, SIDES[sided])
    wanted = tuple(levels or ())

    def make(structure: Structure, step: float) -> Prediction:
        return Passage(
            *(name, structure, responses, wanted, noise, soil, modulation),
            *(duration, step, samples, method),
        )

    structure = Structure(ports, 1, damping, static=False)
    highest = 0.0 if soil is None else soil.omega
    frequency = ABOVE * (top or 1.0)
    return Draft(one, make, structure, frequency, modes, 0.0, duration, step, highest)


def _highest(data: ModalData | None) -> float | None:
    """Return the highest measured frequency in Hz, None where there is none."""
    known = data.mean_frequency[np.isfinite(data.mean_frequency)] if data else np.zeros(0)
    return float(known.max()) if known.size else None


def _ports(one: Table, model: Model | None, *, several: bool) -> tuple[Ports, tuple[str, ...]]:
    """Return where the load acts and what is looked at, and names of the responses."""
    forces: tuple[Pattern, ...] = ()
    expected = f"{NAMED}{'; or a list of these' * several}"
    force = one.take("force", expected, lambda x: _is_force(x, several), None)
    if force is not None:
        chosen = force if isinstance(force, list) else [force]
        forces = tuple(_pattern(one, "force", value, model) for value in chosen)
    base = one.text("base", "a direction in which the base moves", default=None)
    if base is not None and model is not None and base not in model.directions:
        known = ", ".join(f"'{x}'" for x in model.directions) or "none: the model names no base"
        one.fault("base", f"one of the directions of the base, {known}", f"'{base}'")
    if ("force" in one.values) == ("base" in one.values):
        one.fault("", "either force or base", "both" if "force" in one.values else "neither")
    response = one.take(
        "response",
        f"a list of sensors or outputs, or a table, name = {NAMED}",
        lambda x: is_name(x) or _is_list(x) or _is_table(x),
        ...,
    )
    if isinstance(response, str):
        response = [response]
    places = response if isinstance(response, dict) else {x: x for x in response or ()}
    outputs = tuple(_pattern(one, "response", value, model) for value in places.values())
    return Ports(outputs, forces, base), tuple(places)


def _is_list(value: object) -> bool:
    return (
        isinstance(value, list)
        and bool(value)
        and all(map(is_name, value))
        and len(set(value)) == len(value)
    )


def _is_table(value: object) -> bool:
    return (
        isinstance(value, dict)
        and bool(value)
        and all(is_name(key) and _is_pattern(x) for key, x in value.items())
    )


def _is_pattern(value: object) -> bool:
    return is_name(value) or (
        isinstance(value, dict)
        and bool(value)
        and all(is_number(weight) and weight != 0 for weight in value.values())
    )


def _is_force(value: object, several: bool) -> bool:
    many = several and isinstance(value, list) and bool(value) and all(map(_is_pattern, value))
    return _is_pattern(value) or many


def _pattern(one: Table, key: str, value: Any, model: Model | None) -> Pattern:
    """Return weights by place; unknown places are noted."""
    pattern = {value: 1.0} if isinstance(value, str) else {k: float(w) for k, w in value.items()}
    for name in pattern:
        if model is not None and name not in model.places:
            expected = "the name of a sensor or output of the model"
            one.fault(key, expected, suggestion(name, model.places))
    return pattern


def _modes(
    one: Table, model: Model | None, data: ModalData | None
) -> tuple[int | None, float | tuple[float, ...] | None]:
    """Return how many modes are wanted and their damping; None where it is not said."""
    modes = one.integer("modes", 1, model.size if model else 10**9, default=None)
    damping = one.take(
        "damping",
        "'measured', or a ratio above 0 and below 1, or a list of them, one a mode",
        _is_damping,
        "measured",
    )
    if isinstance(damping, list):
        if modes is None and model is not None and len(damping) > model.size:
            found = f"{len(damping)} of them"
            one.fault("damping", f"at most {model.size} ratios, as the model has modes", found)
        elif modes is not None and len(damping) != modes:
            one.fault("damping", f"a list of {modes}, one a mode", f"{len(damping)} of them")
        return len(damping), tuple(map(float, damping))
    if damping == "measured":
        if data is not None and not np.isfinite(measured_damping(data)).any():
            one.fault("damping", "a ratio, as the data have none", "'measured'")
        elif data is not None and not (_known(data) > 0).all():
            one.fault("damping", "a ratio, as measured ones are 0", "'measured'")
        return modes, None
    return modes, float(damping)


def _known(data: ModalData) -> Floats:
    measured = measured_damping(data)
    known: Floats = measured[np.isfinite(measured)]
    return known


def _is_damping(value: object) -> bool:
    ratios = isinstance(value, list) and bool(value) and all(map(_is_ratio, value))
    return value == "measured" or _is_ratio(value) or ratios


def _is_ratio(value: object) -> bool:
    return isinstance(value, float | int) and is_number(value) and 0 < value < 1


def _check_steps(one: Table, duration: float, step: float) -> None:
    steps = duration / step
    if steps > MOST_STEPS:
        one.fault("step", f"at most {MOST_STEPS} time steps", f"{steps:.6g}")
    elif steps < 0.5 or abs(steps - round(steps)) > 1e-6:
        expected = f"a whole number of steps of {step:g} s in {duration:g} s"
        one.fault("step", expected, f"{steps:.6g} of them")


def _filter(one: Table) -> KanaiTajimi | None:
    table = one.table("filter", "a table { frequency, damping }, a Kanai-Tajimi filter", None)
    if table is None:
        return None
    frequency = table.number("frequency", "a frequency of the soil above 0 Hz", lambda x: x > 0)
    damping = table.number("damping", "a damping ratio of the soil above 0", lambda x: x > 0)
    table.close()
    if frequency is None or damping is None:
        return None
    return KanaiTajimi(2 * math.pi * frequency, damping)


def _modulation(one: Table) -> tuple[tuple[float, float], ...]:
    value = one.take(
        "modulation",
        "a list of [time in s, factor], times rising from 0 or more, one factor not zero",
        _is_modulation,
        [],
    )
    return tuple((float(t), float(q)) for t, q in value)


def _is_modulation(value: object) -> bool:
    return (
        isinstance(value, list)
        and bool(value)
        and all(
            isinstance(x, list) and len(x) == 2 and all(map(is_number, x)) and x[0] >= 0
            for x in value
        )
        and all(a[0] < b[0] for a, b in pairwise(value))
        and any(q != 0 for _, q in value)
    )


def complete(drafts: Sequence[Draft], problem: UpdatingProblem) -> tuple[Prediction, ...]:
    """Return the predictions, without those of which the nominal model shows faults."""
    made = [draft.complete(problem) for draft in drafts]
    return tuple(one for one in made if one is not None)
