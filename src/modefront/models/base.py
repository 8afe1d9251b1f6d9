"""Interface of models: modes at sensors, and from loads to outputs, which predictions need.

Loads and outputs are weighted sums, named sums of degrees of freedom with their weights; a moving
base loads with -M r, r the motion of all degrees of freedom with it. In modes they are as
`modefront.predictions.system` has it.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from modefront._typing import Floats
from modefront.modes.result import Modes

if TYPE_CHECKING:
    from modefront.models.geometry import Geometry
    from modefront.models.matrices import MatrixModel

NamedWeights = Mapping[str, float]  # by sensor or output: a force of that size, a term of a sum


@dataclass(frozen=True)
class LoadCase:
    """Loads and outputs of a model: either forces, or one motion of the base."""

    outputs: tuple[NamedWeights, ...]  # sums of sensors and outputs, such as a storey drift
    forces: tuple[NamedWeights, ...] = ()  # one an input; none where the base moves
    base: str | None = None  # direction, of the model's, in which the base moves; None for forces


@dataclass(frozen=True)
class Transfer:
    """A model at one theta from the loads of a load case to its outputs, in its lowest modes."""

    modes: Modes  # the modes at the sensors, without derivatives
    input: Floats  # (modes, inputs) modal loads
    output: Floats  # (outputs, modes) mode shapes at the outputs
    static: Floats | None  # (outputs, inputs) static response; None with rigid-body modes
    rigid: Floats | None  # (outputs, 1) motion of the outputs with the base; None for forces


class Model(Protocol):
    """A class of models: the modes at sensors as a function of parameters."""

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of the parameters, in the order of ``theta``."""

    @property
    def sensors(self) -> tuple[str, ...]:
        """Names of the sensors, in the order of the rows of the mode shapes."""

    @property
    def size(self) -> int:
        """Number of degrees of freedom, an upper bound of the number of modes."""

    @property
    def unused(self) -> tuple[str, ...]:
        """Names of parameters on which nothing depends."""

    def modes(self, theta: Floats, count: int, *, derivatives: bool = True) -> Modes:
        """Return the ``count`` lowest modes at ``theta``, shape (parameters,).

        Raises ModelError where the model has no such modes at ``theta``.
        """

    @property
    def places(self) -> tuple[str, ...]:
        """Names of the sensors, and of what else can be loaded or looked at in predictions."""

    @property
    def directions(self) -> tuple[str, ...]:
        """Names of the directions in which the base can move."""

    def transfer(self, theta: Floats, count: int, load_case: LoadCase) -> Transfer:
        """Return loads and outputs in the ``count`` lowest modes at ``theta``.

        Raises ModelError where the model has no such modes, KeyError for unknown sensors, outputs
        or directions.
        """


def passed_on(inner: str, name: str) -> Any:
    """Return the property of a class of models that is one of the model that it keeps as inner."""
    text = getattr(Model, name, property()).__doc__
    return property(lambda model: getattr(getattr(model, inner), name), doc=text)


def full_of(model: Model) -> Model:
    """Return the model that is solved in full: itself, unless it has another as ``full``."""
    return getattr(model, "full", model)


def is_reduced(model: Model) -> bool:
    """Return whether a model stands for another one that is solved in full."""
    return full_of(model) is not model


def matrices_at(model: Model, theta: Floats) -> "MatrixModel | None":
    """Return the full model with the matrices and derivatives at ``theta``; None without any."""
    full: Any = full_of(model)
    return full.at(theta) if hasattr(type(full), "at") else None


def geometry_of(model: Model) -> "Geometry | None":
    """Return where the degrees of freedom of a model are; None where that is not known."""
    return getattr(full_of(model), "geometry", None)


def shapes_at(model: Model, theta: Floats, count: int) -> tuple[Floats, Floats, Floats | None]:
    """Return the ``count`` lowest modes at ``theta``, those of a reduced model in its basis.

    They are eigenvalues omega**2 in (rad/s)**2, (modes,), and mode shapes of arbitrary sign at the
    sensors, (sensors, modes), and at all degrees of freedom, (N, modes), None for a model without
    matrices. Raises ModelError where the model has no such modes.
    """
    known: Any = model
    if hasattr(type(known), "full_modes"):
        lowest = known.full_modes(theta, count)
        return lowest.lam, known.selection @ lowest.Phi, lowest.Phi
    modes = model.modes(theta, count, derivatives=False)
    return modes.lam, modes.phi, None
