"""A model in its lowest modes between loads and responses, with classical damping.

The modal equations are in docs/methods/first-passage.md. Loads and responses are sums of sensors
and other outputs of the model, by their names.

Where damping is that of the measurements, a model mode has the mean damping ratio, over the data
sets, of the measured mode that is paired with it; modes without a partner, or whose partner's
damping was not measured, have the mean of all that was.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, TypeVar

import numpy as np

from modefront import options as opt
from modefront._typing import Floats
from modefront.data.modal import ModalData
from modefront.errors import Fault, ModelError, refuse, suggestion, wrong
from modefront.models.base import LoadCase, Model
from modefront.pairing.match import match, modes_needed
from modefront.predictions.base import PredictionKind
from modefront.residuals.problem import UpdatingProblem
from modefront.text import Shown


@dataclass(frozen=True, eq=False)
class ModalSystem:
    """A linear structure by its m modes, between n_inputs loads and n_outputs responses.

    Raises InputError for a static response of a structure with a rigid-body mode.
    """

    omega: Floats  # (m,) natural circular frequencies ω_r in rad/s; zero for a rigid-body mode
    zeta: Floats  # (m,) damping ratios ζ_r, none negative
    # (m, n_inputs) modal loads Γ: φᵀf for forces f, -φᵀM r for the acceleration of the base, r its
    # rigid-body motion
    input: Floats
    # (n_outputs, m) mode shapes Y at the outputs: a sensor, or any weighted sum of degrees of
    # freedom, such as a story drift
    output: Floats
    # (n_outputs, n_inputs) full static response Y_s = output · K⁻¹ · load, load = f or -M r: what
    # it exceeds that of the modes by corrects for those cut off; None where these are all
    static: Floats | None = None
    # (n_outputs, n_inputs) motion Y_b = output · r of the outputs with the base, for absolute
    # acceleration; None where the load is a force
    rigid: Floats | None = None

    def __post_init__(self) -> None:
        if self.static is not None and np.any(self.omega == 0):
            first = int(np.argmax(self.omega == 0))
            expected = "None, as a structure with a rigid-body mode has no static response"
            raise wrong("static", expected, f"an array with omega[{first}] = 0")

    def residual_flexibility(self) -> Floats:
        """Return static - Σ_r Y_r Γ_r / ω_r², (n_outputs, n_inputs); zero without `static`."""
        if self.static is None:
            return np.zeros((self.output.shape[0], self.input.shape[1]))
        return self.static - (self.output / self.omega**2) @ self.input


T = TypeVar("T")

MEASURED = "measured"  # damping ratios of the measured modes

BEYOND = 1.5  # end of the modes superposed, if their number is not given, over that of the band
ABOVE = 1.1  # end of the band where none is given, over the highest measured frequency
NAMED = "the name of a sensor or output, or a table of them with weights that are not zero"

WEIGHTS = opt.any_of(opt.NAME, opt.table_of(opt.any_of(opt.ABOVE_ZERO, opt.BELOW_ZERO), 1))
RATIO: opt.Schema = {"type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1}


def _is_printable(value: Any) -> bool:
    """Return whether all names can be printed."""
    if isinstance(value, dict):
        return all(map(_is_printable, value.values()))
    if isinstance(value, list):
        return all(map(_is_printable, value))
    return opt.is_name(value) if isinstance(value, str) else True


def _named_weights(value: Any) -> dict[str, float]:
    return {value: 1.0} if isinstance(value, str) else {k: float(w) for k, w in value.items()}


def _responses(value: Any) -> dict[str, dict[str, float]]:
    names = [value] if isinstance(value, str) else value
    named = names if isinstance(names, dict) else {name: name for name in names}
    return {name: _named_weights(each) for name, each in named.items()}


def _damping(value: Any) -> str | float | tuple[float, ...]:
    if isinstance(value, list):
        return tuple(map(float, value))
    return value if isinstance(value, str) else float(value)


Name = Annotated[str, opt.text("what the prediction is called")]

Force = Annotated[
    str | Mapping[str, float], opt.Requirement(NAMED, WEIGHTS, _named_weights, _is_printable)
]
"""One force; kept as weights by the name of a sensor or output."""

Forces = Annotated[
    str | Mapping[str, float] | Sequence[str | Mapping[str, float]],
    opt.Requirement(
        f"{NAMED}; or a list of these",
        opt.any_of(WEIGHTS, opt.array(WEIGHTS, 1)),
        lambda value: tuple(map(_named_weights, value if isinstance(value, list) else [value])),
        _is_printable,
    ),
]
"""Forces that are independent of one another; kept as such weights of each."""

Base = Annotated[str, opt.text("a direction in which the base moves")]

Response = Annotated[
    str | Sequence[str] | Mapping[str, str | Mapping[str, float]],
    opt.Requirement(
        f"a list of sensors or outputs, or a table, name = {NAMED}",
        opt.any_of(opt.NAME, opt.array(opt.NAME, 1, once=True), opt.table_of(WEIGHTS, 1)),
        _responses,
        lambda value: _is_printable(value) and all(map(opt.is_name, value)),
    ),
]
"""Responses; kept as weights of sensors and outputs by the name of each."""

ModeCount = Annotated[int, opt.whole(1, 10**9)]

Damping = Annotated[
    str | float | Sequence[float],
    opt.Requirement(
        f"'{MEASURED}', or a ratio above 0 and below 1, or a list of them, one a mode",
        opt.any_of({"enum": [MEASURED]}, RATIO, opt.array(RATIO, 1)),
        _damping,
    ),
]


class ModalPrediction(Shown):
    """What predictions share that superpose modes between loads and responses, by their options."""

    name: str
    response: Any  # kept as weights by the name of each response
    force: Any = None  # kept as the weights of one force, or a tuple of those of several
    base: str | None
    modes: int | None  # number of the lowest modes superposed; None where it is not known yet
    damping: Any  # ratio of all modes, or of each, or `MEASURED`
    static: bool = False  # whether the static response of the modes left out is added
    either: ClassVar = {"oneOf": [{"required": [key]} for key in ("force", "base")]}
    kind: ClassVar[PredictionKind]

    def __post_init__(self) -> None:
        """Bring the fields into plain Python, and refuse what contradicts itself."""
        opt.check_fields(self)
        refuse(self.contradictions())

    @property
    def load_case(self) -> LoadCase:
        """Where the model is loaded, and its responses."""
        forces = self.force if isinstance(self.force, tuple) else (self.force,) * bool(self.force)
        return LoadCase(tuple(self.response.values()), forces, self.base)

    @property
    def load(self) -> str:
        """Load case in words."""
        if self.base is not None:
            return f"base along {self.base}"
        forces = (
            " + ".join(name if w == 1 else f"{w:g} {name}" for name, w in weights.items())
            for weights in self.load_case.forces
        )
        return "force at " + ", and at ".join(forces)

    @property
    def damped(self) -> str:
        """The damping ratios, in words."""
        if isinstance(self.damping, str):
            return "as measured"
        return ", ".join(f"{ratio:g}" for ratio in np.atleast_1d(self.damping))

    @property
    def places(self) -> tuple[str, ...]:
        """Name of the prediction and of the response, for each of these."""
        return tuple(f"{self.name}: {response}" for response in self.response)

    @property
    def settings(self) -> Mapping[str, Sequence[object]]:
        """Values of the kind's settings, one a place, by the name of the variable."""
        keys = {x.name: x.name.removeprefix(f"{self.kind.dimension}_") for x in self.kind.settings}
        own = {key: getattr(self, key, None) for key in keys.values()} | {"damping": self.damped}
        return {name: [own[key]] * len(self.places) for name, key in keys.items()}

    def system(self, problem: UpdatingProblem, theta: Floats) -> ModalSystem:
        """Return the structure in modal coordinates at ``theta``.

        Raises ModelError where the model has no such modes there, InputError where their number is
        not known.
        """
        m, n = filled(self.modes, "modes"), 0
        if self.damping == MEASURED:
            # The same candidates as in updating, or other modes might be paired.
            n = modes_needed(problem.pairing, problem.data, problem.model.size)
        transfer = problem.model.transfer(theta, max(m, n), self.load_case)
        zeta, count = self.damping, transfer.modes.lam.size
        if n:
            measured = problem.data.mean_damping
            is_known = np.isfinite(measured)
            zeta = np.full(count, measured[is_known].mean())
            frequency, phi = transfer.modes.frequency[:n], transfer.modes.phi[:, :n]
            pairs = match(problem.pairing, problem.data, frequency, phi)
            zeta[pairs.index[is_known]] = measured[is_known]
        return ModalSystem(
            omega=np.sqrt(transfer.modes.lam[:m]),
            zeta=np.broadcast_to(np.asarray(zeta, dtype=float), count)[:m],
            input=transfer.input[:m],
            output=transfer.output[:, :m],
            static=transfer.static if self.static else None,
            rigid=transfer.rigid,
        )

    def contradictions(self) -> Iterator[Fault]:
        """Yield options that contradict one another."""
        if bool(self.force) == (self.base is not None):
            yield Fault("", "", "either force or base", "both" if self.force else "neither")
        if isinstance(self.damping, tuple) and self.modes not in (None, len(self.damping)):
            expected = f"a list of {self.modes}, one a mode"
            yield Fault("", "damping", expected, f"{len(self.damping)} of them")

    def faults(self, model: Model, data: ModalData) -> Iterator[Fault]:
        """Yield the names and damping that the model or the data do not have."""
        case, damping = self.load_case, self.damping
        for name, sums in (("force", case.forces), ("response", case.outputs)):
            for place in (place for weights in sums for place in weights):
                if place not in model.places:
                    expected = "the name of a sensor or output of the model"
                    yield Fault("", name, expected, suggestion(place, model.places))
        if self.base is not None and self.base not in model.directions:
            names = ", ".join(f"'{x}'" for x in model.directions) or "none: the model names no base"
            expected = f"one of the directions of the base, {names}"
            yield Fault("", "base", expected, f"'{self.base}'")
        if self.modes is not None and self.modes > model.size:
            yield Fault("", "modes", f"a whole number from 1 to {model.size}", str(self.modes))
        if isinstance(damping, tuple) and len(damping) > model.size:
            expected = f"at most {model.size} ratios, as the model has modes"
            yield Fault("", "damping", expected, f"{len(damping)} of them")
        if damping == MEASURED:
            ratios = data.mean_damping
            if not np.isfinite(ratios).any():
                yield Fault("", "damping", "a ratio, as the data have none", f"'{MEASURED}'")
            elif (ratios <= 0).any():
                yield Fault("", "damping", "a ratio, as measured ones are 0", f"'{MEASURED}'")

    def complete_modes(self, problem: UpdatingProblem, top: float) -> int:
        """Return the number of modes: that given, or as many as reach beyond ``top`` Hz."""
        if self.modes is not None:
            return self.modes
        if isinstance(self.damping, tuple):
            return len(self.damping)
        needed = modes_needed(problem.pairing, problem.data, problem.model.size)
        return modes_reaching(problem.model, problem.start, BEYOND * top, needed)

    def nominal(self, problem: UpdatingProblem) -> ModalSystem:
        """Return the nominal model; raise InputError without such modes, or response that moves."""
        try:
            system = self.system(problem, problem.start)
        except ModelError as error:
            raise wrong("modes", "modes that the nominal model has", error) from None
        if not (np.abs(system.output) @ np.abs(system.input)).any():
            raise wrong("response", "responses that the load can move", "none")
        return system


def filled(value: T | None, name: str) -> T:
    """Return an option; raise InputError where it is still to be found from the nominal model."""
    if value is None:
        raise wrong(name, "a value, which complete(problem) finds", "none")
    return value


def highest_frequency(data: ModalData) -> float | None:
    """Return the highest measured frequency in Hz, None where there is none."""
    measured = data.mean_frequency[np.isfinite(data.mean_frequency)]
    return float(measured.max()) if measured.size else None


def modes_reaching(model: Model, theta: Floats, frequency: float, count: int) -> int:
    """Return how many modes at ``theta`` are below a frequency in Hz, and one more if there is.

    The model is known to have ``count`` of them.
    """
    f = model.modes(theta, count, derivatives=False).frequency
    while not (f >= frequency).any():
        known, upper = f.size, min(2 * f.size, model.size)
        while upper > f.size:  # twice as many, as far as there are finite ones
            try:
                f = model.modes(theta, upper, derivatives=False).frequency
            except ModelError:
                upper = (known + upper) // 2
        if f.size == known:
            return known
    return int(np.argmax(f >= frequency)) + 1
